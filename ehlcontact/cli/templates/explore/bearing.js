// A ball bearing under a load at a speed, in SI: reduced_models.bearing.ball_bearing. Equilibrium, contact angles, stiffness and damping
// are those of the C core; this puts in grooves and races, and reads films of the atlas at the contacts that it finds.

const { LARGEST_PLAY, LEAST_SLIP, POSITIONS, SEATED, CARRIES, TRACTION, MOST_FRICTION } = DATA.rules;
const LARGEST_ANGLE = Math.PI / 4, RACES = ["inner", "outer"], AXES = ["x", "y", "z"];
// Of `BallAtRest` of csrc/bearing.h, in its order; what is behind them the page does not need.
const OF_BALL = ["angle", "force", "approach", "compression", "slope", "factor", "rolling"]; // [inner, outer] each; then:
const OF_ROLLING = ["orbit", "rotation", "axis", "share"];

class Bearing {
  // `given`: balls, ball_diameter, pitch_diameter, conformity_inner, conformity_outer, clearance [m], contact_angle [rad] of an
  // angular contact bearing, else 0, name in the catalogue; `oil`: eta0 and alpha, temperature_slope and rho0 where they are known.
  constructor(given, oil, atlas) {
    Object.assign(this, { contact_angle: 0 }, given, { oil, atlas });
    const { balls, ball_diameter: D, pitch_diameter: dm, clearance, contact_angle: angle } = this;
    if (!(Number.isInteger(balls) && balls >= 3)) throw new InputError("balls", balls, "a whole number >= 3");
    if (!(angle >= 0 && angle <= LARGEST_ANGLE * (1 + 1e-12))) throw new InputError("contact_angle", angle * 180 / Math.PI, "from 0 to 45 degrees");
    if (dm <= D) throw new InputError("pitch_diameter", dm, `above ball_diameter = ${D}`);
    for (const name of ["conformity_inner", "conformity_outer"])
      if (!(given[name] > 0.5)) throw new InputError(name, given[name], "above 0.5 (a tighter groove pinches the ball)");
      else requireQuantity(name, given[name], DATA.quantities.conformity);
    this.races = RACES.map(name => new Race(name, this, atlas));
    if (D >= dm * Math.sin(Math.PI / balls)) {
      const most = Math.floor(Math.PI / Math.asin(D / dm));
      throw new InputError("balls", balls, `at most ${most} on this pitch circle: they overlap`);
    }
    const play = LARGEST_PLAY * D;
    if (!(Math.abs(clearance) <= play))
      throw new InputError("clearance", clearance, `between ${g(-play, 3)} and ${g(play, 3)} m`);
    for (const race of this.races) race.requireInAtlas();
  }

  get highestSpeed() {
    return Math.min(...this.races.map(race => race.highestSpeed));
  }

  // Numbers of `Grooves` of csrc/bearing.h: reduced_models.bearing.grooves. Outer race control needs no moments of spin.
  get grooves() {
    const { ball_diameter: D, pitch_diameter: dm, conformity_inner: fi, conformity_outer: fo, clearance, contact_angle: angle } = this;
    const distance = (fi + fo - 1) * D, inner = (fi - 0.5) * D;
    const free = angle > 0 ? angle : Math.acos(1 - 0.5 * Math.max(clearance, 0) / distance);
    const centre = angle > 0 ? [distance * Math.cos(angle), distance * Math.sin(angle)] : [distance - 0.5 * clearance, 0];
    const mass = this.atlas.steel.density * Math.PI / 6 * D ** 3;
    const turning = [1, 0, 1]; // the inner ring
    return [...centre, 0, inner, (fo - 0.5) * D, 0.5 * dm + inner * Math.cos(free), fi * D, D, dm, mass, 1, 0, 0, Math.cos(angle), ...turning];
  }

  requireSpeed(rpm) {
    if (!(isFinite(rpm) && rpm >= 0)) throw new InputError("speed_rpm", rpm, "a finite number >= 0");
    if (rpm === 0)
      throw new InputError("speed_rpm", rpm, "> 0 for a bearing with oil: without rolling there is no film");
    if (rpm > this.highestSpeed) {
      const allowed = `at most ${g(this.highestSpeed, 5)}, where the atlas ends for this bearing and oil`;
      throw new InputError("speed_rpm", rpm, allowed);
    }
  }

  // At rest under a force on the inner ring, [Fx, Fy] with axial motion and tilts held or [Fx, Fy, Fz] with tilts held [N].
  under(load, rpm) {
    this.requireSpeed(rpm);
    const axial = load.length > 2;
    if (this.contact_angle > 0 && !(axial && load[2] > 0))
      throw new InputError("axial_load", axial ? load[2] : 0, "above 0 with the preload: an angular contact bearing needs an axial load, in one direction");
    if (axial) this.requireBearableByAll(load, rpm);
    return new Loaded(this, load, rpm);
  }

  requireBearableByAll(load, rpm) {
    const share = Math.hypot(...load) / this.balls;
    for (const race of this.races) {
      const highest = race.loads(rpm)[1], allowed = `such that a ball carries at most ${g(highest, 4)} N on the ${race.name} race, `
        + `the end of the atlas at this speed (here ${g(share, 4)} N in the mean of all balls)`;
      if (share > highest) throw new InputError("load", load, allowed);
    }
  }

  // Defect frequencies per turn of the shaft without a load, and others with the cage slower by the share `slip`
  // (reduced_models.bearing.kinematics).
  get orders() {
    const ratio = this.ball_diameter / this.pitch_diameter, gamma = ratio * Math.cos(this.contact_angle);
    return this.named(0.5 * (1 - gamma), 0.5 * (1 - gamma * gamma) / ratio);
  }

  named(cage, spin) {
    return { FTF: cage, BPFO: this.balls * cage, BPFI: this.balls * (1 - cage), BSF: spin };
  }

  withSlip({ FTF, BSF }, slip) {
    if (!(slip > LEAST_SLIP && slip < 1)) throw new InputError("slip", 100 * slip, `above ${100 * LEAST_SLIP} and below 100 %`);
    const gamma = 1 - 2 * FTF;
    return this.named(FTF * (1 - slip), BSF * (1 - slip * gamma / (1 + gamma)));
  }
}

// A bearing at rest under a load at a speed: ring, balls, films, and what follows from them.
class Loaded {
  constructor(bearing, load, rpm) {
    const core = new Core(), n = load.length, omega = rpm * Math.PI / 30, { lags, lag_rate, inlet_rate, fast_rate } = bearing.atlas.rates;
    Object.assign(this, { bearing, load, rpm, core, omega });
    this.ring = core.c.bearing_new(bearing.balls, n, 0, omega, core.put(bearing.grooves));
    bearing.races.forEach((race, i) => {
      const { nodes, curve, gains } = race.curve(rpm), law = [race.kn, 2 * race.hertz(1).a / Math.sqrt(race.length), lag_rate, inlet_rate, fast_rate];
      core.c.bearing_race(this.ring, i, core.put(law), nodes, core.put(curve), lags, core.put(gains));
    });
    this.first = Math.atan2(load[1], load[0]);
    if (load.every(force => force === 0)) this.first = -Math.PI / 2;
    Object.assign(this, this.stand(this.first));
    this.requireSeated();
    this.requireInGrooves();
    this.requireBearable();
  }

  // The ring and its balls with the first one at an angle [rad].
  stand(angle) {
    const { core, load, bearing: { balls } } = this, n = load.length;
    const reason = core.text(core.c.bearing_stand(this.ring, angle, core.put(load)));
    if (reason !== null) {
      this.bearing.requireBearableByAll(load, this.rpm);
      throw new Error(reason);
    }
    const ring = core.read(core.c.bearing_ring(this.ring), 6 + n * n), width = core.c.bearing_per_ball();
    const all = core.read(core.c.bearing_of_balls(this.ring), width * balls);
    const ball = row => Object.fromEntries([...OF_BALL.map((name, j) => [name, row.slice(2 * j, 2 * j + 2)]),
      ...OF_ROLLING.map((name, j) => [name, row[2 * OF_BALL.length + j]])]);
    const found = Array.from({ length: balls }, (_, k) => ({ psi: angle + 2 * Math.PI * k / balls, ...ball(all.slice(width * k, width * (k + 1))) }));
    const slope = AXES.slice(0, n).map((_, i) => ring.slice(6 + n * i, 6 + n * (i + 1)));
    return { q: ring.slice(0, n), stiffness: slope, balls: found };
  }

  get largest() {
    return Math.max(...this.balls.map(ball => ball.force[0]));
  }

  get heaviest() {
    return this.balls.findIndex(ball => ball.force[0] === this.largest);
  }

  requireSeated() {
    const K = this.stiffness, diagonal = K.map((row, i) => row[i]), free = diagonal.indexOf(Math.min(...diagonal));
    if (determinant(K) > SEATED * diagonal.reduce((sum, one) => sum + one, 0) ** K.length) return;
    const allowed = K.length === 2 ? "one that presses balls on both sides of its direction; or preload the bearing (clearance < 0)"
      : `one that seats the ring: nothing holds it in ${AXES[free]}; more axial load or preload would`;
    throw new InputError("load", this.load, allowed);
  }

  requireInGrooves() {
    const degrees = angle => g(angle * 180 / Math.PI, 3);
    this.balls.forEach(({ force, approach, angle }, k) => {
      if (!(approach[0] + approach[1] > 0 && force[0] > CARRIES * this.largest)) return;
      const steepest = Math.max(...angle.map(Math.abs));
      if (steepest > STEEPEST) {
        const allowed = `one whose contact angles stay below ${degrees(STEEPEST)} degrees (here ${degrees(steepest)} degrees at ball ${k})`;
        throw new InputError("load", this.load, allowed);
      }
      if (this.bearing.contact_angle > 0 && Math.min(...angle) < 0) {
        const allowed = "one with more axial force in +z: an angular contact bearing carries it in this direction only";
        throw new InputError("load", this.load, `${allowed} (ball ${k} runs at ${degrees(Math.min(...angle))} degrees)`);
      }
    });
  }

  requireBearable() {
    this.bearing.races.forEach((race, i) => {
      const most = Math.max(...this.balls.map(ball => ball.force[i])), highest = race.loads(this.rpm)[1];
      if (most <= highest) return;
      const none = this.load.every(force => force === 0) && this.bearing.clearance < 0;
      const [what, value] = none ? ["clearance", this.bearing.clearance] : ["load", this.load];
      const allowed = `such that a ball carries at most ${g(highest, 4)} N on the ${race.name} race, `
        + `the end of the atlas at this speed (here ${g(most, 4)} N)`;
      throw new InputError(what, value, allowed);
    });
  }

  // The contact of a ball with a race: with its own angle and speeds.
  race(ball, i) {
    const nominal = this.bearing.races[i], same = this.bearing.contact_angle === 0 && ball.angle[i] === 0;
    if (same && Math.abs(ball.rolling[i] / nominal.rolling - 1) < INSIDE) return nominal;
    return new Race(RACES[i], this.bearing, this.bearing.atlas, ball.angle[i], ball.rolling[i]);
  }

  // Films [m] of every ball at both races, moments of their pressure [N m], answers of the atlas where it has the load, Hertz pressures
  // [Pa]. Below the lightest load of the atlas both films are the gap, and the moment is that of the lightest load.
  get films() {
    this.found ??= this.balls.map(ball => RACES.map((name, i) => {
      const race = this.race(ball, i), load = ball.force[i], [lightest, highest] = race.loads(this.rpm);
      if (this.rpm > race.highestSpeed) {
        const allowed = `at most ${g(race.highestSpeed, 5)}, where the atlas ends at a contact angle of ${g(ball.angle[i], 3)} rad`;
        throw new InputError("speed_rpm", this.rpm, allowed);
      }
      if (load > highest) {
        const allowed = `such that a ball carries at most ${g(highest, 4)} N on the ${name} race, the end of the atlas at this speed (here ${g(load, 4)} N)`;
        throw new InputError("load", this.load, allowed);
      }
      const point = race.point(Math.max(load, lightest), this.rpm), answer = this.bearing.atlas.at(point), { a } = race.hertz(point.force);
      const moment = answer.moment * point.force * a, pressure = load > 0 ? 1.5 * load * race.kappa / (Math.PI * race.hertz(load).a ** 2) : 0;
      if (load >= lightest) return { race, point, answer, moment, pressure, h_central: answer.h_central * point.length, h_min: answer.h_min * point.length };
      const gap = (load / this.bearing.races[i].kn) ** (2 / 3) - ball.approach[i];
      return { race, point, moment, pressure, h_central: gap, h_min: gap };
    }));
    return this.found;
  }

  // Torque on the shaft [N m] that the films of rolling balls take, and that of sliding under the usual traction law: those of
  // reduced_models.bearing.sliding, rolling times what heat leaves of the inlet where the oil is known.
  get torque() {
    const { oil } = this.bearing, { roelands_p0: p0, roelands_log } = DATA.oil, q = Math.log(oil.eta0) + roelands_log;
    let rolling = 0, sliding = 0;
    this.balls.forEach((ball, k) => this.films[k].forEach(({ race, point, moment, pressure, answer, h_central }, i) => {
      const speed = 0.5 * race.rolling * this.omega, f = 2 * race.conformity;
      rolling += 0.5 * race.rolling * moment / race.radiusX;
      if (!answer) return;
      const { a } = race.hertz(point.force), across = f * race.D / (f + 1);
      const contact = [a, a / race.kappa, pressure, race.radiusX, across, speed, h_central, this.spin(ball, i)];
      contact.push(Math.log(oil.eta0), q, oil.alpha * p0 / q, p0, TRACTION);
      sliding += this.core.c.sliding_power(this.core.put(contact)) / this.omega;
    }));
    const { race, point } = this.films[this.heaviest][0];
    const heat = oil.temperature_slope === undefined ? 1 : wilsonHeating(thermalLoad(race, point, oil));
    return { rolling: heat * rolling, sliding, heat, skf: this.skf };
  }

  // Moment of friction by SKF's published model [N m] (reduced_models.bearing.skf_friction); null of a bearing without its constants.
  get skf() {
    const { constants, K_rs, K_Z, mu_boundary, mu_film, pressure, stribeck } = DATA.skf, own = constants[this.bearing.name];
    if (own === undefined || this.bearing.contact_angle > 0) return null;
    const { series: [r1, r2, s1, s2], bore, outside } = own, dm = 0.5 * (bore + outside), nu = kinematicViscosity(this.bearing.oil);
    const n = this.rpm, radial = Math.hypot(this.load[0], this.load[1]), axial = Math.abs(this.load[2] ?? 0);
    let rolling = r1 * dm ** 1.96 * radial ** 0.54, sliding = s1 * dm ** -0.26 * radial ** (5 / 3);
    if (axial > 0) {
      const unit = Math.max(...this.bearing.races.map(race => 1.5 * race.kappa / (Math.PI * race.hertz(1).a ** 2)));
      const rating = this.bearing.balls * (pressure / unit) ** 3 / stribeck, angle = 24.6 * (axial / rating) ** 0.24;
      if (angle > 90) return null;
      const slope = Math.sin(angle * Math.PI / 180);
      rolling = r1 * dm ** 1.96 * (radial + r2 * axial / slope) ** 0.54;
      sliding = s1 * dm ** -0.145 * (radial ** 5 + s2 * dm ** 1.5 * axial ** 4 / slope) ** (1 / 3);
    }
    const heat = 1 / (1 + 1.84e-9 * (n * dm) ** 1.28 * nu ** 0.64);
    const supply = Math.exp(-K_rs * nu * n * (bore + outside) * Math.sqrt(K_Z / (2 * (outside - bore))));
    const boundary = Math.exp(-2.6e-8 * (n * nu) ** 1.4 * dm), mu = boundary * mu_boundary + (1 - boundary) * mu_film;
    return 1e-3 * (heat * supply * rolling * (nu * n) ** 0.6 + sliding * mu);
  }

  // Spin over rolling of a contact: reduced_models.bearing.ring. Balls of a radial load have none.
  spin({ angle, axis, rotation, orbit }, i) {
    if (this.load.length < 3) return 0;
    const a = angle[i], turn = i === 0 ? 1 - orbit : -orbit;
    const by = turn * Math.sin(a) + rotation * Math.sin(a - axis), roll = turn * Math.cos(a) + rotation * Math.cos(a - axis);
    return by / roll;
  }

  // Friction across both contacts that holds the gyroscopic moment of a ball, over their forces (reduced_models.bearing.ring).
  gyroscopicFriction({ force, orbit, rotation, axis, share }) {
    const { ball_diameter: D, atlas: { steel: { density } } } = this.bearing, mass = density * Math.PI / 6 * D ** 3;
    const friction = 0.2 * mass * D * orbit * rotation * Math.sin(axis) * this.omega ** 2;
    return [share, 1 - share].map((part, i) => (force[i] > 0 ? part * friction / force[i] : 0));
  }

  // Friction of balls that carry above what films may transmit, in words: `friction_note` of reduced_models.bearing.equilibrium_result.
  get frictionNote() {
    if (this.load.length < 3) return "";
    const carry = this.balls.filter(({ force }) => force[0] > 0), held = carry.map(ball => this.gyroscopicFriction(ball).map(Math.abs));
    const needed = RACES.map((_, i) => Math.max(0, ...held.map(both => both[i]))), i = needed[1] > needed[0] ? 1 : 0;
    return needed[i] > MOST_FRICTION ? `the ${RACES[i]} race must hold the gyroscopic moment of a ball by friction of ${g(needed[i], 2)}`
      + ` of the contact force: above ${g(MOST_FRICTION)} the ball may slip` : "";
  }

  // Defect frequencies per turn of the shaft: the cage turns as the mean of the balls, each with the weight of its load.
  get orders() {
    const total = this.balls.reduce((sum, ball) => sum + ball.force[0], 0);
    if (this.load.length < 3 || total === 0) return this.bearing.orders;
    const mean = name => this.balls.reduce((sum, ball) => sum + ball.force[0] * ball[name], 0) / total;
    return this.bearing.named(mean("orbit"), mean("rotation"));
  }

  // K [N/m] and C [N s/m] at angular frequencies [rad/s], rows over x, y and z: means over a ball passage.
  coefficients(omegas) {
    const { core, bearing } = this, size = AXES.length ** 2, at = core.put(omegas), sum = core.c.numbers(2 * size * omegas.length);
    for (let k = 0; k < POSITIONS; k++) {
      this.stand(this.first + 2 * Math.PI / bearing.balls * k / POSITIONS);
      core.c.bearing_vibrate(this.ring, 1 / POSITIONS, omegas.length, at, sum);
    }
    const all = core.read(sum, 2 * size * omegas.length), n = this.load.length;
    const matrix = from => AXES.slice(0, n).map((_, i) => all.slice(from + 3 * i, from + 3 * i + n));
    return omegas.map((_, f) => ({ stiffness: matrix(2 * size * f), damping: matrix(2 * size * f + size) }));
  }
}

function determinant(m) {
  if (m.length === 2) return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const minor = (i, j) => m[1][i] * m[2][j] - m[1][j] * m[2][i];
  return m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1);
}
