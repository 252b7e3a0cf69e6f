// One race, and its contact with a ball at a speed, over any load: reduced_models.bearing.race and .race_table, with
// the film law of reduced_models.elements. Loads run as x = ln(F/N): approach and film follow from x outright.

const { INSIDE, PER_DECADE, NEAR, DECADE, RIGID_SLOPE, DRY, LEAST_VISCOUS, SMALL_OMEGA } = DATA.rules;

class Race {
  constructor(name, bearing, atlas) {
    const { ball_diameter: D, pitch_diameter: dm, oil } = bearing, gamma = D / dm;
    const conformity = bearing[`conformity_${name}`];
    const along = name === "inner" ? 2 / D + 2 / (dm - D) : 2 / D - 2 / (dm + D);
    const { youngs_modulus: E, poisson_ratio: nu } = atlas.steel;
    Object.assign(this, { name, atlas, oil, D, conformity, radiusX: 1 / along, radiusY: 1 / (2 / D - 1 / (conformity * D)) });
    this.eReduced = E / (1 - nu * nu);
    this.kappa = ellipseRatio(this.radiusX, this.radiusY);
    this.rolling = 0.5 * dm * (1 - gamma * gamma); // u_sum over the speed of the shaft [m]
    this.kn = this.hertz(1).approach ** -1.5; // N/m^1.5
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

  // Contact over all loads of the atlas at a speed.
  contact(rpm) {
    const [low, high] = this.loads(rpm), end = PER_DECADE * Math.log10(high) - NEAR;
    const loads = [low];
    for (let j = Math.ceil(PER_DECADE * Math.log10(low) + NEAR); j < Math.ceil(end); j++) loads.push(10 ** (j / PER_DECADE));
    const nodes = [...loads, high].map(load => {
      const point = this.point(load, rpm), { values, gains } = this.atlas.gainsAt(point);
      return { x: Math.log(load), y: Math.log((1 - values[0]) * point.length), gains: this.gains(gains, values[LOW]) };
    });
    return new Contact(this.kn, this.point(1, rpm), nodes, this.atlas.rates);
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

class Contact {
  // `nodes` over the load, x = ln F increasing: y = ln of the film [m], and gains. `point`: any at this speed.
  constructor(kn, point, nodes, rates) {
    Object.assign(this, { kn, rates });
    this.gains = nodes.map(node => node.gains);
    this.gainX = nodes.map(node => node.x);
    this.transit = point.time / Math.sqrt(point.length); // own time over the root of g, at this speed [s/m^0.5]
    const x = this.gainX, y = nodes.map(node => node.y), slope = pchipSlopes(x, y), last = x.length - 1;
    slope[last] = Math.min(slope[last], 0);
    this.x = [x[0] - DECADE, ...x];
    this.y = [y[0] - 0.5 * DECADE * (slope[0] + RIGID_SLOPE), ...y];
    this.slope = [RIGID_SLOPE, ...slope];
  }

  // Film [m] and its derivative by x.
  film(x) {
    const { x: X, y: Y, slope: S } = this, last = X.length - 1;
    const end = x <= X[0] ? 0 : x >= X[last] ? last : -1;
    if (end >= 0) {
      const h = Math.exp(Y[end] + S[end] * (x - X[end]));
      return [h, h * S[end]];
    }
    const k = interval(X, x), w = X[k + 1] - X[k], t = (x - X[k]) / w, d = Y[k + 1] - Y[k];
    const a = w * S[k] - d, b = d - w * S[k + 1];
    const h = Math.exp(Y[k] + t * d + t * (1 - t) * ((1 - t) * a + t * b));
    return [h, h * (d + (1 - 2 * t) * ((1 - t) * a + t * b) + t * (1 - t) * (b - a)) / w];
  }

  // At rest under F = e^x: dry compression, approach [m] and its derivative by x.
  at(x) {
    const compression = Math.exp(2 / 3 * (x - Math.log(this.kn))), [h, slope] = this.film(x);
    return { compression, approach: compression - h, byX: 2 / 3 * compression - slope };
  }

  // Impedance about rest under e^x (elements.small_motion): w [rad/s] => [Re Z, Im Z] [N/m].
  impedance(x) {
    const force = Math.exp(x), { compression, byX } = this.at(x), stiffness = force / byX;
    const [k, t] = between(this.gainX, x), slope = 1.5 * force / compression, tau = this.transit * Math.sqrt(compression);
    const gains = this.gains[k].map((gain, j) => gain + t * (this.gains[k + 1][j] - gain));
    return w => {
      const own = w * tau, [re, im] = memory(this.rates, gains, Math.max(own, SMALL_OMEGA));
      return [stiffness - slope * own * im, slope * own * re];
    };
  }
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
