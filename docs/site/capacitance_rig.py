"""Picture and numbers of docs/notes/capacitance.md: a ball on a disc, its capacitance measured and computed.

python docs/site/capacitance_rig.py   # some seconds
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact.capacitance import DryGap, hertz_capacitance
from ehlcontact.hertz import hertz_contact
from ehlcontact.point import Geometry

PICTURE = Path(__file__).parents[1] / "images" / "capacitance_rig.png"
BALL = Geometry.ball_on_flat(19.05e-3, e1=2.06e11, nu1=0.3, e2=8.1e10, nu2=0.21)  # steel on coated glass
LOAD, PERMITTIVITY = 20.0, 2.027  # N; FVA 3 at 80 °C
FILM, MEASURED = np.array([97.8e-9, 137.4e-9]), np.array([33.2e-12, 17.1e-12])  # m by light; F
BACKGROUND, DOUBT = 89e-12, 0.1  # F that was subtracted, and an error of it that is drawn


def gap():
    """The dry contact of ball and disc."""
    unit = hertz_contact(1.0, BALL.radius_x, BALL.radius_y, BALL.e_reduced).pressure
    return DryGap.under(LOAD, unit, BALL.radius_x, BALL.radius_y)


def draw():
    """Capacitance over the film, with bounds, the plate, and both measurements."""
    films = np.geomspace(60e-9, 220e-9, 60)
    dry = gap()
    computed = [hertz_capacitance(dry, film, PERMITTIVITY) for film in films.tolist()]
    pico = {
        name: np.array([1e12 * float(getattr(one, name)) for one in computed])
        for name in ("total", "least", "largest", "hertz_zone")
    }
    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    axes = figure.subplots()
    axes.fill_between(1e9 * films, pico["least"], pico["largest"], alpha=0.25, label="by where oil stands")
    axes.plot(1e9 * films, pico["total"], label="computed")
    axes.plot(1e9 * films, pico["hertz_zone"], "--", label="plate of Hertz' area")
    axes.errorbar(
        1e9 * FILM, 1e12 * MEASURED, 1e12 * DOUBT * BACKGROUND, fmt="o", color="black", capsize=4,
        label=f"measured less {1e12 * BACKGROUND:.0f} pF;\nbars: {100 * DOUBT:.0f} % of that background",
    )  # fmt: skip
    axes.set(xlabel="film by light [nm]", ylabel="capacitance [pF]", ylim=(0.0, 48.0))
    axes.legend(fontsize="small")
    figure.savefig(PICTURE, dpi=110)


def main():
    """Print the rows of the table, and draw."""
    dry = gap()
    for film, measured in zip(FILM.tolist(), MEASURED.tolist(), strict=True):
        one = hertz_capacitance(dry, film, PERMITTIVITY)
        total, least, largest, plate = (
            1e12 * float(v) for v in (one.total, one.least, one.largest, one.hertz_zone)
        )
        ratio = 1e12 * measured / total
        print(
            f"{1e9 * film:.1f} nm: {total:.1f} ({least:.1f} to {largest:.1f}) pF, "
            f"plate {plate:.1f}, ratio {ratio:.2f}"
        )
    draw()


if __name__ == "__main__":
    main()
