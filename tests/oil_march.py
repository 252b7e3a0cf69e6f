"""A film under steps at given speeds, and what is lost of oil and of energy on the way."""

import numpy as np

from ehlcontact.solver.balance import Balance
from ehlcontact.transient.features import surface_height, surface_step


def march(film, U, dT, layer=None, surface=None):
    """Largest loss of oil over the flow at U = 1, and of energy, in a step; the film starts steady at ``U[0]``.

    A `surface` is carried at a constant speed.

    The loss of oil is what enters under the layer less what leaves and what is stored by the rule of the step.
    """
    film.set_speed(U[0])
    film.keeps_oil = bool(min(U) < 0.0)
    level, way = film.level, 0.0
    height = surface_height(surface, level.X, level.Y, 0.0)
    assert film.start_steady(Balance.of_load(), surface=height).status.ok
    lines = np.r_[0.5, np.ones(level.ny - 1), 0.0]
    oil, loss, energy = [lines @ level.oil[:, 1:-1].sum(axis=1) * level.hx] * 2, 0.0, 0.0
    for k, speed in enumerate(U[1:]):
        film.set_speed(speed)
        way += dT * speed
        feature = surface_step(surface, level.X, level.Y, way, dT * speed, film.last_step * speed)
        assert film.advance(dT, Balance.of_load(), film.u, feature).status.ok
        oil.append(lines @ level.oil[:, 1:-1].sum(axis=1) * level.hx)
        change = oil[-1] - oil[-2] if k == 0 else 1.5 * oil[-1] - 2.0 * oil[-2] + 0.5 * oil[-3]
        if layer is not None:
            entered, left = (float(lines @ level.carried[:, i]) * level.speed for i in (0, -2))
            loss = max(loss, abs(entered - left - change / dT) / (layer * lines.sum()))
        energy = max([energy, *(effect.columns().get("heat_balance", 0.0) for effect in film.effects)])
    return loss, energy
