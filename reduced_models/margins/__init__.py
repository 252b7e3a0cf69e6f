"""Margins under uncertainty: samples of a machine whose inputs are ranges or distributions.

| module | is responsible for |
|---|---|
| spread | `spread`: an input as a range or a distribution; quasi-random draws of several |
| samples | `sample_of`: the numbers of one machine, or why it has none |
| statistics | intervals from samples with their error, rank correlations with theirs |
| result | `Uncertainty`: intervals, what moves them, what failed; its picture |
| sampling | `uncertainty`: samples of a function, on workers, kept in a folder |
"""
