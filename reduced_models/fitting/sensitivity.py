"""Which terms of the seven-term polynomial the records need: Table 2 of Nonato and Cavalca (2010), and BIC."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line, Panel, Picture
from ehlcontact.results.table import frame_of
from ehlcontact.summary import Summary
from reduced_models.elements.spring import SpringContact
from reduced_models.fitting.models import COLUMNS, linear_estimate
from reduced_models.fitting.records import ContactRecord
from reduced_models.fitting.result import rms_error, sum_error
from reduced_models.fitting.samples import Samples, Window
from reduced_models.fitting.uncertainty import autocorrelation, independent_samples

TERMS = SpringContact.kinds["polynomial"]
# Autocorrelation of neighbouring residuals above which AIC and BIC of all samples mislead: `warning`.
CORRELATED_FROM = 0.5


@dataclass(frozen=True, slots=True)
class SensitivityRow:
    """The fit without one term, all others fitted again.

    ``aic`` and ``bic`` are differences from the full model, negative where the term is not worth its keep.

    Attributes
    ----------
    removed : str or None
        The term; None: the full model.
    rms : float
        RMS error of the force over its standard deviation.
    e_f, e_acc : float, float or None
        Eq. 13 for the force and the acceleration.
    aic, bic : float
        Information criteria less those of the full model.
    rms_without_refit : float
        The term struck out of the full fit, the others as they were.
    """

    removed: str | None
    rms: float
    e_f: float
    e_acc: float | None
    aic: float
    bic: float
    rms_without_refit: float


@dataclass(frozen=True, slots=True)
class Sensitivity(Summary):
    """Table 2 for our records; the first row is the full model.

    Attributes
    ----------
    rows : tuple of SensitivityRow
        The full model, then without one term each: ``removed``, ``rms``, ``e_f`` and ``e_acc`` (eq. 13), ``aic``,
        ``bic``, and ``rms_without_refit``.
    samples : int
        Of all records.
    independent_samples : float
        Of the residuals of the full model: what aic and bic count.
    lag_one : float
        Autocorrelation of neighbouring residuals, mean over the records.
    """

    rows: tuple[SensitivityRow, ...]
    samples: int
    independent_samples: float
    lag_one: float

    def _summary_lines(self) -> list[str]:
        lines = [
            f"terms by their weight: {', '.join(self.ranking)}",
            f"rms error {self.rows[0].rms:.2g} of the standard deviation of the force with all of them",
        ]
        return [*lines, *([self.warning] if self.warning else [])]

    @property
    def ranking(self) -> tuple[str, ...]:
        """Terms from the one whose removal does most harm (rms) to the one whose does least."""
        ordered = sorted(self.rows[1:], key=lambda row: -row.rms)
        return tuple(row.removed for row in ordered if row.removed is not None)

    @property
    def warning(self) -> str | None:
        """Warning about aic and bic, or None."""
        if self.lag_one <= CORRELATED_FROM:
            return None
        return (
            f"residuals hang together (autocorrelation {self.lag_one:.2f}): AIC and BIC count "
            f"{self.independent_samples:.0f} independent samples instead of {self.samples}, and are a rough guide"
        )

    def to_pandas(self) -> Any:
        """``pandas.DataFrame``, a row for each term left out; raises `InputError` where pandas is missing."""
        rows = [asdict(row) | {"removed": row.removed or "none"} for row in self.rows]
        return frame_of(
            rows, "removed", {"samples": self.samples, "independent_samples": self.independent_samples}
        )

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure: error without each term; into a file too where a path is given.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        names = np.array([row.removed or "none" for row in self.rows])
        errors = {
            "fitted again": [row.rms for row in self.rows],
            "as it was": [r.rms_without_refit for r in self.rows],
        }
        panels = [
            Panel([Line(names, values)], "term left out", f"rms error, the rest {how}")
            for how, values in errors.items()
        ]
        title = "Sensitivity: rms error over the standard deviation of the force"
        return draw(Picture(panels, title), path)

    def to_dict(self) -> dict[str, Any]:
        """All numbers, ready for JSON."""
        return asdict(self) | {"ranking": list(self.ranking), "warning": self.warning}


def sensitivity(records: ContactRecord | Sequence[ContactRecord], window: Window | None = None) -> Sensitivity:
    """Fit eq. 11 in full, then seven times with one coefficient left out.

    As in the paper, the others are fitted again. The signed sums of its eq. 13 are near zero by construction
    whatever is missing, so that rms decides; the error without a new fit shows how large the term is.

    Parameters
    ----------
    records, window
        As for `fit`.

    Returns
    -------
    Sensitivity

    Raises
    ------
    InputError
        As `fit` does for the records; the polynomials need not make a contact.
    """
    samples = Samples.of(records, window)
    samples.require_matching_rates()
    full = linear_estimate(samples, TERMS)
    parts = samples.split(samples.force - full.fitted)
    independent = independent_samples(parts)
    scale = float(np.mean((samples.force - full.fitted) ** 2))
    rows = []
    for removed in (None, *TERMS):
        kept = [name for name in TERMS if name != removed]
        fitted = linear_estimate(samples, kept).fitted
        # Of normal residuals -2 ln(likelihood) = N ln(mean square): here of the samples that are independent.
        gain = independent * float(np.log(np.mean((samples.force - fitted) ** 2) / scale))
        fewer = len(TERMS) - len(kept)
        struck = fitted if removed is None else full.fitted - _term(samples, removed, full.parameters[removed])
        rows.append(
            SensitivityRow(
                removed=removed,
                rms=rms_error(samples.force, fitted),
                e_f=sum_error(samples.force, fitted),
                e_acc=samples.acceleration_error(fitted),
                aic=gain - 2.0 * fewer,
                bic=gain - float(np.log(independent)) * fewer,
                rms_without_refit=rms_error(samples.force, struck),
            )
        )
    lag_one = float(np.mean([autocorrelation(part)[1] for part in parts]))
    return Sensitivity(tuple(rows), int(samples.force.size), independent, lag_one)


def _term(samples: Samples, name: str, value: float) -> NDArray[np.float64]:
    return value * COLUMNS[name][1](samples.approach, samples.rate)
