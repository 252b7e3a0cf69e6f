"""An atlas of one's own, solved by a Dask cluster: here of a few light contacts, on the cores of this machine.

    python examples/atlas_on_a_cluster.py [atlas_on_a_cluster.png]     # some minutes; needs ehlcontact[cluster]

What one learns: any scheduler's address makes a cluster of many machines do the work, what was solved survives a
kill, and an atlas knows how right it is: this one has 30 contacts where the shipped one has hundreds, and its
error bars say so.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import MoesPoint
from reduced_models import Atlas
from reduced_models.atlas.build import build as build_table

DRAWS, LIGHT = 0, 20  # sample points over the whole box, and at light loads, where they are solved soon
POINTS = [MoesPoint(M, 10.0, 0.3) for M in (2.0, 5.0, 10.0, 20.0)]


def build(folder: Path, draws: int = DRAWS, light: int = LIGHT, workers: int = 2, **options: Any) -> Atlas:
    """Solve and put together; called again with the same folder it goes on where it was."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0") as cluster:
        # a cluster of many machines: the address that `dask scheduler` prints
        address = cluster.scheduler_address
        sample = {"draws": draws, "light_draws": light}
        build_table("film", folder / "small.h5", folder / "work", sample, scheduler=address, **options)
    return Atlas(folder / "small.h5")


def films(atlas: Atlas) -> list[tuple[float, float]]:
    """Central film at the points, and its error bar."""
    answers = [atlas.at(point) for point in POINTS]
    return [(answer.h_central, answer.error_bars["h_central"]) for answer in answers]


def main(picture: str = "atlas_on_a_cluster.png") -> None:
    """Build, and compare films of both atlases by their error bars."""
    from matplotlib.figure import Figure

    with tempfile.TemporaryDirectory() as folder:
        small = build(Path(folder), progress=lambda done, of: print(f"\r{done} of {of} solved", end=""))
    axes = (figure := Figure(figsize=(9.0, 3.6), layout="constrained")).add_subplot()
    mine, theirs = films(small), films(shipped := Atlas())
    print("\n     M  film, this atlas      film, shipped atlas")
    for point, (h, bar), (other, narrow) in zip(POINTS, mine, theirs, strict=True):
        print(f"{point.M:6g}  {h:.4f} +- {bar:.4f}      {other:.4f} +- {narrow:.4f}")
    for atlas, found, name, aside in ((small, mine, "this one", 0.97), (shipped, theirs, "shipped", 1.03)):
        M = [aside * point.M for point in POINTS]
        h, bar = (np.array(one) / [film for film, _ in theirs] for one in zip(*found, strict=True))
        label = f"{name}, {atlas.metadata['points']} contacts"
        axes.errorbar(M, h, yerr=bar, fmt="o", capsize=4, label=label)
    axes.set(xscale="log", xlabel="M", ylabel="central film over that of the shipped atlas")
    axes.legend(frameon=False, loc="lower left")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
