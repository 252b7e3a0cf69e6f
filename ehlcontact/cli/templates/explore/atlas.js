// The atlas: reduced_models.atlas.interpolation and .frequency. Points are { M, L, kappa, alpha, eta0 }, dimensionless.

const LOBE = 2, LOW = 3, HEAD = 5; // of a row of answers: ln(Hm/Hc), low-frequency C; then K and C over frequency
const { SPLINE_SHARE, THICKEST } = DATA.rules;

class Atlas {
  constructor(data) {
    Object.assign(this, data); // box, interpolation, oil, rates, alpha, eta0, highest_omega, usual_reach
    for (const name of ["omega", "points", "coefficients", "lobe", "factor", "slopes"]) this[name] = floats(data[name]);
    this.leftOut = floats(data.left_out, Float32Array);
    this.k = this.omega.length;
    this.n = this.points.length / 3;
    this.smooth = HEAD + 2 * this.k;
    this.width = this.coefficients.length / (this.n + 6); // smooth variables, then gains
    this.asinh = this.omega.map(Math.asinh);
    this.nodes = [];
    for (let i = 0; i < this.n; i++) this.nodes.push(this.coordinates(...this.points.subarray(3 * i, 3 * i + 3)));
  }

  // Coordinates of a point, those for Hm/Hc, and its published film.
  coordinates(M, L, kappa) {
    const by = this.interpolation, film = expectedFilm(M, L, kappa);
    const logLoad = Math.log(M) + 0.5 * Math.log(radiusRatio(kappa));
    const light = lightness(logLoad, by.light_load, by.light_blend);
    const plain = [logLoad, L ** (2 / 3), Math.log(kappa), light, Math.log(film)];
    return { all: plain.map((c, j) => c * by.weights[j]), lobe: by.lobe_weights.map((w, j) => w * plain[j]), film };
  }

  requireInside(point) {
    const { box } = this, [M, L, kappa] = ["M", "L", "kappa"].map(name => `${name} ${box[name].map(v => g(v)).join("..")}`);
    const whole = `${M}, ${L}, ${kappa}, Hertz pressure up to ${g(box.p_hertz / 1e9)} GPa`;
    for (const name of ["M", "L", "kappa"]) {
      const [low, high] = box[name];
      if (!(low <= point[name] && point[name] <= high))
        throw new InputError(name, point[name], `between ${g(low)} and ${g(high)}, the box of the atlas (${whole})`);
    }
    const pressure = moesPressure(point.M, point.L, point.kappa) / point.alpha;
    if (pressure > box.p_hertz) {
      const allowed = `at most ${g(box.p_hertz / 1e9)}e9 Pa, the limit of the atlas (${whole})`;
      throw new InputError("Hertz pressure", `${g(pressure, 4)} Pa`, allowed);
    }
    this.requireOil(point);
  }

  requireOil(oil) {
    for (const name of ["alpha", "eta0"]) {
      const [low, high] = this.oil[name], quantity = this.quantities[name];
      if (low <= oil[name] && oil[name] <= high) continue;
      const guess = slip(quantity, oil[name]);
      const allowed = `between ${g(low)} and ${g(high)} ${quantity.unit}, the range of the atlas`;
      throw new InputError(name, oil[name], guess ? `${allowed} (${guess})` : allowed);
    }
  }

  // Everything about a point inside, with half widths of error bars; frequency by frequency as in `omega`.
  at(point) {
    this.requireInside(point);
    const { found, film, distance } = this.interpolated(point), { values, slopes } = this.fromSmooth(found, film);
    const named = this.named(values), error = this.named(this.bars(point, distance, values, slopes));
    named.separation = 1 - named.approach;
    error.separation = error.approach;
    return { ...named, error };
  }

  // Answers in a row, and gains of the film memory over the low-frequency damping.
  gainsAt(point) {
    const { found, film } = this.interpolated(point);
    return { values: this.fromSmooth(found, film).values, gains: found.slice(this.smooth) };
  }

  interpolated({ M, L, kappa, alpha, eta0 }) {
    const secants = secantOverSlope(alpha, eta0, this.oil.secant) / secantOverSlope(this.alpha, this.eta0, this.oil.secant);
    const here = this.coordinates(M, L * secants, kappa), distance = new Float64Array(this.n);
    const found = new Float64Array(this.width), { coefficients, lobe, width, n } = this;
    const add = (row, factor) => {
      for (let j = 0, at = row * width; j < width; j++) found[j] += factor * coefficients[at + j];
    };
    let ratio = lobe[n];
    for (let i = 0; i < n; i++) {
      distance[i] = apart(here.all, this.nodes[i].all);
      add(i, distance[i] ** 3);
      ratio += lobe[i] * apart(here.lobe, this.nodes[i].lobe) ** 3;
    }
    add(n, 1);
    here.all.forEach((c, j) => add(n + 1 + j, c));
    here.lobe.forEach((c, j) => { ratio += lobe[n + 1 + j] * c; });
    found[LOBE] = ratio;
    return { found, film: here.film, distance };
  }

  // Answers, and their derivatives to the smooth variables.
  fromSmooth(t, film) {
    const by = this.interpolation, split = HEAD + this.k, expected = film / (by.thick + film);
    const values = Float64Array.from(t.subarray(0, this.smooth), (v, j) => (j < split ? Math.exp(v) : v));
    for (const j of [0, 1, LOW, HEAD - 1]) values[j] *= expected;
    values[2] *= values[1];
    const slopes = values.slice(), scale = by.asinh * values[LOW];
    for (let j = split; j < this.smooth; j++) {
      values[j] = scale * Math.sinh(t[j]);
      slopes[j] = Math.hypot(scale, values[j]);
    }
    values[0] = 1 - values[0];
    return { values, slopes };
  }

  // Half widths of error bars: by the errors of the nearest points when each is left out, and for another oil.
  bars(point, distance, values, slopes) {
    const { nearest } = this.interpolation, split = HEAD + this.k;
    const order = Array.from(distance.keys()).sort((i, j) => distance[i] - distance[j]).slice(0, nearest);
    const far = Math.max(distance[order[nearest - 1]] / this.usual_reach, 1) ** 2;
    const away = ["alpha", "eta0"].map(name => Math.abs(Math.log(point[name] / this[name])));
    const extra = kind => this.oil[kind][0] * away[0] + this.oil[kind][1] * away[1];
    const film = extra("film"), K = extra("stiffness") * Math.min(1 - values[0], THICKEST), C = extra("damping");
    const head = [film, film, film, C, extra("moment")];
    const smooth = slopes.map((_, j) => {
      const squares = order.reduce((sum, i) => sum + this.leftOut[i * this.smooth + j] ** 2, 0);
      return far * this.factor[j] * Math.sqrt(squares / nearest) + (j < HEAD ? head[j] : j < split ? K : C);
    });
    const low = smooth[LOW]; // the damping is over the low-frequency one, whose error comes on top
    return smooth.map((bar, j) => (j < split ? slopes[j] * bar : Math.hypot(slopes[j] * bar, values[j] * low)));
  }

  named(row) {
    const [approach, h_central, h_min, , moment] = row, split = HEAD + this.k;
    return { approach, h_central, h_min, moment, stiffness: row.slice(HEAD, split), damping: row.slice(split) };
  }

  // Between the frequencies of the table, from its values and bars there: [value, half width of its bar] at Omega.
  over(values, bars) {
    const { omega, asinh, k } = this;
    const slopes = values.map((_, i) => values.reduce((sum, v, j) => sum + this.slopes[i * k + j] * v, 0));
    return Omega => {
      const x = Math.asinh(Omega), [i, t] = between(asinh, x), width = asinh[i + 1] - asinh[i];
      const rise = values[i + 1] - values[i], a = width * slopes[i] - rise, b = rise - width * slopes[i + 1];
      const bent = t * (1 - t) * ((1 - t) * a + t * b);
      return [values[i] + t * rise + bent, linear(omega, bars, Omega) + SPLINE_SHARE * Math.abs(bent)];
    };
  }
}

function apart(a, b) {
  let squares = 0;
  for (let j = 0; j < a.length; j++) squares += (a[j] - b[j]) ** 2;
  return Math.sqrt(squares);
}
