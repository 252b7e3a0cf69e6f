"use strict";
// A scene (see cli/plots/live/scene.py) arranged for so many pixels: traces and layout for plotly.js.

const FONT = 12, LINE = 16, LETTER = 7.2; // px: of letters, of a line, and what a letter takes on average
const NARROWEST = 300; // px of a column; with less, panels stand below each other
const LEFT = 66, RIGHT = 14, BAR = 88, SECOND = 62; // px beside the axes: numbers, nothing, colours, a second axis
const HEAD = 10, FOOT = 44, BARE = 26; // px over the axes; under them with a label, and without one
const POLAR = 20, ROUND = 40; // px over a round panel and beside it, of its degrees
const TOOLS = 26; // px over all, of plotly's buttons
const TALLEST = 330, FLATTEST = 140; // px of a panel that stands alone on a narrow page, and of a map at least
// What colours of paper become on a dark page, where the palette of Okabe and Ito is lightened.
const DARK = {
  "#0072b2": "#56b4e9", "#e69f00": "#f0b23c", "#009e73": "#35c79c", "#d55e00": "#ff8f4f", "#cc79a7": "#e39bc6",
  "#7f7f7f": "#a9b0b8", "#000000": "#e8eaed", "#f2f2f2": "#262b31", "#eaf3fa": "#1f3140",
};

function wrapped(text, room) {
  // Lines of at most so many pixels.
  const lines = [""];
  for (const word of text.split(" ")) {
    const last = lines[lines.length - 1];
    if (last && (last.length + word.length + 1) * LETTER > room) lines.push(word);
    else lines[lines.length - 1] = last ? `${last} ${word}` : word;
  }
  return lines;
}

function arranged(scene, width, ink) {
  // {data, layout, keys, grown}: keys are what a legend has to name; maps are so many times higher than in scene.note.
  const tint = colour => (ink.dark && DARK[colour]) || colour;
  const columns = 1 + Math.max(...scene.panels.map(panel => panel.column));
  const alone = columns > 1 && width < NARROWEST * columns;
  const across = alone ? 1 : columns, cell = width / across;
  const panels = scene.panels.map((panel, number) => ({ ...panel, number }));
  if (alone) panels.sort((a, b) => a.column - b.column || a.row - b.row);
  const rows = [];
  panels.forEach((panel, k) => {
    const row = alone ? k : panel.row;
    (rows[row] ??= []).push(measured(panel, cell, alone));
  });
  let top = matchMedia("(hover: none)").matches ? TOOLS : 0; // where nothing hovers the tools are always there
  for (const row of rows.filter(Boolean)) {
    const head = Math.max(...row.map(panel => panel.head)), high = Math.max(...row.map(panel => panel.high));
    for (const panel of row) {
      panel.left = (alone ? 0 : panel.column) * cell;
      panel.top = top + head;
    }
    top += head + high + Math.max(...row.map(panel => panel.foot));
  }
  const layout = {
    width, height: top, margin: { l: 0, r: 0, t: 0, b: 0 }, showlegend: false, hovermode: "closest",
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { size: FONT, color: ink.text, family: ink.family },
    hoverlabel: { font: { size: FONT + 1 } }, shapes: [], annotations: [], images: [],
    dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom",
    modebar: { bgcolor: "rgba(0,0,0,0)", color: ink.soft, activecolor: ink.text },
  };
  const data = [];
  for (const panel of panels.flatMap((_, k) => rows.flat().filter(one => one && one.number === k)))
    place(panel, { data, layout, width, height: top, ink, tint });
  const grown = Math.max(...rows.flat().filter(Boolean).map(panel => panel.grown));
  return { data, layout, keys: keysOf(scene, tint), grown };
}

function measured(panel, cell, alone) {
  // With the pixels that the panel takes inside its cell.
  const bar = panel.traces.some(trace => trace.label), outside = (panel.notes ?? []).some(note => note.shares[0] && note.x > 1);
  const right = bar ? BAR : panel.y2 ? SECOND : outside ? 84 : RIGHT;
  const wide = cell - (panel.polar ? 2 * ROUND - RIGHT : LEFT) - right;
  const title = panel.title ? wrapped(panel.title, cell - 30) : [];
  const usual = alone ? Math.min(Math.max(panel.height - FOOT, 190), TALLEST) : Math.max(panel.height - FOOT, 110);
  const high = panel.polar ? Math.min(wide - 40, 300) : panel.box ? Math.max(wide * panel.box, FLATTEST) : panel.equal ? Math.min(wide, 360) : usual;
  const below = panel.x && (alone ? panel.x.alone : panel.x.label);
  const grown = panel.box ? high / (wide * panel.box) : 1;
  return { ...panel, grown, cell, alone, wide, high, title, head: HEAD + LINE * title.length + (panel.polar ? POLAR : 0), foot: panel.polar ? 34 : below ? FOOT : BARE };
}

function place(panel, at) {
  const { data, layout, width, height, ink, tint } = at;
  const k = panel.number, id = k ? String(k + 1) : "";
  const x0 = panel.left + (panel.polar ? ROUND : LEFT), y1 = height - panel.top;
  const domains = { x: [x0 / width, (x0 + panel.wide) / width], y: [(y1 - panel.high) / height, y1 / height] };
  if (panel.title.length)
    layout.annotations.push({ text: panel.title.join("<br>"), showarrow: false, xref: "paper", yref: "paper", align: "center",
      x: (panel.left + panel.cell / 2) / width, y: (y1 + 4 + (panel.polar ? POLAR : 0)) / height, xanchor: "center", yanchor: "bottom", font: { size: FONT + 1 } });
  if (panel.polar) {
    layout[`polar${id}`] = { barmode: "overlay", domain: domains, bgcolor: "rgba(0,0,0,0)", radialaxis: { range: [0, panel.polar], gridcolor: ink.line, nticks: 4, angle: 20, tickangle: 0 },
      angularaxis: { gridcolor: ink.line, linecolor: ink.line, dtick: 45 } };
    for (const trace of panel.traces)
      data.push({ ...tinted(trace, tint), subplot: `polar${id}`, hovertemplate: `%{theta:.0f}°: %{r:.4g}<extra>${trace.name}</extra>` });
    return;
  }
  const full = panel.pictures?.length > 0 || panel.traces.some(trace => trace.type === "heatmap"); // no lines over them
  const axis = (spec, side, room) => ({
    domain: domains[side], anchor: `${side === "x" ? "y" : "x"}${id}`, type: spec.log ? "log" : "linear",
    range: spec.range && (spec.log ? spec.range.map(Math.log10) : spec.range), autorange: !spec.range,
    title: { text: wrapped(panel.alone ? spec.alone ?? spec.label : spec.label, room).join("<br>"), standoff: 6, font: { size: FONT, color: tint(spec.color ?? ink.text) } },
    gridcolor: ink.line, linecolor: ink.soft, showline: true, showgrid: !full, zeroline: false, ticks: "outside", ticklen: 3, tickcolor: ink.soft,
    exponentformat: "e", nticks: Math.max(4, Math.floor(room / (side === "x" ? 75 : 38))), tickmode: spec.ticks ? "array" : "auto",
    // with a format, the digits between powers of ten are whole numbers and as large as these
    ...(spec.log ? { tickformat: Math.log10(spec.range?.[1] / spec.range?.[0]) > 3.5 ? "~e" : "~g", nticks: Math.max(3, Math.floor(room / (side === "x" ? 60 : 38))) } : {}),
    ...(spec.ticks ? { tickvals: spec.ticks } : {}),
  });
  const shares = number => (number === null || number === undefined ? {} : { matches: `${number ? number + 1 : ""}` });
  const x = axis(panel.x, "x", panel.wide), y = axis(panel.y, "y", panel.high);
  for (const [name, one] of [["x", x], ["y", y]]) {
    const link = shares(panel.matches?.[name]);
    if (link.matches !== undefined && !panel.equal) one.matches = `${name}${link.matches}`;
  }
  if (panel.equal) Object.assign(y, { scaleanchor: `x${id}`, scaleratio: 1 });
  layout[`xaxis${id}`] = x;
  layout[`yaxis${id}`] = y;
  const second = `y${100 + k}`;
  if (panel.y2) layout[`yaxis${100 + k}`] = { ...axis(panel.y2, "y", panel.high), overlaying: `y${id}`, side: "right", showgrid: false };
  const middle = (domains.y[0] + domains.y[1]) / 2;
  for (const trace of panel.traces) {
    const label = trace.second ? panel.y2.label : panel.y.alone || panel.y.label;
    const told = `${panel.x.alone || panel.x.label}: %{x:.5~g}<br>${label}: %{y:.5~g}`;
    const own = { ...tinted(trace, tint), xaxis: `x${id}`, yaxis: trace.second ? second : `y${id}` };
    if (trace.type === "heatmap")
      Object.assign(own, { hovertemplate: `${told}<br>${trace.label}: %{z:.4~g}<extra></extra>`, colorbar: { x: domains.x[1] + 6 / width, xanchor: "left", y: middle,
        len: panel.high, lenmode: "pixels", thickness: 10, ypad: 0, xpad: 0, outlinewidth: 0, tickfont: { size: 11 }, exponentformat: "e",
        nticks: 5, title: { text: wrapped(trace.label, panel.high).join("<br>"), side: "right", font: { size: FONT } } }, showscale: Boolean(trace.label) });
    else if (!trace.hoverinfo) own.hovertemplate = `${told}<extra>${trace.name}</extra>`;
    data.push(own);
  }
  for (const picture of panel.pictures ?? []) {
    layout.images.push({ ...picture, xref: `x${id}`, yref: `y${id}`, sizing: "stretch", layer: "below" });
    const ends = { x: [picture.x, picture.x + picture.sizex], y: [picture.y - picture.sizey, picture.y] };
    data.push({ type: "scatter", mode: "lines", line: { width: 0 }, hoverinfo: "skip", ...ends, xaxis: `x${id}`, yaxis: `y${id}` });
  }
  marked(panel, id, at);
}

function marked(panel, id, { layout, tint }) {
  for (const mark of panel.marks) {
    const line = mark.line && { ...mark.line, color: tint(mark.line.color) }, own = { xref: `x${id}`, yref: `y${id}` };
    if (mark.kind === "ellipse") layout.shapes.push({ type: "circle", ...own, x0: mark.x0, x1: mark.x1, y0: mark.y0, y1: mark.y1, line });
    else if (mark.kind === "stretch")
      layout.shapes.push({ type: "rect", ...own, yref: `y${id} domain`, x0: mark.x0, x1: mark.x1, y0: 0, y1: 1, fillcolor: tint(mark.fill), line: { width: 0 }, layer: "below" });
    else if (mark.x !== undefined) layout.shapes.push({ type: "line", ...own, yref: `y${id} domain`, x0: mark.x, x1: mark.x, y0: 0, y1: 1, line });
    else layout.shapes.push({ type: "line", ...own, xref: `x${id} domain`, x0: 0, x1: 1, y0: mark.y, y1: mark.y, line });
  }
  const value = (spec, share, at) => (spec.log && !share ? Math.log10(at) : at);
  for (const note of panel.notes) {
    const [across, up] = note.shares, left = across && note.x > 1;
    layout.annotations.push({ text: note.text, showarrow: false, font: { size: 11, color: tint(note.color) },
      xref: `x${id}${across ? " domain" : ""}`, yref: `y${id}${up ? " domain" : ""}`, x: value(panel.x, across, note.x), y: value(panel.y, up, note.y),
      xanchor: left ? "left" : note.anchors[0], yanchor: note.anchors[1] });
  }
}

function tinted(trace, tint) {
  const own = { ...trace };
  for (const part of ["line", "marker"]) {
    if (!own[part]) continue;
    own[part] = { ...own[part], ...(own[part].color ? { color: tint(own[part].color) } : {}) };
    if (own[part].line) own[part].line = { ...own[part].line, color: tint(own[part].line.color) };
  }
  return own;
}

function lookOf(trace) {
  // Traces that look alike are one thing, whichever of them is named.
  const { line, marker, type } = trace;
  return [type, line?.color ?? marker?.color, line?.dash ?? "", trace.mode === "markers" ? marker.symbol : ""].join();
}

function keysOf(scene, tint) {
  const found = new Map();
  for (const panel of scene.panels) {
    for (const trace of panel.traces) {
      if (!trace.name) continue;
      const look = lookOf(trace), told = [...found.values()].find(key => key.look === look && trace.name.startsWith(key.name));
      if (told) told.name = trace.name; // the same with a number to it
      else if (!found.has(trace.name)) found.set(trace.name, { name: trace.name, look, trace: tinted(trace, tint) });
    }
    for (const mark of panel.marks)
      if (mark.name && !found.has(mark.name)) found.set(mark.name, { name: mark.name, fill: tint(mark.fill) });
  }
  return [...found.values()];
}
