"""What ROSS 2.3 and 3.1 have of the names that we use, and do with them, on the beams of `beam_rotor`."""

from types import SimpleNamespace

import numpy as np
from beam_rotor import RHO, E, shaft

BENDING, ALONG = (0, 1, 3, 4), 2
DIAMETER = 0.04


class BearingElement:
    """Coefficients of x, y and of z as in ROSS 3: over speed, whirl frequency or both, straight between points."""

    def __init__(
        self, n, kxx, cxx, kyy=None, kxy=0.0, kyx=0.0, cyy=None, cxy=0.0, cyx=0.0,
        kzz=0.0, czz=0.0, speed=None, frequency=None, tag=None, n_link=None,
    ):  # fmt: skip
        self.n, self.speed, self.frequency, self.tag, self.n_link = n, speed, frequency, tag, n_link
        self.k = (kxx, kxy, kyx, kxx if kyy is None else kyy, kzz)
        self.c = (cxx, cxy, cyx, cxx if cyy is None else cyy, czz)
        self.shape = tuple(np.size(axis) for axis in (speed, frequency) if axis is not None)
        for values in (*self.k, *self.c):
            assert np.shape(values) in ((), self.shape)

    def _at(self, values, frequency, speed):
        found = np.array([np.broadcast_to(value, self.shape) for value in values], float)
        if self.frequency is not None:
            found = np.apply_along_axis(lambda row: np.interp(frequency, self.frequency, row), -1, found)
        if self.speed is not None:
            found = np.apply_along_axis(lambda row: np.interp(speed, self.speed, row), -1, found)
        xx, xy, yx, yy, zz = found
        return np.array([[xx, xy, 0.0], [yx, yy, 0.0], [0.0, 0.0, zz]])

    def K(self, frequency, speed=None):
        return self._at(self.k, frequency, frequency if speed is None else speed)

    def C(self, frequency, speed=None):
        return self._at(self.c, frequency, frequency if speed is None else speed)


class BearingElement2(BearingElement):
    """As in ROSS 2: one axis, `frequency`, over which analyses give the speed."""

    def __init__(
        self, n, kxx, cxx, kyy=None, kxy=0.0, kyx=0.0, cyy=None, cxy=0.0, cyx=0.0,
        kzz=0.0, czz=0.0, frequency=None, tag=None, n_link=None,
    ):  # fmt: skip
        super().__init__(n, kxx, cxx, kyy, kxy, kyx, cyy, cxy, cyx, kzz, czz, None, frequency, tag, n_link)

    def K(self, frequency):
        return super().K(frequency)

    def C(self, frequency):
        return super().C(frequency)


class SealElement(BearingElement):
    """No bearing, though ROSS derives it from one."""


class SealElement2(BearingElement2):
    """Likewise."""


BearingElement2.__name__, SealElement2.__name__ = "BearingElement", "SealElement"


class Rotor:
    """As in ROSS 3. Shaft elements are lengths, discs (node, diameter, width), point masses (node, mass)."""

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
        self._M, self.K0, self._G, self.C0 = (np.zeros((self.ndof, self.ndof)) for _ in range(4))
        size = 6 * (len(shaft_elements) + 1)
        at = np.add.outer(np.arange(0, size, 6), BENDING).ravel()
        for matrix, beams in zip(
            (self._M, self.K0, self._G), shaft(shaft_elements, DIAMETER, self.disk_elements), strict=True
        ):
            matrix[np.ix_(at, at)] = beams
        self._add_bars()
        torsion = np.arange(5, size, 6)
        self._M[torsion, torsion] = self.K0[torsion, torsion] = 1.0  # which is none of ours
        for node, mass in self.point_mass_elements:
            at = range(self._first(node), self._first(node) + 3)
            self._M[at, at] += mass

    def _add_bars(self):
        """Shaft and discs along z."""
        area = 0.25 * np.pi * DIAMETER**2
        for n, length in enumerate(self.shaft_elements):
            at = np.ix_(*[(6 * n + ALONG, 6 * n + 6 + ALONG)] * 2)
            self._M[at] += RHO * area * length / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
            self.K0[at] += E * area / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
        for node, outer, width in self.disk_elements:
            at = 6 * node + ALONG
            self._M[at, at] += 0.25 * np.pi * RHO * (outer**2 - DIAMETER**2) * width

    def _first(self, node):
        return 6 * min(node, len(self.nodes)) + 3 * max(node - len(self.nodes), 0)

    def _with(self, matrix, name, *at):
        out = matrix.copy()
        for e in self.bearing_elements:
            block = getattr(e, name)(*at)
            ends = [(e.n, 1.0), *([(e.n_link, -1.0)] if e.n_link is not None else [])]
            for a, sign_a in ends:
                for b, sign_b in ends:
                    i, j = self._first(a), self._first(b)
                    out[i : i + 3, j : j + 3] += sign_a * sign_b * block
        return out

    def M(self, frequency=None, speed=None):
        return self._M.copy()

    def K(self, frequency, speed=None):
        return self._with(self.K0, "K", frequency, speed)

    def C(self, frequency, speed=None):
        return self._with(self.C0, "C", frequency, speed)

    def G(self):
        return self._G.copy()

    def run_modal(self, speed, frequency=None):
        return self._modes(speed, self.K(frequency or speed, speed), self.C(frequency or speed, speed))

    def _modes(self, speed, K, C):
        held = np.abs(self._M).sum(axis=1) > 0.0
        at = np.ix_(held, held)
        M, C, K = self._M[at], (C + speed * self._G)[at], K[at]
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


class Rotor2(Rotor):
    """As in ROSS 2."""

    def M(self, frequency=None):
        return self._M.copy()

    def K(self, frequency):
        return self._with(self.K0, "K", frequency)

    def C(self, frequency):
        return self._with(self.C0, "C", frequency)

    def run_modal(self, speed):
        return self._modes(speed, self.K(speed), self.C(speed))


def module(version=3):
    """As `import ross` gives it."""
    if version == 2:
        return SimpleNamespace(BearingElement=BearingElement2, SealElement=SealElement2, Rotor=Rotor2)
    return SimpleNamespace(BearingElement=BearingElement, SealElement=SealElement, Rotor=Rotor)
