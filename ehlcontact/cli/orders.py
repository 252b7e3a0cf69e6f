"""``--measured-order`` of ``ehlcontact bearing``: contact angle and clearance that a measured order allows."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import STDOUT, show_columns, show_table
from ehlcontact.errors import InputError
from reduced_models.bearing.freedoms import PLANAR
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

    @classmethod
    def of(cls, text: str) -> MeasuredOrder:
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
        return cls(name.lower(), order, error)


@dataclass(frozen=True)
class OrderAnswer:
    """Contact angle [rad], and clearances [m] at axial loads [N], that have a measured order."""

    measured: MeasuredOrder
    angle: Interval
    axial: tuple[float, ...] = ()
    clearance: Interval | None = None  # None without an axial load
    remark: str = ""  # on the clearance

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        entries: dict[str, Any] = {**self.measured._asdict(), "contact_angle": self.angle._asdict()}
        if self.clearance is not None:  # without one at a load it is no number there
            entries |= {"axial_load": self.axial, "clearance": self.clearance._asdict()}
        return entries

    def show(self, json_to: str | None) -> None:
        """Contact angle and clearances with their intervals, unless JSON goes to stdout."""
        if json_to == STDOUT:
            return
        value, low, high = (f"{numeral(degrees(float(one)), 4)}°" for one in self.angle)
        rows = [("contact angle", value, f"{low} to {high}: mean of the balls")]
        rows += [("clearance", "", self.remark)] if self.remark else []
        name, order, error = self.measured
        show_table(f"measured {name.upper()} {numeral(order, 5)} ± {numeral(error, 2)}", rows, json_to)
        if self.clearance is not None:
            columns = (map(_micrometres, np.asarray(one).tolist()) for one in self.clearance)
            rows_of_loads = [list(row) for row in zip(map(numeral, self.axial), *columns, strict=True)]
            show_columns(
                ["axial load [N]", "clearance [µm]", "from", "to"], rows_of_loads, "clearances with this order"
            )


def order_answer(measured: MeasuredOrder, job: BearingJob, slip: float) -> OrderAnswer:
    """Contact angle and, of a deep-groove bearing under axial load at its first speed, clearances.

    Raises
    ------
    InputError
        A pair, moments or a tilt; an order that no contact angle has.
    """
    for given, option in ((job.pair, "--pair"), (job.tilt, "--tilt-x, --tilt-y"), (job.load[3:], "--moment-x")):
        if given:
            raise InputError(OPTION, measured.order, f"without {option}")
    order = {f"{measured.name}_order": measured.order, "error": measured.error, "slip": slip}
    try:
        angle = angle_from_order(job.bearing, **order)
    except InputError as error:
        field = f"{OPTION}, its error" if error.field == "error" else OPTION
        raise InputError(field, error.value, error.allowed) from None
    if job.bearing.contact_angle is not None:
        remark = "not searched: that of an angular contact bearing follows from its angle"
        return OrderAnswer(measured, angle, remark=remark)
    if len(job.load) == len(PLANAR) or job.load[2] <= 0.0:
        return OrderAnswer(measured, angle, remark="not searched without an --axial load above 0")
    axial = tuple(job.load[2] * one for one in BESIDE)
    found = clearance_from_order(job.bearing, axial, **order, radial=-job.load[1], speed_rpm=job.speeds[0])
    remark = f"{_micrometres(job.bearing.clearance)} µm of the bearing not used" if job.bearing.clearance else ""
    return OrderAnswer(measured, angle, axial, found, remark)


def _micrometres(clearance: float) -> str:
    return "none" if np.isnan(clearance) else numeral(1e6 * clearance, 3)
