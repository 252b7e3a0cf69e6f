"""The forces on a ball at a contact angle, in `docs/notes/bearings.md`."""

from math import cos, radians, sin
from pathlib import Path

import matplotlib.pyplot as plt

PICTURE = Path(__file__).parents[1] / "images" / "gyroscopic_friction.png"
ANGLE = radians(35.0)  # of both contacts, larger than usual so that the directions are seen


def main() -> None:
    """Draw the section of a ball through the axis of the shaft."""
    figure, ax = plt.subplots(figsize=(4.6, 4.4), layout="constrained")
    ax.add_patch(plt.Circle((0.0, 0.0), 1.0, fill=False, color="0.3", linewidth=1.5))
    # (z, r): towards the outer race, and outward along it
    normal, along = (
        (sin(ANGLE), cos(ANGLE)),
        (-cos(ANGLE), sin(ANGLE)),
    )
    for sign, name, place in ((1.0, "outer race", (0.62, 1.25)), (-1.0, "inner race, turns", (-0.15, -1.3))):
        z, r = (sign * part for part in normal)
        ax.plot(
            [z - 0.6 * along[0], z + 0.6 * along[0]], [r - 0.6 * along[1], r + 0.6 * along[1]], color="0.3", lw=2.5
        )
        ax.text(*place, name, color="0.3")
    ax.plot([-normal[0], normal[0]], [-normal[1], normal[1]], "-.", color="0.6", lw=0.8)

    def arrow(
        start: tuple[float, float], way: tuple[float, float], text: str, at: tuple[float, float], colour: str
    ):
        end = (start[0] + way[0], start[1] + way[1])
        ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 2})
        ax.text(*at, text, color=colour)

    arrow((0.0, 0.0), (0.0, 0.85), r"$m\,\omega_m^2 r$", (-0.62, 0.7), "tab:blue")
    arrow((0.0, 0.0), (0.75 * along[0], 0.75 * along[1]), r"$\omega_R$", (-0.8, 0.15), "tab:green")
    arrow(normal, (0.95 * along[0], 0.95 * along[1]), "friction on the ball", (-1.25, 1.5), "tab:red")
    ax.text(0.13, 0.42, r"$\alpha$", color="0.4")
    arrow((-1.7, -1.75), (0.5, 0.0), "z, along the shaft", (-1.15, -1.8), "0.4")
    arrow((-1.7, -1.75), (0.0, 0.5), "r", (-1.62, -1.35), "0.4")
    ax.set(xlim=(-1.85, 1.5), ylim=(-1.95, 1.75), aspect="equal")
    ax.axis("off")
    figure.savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
