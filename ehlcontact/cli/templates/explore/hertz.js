// Dry contacts, and published films: ehlcontact.hertz and ehlcontact.film_formulas, under the same names.

// K and E of the parameter 1 - kappa^2, by the arithmetic-geometric mean.
function ellipticIntegrals(kappa) {
  let a = 1, b = kappa, power = 0.5, sum = power * (1 - kappa * kappa);
  while (Math.abs(a - b) > 1e-15 * a) {
    const c = 0.5 * (a - b);
    [a, b] = [0.5 * (a + b), Math.sqrt(a * b)];
    power *= 2;
    sum += power * c * c;
  }
  const K = Math.PI / (a + b);
  return [K, K * (1 - sum)];
}

function shapeFactor(kappa) {
  const m = 1 - kappa * kappa;
  if (Math.abs(m) < 1e-3) return 0.5 - m / 16 - m * m / 32;
  const [K, E] = ellipticIntegrals(kappa);
  return (E - kappa * kappa * K) / (m * K);
}

function radiusRatio(kappa) {
  const S = shapeFactor(kappa);
  return kappa * kappa * (1 - S) / S;
}

function scaledAxis(M, kappa) {
  return Math.cbrt(6 * kappa * shapeFactor(kappa) * ellipticIntegrals(kappa)[0] * M / Math.PI);
}

function ellipseRatio(radiusX, radiusY) {
  let low = -10, high = 10;
  for (let i = 0; i < 60; i++) {
    const middle = 0.5 * (low + high);
    if (radiusRatio(2 ** middle) < radiusX / radiusY) low = middle; else high = middle;
  }
  return 2 ** low;
}

// Of two bodies under a load [N]: a [m], approach [m], from radii [m] and E' [Pa].
function hertzContact(load, radiusX, radiusY, eReduced, kappa) {
  const [K, E] = ellipticIntegrals(kappa), R = 1 / (1 / radiusX + 1 / radiusY);
  const a = Math.cbrt(6 * kappa * E * load * R / (Math.PI * eReduced));
  return { a, approach: a * a * K / (2 * R * E) };
}

function lightness(logLoad, lightLoad, blend) {
  const half = Math.log(blend), below = Math.log(lightLoad) - logLoad;
  const t = Math.min(Math.max(0.5 * (below / half + 1), 0), 1);
  return t === 0 || t === 1 ? Math.max(below, 0) : 2 * half * t ** 3 * (1 - 0.5 * t);
}

// Nijenbanning, Venner and Moes (1994), in Moes units.
function nvmCentralFilm(M, L, kappa) {
  const lam = radiusRatio(kappa), shape = 1 + 0.006 * Math.log(lam) + 0.63 * lam ** (4 / 7);
  const hRI = 145 * (1 + 0.796 * lam ** (14 / 15)) ** (-15 / 7) / (lam * M * M);
  const hEI = 3.18 * shape ** (-14 / 25) * lam ** (-1 / 15) * M ** (-2 / 15);
  const h00 = 1.8 / lam, s = 1.5 * (1 + Math.exp(-1.2 * hEI / hRI));
  const isoviscous = (hRI ** 1.5 + (hEI ** -4 + h00 ** -4) ** (-3 / 8)) ** (2 / 3);
  if (L === 0) return isoviscous;
  const hRP = 1.29 * (1 + 0.691 * lam) ** (-2 / 3) * L ** (2 / 3);
  const hEP = 1.48 * shape ** (-7 / 20) * lam ** (-1 / 24) * M ** (-1 / 12) * L ** 0.75;
  const piezoviscous = (hRP ** -8 + hEP ** -8) ** (-1 / 8);
  return (isoviscous ** s + piezoviscous ** s) ** (1 / s);
}

// The same in dry approaches.
function expectedFilm(M, L, kappa) {
  return nvmCentralFilm(M, L, kappa) * 2 * shapeFactor(kappa) / scaledAxis(M, kappa) ** 2;
}

// alpha times the Hertz pressure.
function moesPressure(M, L, kappa) {
  return 3 * L * kappa * M / (2 * Math.PI * scaledAxis(M, kappa) ** 2);
}
