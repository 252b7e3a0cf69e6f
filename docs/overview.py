"""The picture of the README, drawn from the results of the 6205 study.

Run ``ehlcontact run examples/deep_groove_6205.toml`` first, then ``python docs/overview.py``.
"""

from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np

from ehlcontact import SimulationResult, SteadyResult, load
from reduced_models import load_element

RESULTS = Path("results/deep_groove_6205")
PICTURE = Path("docs/images/overview.png")


def main() -> None:
    """Draw pressure, film wave, force loop and rotor response side by side."""
    steady, run = load(RESULTS / "steady.h5"), load(RESULTS / "harmonic.h5")
    assert isinstance(steady, SteadyResult)
    assert isinstance(run, SimulationResult)
    assert steady.scales is not None
    scales = steady.scales
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(2, 2, figsize=(9, 5.6), layout="constrained")

    panel = axes[0, 0]
    P = np.concatenate([steady.P[:, :0:-1], steady.P], axis=1) * scales.pressure * 1e-9
    y = np.concatenate([-steady.Y[:0:-1], steady.Y]) * scales.b * 1e3
    image = panel.pcolormesh(y, steady.X * scales.a * 1e3, P, cmap="inferno", shading="gouraud", rasterized=True)
    panel.set(xlim=(-1.3, 1.3), ylim=(-0.19, 0.16), xlabel="y across [mm] (compressed)", ylabel="x rolling [mm]")
    panel.set_title("film pressure [GPa], full transient EHL", loc="left")
    figure.colorbar(image, ax=panel)

    panel = axes[0, 1]
    wave = (run.h_midplane - run.h_midplane[0]) * scales.length * 1e6
    image = panel.pcolormesh(run.T, run.X, wave.T, cmap="RdBu_r", vmin=-0.02, vmax=0.02, rasterized=True)
    panel.set(ylim=(-1.1, 1.0), xlabel="time T [2a/u_sum]", ylabel="X = x/a")
    panel.set_title("film change [um], carried through", loc="left")
    figure.colorbar(image, ax=panel)

    panel = axes[1, 0]
    element = load_element(RESULTS / "elements" / "harmonic_cubic.json")
    late = run.T > run.T[-1] / 3.0
    for name, force, style in (
        ("full film", run.force, "-"),
        ("cubic spring and damper", element.force(run.approach, run.rate), "--"),
    ):
        panel.plot(
            run.approach[late] * scales.length * 1e6,
            (force - element.spring(run.approach))[late] * scales.force,
            style,
            label=name,
        )
    panel.set(xlabel="approach [um]", ylabel="damping force [N]")
    panel.set_title("force over approach, less the spring", loc="left")
    panel.legend(frameon=False, fontsize=8, loc="center")

    panel = axes[1, 1]
    with h5py.File(RESULTS / "rotor_full.h5", "r") as file:
        t, force = file["t"][...], file["force"][...]
    panel.plot(t * 1e3, force[:, 0], label="contact 1")
    panel.plot(t * 1e3, force[:, 1], label="contact 2")
    panel.set(xlabel="time [ms]", ylabel="contact force [N]")
    panel.set_title("Jeffcott rotor on full contacts", loc="left")
    panel.legend(frameon=False, fontsize=8)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
