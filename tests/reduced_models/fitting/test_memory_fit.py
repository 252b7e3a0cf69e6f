"""Fit of the film-memory element to impedance and records of full EHL, and the one element for all cases."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from balls import OF_6205
from programs import script

from ehlcontact import (
    FreeVibration,
    Grid,
    HarmonicLoad,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    TimeSteps,
    impedance,
    simulate,
)
from reduced_models import ContactRecord, fit_memory

POINT = MoesPoint(200, 10, 0.5)
OMEGAS = np.concatenate([[0.0], np.geomspace(0.03, 60.0, 24)])


@pytest.fixture(scope="module")
def coarse():
    """Impedance and records of the same contact on a coarse grid."""
    response = impedance(POINT, Omega=OMEGAS, grid=Grid(n=32))
    motions = (FreeVibration(Omega_n=5.13), HarmonicLoad(Omega=pi / 4), HarmonicLoad(Omega=2.0 * pi))
    records = [
        ContactRecord.from_result(simulate(POINT, motion, grid=Grid(n=32, domain=response.film.domain)))
        for motion in motions
    ]
    return response, records


def test_one_element_fits_impedance_and_records(coarse):
    response, records = coarse
    result = fit_memory(response, records, lags=8)
    assert max(result.record_rms) < 0.015
    band = response.omega <= 30.0
    assert np.abs(result.damping_error[band]).max() < 0.1 and np.abs(result.stiffness_error[band]).max() < 0.01
    element = result.element
    Z = element.impedance(Omega=response.omega[1:])
    np.testing.assert_allclose(Z.damping / response.damping[1:] - 1.0, result.damping_error[1:], atol=1e-9)
    assert element.rms == result.rms < 0.01
    assert element.source["n"] == 32 and element.source["point"]["M"] == 200
    assert element.is_valid(0.87) and element.omega_range == (0.0, 60.0)
    T, u, v = (getattr(records[0], name) for name in ("t", "approach", "rate"))
    error = element.drive(T, u, v) - records[0].force
    assert np.sqrt(np.mean(error**2)) / np.std(records[0].force) == pytest.approx(result.record_rms[0])


def test_cross_validation_chooses_the_order_and_the_impedance_alone_will_do(coarse, monkeypatch):
    monkeypatch.setattr("reduced_models.fitting.memory_fit.CHAIN_LENGTHS", (2, 8))
    result = fit_memory(coarse[0])
    assert result.validation[2] > 1.5 * result.validation[8] and result.element.lags == 8
    assert result.rms is None and result.element.inlet_saturation == 0.0
    assert result.element.load_range == (0.9, 1.1)


def test_impedance_is_solved_at_the_point_of_the_record(coarse):
    response, records = coarse
    element = fit_memory(None, records[2], lags=4).element
    C = np.interp(0.05, response.omega, response.damping)
    assert element.impedance(Omega=0.05).damping[0] == pytest.approx(C, rel=0.05)
    with pytest.raises(InputError, match="give an impedance"):
        fit_memory(None)
    with pytest.raises(InputError, match="give an impedance"):
        fit_memory(None, replace(records[0], n=None))


def test_bad_data_for_the_fit(coarse):
    response, records = coarse
    with pytest.raises(InputError, match=r"^frequencies of the impedance = \d: must be at least 8 frequencies"):
        fit_memory(impedance(POINT, Omega=[0.0, 1.0], grid=Grid(n=32)))
    with pytest.raises(InputError, match="lowest Omega"):
        fit_memory(response[9:])
    with pytest.raises(InputError, match="approach"):
        fit_memory(replace(response, film=replace(response.film, approach=1.0)))
    with pytest.raises(InputError, match=r"^response.film = None: must be that of a solved contact"):
        fit_memory(replace(response, film=None))
    with pytest.raises(InputError, match=r"records\[0\].n"):
        fit_memory(response, replace(records[0], n=64))
    with pytest.raises(InputError, match="rate"):
        fit_memory(response, replace(records[0], rate=-records[0].rate))
    with pytest.raises(InputError, match="damping"):
        fit_memory(replace(response, slope=-response.slope), lags=4)
    with pytest.raises(InputError, match="lags"):
        fit_memory(response, lags=0)


@pytest.mark.slow
def test_one_element_for_all():
    """What issue 4 asks for, on n = 64; `examples/studies/one_element_for_all.py` prints it at any n."""
    example = script("examples/studies/one_element_for_all.py")
    Z = impedance(example.POINT, Omega=example.OMEGAS, grid=Grid(n=64, domain=example.DOMAIN))
    seen = {name: example.record(motion, 64) for name, motion in example.fitted_motions().items()}
    unseen = {"chirp": example.record(example.chirp(), 64), "step": example.record(example.load_step(), 64)}
    result = fit_memory(Z, list(seen.values()))
    rows = {name: errors for name, *errors in example.table(result, seen, unseen)}
    assert len(rows) == 11
    assert max(memory for memory, *_ in rows.values()) < 0.012
    assert max(one for _, _, one in rows.values()) > 0.04, "what one viscous cubic makes of it"
    band = (Z.omega >= 0.02) & (Z.omega <= 30.0)
    assert np.abs(result.damping_error[band]).max() < 0.1
    assert np.abs(result.stiffness_error[band]).max() < 0.01
    w = np.geomspace(0.022, 29.5, 40)  # frequencies that the fit did not see
    between, ours = (
        impedance(example.POINT, Omega=w, grid=Grid(n=64, domain=example.DOMAIN)),
        result.element.impedance(Omega=w),
    )
    assert np.abs(ours.imag / w / between.damping - 1.0).max() < 0.1
    assert np.abs(ours.real / between.stiffness - 1.0).max() < 0.01
    low = result.element.impedance(Omega=0.05)[0].imag / 0.05
    assert low == pytest.approx(np.interp(0.05, Z.omega, Z.damping), rel=0.03)


def test_response_and_records_of_a_point_in_si():
    """The element has the units of the response; its numbers are those of Moes units."""
    oil = Lubricant(0.037, 2e-8)
    point = OperatingPoint.ball_bearing(oil, **OF_6205, speed_rpm=3000.0, load=49.0)
    response = impedance(point, Omega=OMEGAS[::2], grid=Grid(n=32))
    time = TimeSteps(until=8.0 * point.scales.time, dt=0.1 * point.scales.time)
    run = simulate(point, HarmonicLoad(Omega=2.0), grid=Grid(n=32, domain=response.film.domain), time=time)
    record = ContactRecord.from_result(run)
    found, moes = (fit_memory(one, [record], lags=4) for one in (response, response.dimensionless))
    element, twin = found.element, moes.element
    assert (element.units, twin.units) == ("SI", "dimensionless") and element.parameters == twin.parameters
    assert found.root == moes.root * point.scales.length and found.tangent == moes.tangent * point.scales.stiffness
    assert found.record_rms == moes.record_rms and element.fit["root"] == found.root
    drive = element.drive(record.t, record.approach, record.rate)
    assert np.std(drive - record.force) == pytest.approx(found.rms * np.std(record.force), rel=0.05)
    Z = element.impedance(omega=response.omega[1:])
    assert np.abs(Z.stiffness / response.stiffness[1:] - 1.0).max() <= np.abs(found.stiffness_error).max() * 1.001
