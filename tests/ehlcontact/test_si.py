"""``.si`` of results: each quantity in its unit, and described with unit and shape."""

import copy
from dataclasses import fields, is_dataclass
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
from ehlcontact.film.over_time import FilmHistory
from ehlcontact.film.plane import Film
from ehlcontact.lubricant import Lubricant
from ehlcontact.point import Geometry, OperatingPoint
from ehlcontact.quantities import quantities_of, si_quantities
from ehlcontact.results import SteadyResult
from ehlcontact.transient.result import SimulationResult

POINT = OperatingPoint(Geometry(0.004, 0.01), Lubricant(0.08, 1.9e-8), 3.0, 1.3)
S = POINT.scales
UNITS = {
    "t": ("T", S.time),
    "snapshot_t": ("snapshot_T", S.time),
    "x": ("X", S.a),
    "y": ("Y", S.b),
    "p": ("P", S.pressure),
    "h": ("H", S.length),
    **{name: (name, S.pressure) for name in ("p_max", "pressure_error", "pressure_changes")},
    "p_midplane": ("p_midplane", S.pressure),
    "snapshot_p": ("snapshot_P", S.pressure),
    "h_midplane": ("h_midplane", S.length),
    "snapshot_h": ("snapshot_H", S.length),
    **{
        name: (name, S.length)
        for name in ("approach", "h_central", "h_min", "static_approach", "approach_changes")
    },
    **{name: (name, S.force) for name in ("force", "load")},
    "moment": ("moment", S.force * S.a),
    "rate": ("rate", S.length / S.time),
    "acceleration": ("acceleration", S.length / S.time**2),
}


@pytest.fixture(scope="module")
def steady():
    return solve_steady(POINT, grid=Grid(n=32))


@pytest.fixture(scope="module")
def run():
    motion = HarmonicLoad.at(POINT, hz=2000.0, mass=0.05)
    return simulate(
        POINT,
        motion,
        grid=Grid(n=32),
        time=TimeSteps(until=0.3 * S.time, dt=0.1 * S.time),
        keep=KeepSettings(snapshots=(0.1 * S.time,)),
    )


def test_every_field_in_its_unit(steady, run):
    assert steady.si.error_estimate.approach == pytest.approx(steady.error_estimate.approach * S.length)
    assert (steady.si.error_estimate.h_central, steady.si.error_estimate.h_min) == (
        steady.error_estimate.h_central,
        steady.error_estimate.h_min,
    )
    assert run.si.film_error.approach == pytest.approx(run.film_error.approach * S.length)
    assert (run.si.film_error.h_central, run.si.to_dict()["film_error"]["h_min"]) == (
        run.film_error.h_central,
        run.film_error.h_min,
    )
    for result, beside in (
        (steady, {"error_estimate", "layer", "layer_behind"}),  # no supply: the last two are None
        (run, {"static_load", "mass", "omega", "hz", "film_error", "layer", "layer_behind"}),
    ):
        si = result.si
        assert {name for name in UNITS if hasattr(result, UNITS[name][0])} | beside == names_of(si)
        for name in names_of(si) - beside:
            ours, unit = UNITS[name]
            value = getattr(si, name)
            np.testing.assert_allclose(value, np.asarray(getattr(result, ours)) * unit, rtol=1e-14)
            assert not isinstance(value, np.ndarray) or not value.flags.writeable
        assert set(result.to_dict()["si"]) <= names_of(si)


def names_of(si):
    """Attributes that `dir` of a view lists beside its methods."""
    return {name for name in dir(si) if name[0] != "_" and not hasattr(type(si), name)}


def test_view_in_si(steady):
    """Names that are not there, and copies."""
    with pytest.raises(AttributeError, match="SteadyResult in SI has no H"):
        _ = steady.si.H
    assert copy.copy(steady.si).h_min == steady.si.h_min and "1e-06" not in repr(steady.si)
    assert repr(steady.si).startswith("SteadyResult in SI: approach ") and " N, h_central" in repr(steady.si)


def test_motion_in_si(run):
    si = run.si
    assert (si.hz, si.omega, si.mass) == pytest.approx((2000.0, 4000.0 * pi, 0.05))
    assert si.static_load == POINT.load
    # Newton's law in SI: what the film does not carry accelerates the mass.
    np.testing.assert_allclose(si.mass * si.acceleration[1:], (si.load - si.force)[1:], atol=1e-3 * POINT.load)
    assert (
        simulate(
            POINT, FreeVibration(Omega_n=5.0), grid=Grid(n=16), time=TimeSteps(until=0.2 * S.time, dt=0.1 * S.time)
        ).si.hz
        is None
    )


def test_full_contact_in_si():
    contact = TransientContact(POINT, grid=Grid(n=32))
    si = contact.si
    assert si.force == contact.force * S.force
    assert contact.force == pytest.approx(1.0, rel=1e-5)  # a film at rest, solved to 1e-5 of its pressure
    assert si.static_approach == contact.static_approach * S.length
    assert (si.h_central, si.h_min) == (contact.h_central * S.length, contact.h_min * S.length)
    assert repr(si).startswith("TransientContact in SI: force ")
    pytest.importorskip("pandas")
    assert si.to_pandas()["force [N]"].tolist() == [si.force] and si.to_pandas().attrs["M"] == contact.point.M
    with pytest.raises(InputError, match=r"^scales = None"):
        _ = TransientContact(POINT.moes, grid=Grid(n=32)).si


def test_dimensionless_points_have_none():
    for result in (
        solve_steady(POINT.moes, grid=Grid(n=16), throw=False),
        simulate(POINT.moes, FreeVibration(Omega_n=5.0), grid=Grid(n=16), time=TimeSteps(until=0.1, dt=0.1)),
    ):
        with pytest.raises(InputError, match=r"^scales = None: must be those of a result made from an Op"):
            _ = result.si
        assert "si" not in result.to_dict()


@pytest.mark.parametrize("cls", [SteadyResult, SimulationResult, TransientContact, Film, FilmHistory])
def test_every_quantity_is_described(cls):
    """Name and SI name in the docstring: under Attributes, as numpydoc has it."""
    text = getdoc(cls).split("Attributes\n", 1)[1]
    heads = [line.partition(" : ")[0] for line in text.splitlines() if line and line[0] != " "]
    named = {name.strip() for head in heads for name in head.split(",")}
    wanted = {f.name for f in fields(cls)} if is_dataclass(cls) else set(quantities_of(cls))
    assert wanted <= named
    assert all(name in named or f"``{name}``" in text for name in si_quantities(quantities_of(cls)))
