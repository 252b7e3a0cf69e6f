"""The atlas: interpolation of contacts solved beforehand, for any point (M, L, kappa) of its box.

| module | is responsible for |
|---|---|
| atlas | `Atlas`: answers with error bars, and elements, at a point |
| answer | `AtlasAnswer`: one contact with error bars; `AtlasAnswers`: many contacts |
| frequency_curve | K or C between the frequencies of the table |
| conditions | `Condition`: changes of answers of flooded isothermal contacts, one way for all conditions |
| atlas_elements | contact elements from answers under one or several loads |
| gain_fit | gains of the film memory from K and C over frequency |
| table | `Table`: solved points, named columns, metadata; the file of any recipe |
| surface | `Surface`: a table as a function of its points, with error bars; files that are open |
| recipe | `Recipe`: sample, coordinates and smooth variables of a table |
| film | recipe of films and impedances over M, L and kappa |
| supply | recipe of what a layer of oil changes, over M, L, kappa and r; `Supplied` |
| heat | recipe of what heat changes, over M, L, kappa, Q and slope of the oil; `Heated`, `HeatedFilm` |
| waves | recipe of contact filters: share of short waves that acts like an approach; `contact_filter` |
| other_oil | `OtherOil`: reading the atlas for oils of another alpha and eta0 |
| mesh | grids of a point, by the width of its inlet |
| build | `build`: sample, solve what is missing on workers, put together, leave one out, write |
"""
