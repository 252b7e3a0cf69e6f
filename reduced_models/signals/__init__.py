"""Vibration signals: from forces of a run to acceleration, its spectra and its statistical features.

| module | is responsible for |
|---|---|
| transfer_path | acceleration of a housing by a force: modes, a measured response, a system of python-control |
| sampling | signals at an output rate from the steps of a run, without aliasing |
| spectra | spectrum of the envelope, spectrum over orders of the shaft |
| indicators | rms, kurtosis, crest factor and others |
| records | labelled synthetic records: cases, their runs on many processes, files |
"""

from reduced_models.signals.indicators import indicators
from reduced_models.signals.records import RecordCase, make_records, write_dataset
from reduced_models.signals.sampling import housing_acceleration, node_acceleration, shaft_angle
from reduced_models.signals.spectra import envelope_spectrum, order_spectrum
from reduced_models.signals.transfer_path import MeasuredPath, ModalPath, SystemPath

__all__ = [
    "MeasuredPath",
    "ModalPath",
    "RecordCase",
    "SystemPath",
    "envelope_spectrum",
    "housing_acceleration",
    "indicators",
    "make_records",
    "node_acceleration",
    "order_spectrum",
    "shaft_angle",
    "write_dataset",
]


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(__all__)
