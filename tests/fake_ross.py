"""What ROSS 2.3.0 has of the names that we use, and does with them, on the beams of `beam_rotor`."""

from types import SimpleNamespace

import numpy as np
from beam_rotor import shaft

BENDING = (0, 1, 3, 4)


class BearingElement:
    """Two by two coefficients over speed, straight between them."""

    def __init__(
        self, n, kxx, cxx, kyy=None, kxy=0.0, kyx=0.0, cyy=None, cxy=0.0, cyx=0.0,
        frequency=None, tag=None, n_link=None,
    ):  # fmt: skip
        self.n, self.frequency, self.tag, self.n_link = n, frequency, tag, n_link
        self.k = (kxx, kxy, kyx, kxx if kyy is None else kyy)
        self.c = (cxx, cxy, cyx, cxx if cyy is None else cyy)
        for values in (*self.k, *self.c):
            assert np.size(values) in (1, np.size(frequency if frequency is not None else 0.0))

    def _at(self, values, frequency):
        if self.frequency is not None:
            rows = [np.broadcast_to(value, np.shape(self.frequency)) for value in values]
            values = [np.interp(frequency, self.frequency, row) for row in rows]
        return np.reshape(values, (2, 2)).astype(float)

    def K(self, frequency):
        return self._at(self.k, frequency)

    def C(self, frequency):
        return self._at(self.c, frequency)


class SealElement(BearingElement):
    """No bearing, though ROSS derives it from one."""


class Rotor:
    """`shaft_elements` are lengths, `disk_elements` (node, diameter, width), point masses (node, mass)."""

    number_dof = 6

    def __init__(
        self, shaft_elements, disk_elements=None, bearing_elements=None, point_mass_elements=None,
        min_w=None, max_w=None, rated_w=None, tag=None,
    ):  # fmt: skip
        self.shaft_elements, self.disk_elements = shaft_elements, disk_elements or []
        self.bearing_elements, self.point_mass_elements = bearing_elements or [], point_mass_elements or []
        self.min_w, self.max_w, self.rated_w, self.tag = min_w, max_w, rated_w, tag
        tags = [e.tag for e in self.bearing_elements if e.tag is not None]
        assert len(tags) == len(set(tags)), "Tags should be unique."
        self.nodes = list(range(len(shaft_elements) + 1))
        self.ndof = 6 * len(self.nodes) + 3 * len(self.point_mass_elements)
        self._M, self._K, self._G = (np.zeros((self.ndof, self.ndof)) for _ in range(3))
        size = 6 * (len(shaft_elements) + 1)
        at = np.add.outer(np.arange(0, size, 6), BENDING).ravel()
        for matrix, beams in zip(
            (self._M, self._K, self._G), shaft(shaft_elements, 0.04, self.disk_elements), strict=True
        ):
            matrix[np.ix_(at, at)] = beams
        others = np.setdiff1d(np.arange(size), at)
        self._M[others, others] = self._K[others, others] = 1.0  # bars and torsion, which are none of ours
        for node, mass in self.point_mass_elements:
            at = range(self._first(node), self._first(node) + 3)
            self._M[at, at] += mass

    def _first(self, node):
        return 6 * min(node, len(self.nodes)) + 3 * max(node - len(self.nodes), 0)

    def _with(self, matrix, name, frequency):
        out = matrix.copy()
        for e in self.bearing_elements:
            block = getattr(e, name)(frequency)
            ends = [(e.n, 1.0), *([(e.n_link, -1.0)] if e.n_link is not None else [])]
            for a, sign_a in ends:
                for b, sign_b in ends:
                    i, j = self._first(a), self._first(b)
                    out[i : i + 2, j : j + 2] += sign_a * sign_b * block
        return out

    def M(self, frequency=None):
        return self._M.copy()

    def K(self, frequency):
        return self._with(self._K, "K", frequency)

    def C(self, frequency):
        return self._with(np.zeros_like(self._K), "C", frequency)

    def G(self):
        return self._G.copy()

    def run_modal(self, speed):
        held = np.abs(self._M).sum(axis=1) > 0.0
        at = np.ix_(held, held)
        M, C, K = self._M[at], (self.C(speed) + speed * self._G)[at], self.K(speed)[at]
        n = len(M)
        roots = np.linalg.eigvals(
            np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
        )
        roots = roots[roots.imag > 10.0]  # not bars and torsion
        roots = roots[np.argsort(np.abs(roots))]
        return SimpleNamespace(wn=np.abs(roots), log_dec=-2.0 * np.pi * roots.real / roots.imag)

    def run_time_response(self, speed, F, t, method="default", add_to_RHS=None):
        """Newmark with forces of the state at the start of the step, from zeros."""
        assert method == "newmark"
        M, K, C = self._M, self.K(speed), self.C(speed) + speed * self._G
        dt = t[1] - t[0]
        solve = np.linalg.inv(M + 0.5 * dt * C + 0.25 * dt * dt * K)
        y, v, a = np.zeros((3, self.ndof))
        yout = np.zeros((len(t), self.ndof))
        for step in range(1, len(t)):
            extra = add_to_RHS(step, time_step=t[step] - t[step - 1], disp_resp=y, velc_resp=v, accl_resp=a)
            v_new, y_new = v + 0.5 * dt * a, y + dt * v + 0.25 * dt * dt * a
            a = solve @ (F[step] + extra - K @ y_new - C @ v_new)
            y, v = y_new + 0.25 * dt * dt * a, v_new + 0.5 * dt * a
            yout[step] = y
        return SimpleNamespace(yout=yout)


def module():
    """As `import ross` gives it."""
    return SimpleNamespace(BearingElement=BearingElement, SealElement=SealElement, Rotor=Rotor)
