"""Oil supply and heat together: the joint film beside products of separate factors (docs/notes/heat.md).

python docs/site/starved_heat.py   # some minutes
"""

from itertools import product
from time import process_time

import numpy as np
from heat import BEARINGS, FASTEST, OILS, SPEEDS, ball

from ehlcontact import Domain, Grid, Heat, Lubricant, OilLayer, solve_steady
from reduced_models.bearing.catalogue import deep_groove_row

GRID = Grid(128, Domain(-6.0, 1.5, 3.0))
LAYERS = (0.3, 0.6, 1.0, 1.5)  # over the flooded film at the temperature of the inlet


def points():
    """Inner races of bearings, every other of those of heat.py."""
    cases = [
        (name, load, grade, temperature, rpm)
        for (name, load), (grade, temperature), rpm in product(BEARINGS, OILS, SPEEDS)
        if rpm * deep_groove_row(name)[1].pitch_diameter * 1e3 <= FASTEST
    ]
    for name, load, grade, temperature, rpm in cases[::2]:
        yield f"{name} {grade} {rpm:g}", ball(name, Lubricant.iso_vg(grade, temperature=temperature), rpm, load)


def starved(point, r, thermal=None):
    """Film under a layer of r times the flooded one; None where its front is not on the grid."""
    film = solve_steady(point, grid=GRID, supply=OilLayer(over_flooded=r), thermal=thermal, throw=False)
    return film if film.status.ok else print(point, r, thermal is not None, film.status)


def row(name, point):
    """Layer, heat's share of the flooded and of the starved film, and films over the joint one."""
    flooded = solve_steady(point, grid=GRID, thermal=Heat())
    heat = flooded.temperature.film_share
    for r in LAYERS:
        joint, other = starved(point, r, Heat()), starved(point, r / heat)
        if joint is None:
            continue
        h, share = joint.h_central, joint.temperature.film_share
        corrected = np.nan if other is None else heat * other.h_central / h
        yield (
            r,
            flooded.temperature.thermal_load,
            heat,
            share,
            h / (flooded.h_central / heat),
            heat / share,
            corrected,
        )
        print(name, *(f"{x:.4f}" for x in (r, heat, share, heat / share, corrected)), joint.cycles, flush=True)


def grids():
    """Joint film, its share and cycles over the mesh, and time over that without heat."""
    bearing, load = BEARINGS[2]
    point = ball(bearing, Lubricant.iso_vg(68, temperature=50.0), 10_000.0, load)
    for n in (64, 128, 256, 512):
        layer, grid = OilLayer(over_flooded=1.0), Grid(n, GRID.domain)
        spent = []
        for thermal in (None, Heat()):
            started = process_time()
            film = solve_steady(point, grid=grid, supply=layer, thermal=thermal, threads=1)
            spent.append(process_time() - started)
        share, times, h = film.temperature.film_share, spent[1] / spent[0], film.h_central * 1e6
        print(f"n = {n}: {h:.4f} um, {share:.4f}, front {film.front:.2f}, {film.cycles}, {times:.1f}")


def main():
    """Both tables."""
    grids()
    found = np.array([values for name, point in points() for values in row(name, point)])
    for r in LAYERS:
        _, q, heat, share, film, plain, corrected = found[found[:, 0] == r].T
        print(
            f"r = {r:g}: {q.size} points, Q {q.min():.2f} to {q.max():.2f}, flooded share {heat.min():.3f} to "
            f"{heat.max():.3f}, starved share {share.min():.3f} to {share.max():.3f}, "
            f"joint film over the flooded isothermal one {film.min():.3f} to {film.max():.3f}; "
            f"product over the joint film {plain.min():.3f} to {plain.max():.3f}; with the layer over the "
            f"heated film {np.nanmin(corrected):.3f} to {np.nanmax(corrected):.3f}"
        )


if __name__ == "__main__":
    main()
