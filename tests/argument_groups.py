"""Arguments of `simulate` and of the other solvers from flat keywords, for tests that vary them by name."""

from ehlcontact import Grid, KeepSettings, RunSettings, TimeSteps

GROUPS = {
    "grid": (Grid, ("n", "domain", "deflection")),
    "time": (TimeSteps, ("until", "dt", "periods", "steps_per_period", "local_error", "tol")),
    "keep": (KeepSettings, ("snapshots", "checkpoint", "checkpoint_every", "restart")),
    "run": (RunSettings, ("threads", "throw", "callback")),
}


def grouped(**flat):
    """Keyword arguments of `simulate`: those of its groups gathered, others as they are."""
    return _gathered(flat, GROUPS)


def with_grid(**flat):
    """Keyword arguments of `solve_steady`, `impedance` or `TransientContact`: those of the grid gathered."""
    return _gathered(flat, {"grid": GROUPS["grid"]})


def _gathered(flat, groups):
    left = dict(flat)
    found = {}
    for name, (group, keys) in groups.items():
        own = {key: left.pop(key) for key in keys if key in left}
        if own:
            found[name] = group(**own)
    return found | left
