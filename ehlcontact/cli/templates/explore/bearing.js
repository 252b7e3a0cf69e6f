// A ball bearing under a load, in -y, at a speed: reduced_models.bearing.ball_bearing, .equilibrium and .impedance, in SI.
// Python balances every ball by its approach at the outer race; here ln of the force at the inner race is looked
// for, from which the approaches of both contacts follow: the same balance, with one search instead of three.

const { LARGEST_PLAY, LEAST_SLIP, POSITIONS, SEATED, TINY_OMEGA } = DATA.rules;
const BALANCED = 1e-12, ROUNDING = 1e-9, REGULARISATION = 1e-6, FIRST_STEP = 1e-9, LARGEST_ANGLE = 45;

class Bearing {
  // `given`: balls, ball_diameter, pitch_diameter, conformity_inner, conformity_outer, clearance [m]; `oil`: eta0
  // and alpha.
  constructor(given, oil, atlas) {
    Object.assign(this, given, { oil, atlas });
    const { balls, ball_diameter: D, pitch_diameter: dm, clearance } = given;
    if (!(Number.isInteger(balls) && balls >= 3)) throw new InputError("balls", balls, "a whole number >= 3");
    if (dm <= D) throw new InputError("pitch_diameter", dm, `above ball_diameter = ${D}`);
    for (const name of ["conformity_inner", "conformity_outer"])
      if (!(given[name] > 0.5)) throw new InputError(name, given[name], "above 0.5 (a tighter groove pinches the ball)");
      else requireQuantity(name, given[name], DATA.quantities.conformity);
    this.races = { inner: new Race("inner", this, atlas), outer: new Race("outer", this, atlas) };
    if (D >= dm * Math.sin(Math.PI / balls)) {
      const most = Math.floor(Math.PI / Math.asin(D / dm));
      throw new InputError("balls", balls, `at most ${most} on this pitch circle: they overlap`);
    }
    const play = LARGEST_PLAY * D;
    if (!(Math.abs(clearance) <= play))
      throw new InputError("clearance", clearance, `between ${g(-play, 3)} and ${g(play, 3)} m`);
    for (const race of Object.values(this.races)) race.requireInAtlas();
  }

  get highestSpeed() {
    return Math.min(this.races.inner.highestSpeed, this.races.outer.highestSpeed);
  }

  // Defect frequencies per turn of the shaft at a contact angle [degrees] (reduced_models.bearing.kinematics), with
  // the cage slower by the share `slip`.
  orders(angle = 0, slip = 0) {
    if (!(angle >= 0 && angle <= LARGEST_ANGLE)) throw new InputError("contact_angle", angle, `0 to ${LARGEST_ANGLE} degrees`);
    const ratio = this.ball_diameter / this.pitch_diameter, gamma = ratio * Math.cos(angle * Math.PI / 180);
    return this.named(0.5 * (1 - gamma), 0.5 * (1 - gamma * gamma) / ratio, slip);
  }

  named(rolling, spin, slip) {
    if (!(slip > LEAST_SLIP && slip < 1)) throw new InputError("slip", 100 * slip, `above ${100 * LEAST_SLIP} and below 100 %`);
    const cage = rolling * (1 - slip), gamma = 1 - 2 * rolling;
    return { FTF: cage, BPFO: this.balls * cage, BPFI: this.balls * (1 - cage), BSF: spin * (1 - slip * gamma / (1 + gamma)) };
  }

  // Those under a radial and an axial load [N]: the cage turns as the mean of the balls, each with the weight of its
  // load; and that mean of the contact angles [degrees]. Both races have the same angle here: the centrifugal force
  // of a ball acts along the line of its contacts. The axis about which a ball turns is that of outer race control,
  // steeper than the line between both contacts, so it turns slightly faster than at a contact angle that is given.
  ordersUnder(atSpeed, load, axial, slip = 0) {
    const { balls } = this.angularEquilibrium(atSpeed, load, axial), ratio = this.ball_diameter / this.pitch_diameter;
    const total = balls.reduce((sum, ball) => sum + ball.force[0], 0);
    const mean = read => balls.reduce((sum, ball) => sum + ball.force[0] * read(ball), 0) / total;
    const gamma = ball => ratio * Math.cos(ball.contact), angle = mean(ball => ball.contact) * 180 / Math.PI;
    if (!(angle <= LARGEST_ANGLE)) throw new InputError("axial_load", axial, `less: contact angles up to ${LARGEST_ANGLE} degrees`);
    const spin = ball => 0.5 * (1 - gamma(ball)) * Math.hypot(1 + gamma(ball), ratio * Math.sin(ball.contact)) / ratio;
    return { angle, orders: this.named(mean(ball => 0.5 * (1 - gamma(ball))), mean(spin), slip) };
  }

  // Both contacts and the centrifugal force at a speed [rev/min].
  speedState(rpm) {
    if (!(isFinite(rpm) && rpm >= 0)) throw new InputError("speed_rpm", rpm, "a finite number >= 0");
    if (rpm === 0)
      throw new InputError("speed_rpm", rpm, "> 0 for a bearing with oil: without rolling there is no film");
    if (rpm > this.highestSpeed) {
      const allowed = `at most ${g(this.highestSpeed, 5)}, where the atlas ends for this bearing and oil`;
      throw new InputError("speed_rpm", rpm, allowed);
    }
    const { ball_diameter: D, pitch_diameter: dm } = this, mass = this.atlas.steel.density * Math.PI / 6 * D ** 3;
    const cage = 0.5 * (1 - D / dm) * rpm * Math.PI / 30, { inner, outer } = this.races;
    return { rpm, inner: inner.contact(rpm), outer: outer.contact(rpm), centrifugal: mass * 0.5 * dm * cage * cage };
  }

  // One ball whose rings have come closer by delta [m]: ln of its forces, approaches, and dF/d(delta).
  ball({ inner, outer, centrifugal }, delta) {
    const both = (inner.kn ** (-2 / 3) + outer.kn ** (-2 / 3)) ** -1.5;
    let x = Math.max(Math.log(both * Math.max(delta, 0) ** 1.5), inner.x[0]), low = -Infinity, high = Infinity;
    for (let step = 0; step < 200; step++) {
      const force = Math.exp(x), x2 = Math.log(force + centrifugal), a = inner.at(x), b = outer.at(x2);
      const missing = delta - a.approach - b.approach, slope = a.byX + b.byX * force / (force + centrifugal);
      if (missing > 0) low = x; else high = x;
      let next = x + Math.min(Math.max(missing / slope, -2), 2);
      if (Math.min(Math.abs(next - x), high - low) <= 1e-14 * (1 + Math.abs(x)))
        return { x: [x, x2], approach: [a.approach, b.approach], stiffness: force / slope };
      if (!(low < next && next < high)) next = 0.5 * (low + high);
      x = next;
    }
    throw new Error(`a ball finds no balance at ${delta} m`);
  }

  // Force on the ring at q [m], its slopes, and the balls, the first at `angle`.
  press(atSpeed, angle, q) {
    const force = [0, 0], slope = [[0, 0], [0, 0]], balls = [];
    for (let k = 0; k < this.balls; k++) {
      const psi = angle + 2 * Math.PI * k / this.balls, n = [Math.cos(psi), Math.sin(psi)];
      const ball = this.ball(atSpeed, n[0] * q[0] + n[1] * q[1] - 0.5 * this.clearance), F = Math.exp(ball.x[0]);
      for (let i = 0; i < 2; i++) {
        force[i] += F * n[i];
        for (let j = 0; j < 2; j++) slope[i][j] += ball.stiffness * n[i] * n[j];
      }
      balls.push({ ...ball, n, psi, force: ball.x.map(Math.exp) });
    }
    return { force, slope, balls };
  }

  // The ring at rest under a load [N] in -y, the first ball at `angle` (reduced_models.rotor.equilibrium).
  ringEquilibrium(atSpeed, load, angle = -Math.PI / 2) {
    const q = balanced(q => this.press(atSpeed, angle, q), [0, -load]);
    const { slope, balls } = this.press(atSpeed, angle, q), trace = slope[0][0] + slope[1][1];
    if (!(slope[0][0] * slope[1][1] - slope[0][1] * slope[1][0] > SEATED * trace * trace)) {
      const allowed = "one that presses balls on both sides of its direction; or preload the bearing (clearance < 0)";
      throw new InputError("load", load, allowed);
    }
    this.requireCarried(atSpeed, load, balls);
    return { q, stiffness: slope, balls };
  }

  // Force on the ring at q = (y, z) [m] with contact angles, a ball under the load: along the lines of groove centres.
  pressAtAngles(atSpeed, q) {
    const grooves = (this.conformity_inner + this.conformity_outer - 1) * this.ball_diameter;
    const force = [0, 0], slope = [[0, 0], [0, 0]], balls = [];
    for (let k = 0; k < this.balls; k++) {
      const down = Math.sin(-Math.PI / 2 + 2 * Math.PI * k / this.balls), radial = grooves - 0.5 * this.clearance + down * q[0];
      const length = Math.hypot(radial, q[1]), [c, s] = [radial / length, q[1] / length];
      const ball = this.ball(atSpeed, length - grooves), F = Math.exp(ball.x[0]), along = [c * down, s], beside = [-s * down, c];
      for (let i = 0; i < 2; i++) {
        force[i] += F * along[i];
        for (let j = 0; j < 2; j++) slope[i][j] += ball.stiffness * along[i] * along[j] + F / length * beside[i] * beside[j];
      }
      balls.push({ ...ball, contact: Math.atan2(q[1], radial), force: ball.x.map(Math.exp) });
    }
    return { force, slope, balls };
  }

  // The ring at rest under a load in -y and one along the shaft [N], tilts held.
  angularEquilibrium(atSpeed, load, axial) {
    const q = balanced(q => this.pressAtAngles(atSpeed, q), [-load, axial]), { balls } = this.pressAtAngles(atSpeed, q);
    this.requireCarried(atSpeed, Math.hypot(load, axial), balls);
    return { q, balls };
  }

  requireCarried(atSpeed, load, balls) {
    ["inner", "outer"].forEach((name, i) => {
      const most = Math.max(...balls.map(ball => ball.force[i])), highest = this.races[name].loads(atSpeed.rpm)[1];
      if (most <= highest) return;
      const [what, value] = load > 0 ? ["load", load] : ["clearance", this.clearance];
      const allowed = `such that a ball carries at most ${g(highest, 4)} N on the ${name} race, `
        + `the end of the atlas at this speed (here ${g(most, 4)} N)`;
      throw new InputError(what, value, allowed);
    });
  }

  // Central and smallest film [m] of a ball with both races; below the lightest load of the atlas both are the gap.
  films(atSpeed, ball) {
    return ["inner", "outer"].map((name, i) => {
      const race = this.races[name], load = ball.force[i];
      if (load < race.loads(atSpeed.rpm)[0]) {
        const gap = (load / race.kn) ** (2 / 3) - ball.approach[i];
        return { h_central: gap, h_min: gap };
      }
      const point = race.point(load, atSpeed.rpm), answer = this.atlas.at(point);
      return { answer, point, h_central: answer.h_central * point.length, h_min: answer.h_min * point.length };
    });
  }

  // K [N/m] and C [N s/m] along and across the load at angular frequencies [rad/s], means over a ball passage.
  coefficients(atSpeed, load, omegas) {
    const rows = omegas.map(() => ({ along: [0, 0], across: [0, 0] }));
    for (let k = 0; k < POSITIONS; k++) {
      const { balls } = this.ringEquilibrium(atSpeed, load, -Math.PI / 2 + 2 * Math.PI / this.balls * k / POSITIONS);
      for (const ball of balls) this.add(atSpeed, ball, omegas, rows);
    }
    const named = ([K, C]) => ({ stiffness: K / POSITIONS, damping: C / POSITIONS });
    return rows.map(row => ({ along: named(row.along), across: named(row.across) }));
  }

  // Both contacts of a ball in series.
  add(atSpeed, { x, n }, omegas, rows) {
    const inner = atSpeed.inner.impedance(x[0]), outer = atSpeed.outer.impedance(x[1]);
    omegas.forEach((omega, i) => {
      const w = Math.max(omega, TINY_OMEGA), [a, b] = inner(w), [c, d] = outer(w);
      const re = a + c, im = b + d, over = re * re + im * im, pr = a * c - b * d, pi = a * d + b * c;
      const K = (pr * re + pi * im) / over, C = (pi * re - pr * im) / over / w;
      rows[i].along[0] += K * n[1] * n[1]; rows[i].along[1] += C * n[1] * n[1];
      rows[i].across[0] += K * n[0] * n[0]; rows[i].across[1] += C * n[0] * n[0];
    });
  }
}

// Where `press` gives this force on the ring [N]: Newton's method, and searches along its steps.
function balanced(press, wanted) {
  const size = v => Math.hypot(...v), plus = (q, t, step) => [q[0] + t * step[0], q[1] + t * step[1]], load = size(wanted);
  const balance = q => { const { force } = press(q); return [force[0] - wanted[0], force[1] - wanted[1]]; };
  const search = (q, step) => plus(q, root(t => { const r = balance(plus(q, t, step)); return step[0] * r[0] + step[1] * r[1]; }), step);
  let q = [0, 0];
  if (load > 0) {
    const way = wanted.map(one => one / load), missing = balance(q), sign = -Math.sign(way[0] * missing[0] + way[1] * missing[1]);
    q = search(q, way.map(one => FIRST_STEP * sign * one));
  }
  for (let step = 0; load > 0; step++) {
    const { force, slope: [[a, b], [c, d]] } = press(q), r = [force[0] - wanted[0], force[1] - wanted[1]];
    const error = size(r), soft = REGULARISATION * Math.max(a + d, load), det = (a + soft) * (d + soft) - b * c;
    if (error <= BALANCED * load || (step > 30 && error <= ROUNDING * load)) break;
    if (step > 100) throw new Error("static equilibrium not found");
    const go = [(b * r[1] - (d + soft) * r[0]) / det, (c * r[0] - (a + soft) * r[1]) / det];
    q = size(balance(plus(q, 1, go))) < 0.5 * error || error <= ROUNDING * load ? plus(q, 1, go) : search(q, go);
  }
  return q;
}

// Where a rising function that is negative at 0 becomes 0: doubling, then the Illinois rule.
function root(along) {
  let low = 0, below = along(0), high = 1, above = along(1);
  if (below >= 0) return 0;
  for (let step = 0; above < 0; step++) {
    if (step > 60) throw new Error("the contacts do not hold the load");
    [low, below, high] = [high, above, 2 * high];
    above = along(high);
  }
  for (let step = 0, side = 0; step < 100 && high - low > 1e-12 * high; step++) {
    const t = (low * above - high * below) / (above - below), value = along(t);
    if (value === 0) return t;
    if (value < 0) {
      if (side < 0) above /= 2;
      [low, below, side] = [t, value, -1];
    } else {
      if (side > 0) below /= 2;
      [high, above, side] = [t, value, 1];
    }
  }
  return 0.5 * (low + high);
}
