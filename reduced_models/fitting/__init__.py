"""Elements fitted to records and impedances: coefficients with their uncertainty.

| module | is responsible for |
|---|---|
| records | `ContactRecord`: one history of approach, rate and force, simulated or measured |
| samples | records of one contact, each cut to its window |
| fit | `fit`: from samples to a memoryless element, step by step; the door to every model |
| models | the models that `fit` knows, and what each makes of samples |
| least_squares | linear least squares by QR, dependent columns by name |
| power | variable projection for the power law |
| memory | `fit_memory`: the film memory, jointly from an impedance and records |
| wide | `wide_range_contact`, `wide_range_from_solves`: an element over a wide range of loads |
| result | `FitResult`, `MemoryFit`, and the figures by which a fit is judged |
| uncertainty | intervals of coefficients where residuals hang together |
| sensitivity | `sensitivity`: which of the seven terms the records need |
"""
