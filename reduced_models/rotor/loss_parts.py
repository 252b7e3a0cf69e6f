"""Parts of a linear rotor that take energy from a vibration, by name: what each takes, and the rotor without it.

Of a motion q exp(s t) with D(s) q = 0 the imaginary part of q^H D(s) q is zero:

    2 sigma w m + sigma g + sum of z_p = 0,    z_p = Im(q^H Z_p(s) q),    s = sigma + i w

with m = q^H M q (and of balls with inertia) and i g = q^H (omega G) q of gyroscopic forces, which do no work.
So every part has its share of sigma, exactly, however large the damping and whatever the memory of a film. |s|^2/w
times z_p is twice the mean power that the part turns into heat: z_p of springs and dashpots in any network is the
sum over its dashpots of w c |stretch|^2. A dashpot has z = w q^H C q, with the symmetric part of C; stiffness has
none, unless it is cross-coupled: then it feeds whirl of one sense and damps that of the other.

Without its loss a part keeps the stiffness K of Z = K + s C, K and C real.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.linear_contact import WithoutLoss
from reduced_models.rotor.rotor import SKEW, Rotor
from reduced_models.rotor.supports import bearing_names

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]
Named = Sequence[tuple[str, Any]]  # supports about equilibrium with their names

CROSS_COUPLED = "cross-coupled stiffness"
NONE = frozenset[str]()


def matrix_losses(rotor: Rotor, omega: float) -> dict[str, tuple[_Floats, _Floats]]:
    """Symmetric damping and skew stiffness, shape (N, N), by name: of the rotor itself and of linear bearings."""
    none = np.zeros_like(rotor.mass)
    found = {name: (0.5 * (part + part.T), none) for name, part in rotor.damping_parts.items()}
    found[CROSS_COUPLED] = none, _skew(rotor.stiffness)
    for mount, name in zip(rotor.bearings, bearing_names(rotor.bearings), strict=True):
        if isinstance(mount.bearing, LinearBearing):
            rows = mount.rows(rotor.size)
            K, C = (rows.T @ part @ rows for part in mount.bearing.at(omega / RPM_TO_RAD_S))
            found[name] = 0.5 * (C + C.T), none
            found[f"{name}, {CROSS_COUPLED}"] = none, _skew(K)
    return {name: parts for name, parts in found.items() if any(part.any() for part in parts)}


def _skew(K: _Floats) -> _Floats:
    """Skew part of a stiffness; 0 where it is rounding."""
    skew = 0.5 * (K - K.T)
    return skew if np.abs(skew).max() > SKEW * np.abs(K).max() else np.zeros_like(K)


def support_losses(supports: Named) -> tuple[str, ...]:
    """Names of what takes energy in supports: of a ball bearing its films, and rings and fits; else all of it."""
    names: list[str] = []
    for name, support in supports:
        if isinstance(support, LinearBalls):
            names += [f"{name}, {part}" for part in support.losses]
        elif not isinstance(support, WithoutLoss):
            names.append(name)
    return tuple(names)


def taken_by_supports(supports: Named, rows: _Floats, s: complex, q: _Complex) -> tuple[dict[str, float], float]:
    """Im(q^H Z q) by name, and the inertia q^H m q of balls; `rows` has the motions of all supports from q."""
    found, mass, first = dict[str, float](), 0.0, 0
    for name, support in supports:
        Z = support.impedance(s)
        u, first = rows[first : first + len(Z)] @ q, first + len(Z)
        if isinstance(support, LinearBalls):
            taken = support.taken(s, u)
            found |= {f"{name}, {part}": value for part, value in taken.by.items()}
            mass += taken.mass
        elif not isinstance(support, WithoutLoss):
            found[name] = float(np.imag(u.conj() @ Z @ u))
    return found, mass


def without_losses(supports: Named, left_out: Iterable[str]) -> list[Any]:
    """The supports without what takes energy by these names."""
    names, found = set(left_out), list[Any]()
    for name, support in supports:
        if isinstance(support, LinearBalls):
            own = {part for part in support.losses if f"{name}, {part}" in names}
            found.append(replace(support, lossless=support.lossless | own) if own else support)
        else:
            found.append(WithoutLoss(support) if name in names else support)
    return found


def require_parts(names: Sequence[str], known: Sequence[str]) -> None:
    """Raise `InputError` for what is no part that takes energy."""
    for name in names:
        if name not in known:
            allowed = f"one of {', '.join(map(repr, known))}" if known else "none: nothing takes energy"
            raise InputError("parts", name, allowed)
