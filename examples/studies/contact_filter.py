"""Contact filter: force of waves on a surface over their height times the impedance, for films of three contacts.

A wave much longer than the contact acts like an approach. One as short as the contact has summits and valleys in
it at the same time, and the film that it lets in at the inlet is carried through. Half a minute on one core:

    python examples/studies/contact_filter.py [contact_filter.png]
"""

import sys

import numpy as np

from ehlcontact import Grid, MoesPoint, excitation
from ehlcontact.results import Response

WAVES = np.geomspace(1.0, 32.0, 41)  # semi-axes a
GRID = Grid(n=128)
CONTACTS = {
    "M 20, L 5, kappa 1": MoesPoint(20, 5, 1.0),
    "M 200, L 10, kappa 0.5": MoesPoint(200, 10, 0.5),
    "M 500, L 12, kappa 0.12": MoesPoint(500, 12, 0.12),
}


def filters() -> dict[str, Response]:
    """Contact filters over `WAVES`, by the name of the contact."""
    return {name: excitation(point, wavelength=WAVES, grid=GRID) for name, point in CONTACTS.items()}


def dry(wavelength: np.ndarray) -> np.ndarray:
    """Contact filter without a film."""
    return np.abs(np.sinc(2.0 / wavelength))


def draw(found: dict[str, Response], path: str) -> None:
    """Filters with their error bars, and the dry one; below, the phase of the force."""
    import matplotlib.pyplot as plt

    figure, (size, phase) = plt.subplots(2, 1, sharex=True, figsize=(6.4, 6.4), layout="constrained")
    for name, result in found.items():
        (line,) = size.plot(result.wavelength, result.contact_filter, label=name)
        low, high = (result.contact_filter + sign * result.error_bars["contact_filter"] for sign in (-1.0, 1.0))
        size.fill_between(result.wavelength, low, high, color=line.get_color(), alpha=0.2, lw=0)
        phase.plot(result.wavelength, np.degrees(np.unwrap(np.angle(result.value[::-1]))[::-1]))
    fine = np.geomspace(WAVES[0], WAVES[-1], 800)
    size.plot(fine, dry(fine), "k:", label="dry, |sin(k)/k|")
    size.set(ylabel="contact filter |G/Z|", xscale="log", ylim=(0.0, 1.02))
    size.legend()
    ticks = [1, 2, 4, 8, 16, 32]
    phase.set(xlabel="wavelength [semi-axes a]", ylabel="phase of the force [degrees]")
    phase.set_xticks(ticks, map(str, ticks))
    phase.minorticks_off()
    phase.set_yticks([-360, -270, -180, -90, 0])
    for axes in (size, phase):
        axes.grid(color="#dddddd")
    figure.savefig(path, dpi=130)


def main() -> None:
    """Print the filters and draw the picture."""
    found = filters()
    print("wavelength/a " + "".join(f"{name:>26}" for name in found) + f"{'dry':>10}")
    for k, wavelength in enumerate(WAVES):
        values = "".join(f"{r.contact_filter[k]:>26.3f}" for r in found.values())
        print(f"{wavelength:12.2f} {values}{dry(wavelength):>10.3f}")
    draw(found, sys.argv[1] if len(sys.argv) > 1 else "contact_filter.png")


if __name__ == "__main__":
    main()
