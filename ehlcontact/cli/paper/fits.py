"""Records and elements of the cases of Nonato and Cavalca (2010), and reduced models integrated over them."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field

import numpy as np

from ehlcontact.cli.paper.data import paper_fits
from ehlcontact.cli.paper.runs import Runs
from ehlcontact.errors import InputError
from reduced_models import ContactRecord, OutsideValidityWarning, SpringContact, fit, simulate_oscillator
from reduced_models.elements.base import ContactElement
from reduced_models.fitting.result import ElementFit, FitResult, rms_error
from reduced_models.fitting.sensitivity import Sensitivity, sensitivity
from reduced_models.rotor.oscillator import OscillatorResult

BEYOND = 0.25  # of the range of a motion that an element of the paper reaches beyond it on either side
PAPER_METHOD, STIFF_METHOD = "RK23", "Radau"  # Bogacki and Shampine as in the paper, and a stiff integrator

# Part of a record that is fitted: its last two thirds, all of it, or from one t to another.
Window = str | tuple[float, float]
LATE, WHOLE = "last two thirds", "whole record"
ROUNDING = 1e-9  # of sums of time steps: a sample on the end of a window lies inside


@dataclass
class Fits:
    """Elements of the cases, each fitted once."""

    runs: Runs
    _fits: dict[tuple[str, str, Window], ElementFit | str] = field(default_factory=dict)

    def record(self, case: str) -> ContactRecord:
        """History of a case that converged."""
        return ContactRecord.from_result(self.runs.cases[case])

    def fit(self, case: str, model: str = "cubic", window: Window = LATE) -> FitResult | None:
        """Fit of a part of the record; None if there is no record or no contact."""
        found = self._fitted(case, model, window)
        return found if isinstance(found, FitResult) else None

    def refusal(self, case: str, model: str = "cubic", window: Window = LATE) -> str | None:
        """Why there is no fit."""
        found = self._fitted(case, model, window)
        return found if isinstance(found, str) else None

    def _fitted(self, case: str, model: str, window: Window) -> ElementFit | str:
        key = (case, model, window)
        if key not in self._fits:
            self._fits[key] = self._refused_or_fitted(*key)
        return self._fits[key]

    def _refused_or_fitted(self, case: str, model: str, window: Window) -> ElementFit | str:
        if case not in self.runs.cases:
            return "no simulation"
        record = self.record(case)
        if isinstance(window, str):
            span = (float(record.t[0]), float(record.t[-1])) if window == WHOLE else None
        else:
            span = window[0] - ROUNDING, window[1] + ROUNDING
        try:
            return fit(record, model, span)
        except InputError as error:
            return str(error)

    def theirs(self, table: int, case: str, motion: str | None = None) -> SpringContact:
        """The paper's element of a case, its polynomial as printed wherever a motion goes; by default its own."""
        seen = self.record(case if motion is None else motion).approach
        room = BEYOND * float(np.ptp(seen))
        return paper_fits()[table, case].element(float(seen.min()) - room, float(seen.max()) + room)

    def rms(self, element: SpringContact, case: str) -> float:
        """RMS of the force error over the standard deviation of the force, where the case is fitted."""
        record = self.record(case)
        cut = record.window(*record.default_window)
        return rms_error(cut.force, np.asarray(element.force(cut.approach, cut.rate)))

    def sensitivity(self, case: str) -> Sensitivity | None:
        """Table 2 of the case."""
        return sensitivity(self.record(case)) if case in self.runs.cases else None

    def integrated(self, element: ContactElement, case: str, method: str = PAPER_METHOD) -> OscillatorResult:
        """The reduced model under the load of the case, from the start of its fitted window.

        Elements of other cases are integrated too, so leaving the validity box is expected and not told.
        """
        record = self.record(case)
        cut = record.window(*record.default_window)
        assert cut.load is not None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", OutsideValidityWarning)
            return simulate_oscillator(
                element,
                cut.t,
                Omega_n=None if cut.mass is None else cut.mass**-0.5,
                load=cut.load,
                u0=float(cut.approach[0]),
                v0=float(cut.rate[0]),
                method=method,
                rtol=1e-7,
            )

    def difference(self, element: ContactElement, case: str) -> dict[str, float]:
        """RMS difference of the integrated approach from the full one and between the integrators.

        Both relative to the standard deviation of the full approach.
        """
        record = self.record(case)
        reduced, stiff = (self.integrated(element, case, method) for method in (PAPER_METHOD, STIFF_METHOD))
        full = record.window(*record.default_window).approach
        spread = float(np.std(full))

        def rms(values: np.ndarray) -> float:
            return float(np.sqrt(np.mean(values**2))) / spread

        return {
            "approach_rms": rms(reduced.approach - full),
            "rk23_against_radau": rms(reduced.approach - stiff.approach),
            "rk23_evaluations": reduced.evaluations,
            "radau_evaluations": stiff.evaluations,
        }
