"""Oil supply: which nodes are partly filled, and the flow that the surfaces carry through them.

The mass balance of a node is that of a full film, with the Couette flow Q through the face behind it in the place
of what a full gap would carry, G = rho H there (third-order upstream-biased, as in `reynolds.transport_at`):

    d/dX(eps dP/dX) + kappa^2 d/dY(eps dP/dY) - dQ/dX = rhs,    Q <= G,  P >= 0,  P (G - Q) = 0,

the complementarity of pressure and content of Elrod and Adams (1974). A node under pressure is full, Q = G. Where
P = 0 the flow is what came from upstream and what pressure beside it pressed in, and the first Q of a line is the
layer that enters, as far as the gap has room for it.

The first full node behind partly filled ones gets a given flow, that of the surfaces and of what is pressed in:
the face before it is closed to pressure, and its balance is written with Q in the place of the wedge term's part
there. So its pressure is that of a given flow, not of P = 0 beside it, also within the equations of a line. How
far Q of the last partly filled node is from the layer towards G is where between two nodes the front lies:
everything is continuous while the front moves through the nodes.

What changes in time is the oil stored in the cells, dS/dT beside dQ/dX:

- rho H where the gap is full, also at the node before;
- half of Q through either face where it is partly filled, which is what moves with the surfaces; behind a full
  node the share of G that Q is counts, of what makes S = rho H at Q = G;
- behind the front ``s rho H + (1 - s)(Q' + G)/2``, with the flow Q' given through the face before it and
  ``s = B/(G_before - Q')``: the flow B pressed back through that face over the largest that there can be, the way
  of the front from this node to the one before.

So while the front passes a cell, what is stored is that cell full less what the layer had brought into it, to
second order, and it is continuous when nodes fill up. That makes the damping of starved contacts converge.

A feature that moves with the surfaces is carried exactly (`transient.transient_film`): the flow of a full gap is
then G less what the differences of the feature are off, C, an input at the faces. All balances hold with G - C.
"""

from ehlcontact.jit import jit_loop, jit_node
from ehlcontact.solver.kernels.linearise import NEIGHBOURS, linearise_at
from ehlcontact.solver.kernels.reynolds import Stencil, flow_mean, update_along

# Gap over layer, at kappa = 1, that no front lies ahead of at first: it settles faster downstream than upstream.
FRONT_GAP = 8.0
WIDER_GAP = 1.5  # power of 1/kappa by which it is more: a wide contact lets little oil aside
FITTING = 4.0  # gap at the border over layer, from which the front may lie within the region


@jit_node
def full_flow(j, i, mass):
    """Couette flow of a full gap through the face behind node i; of node 0 that of `transport_at` at node 1."""
    if i > 0:
        return (2.0 * mass[j, i + 1] + 5.0 * mass[j, i] - mass[j, i - 1]) / 6.0
    return (2.0 * mass[j, 0] + 5.0 * mass[j, 1] - mass[j, 2]) / 6.0


@jit_node
def pressed_in(j, i, P, flow, stencil):
    """Flow by pressure into a node with P = 0, over its area."""
    below, face = (j - 1, j - 1) if j > 0 else (1, 0)
    along = flow.along[j, i] * P[j, i + 1] + flow.along[j, i - 1] * P[j, i - 1]
    across = flow.across[j, i] * P[j + 1, i] + flow.across[face, i] * P[below, i]
    return stencil.cx * along + stencil.cy * across


@jit_loop
def open_faces(first, last, flow):
    """Open all faces on lines `first` to `last` - 1."""
    for j in range(first, last):
        for i in range(flow.open.shape[1] - 1):
            if flow.open[j, i] != 1.0:
                flow.open[j, i] = 1.0
                update_along(j, i, flow)


@jit_node
def own_share(before, full, mass, behind_full):
    """Part that Q has in the oil of a partly filled cell; Q through the face before it has one half."""
    return (mass - 0.5 * before) / full if behind_full else 0.5


@jit_node
def stored_at_front(before, back, full_before, full, mass):
    """Oil in the cell behind a front, by Q of the node before, of which `back` comes out of this cell."""
    given = before - back
    room = full_before - given
    way = min(back / room, 1.0) if room > 0.0 else 1.0
    return way * mass + (1.0 - way) * 0.5 * (given + full)


@jit_node
def front_weight(step):
    """Share of the flow pressed back that the balance behind the front feels; `step` is c_t over 1/hx."""
    return step / (1.0 + 0.5 * step)


@jit_node
def carry_line(j, stop, P, flow, rhs, inflow, excess, stencil, c_t, carried, stored, supplied):
    """`carry_supply` on line j, before node `stop`.

    Inlined: of a kernel that several call, the process that compiles it may run another copy than later ones do,
    with other last bits.
    """
    h = 1.0 / stencil.inv_hx
    weight = front_weight(c_t * h)
    full = full_flow(j, 0, flow.mass) - excess[j, 0]
    carries = min(inflow[j], full)  # Q
    carried[j, 0] = carries
    short = full + excess[j, 0] - carries  # of the G before this node
    partly = False  # the node before is; not the border, over which oil may flow back
    behind_full = False
    back = 0.0  # pressed into the node before, from this one
    for i in range(1, stop):
        if flow.open[j, i] != 1.0:
            flow.open[j, i] = 1.0
            update_along(j, i, flow)
        full_before, full, mass = full, full_flow(j, i, flow.mass) - excess[j, i], flow.mass[j, i]
        fills = P[j, i] > 0.0
        passed, oil = full, mass
        share = own_share(carries, full, mass, behind_full)
        if not fills:
            given = carries + h * (pressed_in(j, i, P, flow, stencil) - rhs[j, i])
            passed = (given - 0.5 * c_t * h * carries) / (1.0 + c_t * h * share)
            fills = passed > full
        if fills and partly:
            flow.open[j, i - 1] = -weight
            update_along(j, i - 1, flow)
            oil = stored_at_front(carries, back, full_before, full, mass)
            supplied[j, i] = rhs[j, i] - stencil.inv_hx * (carries - back + weight * back) - c_t * (mass - oil)
            supplied[j, i - 1] += stencil.inv_hx * weight * back  # what is pressed back has filled it already
        elif fills:
            supplied[j, i] = rhs[j, i] + stencil.inv_hx * short
        else:
            supplied[j, i] = rhs[j, i] + stencil.inv_hx * short - c_t * (mass - 0.5 * carries - share * full)
            oil = 0.5 * carries + share * passed
        supplied[j, i] -= stencil.inv_hx * excess[j, i]
        stored[j, i] = oil
        partly, behind_full = not fills, fills
        back = h * stencil.cx * flow.along[j, i] * P[j, i + 1]
        carries = full if fills else passed
        short = full + excess[j, i] - carries
        carried[j, i] = carries


@jit_loop
def carry_supply(first, last, P, flow, rhs, inflow, excess, stencil, c_t, carried, stored, supplied):
    """Flow through the faces of lines `first` to `last` - 1, from the inlet on, and right-hand sides with it.

    Parameters
    ----------
    inflow : array (ny + 1,)
        The layer that enters.
    excess : array (ny + 1, nx + 1)
        C of the face behind each node.
    carried : array (ny + 1, nx + 1)
        Q through the face behind each node, written; ``flow.open`` and ``flow.along`` likewise.
    stored : array (ny + 1, nx + 1)
        S of the cell of each node, written.
    supplied : array (ny + 1, nx + 1)
        Right-hand sides for which `reynolds.operator_at` is the balance above, written. Negative residuals at
        P = 0 are those of nodes that fill up.
    """
    for j in range(first, last):
        carry_line(j, P.shape[1] - 1, P, flow, rhs, inflow, excess, stencil, c_t, carried, stored, supplied)


@jit_loop
def store_supply(first, last, P, flow, stencil, carried, stored):
    """S of the cells of lines `first` to `last` - 1 with the Q of `carried`, all faces open; `stored` written."""
    h = 1.0 / stencil.inv_hx
    for j in range(first, last):
        for i in range(1, P.shape[1] - 1):
            mass, full, before = flow.mass[j, i], full_flow(j, i, flow.mass), carried[j, i - 1]
            partly = i > 1 and P[j, i - 1] == 0.0
            stored[j, i] = mass
            if P[j, i] == 0.0:
                share = own_share(before, full, mass, i > 1 and not partly)
                stored[j, i] = 0.5 * before + share * carried[j, i]
            elif partly:
                back = h * stencil.cx * flow.along[j, i - 1] * P[j, i]
                stored[j, i] = stored_at_front(before, back, full_flow(j, i - 1, flow.mass), full, mass)


@jit_loop
def linearise_pressed_in(P, flow, stencil, p_coef, h_coef, target):
    """Derivatives of the flow by pressure into partly filled nodes, in the place of those of `linearise`.

    The full node that they lead to gets that flow: ``target[j, i]`` is its flat number where there is such a flow,
    else -1. All three written.
    """
    nx = P.shape[1] - 1
    still = Stencil(stencil.cx, stencil.cy, 0.0, stencil.lam, stencil.speed, stencil.crowding)
    target[:] = -1
    for j in range(P.shape[0] - 1):
        front = -1
        for i in range(nx - 1, 0, -1):
            if front >= 0 and P[j, i] == 0.0 and pressed_in(j, i, P, flow, stencil) > 0.0:
                target[j, i] = front
                derivatives = linearise_at(j, i, P, flow, still, 0.0, 1.0)
                for q in range(NEIGHBOURS):
                    p_coef[q, j, i] = derivatives[q]
                    h_coef[q, j, i] = derivatives[NEIGHBOURS + q]
            if flow.open[j, i - 1] <= 0.0:
                front = j * (nx + 1) + i
            elif P[j, i - 1] > 0.0:
                front = -1


@jit_loop
def linearise_pressed_back(before, P, flow, stencil, slopes):
    """Flow by pressure back through the closed faces, as if they were open, over a cell's area; its derivatives.

    `before` lists the flat numbers of the nodes before them; ``slopes[:, k]``, written, is to the pressure and to
    the film of the node behind such a face, and to the film of that before it, and last the flow itself.
    """
    width = P.shape[1]
    for k in range(len(before)):
        j, i = before[k] // width, before[k] % width
        mean, skew = flow_mean(flow.eps[j, i], flow.eps[j, i + 1])
        drop = stencil.cx * P[j, i + 1]
        own, other = drop * (0.5 * mean + skew), drop * (0.5 * mean - skew)
        slopes[0, k] = stencil.cx * mean + other * flow.eps_slope[j, i + 1]
        slopes[1, k] = other * flow.film_slope[j, i + 1]
        slopes[2, k] = own * flow.film_slope[j, i]
        slopes[3, k] = drop * mean
