"""`simulate`: what a record holds, energy, interruption and failure."""

import json
from dataclasses import fields
from math import pi

import numpy as np
import pytest

from ehlcontact import (
    ConvergenceError,
    Domain,
    FreeVibration,
    Grid,
    HarmonicLoad,
    KeepSettings,
    MoesPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    RunSettings,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.status import Status

POINT = MoesPoint(200, 10, 0.5)
OMEGA_N = 5.13
N = 32


@pytest.fixture(scope="module")
def free():
    return simulate(
        POINT,
        FreeVibration(Omega_n=OMEGA_N),
        grid=Grid(n=N),
        time=TimeSteps(tol=1e-6),
        keep=KeepSettings(snapshots=(0.0, 0.31, 1.0)),
    )


@pytest.fixture(scope="module")
def harmonic():
    return simulate(
        POINT, HarmonicLoad(Omega=2.0 * pi), grid=Grid(n=N), time=TimeSteps(until=4.0, dt=0.025, tol=1e-6)
    )


def test_record_starts_at_rest(free, steady):
    static = steady(200, 10, 0.5, N)
    assert free.static_approach == pytest.approx(static.approach, abs=1e-6)
    assert (free.t[0], free.approach[0]) == (0.0, free.static_approach)
    assert free.force[0] == pytest.approx(1.0, abs=1e-6)
    assert free.rate[0] == pytest.approx(0.1 * 1.5**0.5 * OMEGA_N)
    assert free.h_central[0] == pytest.approx(static.h_central, rel=1e-4)
    assert free.h_min[0] == pytest.approx(static.h_min, rel=1e-4)


def test_equation_of_motion_holds_at_every_step(free):
    residual = free.acceleration / OMEGA_N**2 + free.force - free.load
    assert np.abs(residual).max() < 1e-5
    assert np.abs(free.load_residuals).max() < 1e-5
    assert (free.residuals <= 1e-6).all()
    assert (free.cycles[1:] >= 1).all()


def test_newmark_rule(free):
    """Average acceleration: u and rate follow from the stored acceleration."""
    dT = np.diff(free.t)
    mean = 0.5 * (free.acceleration[1:] + free.acceleration[:-1])
    np.testing.assert_allclose(np.diff(free.rate), dT * mean, atol=1e-12)
    moved = 0.5 * dT * (free.rate[1:] + free.rate[:-1])
    np.testing.assert_allclose(np.diff(free.approach), moved, atol=1e-12)


def test_energy_balance(free):
    """Kinetic energy + work of the film = work of the load, step by step: average acceleration is exact."""
    kinetic = 0.5 * (free.rate**2 - free.rate[0] ** 2) / OMEGA_N**2
    work = np.array([free.dissipated(0.0, T) for T in free.t[1:]])
    balance = kinetic[1:] + work - (free.approach[1:] - free.approach[0])
    assert np.abs(balance).max() < 1e-5 * abs(kinetic[0] - kinetic.min())


@pytest.mark.long
def test_free_vibration_dissipates_in_every_cycle():
    """Loops closed at equal approach (upward passages of the static one, after the first transit)."""
    record = simulate(POINT, FreeVibration(Omega_n=OMEGA_N), grid=Grid(n=N), time=TimeSteps(until=6.0, tol=1e-6))
    above = record.approach > record.static_approach
    starts = np.flatnonzero(~above[:-1] & above[1:])
    assert starts.size >= 5
    kinetic = 0.5 * record.rate[starts] ** 2 / OMEGA_N**2
    for k in range(1, starts.size):
        a, b = record.t[starts[k - 1]], record.t[starts[k]]
        gap = record.approach[starts[k]] - record.approach[starts[k - 1]]
        lost = record.dissipated(a, b) - gap  # the load is 1: its work over the gap is no loss
        assert lost > 0.0
        assert lost == pytest.approx(kinetic[k - 1] - kinetic[k], rel=1e-3)


def test_harmonic_load_dissipates_in_every_cycle(harmonic):
    for start in (1.0, 2.0, 3.0):
        inside = (harmonic.t >= start - 1e-9) & (harmonic.t <= start + 1.0 + 1e-9)
        gap = np.ptp(harmonic.approach[inside][[0, -1]])
        amplitude = 0.5 * np.ptp(harmonic.approach[inside])
        lost = harmonic.dissipated(start - 1e-9, start + 1.0 + 1e-9)
        assert gap < 0.01 * amplitude  # the loop is closed
        # pi Omega C amplitude^2 with C about .012
        assert 0.5 < lost / (pi * 2.0 * pi * 0.012 * amplitude**2) < 2.0


def test_harmonic_load_is_carried_at_every_instant(harmonic):
    np.testing.assert_allclose(harmonic.load, 1.0 + 0.1 * np.sin(2.0 * pi * harmonic.t), atol=1e-12)
    np.testing.assert_allclose(harmonic.force, harmonic.load, atol=1e-5)
    np.testing.assert_allclose(harmonic.rate, np.gradient(harmonic.approach, harmonic.t, edge_order=2), atol=1e-12)


def test_fields_of_a_record(free):
    steps = free.steps
    assert free.t.shape == (steps + 1,)
    for f in fields(free):
        value = getattr(free, f.name)
        if isinstance(value, np.ndarray):
            assert not value.flags.writeable
            assert np.isfinite(value).all()
    for name in ("approach", "rate", "acceleration", "force", "load", "h_central", "h_min", "cycles"):
        assert getattr(free, name).shape == (steps + 1,)
    assert free.h_midplane.shape == free.p_midplane.shape == (steps + 1, N + 1)
    assert (free.p_midplane >= 0.0).all()
    assert (free.h_min > 0.0).all()
    assert np.allclose(np.diff(free.t), free.t[1])
    assert free.t[-1] == pytest.approx(free.motion.default_end)


def test_snapshots(free):
    assert free.snapshot_t.shape == (3,)
    assert free.snapshot_t[0] == 0.0
    for wanted, got in zip((0.0, 0.31, 1.0), free.snapshot_t, strict=True):
        assert wanted - 1e-9 <= got < wanted + free.t[1]
    at = np.searchsorted(free.t, free.snapshot_t - 1e-12)
    np.testing.assert_array_equal(free.snapshot_h[:, :, 0], free.h_midplane[at])
    np.testing.assert_array_equal(free.snapshot_p[:, :, 0], free.p_midplane[at])
    assert (free.snapshot_p >= 0.0).all()


def test_snapshot_at_the_end():
    run = simulate(
        POINT,
        HarmonicLoad(Omega=3.0),
        grid=Grid(n=N),
        time=TimeSteps(until=0.2, dt=0.1),
        keep=KeepSettings(snapshots=(0.1, 0.2)),
    )
    np.testing.assert_allclose(run.snapshot_t, [0.1, 0.2], rtol=1e-12)
    np.testing.assert_array_equal(run.snapshot_h[-1, :, 0], run.h_midplane[-1])


def test_no_snapshots(harmonic):
    assert harmonic.snapshot_t.shape == (0,)
    assert harmonic.snapshot_h.shape == (0, N + 1, harmonic.y.size)


def test_summary_is_plain(free):
    summary = free.to_dict()
    assert json.loads(json.dumps(summary)) == summary
    wanted = "status steps seconds t approach rate force h_central h_min"
    assert set(wanted.split()) <= set(summary)


def test_steady_is_a_rest_state():
    """Under its own static approach nothing moves."""
    u = solve_steady(POINT, grid=Grid(n=N), tol=1e-7).approach
    T = np.linspace(0.0, 2.0, 11)
    record = simulate(POINT, PrescribedApproach(T, np.full(T.size, u)), grid=Grid(n=N), time=TimeSteps(tol=1e-6))
    assert np.abs(record.force - 1.0).max() < 2e-4
    assert np.ptp(record.force) < 2e-5


def test_prescribed_load_equals_the_same_harmonic_load():
    harmonic = HarmonicLoad(Omega=pi)
    one = simulate(POINT, harmonic, grid=Grid(n=N), time=TimeSteps(until=2.0, dt=0.05, tol=1e-6))
    T = np.linspace(0.0, 2.0, 41)
    table = PrescribedLoad(T, [harmonic.load(t) for t in T])
    other = simulate(POINT, table, grid=Grid(n=N), time=TimeSteps(until=2.0, dt=0.05, tol=1e-6))
    np.testing.assert_allclose(other.approach, one.approach, atol=1e-6)


def test_inertia_of_a_stiff_oscillator_is_quasi_static():
    """At Omega_n far above the load's frequency, eq. 5 tends to eq. 6."""
    light = simulate(
        POINT, HarmonicLoad(Omega=0.5 * pi, Omega_n=40.0), grid=Grid(n=N), time=TimeSteps(until=4.0, dt=0.025)
    )
    none = simulate(POINT, HarmonicLoad(Omega=0.5 * pi), grid=Grid(n=N), time=TimeSteps(until=4.0, dt=0.025))
    late = light.t > 1.0
    np.testing.assert_allclose(light.approach[late], none.approach[late], atol=3e-3)


def test_prescribed_load_may_start_elsewhere():
    T = np.linspace(0.0, 0.4, 5)
    record = simulate(POINT, PrescribedLoad(T, np.full(5, 1.2)), grid=Grid(n=N), time=TimeSteps(tol=1e-6))
    assert record.force[0] == pytest.approx(1.2, abs=1e-5)
    assert np.ptp(record.approach) < 1e-4
    assert record.static_approach < record.approach[0]


def test_offset_starts_from_the_displaced_film():
    record = simulate(
        POINT, FreeVibration(Omega_n=OMEGA_N, offset=0.05), grid=Grid(n=N), time=TimeSteps(until=0.5)
    )
    assert record.approach[0] == pytest.approx(record.static_approach + 0.05, abs=1e-7)
    assert record.rate[0] == 0.0
    assert record.force[0] > 1.05
    assert record.acceleration[0] == pytest.approx(OMEGA_N**2 * (1.0 - record.force[0]), rel=1e-9)


def test_ramp_widens_the_domain_and_settles():
    record = simulate(MoesPoint(58.07, 4.62, 1.0), RampLoad(3.67, 1.69, Omega_n=2.4), grid=Grid(n=64))
    assert record.domain.x_out > 1.5 * 3.67 ** (1 / 3) - 1e-9
    assert record.approach[-1] == pytest.approx(2.25, abs=0.2)
    assert record.load[-1] == pytest.approx(3.67)


def test_steps_divide_the_end_evenly():
    record = simulate(POINT, HarmonicLoad(Omega=pi), grid=Grid(n=N), time=TimeSteps(until=0.5, dt=0.3))
    assert record.steps == 2
    assert record.t[-1] == pytest.approx(0.5)
    exact = simulate(POINT, HarmonicLoad(Omega=pi), grid=Grid(n=N), time=TimeSteps(until=0.3, dt=0.1))
    assert exact.steps == 3


def test_interrupt_keeps_what_was_computed():
    def stop(T, until):
        if T > 0.45:
            raise KeyboardInterrupt

    record = simulate(
        POINT,
        HarmonicLoad(Omega=pi),
        grid=Grid(n=N),
        time=TimeSteps(until=2.0, dt=0.1),
        run=RunSettings(callback=stop),
    )
    assert record.status is Status.INTERRUPTED
    assert record.steps == 5
    assert record.approach.shape == record.h_midplane.shape[:1] == (6,)


def test_callback_sees_every_step():
    seen = []
    simulate(
        POINT,
        HarmonicLoad(Omega=pi),
        grid=Grid(n=N),
        time=TimeSteps(until=0.5, dt=0.1),
        run=RunSettings(callback=lambda T, until: seen.append((T, until))),
    )
    np.testing.assert_allclose(seen, [(0.1 * k, 0.5) for k in range(1, 6)])


@pytest.mark.parametrize("throw", [True, False])
def test_failed_step_keeps_the_history(monkeypatch, throw):
    """The second step gets no cycle at all."""

    def no_more_cycles(T, until):
        monkeypatch.setattr("ehlcontact.transient.transient_film.STEP_CYCLES", 0)

    def run():
        return simulate(
            POINT,
            HarmonicLoad(Omega=pi),
            grid=Grid(n=N),
            time=TimeSteps(until=1.0, dt=0.1, tol=1e-6),
            run=RunSettings(throw=throw, callback=no_more_cycles),
        )

    if throw:
        with pytest.raises(
            ConvergenceError, match=r"simulation max_cycles at T = 0\.2 \(step 0\.1, residual .*\): The cycles"
        ) as caught:
            run()
        result = caught.value.result
    else:
        result = run()
    assert result.status is Status.MAX_CYCLES
    assert result.steps == 2
    assert result.residuals[1] < 1e-6 < result.residuals[2]


def test_time_out_of_the_domain_is_reported():
    """A ramp to five times the load on the default region: the ellipse reaches the outlet."""
    record = simulate(
        MoesPoint(58.07, 4.62, 1.0),
        RampLoad(5.0, 1.0, Omega_n=4.0),
        grid=Grid(n=N, domain=Domain()),
        run=RunSettings(throw=False),
        time=TimeSteps(until=4.0),
    )
    assert record.status is Status.OUT_OF_DOMAIN
    assert record.t[-1] < 4.0


def test_fast_squeezing_of_a_narrow_ellipse():
    """Local passes along the cavitation boundary must keep out of where the squeeze term rules."""
    record = simulate(
        MoesPoint(500, 15, 0.12), HarmonicLoad(Omega=12.56), grid=Grid(n=128), time=TimeSteps(until=0.4)
    )
    assert record.cycles.max() < 10
