"""Pictures of a rotor on several models of its bearings or contacts, beside each other.

`looks` have colour and dash of a model by its name, `names` what the legend calls it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

import numpy as np

from ehlcontact.results.picture import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    Band,
    Label,
    Line,
    Mark,
    Panel,
    Picture,
    Slides,
)
from reduced_models.bearing.picture import over_frequency, speeds_slides
from reduced_models.rotor.compare_bearing_models import CONSTANT, DRY, FILM, USUAL
from reduced_models.rotor.decay import Decrement
from reduced_models.rotor.picture import RESPONSE, amplitudes, orbit_panel, spectrum_panel
from reduced_models.rotor.resonance import Resonances
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.settling import Settling, steps_per_revolution

LOOKS = {FILM: (BLUE, "-"), DRY: (GREY, "-"), CONSTANT: (GREEN, "--"), USUAL: (RED, "-.")}
ORDER = DRY, FILM, USUAL, CONSTANT  # in which they are drawn: lines over clouds
BODIES = {"ring": "inner ring, left", "disc": "disc"}
ORDERS = 12.0  # multiples of the speed, that a spectrum shows
DECADES = 5.0  # of its amplitudes
TURNS = 5.0  # of the shaft, on the orbits
DIRECTIONS = {"x": "horizontal", "y": "vertical"}
UNBALANCE = "frequency of the unbalance", "Hz"

MARKS = "o ", "x", "s "  # of spectra, as they come

Names = Mapping[str, str]
Looks = Mapping[str, tuple[str, str]]  # colour and dash


def orbits(found: Any, names: Names) -> Picture:
    """Paths of the left ring and of the disc, each about its mean, of `BearingModels`."""

    def paths(body: str) -> Iterator[Line]:
        for name, run in _ran(found):
            path = getattr(run, body)[run.t >= run.t[-1] - TURNS * 60.0 / found.speed_rpm]
            x, y = (path - path.mean(axis=0)).T
            yield Line(x, y, names[name], *LOOKS[name], width=1.2)

    return Picture([orbit_panel(list(paths(body)), title) for body, title in BODIES.items()], heights=(380.0,))


def spectra(found: Any, names: Names) -> Picture:
    """Amplitudes of ring and disc up and down; dotted, the speed and the passage of the balls."""
    speed = found.speed_rpm / 60.0
    marks = (Mark(speed, "1x", ORANGE), Mark(found.passage_hz, "ball passage", ORANGE))

    def lines(body: str) -> Iterator[Line]:
        for name, run in _ran(found):
            pair = amplitudes(getattr(run, body)[:, 1], float(run.t[1] - run.t[0]))
            yield Line(*pair, names[name], *LOOKS[name], width=1.2)

    options: dict[str, Any] = {"label": ("amplitude of y", "m"), "decades": DECADES, "marks": marks}
    panels = [
        spectrum_panel(lines(body), ORDERS * speed, title=title, **options) for body, title in BODIES.items()
    ]
    return Picture(panels, heights=(300.0,))


def coefficients(found: Any, names: Names) -> Picture:
    """K and C of a bearing over the frequency of the vibration, beside those that are constant."""
    constants = [(names[key], pair, *LOOKS[key]) for key, pair in found.constants.items()]
    return Picture(over_frequency(found.over_frequency, constants, found.speed_rpm / 60.0), heights=(280.0,))


def response(found: Any, names: Names, eccentricity: float | None = None) -> Picture:
    """Displacement of the disc over the frequency of the unbalance, in m where its eccentricity is given [m]."""
    size, label = _displacement(eccentricity)
    most = size * max(float(values.max()) for values in found.responses.values())
    least = size * min(float(values.min()) for values in found.responses.values())
    panels = []
    for column, way in enumerate(DIRECTIONS.values()):
        lines = [
            Line(found.response_hz, size * found.responses[name][:, column], names[name], *LOOKS[name])
            for name in ORDER
            if name in found.responses
        ]
        ends = (0.7 * least, 1.4 * most)
        panels.append(Panel(lines, UNBALANCE, label, title=f"disc, {way}", logs="XY", y_ends=ends))
    return Picture(panels, heights=(290.0,))


def _displacement(eccentricity: float | None) -> tuple[float, Label]:
    """Factor of responses over the eccentricity, and their label: in m where that is given [m]."""
    return (eccentricity, ("displacement", "m")) if eccentricity else (1.0, RESPONSE)


def speeds(found: Any) -> Slides:
    """Load zone, films, stiffness and damping of the bearing, with a slider through the speeds."""
    return speeds_slides(found.over_speed, found.speed_rpm)


def bode(responses: Resonances, looks: Looks, names: Names, eccentricity: float | None = None) -> Picture:
    """Displacement and phase of the disc under unbalance, by direction, each over its span of frequency.

    Displacements are over the eccentricity, where none is given [m].
    """
    size, label = _displacement(eccentricity)
    hz, above, below = responses.hz, [], []
    for direction, found in responses.curves.items():
        low, high = responses.spans[direction]
        shown = (hz >= low) & (hz <= high)
        sizes, phases = [], []
        for name, whole in found.items():
            curve, look = whole[shown], (names[name], *looks[name])
            # behind the force of the unbalance, which in y comes a quarter of a turn after that in x
            behind = np.angle(curve * (1j if direction == "y" else 1.0), deg=True)
            sizes.append(Line(hz[shown], size * np.abs(curve), *look))
            phases.append(Line(hz[shown], np.where(behind > 90.0, behind - 360.0, behind), *look))
        ends, title = (float(low), float(high)), f"disc, {DIRECTIONS[direction]}"
        above.append(Panel(sizes, UNBALANCE, label, title=title, logs="Y", x_ends=ends))
        below.append(Panel(phases, UNBALANCE, "phase [degrees]", x_ends=ends, y_tick=90.0))
    return Picture([*above, *below], columns=len(above), heights=(240.0, 150.0), shared=True)


def _ran(found: Any) -> Iterator[tuple[str, Any]]:
    return ((name, found.ran[name]) for name in ORDER if name in found.ran)


def settled_part(run: RotorResult, how: Settling) -> tuple[RotorResult, bool]:
    """The settled revolutions of a run and True, or its last revolution and False."""
    steps = steps_per_revolution(run)
    first = how.settled_from
    whole = (run.t.size - 1) // steps * steps
    begin = whole - steps if first is None else first * steps
    return run.part(begin, whole), first is not None


def settled_orbits(runs: Mapping[str, RotorResult], how: Settling, looks: Looks, names: Names) -> Picture:
    """Paths of disc and journal about their mean: the settled part heavy, what is before it thin.

    Of a rotor that moves only up and down, velocity against displacement.
    """
    planar = "x" in next(iter(runs.values())).nodes["disc"]
    labels = None if planar else (("displacement y", "m"), ("velocity", "m/s"))

    def paths(body: str) -> Iterator[Line]:
        for name, run in runs.items():
            settled, _ = settled_part(run, how)
            centre = getattr(settled, body)[1:].mean(axis=0)
            for part, width in ((run, 0.7), (settled, 1.4)):
                x, y = (getattr(part, body) - centre).T
                pair = (x, y) if planar else (y, getattr(part, f"{body}_velocity")[:, 1])
                yield Line(*pair, names[name], *looks[name], width=width, faint=part is run)

    return Picture(
        [orbit_panel(list(paths(body)), body, labels) for body in ("disc", "journal")], heights=(360.0,)
    )


def time_response(
    runs: Mapping[str, RotorResult], full: str, drawn: Collection[str], how: Settling, looks: Looks, names: Names
) -> Picture:
    """Journal displacement and force of contact 0 over time, and the differences of all runs from the full one.

    Both about their mean: another place of rest is no other vibration. What is before the settled part is grey.
    """
    own = runs[full]
    signals: tuple[tuple[str, str, Callable[[RotorResult], Any]], ...] = (
        ("journal y", "m", lambda run: run.journal[:, 1] - run.journal[1:, 1].mean()),
        ("force 0", "N", lambda run: run.force[:, 0]),
    )
    first = how.settled_from
    until = float(own.t[-1] if first is None else first * steps_per_revolution(own) * (own.t[1] - own.t[0]))
    panels: list[Panel] = []
    for name, unit, signal in signals:
        lines = [
            Line(own.t, signal(run), names[which], *looks[which]) for which, run in runs.items() if which in drawn
        ]
        differences = []
        for which, run in runs.items():
            differ = signal(run) - signal(own)
            if which != full:
                differences.append(Line(own.t, differ - differ[1:].mean(), names[which], *looks[which]))
        for shown, label in ((lines, name), (differences, "difference")):
            word = "" if panels else "not settled"
            band = (Band(float(own.t[0]), until, word),) if until > 0.0 else ()
            ends = float(own.t[0]), float(own.t[-1])
            panels.append(Panel(shown, ("time", "s"), (label, unit), x_ends=ends, bands=band))
    return Picture(panels, columns=1, heights=(170.0, 125.0, 170.0, 125.0), shared=True)


def settled_spectra(runs: Mapping[str, RotorResult], how: Settling, looks: Looks, names: Names) -> Picture:
    """Amplitudes of disc displacement and contact force over whole revolutions, which need no window."""
    speed = float(next(iter(runs.values())).speed_rpm[0]) / 60.0
    signals: tuple[tuple[str, str, Callable[[RotorResult], Any]], ...] = (
        ("disc y", "m", lambda run: run.disc[:, 1]),
        ("force of contact 0", "N", lambda run: run.force[:, 0]),
    )

    def lines(signal: Callable[[RotorResult], Any]) -> Iterator[Line]:
        for k, (name, run) in enumerate(runs.items()):
            hz, size = spectrum_lines(settled_part(run, how)[0], signal)
            yield Line(hz, size, names[name], looks[name][0], "", MARKS[k % len(MARKS)])

    options: dict[str, Any] = {"decades": DECADES, "marks": (Mark(speed, "1x"),)}
    panels = [
        spectrum_panel(lines(signal), ORDERS * speed, (name, unit), **options) for name, unit, signal in signals
    ]
    return Picture(panels)


def spectrum_lines(run: RotorResult, signal: Callable[[RotorResult], Any]) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] above 0 and amplitudes of a signal over whole revolutions."""
    values = signal(run)[1:]
    amplitude = 2.0 / values.size * np.abs(np.fft.rfft(values))
    return np.fft.rfftfreq(values.size, float(run.t[1] - run.t[0]))[1:], amplitude[1:]


def decay(
    runs: Mapping[str, RotorResult],
    decrements: Mapping[str, Decrement],
    drawn: Collection[str],
    looks: Looks,
    names: Names,
) -> Picture:
    """Height of the journal about its rest over time, and the logarithm of the amplitudes that were fitted."""
    above, below = [], []
    for name, run in runs.items():
        found = decrements[name]
        look = (f"{names[name]}: decrement {found.decrement:.3g}", *looks[name])
        if name in drawn:
            above.append(Line(run.t, run.journal[:, 1] - run.journal[0, 1], *look))
        periods = np.array([0.0, found.periods])
        below.append(Line(periods, -found.decrement * periods, *look))
    end = min(found.periods for found in decrements.values())
    panels = (
        Panel(above, ("time", "s"), ("journal y about rest", "m"), x_ends=(0.0, above[0].x[-1])),
        Panel(below, "period of those fitted", "ln(amplitude/first)", x_ends=(0.0, float(end))),
    )
    return Picture(panels, columns=1, heights=(230.0, 170.0))
