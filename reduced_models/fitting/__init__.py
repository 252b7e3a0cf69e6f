"""Elements fitted to records and impedances: coefficients with their uncertainty.

| module | is responsible for |
|---|---|
| records | `ContactRecord`: one history of approach, rate and force, simulated or measured |
| samples | records of one contact, each cut to its window |
| fit | `fit`: samples to a memoryless element, or records to a film memory |
| models | least squares of each memoryless model: coefficients, fitted force, covariance |
| least_squares | linear least squares by QR, dependent columns by name |
| power_law_fit | variable projection for the power law |
| memory_fit | `fit_memory`: the film memory, jointly from an impedance and records |
| wide_range_fit | `wide_range_contact`, `wide_range_from_solves`: an element over a wide range of loads |
| pictures | records beside fitted elements: histories, loops, stiffness and damping |
| result | `FitResult`, `MemoryFit`, and the figures by which a fit is judged |
| uncertainty | intervals of coefficients with autocorrelated residuals |
| sensitivity | `sensitivity`: error without each of the seven terms |
"""
