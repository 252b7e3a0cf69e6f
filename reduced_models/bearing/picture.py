"""Pictures of bearings: load zones, films, contact angles, stiffness and damping."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import pi
from typing import Any

import numpy as np

from ehlcontact.results.picture import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    RED,
    AnyPanel,
    Label,
    Line,
    LoadZone,
    Mark,
    Panel,
    Picture,
    Slides,
    stiffness_and_damping,
)
from reduced_models.bearing.freedoms import PLANAR

ROUNDING = 1e-9  # of a load over the force on a ball: none
RACES = (("inner race", BLUE, 0.6), ("outer race", ORANGE, 1.0))  # name, colour, width of a bar
LOOKS = ("-", "o"), ("--", "s"), (":", "^")  # of contact angles of the bearings of a set
AROUND = "angle from the load [degrees]"
# Directions of a vibration: column, name, colour, dash
FORCES = (1, "along the load", BLUE, "-"), (0, "across it", BLUE, ":"), (2, "axial", ORANGE, "-")
TILTS = (3, "about x", GREEN, "-"), (4, "about y", GREEN, ":")
TILT_UNITS = "N m/rad", "N m s/rad"
VIBRATION = "frequency of the vibration", "Hz"
CONDITIONS = ((INK, "--"), (RED, "-"), (BLUE, "-"), (GREEN, ":"))  # of oil and heat, as they come


def state_picture(state: Any) -> Picture:
    """Load zone of a `BearingState` beside the films of every ball; with contact angles these and the spin."""
    panels: list[AnyPanel] = [load_zone(state), films(state)]
    if state.contact_angles is not None:
        panels += [contact_angles((state,)), spins(state)]
    torque = state.rolling_torque
    resists = "" if torque is None else f"; films resist rolling by {torque * 1e3:.3g} N mm"
    title = f"{state.name or 'ball bearing'}, {_load(state)}, {_speed(state)}{resists}"
    return Picture(panels, title, heights=(320.0, 260.0))


def set_picture(state: Any) -> Picture:
    """Load zones of a `SetState` above contact angles, bearing by bearing."""
    most = max(float(one.force.max()) for one in state.bearings)
    zones = [load_zone(one, most, _bearing_title(state, k)) for k, one in enumerate(state.bearings)]
    angles = [contact_angles((one,)) for one in state.bearings]
    title = f"{state.name or 'set of bearings'}, {_load(state)}, {_speed(state)}"
    return Picture([*zones, *angles], title, columns=len(state.bearings), heights=(320.0, 260.0))


def over_speed_picture(state: Any, points: Sequence[Any], curve: Sequence[Any]) -> Picture:
    """Load zone and films at one speed, and contact angles where there are any, above K and C over speed.

    Of a set, load zones of its first two bearings and contact angles of all stand above.

    Parameters
    ----------
    state : BearingState or SetState
    points, curve : sequence of BearingCoefficients
        Shown as points and as lines, each at its first frequency.
    """
    several = getattr(state, "bearings", ())
    if several:
        most = max(float(one.force.max()) for one in several)
        above: list[AnyPanel] = [
            load_zone(one, most, _bearing_title(state, k)) for k, one in enumerate(several[:2])
        ]
        above.append(contact_angles(several))
    else:
        above = [load_zone(state), films(state)]
        above += [contact_angles((state,))] if state.contact_angles is not None else []

    def lines(name: str, ways: Any = None) -> Iterator[Line]:
        for k, way, colour, dash in FORCES[: 2 if len(above) < 3 else 3] if ways is None else ways:
            for found, look in ((curve, {"dash": dash}), (points, {"dash": "", "mark": "o"})):
                values = [getattr(at, name)[0, k, k] for at in found]
                yield Line([at.speed_rpm for at in found], values, way, colour, **look)

    speed = "speed", "rev/min"
    below = stiffness_and_damping(lines, speed, logs="", bottom=0.0)
    if len(above) == 3:
        below += stiffness_and_damping(lambda name: lines(name, TILTS), speed, TILT_UNITS, of="tilt", logs="")[:1]
    hz = {float(at.hz[0]) for at in points}
    shaft = all(np.isclose(at.hz[0], at.speed_rpm / 60.0) for at in points)
    frequency = "the frequency of the shaft" if shaft else f"{min(hz):g} Hz"
    at = f"above at {state.speed_rpm:g} rev/min, a ball under the load; below at {frequency}"
    title = f"{state.name or 'ball bearing'}, {_load(state)}; {at}"
    return Picture([*above, *below], title, columns=len(above), heights=(320.0, 270.0))


def over_frequency(
    found: Any, constants: Sequence[tuple[str, tuple[float, float], str, str]] = (), shaft_hz: float | None = None
) -> list[Panel]:
    """K and C of `BearingCoefficients` along the load and across it, with tilts where there are any.

    Parameters
    ----------
    found : BearingCoefficients
    constants : sequence of (name, (K, C), colour, dash)
        Constant ones beside them.
    shaft_hz : float, optional
        Frequency of the shaft, for a dotted line.
    """
    planar = found.load.size == len(PLANAR)
    marks = () if shaft_hz is None else (Mark(shaft_hz, "1x", ORANGE),)

    def lines(name: str, ways: Any) -> Iterator[Line]:
        for k, way, colour, dash in ways:
            yield Line(found.hz, getattr(found, name)[:, k, k], way, colour, dash)
        if ways is not TILTS:
            for text, values, colour, dash in constants:
                value = values[name == "damping"]
                yield Line(found.hz[[0, -1]], [value, value], text, colour, dash)

    forces = FORCES[: 2 if planar else 3]
    panels = stiffness_and_damping(lambda name: lines(name, forces), VIBRATION, marks=marks)
    if not planar:
        tilts = stiffness_and_damping(
            lambda name: lines(name, TILTS), VIBRATION, TILT_UNITS, of="tilt", marks=marks
        )
        panels += tilts
    return panels


def speeds_slides(every: Sequence[Any], own_rpm: float) -> Slides:
    """Load zone, films, stiffness and damping of a bearing, with a slider through its speeds.

    `every` has a `state` and the K and C `small` at each speed.
    """
    rpm = [one.state.speed_rpm for one in every]
    pictures = [
        Picture([load_zone(one.state), films(one.state), *over_frequency(one.small)], heights=(300.0, 250.0))
        for one in every
    ]
    start = min(range(len(rpm)), key=lambda k: abs(rpm[k] - own_rpm))
    return Slides(pictures, ("speed", "rpm"), rpm, start)


def conditions_films(found: Any) -> Picture:
    """Central films of the balls that carry around the ring, at both races, of an `OilAndHeat`."""
    state, panels = found.state, []
    place = from_load(state)
    order = [k for k in np.argsort(place) if state.approach[k].sum() > 0.0]
    top = 1.05 * max(float(one.h_central[order].max()) for one in found.conditions.values())
    for column, (race, *_) in enumerate(RACES):
        lines = [
            Line(place[order], one.h_central[order, column], key, colour, dash, "o")
            for (key, one), (colour, dash) in zip(found.conditions.items(), CONDITIONS, strict=False)
        ]
        panels.append(Panel(lines, AROUND, ("central film", "m"), title=race, y_ends=(0.0, top), tick=60.0))
    return Picture(panels, heights=(290.0,))


def conditions_coefficients(found: Any) -> Picture:
    """K and C over the frequency of a small vibration, in the first of the directions, of an `OilAndHeat`."""
    order, way = np.argsort(found.hz), next(iter(found.ways.values()))

    def lines(name: str) -> Iterator[Line]:
        for (key, one), (colour, dash) in zip(found.conditions.items(), CONDITIONS, strict=False):
            yield Line(found.hz[order], getattr(one, name)[order, way], key, colour, dash)

    marks = (Mark(float(found.hz[0]), "1x", ORANGE),)
    return Picture(stiffness_and_damping(lines, VIBRATION, marks=marks, logs="x"), heights=(290.0,))


def load_zone(state: Any, most: float | None = None, title: str = "force on the balls [N]") -> LoadZone:
    """Force of every ball, outward from the centre, up to `most` [N], and the load."""
    largest = float(state.force.max()) if most is None else most
    loaded = np.hypot(*state.load[:2]) > ROUNDING * largest
    angle = float(np.arctan2(state.load[1], state.load[0])) if loaded else None
    forces = [(name, state.force[:, column], colour, share) for column, (name, colour, share) in enumerate(RACES)]
    return LoadZone(state.angles, forces[::-1], angle, title, most)


def films(state: Any) -> Panel:
    """Smallest film of every ball over its place, or the approaches of a dry bearing."""
    if state.h_min is None:
        return _around((state,), "approach", ("approach of the surfaces; below 0 a gap", "m"))
    panel = _around((state,), "h_min", ("smallest film", "m"))
    if state.lambda_ratio is None:
        return panel
    rough = float(state.h_min.flat[0] / state.lambda_ratio.flat[0])
    name = f"composite roughness; least lambda {float(np.nanmin(state.lambda_ratio)):.3g}"
    lines = [*panel.lines, Line([-180.0, 180.0], [rough, rough], name, GREY, "--", width=1.2)]
    return Panel(lines, panel.x, panel.y, logs="y", x_ends=panel.x_ends, tick=panel.tick)


def contact_angles(states: Sequence[Any]) -> Panel:
    """Contact angles of every ball over its place, of a bearing or of several."""
    return _around(states, "contact_angles", ("contact angle", "rad"), logs="")


def spins(state: Any) -> Panel:
    """Spin over rolling at both races."""
    return _around((state,), "spin_to_roll", "spin over rolling", logs="")


def _around(states: Sequence[Any], name: str, label: Label, logs: str = "y") -> Panel:
    """Values of every ball at inner and outer race, over the place of the ball from the load."""
    lines = []
    for k, state in enumerate(states):
        place, values = from_load(state), getattr(state, name)
        order, (dash, mark) = np.argsort(place), LOOKS[k % len(LOOKS)]
        which = f", bearing {k}" if len(states) > 1 else ""
        lines += [
            Line(place[order], values[order, column], race + which, colour, dash, mark)
            for column, (race, colour, _) in enumerate(RACES)
        ]
    return Panel(lines, AROUND, label, logs=logs, x_ends=(-180.0, 180.0), tick=60.0)


def from_load(state: Any) -> Any:
    """Angles of the balls from the direction of the load [degrees], from -180 to 180."""
    turned = state.angles - np.arctan2(state.load[1], state.load[0])
    return np.degrees((turned + pi) % (2.0 * pi) - pi)


def _load(state: Any) -> str:
    """Load of a state in words."""
    radial = f"{np.hypot(*state.load[:2]):.4g} N"
    return radial if state.load.size == 2 else f"{radial} radially, {state.load[2]:.4g} N axially"


def _speed(state: Any) -> str:
    return f"{state.speed_rpm:g} rev/min" if state.speed_rpm else "at standstill"


def _bearing_title(state: Any, k: int) -> str:
    """Of the load zone of a bearing of a set."""
    force = state.axial_forces[k]
    return f"bearing {k}, facing {state.facings[k]}: {force:.4g} N axially\nforce on the balls [N]"
