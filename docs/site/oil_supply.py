"""Numbers and pictures of docs/notes/oil_supply.md.

python docs/site/oil_supply.py   # some minutes
"""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import minimize_scalar

from ehlcontact import (
    Domain,
    Geometry,
    Grid,
    HarmonicLoad,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.film_formulas import film_of_layer
from ehlcontact.lubricant import density
from ehlcontact.side_flow import layer_after_passes, oil_passes, side_flow
from reduced_models import BallBearing, OilBalance
from reduced_models.bearing.fed_layer import lost_share

IMAGES = Path(__file__).parents[1] / "images"
POINTS = (MoesPoint(20, 10, 1), MoesPoint(200, 10, 1), MoesPoint(200, 10, 0.5), MoesPoint(2900, 19, 0.11))
RATIOS = np.array([0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0])
CIRCLE, LAYER = POINTS[0], 0.495


def curve(ratio: np.ndarray, exponent: float) -> np.ndarray:
    """Film over the flooded one."""
    return ratio / (1.0 + ratio**exponent) ** (1.0 / exponent)


def films() -> None:
    """Film over supply at the points, with the fitted curve."""
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    at = np.linspace(0.05, 3.2, 200)
    for point in POINTS:
        grid = Grid(256 if point.kappa > 0.2 else 128, Domain(-9.0, 1.5, 3.0) if point.kappa < 0.2 else None)
        flooded = solve_steady(point, grid=grid)
        solved = [solve_steady(point, grid=grid, supply=OilLayer(over_flooded=r)) for r in RATIOS]
        found = np.array([film.h_central for film in solved]) / flooded.h_central
        best = minimize_scalar(lambda g, found=found: np.abs(curve(RATIOS, g) / found - 1.0).max(), (2.0, 5.0))
        fronts = [float(film.x[np.argmax(film.p[:, 0] > 0.0)]) for film in solved]
        name = f"{point.M:g}, {point.L:g}, {point.kappa:g}"
        print(f"({name}): g {best.x:.2f}, largest deviation {100.0 * best.fun:.1f} %")
        print("   ", *(f"{r:g}: {h:.3f} at {x:.2f};" for r, h, x in zip(RATIOS, found, fronts, strict=True)))
        (line,) = axes.plot(RATIOS, found, "o", label=f"({name}), g = {best.x:.1f}")
        axes.plot(at, curve(at, best.x), color=line.get_color())
    axes.plot([0.0, 1.0, 3.2], [0.0, 1.0, 1.0], "--", color="grey", linewidth=0.8)
    axes.set(
        xlabel="layer of oil over what the flooded film lets through", ylabel="central film over the flooded one"
    )
    axes.legend(title="M, L, kappa")
    figure.savefig(IMAGES / "oil_supply.png", dpi=130)


def map_of_a_film() -> None:
    """Pressure and content of a starved film."""
    film = solve_steady(CIRCLE, grid=Grid(256), supply=OilLayer(H=LAYER))
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    Y = np.concatenate([-film.y[:0:-1], film.y])
    for axes, field, words, colours in zip(
        figure.subplots(1, 2),
        (film.p, film.content),
        ("pressure over Hertz's", "part of the gap filled"),
        ("inferno", "cividis"),
        strict=True,
    ):
        whole = np.concatenate([field[:, :0:-1], field], axis=1)
        mesh = axes.pcolormesh(film.x, Y, whole.T, cmap=colours, shading="gouraud", rasterized=True)
        turn = np.linspace(0.0, 2.0 * np.pi, 181)
        axes.plot(np.cos(turn), np.sin(turn), "--", color="white", linewidth=0.8)
        axes.set(xlabel="x/a", ylabel="y/b", xlim=(-3.0, 1.5), ylim=(-2.2, 2.2), aspect="equal")
        figure.colorbar(mesh, ax=axes, label=words)
    figure.savefig(IMAGES / "oil_content.png", dpi=130)


def grids() -> None:
    """Central film on grids of twice the intervals each."""
    last = None
    for n in (64, 128, 256, 512):
        film = solve_steady(CIRCLE, grid=Grid(n), supply=OilLayer(H=LAYER), tol=1e-8)
        change = "" if last is None else f", {100.0 * (film.h_central / last - 1.0):+.3f} %"
        print(f"n {n}: {film.h_central:.6f}{change}")
        last = film.h_central


def case_a() -> None:
    """The layer that gives the film of Nijenbanning, Venner and Moes (1994), case A, on their region."""
    point = OperatingPoint(
        geometry=Geometry(19.05e-3, 152.4e-3, e1=206.8e9, e2=206.8e9),
        lubricant=Lubricant(eta0=17.9e-3, alpha=1.48e-8, viscosity="barus"),
        load=992.4,
        u_sum=49.74,
    )
    near = Grid(256, Domain(-2.5, 1.5, 2.05))
    for grid, supply in ((near, None), (Grid(256), None), (Grid(256), OilLayer(2.2105e-6))):
        film = solve_steady(point, grid=grid, supply=supply)
        print(f"{1e6 * film.h_central:.3f} um, {1e6 * film.h_min:.3f} um", *str(film).splitlines()[4:5])


def through_time() -> None:
    """Central film under an oscillating load, and the layer that leaves."""
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    motion, time = HarmonicLoad(amplitude=0.3, Omega=2.0), TimeSteps(periods=2, steps_per_period=60)
    for ratio in (None, 1.5, 1.0, 0.6):
        supply = None if ratio is None else OilLayer(over_flooded=ratio)
        run = simulate(CIRCLE, motion, grid=Grid(128), supply=supply, time=time)
        left.plot(run.t, run.h_central, label="flooded" if ratio is None else f"r = {ratio:g}")
        if ratio == 1.0:
            mesh = right.pcolormesh(
                run.t, run.y, run.layer_behind.T, cmap="cividis", shading="gouraud", rasterized=True
            )
    left.set(xlabel="T u_sum/(2a)", ylabel="central film over the dry approach", ylim=(0.0, None))
    left.legend(ncols=2, loc="lower left")
    right.set(xlabel="T u_sum/(2a)", ylabel="y/b", ylim=(0.0, 2.0))
    figure.colorbar(mesh, ax=right, label="layer behind over the dry approach")
    figure.savefig(IMAGES / "oil_through_time.png", dpi=130)


def passes() -> None:
    """Film pass after pass, solved and by formulas; and the films of a bearing whose oil is cut off."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    count = 100
    for point, g, grid in ((CIRCLE, 2.67, Grid(256)), (POINTS[2], 4.11, Grid(256))):
        flooded = solve_steady(point, grid=grid)
        full = float(density(1.0, point.law)[0]) * flooded.h_central
        growth = side_flow(point) * full**2
        films = list(islice(oil_passes(point, OilLayer(H=full), grid=grid), count))
        found = np.array([film.h_central for film in films]) / flooded.h_central
        starved, both, ratio = [], [], 1.0
        for n in range(1, count + 1):
            starved.append((1.0 + n) ** (-1.0 / g))
            both.append(film_of_layer(ratio, g))
            ratio *= 1.0 - float(lost_share(ratio, g, growth))
        at = np.arange(1, count + 1)
        (line,) = left.loglog(at, found, ".", label=f"{point.M:g}, {point.L:g}, {point.kappa:g}")
        left.loglog(at, both, color=line.get_color())
        left.loglog(at, starved, "--", color=line.get_color(), linewidth=0.8)
        print(f"{point}: solved, both losses, starvation alone")
        for n in (1, 3, 5, 8, 20, 50, 100):
            print(f"   {n:3d}: {found[n - 1]:.3f} {both[n - 1]:.3f} {starved[n - 1]:.3f}")
        start = 0.3 * full
        thin = list(islice(oil_passes(point, OilLayer(H=start), grid=grid), count))
        for n in (1, 10, 50, 100):
            closed = float(layer_after_passes(point, start, n))
            print(
                f"   from r = 0.3, {n}: {thin[n - 1].layer_behind[0]:.5f}, closed form {closed:.5f} of {start:.5f}"
            )
    left.set(xlabel="pass", ylabel="central film over the flooded one")
    left.legend(title="M, L, kappa")
    bearing = BallBearing.catalogue("6204", oil=Lubricant(eta0=0.0255, alpha=1.62e-8))
    usual = {"bearing": bearing, "load": (0.0, -1000.0), "speed_rpm": 10000.0}
    times = np.concatenate([[0.0], np.logspace(-2, 5, 141)])
    for words, given in (
        ("cut off", {}),
        ("90 % comes back in 10 s", {"returned": 0.9, "return_time": 10.0}),
        ("fed by 60 mm³/h", {"feed": 60e-9 / 3600.0}),
    ):
        balance = OilBalance(**usual, **given)
        history = balance.history(OilLayer(over_flooded=2.0), times)
        right.semilogx(history.t[1:], 1e6 * history.h_central[1:, 0], label=words)
        shown = ", ".join(f"{t:g} s {h:.3f}" for t, h in zip(times[1::20], history.share[1::20, 0], strict=True))
        print(f"{words}: {shown}")
        if not given:
            print(balance)
            for ratio in (0.9, 0.5, 0.3):
                print(f"   {3.6e12 * balance.feed_for(ratio * balance.full_layer):.3g} mm3/h for r = {ratio}")
    right.set(
        xlabel="time after the start [s]", ylabel="central film of the most loaded ball [µm]", ylim=(0.0, None)
    )
    right.legend()
    figure.savefig(IMAGES / "oil_passes.png", dpi=130)


def bearing_over_supply() -> None:
    """Film and damping of a 6205 over its oil supply, by the atlas, its elements and its solved contacts."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    oil, load, hz = Lubricant.iso_vg(68, temperature=50.0), (0.0, -1000.0), np.array([50.0, 500.0, 1000.0, 3000.0])
    ratios, speeds = np.geomspace(0.25, 6.0, 33), (1000.0, 3000.0, 6000.0)
    flooded = {}
    for speed in speeds:
        whole = BallBearing.catalogue("6205", oil=oil)
        state = whole.equilibrium(load, speed_rpm=speed)
        flooded[speed] = (
            state.h_central[state.heaviest, 0],
            whole.coefficients(load, speed_rpm=speed, hz=hz).damping,
        )
        shares, found = [], []
        for ratio in ratios:
            bearing = BallBearing.catalogue("6205", oil=oil, supply=OilLayer(over_flooded=ratio))
            state = bearing.equilibrium(load, speed_rpm=speed)
            shares.append(state.h_central[state.heaviest, 0] / flooded[speed][0])
            if speed == 3000.0:
                small = bearing.coefficients(load, speed_rpm=speed, hz=hz)
                found.append((ratio, small.signed_damping[:, 1, 1], small.damping[:, 1, 1]))
        left.semilogx(ratios, shares, label=f"{speed:.0f} rev/min, {1e6 * flooded[speed][0]:.3g} µm flooded")
        for ratio in (0.6, 1.0, 1.5, 2.0, 4.0):
            bearing = BallBearing.catalogue("6205", oil=oil, supply=OilLayer(over_flooded=ratio))
            small = bearing.coefficients(load, speed_rpm=speed, hz=[speed / 60.0, 500.0, 1000.0, 3000.0])
            signed, element = small.signed_damping[:, 1, 1], small.damping[:, 1, 1]
            print(
                f"   r {ratio:g}, from the frequency of the shaft: {signed.round(0)}, elements {element.round(0)}"
            )
        print(f"{speed:g} rev/min, flooded {flooded[speed][1][:, 1, 1].round(0)} N s/m at {hz} Hz")
        if speed == 3000.0:
            at = [one[0] for one in found]
            for k, one in enumerate(hz):
                signed, element = (np.array([row[j][k] for row in found]) for j in (1, 2))
                (line,) = right.semilogx(at, signed, label=f"{one:.0f} Hz")
                right.semilogx(at, element, ":", color=line.get_color())
                right.plot(7.0, flooded[speed][1][k, 1, 1], "_", color=line.get_color(), markersize=12)
    for axes in (left, right):
        axes.axhline(0.0, color="grey", linewidth=0.6)
        axes.set_xlabel("layer of oil over what the flooded films let through")
        axes.set_xticks([0.25, 0.5, 1.0, 2.0, 4.0], ["0.25", "0.5", "1", "2", "4"])
        axes.minorticks_off()
    left.set(ylabel="central film over the flooded one")
    right.set(ylabel="C_yy at 3000 rev/min [N s/m]", ylim=(-250.0, 200.0))
    left.legend()
    right.legend(loc="lower right")
    figure.savefig(IMAGES / "oil_supply_bearing.png", dpi=110)


def held_feed() -> None:
    """Damping of a 6205 over frequency under a given layer and with the feed held, and losses that outweigh it."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    load, rpm = (0.0, -1000.0), 3000.0
    start = OilBalance(bearing=bearing, load=load, speed_rpm=rpm)
    hz = np.geomspace(1.0, 1000.0, 61)
    shown = [int(np.argmin(np.abs(hz - f))) for f in (1.0, 10.0, 50.0, 100.0, 500.0)]
    for ratio, colour in ((1.0, "tab:orange"), (1.5, "tab:blue")):
        feed = start.feed_for(ratio * start.full_layer)
        fed = replace(start, feed=feed).lasting_supply
        for supply, line in ((OilLayer(fed.h), ":"), (fed, "-")):
            small = replace(bearing, supply=supply).coefficients(load, speed_rpm=rpm, hz=hz)
            C, K = small.signed_damping[:, 1, 1], small.stiffness[:, 1, 1]
            name = f"r = {ratio:g}, {'feed held' if supply is fed else 'layer given'}"
            left.plot(hz, C, line, color=colour, label=name)
            right.plot(hz, small.omega * C / K, line, color=colour)
            print(f"r = {ratio:g}, {3.6e12 * feed:.0f} mm3/h, {'feed' if supply is fed else 'layer'} held:")
            print("   Hz", *(f"{hz[k]:.0f}" for k in shown), "C", *(f"{C[k]:.0f}" for k in shown))
            print("   K", *(f"{1e-6 * K[k]:.2f}" for k in shown))
            print("   loss factor that outweighs C_yy", *(f"{-small.omega[k] * C[k] / K[k]:.1e}" for k in shown))
    left.axhline(0.0, color="grey", linewidth=0.8)
    left.set(xlabel="frequency, Hz", ylabel="C_yy, N s/m", xscale="log", ylim=(-500.0, 500.0))
    left.axvline(50.0, color="grey", linewidth=0.8, linestyle="--")
    right.axhspan(-0.005, 0.0, color="lightgrey", label="outweighed by rings that lose .005")
    right.axhline(0.0, color="grey", linewidth=0.8)
    right.set(xlabel="frequency, Hz", ylabel="omega C/K", xscale="log", ylim=(-0.006, 0.006))
    left.legend()
    right.legend(loc="upper left")
    figure.savefig(IMAGES / "oil_feedback.png", dpi=130)


if __name__ == "__main__":
    held_feed()
    bearing_over_supply()
    passes()
    through_time()
    map_of_a_film()
    grids()
    case_a()
    films()
