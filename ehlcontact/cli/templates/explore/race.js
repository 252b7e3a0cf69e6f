// One race and its contacts with balls: reduced_models.bearing.race, and nodes of its static curve over the load, with the
// gains of its film memory, as `bearing.c` takes them (reduced_models.elements.film_curve).

const { INSIDE, PER_DECADE, NEAR, DECADE, RIGID_SLOPE, DRY, LEAST_VISCOUS, STEEPEST } = DATA.rules;

class Race {
  // At a contact angle [rad]; `rolling` is the sum of both surface speeds over the speed of the shaft [m].
  constructor(name, bearing, atlas, angle = bearing.contact_angle, rolling = null) {
    const { ball_diameter: D, oil } = bearing, cone = bearing.pitch_diameter / Math.cos(Math.min(Math.abs(angle), STEEPEST)), gamma = D / cone;
    const conformity = bearing[`conformity_${name}`];
    const along = name === "inner" ? 2 / D + 2 / (cone - D) : 2 / D - 2 / (cone + D);
    const { youngs_modulus: E, poisson_ratio: nu } = atlas.steel;
    Object.assign(this, { name, atlas, oil, D, conformity, radiusX: 1 / along, radiusY: 1 / (2 / D - 1 / (conformity * D)) });
    this.eReduced = E / (1 - nu * nu);
    this.kappa = ellipseRatio(this.radiusX, this.radiusY);
    this.rolling = rolling ?? 0.5 * bearing.pitch_diameter * (1 - gamma * gamma);
    this.length = this.hertz(1).approach; // m, of the dry contact under 1 N
    this.kn = this.length ** -1.5; // N/m^1.5
  }

  hertz(load) {
    return hertzContact(load, this.radiusX, this.radiusY, this.eReduced, this.kappa);
  }

  // Operating point under a load [N] at a speed of the shaft [rev/min], with its units in SI.
  point(load, rpm) {
    const uSum = this.rolling * rpm * Math.PI / 30, { eta0, alpha } = this.oil, { a, approach } = this.hertz(load);
    const U = eta0 * uSum / (this.eReduced * this.radiusX);
    const M = load / (this.eReduced * this.radiusX ** 2) * U ** -0.75, L = alpha * this.eReduced * U ** 0.25;
    return { M, L, kappa: this.kappa, alpha, eta0, force: load, length: approach, time: 2 * a / uSum };
  }

  get highestSpeed() {
    return (this.atlas.box.L[1] / this.point(1, 1).L) ** 4 * (1 - INSIDE);
  }

  // Lightest and heaviest load [N] of the atlas at a speed.
  loads(rpm) {
    const { box } = this.atlas, unit = this.point(1, rpm);
    const pressure = moesPressure(unit.M, unit.L, unit.kappa) / unit.alpha;
    const highest = Math.min(box.M[1] / unit.M, (box.p_hertz / pressure) ** 3);
    return [box.M[0] / unit.M * (1 + INSIDE), highest * (1 - INSIDE)];
  }

  requireInAtlas() {
    const [low, high] = this.atlas.box.kappa;
    if (!(low <= this.kappa && this.kappa <= high)) {
      const least = 1 / (2 - this.D * radiusRatio(low) / this.radiusX);
      const allowed = `at least ${least.toFixed(4)}: its ellipse, a/b = ${g(this.kappa, 4)}, lies outside the atlas (${g(low)} to ${g(high)})`;
      throw new InputError(`conformity_${this.name}`, this.conformity, allowed);
    }
    this.atlas.requireOil(this.oil);
  }

  // Static curve at a speed: rows ln F, ln h, slope and approach, in N and in the approach of the dry contact under 1 N; gains of
  // all nodes but the first, which stands for rigid bodies.
  curve(rpm) {
    const [low, high] = this.loads(rpm), end = PER_DECADE * Math.log10(high) - NEAR, loads = [low];
    for (let j = Math.ceil(PER_DECADE * Math.log10(low) + NEAR); j < Math.ceil(end); j++) loads.push(10 ** (j / PER_DECADE));
    const nodes = [...loads, high].map(load => {
      const point = this.point(load, rpm), { values, gains } = this.atlas.gainsAt(point);
      return { x: Math.log(load), y: Math.log((1 - values[0]) * point.length / this.length), gains: this.gains(gains, values[LOW]) };
    });
    const x = nodes.map(node => node.x), y = nodes.map(node => node.y), slope = pchipSlopes(x, y), last = x.length - 1;
    slope[last] = Math.min(slope[last], 0);
    x.unshift(x[0] - DECADE);
    y.unshift(y[0] - 0.5 * DECADE * (slope[0] + RIGID_SLOPE));
    slope.unshift(RIGID_SLOPE);
    const u = x.map((one, k) => Math.exp(2 / 3 * one) - Math.exp(y[k]));
    return { nodes: x.length, curve: [...x, ...y, ...slope, ...u], gains: nodes.flatMap(node => node.gains) };
  }

  // Gains of one load from those over its low-frequency damping: none below 0, and passive.
  gains(shares, low) {
    const gains = Array.from(shares, share => Math.max(share * low, 0));
    gains[0] = Math.max(gains[0], LEAST_VISCOUS / DRY * low);
    const least = leastDissipation(this.atlas.rates, gains);
    if (least < 0) gains[0] -= 1.001 * least;
    return gains;
  }
}

// 1, inlet, fast and chain of the film memory at an own frequency, weighed: [Re G, Im G] (elements.film_response).
function memory(rates, gains, own) {
  const lag = rate => { const w = own / rate, n = 1 + w * w; return [1 / n, -w / n]; };
  const [ir, ii] = lag(rates.inlet_rate), [fr, fi] = lag(rates.fast_rate), [cr, ci] = lag(rates.lag_rate);
  let re = 0, im = 0;
  for (let j = gains.length - 1; j >= 3; j--) { // sum of gain times lag^power, from the last
    const r = re + gains[j];
    [re, im] = [r * cr - im * ci, r * ci + im * cr];
  }
  re += gains[1];
  return [gains[0] + ir * re - ii * im + gains[2] * fr, ir * im + ii * re + gains[2] * fi];
}

// Smallest Re G over all frequencies: in steps, and by golden section about the smallest.
function leastDissipation(rates, gains) {
  const STEPS = 400, shrink = (Math.sqrt(5) - 1) / 2;
  const at = s => memory(rates, gains, rates.lag_rate * Math.tan(Math.min(s, 1 - 1e-9) * Math.PI / 2))[0];
  let best = 0, least = Infinity;
  for (let j = 0; j <= STEPS; j++) {
    const value = at(j / STEPS);
    if (value < least) [best, least] = [j / STEPS, value];
  }
  let low = Math.max(best - 1 / STEPS, 0), high = Math.min(best + 1 / STEPS, 1);
  for (let j = 0; j < 40; j++) {
    const a = high - shrink * (high - low), b = low + shrink * (high - low);
    if (at(a) < at(b)) high = b; else low = a;
  }
  return Math.min(least, at(low));
}

// Slopes at the nodes of the monotone cubics of Fritsch and Butland (scipy's PchipInterpolator).
function pchipSlopes(x, y) {
  const h = x.slice(1).map((v, k) => v - x[k]), m = h.map((w, k) => (y[k + 1] - y[k]) / w), n = m.length;
  const edge = (h0, h1, m0, m1) => {
    const slope = ((2 * h0 + h1) * m0 - h0 * m1) / (h0 + h1);
    if (slope * m0 <= 0) return 0;
    return m0 * m1 < 0 && Math.abs(slope) > 3 * Math.abs(m0) ? 3 * m0 : slope;
  };
  const inside = m.slice(1).map((next, k) => {
    const a = 2 * h[k + 1] + h[k], b = h[k + 1] + 2 * h[k];
    return m[k] * next <= 0 ? 0 : (a + b) / (a / m[k] + b / next);
  });
  return [edge(h[0], h[1], m[0], m[1]), ...inside, edge(h[n - 1], h[n - 2], m[n - 1], m[n - 2])];
}
