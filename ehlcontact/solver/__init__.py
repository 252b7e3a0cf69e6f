"""One film at one instant.

| module | is responsible for |
|---|---|
| domain | `Domain`, the computed region |
| mesh | `mesh_for` and `remedy`: which region and grid a film needs, what follows a failure, every number behind that |
"""
