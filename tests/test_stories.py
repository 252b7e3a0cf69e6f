"""What results and elements say of themselves: five short lines without an array, of what they hold."""

import inspect
import re
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

import ehlcontact
import fmu
import reduced_models
from ehlcontact import (
    HarmonicLoad,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    film_of,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.results.story import Told, span
from reduced_models import (
    Atlas,
    BallBearing,
    BearingMount,
    ContactRecord,
    MatrixRotor,
    Unbalance,
    campbell,
    fit,
    linearise,
    simulate_on_bearings,
    simulate_oscillator,
    unbalance_response,
)

# What a user gives, or a few numbers: shown as they are.
SHOWN = (
    "LinearRotor", "MatrixRotor", "PrescribedApproach", "PrescribedLoad", "RotorMode", "RotorState", "Roughness",
    "SpeedCourse", "WhirlMode",
)  # fmt: skip


@pytest.fixture(scope="module")
def point():
    oil = Lubricant.iso_vg(68, temperature=60.0)
    sizes = {"ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3, "conformity": 0.52}
    return OperatingPoint.ball_bearing(oil, **sizes, speed_rpm=3000.0, load=49.0)


@pytest.fixture(scope="module")
def told(point):
    """One of everything."""
    moes, motion = MoesPoint(20, 5, 0.5), HarmonicLoad(Omega=3.0)
    film = solve_steady(point, n=32)
    run = simulate(point, motion, n=16, until=1.0, dT=0.1, throw=False)
    record, atlas = ContactRecord.from_result(run), Atlas()
    oil = point.lubricant
    bearing = BallBearing.catalogue("6205", oil=oil, rq_race=1e-7)
    down, element = (0.0, -500.0), atlas.element(MoesPoint(200, 10, 0.5), "memory")
    rotor = MatrixRotor(
        mass=5.0 * np.eye(2),
        stiffness=np.zeros((2, 2)),
        load=np.array([0.0, -500.0]),
        mounts=(BearingMount(bearing=bearing, x=0, y=1),),
        unbalances=(Unbalance(x=0, y=1, amount=1e-6),),
    )
    speeds, response = [2000.0, 4000.0], impedance(point, hz=[50.0, 100.0], n=32)
    return [
        film, film.si, film_of(film), solve_steady(moes, n=16, throw=False), run, run.si, run.at([0.2, 0.3]),
        record, response, response.si, impedance(moes, Omega=1.0, n=16),
        atlas.at(point), atlas.at(point).si, atlas.at(moes), atlas.at(point).impedance(hz=50.0),
        atlas.over([20.0, 30.0], 5.0, 0.5), element, atlas.element(point), atlas.element(point, "cubic", rpm=3000),
        bearing.equilibrium(down, speed_rpm=3000.0), BallBearing.catalogue("6205").equilibrium(down),
        bearing.coefficients(down, speed_rpm=3000.0, hz=50.0), campbell(rotor, speeds, count=1),
        unbalance_response(rotor, speeds), simulate_on_bearings(rotor, speed_rpm=3000.0, dt=1e-4, until=1e-3),
        simulate_oscillator(element, np.linspace(0.0, 1.0, 5), Omega_n=3.0, u0=0.87),
        fit(record, model="linear"), linearise(rotor, 3000.0),
    ]  # fmt: skip


def test_stories_are_short(told):
    for thing in told:
        lines = repr(thing).splitlines()
        assert 1 <= len(lines) <= 5, repr(thing)
        assert lines[0].startswith(f"{type(thing).__name__}: ")
        assert max(map(len, lines)) <= 118, repr(thing)
        assert "array" not in repr(thing) and "[0." not in repr(thing)
        page = thing._repr_html_()
        assert page.count("<br>") == len(lines) - 1 and "<strong>" in page
        assert re.sub(r"\s+", "", re.sub("<[^>]*>", "", page)) == re.sub(
            r"\s+", "", repr(thing).replace("<", "&lt;")
        )


def test_they_say_what_is_there(point, told):
    film, run = told[0], told[4]
    assert f"{1e6 * film.si.h_central:.4g} (±" in repr(film) and "49 N" in repr(film) and "converged" in repr(film)
    assert "unresolved" in repr(replace(film, status=ehlcontact.Status.UNRESOLVED))
    assert f"force {span(run.si.force, 1.0, 'N')}" in repr(run) and f"{run.steps} steps" in repr(run)
    state = next(thing for thing in told if isinstance(thing, reduced_models.BearingState))
    assert f"heaviest {state.force[state.heaviest, 0]:.4g} N" in repr(state) and "lambda" in repr(state)


def test_every_public_result_of_arrays_is_told():
    """So that a new one that dumps them is seen here."""
    left = []
    for package in (ehlcontact, reduced_models, fmu):
        for name, value in vars(package).items():
            if inspect.isclass(value) and is_dataclass(value) and name not in SHOWN:
                kinds = [str(field.type) for field in fields(value)]
                if any("NDArray" in kind or "Array" in kind or "_Floats" in kind for kind in kinds):
                    left += [] if issubclass(value, Told) else [name]
    assert left == []


def test_span():
    assert span([1.0, 3.0], 2.0, "N") == "2 .. 6 N" and span([2.0, 2.0]) == "2" and span([np.nan]) == "none"


@pytest.mark.parametrize("package", [ehlcontact, reduced_models])
def test_dir_lists_public_names_only(package):
    listed = dir(package)
    rooms = [name for name in listed if inspect.ismodule(getattr(package, name))]
    assert rooms == [] and len(listed) > 40 and "annotations" not in listed
    assert not [name for name in listed if name.startswith("_") and name != "__version__"]
