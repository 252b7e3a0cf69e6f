"""Sweeps of the energy equation of a film: upwind, over the nodes under pressure (docs/heat.md, eq. 5)."""

from ehlcontact.jit import jit_loop

ORDERS = 4  # lines up and down, nodes along and against: heat goes back in the inlet


@jit_loop
def sweep(along, across, exchange, source, share, rise):
    """One Gauss-Seidel sweep in every order; `rise` written, returns its largest change.

    Parameters
    ----------
    along, across : array (ny + 1, nx + 1)
        Heat that a rise of 1 carries from node i to i + 1, and from j to j + 1, over a cell's area; negative where
        it goes the other way, with the rise of the node it comes from.
    exchange : array (ny + 1, nx + 1)
        Heat that a rise of 1 gives to the surfaces; 0 where there is no pressure, and no rise.
    source : array (ny + 1, nx + 1)
    share : array (ny + 1, nx + 1)
        Of the heat that comes from the neighbours, what stays in the oil.
    rise : array (ny + 1, nx + 1)
        Mean temperature of the film over that of the surfaces.
    """
    ny, nx = rise.shape[0] - 1, rise.shape[1] - 1
    largest = 0.0
    for order in range(ORDERS):
        for k in range(ny):
            j = k if order < 2 else ny - 1 - k
            below, face = (j - 1, j - 1) if j > 0 else (1, 0)
            for m in range(1, nx):
                i = m if order % 2 == 0 else nx - m
                if exchange[j, i] == 0.0:
                    continue
                west, east, north = along[j, i - 1], along[j, i], across[j, i]
                south = across[face, i] if j > 0 else -north  # the line below line 0 is its image
                own = max(east, 0.0) - min(west, 0.0) + max(north, 0.0) - min(south, 0.0)
                comes = max(west, 0.0) * rise[j, i - 1] - min(east, 0.0) * rise[j, i + 1]
                comes += max(south, 0.0) * rise[below, i] - min(north, 0.0) * rise[j + 1, i]
                new = (source[j, i] + share[j, i] * comes) / (own + exchange[j, i])
                largest = max(largest, abs(new - rise[j, i]))
                rise[j, i] = new
    return largest
