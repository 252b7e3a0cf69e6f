// Names of bearings as people type them: reduced_models.bearing.designation, whose regular expressions these are.

const NAMING = DATA.designations;

const squeezed = text => text.toUpperCase().replace(new RegExp(NAMING.gap, "g"), "");

// Name in the catalogue, suffixes with their meanings, class of clearance among them; null where it has no such name.
function designation(text) {
  const written = text.trim().toUpperCase(), rest = written.replace(new RegExp(NAMING.maker), "");
  const exact = Object.fromEntries(Object.keys(DATA.catalogue).map(name => [squeezed(name), name]));
  const own = [written, rest].flatMap(one => [squeezed(one), `${squeezed(one)}A`]).find(one => exact[one] !== undefined);
  if (own !== undefined) return { name: exact[own], suffixes: [], clearance: null };
  for (const [pattern, name, withoutLetter] of NAMING.readings) {
    const begin = rest.match(new RegExp(pattern));
    if (begin === null) continue;
    const tokens = rest.slice(begin[0].length).split(new RegExp(NAMING.gap)).flatMap(part => part.split(new RegExp(NAMING.token))).filter(Boolean);
    if (tokens.some(one => /^\d+$/.test(one))) return null;
    const found = tokens.filter(one => !NAMING.makers.includes(one)).map(one => [one, meaningOf(one)]);
    if (withoutLetter && found.some(([, words]) => words === NAMING.not_read)) return null;
    return { name, suffixes: found, clearance: found.find(([, words]) => words === "clearance class")?.[0] ?? null };
  }
  return null;
}

const meaningOf = suffix => Object.entries(NAMING.suffixes).find(([pattern]) => new RegExp(`^(?:${pattern})$`).test(suffix))?.[1] ?? NAMING.not_read;

// Suffixes with their meanings, and what of them is not in the torque.
function wordsOf({ suffixes }) {
  const left = suffixes.map(([, words]) => NAMING.not_in_torque[words]).find(Boolean);
  return [...suffixes.map(([suffix, words]) => `${suffix}: ${words}`), ...(left ? [left] : [])].join("; ");
}

// What a name must be that is none of the catalogue: the kind of bearing that it is of, or names that begin alike.
function allowedNames(text) {
  const wanted = squeezed(text.trim().toUpperCase().replace(new RegExp(NAMING.maker), ""));
  const kind = Object.entries(NAMING.kinds).find(([pattern]) => new RegExp(`^(?:${pattern})`).test(wanted));
  if (kind) return `a ball bearing of one row, deep groove or angular contact: ${text} is one of the ${kind[1]}, which are not in this page`;
  const names = Object.keys(DATA.catalogue), begins = length => names.filter(name => squeezed(name).startsWith(wanted.slice(0, length)));
  const length = [...wanted].findLastIndex((_, k) => begins(k + 1).length > 0) + 1, near = length ? begins(length) : names;
  return `one of ${near.slice(0, 12).join(", ")}${near.length > 12 ? " and others" : ""}, with suffixes as in 6205-2RS/C3; or own, with its dimensions`;
}
