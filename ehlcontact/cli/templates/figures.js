"use strict";
// Draws the figures of a page with plotly.js: as wide as the page, light or dark, with a slider where one has frames.

const report = { wanted: 0, drawn: 0, failed: [] }; // what a test looks at
// nothing is sent anywhere
const CONFIG = { displaylogo: false, showSendToCloud: false, showEditInChartStudio: false, plotlyServerURL: "", scrollZoom: false, doubleClick: "reset", modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"] };
const NARROWEST = 210; // px of a column; with less, panels stand below each other
const PACE = 160; // ms of a frame that runs
const SHEET = 703, TALLEST = 900; // px of an A4 sheet between its margins; and of a figure with its notes and caption on it
// What colours of paper become on a dark page, where the palette of Okabe and Ito is lightened.
const DARK = {
  "#0072b2": "#56b4e9", "#e69f00": "#f0b23c", "#009e73": "#35c79c", "#d55e00": "#ff8f4f", "#cc79a7": "#e39bc6",
  "#7f7f7f": "#a9b0b8", "#f2f2f2": "#262b31", "#eaf3fa": "#1f3140", "#1d2126": "#e8eaed", "#59616b": "#a7afb9", "#d5d9de": "#3a4048",
};
const night = matchMedia("(prefers-color-scheme: dark)");

async function unpacked(id) {
  const letters = atob(document.getElementById(id).textContent.trim());
  const bytes = Uint8Array.from(letters, letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

function element(name, properties = {}, ...children) {
  const one = Object.assign(document.createElement(name), properties);
  one.append(...children);
  return one;
}

function merged(base, changes) {
  // A layout with some of its values replaced, at any depth.
  const plain = value => value && typeof value === "object" && !Array.isArray(value);
  const found = { ...base };
  for (const [name, value] of Object.entries(changes)) found[name] = plain(value) && plain(base[name]) ? merged(base[name], value) : value;
  return found;
}

class Drawn {
  // One figure of the page; `text` is its JSON.
  constructor(plot, text) {
    Object.assign(this, { plot, text, meta: JSON.parse(text).layout.meta });
    this.frame = this.meta.slider?.start ?? 0;
    if (this.meta.note) plot.before(element("p", { className: "note" }, this.meta.note));
    if (this.meta.thinned) plot.after(element("p", { className: "note screen" }, `Thinned for the screen: ${this.meta.thinned}. All of it is in the results files.`));
    if (this.meta.slider) plot.after(this.slider(this.meta.slider));
  }

  async draw(dark = night.matches) {
    const { data, layout, frames } = JSON.parse(dark ? this.text.replace(/#[0-9a-f]{6}/g, colour => DARK[colour] ?? colour) : this.text);
    const width = this.plot.clientWidth, narrow = width < NARROWEST * this.meta.columns || width < 500;
    const own = { width, font: { family: getComputedStyle(document.body).fontFamily }, dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom" };
    this.frames = frames;
    this.enter(data);
    const options = { ...CONFIG, toImageButtonOptions: { filename: this.plot.parentElement.id, scale: 2 } };
    this.plot.style.minHeight = "";
    const whole = merged(merged(layout, narrow ? this.meta.narrow : {}), own);
    this.plot.style.setProperty("--sheet", Math.min(1, SHEET / width, TALLEST / whole.height));
    await Plotly.react(this.plot, data, whole, options);
  }

  enter(data) {
    // The numbers of the frame into the traces.
    const frame = this.frames?.[this.frame];
    frame?.data.forEach((trace, k) => Object.assign(data[frame.traces?.[k] ?? k], trace));
  }

  slider({ label, texts, runs }) {
    const id = `${this.plot.parentElement.id}-frame`;
    const input = element("input", { type: "range", id, min: 0, max: texts.length - 1, step: 1, value: this.frame });
    const shown = element("output", { textContent: texts[this.frame] }), button = element("button", { type: "button", textContent: "run" });
    const go = frame => {
      this.frame = frame;
      input.value = frame;
      shown.textContent = texts[frame];
      input.setAttribute("aria-valuetext", texts[frame]);
      this.enter(this.plot.data);
      return Plotly.redraw(this.plot);
    };
    let clock = null;
    const stop = () => { clearInterval(clock); clock = null; button.textContent = "run"; };
    input.addEventListener("input", () => { stop(); go(Number(input.value)); });
    button.addEventListener("click", () => {
      if (clock) return stop();
      button.textContent = "stop";
      clock = setInterval(() => go((this.frame + 1) % texts.length), PACE);
    });
    return element("div", { className: "slider" }, element("label", { htmlFor: id }, label), input, shown, ...(runs ? [button] : []));
  }
}

const drawings = [];

async function redraw(dark) {
  for (const one of drawings)
    try { await one.draw(dark); } catch (error) { report.failed.push(`${one.plot.dataset.figure}: ${error}`); }
}

async function start() {
  const plots = [...document.querySelectorAll("[data-figure]")];
  report.wanted = plots.length;
  document.head.append(element("script", { textContent: await unpacked("plotly") }));
  const figures = JSON.parse(await unpacked("figures"));
  for (const plot of plots) {
    const one = new Drawn(plot, figures[plot.dataset.figure]);
    try { await one.draw(); drawings.push(one); report.drawn += 1; } catch (error) { report.failed.push(`${plot.dataset.figure}: ${error}`); }
  }
  let width = document.documentElement.clientWidth, waiting;
  addEventListener("resize", () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      if (width !== (width = document.documentElement.clientWidth)) redraw();
    }, 150);
  });
  night.addEventListener("change", () => redraw());
  addEventListener("beforeprint", () => { if (night.matches) redraw(false); });
  addEventListener("afterprint", () => { if (night.matches) redraw(); });
}

report.ready = start().catch(error => report.failed.push(String(error)));
