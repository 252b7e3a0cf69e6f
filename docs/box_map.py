"""The picture of `docs/notes/solver.md`: where the solver was tried, what came out and what it cost.

Run ``python tests/benchmarks/box.py --json box.json`` first, then ``python docs/box_map.py box.json``.
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

PICTURE = Path("docs/images/box.png")


def main(source: Path) -> None:
    """Smallest film and time of every point, over load and ellipse."""
    rows = [row for row in json.loads(source.read_text())["rows"] if "n" in row and "of" not in row]
    good = [row for row in rows if row["status"] == "converged"]
    bad = [row for row in rows if row["status"] != "converged"]
    M, kappa = (np.array([row[name] for row in good]) for name in ("M", "kappa"))
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained", sharey=True)
    panels = (
        (axes[0], np.array([row["h_min"] for row in good]), "viridis", "smallest film / dry approach"),
        (axes[1], np.array([row["seconds"] for row in good]), "inferno_r", "time [s]"),
    )
    for panel, values, colours, title in panels:
        dots = panel.scatter(M, kappa, c=values, cmap=colours, norm=LogNorm(), s=26, edgecolor="0.4", lw=0.3)
        if bad:
            panel.plot(
                [row["M"] for row in bad], [row["kappa"] for row in bad], "x", color="crimson", label="not solved"
            )
            panel.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0, frameon=False)
        panel.set(xscale="log", yscale="log", xlabel="Moes load M")
        panel.set_title(title, loc="left")
        figure.colorbar(dots, ax=panel)
    axes[0].set_ylabel("ellipse ratio kappa = a/b")
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=130)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
