"""Speed of the surfaces over time: against steady films, an axisymmetric squeeze film and mirror images."""

import numpy as np
import pytest
from scipy.special import ellipkm1

from ehlcontact import (
    Dent,
    Domain,
    Geometry,
    Grid,
    HarmonicLoad,
    InputError,
    KeepSettings,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    PrescribedApproach,
    PrescribedLoad,
    SpeedHistory,
    TimeSteps,
    read,
    response,
    save,
    simulate,
    solve_steady,
)
from ehlcontact.lubricant import density, log_viscosity
from ehlcontact.transient.prescribed import passed_over

POINT = MoesPoint(20.0, 5.0, 1.0)
HELD = PrescribedLoad(np.linspace(0.0, 100.0, 5), np.ones(5))
COARSE = Grid(n=64)
AROUND = Grid(n=64, domain=Domain(-3.0, 3.0, 2.5))


def ramp(length, end, start=1.0):
    """From `start` at T = 1 to `end`, smooth in slope."""
    x = np.linspace(0.0, 1.0, 41)
    T = np.concatenate([[0.0], 1.0 + length * x, [length + 100.0]])
    return SpeedHistory(T, np.concatenate([[start], start + (end - start) * x * x * (3.0 - 2.0 * x), [end]]))


def films(run):
    return run.h_central, run.h_min, run.approach, run.force


def test_a_constant_speed_is_none():
    motion, time = HarmonicLoad(amplitude=0.2, Omega=3.0), TimeSteps(until=1.0, dt=0.05)
    plain = simulate(POINT, motion, grid=COARSE, time=time)
    same = simulate(POINT, motion, grid=COARSE, time=time, speed=SpeedHistory([0.0, 1.0, 2.0, 3.0], np.ones(4)))
    for one, other in zip(films(plain), films(same), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("end", [0.25, pytest.param(4.0, marks=pytest.mark.long)])
def test_settled_at_another_speed_it_is_that_steady_film(end):
    """A point of M U^(-3/4), L U^(1/4): all scales but that of time stay."""
    run = simulate(POINT, HELD, grid=COARSE, time=TimeSteps(until=25.0, dt=0.1, tol=1e-5), speed=ramp(4.0, end))
    other = MoesPoint(POINT.M * end**-0.75, POINT.L * end**0.25, POINT.kappa)
    steady = solve_steady(other, grid=Grid(n=64, domain=run.domain))
    assert run.h_central[-1] == pytest.approx(steady.h_central, rel=2e-4)
    assert run.h_min[-1] == pytest.approx(steady.h_min, rel=2e-4)
    assert run.approach[-1] == pytest.approx(steady.approach, abs=2e-5)


@pytest.mark.long
def test_slow_changes_are_steady_films_to_first_order():
    off = []
    for length in (20.0, 40.0, 80.0):
        U = SpeedHistory([0.0, 1.0, 1.0 + length, 2.0 + length], [1.0, 1.0, 2.0, 2.0])
        middle = 1.0 + 0.5 * length
        run = simulate(POINT, HELD, grid=COARSE, time=TimeSteps(until=middle, dt=0.25, tol=1e-5), speed=U)
        other = MoesPoint(POINT.M * 1.5**-0.75, POINT.L * 1.5**0.25, POINT.kappa)
        off.append(run.h_central[-1] / solve_steady(other, grid=Grid(n=64, domain=run.domain)).h_central - 1.0)
    assert off[0] == pytest.approx(2.0 * off[1], rel=0.1)
    assert off[1] == pytest.approx(2.0 * off[2], rel=0.05)
    assert -0.02 < off[2] < -0.001  # the film is what the slower inlet has made before


@pytest.mark.long
def test_order_in_time():
    """Through a stop and back to speed, with a slope that does not jump."""
    U = SpeedHistory.from_function(lambda T: 0.5 * (1.0 + np.cos(np.pi * T)), 2.0, steps=2000)
    runs = [
        simulate(POINT, HELD, grid=COARSE, time=TimeSteps(until=2.0, dt=dt, tol=1e-7), speed=U)
        for dt in (0.1, 0.05, 0.025, 0.00625)
    ]
    finest = runs[-1]
    for k in (0, 2):  # central film, approach
        errors = [
            np.abs(films(one)[k] - films(finest)[k][:: round(one.t[1] / finest.t[1])]).max() for one in runs[:3]
        ]
        assert errors[1] < 0.35 * errors[0] and errors[2] < 0.35 * errors[1]
    assert finest.h_central[finest.t.size // 2] > 0.5 * finest.h_central[0]  # at U = 0 the film is trapped


def test_backwards_is_the_mirror_image():
    T, U = np.array([0.0, 0.5, 1.0, 2.0]), np.array([1.0, 1.0, 0.4, 0.4])
    time, keep = TimeSteps(until=2.0, dt=0.1), KeepSettings(snapshots=(0.0, 1.0))
    ahead, back = (
        simulate(POINT, HELD, grid=AROUND, time=time, keep=keep, speed=SpeedHistory(T, s * U)) for s in (1.0, -1.0)
    )
    np.testing.assert_array_equal(ahead.h_central, back.h_central)
    np.testing.assert_array_equal(ahead.p_midplane, back.p_midplane[:, ::-1])
    np.testing.assert_array_equal(ahead.snapshot_h, back.snapshot_h[:, ::-1])


@pytest.mark.parametrize("local_error", [pytest.param(None, marks=pytest.mark.long), 1e-3])
def test_turned_round_it_ends_in_the_mirror_image_of_its_start(local_error):
    U = SpeedHistory([0.0, 0.5, 1.5, 10.0], [1.0, 1.0, -1.0, -1.0])
    time = TimeSteps(until=8.0, local_error=local_error, tol=None if local_error else 1e-5)
    run = simulate(POINT, HELD, time=time, speed=U)
    assert run.domain.x_out == -run.domain.x_in
    assert run.h_central[-1] == pytest.approx(run.h_central[0], rel=1e-3)
    np.testing.assert_allclose(run.p_midplane[-1][::-1], run.p_midplane[0], atol=2e-3)
    assert run.h_min.min() < 0.97 * run.h_min[0] and run.h_min.min() > 0.0  # thinner while it turns
    if local_error:
        assert np.abs(run.t - 1.0).min() < 1e-12  # where it turns


def test_stop_and_go():
    """At standstill the film is squeezed out slowly, by its rim; it comes back with the speed."""
    U = SpeedHistory([0.0, 1.0, 2.0, 22.0, 23.0, 40.0], [1.0, 1.0, 0.0, 0.0, 1.0, 1.0])
    run = simulate(POINT, HELD, grid=COARSE, time=TimeSteps(until=35.0, dt=0.1, tol=1e-4), speed=U)
    stopped, later = np.searchsorted(run.t, (4.0, 22.0))
    assert 0.6 * run.h_min[stopped] > run.h_min[later] > 0.0
    assert np.all(np.diff(run.approach[stopped:later]) > 0.0)
    assert run.h_central[-1] == pytest.approx(run.h_central[0], rel=1e-3)


STOPPED = 0.6  # time at which the contact below stands still


def approach(T):
    """From apart to 0.85 dry approaches, within T = 3."""
    x = np.clip((T - STOPPED - 0.4) / 3.0, 0.0, 1.0)
    return -0.3 + 1.15 * x * x * (3.0 - 2.0 * x)


def ring_deflections(r, edges):
    """Deflection at `r` of unit pressure on each ring: ``2/pi^2 int 4 s K(k)/(r + s) ds``, k^2 = 4 r s/(r + s)^2.

    2/pi^2 is what makes a Hertz pressure sqrt(1 - r^2) deflect by 1 - r^2/2.
    """
    x, w = np.polynomial.legendre.leggauss(24)
    t, weight = 0.5 * (x + 1.0), 0.5 * w
    near = np.clip(r[:, None], edges[:-1], edges[1:])  # the nearest point of each ring; nodes gather there
    total = np.zeros(near.shape)
    for far in (edges[:-1], edges[1:]):
        s = near[..., None] + (far - near)[..., None] * t**3
        value = 4.0 * s / (r[:, None, None] + s) * ellipkm1(((r[:, None, None] - s) / (r[:, None, None] + s)) ** 2)
        total += np.abs(far - near) * (value * 3.0 * t * t * weight).sum(axis=-1)
    return 2.0 / np.pi**2 * total


def axisymmetric(point, times, rings, radius):
    """Force and central film of a squeeze film: ``(r eps p')'/r = d(rho h)/dT`` on rings, Newton, BDF2."""
    inner, outer = np.linspace(0.0, 1.4, 3 * rings // 4 + 1), np.linspace(0.0, 1.0, rings // 4 + 1)[1:]
    edges = np.concatenate([inner, 1.4 + (radius - 1.4) * outer**1.5])
    r, area = 0.5 * (edges[1:] + edges[:-1]), np.pi * np.diff(edges**2)
    deflect, apart = ring_deflections(r, edges), np.append(np.diff(r), edges[-1] - r[-1])
    rim = 2.0 * np.pi * edges[1:] / apart
    n, P, content, found = r.size, np.zeros(r.size), [], []
    for k, (T, u) in enumerate(zip(times, approach(times), strict=True)):
        for _ in range(40 if k else 1):
            h = -u + 0.5 * r * r + deflect @ P
            rho, rho_slope = np.array([density(p, point.law) for p in P]).T
            log_eta, eta_slope = np.array([log_viscosity(p, point.law) for p in P]).T
            if not k:
                break
            dT = T - times[k - 1]
            c = 1.5 / dT if k > 1 else 1.0 / dT
            known = (0.5 * content[-2] - 2.0 * content[-1]) / dT if k > 1 else -content[-1] / dT
            eps = rho * h**3 * np.exp(-log_eta) / point.lam
            face = np.append(np.sqrt(eps[1:] * eps[:-1]), eps[-1])
            inward = rim * face * np.diff(P, append=0.0)
            J = np.zeros((n + 1, n))
            for side, sign in ((np.arange(n), -1.0), (np.arange(1, n), 1.0)):
                at = np.arange(side.size)
                share = (0.5 * inward[at] * (1.0 + (at == n - 1)))[:, None]
                J[at, side] += sign * rim[at] * face[at] + share[:, 0] * (rho_slope / rho - eta_slope)[side]
                J[at] += share * (3.0 / h[side])[:, None] * deflect[side]
            J = J[:n] - np.vstack([np.zeros(n), J[: n - 1]])
            J -= (c * area)[:, None] * (rho[:, None] * deflect + np.diag(rho_slope * h))
            residual = inward - np.append(0.0, inward[:-1]) - area * (c * rho * h + known)
            dP = np.linalg.solve(J, -residual)
            P = np.maximum(P + dP * min(1.0, 0.3 / max(np.abs(dP).max(), 1e-30)), 0.0)
            if np.abs(dP).max() < 1e-7:
                break
        else:
            raise AssertionError(f"no solution at T = {T}")
        content.append(rho * h)
        found.append((1.5 / np.pi * float(area @ P), h[0]))
    return np.array(found)


def squeezed(n, dT, until=6.0):
    """Forces and central films at standstill, and those of the axisymmetric solution at the same times."""
    point, T = MoesPoint(200.0, 10.0, 1.0), np.linspace(0.0, 8.0, 401)
    still = SpeedHistory([0.0, 0.3, STOPPED, 8.0], [1.0, 1.0, 0.0, 0.0])
    motion, grid = PrescribedApproach(T, approach(T)), Grid(n=n, domain=Domain(-4.5, 4.5, 4.5))
    run = simulate(point, motion, grid=grid, time=TimeSteps(until=until, dt=dT), speed=still)
    start = round(STOPPED / dT)
    known = axisymmetric(point, run.t[start:], 80, 4.5)
    pressed = known[:, 0] > 0.1
    return run.force[start:][pressed], run.h_central[start:][pressed], *known[pressed].T


@pytest.mark.long
def test_standstill_against_an_axisymmetric_squeeze_film():
    force, film, known_force, known_film = squeezed(96, 0.04)
    np.testing.assert_allclose(force, known_force, atol=0.01)
    np.testing.assert_allclose(film, known_film, rtol=0.01)
    assert known_film[-1] < 0.99 * known_film[0]


@pytest.mark.slow
def test_standstill_on_a_finer_grid():
    force, film, known_force, known_film = squeezed(192, 0.02)
    np.testing.assert_allclose(force, known_force, atol=1e-3)
    np.testing.assert_allclose(film[known_force > 0.4], known_film[known_force > 0.4], rtol=1.5e-3)


def vibrating(point, grid, W, swing=0.02, periods=4, steps=40, **given):
    """Force over a relative change of speed at fixed approach, from a run."""
    steady = solve_steady(point, grid=grid, tol=1e-9, **given)
    T = np.linspace(0.0, 2.0 * np.pi / W * periods, 2 * steps * periods + 1)
    grid, still = Grid(n=grid.n, domain=steady.domain), PrescribedApproach(T, np.full(T.size, steady.approach))
    time = TimeSteps(until=T[-1], dt=T[2], tol=1e-6)
    speed = SpeedHistory(T, 1.0 + swing * np.sin(W * T))
    run = simulate(point, still, grid=grid, time=time, speed=speed, **given)
    last = run.t > 0.5 * T[-1] + 1e-9
    waves = np.stack([np.sin(W * run.t[last]), np.cos(W * run.t[last]), np.ones(last.sum())], axis=1)
    sine, cosine, _ = np.linalg.lstsq(waves, run.force[last], rcond=None)[0] / swing
    return sine + 1j * cosine


@pytest.mark.long
@pytest.mark.parametrize("W", [0.3, 4.0])
def test_response_to_a_vibrating_speed(W):
    found = response(POINT, to="speed", Omega=W, grid=COARSE)
    assert found.value[0] == pytest.approx(vibrating(POINT, COARSE, W), rel=0.01)
    assert found.lift[0] > 0.0 > found.quadrature[0]


def test_slow_response_is_the_derivative_of_the_steady_film():
    """At constant load: how the approach changes with ln(u_sum)."""
    found = response(POINT, to="speed", Omega=0.0, grid=COARSE)
    near = [
        solve_steady(
            MoesPoint(20.0 * U**-0.75, 5.0 * U**0.25, 1.0), grid=Grid(n=64, domain=found.film.domain), tol=1e-10
        )
        for U in (0.99, 1.01)
    ]
    apart = (near[0].approach - near[1].approach) / np.log(1.01 / 0.99)
    assert found.lift[0] == pytest.approx(apart, rel=1e-3)


@pytest.mark.long
def test_response_of_a_starved_contact():
    """Slow, the derivative of steady films under one layer; fast, that of a run: .53 % apart."""
    point, layer = MoesPoint(50.0, 8.0, 0.7), OilLayer(over_flooded=1.0)
    found = response(point, to="speed", Omega=[0.0, 2.0], grid=Grid(n=48), supply=layer)
    grid, layer = Grid(n=48, domain=found.film.domain), OilLayer(H=float(found.film.layer[0]))
    near = [
        solve_steady(MoesPoint(50.0 * U**-0.75, 8.0 * U**0.25, 0.7), grid=grid, supply=layer, tol=1e-10)
        for U in (0.99, 1.01)
    ]
    apart = (near[0].approach - near[1].approach) / np.log(1.01 / 0.99)
    assert found.lift[0] == pytest.approx(apart, rel=1e-4)
    run = vibrating(point, grid, 2.0, periods=3, steps=80, supply=layer)
    assert found.value[1] == pytest.approx(run, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("W", [0.3, 1.0, 4.0])
@pytest.mark.parametrize("point", [MoesPoint(20.0, 5.0, 1.0), MoesPoint(200.0, 10.0, 0.5)])
def test_responses_of_the_page(point, W):
    grid = Grid(n=128)
    found, run = (
        response(point, to="speed", Omega=W, grid=grid).value[0],
        vibrating(point, grid, W, periods=5, steps=80),
    )
    print(f"{point}, Omega {W:g}: {found:.4f}, {run:.4f}, {abs(run / found - 1.0):.2%} apart")
    assert abs(run / found - 1.0) < 0.005


def test_restart_after_it_turned(tmp_path):
    U, path = SpeedHistory([0.0, 0.2, 0.8, 2.0], [1.0, 1.0, -1.0, -1.0]), tmp_path / "run.h5"
    whole = simulate(POINT, HELD, grid=AROUND, time=TimeSteps(until=1.2, dt=0.1), speed=U)
    simulate(
        POINT, HELD, grid=AROUND, time=TimeSteps(until=0.7, dt=0.1), speed=U, keep=KeepSettings(checkpoint=path)
    )
    rest = simulate(
        POINT, HELD, grid=AROUND, time=TimeSteps(until=1.2, dt=0.1), speed=U, keep=KeepSettings(restart=path)
    )
    np.testing.assert_array_equal(rest.h_midplane, whole.h_midplane)
    with pytest.raises(InputError, match="speed"):
        simulate(POINT, HELD, grid=AROUND, time=TimeSteps(until=1.2, dt=0.1), keep=KeepSettings(restart=path))
    back = read(save(whole, tmp_path / "result.h5"))
    assert back.speed(0.5) == pytest.approx(0.0, abs=1e-15) and back.speed.reverses


def test_in_si():
    oil_point = OperatingPoint(Geometry(0.01, 0.02), Lubricant(eta0=0.04, alpha=2.2e-8), load=50.0, u_sum=2.0)
    t = np.array([0.0, 1e-4, 2e-4, 1e-3])
    history = SpeedHistory.at(oil_point, t, oil_point.u_sum * np.array([1.0, 1.0, 0.5, 0.5]))
    assert history(1e-3 / oil_point.scales.time) == pytest.approx(0.5)
    assert history.corners == pytest.approx([1e-4 / oil_point.scales.time, 2e-4 / oil_point.scales.time])
    with pytest.raises(InputError, match="OperatingPoint"):
        SpeedHistory.at(POINT, t, np.ones(4))


@pytest.mark.parametrize(
    ("T", "U", "words"),
    [
        ([0.0, 1.0, 1.0, 2.0], np.ones(4), "T"),
        ([0.0, 1.0, 1.0 + 1e-12, 2.0], [1.0, 1.0, 2.0, 2.0], "change by at most"),
        ([0.0, 1.0, 2.0, 3.0], [1.0, np.nan, 1.0, 1.0], "values"),
        ([0.0, 2.0], [1.0, 0.5], "length of T = 2: must be at least 4, .*cubic splines"),
        ([0.0, 2.0], [1.0, np.nan], r"^values\[1\] = nan"),
        ([0.0, np.nan], [1.0, 0.5], r"^T\[1\] = nan"),
        ([0.0, 2.0], [1.0, 0.5, 0.5], "^length of values = 3: must be 2"),
        ([0.0, 1.0, 2.0, 3.0], [1.0, 3000.0, 1.0, 1.0], "times that of the operating point"),
    ],
)
def test_bad_histories(T, U, words):
    with pytest.raises(InputError, match=words):
        SpeedHistory(T, U)


def test_steps_over_all_of_a_history_are_said():
    """Times of a history are dimensionless, those of the run at this point seconds."""
    point = OperatingPoint(Geometry(0.01, 0.02), Lubricant(eta0=0.04, alpha=2.2e-8), load=50.0, u_sum=2.0)
    turned = SpeedHistory([0.0, 10.0, 15.0, 20.0, 30.0], [1.0, 1.0, 0.0, 1.0, 1.0])
    with pytest.warns(RuntimeWarning, match=r"changes of the SpeedHistory: .* \(0.1 s\) .* T = 30 .* in seconds"):
        run = simulate(point, HELD, grid=COARSE, time=TimeSteps(until=0.2, dt=0.1), speed=turned)
    assert "steps pass over changes of the SpeedHistory" in run.reservation


@pytest.mark.parametrize(
    ("T", "values", "dT", "passed"),
    [
        ([0.0, 10.0, 15.0, 20.0], [1.0, 1.0, 0.0, -1.0], 25.0, True),  # all of it
        ([0.0, 10.0, 15.0, 20.0], [1.0, 1.0, 0.0, -1.0], 8.0, False),
        ([0.0, 10.0, 10.1, 10.2, 20.0], [1.0, 1.0, 2.0, 1.0, 1.0], 0.5, True),  # there and back
        ([0.0, 10.0, 10.001, 20.0], [1.0, 1.0, 2.0, 2.0], 0.5, False),  # a jump
        ([0.0, 1.0, 2.0, 3.0], [1.0, 1.0, 1.0, 1.0], 20.0, False),  # constant
    ],
)
def test_what_steps_pass_over(T, values, dT, passed):
    table = np.array(T), np.array(values)
    assert passed_over(table, np.arange(0.0, 60.0, dT)) is passed


def test_bad_runs():
    U = SpeedHistory([0.0, 1.0, 2.0, 3.0], [0.0, 0.0, 1.0, 1.0])
    with pytest.raises(InputError, match="standstill"):
        simulate(POINT, HELD, grid=COARSE, speed=U)
    turned = SpeedHistory([0.0, 1.0, 2.0, 3.0], [1.0, 1.0, -1.0, -1.0])
    with pytest.raises(InputError, match="as far behind"):
        simulate(POINT, HELD, grid=Grid(n=64, domain=Domain()), speed=turned)
    with pytest.raises(InputError, match="SpeedHistory"):
        simulate(POINT, HELD, speed=2.0)


DENT = Dent(0.1, 0.6, start=-1.8)


def over(surface, speed, until, steps, point=POINT, **given):
    """A run over a surface in fixed steps, at speeds in equal steps of time."""
    history = None if speed is None else SpeedHistory(np.linspace(0.0, until, len(speed)), speed)
    time = TimeSteps(until=until, dt=until / steps, tol=1e-6)
    return simulate(point, HELD, grid=AROUND, surface=surface, speed=history, time=time, **given)


def test_features_move_with_the_way_of_the_surfaces():
    """At half the speed in twice the time it is the contact of that speed, and at speed 1 the run without one."""
    slow = over(DENT, [0.5] * 4, 4.0, 20)
    same = MoesPoint(POINT.M * 0.5**-0.75, POINT.L * 0.5**0.25, POINT.kappa)
    own = over(DENT, None, 2.0, 20, same)
    np.testing.assert_allclose(slow.h_midplane, own.h_midplane, atol=1e-6)
    assert np.abs(own.h_midplane[-1] - own.h_midplane[0]).max() > 0.05
    for one, other in zip(films(over(DENT, [1.0] * 4, 1.0, 8)), films(over(DENT, None, 1.0, 8)), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.long
def test_features_turn_back_with_the_surfaces(tmp_path):
    """Backwards over the mirror image of the feature it is the mirror image; a checkpoint goes on bit for bit."""
    speed, file = np.array([1.0, 1.0, -1.0, -1.0]), tmp_path / "run.h5"
    ahead = over(DENT, speed, 4.5, 30)
    back = over(lambda X, Y, T: DENT(-X, Y, -T), -speed, 4.5, 30)
    np.testing.assert_array_equal(back.h_midplane, ahead.h_midplane[:, ::-1])
    assert SpeedHistory(np.linspace(0.0, 4.5, 4), speed).way(4.5) == pytest.approx(0.0, abs=1e-12)
    given = {"grid": AROUND, "surface": DENT, "speed": SpeedHistory(np.linspace(0.0, 4.5, 4), speed)}
    half = TimeSteps(until=3.0, dt=0.15, tol=1e-6)
    simulate(POINT, HELD, **given, time=half, keep=KeepSettings(checkpoint=file))
    whole = TimeSteps(until=4.5, dt=0.15, tol=1e-6)
    again = simulate(POINT, HELD, **given, time=whole, keep=KeepSettings(restart=file))
    np.testing.assert_array_equal(again.h_midplane, ahead.h_midplane)
