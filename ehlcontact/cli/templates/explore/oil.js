// Mineral oils by grade and temperature: ehlcontact.lubricant.oil, at the index and the density of `data`.

function mineralOil(data, grade, temperature) {
  const slope = data.walther_slopes[grade];
  if (slope === undefined) throw new InputError("iso_vg", grade, `one of ${Object.keys(data.walther_slopes).join(", ")}`);
  const [coldest, hottest] = data.temperatures;
  if (!(coldest <= temperature && temperature <= hottest)) {
    const inC = temperature - data.kelvin, kelvin = coldest <= inC && inC <= hottest;
    const hint = kelvin ? " (degrees Celsius; given in K?)" : " degrees Celsius";
    throw new InputError("temperature", temperature, `between ${g(coldest)} and ${g(hottest)}${hint}`);
  }
  const line = Math.log10(Math.log10(Number(grade) + data.shift))
    - slope * Math.log10((temperature + data.kelvin) / (40 + data.kelvin));
  const nu = 10 ** 10 ** line - data.shift;
  if (nu < data.thinnest) {
    const allowed = `one with at least ${g(data.thinnest)} mm2/s (ASTM D341); this oil has ${nu.toFixed(2)}`;
    throw new InputError("temperature", temperature, allowed);
  }
  const x = data.expansion / data.density_15 * (temperature - 15);
  const rho0 = data.density_15 * Math.exp(-x * (1 + 0.8 * x)), eta0 = nu * 1e-6 * rho0;
  // alpha such that Roelands' law passes through Gold's viscosity at 200 MPa
  const q = Math.log(eta0) + data.roelands_log, secant = data.gold_s * nu ** data.gold_t;
  const z = Math.log1p(secant * data.gold_pressure / q) / Math.log1p(data.gold_pressure / data.roelands_p0);
  // -d ln(eta0)/dT: of Walther's line, and of the density
  const shifted = nu + data.shift, ofDensity = data.expansion / data.density_15 * (1 + 1.6 * x);
  const temperature_slope = slope * shifted * Math.log(shifted) / (nu * (temperature + data.kelvin)) + ofDensity;
  return { eta0, alpha: z * q / data.roelands_p0, temperature_slope, rho0 };
}

// Kinematic viscosity of an oil [mm2/s]; of one known by eta0 alone with the usual density.
function kinematicViscosity({ eta0, rho0 }) {
  return 1e6 * eta0 / (rho0 ?? DATA.oil.usual_density);
}

// Secant of Roelands' ln(eta) from ambient pressure to where alpha p = `end`, over its slope there.
function secantOverSlope(alpha, eta0, end) {
  const { roelands_log, roelands_p0 } = DATA.oil, q = Math.log(eta0) + roelands_log;
  return q * Math.expm1(alpha * roelands_p0 / q * Math.log1p(end / (alpha * roelands_p0))) / end;
}
