"""Grid transfer on half domains: full weighting down, bilinear up.

Ratios `sx` along X and `sy` along Y are 2 or 1, not both 1: a mesh may be coarsened along one direction alone.
"""

from ehlcontact.jit import jit


@jit
def full_weighting(fine, coarse, sx, sy):
    """Full weighting, even about line 0; interior of `coarse` written, its boundary left alone."""
    for j in range(coarse.shape[0] - 1):
        c = sy * j
        n, s = c + 1, c - 1 if j > 0 else 1
        for i in range(1, coarse.shape[1] - 1):
            k = sx * i
            if sx == 2:
                middle = 0.5 * fine[c, k] + 0.25 * (fine[c, k - 1] + fine[c, k + 1])
                if sy == 2:
                    north = 0.5 * fine[n, k] + 0.25 * (fine[n, k - 1] + fine[n, k + 1])
                    south = 0.5 * fine[s, k] + 0.25 * (fine[s, k - 1] + fine[s, k + 1])
                    coarse[j, i] = 0.5 * middle + 0.25 * (north + south)
                else:
                    coarse[j, i] = middle
            else:
                coarse[j, i] = 0.5 * fine[c, k] + 0.25 * (fine[n, k] + fine[s, k])


@jit
def restrict_pressure(fine, coarse, sx, sy):
    """Full weighting where all its pressures are positive, injection beside cavitation; `coarse` written."""
    rx, ry = sx - 1, sy - 1
    for j in range(coarse.shape[0] - 1):
        for i in range(1, coarse.shape[1] - 1):
            total = 0.0
            weights = 0.0
            wet = True
            for dj in range(-ry, ry + 1):
                jf = abs(sy * j + dj)
                for di in range(-rx, rx + 1):
                    p = fine[jf, sx * i + di]
                    w = (2.0 - abs(dj)) * (2.0 - abs(di))
                    wet = wet and p > 0.0
                    total += w * p
                    weights += w
            coarse[j, i] = total / weights if wet else fine[sy * j, sx * i]


@jit
def add_correction(new, old, fine, sx, sy):
    """Add the bilinear interpolation of ``new - old`` to `fine`, except along the cavitation boundary.

    A coarse correction beside its own cavitation boundary is no information about the fine one: nodes whose
    coarse neighbours are not all under pressure, before and after, are left to relaxation. The border of the
    domain is no such boundary.
    """
    for j in range(fine.shape[0] - 1):
        j0 = j // sy
        j1 = (j + sy - 1) // sy
        for i in range(1, fine.shape[1] - 1):
            if fine[j, i] <= 0.0:
                continue
            i0 = i // sx
            i1 = (i + sx - 1) // sx
            change = 0.0
            wet = True
            for jc in range(j0, j1 + 1):
                for ic in range(i0, i1 + 1):
                    change += new[jc, ic] - old[jc, ic]
                    border = ic == 0 or ic == new.shape[1] - 1 or jc == new.shape[0] - 1
                    wet = wet and (border or (new[jc, ic] > 0.0 and old[jc, ic] > 0.0))
            if wet:
                weight = (j1 - j0 + 1.0) * (i1 - i0 + 1.0)
                fine[j, i] = max(fine[j, i] + change / weight, 0.0)


@jit
def drain(new, old, fine, sx, sy, end):
    """Take the pressure from nodes of `fine` before column `end` around which the coarse grid has lost all of its.

    A front of full film that is far from its place moves by whole coarse nodes then.
    """
    for j in range(fine.shape[0] - 1):
        j0 = j // sy
        j1 = (j + sy - 1) // sy
        for i in range(1, end):
            if fine[j, i] <= 0.0:
                continue
            i0 = i // sx
            i1 = (i + sx - 1) // sx
            dry = True
            lost = False
            for jc in range(j0, j1 + 1):
                for ic in range(i0, i1 + 1):
                    dry = dry and new[jc, ic] <= 0.0
                    lost = lost or old[jc, ic] > 0.0
            if dry and lost:
                fine[j, i] = 0.0
