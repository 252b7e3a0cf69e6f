"""Capacitance as an output of FMUs: bearings alone, in sets and in rotors, beside Python."""

from dataclasses import replace

import numpy as np
import pytest
from bearing_fmus import MODELS, OIL, RPM, Exported, ExportedBearing, inputs

from ehlcontact import InputError
from fmu import export
from fmu.bearing.capacitance_table import CapacitanceTable
from fmu.bearing.model import BearingModel
from fmu.bearing.tables import film_logarithms
from fmu.bearing.trial import START, bearing_trial
from reduced_models import BallBearing, BearingSet, Disc, Shaft, Support, rotor_on_bearings, simulate_rotor
from reduced_models.bearing.capacitance import contact_capacitance
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.rotor.capacitance_run import capacitance_of_run

OIL_PERMITTIVITY = 2.3
SPINDLE = BallBearing.catalogue("7205", oil=OIL)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """``made("five")``: exported once, with the capacitance."""
    known = {}

    def make(name):
        if name not in known:
            model = replace(MODELS[name](), permittivity=OIL_PERMITTIVITY)
            path = tmp_path_factory.mktemp("bearing") / "x.fmu"
            given = {"speeds_rpm": model.speeds_rpm, "load": model.load, "directions": model.directions}
            export(model.bearing, path, **given, permittivity=OIL_PERMITTIVITY)
            known[name] = ExportedBearing(path, model)
        return known[name]

    return make


def contacts(slave, model, name):
    """Of all contacts, shape (balls, 2)."""
    names = (f"ball[{k + 1}].{name}_{race}" for k in range(model.bearing.balls) for race in RACES)
    return np.array(slave.get(*names)).reshape(-1, 2)


def in_series(contact):
    return float((1.0 / (1.0 / contact).sum(axis=1)).sum())


@pytest.mark.long
@pytest.mark.parametrize("name", ["five", "range"])
def test_it_is_that_of_the_films_in_every_step(made, name):
    """Of the polynomial to rounding, of the integrals to 3e-5, where all balls carry what the atlas has."""
    one = made(name)
    trial = bearing_trial(one.model, steps=60, dt=16e-6)
    lightest = np.exp(film_logarithms(one.model)[0][:, 0])
    tables = [CapacitanceTable.of(one.model, race) for race in (0, 1)]
    slave, compared = one.started(**inputs(one.model, trial, 0)), 0
    for k in range(1, trial.time.size):
        slave.set(**inputs(one.model, trial, k))
        slave.step_to(float(trial.time[k]))
        load, film = contacts(slave, one.model, "load"), contacts(slave, one.model, "film")
        angle = contacts(slave, one.model, "contact_angle") if one.model.angular else np.zeros_like(load)
        if np.all(load > lightest):
            values = [tables[race].at(load[:, race], film[:, race], np.cos(angle[:, race])) for race in (0, 1)]
            (found,) = slave.get("capacitance")
            assert found == pytest.approx(in_series(np.column_stack(values)), rel=1e-10, abs=0.0)
            own = one.model.bearing.tables.internals
            exact = contact_capacitance(own, load, film, angle, OIL_PERMITTIVITY, OIL_PERMITTIVITY).total
            assert found == pytest.approx(in_series(exact), rel=3e-5, abs=0.0)
            compared += 1
    slave.free()
    assert compared > 4


@pytest.mark.long
def test_at_rest_it_is_that_of_the_bearing(made):
    """With balls that part from the inner race."""
    one = made("planar")
    state = one.model.bearing.equilibrium((0.0, -500.0), speed_rpm=RPM, cage_angle=START)
    assert (state.approach[:, 0] < -1e-6).any()
    slave = one.started(x=one.model.place[0], y=one.model.place[1], speed=RPM * RPM_TO_RAD_S)
    assert slave.get("capacitance")[0] == pytest.approx(
        state.capacitance(OIL_PERMITTIVITY).total, rel=1e-3, abs=0.0
    )
    slave.free()
    dry = one.started(x=one.model.place[0], y=one.model.place[1], speed=RPM * RPM_TO_RAD_S, film=0.0)
    assert dry.get("capacitance")[0] == 0.0
    dry.free()


@pytest.mark.long
def test_partial_derivatives(made):
    one = made("five")
    place = dict(zip(one.model.directions, one.model.place.tolist(), strict=True))
    model = one.exchange(**place, speed=RPM * RPM_TO_RAD_S)
    for known, step in (("y", 1e-9), ("z", 1e-9), ("speed", 1e-3)):
        start = model.get(known)[0]
        ends = []
        for sign in (1.0, -1.0):
            model.set(**{known: start + sign * step})
            ends.append(model.get("capacitance")[0])
        model.set(**{known: start})
        model.get("capacitance")
        assert model.gradient("capacitance", known) == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-4)
    model.free()


@pytest.mark.long
def test_of_a_set_each_bearing_has_one(tmp_path):
    bearings = BearingSet(
        bearings=(SPINDLE, BallBearing.catalogue("7205")), facings=("+z", "-z"), positions=(-0.03, 0.03)
    ).preloaded(300.0)
    path = tmp_path / "pair.fmu"
    export(bearings, path, speeds_rpm=8000.0, permittivity=2.2)
    one = Exported(path)
    names = {variable.name for variable in one.description.modelVariables}
    assert "bearing[1].capacitance" in names and "bearing[2].capacitance" not in names
    slave = one.started(lead=0.0)
    state = bearings.equilibrium(np.zeros(5), speed_rpm=8000.0).bearings[0]
    assert slave.get("bearing[1].capacitance")[0] == pytest.approx(state.capacitance().total, rel=0.02)
    slave.free()


@pytest.mark.long
def test_in_a_rotor_it_is_that_of_the_run(tmp_path):
    """Beside `capacitance_of_run`, whose films have no memory: that matters little in a slow whirl."""
    bearing = BallBearing.catalogue("6205", oil=OIL, clearance=10e-6)
    disc = Disc.cylinder(position=0.1, diameter=0.15, width=0.2, bore=0.025, unbalance=1e-4)
    supports = [Support(position=place, bearing=bearing) for place in (0.02, 0.18)]
    rotor = rotor_on_bearings(Shaft(length=0.2, diameter=0.025), discs=[disc], supports=supports)
    run = simulate_rotor(rotor, speed_rpm=RPM, dt=2e-5, until=2e-3)
    there = capacitance_of_run(rotor, run, 0, 2.2, every=20)
    path = tmp_path / "rotor.fmu"
    export(rotor, path, speeds_rpm=RPM, permittivity=2.2)
    slave = Exported(path).started(speed=RPM * RPM_TO_RAD_S, inner_step=2e-5)
    found = [slave.get("bearing[1].capacitance")[0]]
    for time in there.t[1:].tolist():
        slave.step_to(time)
        found.append(slave.get("bearing[1].capacitance")[0])
    slave.free()
    assert found == pytest.approx(there.capacitance, rel=2e-3, abs=0.0)


def test_refused():
    bearing = BallBearing.catalogue("6205", oil=OIL)
    with pytest.raises(InputError, match="between 1 and 100"):
        BearingModel(bearing, RPM, 500.0, permittivity=0.5)
    with pytest.raises(InputError, match="dry bearing"):
        BearingModel(bearing.dry, RPM, 500.0, permittivity=2.2)
