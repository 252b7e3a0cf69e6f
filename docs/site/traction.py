"""Numbers and the picture of docs/notes/traction.md.

python docs/site/traction.py   # a minute
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

from ehlcontact import Geometry, Grid, Heat, Lubricant, OperatingPoint, solve_steady
from ehlcontact.film_formulas import load_number
from ehlcontact.lubricant import Carreau, Eyring, LimitingShear
from ehlcontact.lubricant.traction_laws import log_sinh_law
from ehlcontact.traction import traction_curve

IMAGES = Path(__file__).parents[1] / "images"
BALL = {"ball_diameter": 7.938e-3, "pitch_diameter": 39.1e-3, "conformity": 0.52}  # 6205
OILS = ((32, 70.0), (68, 50.0), (150, 60.0))  # grade, C
GRID = Grid(128)
HEAVY = 100.0  # load number from which on a film under load is nearly Hertz's contact
STRESS = 5e6  # Pa


def films():
    """Films over M, L, kappa and speed: balls in a 6205, on a disc, and an ellipse between."""
    for grade, temperature in OILS:
        oil = Lubricant.iso_vg(grade, temperature=temperature)
        points = [
            OperatingPoint.ball_bearing(oil, **BALL, speed_rpm=rpm, load=load)
            for rpm in (1000.0, 6000.0)
            for load in (50.0, 300.0)
        ]
        for speed in (0.3, 3.0):
            for load in (10.0, 60.0):
                points.append(
                    OperatingPoint.ball_on_flat(oil, ball_diameter=19.05e-3, entrainment_speed=speed, load=load)
                )
            points.append(OperatingPoint(Geometry(radius_x=10e-3, radius_y=25e-3), oil, 100.0, 2.0 * speed))
        yield from (solve_steady(point, grid=GRID) for point in points)


def power_mean(log_values, weights, q):
    """Logarithm of the power mean with the exponent q."""
    top = log_values.max()
    return top + np.log(weights @ np.exp(q * (log_values - top))) / q


def exponent(y):
    """Exponent of the mean for a contact whose mean stress is y times Eyring's (docs/notes/traction.md)."""
    return (1.0 + (y / 1.36) ** 1.33) ** -1.36


def characteristic(film, ratio):
    """Characteristic shear: power mean over the ellipse of the Newtonian stress over Eyring's.

    Its exponent is that of the mean stress asinh(characteristic shear), so the mean stress itself is not needed.
    """
    stress, s = film.traction(ratio, Eyring(STRESS)).stress / STRESS, film.point.scales
    inside = ((film.x[:, None] / s.a) ** 2 + (film.y[None, :] / s.b) ** 2 < 1.0) & (stress > 0.0)
    log_newton = np.log(np.sinh(stress[inside]))
    weights = np.broadcast_to(np.where(film.y == 0.0, 0.5, 1.0), stress.shape)[inside]
    weights = weights / weights.sum()

    def missing(y):
        return float(log_sinh_law(power_mean(log_newton, weights, exponent(y)))) - y

    return float(np.sinh(brentq(missing, 1e-9, 100.0)))


def curve(found, ratios):
    """Load numbers of films, their characteristic shear and mean stress over Eyring's at these ratios."""
    rows = []
    for film in found:
        N = load_number(film.point.moes.M, film.point.moes.kappa)
        y = film.traction(ratios, Eyring(STRESS)).mean_stress / STRESS
        rows += [(N, characteristic(film, ratio), one) for ratio, one in zip(ratios, y, strict=True)]
    return np.array(rows)


def draw_stress(axes, film):
    """Map of the shear stress and Hertz's ellipse; the film is even in y."""
    map_of, s = film.traction(0.01, Eyring()), film.point.scales
    y = np.concatenate([-map_of.y[:0:-1], map_of.y])
    stress = np.concatenate([map_of.stress[:, :0:-1], map_of.stress], axis=1)
    mesh = axes.pcolormesh(
        map_of.x * 1e6, y * 1e6, stress.T * 1e-6, shading="gouraud", cmap="magma", rasterized=True
    )
    turn, a, b = np.linspace(0.0, 2.0 * np.pi, 181), s.a * 1e6, s.b * 1e6
    axes.plot(a * np.cos(turn), b * np.sin(turn), "--", color="white", linewidth=0.8)
    axes.set(xlim=(-1.5 * a, 1.5 * a), ylim=(-1.5 * b, 1.5 * b), xlabel="x along rolling [µm]")
    axes.set(ylabel="y across [µm]", title="shear stress, Eyring, slide-to-roll ratio 0.01")
    axes.figure.colorbar(mesh, ax=axes, label="shear stress [MPa]")


def main():
    """Print what the page says, and draw."""
    rows = curve(list(films()), np.geomspace(1e-5, 2.0, 25))
    rows = rows[rows[:, 2] > 0.1]
    off = rows[:, 2] / np.arcsinh(rows[:, 1]) - 1.0
    heavy = rows[:, 0] > HEAVY
    print(f"one curve: {heavy.sum()} points, N > {HEAVY:g}: {off[heavy].min():.3f} to {off[heavy].max():.3f}")
    print(f"the others: {(~heavy).sum()} points: {off[~heavy].min():.3f} to {off[~heavy].max():.3f}")
    point = OperatingPoint.ball_bearing(
        Lubricant.iso_vg(68, temperature=50.0), **BALL, speed_rpm=3000.0, load=200.0
    )
    film = solve_steady(point)
    ratios = np.geomspace(1e-5, 1.0, 41)
    figure = Figure(figsize=(11.0, 7.6), layout="compressed")
    axes = figure.subplots(2, 2)
    for law, name in (
        (Eyring(), "Eyring, 5 MPa"),
        (Carreau(exponent=0.25), "Carreau, 5 MPa, n = 0.25"),
        (LimitingShear(), "limiting stress 0.05 p"),
    ):
        axes[0, 0].plot(ratios, film.traction(ratios, law).coefficient, label=name)
    warm = traction_curve(point, ratios[::4], Eyring(), thermal=Heat(), grid=GRID)
    axes[0, 0].plot(ratios[::4], warm.coefficient, "o--", ms=3, label="Eyring, film heated")
    print("heated", np.c_[ratios[::4], warm.coefficient, warm.warming])
    print("isothermal", film.traction(ratios[::4], Eyring()).coefficient)
    axes[0, 0].set(
        xscale="log", xlabel="slide-to-roll ratio", ylabel="traction over load", title="6205, 200 N on the ball"
    )
    axes[0, 0].legend(frameon=False, fontsize=8)
    draw_stress(axes[0, 1], film)
    axes[1, 0].loglog(rows[heavy, 1], rows[heavy, 2], ".", ms=4, label=f"N > {HEAVY:g}")
    axes[1, 0].loglog(rows[~heavy, 1], rows[~heavy, 2], ".", ms=4, label="lightly loaded")
    at = np.geomspace(rows[:, 1].min(), rows[:, 1].max(), 200)
    axes[1, 0].loglog(at, np.arcsinh(at), "k-", lw=0.8, label="asinh")
    axes[1, 0].set(xlabel="characteristic shear", ylabel="mean stress over Eyring's", title="30 films, one curve")
    axes[1, 0].legend(frameon=False, fontsize=8)
    loads = (20.0, 100.0, 500.0)
    for load in loads:
        one = OperatingPoint.ball_bearing(point.lubricant, **BALL, speed_rpm=3000.0, load=load)
        curve_of = solve_steady(one, grid=GRID).traction(ratios, Eyring())
        axes[1, 1].plot(ratios, curve_of.coefficient, label=f"{load:g} N, {1e-9 * one.scales.pressure:.2f} GPa")
    axes[1, 1].set(
        xscale="log", xlabel="slide-to-roll ratio", ylabel="traction over load", title="Eyring, over the load"
    )
    axes[1, 1].legend(frameon=False, fontsize=8)
    figure.savefig(IMAGES / "traction.png", dpi=110)


if __name__ == "__main__":
    main()
