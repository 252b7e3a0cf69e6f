"""Results in the units of their point: SI at an `OperatingPoint`, Moes units at its `MoesPoint`, and described."""

from dataclasses import astuple, fields, is_dataclass, replace
from inspect import getdoc
from math import pi

import numpy as np
import pytest

from ehlcontact import (
    FreeVibration,
    Grid,
    HarmonicLoad,
    InputError,
    KeepSettings,
    TimeSteps,
    TransientContact,
    simulate,
    solve_steady,
)
from ehlcontact.film import film_of
from ehlcontact.film.over_time import FilmHistory, film_history, film_wave, track_wave
from ehlcontact.film.plane import Constriction, Film, Profile
from ehlcontact.lubricant import Lubricant
from ehlcontact.point import Geometry, OperatingPoint
from ehlcontact.quantities import quantities_of
from ehlcontact.results import SteadyResult
from ehlcontact.transient.result import SimulationResult

POINT = OperatingPoint(Geometry(0.004, 0.01), Lubricant(0.08, 1.9e-8), 3.0, 1.3)
OTHER = replace(POINT, load=4.0)
S = POINT.scales
MOTION = HarmonicLoad.at(POINT, hz=2000.0, mass=0.05)
UNITS = {
    **dict.fromkeys(("t", "snapshot_t"), S.time),
    "x": S.a,
    "y": S.b,
    **dict.fromkeys(("p", "p_max", "pressure_error", "pressure_changes", "p_midplane", "snapshot_p"), S.pressure),
    **dict.fromkeys(("h", "h_midplane", "snapshot_h", "approach", "h_central", "h_min"), S.length),
    **dict.fromkeys(("static_approach", "approach_changes"), S.length),
    **dict.fromkeys(("force", "load", "static_load"), S.force),
    "moment": S.force * S.a,
    "rate": S.length / S.time,
    "acceleration": S.length / S.time**2,
    "omega": 1.0 / S.time,
    "mass": S.force / S.length * S.time**2,
}


def run_at(point):
    unit = point.scales.time
    return simulate(
        point,
        MOTION,
        grid=Grid(n=32),
        time=TimeSteps(until=0.3 * unit, dt=0.1 * unit),
        keep=KeepSettings(snapshots=(0.1 * unit,)),
    )


@pytest.fixture(scope="module")
def films():
    return [solve_steady(point, grid=Grid(n=32)) for point in (POINT, POINT.moes)]


@pytest.fixture(scope="module")
def runs():
    return [run_at(point) for point in (POINT, POINT.moes)]


def test_every_field_in_its_unit(films, runs):
    """Values in SI are those of the dimensionless point times their units, and back."""
    for si, moes in (films, runs):
        assert si.point is POINT and moes.point == POINT.moes and moes.dimensionless is moes
        again = si.dimensionless
        assert type(again) is type(si) and again.point == POINT.moes
        for name, quantity in quantities_of(type(si)).items():
            if name == "hz" or (value := getattr(moes, name)) is None:
                continue
            unit = UNITS[name] if quantity.scale else 1.0
            np.testing.assert_allclose(getattr(si, name), np.asarray(value) * unit, rtol=1e-14)
            np.testing.assert_allclose(getattr(again, name), value, rtol=1e-14)
            assert not isinstance(value, np.ndarray) or not getattr(si, name).flags.writeable
        np.testing.assert_equal(moes.in_units_of(POINT).to_dict() | {"seconds": 0}, si.to_dict() | {"seconds": 0})
    estimates = [film.error_estimate for film in films] + [run.film_error for run in runs]
    for si, moes in (estimates[:2], estimates[2:]):
        assert si.approach == moes.approach * S.length
        assert astuple(si)[1:] == astuple(moes)[1:]  # over the films


def test_motion_in_si(runs):
    run, moes = runs
    assert (run.hz, run.omega, run.mass) == pytest.approx((2000.0, 4000.0 * pi, 0.05))
    assert run.static_load == POINT.load and moes.static_load == 1.0
    assert moes.mass == pytest.approx(MOTION.Omega_n**-2)
    # Newton's law: what the film does not carry accelerates the mass
    for one in runs:
        np.testing.assert_allclose(
            one.mass * one.acceleration[1:], (one.load - one.force)[1:], atol=1e-3 * one.static_load
        )
    with pytest.raises(InputError, match=r"^hz = 'asked for': must be omega at a dimensionless point"):
        _ = moes.hz
    free = simulate(
        POINT, FreeVibration(Omega_n=5.0), grid=Grid(n=16), time=TimeSteps(until=0.2 * S.time, dt=0.1 * S.time)
    )
    assert free.hz is None and free.omega is None


def test_views_have_the_units_of_their_result(films, runs):
    """Films, profiles, the horseshoe, histories and waves."""
    for of in (film_of, lambda f: film_of(f).across, lambda f: film_of(f).constriction):
        si, moes = (of(film) for film in films)
        for name in quantities_of(type(si)):
            wanted = np.asarray(getattr(moes.in_units_of(POINT), name))
            np.testing.assert_allclose(getattr(si, name), wanted, rtol=1e-12, atol=1e-12 * abs(wanted).max())
    for of in (film_history, film_wave, lambda run: run.at(run.t[1:3])):
        si, moes = (of(run) for run in runs)
        for name in quantities_of(type(si)):
            np.testing.assert_allclose(getattr(si.dimensionless, name), getattr(moes, name), rtol=1e-9, atol=1e-12)
    with pytest.raises(InputError, match="wave"):
        track_wave(film_wave(runs[0]))  # too short, in either unit


def test_units_of_another_point(films):
    with pytest.raises(InputError, match=r"^point = 'M [\d.]+, L [\d.]+, kappa .*': must be that of the result"):
        films[1].in_units_of(OTHER)


def test_prescribed_approach_in_units_of_the_point(films):
    for film in films:
        again = solve_steady(film.point, grid=Grid(n=32), approach=film.approach)
        assert again.force == pytest.approx(film.force, rel=1e-5)


def test_tables_have_the_units_of_the_point(films):
    assert "N" in repr(films[0]) and "dry approach" in repr(films[1])
    pytest.importorskip("pandas")
    si, moes = (film.to_pandas() for film in films)
    assert list(si.columns) == ["p [Pa]", "h [m]"] and list(moes.columns) == ["p [p_h]", "h [delta_H]"]
    assert si.attrs["units"] == "SI" and moes.attrs["units"] == "Moes" and si.attrs["load"] == POINT.load


def test_full_contact_in_the_units_of_its_point():
    """Steps too: they are those of the dimensionless contact but for rounding of their inputs."""
    si, moes = (TransientContact(point, grid=Grid(n=32)) for point in (POINT, POINT.moes))
    units = dict.fromkeys(("static_approach", "h_central", "h_min"), S.length) | {"force": S.force}
    assert si.force == pytest.approx(POINT.load, rel=1e-5)  # a film at rest, solved to 1e-5 of its pressure
    assert (si.units, moes.units) == ("SI", "dimensionless")
    assert si.film_error.approach == moes.film_error.approach * S.length
    assert si.film_error.h_min_relative == moes.film_error.h_min_relative
    assert "µm" in repr(si) and "µm" not in repr(moes)
    for moved in (0.0, 0.02, -0.01):
        for name, unit in units.items():
            assert getattr(si, name) == pytest.approx(getattr(moes, name) * unit, rel=1e-9, abs=0.0), name
        u = moes.static_approach + moved
        force = si.advance(0.1 * S.time, u * S.length, 0.0)
        assert force == pytest.approx(moes.advance(0.1, u) * S.force, rel=1e-9)


@pytest.mark.parametrize("cls", [SteadyResult, SimulationResult, Film, Profile, Constriction, FilmHistory])
def test_every_quantity_is_described(cls):
    """Names in the docstring: under Attributes, as numpydoc has it."""
    text = getdoc(cls).split("Attributes\n", 1)[1]
    heads = [line.partition(" : ")[0] for line in text.splitlines() if line and line[0] != " "]
    named = {name.strip() for head in heads for name in head.split(",")}
    wanted = {f.name for f in fields(cls)} if is_dataclass(cls) else set(quantities_of(cls))
    assert wanted <= named
