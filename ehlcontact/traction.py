"""`traction_curve`: traction over the slide-to-roll ratio of a solved contact, isothermal or heated.

With heat one film for each ratio. Shear stress and coefficient of one film: `ehlcontact.results.traction`.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ehlcontact.checks import shown
from ehlcontact.conditions import Conditions
from ehlcontact.errors import InputError
from ehlcontact.heat import Heat
from ehlcontact.lubricant.traction_laws import Eyring, TractionLaw, require_law
from ehlcontact.point import OperatingPoint
from ehlcontact.results.traction import Traction, slide_rolls
from ehlcontact.steady import solve_steady


def traction_curve(
    point: OperatingPoint,
    slide_roll: ArrayLike,
    law: TractionLaw,
    *,
    thermal: Heat | bool | None = None,
    **options: Any,
) -> Traction:
    """Solve the film and its traction over the slide-to-roll ratio.

    Parameters
    ----------
    point : OperatingPoint
    slide_roll : float or array_like, shape (k,)
        Slide-to-roll ratios, 0 to 2.
    law : TractionLaw
        `Eyring`, `Carreau` or `LimitingShear`.
    thermal : Heat, or True for ``Heat()``, optional
        Solve a heated film for each ratio, up to 1, heated by Eyring's stress of the law. By default one
        isothermal film is used for all ratios: without heat, sliding does not change the film here.
    **options
        Of `solve_steady`.

    Raises
    ------
    InputError
        As of `SteadyResult.traction` and `solve_steady`; heat with another law than Eyring's.
    ConvergenceError
        A film did not converge.
    """
    require_law(law)
    ratios = slide_rolls(slide_roll)
    if not isinstance(point, OperatingPoint):
        allowed = "an OperatingPoint: a traction law has stresses in Pa, and a dimensionless point has no units"
        raise InputError("point", shown(point), allowed)
    given = Conditions.of(thermal=thermal).heat
    if given is None:
        return solve_steady(point, **options).traction(ratios, law)
    if not isinstance(law, Eyring):
        raise InputError("law", shown(law), "Eyring with thermal: his stress heats the film")
    heats = [replace(given, slide_roll=ratio, eyring_stress=law.stress) for ratio in ratios.tolist()]
    return _together(
        [solve_steady(point, thermal=heat, **options).traction(heat.slide_roll, law) for heat in heats]
    )


def _together(found: list[Traction]) -> Traction:
    """One curve of tractions at one ratio each; the map and the mesh are those of the last."""
    over = [f.name for f in fields(found[0]) if found[0].over_sliding(f.name)]
    joined: dict[str, Any] = {name: np.concatenate([getattr(one, name) for one in found]) for name in over}
    return replace(found[-1], **joined, seconds=sum(one.seconds for one in found))
