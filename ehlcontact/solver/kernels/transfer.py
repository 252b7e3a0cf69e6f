"""Grid transfer on half domains, halving along X, along Y or both."""

from ehlcontact.jit import jit


@jit
def full_weighting(fine, coarse, sx, sy):
    """Full weighting of a residual: sx, sy are 2 along directions that are halved, else 1; `coarse` written."""
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
    """The same of the pressure where all nodes around have some, else the node itself; `coarse` written."""
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
    """Add to `fine`, where it has pressure, the change from `old` to `new`, bilinear between nodes with some."""
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
