"""Energy of parts in a period: dashpots by hand, what unbalances put in, shares of small vibrations."""

import numpy as np
import passage_rotor
import pytest

from ehlcontact import InputError, Lubricant, read, save
from ehlcontact.status import Status
from reduced_models import (
    BallBearing,
    BearingMount,
    Disc,
    LinearBearing,
    Rotor,
    Shaft,
    SqueezeFilmDamper,
    Support,
    Unbalance,
    linearise,
    rotor_on_bearings,
    unbalance_response,
)
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.energy_budget import energy_budget
from reduced_models.periodic_motion.periodic import periodic_answer
from reduced_models.rotor.result import RotorResult


def put_in(rotor, answer):
    """Work of all unbalances in a period [J]."""
    turning = np.exp(1j * answer.speed * answer.run.t[1:])[:, None] * answer.speed**2 * rotor.turning_unbalance
    return float((turning.real * answer.run.velocity[1:]).sum()) * answer.period / turning.shape[0]


def mass(damping=((0.0, 0.0), (0.0, 0.0)), **more):
    """On a spring with a dashpot, and a damper to the ground."""
    bearing = LinearBearing(stiffness=1e6 * np.eye(2) + np.array(damping), damping=120.0 * np.eye(2))
    return Rotor(
        mass=2.0 * np.eye(2),
        stiffness=np.zeros((2, 2)),
        damping=30.0 * np.eye(2),
        mounts=(BearingMount(bearing=bearing, x=0, y=1),),
        unbalances=(Unbalance(x=0, y=1, amount=1e-5),),
        **more,
    )


def circling(rotor, speed):
    """The answer of a linear rotor to its unbalance, 64 samples of a turn."""
    q = unbalance_response(rotor, [speed]).amplitude[0]
    omega = speed * np.pi / 30.0
    t = np.linspace(0.0, 2.0 * np.pi / omega, 65)
    turned = np.exp(1j * omega * t)[:, None] * q
    none = np.zeros((t.size, 2))
    run = RotorResult(
        t=t, speed_rpm=np.full(t.size, speed), displacement=turned.real, velocity=(1j * omega * turned).real,
        approach=none, rate=none, force=none, iterations=np.zeros(t.size, np.int64), largest_load=np.zeros((0, 2)),
        status=Status.CONVERGED, columns=("bearing 0 x", "bearing 0 y"),
    )  # fmt: skip
    return PeriodicAnswer(run=run, excitation="unbalance", value=speed, residual=0.0)


def motor(oil, loss_factor):
    bearing = BallBearing.catalogue("6305", oil=oil, clearance=2e-6, loss_factor=loss_factor)
    return rotor_on_bearings(
        Shaft(length=0.2, diameter=0.025, elements=2, damping_time=1e-6),
        supports=[Support(position=0.0, bearing=bearing), Support(position=0.2, bearing=bearing)],
        discs=[Disc(position=0.1, mass=6.0, unbalance=1e-6, damping=20.0)],
    )


def test_dashpots_by_hand(tmp_path):
    """Pi c w |q|^2 in each of both directions; cross-coupled stiffness of a forward orbit puts in 2 pi k |q|^2."""
    rotor = mass(damping=((0.0, 5e3), (-5e3, 0.0)))
    answer = circling(rotor, 6000.0)
    found, size = energy_budget(rotor, answer), np.abs(answer.harmonics[1, 0]) ** 2
    assert found.parts == ("rotor", "bearing 0", "bearing 0, cross-coupled stiffness")
    by_hand = 2.0 * np.pi * size * np.array([30.0 * answer.omega, 120.0 * answer.omega, -5e3])
    np.testing.assert_allclose(found.work[:, 0], by_hand, rtol=1e-9)
    assert found.work.sum() == pytest.approx(put_in(rotor, answer), rel=1e-7)
    np.testing.assert_allclose(found.power[:, 0], by_hand * 100.0, rtol=1e-9)
    again = read(save(found, tmp_path / "energy.h5"))
    np.testing.assert_array_equal(again.work, found.work)
    assert "speed 6000: " in str(found) and found.to_dict()["parts"][0] == "rotor"
    stack = found.picture().panels[0].lines
    assert min(line.base[0] + line.y[0] for line in stack) < 0.0


def test_answers_of_a_branch_have_a_column_each():
    rotor = mass()
    several = [circling(rotor, speed) for speed in (3000.0, 6000.0)]
    found = energy_budget(rotor, several)
    assert found.work.shape == (2, 2) and found.value.tolist() == [3000.0, 6000.0]
    np.testing.assert_allclose(found.share[1] / found.share[0], 4.0, rtol=1e-9)
    with pytest.raises(InputError, match=r"^answers = '0 entries'"):
        energy_budget(rotor, [])
    with pytest.raises(InputError, match="must be of the rotor, which has 4"):
        energy_budget(Rotor(mass=np.eye(4), stiffness=np.eye(4), mounts=rotor.mounts), several)


@pytest.mark.long
@pytest.mark.parametrize("loss_factor", [0.0, 0.02])
def test_what_unbalance_puts_in_is_what_parts_take(oil, loss_factor):
    """Of a motor with films; a small unbalance has the shares of small vibrations, but for steps of the films."""
    rotor = motor(oil, loss_factor)
    answer = periodic_answer(rotor, 9000.0)
    found = energy_budget(rotor, answer)
    assert found.work.sum() == pytest.approx(put_in(rotor, answer), rel=1e-6)
    assert found.parts[:2] == (
        "bearing 0, films",
        "bearing 0, rings and fits" if loss_factor else "bearing 1, films",
    )
    linear = linearise(rotor, 9000.0)
    taken, _ = linear.taken(1j * answer.omega, answer.harmonics[1])
    films = np.pi * sum(value for part, value in taken.items() if "films" in part)
    assert found.work[["films" in part for part in found.parts], 0].sum() == pytest.approx(films, rel=0.05)
    if loss_factor:
        rings = np.pi * sum(value for part, value in taken.items() if "rings" in part)
        assert found.work[["rings" in part for part in found.parts], 0].sum() == pytest.approx(rings, rel=0.02)


def test_balls_that_pass_put_in_what_a_damper_takes():
    """A dry bearing loses nothing: its balls, which the shaft drives, shake the rotor."""
    rotor = passage_rotor.rotor()
    answer = periodic_answer(rotor, passage_rotor.speed_rpm(400.0), excitation="passage")
    found = energy_budget(rotor, answer)
    assert found.parts == ("bearing 0, films", "rotor")
    given, taken = found.work[:, 0]
    assert taken > 0.0 and given == pytest.approx(-taken, rel=1e-6)


@pytest.mark.long
def test_a_damper_that_cavitates_takes_its_share():
    """Film of a damper, housing, rings and films of one support: together what the unbalance puts in."""
    oil = Lubricant.iso_vg(68, temperature=50.0)
    held = BallBearing.catalogue("6205", oil=oil, loss_factor=0.01)
    film = SqueezeFilmDamper(length=0.015, diameter=0.08, clearance=1e-4, viscosity=oil)
    more = {"housing_mass": 2.0, "housing_stiffness": 8e7, "housing_damping": 500.0, "damper": film}
    rotor = rotor_on_bearings(
        Shaft(length=0.3, diameter=0.025, elements=2),
        discs=[Disc.cylinder(position=0.3, diameter=0.2, width=0.03, bore=0.025, unbalance=2e-5)],
        supports=[Support(position=0.02, bearing=held), Support(position=0.17, bearing=held, **more)],
    )
    answer = periodic_answer(rotor, 3500.0)
    found = energy_budget(rotor, answer)
    assert found.parts[-2:] == ("damper 1", "housing 1") and np.all(found.work > 0.0)
    assert found.work.sum() == pytest.approx(put_in(rotor, answer), rel=1e-6)
    assert found.kinds["damper 1"][0] > 0.5
