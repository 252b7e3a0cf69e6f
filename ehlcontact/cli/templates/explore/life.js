// Basic reference rating life of a loaded bearing, ratings and viscosity ratios: reduced_models.life. Ratings are those of the catalogue
// where it has these balls, else those of the geometry.

const { MATERIAL, RATING_CONSTANT, REDUCTION, RATED_GROOVE, LARGE_BALL, LARGE_FACTOR, TURNING, STANDING, RACE_POWER, SLOPE,
  PER_HOUR, SLOW, FILM_POWER } = DATA.rules;

// Rated load of the inner race over that of the outer one, the constant of ISO 281 or of ISO/TS 16281.
function strengthRatio(gamma, fi, fo, constant) {
  return constant * ((1 - gamma) / (1 + gamma)) ** 1.72 * (fi / fo * (2 * fo - 1) / (2 * fi - 1)) ** 0.41;
}

function dynamicRating({ balls, ball_diameter, pitch_diameter, conformity_inner, conformity_outer, contact_angle }) {
  const [fi, fo] = [conformity_inner, conformity_outer].map(one => Math.max(one, RATED_GROOVE)), D = 1e3 * ball_diameter;
  const gamma = ball_diameter * Math.cos(contact_angle) / pitch_diameter;
  const fc = RATING_CONSTANT * REDUCTION * (1 + strengthRatio(gamma, fi, fo, 1.04) ** (10 / 3)) ** -0.3
    * gamma ** 0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3) * (2 * fi / (2 * fi - 1)) ** 0.41;
  const size = D <= LARGE_BALL ? D ** 1.8 : LARGE_FACTOR * D ** 1.4;
  return MATERIAL * fc * Math.cos(contact_angle) ** 0.7 * balls ** (2 / 3) * size;
}

// C [N], life in million turns and hours, viscosity ratio of the oil and of the film over a roughness [m], static safety by pressure.
function ratingLife(there, rq) {
  const { bearing, balls, rpm, films, heaviest } = there, row = DATA.catalogue[bearing.name];
  const printed = row?.ratings && ["balls", "ball_diameter", "pitch_diameter"].every(name => Math.abs(row[name] / bearing[name] - 1) < 1e-6)
    && Math.abs((row.contact_angle ?? 0) - bearing.contact_angle) < 1e-6;
  const rating = printed ? row.ratings[0] : dynamicRating(bearing), angle = bearing.contact_angle;
  const gamma = bearing.ball_diameter * Math.cos(angle) / bearing.pitch_diameter, dm = 1e3 * bearing.pitch_diameter;
  const ratio = strengthRatio(gamma, bearing.conformity_inner, bearing.conformity_outer, 1.044);
  const share = rating / (bearing.balls * Math.cos(angle) ** 0.7);
  const rated = [share / 0.407 * (1 + ratio ** (10 / 3)) ** 0.3, share / 0.389 * (1 + ratio ** (-10 / 3)) ** 0.3];
  const mean = (i, power) => (balls.reduce((sum, { force }) => sum + Math.max(force[i], 0) ** power, 0) / balls.length) ** (1 / power);
  const loads = [mean(0, TURNING), mean(1, STANDING)];
  const turns = loads.reduce((sum, load, i) => sum + (load / rated[i]) ** RACE_POWER, 0) ** (-1 / SLOPE);
  const needed = dm ** -0.5 * (rpm < SLOW ? 45000 * rpm ** -0.83 : 4500 * rpm ** -0.5);
  const lambda = Math.min(...films[heaviest].map(film => film.h_min)) / rq;
  const pressure = Math.max(...bearing.races.map((race, i) => {
    const most = Math.max(...balls.map(({ force }) => force[i]));
    return most > 0 ? 1.5 * most * race.kappa / (Math.PI * race.hertz(most).a ** 2) : 0;
  }));
  return { rating, printed: Boolean(printed), turns, hours: turns / (PER_HOUR * rpm), kappa: kinematicViscosity(bearing.oil) / needed,
    film: lambda ** FILM_POWER, safety: (DATA.skf.pressure / pressure) ** 3 };
}
