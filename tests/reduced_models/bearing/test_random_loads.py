"""Random bearings under random loads: an answer that balances, or one line that says why there is none."""

from collections import Counter
from math import acos, asin, cos, radians

import numpy as np
import pytest
from balls_in_balance import imbalance, races_by_hand, random_bearing, random_load
from scipy.optimize import brentq

from ehlcontact import Lubricant
from ehlcontact.errors import InputError
from reduced_models import BallBearing

# Reasons for which a load is refused. Friction holds the gyroscopic moments under control of the inner race only
# where it presses the balls enough.
REASONS = {
    "not held": "nothing holds it",
    "steep": "60 degrees",
    "other side": "more axial force in",
    "heavy": "a ball carries at most",
    "friction": "friction holds",
    "atlas": "where the atlas ends",
}


def answers(seed, cases, each, oils=(), turning=("inner",)):
    """Count of each answer to `cases` random loads, a new bearing for every `each` of them."""
    rng, found = np.random.default_rng(seed), Counter()
    for k in range(cases):
        if k % each == 0:
            changes = {"turning": turning[k // each % len(turning)]}
            changes |= {"oil": oils[rng.integers(len(oils))]} if oils else {}
            bearing = BallBearing(**random_bearing(rng, **changes))
        _, load, rpm, tilt = random_load(rng, bearing)
        try:
            state = bearing.equilibrium(load, speed_rpm=rpm, tilt=tilt)
        except InputError as error:
            reason = next(name for name, words in REASONS.items() if words in error.allowed)
            assert reason != "friction" or bearing.race_control in ("inner", "shared")
            found[reason] += 1
        else:
            assert imbalance(bearing, state, load) < 1e-7
            found["balanced"] += 1
    return found


@pytest.mark.long
def test_random_loads_of_dry_bearings():
    found = answers(1, 150, 3)
    assert found["balanced"] > 110


@pytest.mark.long
def test_random_loads_with_the_outer_ring_turning():
    found = answers(5, 120, 3, turning=("outer", (1.0, 2.5), (-4.0, 1.0)))
    assert found["balanced"] > 80


@pytest.mark.slow
def test_thousands_of_random_loads():
    """Every answer balances; no search fails."""
    found = answers(2, 4000, 3)
    assert found["balanced"] > 3000
    oils = [Lubricant.iso_vg(vg, temperature=t) for vg in (15, 32, 68, 150) for t in (40.0, 60.0, 90.0)]
    found = answers(3, 300, 10, oils)
    assert found["balanced"] > 240


def test_balls_that_the_inner_ring_has_left_by_far():
    """Narrow inner and wide outer grooves: a ball on the outer race alone is far beside the inner groove."""
    rows = (
        ((23, 12.552e-3, 97.703e-3, 0.508717, 0.52162, "shared", 0.663535), (6.06, -3.47, 6.62), 2148.0),
        ((22, 5.19e-3, 54.103e-3, 0.52147, 0.544005, "inner", 0.696344), (-1.64, 1.36, 0.917), 2905.0),
        ((25, 25.58e-3, 287.648e-3, 0.516766, 0.559712, "harris", 0.646347), (-836.0, -875.0, 18.7), 1545.0),
        ((6, 6.43e-3, 20.169e-3, 0.505366, 0.548828, "outer", 0.622393), (30.6, -634.0, 771.0), 1486.0),
    )
    names = "balls", "ball_diameter", "pitch_diameter", "conformity_inner", "conformity_outer"
    for sizes, load, rpm in rows:
        bearing = BallBearing(**dict(zip((*names, "race_control", "contact_angle"), sizes, strict=True)))
        state = bearing.equilibrium(load, speed_rpm=rpm)
        assert imbalance(bearing, state, load) < 1e-9


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_contact_ellipses_end_at_the_shoulders(race):
    """Axial load at which an ellipse reaches the shoulder, from Hertz and the groove by hand."""
    angle, D, pitch, f = radians(25.0), 7.938e-3, 38.5e-3, 0.52
    sizes = {"balls": 13, "ball_diameter": D, "pitch_diameter": pitch, "contact_angle": angle}
    bottom = 0.5 * pitch + (-0.5 if race == "inner" else 0.5) * D * (2.0 * f * (1.0 - cos(angle)) + cos(angle))
    height = 0.2 * D
    diameter = 2.0 * (bottom + height if race == "inner" else bottom - height)
    bearing = BallBearing(**sizes, **{f"shoulder_{race}": diameter})
    column = 0 if race == "inner" else 1
    across = races_by_hand(bearing)[column][1]

    def reach(force):
        state = BallBearing(**sizes).equilibrium((0.0, 0.0, force))
        edge = asin(across * np.cbrt(state.force[0, column]) / (f * D))
        return float(state.contact_angles[0, column]) + edge - acos(1.0 - height / (f * D))

    most = brentq(reach, 10.0, 20000.0, xtol=1e-9)
    assert bearing.equilibrium((0.0, 0.0, 0.9999 * most)).load[2] == pytest.approx(0.9999 * most)
    with pytest.raises(InputError, match=f"load = .*below the shoulder of the {race} race .*at ball"):
        bearing.equilibrium((0.0, 0.0, 1.0001 * most))
    with pytest.raises(InputError, match=f"shoulder_{race} = .*: must be between .* m, the bottom of the groove"):
        BallBearing(**sizes, **{f"shoulder_{race}": 3.0 * diameter})


def test_preloaded_ring_that_is_held_tilted_without_a_load():
    """Nine balls are not symmetric about the tilt: the ring moves, for there is no load."""
    bearing = BallBearing.catalogue("6205", clearance=-5e-6)
    state = bearing.equilibrium((0.0, 0.0, 0.0), tilt=(2e-3, 1e-3), cage_angle=0.1)
    assert imbalance(bearing, state, (1.0, 0.0, 0.0)) == pytest.approx(1.0, abs=1e-9)  # but for the load of 1 N
    assert np.abs(state.displacement[:3]).max() > 1e-10
    np.testing.assert_array_equal(bearing.equilibrium((0.0, 0.0, 0.0)).displacement, 0.0)


def test_moment_far_below_the_preload():
    sizes = {"balls": 9, "ball_diameter": 6.825e-3, "pitch_diameter": 20.619e-3, "clearance": -1.858e-6}
    bearing = BallBearing(**sizes, conformity_inner=0.548, conformity_outer=0.529)
    load = (0.0, 0.0, 0.0, -5.25e-6, -6.32e-6)
    state = bearing.equilibrium(load, speed_rpm=2238.0)
    assert imbalance(bearing, state, load) < 1e-6


def test_loads_at_which_rounding_shows():
    """An approach of 5e-14 m beside groove centres 0.3 mm apart."""
    bearing = BallBearing(balls=13, ball_diameter=7.938e-3, pitch_diameter=38.5e-3, contact_angle=radians(25.0))
    state = bearing.equilibrium((0.0, 0.0, 1e-9))
    assert imbalance(bearing, state, (0.0, 0.0, 1e-9)) < 1e-4
