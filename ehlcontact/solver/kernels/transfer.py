"""Grid transfer on half domains: full weighting down, bilinear up."""

from ehlcontact.jit import jit


@jit
def full_weighting(fine, coarse):
    """Full weighting, even about line 0; interior of `coarse` written, its boundary left alone."""
    for j in range(coarse.shape[0] - 1):
        n, s = 2 * j + 1, 2 * j - 1 if j > 0 else 1
        for i in range(1, coarse.shape[1] - 1):
            c = 2 * i
            middle = 2.0 * fine[2 * j, c] + fine[2 * j, c - 1] + fine[2 * j, c + 1]
            north = 2.0 * fine[n, c] + fine[n, c - 1] + fine[n, c + 1]
            south = 2.0 * fine[s, c] + fine[s, c - 1] + fine[s, c + 1]
            coarse[j, i] = 0.125 * middle + 0.0625 * (north + south)


@jit
def restrict_pressure(fine, coarse):
    """Full weighting where all nine pressures are positive, injection beside cavitation; `coarse` written."""
    for j in range(coarse.shape[0] - 1):
        n, s = 2 * j + 1, 2 * j - 1 if j > 0 else 1
        for i in range(1, coarse.shape[1] - 1):
            total = 0.0
            wet = True
            for jf, wj in ((s, 1.0), (2 * j, 2.0), (n, 1.0)):
                for di in range(-1, 2):
                    p = fine[jf, 2 * i + di]
                    wet = wet and p > 0.0
                    total += wj * (2.0 if di == 0 else 1.0) * p
            coarse[j, i] = total / 16.0 if wet else fine[2 * j, 2 * i]


@jit
def add_correction(new, old, fine):
    """Add the bilinear interpolation of ``new - old`` to `fine`, except along the cavitation boundary.

    A coarse correction beside its own cavitation boundary is no information about the fine one: nodes whose
    coarse neighbours are not all under pressure, before and after, are left to relaxation. The border of the
    domain is no such boundary.
    """
    for j in range(fine.shape[0] - 1):
        for i in range(1, fine.shape[1] - 1):
            if fine[j, i] <= 0.0:
                continue
            change = 0.0
            wet = True
            for jc in range(j // 2, (j + 1) // 2 + 1):
                for ic in range(i // 2, (i + 1) // 2 + 1):
                    change += new[jc, ic] - old[jc, ic]
                    border = ic == 0 or ic == new.shape[1] - 1 or jc == new.shape[0] - 1
                    wet = wet and (border or (new[jc, ic] > 0.0 and old[jc, ic] > 0.0))
            if wet:
                weight = (2.0 if j % 2 else 1.0) * (2.0 if i % 2 else 1.0)
                fine[j, i] = max(fine[j, i] + change / weight, 0.0)
