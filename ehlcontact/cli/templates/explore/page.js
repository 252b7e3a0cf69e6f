// The page: what is typed to a bearing, what is found to tables and pictures, and all of it in the address.

const FIELDS = [...document.querySelectorAll("#inputs input, #inputs select")].map(input => input.name);
const SIZES = ["balls", "ball_diameter", "pitch_diameter", "conformity_inner", "conformity_outer"];
const OWN = "own", SIZE = { mm: 1e-3, "µm": 1e-6, "mPa s": 1e-3, "1/GPa": 1e-9 };
const RANGED = { conformity_inner: "conformity", conformity_outer: "conformity" }; // that share a range of inputs
const USUAL = [0.25e-5, 2.5e-5]; // s, damping over stiffness: Kraemer, Dynamics of Rotors and Foundations, 1993
const DEFECTS = { FTF: "cage", BPFO: "balls on the outer race", BPFI: "balls on the inner race", BSF: "spin of a ball" };
const FREQUENCIES = 90, SHOWN = 14; // of curves; of a table
const field = name => document.getElementById(name);
const atlas = new Atlas(DATA.atlas);
let found = null;

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

// Names bring their dimensions and oils by grade their viscosity: shown where one's own would stand.
function fillIn() {
  const bearing = DATA.catalogue[field("bearing").value], grade = field("grade").value;
  if (bearing) {
    const row = { ...bearing, conformity_inner: bearing.conformity, conformity_outer: bearing.conformity };
    for (const name of SIZES) field(name).value = g(row[name] / (SIZE[field(name).dataset.unit] ?? 1), 8);
    field("source").textContent = bearing.sourced ? `Dimensions: ${bearing.source}.` : `Dimensions: ${bearing.source}; measure yours.`;
  } else field("source").textContent = "";
  for (const name of SIZES) field(name).readOnly = Boolean(bearing);
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

function compute() {
  const name = field("bearing").value, row = DATA.catalogue[name], grade = field("grade").value;
  const sizes = row && { ...row, conformity_inner: row.conformity, conformity_outer: row.conformity };
  const bearing = { clearance: given("clearance") };
  for (const size of SIZES) bearing[size] = sizes ? sizes[size] : given(size);
  const oil = grade === OWN ? { eta0: given("eta0"), alpha: given("alpha") } : mineralOil(DATA.oil, grade, typed("temperature"));
  const rq = positive("rq"), ratio = positive("ratio", ">= 0");
  const whole = new Bearing(bearing, oil, atlas), rpm = typed("speed_rpm"), load = positive("load", ">= 0");
  const axial = positive("axial_load", ">= 0"), slip = 0.01 * typed("slip");
  const atSpeed = whole.speedState(rpm), state = whole.ringEquilibrium(atSpeed, load), films = state.balls.map(ball => whole.films(atSpeed, ball));
  const typedAngle = typed("contact_angle"), byAngle = { angle: typedAngle, orders: whole.orders(typedAngle, slip) };
  const { angle, orders } = axial > 0 ? whole.ordersUnder(atSpeed, load, axial, slip) : byAngle;
  const times = ["inner", "outer"].map((race, i) => whole.races[race].point(state.balls[0].force[i], rpm).time);
  const highest = Math.min(...times.map(time => atlas.highest_omega / (2 * Math.PI * time)));
  const hz = field("hz").value.trim() === "" ? rpm / 60 : positive("hz", ">= 0");
  if (hz > highest) throw new InputError("hz", hz, `at most ${g(highest, 4)}: there the atlas ends for the film's memory`);
  const low = Math.min(1, rpm / 600), hzs = Array.from({ length: FREQUENCIES }, (_, i) => low * (highest / low) ** (i / (FREQUENCIES - 1)));
  const rows = whole.coefficients(atSpeed, load, [0, hz, ...hzs].map(one => 2 * Math.PI * one));
  const contacts = films[0].map(film => film.answer && contact(film));
  const outside = outsideAssumptions(whole, atSpeed, state.balls);
  return { outside, whole, orders, angle, axial, slip, rpm, load, rq, ratio, state, films, hz, hzs, contacts, still: rows[0], there: rows[1], over: rows.slice(2) };
}

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

function filmRows({ state, films, rq }) {
  const [inner, outer] = films[0].map(({ answer, point, h_central, h_min }, i) => {
    const force = show(state.balls[0].force[i], 4);
    if (!answer) return [force, show(h_central * 1e6), show(h_min * 1e6), show(h_min / rq)];
    const { h_central: central, h_min: least } = answer.error, length = point.length;
    const films = [give(h_central, central * length, 1e6), give(h_min, least * length, 1e6)];
    return [force, ...films, give(h_min, least * length, 1 / rq)];
  });
  return ["load [N]", "film in the centre [µm]", "smallest film [µm]", "lambda ratio"].map((name, i) => [name, inner[i], outer[i]]);
}

function frequencyRows({ contacts, hz, there, still, ratio }) {
  const rows = contacts.map((one, i) => {
    const name = `contact of the most loaded ball, ${i ? "outer" : "inner"} race`;
    if (!one) return [name, "–", "–"];
    const { K, C } = one(hz);
    return [name, give(...K, 1e-6), give(...C)];
  });
  for (const way of ["along", "across"])
    rows.push([`whole bearing, ${way} the load`, show(there[way].stiffness * 1e-6), show(there[way].damping)]);
  const K = still.along.stiffness;
  rows.push([`guessed for it: c = ${show(ratio)} s × k`, show(K * 1e-6), show(ratio * K)]);
  return rows;
}

function headline({ state, films, rq, there, still, ratio, hz }) {
  const loaded = state.balls.filter(ball => ball.approach[0] + ball.approach[1] > 0).length;
  const lambda = Math.min(...films[0].map(film => film.h_min)) / rq, C = there.along.damping;
  const times = ratio * still.along.stiffness / C;
  const guess = times > 1 ? `${show(times, 2)} times that` : `${show(100 * times, 2)} % of that`;
  const { smooth, mixed } = DATA.lambda, rough = lambda >= mixed ? ", mixed: asperities touch" : ", boundary: asperities touch all the time";
  return `${loaded} of ${state.balls.length} balls are pressed by both rings. The heaviest carries ${show(state.balls[0].force[0])} N `
    + `on a film of at least ${show(lambda * rq * 1e6)} µm: lambda ${show(lambda)}${lambda >= smooth ? "" : rough}. Along the load the films of the bearing damp `
    + `${show(C)} N s/m at ${show(hz, 4)} Hz; the guess is ${guess}.`;
}

function drawAll(f) {
  const x = { low: f.hzs[0], high: f.hzs.at(-1), label: "frequency of the vibration [Hz]" };
  const ways = ["inner", "outer"], put = (id, label, unit, log, series, bands) => {
    const values = [...series.flatMap(one => one.points.map(p => p[1])), ...bands.flatMap(one => one.points.flatMap(p => p.slice(1)))];
    const box = field(id), y = { ...range(values, log), label: unit };
    box.innerHTML = curves(box.clientWidth || 560, { x, y, series, bands, mark: f.hz, label });
  };
  for (const [letter, id, unit, size, log] of [["K", "contact_k", "N/µm", 1e-6, false], ["C", "contact_c", "N s/m", 1, true]]) {
    const series = [], bands = [];
    f.contacts.forEach((one, i) => {
      if (!one) return;
      const values = f.hzs.map(hz => [hz, ...one(hz)[letter].map(v => v * size)]);
      series.push({ points: values, kind: ways[i] });
      bands.push({ points: values.map(([hz, v, bar]) => [hz, v - bar, v + bar]), kind: ways[i] });
    });
    const what = letter === "K" ? "Stiffness" : "Damping";
    const label = `${what} of the contacts of the most loaded ball over frequency, with error bars`;
    if (series.length) put(id, label, unit, log, series, bands);
    else field(id).innerHTML = "<p>Lighter than any contact of the atlas: the bodies are as good as rigid there.</p>";
  }
  const line = (name, way, size) => f.over.map((row, i) => [f.hzs[i], row[way][name] * size]);
  const both = (name, size) => ["along", "across"].map(way => ({ points: line(name, way, size), kind: way }));
  const K = f.still.along.stiffness, level = c => f.hzs.map(hz => [hz, c * K]);
  put("bearing_k", "Stiffness of the whole bearing over frequency, along and across the load", "N/µm", false, both("stiffness", 1e-6), []);
  put("bearing_c", "Damping of the whole bearing over frequency, along and across the load, and as guessed", "N s/m", true,
    [...both("damping", 1), { points: level(f.ratio), kind: "guess" }],
    [{ points: f.hzs.map(hz => [hz, USUAL[0] * K, USUAL[1] * K]), kind: "guess" }]);
  const { ball_diameter, pitch_diameter } = f.whole, zone = field("zone");
  const label = `Balls between the rings: ${f.state.balls.map((ball, k) => `${show(ball.force[0])} N at ${degrees(f, k)}°`).join(", ")}`;
  zone.innerHTML = loadZone(zone.clientWidth || 340, f.state.balls, { ball: ball_diameter / 2, pitch: pitch_diameter / 2 }, label);
}

const degrees = (f, k) => show(360 * k / f.whole.balls, 4);

function tables(f) {
  field("headline").textContent = headline(f);
  field("outside").textContent = f.outside;
  field("outside").hidden = f.outside === "";
  field("python").textContent = inPython();
  field("films").innerHTML = table("Most loaded ball, right under the load", ["", "inner race", "outer race"], filmRows(f));
  field("at").innerHTML = table(`At ${show(f.hz, 4)} Hz`, ["", "stiffness [N/µm]", "damping [N s/m]"], frequencyRows(f));
  const defects = Object.entries(f.orders).map(([name, order]) => [`${name}, ${DEFECTS[name]}`, show(order * f.rpm / 60, 4), show(order, 5)]);
  const under = f.axial > 0 ? `, under ${show(f.axial)} N of axial load, without which all else is computed` : "";
  const at = f.angle > 0 ? ` at a contact angle of ${show(f.angle)}°${under}` : "";
  field("defects").innerHTML = table(`Defect frequencies${f.slip === 0 ? "" : ` with ${show(100 * f.slip)} % slip of the cage`}${at}`, ["", "Hz", "per turn"], defects);
  const balls = f.state.balls.map((ball, k) => [`${degrees(f, k)}°`, ...ball.force.map(one => show(one)),
    ...f.films[k].map(film => show(film.h_min * 1e6)), show(Math.min(...f.films[k].map(film => film.h_min)) / f.rq)]);
  field("balls_table").innerHTML = table("All balls, from the load on", ["ball", "inner [N]", "outer [N]", "film inner [µm]", "outer [µm]", "lambda"], balls);
  const every = Math.ceil(FREQUENCIES / SHOWN);
  const rows = f.hzs.map((hz, i) => [i, hz]).filter(([i]) => i % every === 0).map(([i, hz]) => {
    const contacts = f.contacts.flatMap(one => (one ? [give(...one(hz).K, 1e-6), give(...one(hz).C)] : ["–", "–"]));
    const { along, across } = f.over[i];
    return [show(hz), ...contacts, show(along.stiffness * 1e-6), show(along.damping), show(across.stiffness * 1e-6), show(across.damping)];
  });
  const head = ["Hz", "K inner", "C inner", "K outer", "C outer", "K along", "C along", "K across", "C across"];
  field("frequencies_table").innerHTML = table("K [N/µm] and C [N s/m] over frequency", head, rows);
}

// The case as a call of the library.
function inPython() {
  const name = field("bearing").value, m = id => `${show(given(id), 8)}`, own = name === OWN;
  const oil = field("grade").value === OWN ? `Lubricant(eta0=${m("eta0")}, alpha=${m("alpha")})`
    : `Lubricant.iso_vg(${field("grade").value}, temperature=${m("temperature")})`;
  const sizes = [...(own ? SIZES : []), "clearance"].filter(id => own || given(id) !== 0).map(id => `${id}=${m(id)}`);
  const inside = [...(own ? [] : [`"${name}"`]), ...sizes, `rq_race=${m("rq")}`, `oil=${oil}`].join(", ");
  const call = `.equilibrium((0, -${m("load")}), speed_rpm=${m("speed_rpm")})`;
  return `BallBearing${own ? "" : ".catalogue"}(${inside})${call}`;
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
    found = compute();
    field("refusal").hidden = true;
    field("results").hidden = false;
    tables(found);
    drawAll(found);
  } catch (error) {
    found = null;
    field("results").hidden = true;
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
  const entries = new URLSearchParams(location.hash.slice(1));
  for (const name of FIELDS) field(name).value = entries.get(name) ?? field(name).dataset.first;
  for (const name of ["bearing", "grade"]) if (!field(name).value) field(name).value = field(name).dataset.first;
  update();
}

function begin() {
  const options = (name, values) => { field(name).innerHTML = values.map(([value, text]) => `<option value="${value}">${text}</option>`).join(""); };
  options("bearing", [...Object.keys(DATA.catalogue).map(name => [name, name]), [OWN, "own dimensions"]]);
  options("grade", [...Object.keys(DATA.oil.walther_slopes).map(grade => [grade, `ISO VG ${grade}`]), [OWN, "own viscosity"]]);
  for (const name of FIELDS) field(name).dataset.first = field(name).dataset.first ?? field(name).value;
  let waiting = 0;
  field("inputs").addEventListener("input", () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => { update(); toAddress(); }, 150);
  });
  field("inputs").addEventListener("submit", event => { event.preventDefault(); update(); toAddress(); });
  field("copy").addEventListener("click", () => {
    toAddress();
    navigator.clipboard?.writeText(location.href).then(() => { field("copied").textContent = "Copied."; }, () => {});
  });
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width && found) { width = innerWidth; drawAll(found); } });
  addEventListener("hashchange", fromAddress);
  fromAddress();
}

begin();
