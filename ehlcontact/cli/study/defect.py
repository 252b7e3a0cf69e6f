"""A spall in the bearing of a study: orders, and lines of its force with films, over time and as envelope."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from math import ceil, pi
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.cli.study.loads import defect_field, place_of, ring_load, spall_in
from ehlcontact.cli.study.machine import bearing_of
from ehlcontact.results.picture import BLUE, ORANGE, Line, Panel, Picture
from reduced_models import Spall
from reduced_models.bearing.excitation import BearingExcitation
from reduced_models.bearing.freedoms import PLANAR
from reduced_models.bearing.height_tables import track_radius
from reduced_models.bearing.kinematics import RPM_TO_HZ, DefectFrequencies, DefectOrders
from reduced_models.signals import envelope_spectrum
from reduced_models.signals.spectra import HIGHEST_SHOWN, EnvelopeSpectrum, multiples, shown_to

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

_Floats = NDArray[np.float64]

# Names, colours and widths by filter: bare heights first, the film is drawn over them
LOOKS = {"none": ("bare step under the ball", ORANGE, 0.8), "film": ("filtered by contact and film", BLUE, 1.2)}
SHOWN_TURNS = 1.5  # of the shaft, in the picture
DEEPEST = 3e-4  # of the largest line, the smallest that is shown
FILTERS = ("film", "none")  # of the contacts, side by side
TURNS = 16  # of the shaft, of a signal
PER_TURN, FINER = 2**10, 2.5  # least samples in one turn; over the highest order of a line
BLOCK = 512  # samples computed together
LOW, HIGH = 0.04, 0.25  # band of the envelope, over the highest line: waves of 12 to 2 semi-axes
FIRST = 1.5  # turns, of which the strongest passage is shown
BESIDE = 3.0  # of spall and semi-axis together, to either side of a passage that is shown
NEAR = 0.05  # of the order of the spall, within which a line of the envelope is one of its multiples


@dataclass(frozen=True)
class StudyDefect:
    """Orders of a bearing under load, and what a spall does, by `FILTERS` of the contacts."""

    support: str  # name of the support whose bearing it is in
    spall: Spall
    orders: DefectOrders
    speed_rpm: float
    at_angles: bool  # the bearing carries axial load
    slip: float  # of the cage, a share of its speed with balls that roll
    lines: dict[str, BearingExcitation]
    turns: _Floats
    force: dict[str, _Floats]  # change of that which carries the load, over the turns [N]
    envelope: dict[str, EnvelopeSpectrum]
    band: tuple[float, float]  # of the envelope [Hz]
    passage: tuple[float, float]  # turns between which a ball meets the spall, contact length beside it included

    def picture(self) -> Picture:
        """Force over time, one passage of it, the spectrum of its envelope, and lines of the force."""
        turn = 1.0 / (self.speed_rpm * RPM_TO_HZ)
        change = ("change of the force", "N")
        spans, titles = ((0.0, SHOWN_TURNS), self.passage), (f"{SHOWN_TURNS:g} turns of the shaft", "one passage")
        over_time = [
            Panel(
                [
                    Line(turn * self.turns[shown], self.force[name][shown], text, colour, width=width)
                    for name, (text, colour, width) in LOOKS.items()
                ],
                ("time", "s"),
                change,
                title=title,
            )
            for (low, high), title in zip(spans, titles, strict=True)
            if (shown := (low <= self.turns) & (self.turns <= high)).any()
        ]
        last = shown_to([self.hz], HIGHEST_SHOWN, float(self.envelope[FILTERS[0]].hz[-1]))
        envelope, lines = [], []
        for name, (text, colour, width) in LOOKS.items():
            own, whole = self.lines[name], self.envelope[name]
            within, above = whole.hz <= last, own.order > 0.0
            envelope.append(Line(whole.hz[within], whole.amplitude[within], text, colour, width=width))
            lines.append(Line(1e-3 * own.hz[above], own.amplitude[above, 1], text, colour, "", "o"))
        top = max(float(line.y.max(initial=0.0)) for line in lines)
        marks = multiples(self.name, self.hz, last)
        amplitude = ("amplitude of the envelope", "N")
        below = [
            Panel(envelope, ("frequency", "Hz"), amplitude, title="envelope", x_ends=(0.0, last), marks=marks),
            Panel(
                lines,
                ("frequency", "kHz"),
                ("amplitude of a line", "N"),
                title="lines of the force",
                logs="Y" if top > 0.0 else "",
                y_ends=(DEEPEST * top, 2.0 * top) if top > 0.0 else None,
            ),
        ]
        return Picture([*over_time, *below], heights=(280.0,))

    @property
    def name(self) -> str:
        """Of its own order."""
        return "BPFI" if self.spall.race == "inner" else "BPFO"

    @property
    def order(self) -> float:
        """At which balls meet the spall, per turn of the shaft."""
        return float(getattr(self.orders, f"{self.name.lower()}_order"))

    @property
    def frequencies(self) -> DefectFrequencies:
        """Defect frequencies [Hz]."""
        return self.orders.at(self.speed_rpm)

    @property
    def hz(self) -> float:
        """At which balls meet the spall [Hz]."""
        return float(getattr(self.frequencies, self.name.lower()))

    @property
    def reservation(self) -> str:
        """Where forces are not linear in the depth; else empty."""
        return self.lines[FILTERS[0]].reservation

    @property
    def loses_load(self) -> bool:
        """Whether balls lose their load over the spall, so that linear forces mean nothing."""
        return self.lines[FILTERS[0]].loses_load

    @property
    def highest(self) -> dict[str, float]:
        """Largest change of the force that carries the load [N], by filter."""
        return {name: float(np.abs(force).max()) for name, force in self.force.items()}

    @property
    def harmonics(self) -> dict[str, list[float]]:
        """Lines of the envelope at the first three multiples of the order of the spall [N], by filter."""
        hz = self.hz
        return {
            name: [one.line(j * hz, NEAR * hz).amplitude for j in (1, 2, 3)] for name, one in self.envelope.items()
        }

    def to_dict(self) -> dict[str, Any]:
        """Numbers of ``results.json``; forces in N."""
        return {
            "support": self.support,
            "spall": asdict(self.spall),
            "orders": asdict(self.orders),
            "frequencies_hz": asdict(self.frequencies),
            "cage_slip": self.slip,
            "reservation": self.reservation,
            "largest_force": None if self.loses_load else self.highest,
            "envelope_band_hz": list(self.band),
            "envelope_harmonics": None if self.loses_load else self.harmonics,
        }


def defects_of(study: Study) -> tuple[StudyDefect, ...]:
    """What the spalls of a study do to their bearings, whose rings are held."""
    return tuple(_defect_of(study, k) for k in range(len(study.defect)))


def _defect_of(study: Study, k: int) -> StudyDefect:
    spall, speed = spall_in(study, k), study.speed_rpm
    place = place_of(study, study.defect[k], defect_field(study, k, "support"))
    bearing, load = bearing_of(study, place), ring_load(study, place)
    slip = 0.01 * (study.defect[k].cage_slip_percent or 0.0)
    lines = {
        name: bearing.excitation([spall], load, speed_rpm=speed, contact_filter=name, slip=slip)
        for name in FILTERS
    }
    highest = max(float(one.order.max(initial=0.0)) for one in lines.values())
    per_turn = max(PER_TURN, 2 ** ceil(np.log2(FINER * highest + 1.0)))
    turns = np.arange(TURNS * per_turn) / per_turn
    rate = per_turn * speed * RPM_TO_HZ
    force = {name: _vibration(one, turns) for name, one in lines.items()}
    band = LOW * highest * speed * RPM_TO_HZ, HIGH * highest * speed * RPM_TO_HZ
    envelopes = {name: envelope_spectrum(one, rate, band, unit="N") for name, one in force.items()}
    force["none"] = _vibration(_without_ripple(lines["none"]), turns)
    orders = bearing.orders_under(load, speed_rpm=speed, slip=slip)
    met = orders.bpfi_order if spall.race == "inner" else orders.bpfo_order
    rolled = spall.length * bearing.balls / (2.0 * pi * track_radius(bearing, str(spall.race)) * met)
    reach = BESIDE * (rolled + 2.0 / highest)  # the shortest waves are half a semi-axis
    strongest = float(turns[np.abs(force[FILTERS[0]][turns <= FIRST]).argmax()])
    passage = strongest - reach, strongest + reach
    about = study.names[place], spall, orders, speed, load.size > len(PLANAR), slip
    return StudyDefect(*about, lines, turns, force, envelopes, band, passage)


def _without_ripple(lines: BearingExcitation) -> BearingExcitation:
    """Lines of a force that is averaged twice over the shortest wave, by the square of Lanczos' factors.

    A series that ends overshoots a jump by 9 %, however long it is (Gibbs), so its largest value is not the jump.
    """
    share = lines.order / max(float(lines.order.max(initial=0.0)), 1.0)
    return replace(lines, amplitude=lines.amplitude * np.sinc(share)[:, None] ** 2)


def _vibration(lines: BearingExcitation, turns: _Floats) -> _Floats:
    """Force that carries the load over turns of the shaft, without its mean [N]."""
    blocks = np.array_split(turns, ceil(turns.size / BLOCK))
    force = np.concatenate([lines.force(one)[:, 1] for one in blocks])
    return np.asarray(force - force.mean())
