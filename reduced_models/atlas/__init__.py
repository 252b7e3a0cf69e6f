"""The atlas: interpolation of contacts solved beforehand, for any point (M, L, kappa) of its box.

| module | is responsible for |
|---|---|
| atlas | `Atlas`: answers with error bars, and elements, at a point |
| answer | `AtlasAnswer`: one contact with error bars; `AtlasAnswers`: many at once |
| frequency | K and C between the frequencies of the table |
| table | what it holds: box, points, answers, the numbers of its interpolation; the file |
| interpolation | interpolation of the table, and its error bars |
| elements | contact elements from answers under one or several loads |
| build | `build_atlas`: sample, solve what is missing, put together; the numbers of a build |
| sample | the points of a build |
| mesh | grids of a point, by the width of its inlet |
| solve | one of them solved |
| work | points solved by an executor, and kept in a store by content |
| tune | how the numbers of a build were found |
"""
