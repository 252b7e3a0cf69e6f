"""Vibration signals: from forces of a run to acceleration, its spectra and its statistical features.

| module | is responsible for |
|---|---|
| transfer_path | acceleration of a housing by a force: modes, a measured response, a system of python-control |
| sampling | signals at an output rate from the steps of a run, without aliasing |
| spectra | spectrum of the envelope, spectrum over orders of the shaft |
| indicators | rms, kurtosis, crest factor and others |
| records | labelled synthetic records: cases, their runs on many processes, files |
"""
