// The page: what is typed to a bearing, its answers to tiles, tables and pictures, and all that is typed in the address.

const FIELDS = [...document.querySelectorAll("#inputs input, #inputs select")].map(input => input.name);
const SIZES = ["balls", "ball_diameter", "pitch_diameter", "conformity_inner", "conformity_outer", "contact_angle"];
const OWN = "own", SIZE = { mm: 1e-3, "µm": 1e-6, "mPa s": 1e-3, "1/GPa": 1e-9, "°": Math.PI / 180 };
const RANGED = { conformity_inner: "conformity", conformity_outer: "conformity" }; // that share a range of inputs
const USUAL = [0.25e-5, 2.5e-5]; // s, damping over stiffness: Kraemer, Dynamics of Rotors and Foundations, 1993
const DEFECTS = { FTF: "cage", BPFO: "balls on the outer race", BPFI: "balls on the inner race", BSF: "spin of a ball" };
const WAYS = { along: 1, across: 0, axial: 2 }; // place among the axes of the bearing
const FREQUENCIES = 90, SHOWN = 14; // of curves; of a table
const field = name => document.getElementById(name);
const atlas = new Atlas(DATA.atlas);
let current = null;

function typed(name) {
  const text = field(name).value.trim(), value = Number(text);
  if (text === "" || !isFinite(value)) throw new InputError(name, text || "nothing", "a number");
  const ranges = DATA.quantities[RANGED[name] ?? name];
  return ranges && !(name === "speed_rpm" && value === 0) ? requireQuantity(name, value, ranges) : value;
}

// In SI.
const given = name => typed(name) * (SIZE[field(name).dataset.unit] ?? 1);

function positive(name, least = "> 0") {
  const value = given(name);
  if (value > 0 || (least === ">= 0" && value === 0)) return value;
  throw new InputError(name, typed(name), `a finite number ${least}`);
}

function requireFinite(name) {
  const value = given(name);
  if (isFinite(value)) return value;
  throw new InputError(name, typed(name), "a finite number");
}

// The bearing's name taken apart; null for dimensions of one's own, and for what is no name.
const isOwn = () => field("bearing").value.trim().toLowerCase() === OWN;
const named = () => (isOwn() ? null : designation(field("bearing").value));

// Dimensions of a name, in SI; undefined for those of one's own.
function catalogued() {
  const row = DATA.catalogue[named()?.name];
  return row && { ...row, conformity_inner: row.conformity, conformity_outer: row.conformity, contact_angle: row.contact_angle ?? 0 };
}

// Names bring their dimensions, classes their clearance and oils by grade their viscosity: shown where one's own would stand.
function fillIn() {
  const row = catalogued(), grade = field("grade").value;
  const text = (name, value) => { field(name).value = g(value / (SIZE[field(name).dataset.unit] ?? 1), 8); };
  if (row) for (const name of SIZES) text(name, row[name]);
  field("source").textContent = row ? `Dimensions: ${row.source}${row.sourced ? "." : "; measure yours."}` : "";
  field("read").textContent = readName();
  for (const name of SIZES) field(name).readOnly = Boolean(row);
  fillInClearance(row, text);
  for (const name of ["eta0", "alpha"]) field(name).readOnly = grade !== OWN;
  field("temperature").disabled = grade === OWN;
  if (grade === OWN) return;
  try {
    const oil = mineralOil(DATA.oil, grade, typed("temperature"));
    for (const name of ["eta0", "alpha"]) field(name).value = g(oil[name] / SIZE[field(name).dataset.unit], 4);
  } catch (error) {
    if (!(error instanceof InputError)) throw error;
    for (const name of ["eta0", "alpha"]) field(name).value = "";
  }
}

// The class of a name holds. Bearings with a contact angle, or whose bore is not known, have no class and an empty entry.
function fillInClearance(row, text) {
  const classes = row?.classes ?? {}, select = field("clearance_class"), play = field("clearance"), fixed = row && named().clearance;
  const none = Object.keys(classes).length === 0, angular = Number(field("contact_angle").value) > 0;
  if (!select.disabled) select.dataset.chosen = select.value;
  if (!play.disabled && !play.readOnly) play.dataset.chosen = play.value;
  select.disabled = none || Boolean(fixed);
  select.value = none ? "" : fixed && classes[fixed] !== undefined ? fixed : select.dataset.chosen ?? select.dataset.first;
  play.disabled = angular;
  play.readOnly = classes[select.value] !== undefined;
  if (angular) play.value = "";
  else if (play.readOnly) text("clearance", classes[select.value]);
  else if (play.value === "") play.value = play.dataset.chosen ?? play.dataset.first;
}

// How a name with suffixes was read, and what of it is not in the torque.
function readName() {
  const read = named();
  if (read === null || read.suffixes.length === 0) return "As printed on the bearing, with suffixes as in 6205-2RS/C3; own: dimensions below.";
  return `Read as ${read.name}; ${wordsOf(read)}.`;
}

// A name of the list, or own dimensions; the class of clearance in it is one that the bearing has.
function requireName(sizes) {
  const typed = field("bearing").value.trim();
  if (!sizes && !isOwn()) throw new InputError("bearing", typed || "nothing", allowedNames(typed));
  const fixed = sizes?.contact_angle === 0 && named().clearance, classes = sizes?.classes ?? {};
  if (!fixed || classes[fixed] !== undefined) return;
  const names = Object.keys(classes).join(", ");
  throw new InputError("bearing", typed, names ? `of a class of clearance: ${names}` : "without a class of clearance: classes need its bore, which is not known");
}

function compute() {
  const sizes = catalogued(), grade = field("grade").value, bearing = { name: named()?.name ?? OWN };
  requireName(sizes);
  for (const size of SIZES) bearing[size] = sizes ? sizes[size] : given(size);
  bearing.clearance = bearing.contact_angle > 0 ? 0 : given("clearance");
  const oil = grade === OWN ? { eta0: given("eta0"), alpha: given("alpha") } : mineralOil(DATA.oil, grade, typed("temperature"));
  const rq = positive("rq"), ratio = positive("ratio", ">= 0"), slip = 0.01 * typed("slip");
  const whole = new Bearing(bearing, oil, atlas), rpm = typed("speed_rpm"), load = positive("load", ">= 0");
  const axial = requireFinite("axial_load") + positive("preload", ">= 0");
  const there = whole.under(axial === 0 ? [0, -load] : [0, -load, axial], rpm), { heaviest } = there, films = there.films[heaviest];
  const highest = Math.min(...films.map(({ point }) => atlas.highest_omega / (2 * Math.PI * point.time)));
  const hz = field("hz").value.trim() === "" ? rpm / 60 : positive("hz", ">= 0");
  if (hz > highest) throw new InputError("hz", hz, `at most ${g(highest, 4)}: there the atlas ends for the film's memory`);
  const low = Math.min(1, rpm / 600), hzs = Array.from({ length: FREQUENCIES }, (_, i) => low * (highest / low) ** (i / (FREQUENCIES - 1)));
  const balls = there.balls, torque = there.torque, life = ratingLife(there, rq), orders = whole.withSlip(there.orders, slip);
  const outside = [outsideAssumptions(there), beyondData(there), sentence(there.frictionNote)].filter(Boolean).join(" ");
  const rows = there.coefficients([0, hz, ...hzs].map(one => 2 * Math.PI * one));
  const contacts = films.map(film => film.answer && contact(film)), ways = Object.keys(WAYS).filter(way => WAYS[way] < rows[0].stiffness.length);
  const worst = balls.flatMap((_, k) => RACES.map((_, i) => [k, i]))
    .reduce((best, next) => (there.films[next[0]][next[1]].h_min < there.films[best[0]][best[1]].h_min ? next : best));
  return { whole, there, balls, heaviest, worst, films, outside, orders, torque, life, axial, slip, rpm, load, rq, ratio, hz, hzs, contacts, ways,
    still: rows[0], at: rows[1], over: rows.slice(2) };
}

const sentence = text => (text ? `${text[0].toUpperCase()}${text.slice(1)}.` : "");

// K and C of one film in SI, with their bars: hz => { K: [value, bar], C: [value, bar] }.
function contact({ answer, point: { force, length, time } }) {
  const K = atlas.over(answer.stiffness, answer.error.stiffness), C = atlas.over(answer.damping, answer.error.damping);
  const unit = force / length, si = (pair, size) => pair.map(value => value * size);
  return hz => ({ K: si(K(2 * Math.PI * hz * time), unit), C: si(C(2 * Math.PI * hz * time), unit * time) });
}

// With its error bar, which has two figures, and as many decimals.
function give(value, bar, size = 1) {
  const decimals = 1 - Math.floor(Math.log10(bar * size));
  return decimals >= 0 && decimals < 5 ? [value, bar].map(one => (one * size).toFixed(decimals)).join(" ± ")
    : `${show(value * size)} ± ${show(bar * size, 2)}`;
}

function filmRows({ there, heaviest, films, rq }) {
  const ball = there.balls[heaviest];
  const [inner, outer] = films.map(({ answer, point, pressure, h_central, h_min }, i) => {
    const carried = [show(ball.force[i], 4), show(pressure * 1e-9), show(ball.angle[i] * 180 / Math.PI)];
    if (!answer) return [...carried, show(h_central * 1e6), show(h_min * 1e6), show(h_min / rq)];
    const { h_central: central, h_min: least } = answer.error, length = point.length;
    return [...carried, give(h_central, central * length, 1e6), give(h_min, least * length, 1e6), give(h_min, least * length, 1 / rq)];
  });
  const names = ["load [N]", "Hertz pressure [GPa]", "contact angle [°]", "film in the centre [µm]", "smallest film [µm]", "lambda ratio"];
  return names.map((name, i) => [name, inner[i], outer[i]]);
}

const IN_WORDS = { along: "along the radial load", across: "across it", axial: "along the shaft" };

// K [N/m], C [N s/m] of a direction.
const entry = (row, way) => ({ K: row.stiffness[WAYS[way]][WAYS[way]], C: row.damping[WAYS[way]][WAYS[way]] });

function frequencyRows({ contacts, hz, at, still, ratio, ways }) {
  const rows = contacts.map((one, i) => {
    const name = `contact of the most loaded ball, ${RACES[i]} race`;
    if (!one) return [name, "–", "–"];
    const { K, C } = one(hz);
    return [name, give(...K, 1e-6), give(...C)];
  });
  for (const way of ways) rows.push([`whole bearing, ${IN_WORDS[way]}`, show(entry(at, way).K * 1e-6), show(entry(at, way).C)]);
  const { K } = entry(still, "along");
  rows.push([`guessed for it: c = ${show(ratio)} s × k`, show(K * 1e-6), show(ratio * K)]);
  return rows;
}

// What is asked first: rows of name, value, and what belongs to it.
function tiles(f) {
  const [k, i] = f.worst, lambda = f.there.films[k][i].h_min / f.rq, { smooth, mixed } = DATA.lambda, ball = f.balls[f.heaviest];
  const touching = lambda >= smooth ? "" : lambda >= mixed ? "; mixed: asperities touch" : "; boundary: asperities touch all the time";
  const pressed = f.balls.filter(({ approach }) => approach[0] + approach[1] > 0).length;
  const K = f.ways.map(way => show(entry(f.at, way).K * 1e-6)), C = f.ways.map(way => show(entry(f.at, way).C));
  const others = f.ways.slice(1).map((way, j) => `${IN_WORDS[way]} ${K[j + 1]} and ${C[j + 1]}`).join(", ");
  const { rolling, sliding, skf } = f.torque, relies = skf !== null && f.rpm > DATA.rules.RELY_ON_SKF, torque = relies ? skf : rolling + sliding;
  const films = `rolling ${show(rolling * 1e3)}, sliding ${show(sliding * 1e3)} N mm`, hz = name => show(f.orders[name] * f.rpm / 60, 4);
  const doubt = !relies && f.rpm > DATA.rules.RELY_ON_SKF ? `; ${DATA.rules.ABOVE_MEASURED}` : "";
  const parts = relies ? `by SKF's model; films alone: ${films}` : `${films}${skf === null ? "" : `; SKF's model ${show(skf * 1e3)} N mm`}${doubt}`;
  const angles = f.axial === 0 ? "" : `; contact angle ${ball.angle.map(angle => show(Math.abs(angle) * 180 / Math.PI)).join("° and ")}°`;
  return [
    ["Smallest film", `${show(f.there.films[k][i].h_min * 1e6)} µm, lambda ${show(lambda)}`, `${RACES[i]} race, ball at ${degrees(f, k)}°${touching}`],
    ["Largest ball load", `${show(ball.force[0])} N, ${show(Math.max(...f.films.map(film => film.pressure)) * 1e-9)} GPa`,
      `${pressed} of ${f.balls.length} balls are pressed by both rings${angles}`],
    [`K and C at ${show(f.hz, 4)} Hz`, `${K[0]} N/µm, ${C[0]} N s/m`, `${IN_WORDS.along}; ${others}`],
    ["Friction torque", `${show(torque * 1e3)} N mm, ${show(torque * f.rpm * Math.PI / 30)} W`, `${parts}; without seals`],
    ["Rating life", `${show(f.life.hours)} h`, `basic, 90 %: ${show(f.life.turns)} million turns; viscosity ratio ${show(f.life.kappa)} by nu/nu1, `
      + `${show(f.life.film)} by the film; static safety ${show(f.life.safety)}; C ${show(f.life.rating * 1e-3)} kN ${f.life.printed ? "as NSK prints it" : "from the geometry"}`],
    ["Defect frequencies", `BPFO ${hz("BPFO")} Hz, BPFI ${hz("BPFI")} Hz`,
      `FTF ${hz("FTF")}, BSF ${hz("BSF")} Hz`],
  ];
}

function drawAll(f) {
  const x = { low: f.hzs[0], high: f.hzs.at(-1), label: "frequency of the vibration [Hz]" };
  const put = (id, label, unit, log, series, bands) => {
    const values = [...series.flatMap(one => one.points.map(p => p[1])), ...bands.flatMap(one => one.points.flatMap(p => p.slice(1)))];
    const box = field(id), y = { ...range(values, log), label: unit };
    box.innerHTML = curves(box.clientWidth || 560, { x, y, series, bands, mark: f.hz, label });
  };
  for (const [letter, id, unit, size, log] of [["K", "contact_k", "N/µm", 1e-6, false], ["C", "contact_c", "N s/m", 1, true]]) {
    const series = [], bands = [];
    f.contacts.forEach((one, i) => {
      if (!one) return;
      const values = f.hzs.map(hz => [hz, ...one(hz)[letter].map(v => v * size)]);
      series.push({ points: values, kind: RACES[i] });
      bands.push({ points: values.map(([hz, v, bar]) => [hz, v - bar, v + bar]), kind: RACES[i] });
    });
    const what = letter === "K" ? "Stiffness" : "Damping";
    const label = `${what} of the contacts of the most loaded ball over frequency, with error bars`;
    if (series.length) put(id, label, unit, log, series, bands);
    else field(id).innerHTML = "<p>Lighter than any contact of the atlas: the bodies are as good as rigid there.</p>";
  }
  const curve = (letter, size) => f.ways.map(way => ({ points: f.over.map((row, i) => [f.hzs[i], entry(row, way)[letter] * size]), kind: way }));
  const { K } = entry(f.still, "along"), level = c => f.hzs.map(hz => [hz, c * K]);
  put("bearing_k", "Stiffness of the whole bearing over frequency, along and across the load and along the shaft", "N/µm", false, curve("K", 1e-6), []);
  put("bearing_c", "Damping of the whole bearing over frequency, along and across the load and along the shaft, and as guessed", "N s/m", true,
    [...curve("C", 1), { points: level(f.ratio), kind: "guess" }],
    [{ points: f.hzs.map(hz => [hz, USUAL[0] * K, USUAL[1] * K]), kind: "guess" }]);
  const { ball_diameter, pitch_diameter } = f.whole, zone = field("zone"), ahead = f.load > 0 || f.axial === 0;
  const label = `Balls between the rings: ${f.balls.map((ball, k) => `${show(ball.force[0])} N at ${degrees(f, k)}°`).join(", ")}`;
  zone.innerHTML = loadZone(zone.clientWidth || 340, f.balls, { ball: ball_diameter / 2, pitch: pitch_diameter / 2 }, label, ahead);
}

const degrees = (f, k) => show(360 * k / f.whole.balls, 4);

function tables(f) {
  field("tiles").innerHTML = tiles(f).map(([name, value, more]) => `<div class="tile"><h2>${name}</h2><p class="value">${value.split(", ").map(part => `<span>${part}</span>`).join(", ")}</p><p class="note">${more}</p></div>`).join("");
  field("outside").textContent = f.outside;
  field("outside").hidden = f.outside === "";
  field("python").textContent = inPython(f);
  field("films").innerHTML = table(`Heaviest ball, at ${degrees(f, f.heaviest)}°`, ["", "inner race", "outer race"], filmRows(f));
  field("at").innerHTML = table(`At ${show(f.hz, 4)} Hz`, ["", "stiffness [N/µm]", "damping [N s/m]"], frequencyRows(f));
  const defects = Object.entries(f.orders).map(([name, order]) => [`${name}, ${DEFECTS[name]}`, show(order * f.rpm / 60, 4), show(order, 5)]);
  field("defects").innerHTML = table(`Defect frequencies${f.slip === 0 ? "" : ` with ${show(100 * f.slip)} % slip of the cage`}`, ["", "Hz", "per turn"], defects);
  const balls = f.balls.map((ball, k) => [`${degrees(f, k)}°`, ...ball.force.map(one => show(one)), ...ball.angle.map(one => show(one * 180 / Math.PI)),
    ...f.there.films[k].map(film => show(film.h_min * 1e6)), show(Math.min(...f.there.films[k].map(film => film.h_min)) / f.rq)]);
  const heads = ["ball", "inner [N]", "outer [N]", "angle inner [°]", "outer [°]", "film inner [µm]", "outer [µm]", "lambda"];
  field("balls_table").innerHTML = table("All balls, by the angle from the radial load", heads, balls);
  const every = Math.ceil(FREQUENCIES / SHOWN);
  const rows = f.hzs.map((hz, i) => [i, hz]).filter(([i]) => i % every === 0).map(([i, hz]) => {
    const contacts = f.contacts.flatMap(one => (one ? [give(...one(hz).K, 1e-6), give(...one(hz).C)] : ["–", "–"]));
    return [show(hz), ...contacts, ...f.ways.flatMap(way => [show(entry(f.over[i], way).K * 1e-6), show(entry(f.over[i], way).C)])];
  });
  const head = ["Hz", "K inner", "C inner", "K outer", "C outer", ...f.ways.flatMap(way => [`K ${way}`, `C ${way}`])];
  field("frequencies_table").innerHTML = table("K [N/µm] and C [N s/m] over frequency", head, rows);
}

// The case as a call of the library.
function inPython({ axial }) {
  const own = isOwn(), name = named()?.name, m = id => `${show(given(id), 8)}`, angular = given("contact_angle") > 0;
  const oil = field("grade").value === OWN ? `Lubricant(eta0=${m("eta0")}, alpha=${m("alpha")})`
    : `Lubricant.iso_vg(${field("grade").value}, temperature=${m("temperature")})`;
  const sizes = own ? SIZES.filter(id => id !== "contact_angle" || angular).map(id => `${id}=${m(id)}`) : [];
  const chosen = field("clearance_class").value;
  if (!angular && (chosen !== "" && chosen !== OWN)) sizes.push(`clearance="${chosen}"`);
  else if (!angular && given("clearance") !== 0) sizes.push(`clearance=${m("clearance")}`);
  const inside = [...(own ? [] : [`"${name}"`]), ...sizes, `rq_race=${m("rq")}`, `oil=${oil}`].join(", ");
  const load = [0, `-${m("load")}`, ...(axial === 0 ? [] : [show(axial, 8)])].join(", ");
  return `BallBearing${own ? "" : ".catalogue"}(${inside}).equilibrium((${load}), speed_rpm=${m("speed_rpm")})`;
}

function refuse(error) {
  const input = field(error.field) ?? field({ iso_vg: "grade" }[error.field]), known = error instanceof InputError;
  field("refusal").hidden = false;
  const name = input ? input.labels[0].firstChild.textContent.trim() : error.field;
  const unit = input?.dataset.unit, value = input && input.value !== "" ? `${input.value}${unit ? ` ${unit}` : ""}` : error.value;
  field("refusal").textContent = known ? `${name} = ${value}: must be ${error.allowed}.` : String(error.message);
  if (input) {
    input.setAttribute("aria-invalid", "true");
    input.setAttribute("aria-describedby", "refusal");
    if (input.closest("details")) input.closest("details").open = true;
  }
}

function update() {
  for (const input of document.querySelectorAll("[aria-invalid]")) ["aria-invalid", "aria-describedby"].forEach(name => input.removeAttribute(name));
  fillIn();
  try {
    current = compute();
    field("refusal").hidden = true;
    for (const name of ["tiles", "results"]) field(name).hidden = false;
    tables(current);
    drawAll(current);
  } catch (error) {
    current = null;
    for (const name of ["tiles", "outside", "results"]) field(name).hidden = true;
    refuse(error);
  }
}

// What is not as the page begins, and not filled in by a name or a grade.
function toAddress() {
  const entries = new URLSearchParams();
  for (const name of FIELDS) {
    const input = field(name);
    if (!input.readOnly && !input.disabled && input.value !== field(name).dataset.first) entries.set(name, input.value);
  }
  history.replaceState(null, "", `#${entries}`);
}

function fromAddress() {
  const entries = new URLSearchParams(location.hash.slice(1) || location.search), said = [];
  if (entries.has("clearance") && !entries.has("clearance_class")) entries.set("clearance_class", OWN);
  for (const name of FIELDS) {
    field(name).value = entries.get(name) ?? field(name).dataset.first;
    field(name).disabled = field(name).readOnly = false;
  }
  if (!named() && !isOwn()) {
    said.push(`bearing = ${entries.get("bearing")} is not in its list, and ${field("bearing").dataset.first} is shown.`);
    field("bearing").value = field("bearing").dataset.first;
  }
  for (const name of ["clearance_class", "grade"]) {
    if (field(name).value) continue;
    field(name).value = field(name).dataset.first;
    said.push(`${name} = ${entries.get(name)} is not in its list, and ${field(name).dataset.first} is shown.`);
  }
  const unknown = [...entries.keys()].filter(name => !FIELDS.includes(name));
  if (unknown.length > 0) said.push(`${unknown.join(", ")}: no input of this page. Its inputs are ${FIELDS.join(", ")}.`);
  field("address").textContent = said.length > 0 ? `In the address: ${said.join(" ")}` : "";
  field("address").hidden = said.length === 0;
  update();
}

function begin() {
  const options = (name, values) => { field(name).innerHTML = values.map(([value, text]) => `<option value="${value}">${text}</option>`).join(""); };
  options("bearings", [...Object.keys(DATA.catalogue).map(name => [name, ""]), [OWN, "dimensions below"]]);
  options("clearance_class", [...DATA.classes.map(name => [name, name]), [OWN, "as given"]]);
  options("grade", [...Object.keys(DATA.oil.walther_slopes).map(grade => [grade, `ISO VG ${grade}`]), [OWN, "own viscosity"]]);
  for (const name of FIELDS) field(name).dataset.first = field(name).dataset.first ?? field(name).value;
  let waiting = 0;
  field("inputs").addEventListener("input", ({ target }) => {
    clearTimeout(waiting);
    if (target === field("bearing") && !named() && !isOwn()) return; // a name that is being typed
    waiting = setTimeout(() => { update(); toAddress(); }, 150);
  });
  field("bearing").addEventListener("change", () => { update(); toAddress(); });
  field("bearing").addEventListener("focus", () => field("bearing").select());
  field("inputs").addEventListener("submit", event => { event.preventDefault(); update(); toAddress(); });
  field("copy").addEventListener("click", () => {
    toAddress();
    navigator.clipboard?.writeText(location.href).then(() => { field("copied").textContent = "Copied."; }, () => {});
  });
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width && current) { width = innerWidth; drawAll(current); } });
  addEventListener("hashchange", fromAddress);
  fromAddress();
}

begin();
