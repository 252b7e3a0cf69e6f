"""One film at one instant.

| module | is responsible for |
|---|---|
| domain | `Domain`, the computed region |
| mesh | `mesh_for`, `remedy`: which region and grid a film needs, what to try after a failure; all their numbers |
"""
