// Draws the scenes of the page over their static pictures, with keys to switch lines off and sliders to run through
// frames; again when the page changes its width or its colours.

const report = { wanted: 0, drawn: 0, failed: [] }; // what a test looks at
// nothing is sent anywhere
const CONFIG = { displaylogo: false, showSendToCloud: false, showEditInChartStudio: false, plotlyServerURL: "", scrollZoom: false, doubleClick: "reset", modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"] };
const PACE = 160; // ms of a frame that runs

async function unpacked(id) {
  const letters = atob(document.getElementById(id).textContent.trim());
  const bytes = Uint8Array.from(letters, letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

function inks() {
  const style = getComputedStyle(document.documentElement), ink = name => style.getPropertyValue(`--${name}`).trim();
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  return { dark, text: ink("ink"), soft: ink("soft"), line: ink("line"), family: getComputedStyle(document.body).fontFamily };
}

function element(name, properties = {}, ...children) {
  const one = Object.assign(document.createElement(name), properties);
  one.append(...children);
  return one;
}

class Drawn {
  // One figure of the page.
  constructor(figure, scene) {
    Object.assign(this, { figure, scene, hidden: new Set(), frame: scene.frames?.start ?? 0, width: 0 });
    this.plot = element("div", { className: "plot" });
    this.keys = element("ul", { className: "keys" });
    this.box = element("div", { className: "live" }, this.keys, this.plot);
    this.note = element("p", { className: "note" });
    this.box.prepend(this.note);
    if (scene.frames) this.box.append(this.slider());
    if (scene.thinned) this.box.append(element("p", { className: "note" }, `Thinned for the screen - ${scene.thinned}. All of it is in the results files.`));
    figure.prepend(this.box);
    figure.classList.add("drawn"); // before it is, for what is hidden has no width
  }

  async draw() {
    const width = Math.floor(this.plot.clientWidth || this.figure.clientWidth);
    this.width = width;
    const { data, layout, keys, grown } = arranged(this.scene, width, inks());
    for (const trace of data) if (this.off(trace)) trace.visible = false;
    const higher = grown > 1.02 ? `on so narrow a page maps are another ${grown.toFixed(1)} times higher` : "";
    this.note.textContent = [this.scene.note, higher].filter(Boolean).join("; ");
    this.note.hidden = !this.note.textContent;
    this.data = data;
    this.show(keys);
    this.enter();
    await Plotly.react(this.plot, data, layout, { ...CONFIG, toImageButtonOptions: { filename: this.figure.id, scale: 2 } });
  }

  remove() {
    this.box.remove();
    this.figure.classList.remove("drawn");
  }

  off(trace) {
    return this.hidden.has(lookOf(trace));
  }

  show(keys) {
    this.keys.replaceChildren(...(keys.length > 1 ? keys.map(key => element("li", {}, this.key(key))) : []));
  }

  key({ name, look, fill, trace }) {
    const sample = element("span", { className: "sample" });
    sample.innerHTML = drawnSample(trace, fill);
    if (fill) return element("span", {}, sample, name);
    const button = element("button", { type: "button", title: "show or hide" }, sample, name);
    const tell = () => button.setAttribute("aria-pressed", String(!this.hidden.has(look)));
    button.addEventListener("click", () => {
      if (!this.hidden.delete(look)) this.hidden.add(look);
      tell();
      const visible = this.data.map(one => !this.off(one));
      Plotly.restyle(this.plot, { visible });
    });
    tell();
    return button;
  }

  slider() {
    const { label, unit, values } = this.scene.frames, id = `${this.figure.id}-frame`;
    const input = element("input", { type: "range", id, min: 0, max: values.length - 1, step: 1, value: this.frame });
    const told = element("output", {}), play = element("button", { type: "button" }, "run");
    const tell = () => {
      told.textContent = `${values[this.frame]} ${unit}`;
      input.setAttribute("aria-valuetext", told.textContent);
    };
    const go = frame => {
      this.frame = frame;
      input.value = frame;
      tell();
      this.enter();
      return Plotly.redraw(this.plot);
    };
    let clock = null;
    const stop = () => { clearInterval(clock); clock = null; play.textContent = "run"; };
    input.addEventListener("input", () => { stop(); go(Number(input.value)); });
    play.addEventListener("click", () => {
      if (clock) return stop();
      play.textContent = "stop";
      clock = setInterval(() => go((this.frame + 1) % values.length), PACE);
    });
    tell();
    this.go = go;
    const words = element("label", { htmlFor: id }, label);
    return element("div", { className: "slider" }, words, input, told, ...(this.scene.frames.runs ? [play] : []));
  }

  enter() {
    // The numbers of the frame into the traces.
    if (!this.scene.frames) return;
    for (const { trace, ...series } of this.scene.frames.traces)
      for (const [name, frames] of Object.entries(series)) this.data[trace][name] = frames[this.frame];
  }
}

function drawnSample(trace, fill) {
  const start = '<svg width="26" height="10" viewBox="0 0 26 10" aria-hidden="true">';
  const box = fill ?? (trace.type === "barpolar" ? trace.marker.color : null);
  if (box) return `${start}<rect x="2" width="22" height="10" fill="${box}"/></svg>`;
  const dashes = { dash: "6 4", dot: "2 3", dashdot: "6 3 2 3" }[trace.line?.dash] ?? "none";
  const line = trace.line ? `<line x1="0" x2="26" y1="5" y2="5" stroke="${trace.line.color}" stroke-width="2.2" stroke-dasharray="${dashes}"/>` : "";
  if (!trace.marker) return `${start}${line}</svg>`;
  const { symbol, color } = trace.marker, look = `stroke="${color}" stroke-width="1.6" fill="${symbol.endsWith("open") ? "none" : color}"`;
  const shapes = { circle: `<circle cx="13" cy="5" r="3.4" ${look}/>`, square: `<rect x="10" y="2" width="6" height="6" ${look}/>`,
    diamond: `<path d="M13 1l4 4-4 4-4-4z" ${look}/>`, triangle: `<path d="M13 1l4 7h-8z" ${look}/>`, x: `<path d="M10 2l6 6m0-6l-6 6" ${look}/>` };
  return `${start}${line}${shapes[symbol.split("-")[0]] ?? shapes.circle}</svg>`;
}

const drawings = [];

async function redraw() {
  for (const one of drawings)
    try { await one.draw(); } catch (error) { report.failed.push(`${one.figure.id}: ${error}`); }
}

async function start() {
  if (!("DecompressionStream" in window)) return;
  const figures = [...document.querySelectorAll("figure[data-scene]")];
  report.wanted = figures.length;
  document.head.append(element("script", { textContent: await unpacked("plotly") }));
  const scenes = JSON.parse(await unpacked("scenes"));
  for (const figure of figures) {
    const scene = scenes[figure.dataset.scene], one = new Drawn(figure, scene);
    drawings.push(one);
    try { await one.draw(); report.drawn += 1; } catch (error) { one.remove(); report.failed.push(`${figure.id}: ${error}`); }
  }
  let width = document.documentElement.clientWidth, waiting;
  addEventListener("resize", () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      if (width === (width = document.documentElement.clientWidth)) return;
      redraw();
    }, 150);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

report.ready = start().catch(error => report.failed.push(String(error)));
