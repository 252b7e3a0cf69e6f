"""The atlas: interpolation of contacts solved beforehand, for any point (M, L, kappa) of its box.

| module | is responsible for |
|---|---|
| atlas | `Atlas`: answers with error bars, and elements, at a point |
| answer | `AtlasAnswer`: one contact with error bars; `AtlasImpedance`; `AtlasAnswers`: many contacts |
| frequency_curve | K or C between the frequencies of the table |
| conditions | changes of these answers under other conditions than flooded and isothermal |
| change | `Change`: change of answers by a condition |
| supply_condition | `SupplyCondition`: an oil supply, from its own table |
| supply_table | `SupplyTable`: what a supply changes, and its interpolation over M, L, kappa and r |
| supply_build | building the table of oil supply |
| supply_solve | solution of one sample point, flooded and under several layers |
| heat_condition | `HeatCondition`: heat, from its own table; `HeatedFilm` |
| heat_table | `HeatTable`: what heat changes, over M, L, kappa, Q and slope of the oil; its interpolation |
| heat_build | building the table of heat |
| heat_sample | contacts of the table of heat: balls in bearings |
| heat_solve | film and impedance of one of these contacts, with heat and isothermal |
| table | `AtlasTable`: box, points, answers, settings of the interpolation; the file |
| interpolation | interpolation of the table, and its error bars |
| atlas_elements | contact elements from answers under one or several loads |
| gain_fit | gains of the film memory from K and C over frequency |
| filter_table | `contact_filter`: share of short waves that acts like an approach, with error bars; its table |
| filter_points | sample points of the table of contact filters, and the solution of one of them |
| filter_build | building the table of contact filters |
| build | `build_atlas`: sample, solve what is missing, put together; the numbers of a build |
| sample | the points of a build |
| mesh | grids of a point, by the width of its inlet |
| solve | steady film and impedance of one point |
| solved_points | points solved by an executor, and kept in a store by content |
"""
