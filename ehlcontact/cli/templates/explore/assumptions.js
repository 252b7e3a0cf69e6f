// What does not hold of the assumptions of films: ehlcontact.assumptions, at the heaviest contacts of a bearing.

const { CONDUCTIVITY, LEAST_HEATING_FACTOR, EYRING_STRESS, LARGEST_STRESS } = DATA.rules;
const { TYPICAL_SLOPE, TYPICAL_DENSITY, LEAST_SLOPE } = DATA.rules;

// -d ln(eta)/dT [1/K] of an oil, and of one of which only the viscosity is known.
function temperatureSlope({ eta0, temperature_slope }) {
  const typical = TYPICAL_SLOPE * Math.log(eta0 / TYPICAL_DENSITY * 1e6 + DATA.oil.shift);
  return temperature_slope ?? Math.max(typical, LEAST_SLOPE);
}

// Film over the isothermal one: gupta_heating and wilson_heating of ehlcontact.film_formulas.
function guptaHeating(load, pressure) {
  return Math.max((1 - 13.2 * pressure * load ** 0.42) / (1 + 0.213 * load ** 0.64), 0);
}

const wilsonHeating = load => 1 / (1 + 0.1 * (4 * load) ** 0.64);
const shareText = share => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`;

function thermalLoad(race, point, oil) {
  const u = race.hertz(point.force).a / point.time;
  return temperatureSlope(oil) * oil.eta0 * u * u / CONDUCTIVITY;
}

// Assumptions of a contact: how far beyond its limit, relative, and what it says.
function assumptions({ race, point }) {
  const { eta0 } = race.oil, { a } = race.hertz(point.force), u = a / point.time;
  const pressure = 1.5 * point.force * race.kappa / (Math.PI * a * a), film = race.atlas.at(point).h_central * point.length;
  const heat = thermalLoad(race, point, race.oil), left = guptaHeating(heat, pressure / race.eReduced);
  const stress = 1.5 * (point.L > 0 ? Math.E : 1) * eta0 * u / film;
  const heated = `shear heats the inlet: film ${shareText(1 - left)} thinner, ${shareText(1 - wilsonHeating(heat))} by Wilson and Sheu`;
  return [
    ["isothermal", (LEAST_HEATING_FACTOR - left) / LEAST_HEATING_FACTOR, heated],
    ["newtonian", (stress / EYRING_STRESS - LARGEST_STRESS) / LARGEST_STRESS, `rolling shears the inlet by ${g(stress * 1e-6, 2)} MPa`],
  ];
}

// The ball with the largest force at a race.
const heaviest = (loaded, i) => loaded.balls.reduce((best, ball, k) => (ball.force[i] > loaded.balls[best].force[i] ? k : best), 0);

// Loads below those of the atlas at the most loaded contacts, in words: reduced_models.bearing.race.beyond_data.
function beyondData(loaded) {
  const said = RACES.flatMap((name, i) => {
    const k = heaviest(loaded, i), { race } = loaded.films[k][i], force = loaded.balls[k].force[i], [lightest] = race.loads(loaded.rpm);
    return force < lightest ? [`${g(force, 3)} N on the ${name} race, the atlas begins at ${g(lightest, 3)} N`] : [];
  });
  return said.length ? `Beyond the data: no ball carries more than ${said.join(" and ")}.` : "";
}

// What does not hold at the most loaded contacts of both races, the worse of them; empty where all does.
function outsideAssumptions(loaded) {
  const [inner, outer] = RACES.map((_, i) => assumptions(loaded.films[heaviest(loaded, i)][i]));
  const worst = inner.map((one, k) => (outer[k][1] > one[1] ? outer[k] : one)).filter(one => one[1] > 0);
  return worst.length ? `Outside what is assumed: ${worst.map(([name, , text]) => `${name} (${text})`).join("; ")}.` : "";
}
