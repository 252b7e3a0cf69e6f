"""Records: what they accept, what they refuse by name, and their windows."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from ehlcontact import Geometry, Lubricant, MoesPoint, OperatingPoint
from ehlcontact.checks import shown
from ehlcontact.errors import InputError
from reduced_models import ContactRecord, SpringContact

BALL = OperatingPoint(Geometry(0.01, 0.02), Lubricant(eta0=0.04, alpha=2.2e-8), load=50.0, u_sum=2.0)


def plain(**changes):
    T = np.linspace(0.0, 3.0, 31)
    return {"t": T, "approach": np.sin(T), "rate": np.cos(T), "force": np.sin(T)} | changes


def test_plain_lists_become_read_only_copies():
    T = [0.0, 1.0, 2.0, 3.0]
    record = ContactRecord(T, T, T, T)
    assert record.static_load == 1.0 and len(record) == 4
    with pytest.raises(ValueError, match="read-only"):
        record.force[0] = 2.0


def test_measured_record_in_si_has_no_static_load_unless_given():
    assert ContactRecord(**plain(), units="SI").static_load is None
    assert ContactRecord(**plain(), units="SI", static_load=50.0).static_load == 50.0


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"force": np.full(31, np.nan)}, "force[0]"),
        ({"rate": np.r_[np.zeros(30), np.inf]}, "rate[30]"),
        ({"approach": np.zeros(30)}, "length of approach"),
        ({"load": np.zeros(32)}, "length of load"),
        ({"acceleration": np.zeros((31, 1))}, "shape of acceleration"),
        ({"t": np.r_[np.linspace(0, 1, 30), 1.0]}, "t[30]"),
        ({"t": np.zeros(3)}, "length of t"),
        ({"force": ["a"] * 31}, "force"),
        ({"force": None}, "force"),
        ({"mass": -1.0}, "mass"),
        ({"Omega_n": 1.0}, "Omega_n"),
        ({"units": "um"}, "units"),
        ({"units": "SI", "point": MoesPoint(200.0, 10.0, 0.5)}, "units"),
        ({"units": "dimensionless", "point": BALL}, "units"),
        ({"static_load": 0.0}, "static_load"),
    ],
)
def test_bad_histories_are_named(changes, field):
    with pytest.raises(InputError) as caught:
        ContactRecord(**plain(**changes))
    assert caught.value.field == field


def test_window_is_closed_and_keeps_everything_else(record):
    cut = record.window(1.0, 2.0)
    assert cut.t[0] == pytest.approx(1.0) and cut.t[-1] == pytest.approx(2.0) and len(cut) == 101
    assert cut.load.size == cut.acceleration.size == 101 and cut.mass == record.mass
    assert record.default_window == pytest.approx((1.0, 3.0))


@pytest.mark.parametrize("span", [(2.0, 1.0), (np.nan, 1.0), (1.0, 1.01), (8.0, 9.0)])
def test_useless_windows(record, span):
    with pytest.raises(InputError):
        record.window(*span)


def simulation(status="converged", domain=(-4.5, 1.5, 3.0)):
    histories = plain(load=np.ones(31), acceleration=np.zeros(31))
    run = SimpleNamespace(
        **histories,
        point=MoesPoint(200.0, 10.0, 0.5),
        n=np.int64(64),
        domain=domain,
        motion=SimpleNamespace(to_dict=lambda: {"kind": "free", "Omega_n": 5.13}),
        mass=5.13**-2,
        status=status,
    )
    return run


@pytest.mark.parametrize("domain", [(-4.5, 1.5, 3.0), SimpleNamespace(x_in=-4.5, x_out=1.5, y_max=3.0)])
def test_from_result_takes_what_the_fit_will_need(domain):
    record = ContactRecord.from_result(simulation(domain=domain))
    assert record.mass == 5.13**-2 and record.domain == (-4.5, 1.5, 3.0) and record.n == 64
    assert record.motion["kind"] == "free" and record.load is not None


@pytest.mark.parametrize("other", [None, 3.0, "run.h5", SpringContact.linear(1.15, 0.0124, low=0.75, high=1.0)])
def test_from_result_names_what_is_no_simulation(other):
    with pytest.raises(
        InputError, match=rf"^simulation = {re.escape(repr(shown(other)))}: must be a SimulationResult"
    ):
        ContactRecord.from_result(other)


def test_from_result_refuses_an_unconverged_run_by_default():
    with pytest.raises(InputError, match="accept_unconverged"):
        ContactRecord.from_result(simulation("diverged"))
    assert len(ContactRecord.from_result(simulation("diverged"), accept_unconverged=True)) == 31


@pytest.mark.parametrize(
    ("name", "factor", "guess"),
    [
        ("approach", 1e6, "in um?"),
        ("approach", -1e3, "in mm?"),
        ("approach", 1e9, "in nm?"),
        ("force", 1e-3, "in kN?"),
        ("force", 1e4, "between"),
    ],
)
def test_histories_in_another_unit_than_the_point_are_refused(name, factor, guess):
    s, level = BALL.scales, np.linspace(0.9, 1.1, 31)
    given = {"t": level, "approach": s.length * level, "rate": 0.0 * level, "force": s.force * level}
    assert ContactRecord(**given, point=BALL).units == "SI"
    given[name] = factor * given[name]
    with pytest.raises(InputError, match=rf"^largest {name} = .*{re.escape(guess)}"):
        ContactRecord(**given, point=BALL)
    assert ContactRecord(**given, units="SI").units == "SI"  # without a point nothing says how large it is


def test_a_record_has_the_units_of_its_point():
    """Those of the point by default, and into Moes units and back."""
    s = BALL.scales
    motion = {"kind": "harmonic", "Omega": 9.0}
    T = np.linspace(0.0, 3.0, 31)
    given = plain(t=s.time * T, approach=s.length * np.sin(T), rate=s.rate * np.cos(T), force=s.force * np.sin(T))
    record = ContactRecord(**given, point=BALL, mass=2.0, motion=motion)
    assert record.units == "SI" and record.static_load == 50.0
    moes = record.dimensionless
    assert moes.units == "dimensionless" and moes.point == BALL.moes and moes.static_load == 1.0
    for name, unit in {"t": s.time, "approach": s.length, "rate": s.rate, "force": s.force}.items():
        np.testing.assert_array_equal(getattr(moes, name), getattr(record, name) / unit)
    assert moes.mass == 2.0 / s.mass and moes.in_units_of(BALL).mass == pytest.approx(2.0)
    assert moes.in_units_of(BALL).units == "SI" and moes.in_units_of(BALL.moes) is moes
    assert record.frequency == 9.0 / s.time and moes.frequency == 9.0
    assert record.default_window == pytest.approx([s.time * t for t in moes.default_window], rel=1e-12, abs=0.0)
    with pytest.raises(InputError, match=r"^point = 'M 20"):
        moes.in_units_of(MoesPoint(20.0, 10.0, 0.5))
    with pytest.raises(InputError, match="point = None: must be given"):
        _ = ContactRecord(**plain(), units="SI").dimensionless
