"""Elements whose force follows from approach and rate alone: spring beside damper."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import require_positive
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models.elements.base import ContactElement

_Floats = NDArray[np.float64]


class MemorylessContact(ContactElement):
    """Force ``max(0, spring(u) + damper(u, u'))``, exact tangents, no state.

    On [low, high] spring and damper are the fitted ones; outside they go on as `ends` says. A
    subclass gives the three numbers at a point, at arrays, and its spring.
    """

    @abstractmethod
    def _at(self, approach: float, rate: float) -> tuple[float, float, float]:
        """Force, dF/du and dF/du' at one point: the inner loop of every integrator."""

    @abstractmethod
    def _values(self, approach: ArrayLike, rate: ArrayLike) -> _Floats:
        """The same for arrays that broadcast, stacked on axis 0."""

    @abstractmethod
    def _springs(self, approach: ArrayLike) -> _Floats:
        """Spring force and damping coefficient at zero rate, stacked on axis 0."""

    @abstractmethod
    def _static_approach(self, force: float) -> float:
        """Approach at which the spring carries `force` > 0."""

    @abstractmethod
    def _si_factors(self, scales: Scales) -> dict[str, float]:
        """SI value of the unit of every coefficient."""

    def _si_coefficients(self, scales: Scales) -> dict[str, Any]:
        factor = self._si_factors(scales)
        return {name: value * factor[name] for name, value in self.parameters.items()}

    @overload
    def force(self, approach: float, rate: float) -> float: ...
    @overload
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def force(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Contact force, never negative; scalars or arrays that broadcast."""
        return self._value(0, approach, rate)

    @overload
    def stiffness(self, approach: float, rate: float) -> float: ...
    @overload
    def stiffness(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def stiffness(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Exact tangent dF/du; zero where the force is clipped."""
        return self._value(1, approach, rate)

    @overload
    def damping(self, approach: float, rate: float) -> float: ...
    @overload
    def damping(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats: ...
    def damping(self, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        """Exact tangent dF/du'; zero where the force is clipped."""
        return self._value(2, approach, rate)

    def spring(self, approach: ArrayLike) -> float | _Floats:
        """Force at zero rate."""
        value = self._springs(approach)[0]
        return value if value.ndim else float(value)

    def spring_tangent(self, approach: float) -> float:
        """Slope of the force at zero rate."""
        return self._at(float(approach), 0.0)[1]

    def damper(self, approach: ArrayLike) -> float | _Floats:
        """Damping coefficient c(u) at zero rate, before the force is clipped."""
        value = self._springs(approach)[1]
        return value if value.ndim else float(value)

    def approach_at(self, force: float) -> float:
        """Static approach under `force` > 0.

        Raises
        ------
        InputError
            Force not finite and > 0.
        """
        return self._static_approach(require_positive("force", force))

    def rate_at(self, approach: float, force: float) -> float:
        """Rate at which the contact carries `force` > 0 at this approach: the motion without inertia.

        Raises
        ------
        InputError
            No damper acts there.
        """
        spring, damping = (float(part) for part in self._springs(approach))
        if damping <= 0.0:
            raise InputError(f"damping at approach {approach:g}", damping, "> 0 for a motion without inertia")
        return (force - spring) / damping

    @property
    def state_count(self) -> int:
        """No states."""
        return 0

    def state_rates(self, states: _Floats, approach: float, rate: float) -> tuple[float, _Floats]:
        """Force, and the rates of no states."""
        return self.force(float(approach), float(rate)), states

    def rate_under(self, states: _Floats, approach: float, force: float) -> float:
        """As `rate_at`, whatever the states."""
        return self.rate_at(approach, force)

    def advance(self, dt: float, approach: float, rate: float) -> float:
        """Force at the end of a step; `dt` is ignored, for the element has no memory."""
        approach, rate = float(approach), float(rate)
        low, high, fastest = self._box
        if not (low <= approach <= high and -fastest <= rate <= fastest):
            self.warn_outside(approach, rate)
        return self._at(approach, rate)[0]

    def step_tangents(self, dt: float, approach: float, rate: float) -> tuple[float, float, float]:
        """Force, dF/du and dF/du' at the end of a step; `dt` is ignored."""
        return self._at(float(approach), float(rate))

    def rest(self, approach: float) -> float:
        """Force at rest; there is no state to set."""
        return self._at(float(approach), 0.0)[0]

    def save_state(self) -> object:
        """Nothing to save."""
        return None

    def restore_state(self, state: object) -> None:
        """Nothing to restore."""

    def to_control(self, name: str = "contact") -> Any:
        """Static python-control system with inputs u, v and output F.

        ``control.linearize`` differentiates with an absolute step of 1e-6 by default: give it 1e-9 m for an
        element in SI, or use `stiffness` and `damping`, which are exact.
        """
        import control

        def output(t: float, x: _Floats, inputs: _Floats, params: object) -> _Floats:
            return np.array([self.advance(0.0, inputs[0], inputs[1])])

        return control.nlsys(None, output, inputs=["u", "v"], outputs=["F"], name=name)

    def _value(self, index: int, approach: ArrayLike, rate: ArrayLike) -> float | _Floats:
        if isinstance(approach, float) and isinstance(rate, float):
            return self._at(approach, rate)[index]
        value = self._values(approach, rate)[index]
        return value if value.ndim else float(value)
