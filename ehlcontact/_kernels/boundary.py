"""Projected point Gauss-Seidel along the cavitation boundary.

Line relaxation with clipping leaves residuals on the last lines before the free boundary, where P is tiny:
the second stall of the classical scheme, besides the switch line. A few local passes at frozen film remove
them. Only where flow through the gap dominates: elsewhere the film answers to the pressure at once, and a
frozen film makes these passes diverge.
"""

from ehlcontact._kernels.jit import jit
from ehlcontact._kernels.mean import flow_mean
from ehlcontact._kernels.reynolds import operator_at

PASSES = 4
REACH = 3  # nodes on either side of the boundary
DOMINANCE = 3.0  # flow term over wedge term
SQUEEZE_DOMINANCE = 30.0  # flow term over squeeze term


@jit
def mark_boundary(P, marks):
    """Mark the nodes within REACH of a change between P > 0 and P = 0; `marks` (bytes) written."""
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    marks[:] = 0
    for j in range(ny):
        for i in range(1, nx):
            wet = P[j, i] > 0.0
            east = i + 1 < nx and (P[j, i + 1] > 0.0) != wet
            north = j + 1 < ny and (P[j + 1, i] > 0.0) != wet
            if east or north:
                for jj in range(max(j - REACH, -REACH), min(j + REACH + 1, ny - 1) + 1):
                    for ii in range(max(i - REACH, 1), min(i + REACH + 1, nx - 1) + 1):
                        marks[abs(jj), ii] = 1


@jit
def total_flow(j, i, eps, mesh):
    """Sum of the four couplings of one node."""
    js = j - 1 if j > 0 else 1
    e = eps[j, i]
    along = flow_mean(e, eps[j, i - 1]) + flow_mean(e, eps[j, i + 1])
    return mesh.cx * along + mesh.cy * (flow_mean(e, eps[js, i]) + flow_mean(e, eps[j + 1, i]))


@jit
def relax_boundary(P, eps, mass, rhs, mesh, c_t, self_deflection, nodes, marks):
    """Relax P near the cavitation boundary at frozen eps and mass; `P` written, `nodes`, `marks` work space."""
    width = P.shape[1]
    mark_boundary(P, marks)
    transport = DOMINANCE * 1.5 * mesh.inv_hx + SQUEEZE_DOMINANCE * c_t
    count = 0
    for j in range(P.shape[0] - 1):
        for i in range(1, width - 1):
            if marks[j, i] and total_flow(j, i, eps, mesh) > transport * self_deflection:
                nodes[count] = j * width + i
                count += 1
    for sweep in range(PASSES):
        for s in range(count):
            node = nodes[s] if sweep % 2 == 0 else nodes[count - 1 - s]
            j, i = node // width, node % width
            own = total_flow(j, i, eps, mesh) + (1.5 * mesh.inv_hx + c_t) * self_deflection
            res = rhs[j, i] - operator_at(j, i, P, eps, mass, mesh, c_t)
            P[j, i] = max(P[j, i] - res / own, 0.0)
