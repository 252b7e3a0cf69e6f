"""Relaxation by lines along Y, for ellipses whose long axis lies along rolling (kappa > 1).

There the flow couples most strongly along Y, and relaxation by lines along X no longer smooths the inlet. As
along the cavitation boundary, film and flow factor are frozen, so only nodes where flow dominates take part.
"""

from ehlcontact._kernels.boundary import DOMINANCE, SQUEEZE_DOMINANCE
from ehlcontact._kernels.jit import jit
from ehlcontact._kernels.reynolds import operator_at


@jit
def relax_columns(P, eps, mass, rhs, mesh, c_t, self_deflection, work):
    """One sweep over all columns, even ones first; `P` written, `work` (2, ny + 1) is work space."""
    nx = P.shape[1] - 1
    for colour in range(2):
        for i in range(1 + colour, nx, 2):
            relax_column(i, P, eps, mass, rhs, mesh, c_t, self_deflection, work)


@jit
def relax_column(i, P, eps, mass, rhs, mesh, c_t, self_deflection, work):
    """Solve column i for its pressure changes by forward elimination and back substitution; `P` written."""
    ny = P.shape[0] - 1
    upper, change = work[0], work[1]
    wedge = 1.5 * mesh.inv_hx * self_deflection
    squeeze = c_t * self_deflection
    for j in range(ny):
        js = j - 1 if j > 0 else 1
        e = eps[j, i]
        north = 0.5 * mesh.cy * (e + eps[j + 1, i])
        south = 0.5 * mesh.cy * (e + eps[js, i])
        flow = north + south + 0.5 * mesh.cx * (2.0 * e + eps[j, i - 1] + eps[j, i + 1])
        res = rhs[j, i] - operator_at(j, i, P, eps, mass, mesh, c_t)
        free = P[j, i] > 0.0 or res < 0.0
        if not free or flow < DOMINANCE * wedge + SQUEEZE_DOMINANCE * squeeze:
            upper[j] = 0.0
            change[j] = 0.0
            continue
        if j == 0:  # both neighbours are the same node
            north, south = north + south, 0.0
        pivot = -(flow + wedge + squeeze)
        if j > 0:
            pivot -= south * upper[j - 1]
            res -= south * change[j - 1]
        upper[j] = north / pivot
        change[j] = res / pivot
    for j in range(ny - 1, -1, -1):
        if j + 1 < ny:
            change[j] -= upper[j] * change[j + 1]
        P[j, i] = max(P[j, i] + change[j], 0.0)
