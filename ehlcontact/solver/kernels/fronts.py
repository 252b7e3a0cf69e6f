"""Passes along the fronts of full film behind partly filled nodes, for films that run short of oil.

A sweep moves a front by a node or so, and a front may have far to go. Here each line finds the place of its front
at frozen film, with the lines beside it as they are: the pressure behind the front is solved for directly, for as
far as flow through the gap dominates (as in `cavitation`), and the front moves with it until it stays.
"""

from ehlcontact.jit import inner, jit_loop
from ehlcontact.solver.kernels.cavitation import DOMINANCE, SQUEEZE_DOMINANCE, total_flow
from ehlcontact.solver.kernels.reynolds import operator_at
from ehlcontact.solver.kernels.supply import carry_line

MOVES = 6  # of the fronts of a line in one pass, at most
PASSES = 3  # over the lines, there and back: what is pressed aside comes from the lines beside


@inner
@jit_loop
def solve_behind(j, front, P, flow, supplied, stencil, c_t, least, factors, changes):
    """Solve for the pressure from node `front` on, as far as flow dominates; returns the node after the last.

    The further the nodes that change together reach, the more their film would follow: it has to dominate by more.
    """
    k, end = front, P.shape[1] - 1
    factor = change = 0.0
    while k < end:
        own = total_flow(j, k, flow, stencil)
        residual = supplied[j, k] - operator_at(j, k, P, flow, stencil, c_t)
        if own <= least * (k - front + 1) or (P[j, k] == 0.0 and residual >= 0.0):
            break
        west = stencil.cx * flow.along[j, k - 1] if k > front else 0.0
        pivot = own - west * factor
        change = (west * change - residual) / pivot
        factor = stencil.cx * flow.along[j, k] / pivot
        factors[j, k], changes[j, k] = factor, change
        k += 1
    change = 0.0
    for i in range(k - 1, front - 1, -1):
        change = changes[j, i] + factors[j, i] * change
        P[j, i] = max(P[j, i] + change, 0.0)
    return k


@inner
@jit_loop
def settle_line(j, P, flow, supply, stencil, c_t, least, factors, changes):
    """Move the fronts of line j, with the pressure behind them, to where they belong."""
    rhs, inflow, excess, carried, stored, supplied = supply
    stop = P.shape[1] - 1
    former = 0
    for _ in range(MOVES):
        carry_line(j, stop, P, flow, rhs, inflow, excess, stencil, c_t, carried, stored, supplied)
        places, i, behind = 0, 2, 2
        while i < stop:
            if flow.open[j, i - 1] <= 0.0:
                places += i
                behind = solve_behind(j, i, P, flow, supplied, stencil, c_t, least, factors, changes)
                i = behind = max(behind, i + 1)
            else:
                i += 1
        if places == former:
            return
        former = places
        if P[j, behind] > 0.0:  # nothing changes from there on
            stop = min(behind + 2, P.shape[1] - 1)


@jit_loop
def settle_fronts(first, last, colour, lines, P, flow, supply, stencil, c_t, self_deflection, factors, changes):
    """Settle the fronts on the blocks of `lines` lines ``colour + 2 k``, k from `first` to `last` - 1.

    `P` is written, and what `supply` holds (for `carry_line`); `factors` and `changes`, shaped as P, are work
    space.
    """
    least = (DOMINANCE * stencil.crowding * 1.5 * stencil.inv_hx + SQUEEZE_DOMINANCE * c_t) * self_deflection
    for k in range(first, last):
        start = (colour + 2 * k) * lines
        stop = min(start + lines, P.shape[0] - 1)
        for sweep in range(PASSES):
            for s in range(stop - start):
                j = start + s if sweep % 2 == 0 else stop - 1 - s
                settle_line(j, P, flow, supply, stencil, c_t, least, factors, changes)
