"""Energy equation of a film, upwind over the nodes under pressure, and of its surfaces (docs/notes/heat.md)."""

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


@jit_loop
def warm_walls(memory, by_mean, across, change):
    """Changes of the temperatures of both surfaces that make up for what they lack, line by line from the inlet.

    A change of the mean of both changes the heat that each takes, and their difference moves heat from one to the
    other, the more the thinner the film is. As surfaces carry heat downstream, all of it is a triangular system.

    Parameters
    ----------
    memory : array (2, nx + 1)
        Rise of each surface by a unit of heat at as many nodes upstream.
    by_mean : array (ny + 1, nx + 1)
        Heat that each surface takes more when the mean of both is warmer by 1.
    across : array (ny + 1, nx + 1)
        Heat from one to the other when they differ by 1.
    change : array (2, ny + 1, nx + 1)
        What they lack; overwritten with the changes.
    """
    first, second = memory
    lines, nodes = by_mean.shape
    for j in range(lines):
        one, two = change[0, j], change[1, j]
        for i in range(nodes):
            half, through = 0.5 * by_mean[j, i], across[j, i]
            if half == 0.0 and through == 0.0:
                continue
            # one = one + first[0] (half (one + two) + through (two - one)), likewise two, with through negative
            a, b = 1.0 - first[0] * (half - through), -first[0] * (half + through)
            c, d = -second[0] * (half + through), 1.0 - second[0] * (half - through)
            size = a * d - b * c
            x, y = (d * one[i] - b * two[i]) / size, (a * two[i] - c * one[i]) / size
            to_one, to_two = half * (x + y) + through * (y - x), half * (x + y) - through * (y - x)
            one[i], two[i] = x, y
            for k in range(1, nodes - i):
                one[i + k] += first[k] * to_one
                two[i + k] += second[k] * to_two
