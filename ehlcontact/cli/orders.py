"""``--measured-order`` of ``ehlcontact bearing``: contact angle and clearance that a measured order allows."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import show_columns, show_table
from ehlcontact.errors import InputError
from reduced_models.bearing.measured_order import Interval, angle_from_order, clearance_from_order

if TYPE_CHECKING:
    from ehlcontact.cli.study.bearing import BearingJob

OPTION = "--measured-order"
WORDS = "bpfo or bpfi, the order and its error, as bpfi,5.4021,0.0005"
BESIDE = (0.5, 1.0, 2.0)  # of the axial load: loads at which clearances are given
UNITS = {
    "measured_order": "per turn of the shaft, with its error",
    "contact_angle": "rad; mean of the balls, whatever the clearance, with the bounds that the error leaves",
    "clearance": "m; at each axial load; null where no clearance has the order",
}


class MeasuredOrder(NamedTuple):
    """An order that was measured."""

    name: str  # "bpfo" or "bpfi"
    order: float
    error: float

    @property
    def given(self) -> dict[str, float]:
        """Arguments of `angle_from_order` and `clearance_from_order`."""
        return {f"{self.name}_order": self.order, "error": self.error}


class Found(NamedTuple):
    """Contact angle [rad], and clearances [m] at axial loads [N]; without an axial load no clearances."""

    angle: Interval
    axial: tuple[float, ...]
    clearance: Interval | None
    remark: str = ""  # on the clearance


def measured_order_of(text: str) -> MeasuredOrder:
    """The order that an option gives: name, value and error; without an error it is 0.

    Raises
    ------
    InputError
        Not these.
    """
    name, *numbers = (part.strip() for part in text.split(","))
    try:
        order, error = map(float, numbers if len(numbers) != 1 else [*numbers, "0"])
    except ValueError:
        raise InputError(OPTION, text, WORDS) from None
    if name.lower() not in ("bpfo", "bpfi") or not error >= 0.0:
        raise InputError(OPTION, text, WORDS)
    return MeasuredOrder(name.lower(), order, error)


def allowed_by(measured: MeasuredOrder, job: BearingJob, slip: float) -> Found:
    """Contact angle and, of a deep-groove bearing under axial load at its first speed, clearances.

    Raises
    ------
    InputError
        A pair, moments or a tilt; an order that no contact angle has.
    """
    for given, option in ((job.pair, "--pair"), (job.tilt, "--tilt-x, --tilt-y"), (job.load[3:], "--moment-x")):
        if given:
            raise InputError(OPTION, measured.order, f"without {option}")
    try:
        angle = angle_from_order(job.bearing, **measured.given, slip=slip)
    except InputError as error:
        field = f"{OPTION}, its error" if error.field == "error" else OPTION
        raise InputError(field, error.value, error.allowed) from None
    if job.bearing.contact_angle is not None:
        return Found(angle, (), None, "not searched: that of an angular contact bearing follows from its angle")
    if job.planar or job.load[2] <= 0.0:
        return Found(angle, (), None, "not searched without an --axial load above 0")
    axial = tuple(job.load[2] * one for one in BESIDE)
    at = {"radial": -job.load[1], "speed_rpm": job.speeds[0], "slip": slip}
    remark = f"{_micrometres(job.bearing.clearance)} µm of the bearing not used" if job.bearing.clearance else ""
    return Found(angle, axial, clearance_from_order(job.bearing, axial, **measured.given, **at), remark)


def summary(measured: MeasuredOrder, found: Found) -> dict[str, Any]:
    """For JSON."""
    entries: dict[str, Any] = {**measured._asdict(), "contact_angle": found.angle._asdict()}
    if found.clearance is not None:
        bounds = {name: _or_none(values) for name, values in found.clearance._asdict().items()}
        entries |= {"axial_load": found.axial, "clearance": bounds}
    return entries


def show(measured: MeasuredOrder, found: Found) -> None:
    """Contact angle and clearances with their intervals."""
    value, low, high = (f"{numeral(degrees(float(one)), 4)}°" for one in found.angle)
    order = f"{measured.name.upper()} {numeral(measured.order, 5)} ± {numeral(measured.error, 2)}"
    rows = [("contact angle", value, f"{low} to {high}: mean of the balls")]
    rows += [("clearance", "", found.remark)] if found.remark else []
    show_table(f"measured {order}", rows, None)
    if found.clearance is None:
        return
    loads = [
        [numeral(load), *(_micrometres(float(np.asarray(one)[k])) for one in found.clearance)]
        for k, load in enumerate(found.axial)
    ]
    show_columns(["axial load [N]", "clearance [µm]", "from", "to"], loads, "clearances with this order")


def _micrometres(clearance: float) -> str:
    return "none" if np.isnan(clearance) else numeral(1e6 * clearance, 3)


def _or_none(values: Any) -> list[float | None]:
    return [None if np.isnan(one) else float(one) for one in values]
