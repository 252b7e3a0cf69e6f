"""What balls that pass do to a mode: bearings change as the rotor vibrates. By Hill's determinant and in time."""

from math import pi

import numpy as np
import pytest

from reduced_models import linearise, simulate_rotor
from reduced_models.bearing.ring_statics import equilibrium_under, linear_balls

RPM, DISC = 3000.0, 12
POSITIONS, HARMONICS = 24, 2


def floquet(at, mode):
    """Eigenvalue near that of the mean: q = sum q_n exp((s + i n w) t), w that of the balls that pass.

    Bearings at a position of the cage have Z(s) of that position; its harmonics over the passage couple all q_n.
    """
    bearing, size = at.rotor.mounts[0].bearing, at.rotor.size
    first = at.rotor.mounts[0].cage_angle
    angles = first + 2.0 * pi / bearing.balls * np.arange(POSITIONS) / POSITIONS
    places = [
        linear_balls(bearing, RPM, [equilibrium_under(bearing, at.loads[0], RPM, angle)])
        for angle in angles.tolist()
    ]
    passing, rings, (M, C, K) = 2.0 * pi * bearing.frequencies(RPM).bpfo, at.rotor.support_rows, at.matrices
    count = 2 * HARMONICS + 1

    def matrix(s):
        rows = np.zeros((count, size, count, size), complex)
        for n in range(count):
            here = s + 1j * (n - HARMONICS) * passing
            Z = np.fft.fft([place.impedance(here) for place in places], axis=0) / POSITIONS
            for m in range(count):
                both = np.kron(np.eye(len(at.rotor.mounts)), Z[(m - n) % POSITIONS])
                rows[m, :, n] = rings.T @ both @ rings
            rows[n, :, n] += here * here * M + here * C + K
        return rows.reshape(count * size, count * size)

    s, q = mode.eigenvalue, np.zeros(count * size, complex)
    q[HARMONICS * size : (HARMONICS + 1) * size] = mode.shape
    along = q.conj() / np.vdot(q, q)
    for _ in range(8):
        A = matrix(s)
        y = np.linalg.solve(A, (matrix(s + 1e-3) - A) @ q / 1e-3)
        q, s = y / (along @ y), s - (along @ q) / (along @ y)
    return s


def poles(y, dt, order=30):
    """Frequencies [Hz] and decrements of a sum of damped vibrations, the strongest first (matrix pencil)."""
    windows = np.lib.stride_tricks.sliding_window_view(y, y.size // 2)
    V = np.linalg.svd(windows, full_matrices=False)[2][:order].T
    s = np.log(np.linalg.eigvals(np.linalg.lstsq(V[:-1], V[1:], rcond=None)[0]).astype(complex)) / dt
    strength = np.abs(np.linalg.lstsq(np.exp(np.outer(np.arange(y.size) * dt, s)), y + 0j, rcond=None)[0])
    s = s[np.argsort(-strength)]
    s = s[s.imag > 1.0]
    return s.imag / (2.0 * pi), -2.0 * pi * s.real / s.imag


@pytest.mark.long
def test_a_mode_across_the_load(film, beam):
    """Stiffness across the load changes by a quarter as a ball passes: decrement by 0.7 %, frequency by 0.2 %.

    A fit of one vibration to the run would see 2 % more: beside the mode swing its sidebands, at the frequency of
    the balls that pass less its own and so on.
    """
    rotor = beam(film, unbalances=())
    at = linearise(rotor, RPM)
    mode, exact = at.modes()[0], floquet(at, at.modes()[0])
    decrement = -2.0 * pi * exact.real / exact.imag
    assert exact.imag == pytest.approx(mode.omega, rel=2e-3)
    assert 1.005 < decrement / mode.decrement < 1.009
    rest, dt = rotor.equilibrium(RPM), 2e-5
    kick = 2e-8 * mode.shape
    starts = (rest + kick.real, (mode.eigenvalue * kick).real), (rest, np.zeros(rotor.size))
    with_it, without = (
        simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=0.5, start=start, rho_inf=1.0).displacement[:, DISC]
        for start in starts
    )
    hz, seen = poles((with_it - without)[2500::40], 40 * dt)
    assert seen[0] == pytest.approx(decrement, rel=2e-3)
    assert hz[0] == pytest.approx(exact.imag / (2.0 * pi), rel=2e-3)
    passing = film.frequencies(RPM).bpfo
    sidebands = [abs(hz[0] + n * passing) for n in (-1, 1, -2)]
    assert all(np.abs(hz[1:8] - one).min() < 0.01 * one + 0.5 for one in sidebands[:2])


def test_a_mode_along_the_load(film, beam):
    """Along the load hardly anything changes as balls pass."""
    at = linearise(beam(film, unbalances=()), RPM)
    mode = at.modes()[1]
    exact = floquet(at, mode)
    assert exact.imag == pytest.approx(mode.omega, rel=1e-4)
    assert -2.0 * pi * exact.real / exact.imag == pytest.approx(mode.decrement, rel=1e-3)
