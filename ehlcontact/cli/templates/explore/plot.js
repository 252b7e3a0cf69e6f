// Small pictures in SVG: curves over a frequency, with bands for their error bars; and the load zone.

const MARGIN = { left: 62, right: 14, top: 12, bottom: 42 };

// A number for people: so many figures, without exponent from 1e-3 to 1e5.
function show(value, digits = 3) {
  if (value === 0 || !isFinite(value)) return value === 0 ? "0" : "–";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e5) return size >= 10 ** digits ? value.toFixed(0) : String(Number(value.toPrecision(digits)));
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  return `${Number(mantissa)}e${Number(exponent)}`;
}

// An axis from `low` to `high` over `length` pixels: place of a value, and ticks as [value, text].
function axis(low, high, log, from, to) {
  const [a, b] = log ? [Math.log10(low), Math.log10(high)] : [low, high];
  const place = value => from + (to - from) * ((log ? Math.log10(Math.max(value, 1e-300)) : value) - a) / (b - a);
  const within = value => Math.min(Math.max(place(value), Math.min(from, to)), Math.max(from, to));
  const ticks = [];
  if (log) {
    const every = Math.ceil((b - a) / Math.max(Math.abs(to - from) / 45, 1));
    for (let p = Math.ceil(a - 1e-9); p <= b + 1e-9; p += every) ticks.push([10 ** p, powerText(p)]);
  } else {
    const rough = (b - a) / 5, power = 10 ** Math.floor(Math.log10(rough)), step = [1, 2, 5, 10].find(s => s * power >= rough) * power;
    for (let v = Math.ceil(a / step - 1e-9) * step; v <= b + 1e-9 * step; v += step) ticks.push([v, show(Number(v.toPrecision(6)), 4)]);
  }
  return { place, within, ticks };
}

function powerText(p) {
  if (p >= -2 && p <= 2) return show(10 ** p);
  if (p >= 3 && p <= 5) return `${10 ** (p - 3)}k`;
  if (p >= 6 && p <= 8) return `${10 ** (p - 6)}M`;
  return `1e${p}`;
}

// Curves over a logarithmic x. `series`: { points: [[x, y, half width of the bar]], kind: class }; `mark`: an x.
function curves(width, { x, y, series, bands = [], mark, label }) {
  const height = Math.round(Math.min(Math.max(0.5 * width, 210), 300)), { left, right, top, bottom } = MARGIN;
  const ax = axis(x.low, x.high, true, left, width - right), ay = axis(y.low, y.high, y.log, height - bottom, top);
  const at = (u, v) => `${ax.within(u).toFixed(1)},${ay.within(v).toFixed(1)}`, parts = [];
  for (const [v, text] of ax.ticks)
    parts.push(`<path class="grid" d="M${at(v, y.low)}V${top}"/><text x="${ax.place(v)}" y="${height - bottom + 16}" text-anchor="middle">${text}</text>`);
  for (const [v, text] of ay.ticks)
    parts.push(`<path class="grid" d="M${at(x.low, v)}H${width - right}"/><text x="${left - 6}" y="${ay.place(v) + 4}" text-anchor="end">${text}</text>`);
  for (const { points, kind } of bands) {
    const ends = [...points.map(([u, low]) => at(u, low)), ...points.map(([u, , high]) => at(u, high)).reverse()];
    parts.push(`<polygon class="band ${kind}" points="${ends.join(" ")}"/>`);
  }
  for (const { points, kind } of series)
    parts.push(`<polyline class="curve ${kind}" points="${points.map(([u, v]) => at(u, v)).join(" ")}"/>`);
  if (mark >= x.low && mark <= x.high) parts.push(`<path class="mark" d="M${at(mark, y.low)}V${top}"/>`);
  parts.push(`<text x="${(left + width - right) / 2}" y="${height - 6}" text-anchor="middle">${x.label}</text>`);
  parts.push(`<text transform="translate(13 ${(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">${y.label}</text>`);
  return `<svg class="curves" role="img" aria-label="${label}" viewBox="0 0 ${width} ${height}">${parts.join("")}</svg>`;
}

// Range for all values of series and bands; whole decades for a logarithmic axis.
function range(values, log) {
  const high = Math.max(...values);
  if (!log) {
    const least = Math.min(...values), room = Math.max(0.15 * (high - least), 0.02 * high);
    return { low: least - room, high: high + room, log };
  }
  const low = Math.max(Math.min(...values.filter(v => v > 0)), high * 1e-5);
  return { low: 10 ** Math.floor(Math.log10(low)), high: 10 ** Math.ceil(Math.log10(high)), log };
}

// Balls between both rings, and the force of each as a bar outwards from the ring; `arrow`: of the radial load.
function loadZone(width, balls, radii, label, arrow) {
  const size = Math.min(width, 360), middle = size / 2, most = Math.max(...balls.map(ball => ball.force[0]));
  const ring = 0.23 * size, scale = ring / radii.pitch, longest = middle - ring - scale * radii.ball - 22, parts = [];
  const far = ring + scale * radii.ball;
  const at = (n, r) => `${(middle + n[0] * r).toFixed(1)},${(middle - n[1] * r).toFixed(1)}`;
  for (const r of [ring - scale * radii.ball, far]) parts.push(`<circle class="ring" cx="${middle}" cy="${middle}" r="${r}"/>`);
  for (const { psi, force } of balls) {
    const n = [Math.cos(psi), Math.sin(psi)];
    const [cx, cy] = at(n, ring).split(","), share = force[0] / most;
    parts.push(`<circle class="ball${share > 0.01 ? " loaded" : ""}" cx="${cx}" cy="${cy}" r="${scale * radii.ball * 0.94}"/>`);
    if (share < 0.01) continue;
    const [x, y] = at(n, far + 3 + longest * share + (Math.abs(n[0]) < 0.4 ? 10 : 4)).split(",");
    const anchor = n[0] < -0.4 ? "end" : n[0] > 0.4 ? "start" : "middle";
    parts.push(`<path class="force" d="M${at(n, far + 3)}L${at(n, far + 3 + longest * share)}"/>`);
    parts.push(`<text x="${x}" y="${Number(y) + 4}" text-anchor="${anchor}">${show(force[0])}</text>`);
  }
  if (arrow) parts.push(`<path class="load" d="M${middle},${middle - 0.12 * size}V${middle + 0.1 * size}m-6,-9l6,9l6,-9"/>`);
  return `<svg class="zone" role="img" aria-label="${label}" viewBox="0 0 ${size} ${size}" style="max-width:${size}px">${parts.join("")}</svg>`;
}

function table(caption, head, rows) {
  const cells = (row, tag) => row.map((cell, i) => (i ? `<${tag}>${cell}</${tag}>` : `<th scope="row">${cell}</th>`)).join("");
  const top = head.map(cell => `<th scope="col">${cell}</th>`).join("");
  const body = rows.map(row => `<tr>${cells(row, "td")}</tr>`).join("");
  return `<div class="wide" role="region" aria-label="${caption}" tabindex="0"><table><caption>${caption}</caption><thead><tr>${top}</tr></thead><tbody>${body}</tbody></table></div>`;
}
