"""How a solve or a run of a model ended, each way with advice."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """End of a solve, of a rotor's or oscillator's run, or of a stage; ``advice`` says what to do about it."""

    CONVERGED = "converged"
    STAGNATED = "stagnated"
    DIVERGED = "diverged"
    NONFINITE = "nonfinite"
    MAX_CYCLES = "max_cycles"
    OUT_OF_DOMAIN = "out_of_domain"
    UNRESOLVED = "unresolved"
    STARVED = "starved"
    BEYOND_REGION = "beyond_region"
    STEP_TOO_SMALL = "step_too_small"
    INTERRUPTED = "interrupted"
    FAILED = "failed"

    @property
    def advice(self) -> str:
        """One sentence."""
        return _ADVICE[self]

    @property
    def ok(self) -> bool:
        """Whether the result can be relied on."""
        return self is Status.CONVERGED


_ADVICE = {
    Status.CONVERGED: "Residuals, and the changes still to come, are below tolerance.",
    Status.STAGNATED: "The pressure no longer settles: try a wider domain at light load, else a finer grid, "
    "a smaller time step where there is one, or a tolerance above rounding (1e-9).",
    Status.DIVERGED: "The residual grows: use a finer grid; in a simulation also a smaller time step.",
    Status.NONFINITE: "NaN or infinity appeared: use a finer grid, or check that M, L and kappa are meant.",
    Status.MAX_CYCLES: "The cycles ran out while still converging: raise max_cycles.",
    Status.OUT_OF_DOMAIN: "Pressure reaches the border of the computed region: give a wider domain, such as "
    "Grid(domain=Domain.for_load(largest force to come)), --domain XA XB YMAX, or domain under [contact] of "
    "a study.",
    Status.UNRESOLVED: "The grid is too coarse for this film, which is zero or negative somewhere: raise n; in a "
    "simulation a step that is too long, or surfaces that touch, end so too: shorten the step, lower the load.",
    Status.STARVED: "The layer of oil is so thin that the film is zero or negative on this grid: raise n, or let "
    "more oil in.",
    Status.BEYOND_REGION: "The layer of oil is so thick that the full film begins ahead of the computed region: "
    "leave grid out, or give Grid(domain=) with a longer inlet; a flooded inlet has no supply.",
    Status.STEP_TOO_SMALL: "However short the step, it does not meet its tolerance: allow a larger error, or "
    "smooth what jumps (a load, a surface).",
    Status.INTERRUPTED: "Stopped by the user; what was computed until then is kept.",
    Status.FAILED: "It broke off; the message says why.",
}
