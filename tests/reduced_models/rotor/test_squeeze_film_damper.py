"""Squeeze film dampers: closed forms, quadrature of pressures, tangents; alone and under a housing."""

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
import pytest
from scipy.integrate import quad
from squeeze_films import (
    CLEARANCE,
    LENGTH,
    MASS,
    RADIUS,
    SPRING,
    VISCOSITY,
    damper,
    in_series,
    on_orbit,
    orbits,
    ratio,
    rigid,
)

from ehlcontact import ConvergenceError, InputError, Lubricant
from reduced_models import (
    BearingMount,
    LinearBearing,
    SpeedProfile,
    Support,
    linearise,
    rotor_to_control,
    simulate_rotor,
    unbalance_response,
)
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.integrate_python import PythonSteps
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.simulate import integrate

KINDS = [(seals, cavitation) for seals in ("open", "sealed") for cavitation in (True, False)]


def in_python(rotor, speed, dt, steps, start="static", tolerance=1e-9):
    """A run by the steps in Python."""
    run = PreparedRun(rotor, speed, dt, steps, start, 0.8)
    return integrate(run, PythonSteps(run, tolerance, 30), None)


# ---- the film


@pytest.mark.parametrize("e", [1e-6, 0.1, 0.5, 0.9, 0.98])
def test_circular_orbits_of_a_short_bearing(e):
    """Damping and direct stiffness of the pi film in closed form; the whole film has twice the one alone."""
    omega, film = 300.0, VISCOSITY * LENGTH**3 * RADIUS / CLEARANCE**3
    C, K = pi * film / (2.0 * ratio(e) ** 1.5), 2.0 * film * omega * e / ratio(e) ** 2
    assert damper().circular_orbit(e, omega) == pytest.approx((K, C), rel=1e-12, abs=0.0)
    assert damper(stiffness=1e6).circular_orbit(e, omega) == pytest.approx((K + 1e6, C), rel=1e-12, abs=0.0)
    stiffness, damping = damper(cavitation=False).circular_orbit(e, omega)
    assert damping == pytest.approx(2.0 * C, rel=1e-12, abs=0.0) and abs(stiffness) < 1e-12 * K
    grooved = damper(groove=True).circular_orbit(e, omega)
    assert grooved == pytest.approx((K / 4.0, C / 4.0), rel=1e-12, abs=0.0)


@pytest.mark.parametrize("e", [1e-3, 0.1, 0.5, 0.9])
def test_circular_orbits_of_a_long_bearing(e):
    omega, film = 300.0, 12.0 * VISCOSITY * LENGTH * (RADIUS / CLEARANCE) ** 3
    C = pi * film / ((2.0 + e * e) * ratio(e) ** 0.5)
    K = 2.0 * film * e * omega / ((2.0 + e * e) * ratio(e))
    assert damper(seals="sealed").circular_orbit(e, omega) == pytest.approx((K, C), rel=1e-12, abs=0.0)
    short = np.array(damper().circular_orbit(e, omega))
    mixed = damper(seals="sealed", leakage=0.3).circular_orbit(e, omega)
    assert mixed == pytest.approx(0.7 * np.array([K, C]) + 0.3 * short, rel=1e-12, abs=0.0)
    whole = damper(seals="sealed", cavitation=False).circular_orbit(e, omega)
    assert whole[1] == pytest.approx(2.0 * C, rel=1e-12, abs=0.0)


def integrated(made, q, v):
    """Force of the positive pressure, or the whole, by quadrature of polar pressures."""
    e, along = np.hypot(*q) / CLEARANCE, np.arctan2(q[1], q[0])
    r, t = v @ [np.cos(along), np.sin(along)], v @ [-np.sin(along), np.cos(along)]

    def pressure(angle):
        c, s = np.cos(angle), np.sin(angle)
        if made.seals == "open":
            return VISCOSITY * LENGTH**3 * RADIUS / CLEARANCE**3 * (r * c + t * s) / (1.0 - e * c) ** 3
        film = 12.0 * VISCOSITY * LENGTH * (RADIUS / CLEARANCE) ** 3
        return film * (2.0 - e * c) / (1.0 - e * c) ** 2 * (0.5 * r * c + t * s / (2.0 + e * e))

    middle = np.arctan2(t, r) if made.seals == "open" else np.arctan2(t / (2.0 + e * e), 0.5 * r)
    ends = [middle - pi / 2.0, middle + pi / 2.0, middle + 1.5 * pi]
    assert abs(pressure(ends[0])) < 1e-12 * pressure(middle)
    spans = list(pairwise(ends))[: 1 if made.cavitation else 2]
    parts = [
        sum(
            quad(lambda a, way=way: pressure(a) * way(a), *span, epsabs=0.0, epsrel=1e-12, limit=200)[0]
            for span in spans
        )
        for way in (np.cos, np.sin)
    ]
    turned = np.array([[np.cos(along), -np.sin(along)], [np.sin(along), np.cos(along)]])
    return turned @ parts


@pytest.mark.parametrize(("seals", "cavitation"), KINDS)
def test_any_motion_is_the_integral_of_its_pressure(seals, cavitation):
    made, rng = damper(seals=seals, cavitation=cavitation), np.random.default_rng(3)
    for e in (1e-7, 0.2, 0.6, 0.95):
        angle, v = rng.uniform(0.0, 2.0 * pi), rng.normal(size=2)
        q = e * CLEARANCE * np.array([np.cos(angle), np.sin(angle)])
        wanted = integrated(made, q, v)
        assert np.abs(made.forces(q, v).force - wanted).max() < 1e-10 * np.abs(wanted).max()


def differences(function, x, h):
    """Derivative of a vector by central differences of the fourth order."""
    columns = [
        (
            8.0 * (function(x + h * way) - function(x - h * way))
            - function(x + 2 * h * way)
            + function(x - 2 * h * way)
        )
        / (12.0 * h)
        for way in np.eye(2)
    ]
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize(("seals", "cavitation"), KINDS)
def test_tangents_are_exact(seals, cavitation):
    """Beyond the clearance too, where the film stays that of a gap of a hundredth of it."""
    made = damper(seals=seals, cavitation=cavitation, stiffness=1e6, leakage=0.2 * (seals == "sealed"))
    for e in (0.05, 0.3, 0.8, 0.98, 1.2):
        q, v = e * CLEARANCE * np.array([0.6, -0.8]), np.array([0.01, 0.03])
        found = made.forces(q, v)
        stiffness = differences(lambda x, v=v: made.forces(x, v).force, q, 1e-4 * CLEARANCE)
        damping = differences(lambda x, q=q: made.forces(q, x).force, v, 1e-4)
        assert np.abs(found.stiffness - stiffness).max() < 1e-6 * np.abs(stiffness).max()
        assert np.abs(found.damping - damping).max() < 1e-7 * np.abs(damping).max()


def test_many_motions_at_once():
    q, v = 1e-4 * np.random.default_rng(1).uniform(-0.7, 0.7, (2, 5, 3, 2))
    found = damper().forces(q, v)
    assert found.force.shape == (5, 3, 2) and found.damping.shape == (5, 3, 2, 2)
    assert np.array_equal(found.stiffness[4, 1], damper().forces(q[4, 1], v[4, 1]).stiffness)


@pytest.mark.parametrize("seals", ["open", "sealed"])
def test_linear_is_the_first_harmonic_of_small_vibrations(seals):
    """About a journal at rest off the middle: the cavitated film is half the whole one, exactly."""
    made, rest = damper(seals=seals), CLEARANCE * np.array([0.3, 0.4])
    turned = np.exp(1j * 2.0 * pi * np.arange(720) / 720.0)
    v = np.real(turned[:, None] * np.array([0.02, 0.01 - 0.03j]))
    force = made.forces(rest, v).force
    harmonic = 2.0 * (force.T @ turned.conj()) / turned.size
    linear = made.linear(rest)
    assert harmonic == pytest.approx(linear.damping @ np.array([0.02, 0.01 - 0.03j]), rel=1e-12)
    assert not linear.stiffness.any() and np.hypot(*force.mean(axis=0)) > 0.1 * np.abs(harmonic).max()
    whole = damper(seals=seals, cavitation=False).linear(rest)
    assert whole.damping == pytest.approx(2.0 * linear.damping, rel=1e-12)


def test_ross():
    """Its element: sealed ends, the short film, and that with a groove."""
    rs = pytest.importorskip("ross", reason="ROSS is not installed: pip install 'ehlcontact[ross]'")
    if not hasattr(rs, "SqueezeFilmDamper"):
        pytest.skip("ROSS before 3 has no squeeze film damper")
    e, omega = 0.4, 1200.0
    kinds = {"groove": {"groove": True}, "groove-end_seals": {}, "end_seals": {"seals": "sealed"}}
    for geometry, own in kinds.items():
        theirs = rs.SqueezeFilmDamper(
            n=0, frequency=[omega], axial_length=LENGTH, journal_diameter=2.0 * RADIUS,
            radial_clearance=CLEARANCE, eccentricity_ratio=e, lubricant="ISOVG32", geometry=geometry,
        )  # fmt: skip
        stiffness, damping = damper(viscosity=theirs.lubricant, **own).circular_orbit(e, omega)
        assert damping == pytest.approx(float(theirs.cxx[0]), rel=1e-2)
        if geometry != "end_seals":  # whose stiffness it leaves out
            assert stiffness == pytest.approx(float(theirs.kxx[0]), rel=1e-2)


# ---- a rotor in a damper


def test_compiled_steps_are_those_in_python():
    """Under its weight, whose orbits are no circles."""
    rotor = rigid(load=(0.0, -9.81 * MASS), spring=4e6)
    dt, steps = 2e-4, 400
    found = simulate_rotor(rotor, speed_rpm=6000.0, dt=dt, until=dt * steps)
    twin = in_python(rotor, 6000.0, dt, steps)
    for name in ("displacement", "velocity", "force"):
        assert np.abs(getattr(found, name) - getattr(twin, name)).max() < 1e-9 * np.abs(getattr(twin, name)).max()
    assert found.columns == ("damper 0 x", "damper 0 y")
    forces = rotor.mounts[0].bearing.forces(found.displacement, found.velocity).force
    assert np.abs(found.force - forces).max() < 1e-8 * np.abs(forces).max()


@pytest.mark.long
def test_unbalance_jumps():
    """Three circular orbits between 607 and 672 rad/s: a run-up stays on the large one, the reverse does not."""
    low, _, high = orbits(640.0)
    assert len(orbits(606.0)) == len(orbits(674.0)) == 1
    dt, steps, ends = 2e-4, 40_000, np.array([580.0, 720.0]) / RPM_TO_RAD_S
    for profile, held, jump in (
        (SpeedProfile.ramp(*ends, dt * steps), high, 672.5),
        (SpeedProfile.ramp(*ends[::-1], dt * steps), low, 607.2),
    ):
        run = simulate_rotor(rigid(), speed_rpm=profile, dt=dt, until=dt * steps)
        omega, e = run.speed_rpm * RPM_TO_RAD_S, np.hypot(*run.displacement.T) / CLEARANCE
        near = np.abs(omega - 640.0) < 0.5
        assert e[near].mean() == pytest.approx(held, rel=0.01)
        steepest = omega[5000 + int(np.argmax(np.abs(np.diff(e[5000:]))))]  # after the start
        assert steepest == pytest.approx(jump, rel=0.012)


@pytest.mark.long
def test_a_jump_is_the_one_of_python():
    dt, steps = 2e-4, 6000
    profile = SpeedProfile.ramp(640.0 / RPM_TO_RAD_S, 720.0 / RPM_TO_RAD_S, dt * steps)
    start = on_orbit(orbits(640.0)[2], 640.0)
    found = simulate_rotor(rigid(), speed_rpm=profile, dt=dt, until=dt * steps, start=start, tolerance=1e-11)
    twin = in_python(rigid(), profile, dt, steps, start, 1e-11)
    amplitude = np.hypot(*found.displacement.T) / CLEARANCE
    assert amplitude.max() > 0.7 and amplitude[-1] < 0.5
    assert np.abs(found.displacement - twin.displacement).max() < 1e-9 * np.abs(twin.displacement).max()


def test_constant_speed_keeps_either_orbit():
    """From near each stable orbit at 640 rad/s the settled one is that in closed form."""
    dt, omega = 1e-4, 640.0
    found = orbits(omega)
    for e in (found[0], found[2]):
        start = on_orbit(e, omega)
        run = simulate_rotor(rigid(), speed_rpm=omega / RPM_TO_RAD_S, dt=dt, until=6000 * dt, start=start)
        assert np.hypot(*run.displacement[-1]) / CLEARANCE == pytest.approx(e, rel=2e-3)


def test_contact_is_named():
    """A load that no spring holds sinks to the housing: both ways of stepping stop there and say so."""
    rotor, start = rigid(spring=0.0, load=(0.0, -2e3), eccentric=0.0), (np.zeros(2), np.zeros(2))
    with pytest.raises(ConvergenceError, match="the journal of damper 0 touches its housing") as compiled:
        simulate_rotor(rotor, speed_rpm=300.0, dt=1e-3, until=5.0, start=start)
    with pytest.raises(ConvergenceError, match="the journal of damper 0 touches its housing") as stepped:
        in_python(rotor, 300.0, 1e-3, 5000, start)
    runs = [error.value.result for error in (compiled, stepped)]
    assert runs[0].t.size == runs[1].t.size > 10
    assert np.isfinite(runs[0].force).all()
    last = np.hypot(*runs[0].displacement[-1]) / CLEARANCE
    assert 0.98 < last < 1.0


def test_equilibrium_is_that_of_the_spring():
    assert rigid(load=(30.0, -100.0)).equilibrium() == pytest.approx(np.array([30.0, -100.0]) / SPRING, rel=1e-12)
    with pytest.raises(InputError, match="not held by damper 0 in y': must be one with a stiffness, or a housing"):
        rigid(spring=0.0, load=(0.0, -100.0)).equilibrium()
    assert rigid(spring=0.0).equilibrium().tolist() == [0.0, 0.0]  # without a load it stays
    with pytest.raises(InputError, match=r"the journal of damper 0 touches .* ratio is 4\.1"):
        rigid(load=(0.0, -1000.0)).equilibrium()


def test_linearised_about_the_sag():
    """The spring and half the damping of the whole film at the static eccentricity, in closed form."""
    sag = 0.5 * CLEARANCE
    linear = linearise(rigid(load=(0.0, -SPRING * sag)), 3000.0)
    film = VISCOSITY * LENGTH**3 * RADIUS / CLEARANCE**3
    across, along = 0.5 * pi * film / ratio(0.5) ** 1.5, 0.5 * pi * film * 1.5 / ratio(0.5) ** 2.5
    for mode, C in zip(sorted(linear.modes(), key=lambda one: -one.eigenvalue.real), (across, along), strict=True):
        assert mode.eigenvalue.real == pytest.approx(-C / (2.0 * MASS), rel=1e-9)
        assert abs(mode.eigenvalue) == pytest.approx((SPRING / MASS) ** 0.5, rel=1e-9)
    assert linear.rotor.mounts[0].name == "damper 0"


@pytest.mark.parametrize("cavitation", [True, False])
def test_a_small_unbalance_response_is_that_of_a_run(cavitation):
    """About the middle even a film that cavitates is linear."""
    rotor, omega = rigid(eccentric=1e-7, cavitation=cavitation), 350.0
    response = unbalance_response(rotor, [omega / RPM_TO_RAD_S])
    run = simulate_rotor(rotor, speed_rpm=omega / RPM_TO_RAD_S, dt=1e-4, until=0.5)
    assert np.hypot(*run.displacement[-1]) == pytest.approx(abs(response.amplitude[0, 0]), rel=2e-3)
    film = (2.0 - cavitation) * 0.5 * pi * VISCOSITY * LENGTH**3 * RADIUS / CLEARANCE**3
    wanted = MASS * 1e-7 * omega**2 / (SPRING - MASS * omega**2 + 1j * omega * film)
    assert response.amplitude[0, :2] == pytest.approx(wanted * np.array([1.0, -1j]), rel=1e-10)


# ---- under the housing of a ball bearing


def test_in_series_with_ball_bearings():
    rotor = in_series()
    assert (
        [mount.name for mount in rotor.film_dampers] == ["damper 0", "damper 1"] == list(rotor.film_damper_names)
    )
    housing = rotor.nodes["housing 1"]
    assert rotor.film_dampers[1].ends == ((housing["x"], housing["y"]),)
    bare = in_series(film=False)
    assert rotor.equilibrium(3000.0) == pytest.approx(bare.equilibrium(3000.0), rel=1e-9)
    damped, free = (linearise(one, 3000.0).modes(1)[0].decrement for one in (rotor, bare))
    assert damped > 5.0 * free
    budget = linearise(rotor, 3000.0).damping_budget(2)
    rows = [budget.parts.index(name) for name in ("damper 0", "damper 1")]
    assert (budget.share[rows].sum(axis=0) > 0.8).all() and np.abs(budget.residual).max() < 1e-9


def test_compiled_steps_are_those_in_python_with_balls():
    rotor, dt, steps = in_series(), 1e-5, 60
    found = simulate_rotor(rotor, speed_rpm=6000.0, dt=dt, until=dt * steps)
    twin = in_python(rotor, 6000.0, dt, steps)
    assert np.abs(found.displacement - twin.displacement).max() < 1e-9 * np.abs(twin.displacement).max()
    assert found.columns[-2:] == ("damper 1 x", "damper 1 y") and found.columns[4] == "bearing 1 x"
    force = found.force[:, found.columns.index("damper 1 y")]
    assert np.abs(force).max() > 0.0


def test_dampers_are_no_rings(tmp_path):
    """Of a rotor with axial motion rings keep their five directions; figures have the journals too."""
    rotor = in_series(axial=True)
    run = simulate_rotor(rotor, speed_rpm=6000.0, dt=1e-5, until=3e-4)
    assert run.dampers == ("damper 0", "damper 1") and run.ring.shape == (31, 2, 5)
    assert run.force.shape[1] == len(run.columns) == 14
    titles = [title for title, _ in run._shown(None)]
    assert titles == [
        f"{what} of {kind} {k}"
        for what, kind in (("inner ring", "bearing"), ("journal", "damper"))
        for k in (0, 1)
    ]
    own = rotor.film_dampers[1].rows(rotor.size) @ run.displacement[-1]
    assert run._shown(None)[-1][1][-1] == pytest.approx(own, rel=1e-9)


# ---- bad input


@pytest.mark.parametrize(
    ("changes", "field", "words"),
    [
        ({"length": None}, "length", "given"),
        ({"clearance": None}, "clearance", "given"),
        ({"viscosity": None}, "viscosity", "given"),
        ({"radius": None}, "diameter", "given, or radius"),
        ({"diameter": 0.1}, "diameter", "left out beside radius"),
        ({"clearance": 120.0}, "clearance", "in µm"),
        ({"clearance": 0.007}, "clearance", "below a tenth of the radius"),
        ({"length": 5.0}, "length", "10 diameters"),
        ({"viscosity": 12.0}, "viscosity", "in mPa s"),
        ({"viscosity": "thin"}, "viscosity", "number"),
        ({"leakage": 0.2}, "leakage", "open ends"),
        ({"seals": "sealed", "groove": True}, "groove", "left out"),
        ({"seals": "shut"}, "seals", "open"),
        ({"cavitation": 1}, "cavitation", "True or False"),
        ({"stiffness": -1.0}, "stiffness", "between"),
    ],
)
def test_refused(changes, field, words):
    with pytest.raises(InputError) as error:
        damper(**changes)
    assert error.value.field == field and words in str(error.value)


def test_what_a_damper_is_not():
    made = damper()
    with pytest.raises(InputError, match="planar"):
        BearingMount(bearing=made, x=0, y=1, z=2, tilt_x=3, tilt_y=4)
    with pytest.raises(InputError, match="housing_mass"):
        Support(position=0.0, bearing=LinearBearing(1e8 * np.eye(2), np.eye(2)), damper=made)
    with pytest.raises(InputError, match="SqueezeFilmDamper"):
        Support(position=0.0, bearing=LinearBearing(np.eye(2), np.eye(2)), damper=5)
    with pytest.raises(InputError, match="within the clearance"):
        made.linear((2e-4, 0.0))
    with pytest.raises(InputError, match=r"of shape \(..., 2\)"):
        made.forces((0.0, np.nan), (0.0, 0.0))
    with pytest.raises(InputError, match="linearise"):
        rotor_to_control(rigid(), 3000.0)
    oil = Lubricant.iso_vg(46, temperature=80.0)
    assert damper(viscosity=oil).viscosity == oil.eta0 and replace(made, clearance=2e-4).clearance == 2e-4
