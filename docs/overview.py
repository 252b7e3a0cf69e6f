"""The picture of the README, drawn from the results of the 6205 study.

Run ``ehlcontact run examples/deep_groove_6205.toml`` first, then ``python docs/overview.py``.
"""

import json
from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np

from ehlcontact import read
from ehlcontact.results import SteadyResult
from ehlcontact.transient.result import SimulationResult
from reduced_models import FilmContact

RESULTS = Path("results/deep_groove_6205")
PICTURE = Path("docs/images/overview.png")


def main() -> None:
    """Draw pressure, film wave, damping over frequency and rotor response side by side."""
    steady, run = read(RESULTS / "steady.h5"), read(RESULTS / "harmonic.h5")
    assert isinstance(steady, SteadyResult)
    assert isinstance(run, SimulationResult)
    scales = steady.point.scales
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(2, 2, figsize=(9, 5.6), layout="constrained")

    panel = axes[0, 0]
    P = np.concatenate([steady.p[:, :0:-1], steady.p], axis=1) * 1e-9
    y = np.concatenate([-steady.y[:0:-1], steady.y]) * 1e3
    along, wide = scales.a * 1e3, scales.b * 1e3
    image = panel.pcolormesh(y, steady.x * 1e3, P, cmap="inferno", shading="gouraud", rasterized=True)
    panel.set(xlim=(-1.35 * wide, 1.35 * wide), ylim=(-1.9 * along, 1.6 * along))
    panel.set(xlabel="y across [mm] (compressed)", ylabel="x rolling [mm]")
    panel.set_title("film pressure [GPa], full transient EHL", loc="left")
    figure.colorbar(image, ax=panel)

    panel = axes[0, 1]
    wave, T, X = (run.h_midplane - run.h_midplane[0]) * 1e6, run.t / scales.time, run.x / scales.a
    largest = float(np.percentile(np.abs(wave[:, np.abs(X) < 0.9]), 98))  # outside, the film follows the load
    image = panel.pcolormesh(T, X, wave.T, cmap="RdBu_r", vmin=-largest, vmax=largest, rasterized=True)
    panel.set(ylim=(-1.1, 1.0), xlabel="time T [2a/u_sum]", ylabel="X = x/a")
    panel.set_title("film change [µm], carried through", loc="left")
    figure.colorbar(image, ax=panel)

    panel = axes[1, 0]
    found = json.loads((RESULTS / "results.json").read_text(encoding="utf-8"))
    film = found["memory"]["impedance"]
    rotor = found["operating_point"]["rotor_omega"] / found["operating_point"]["time_unit"]  # rad/s
    memory = read(RESULTS / "elements" / "memory.json", FilmContact)
    omega = np.geomspace(0.5 * rotor, film["omega"][-1], 300)
    hz = 0.5 / np.pi
    panel.loglog(hz * np.array(film["omega"][1:]), film["damping"][1:], "o", markersize=4, label="full film")
    panel.plot(hz * omega, memory.impedance(omega=omega).damping, label="film memory, one element")
    cubics = [row for row in found["fits"] if row["model"] == "cubic" and "refused" not in row]
    at = [hz * np.mean(row["valid"]["omega"]) for row in cubics]
    panel.plot(
        at, [row["parameters"]["C1"] for row in cubics], "s", color="tab:red", label="cubics, one band each"
    )
    panel.axvline(hz * rotor, color="grey", linestyle=":")
    panel.annotate(" rotor", (hz * rotor, 0.3), xycoords=("data", "axes fraction"), color="grey")
    panel.set(xlabel="frequency [Hz]", ylabel="damping [N s/m]")
    panel.set_title("damping of the contact and of its elements", loc="left")
    panel.legend(frameon=False, fontsize=8)

    panel = axes[1, 1]
    told = found["rotor"]["decay"]["decrements"]
    with h5py.File(RESULTS / "decay.h5", "r", locking=False) as file:
        t, height = file["t"][...], file["journal"][:, 1]
    size = 1e9 * told["full"]["amplitude"]
    panel.plot(t * 1e3, 1e9 * (height - height[0]), label="full contacts")
    since = t[t >= t[-1] - told["full"]["periods"] / told["full"]["hz"]]
    for name, label, style in (("rotor_band", "cubic", "--"), ("dry", "dry Hertz", "-.")):
        gone = (since - since[0]) * told[name]["hz"]
        panel.plot(since * 1e3, size * np.exp(-told[name]["decrement"] * gone), style, label=f"{label}, amplitude")
    panel.set(xlabel="time [ms]", ylabel="journal about rest [nm]", ylim=(-1.2 * size, 1.8 * size))
    panel.set_title("rotor after a kick: the film damps it", loc="left")
    panel.legend(frameon=False, fontsize=8, ncols=2)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
