"use strict";
// What the other files share: refusals, texts of numbers, arrays out of base64, interpolation.

// An input outside its range, as Python's: what it is, its value, and what is allowed, in SI.
class InputError extends Error {
  constructor(field, value, allowed) {
    super(`${field} = ${value}: must be ${allowed}`);
    Object.assign(this, { field, value, allowed });
  }
}

// As Python's format(value, ".6g").
function g(value, digits = 6) {
  if (value === 0 || !isFinite(value)) return String(value + 0);
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  const trimmed = text => (text.includes(".") ? text.replace(/\.?0+$/, "") : text);
  const power = Number(exponent);
  if (power >= -4 && power < digits) return trimmed(value.toFixed(digits - 1 - power));
  return `${trimmed(mantissa)}e${power < 0 ? "-" : "+"}${String(Math.abs(power)).padStart(2, "0")}`;
}

// The unit that an unusual value betrays (ehlcontact.checks.box.Quantity).
function slip(quantity, value) {
  const usual = x => quantity.usual[0] <= x && x <= quantity.usual[1];
  if (usual(value)) return "";
  for (const [other, size] of Object.entries(quantity.others))
    if (usual(value * size)) return `in ${other}? then ${g(value * size, 4)} ${quantity.unit}`.trimEnd();
  for (const [definition, [factor, power]] of Object.entries(quantity.definitions))
    if (usual(factor * value ** power)) return `as ${definition}? then ${g(factor * value ** power, 4)} ${quantity.unit}`.trimEnd();
  return "";
}

function requireQuantity(field, value, quantity) {
  const [low, high] = quantity.limits;
  if (low <= value && value <= high) return value;
  const guess = slip(quantity, value), allowed = `between ${g(low)} and ${g(high)} ${quantity.unit}`.trimEnd();
  throw new InputError(field, value, guess ? `${allowed} (${guess})` : allowed);
}

function bytes(base64) {
  return Uint8Array.from(atob(base64), letter => letter.charCodeAt(0));
}

// Little-endian numbers out of base64; `kind` is Float64Array or Float32Array.
function floats(base64, kind = Float64Array) {
  return new kind(bytes(base64).buffer);
}

// Index of the interval of the increasing array `x` that `at` lies in, or is nearest to.
function interval(x, at) {
  let low = 0, high = x.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= at) low = middle; else high = middle;
  }
  return low;
}

// Straight lines between the nodes, level beyond them: weights of two neighbours, [index, share of the next].
function between(x, at) {
  const k = interval(x, at);
  return [k, Math.min(Math.max((at - x[k]) / (x[k + 1] - x[k]), 0), 1)];
}

function linear(x, values, at) {
  const [k, t] = between(x, at);
  return values[k] + t * (values[k + 1] - values[k]);
}
