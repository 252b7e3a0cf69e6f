"""Numbers and the picture of stiffness and damping with heat in docs/notes/heat.md.

python docs/site/heat_impedance.py   # minutes
"""

from pathlib import Path

import numpy as np
from heat import ball
from matplotlib.figure import Figure

from ehlcontact import Grid, Heat, Lubricant, impedance, solve_steady
from ehlcontact.linearised_film import held
from ehlcontact.solver.linearised_contact import LinearisedContact

IMAGES = Path(__file__).parents[1] / "images"
OMEGA = np.geomspace(0.05, 100.0, 40)
TABLE = (0.0, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
POINT = ball("6305", Lubricant.iso_vg(68, temperature=50.0), 10_000.0, 2000.0)
GRID = Grid(128)
HEAT = Heat()


def times():
    """Time scales, over that of the contact, a/u."""
    s, heat = POINT.scales, HEAT
    film = solve_steady(POINT, grid=GRID, thermal=heat)
    across = heat.heat_capacity * film.h_central**2 / (12.0 * heat.conductivity) / s.time
    print(f"a/u {1e6 * s.time:.2f} us, Omega = 1 is {0.5 / np.pi / s.time:.0f} Hz")
    for factor in (1.0, 3.0):
        print(f"conduction across {factor:g} times the central film: {factor**2 * across:.3f} a/u")


def responses(omega):
    """K and C [N/m, N s/m] at these Omega: isothermal, with heat at a fixed viscosity, and one that follows."""
    cold, warm = (impedance(POINT, Omega=omega, grid=GRID, thermal=heat) for heat in (None, HEAT))
    film = solve_steady(POINT, grid=Grid(warm.film.n, warm.film.domain), thermal=HEAT)
    Z = LinearisedContact(held(film)).respond(np.maximum(omega, 1e-4), 1e-5)[0]
    still = Z.real * POINT.scales.stiffness, Z.imag / np.maximum(omega, 1e-4) * POINT.scales.damping
    return (cold.stiffness, cold.damping), still, (warm.stiffness, warm.damping)


def draw(found):
    """K and C over frequency."""
    figure = Figure(figsize=(8.6, 3.9), layout="constrained")
    left, right = figure.subplots(1, 2)
    styles = (
        ("isothermal", "k--"),
        ("with heat, viscosity held fixed", "C0:"),
        ("with heat, viscosity follows", "C3-"),
    )
    for (name, style), (K, C) in zip(styles, found, strict=True):
        left.plot(OMEGA, K * 1e-6, style, label=name)
        right.plot(OMEGA, C, style, label=name)
    hz = 0.5 / np.pi / POINT.scales.time
    for axes, label in ((left, "stiffness K, N/µm"), (right, "damping C, N s/m")):
        axes.set(xscale="log", xlabel="Omega (unit of time a/u)", ylabel=label)
        axes.secondary_xaxis("top", functions=(lambda w: w * hz * 1e-3, lambda f: f / hz * 1e3)).set_xlabel("kHz")
        axes.grid(alpha=0.3)
    right.set_yscale("log")
    left.legend(frameon=False, fontsize=8)
    figure.savefig(IMAGES / "heat_impedance.png", dpi=130)


def main():
    """All of it."""
    times()
    cold, still, warm = responses(np.array(TABLE))
    for k, w in enumerate(TABLE):
        print(f"Omega {w:g}: K " + " ".join(f"{K[k] * 1e-6:.2f}" for K, _ in (cold, still, warm)), end="; C ")
        print(" ".join(f"{C[k]:.2f}" for _, C in (cold, still, warm)))
    draw(responses(OMEGA))


if __name__ == "__main__":
    main()
