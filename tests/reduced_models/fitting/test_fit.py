"""Least squares against the paper's normal equations, and what it refuses."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ehlcontact import Domain, Geometry, Lubricant, MoesPoint, OperatingPoint, assumptions
from ehlcontact.errors import InputError
from reduced_models import ContactRecord, SpringContact, fit

BALL = OperatingPoint(Geometry(0.01, 0.02), Lubricant(eta0=0.04, alpha=2.2e-8), load=50.0, u_sum=2.0)
# Nonato and Cavalca (2010): coefficients, and the root and tangent that follow from them.
TABLES = [
    ((1.552, -1.414, 1.093, 0.011), 0.8702, 1.574),
    ((0.806, 0.346, 0.054, 0.013), 0.8709, 1.532),
    ((0.747, 0.502, -0.046, 0.015), 0.8703, 1.516),
    ((0.703, 0.596, -0.097, 0.015), 0.8708, 1.520),
    ((0.603, 0.815, -0.215, 0.013), 0.8701, 1.533),
    ((0.413, 1.236, -0.444, 0.011), 0.8684, 1.555),
    ((0.8674, 0.3823, -0.0185, 0.033), 0.8486, 1.476),
]


def with_noise(record, size=1e-3):
    noise = size * np.random.default_rng(1).standard_normal(len(record))
    return replace(record, force=record.force + noise)


def test_exact_record_gives_its_coefficients_back(record):
    result = fit(record)
    paper = {"K1": 0.806, "K2": 0.346, "K3": 0.054, "C1": 0.013}
    assert result.parameters == pytest.approx(paper, rel=1e-8)
    assert result.rms < 1e-10 and abs(result.e_f) < 1e-12 and abs(result.e_acc) < 1e-10
    assert result.root == pytest.approx(0.8709, abs=1e-4) and result.tangent == pytest.approx(1.532, abs=1e-3)
    assert result.window == ((1.0, 3.0),)
    assert result.element.low == record.window(1.0, 3.0).approach.min()


@pytest.mark.literature
@pytest.mark.parametrize(("coefficients", "root", "tangent"), TABLES)
def test_roots_and_tangents_of_the_published_cubics(coefficients, root, tangent):
    element = SpringContact.cubic(*coefficients, low=0.78, high=0.96)
    u = element.approach_at(1.0)
    assert u == pytest.approx(root, abs=2e-4)
    assert element.stiffness(u, 0.0) == pytest.approx(tangent, abs=6e-3)


@pytest.mark.parametrize("model", ["linear", "cubic", "polynomial"])
def test_qr_agrees_with_the_papers_normal_equations(record, model):
    noisy = with_noise(record).window(1.0, 3.0)
    u, v, f = noisy.approach, noisy.rate, noisy.force
    # eq. 10; eq. 12 without the rows and columns of C2, C3, B4; eq. 12. Order as printed.
    terms = {
        "linear": [u, v],
        "cubic": [u, v, u**2, u**3],
        "polynomial": [u, v, u**2, v**2, u**3, v**3, u * v],
    }[model]
    matrix = np.array([[np.sum(a * b) for b in terms] for a in terms])
    right = np.array([np.sum(f * a) for a in terms])
    solved = np.linalg.solve(matrix, right)
    names = {
        "linear": ["K1", "C1"],
        "cubic": ["K1", "C1", "K2", "K3"],
        "polynomial": ["K1", "C1", "K2", "C2", "K3", "C3", "B4"],
    }[model]
    result = fit(noisy, model, window=(0.0, 9.0))
    # The normal matrix has the square of the condition number.
    np.testing.assert_allclose([result.parameters[name] for name in names], solved, rtol=1e-6)


def test_figures_of_merit_by_their_definitions(record):
    noisy = with_noise(record)
    result = fit(noisy)
    cut = noisy.window(*result.window[0])
    fitted = result.element.force(cut.approach, cut.rate)
    assert result.rms == pytest.approx(np.sqrt(np.mean((cut.force - fitted) ** 2)) / np.std(cut.force), rel=1e-9)
    assert result.e_f == pytest.approx(np.sum(cut.force - fitted) / np.sum(cut.force), abs=1e-12)
    model = 5.13**2 * (cut.load - fitted)
    assert result.e_acc == pytest.approx(np.sum(cut.acceleration - model) / np.sum(cut.acceleration), rel=1e-6)
    A = np.column_stack([cut.approach, cut.approach**2, cut.approach**3, cut.rate])
    assert result.condition == pytest.approx(np.linalg.cond(A / np.linalg.norm(A, axis=0)), rel=1e-6)
    variance = np.sum((cut.force - fitted) ** 2) / (len(cut) - 4)
    enlarged = variance * len(cut) / result.independent_samples
    np.testing.assert_allclose(result.covariance, enlarged * np.linalg.inv(A.T @ A), rtol=1e-5)
    assert result.std_errors["C1"] == pytest.approx(np.sqrt(result.covariance[3, 3]))


def test_standard_errors_match_the_scatter_over_many_records(record):
    def c1(seed):
        noise = 1e-3 * np.random.default_rng(seed).standard_normal(len(record))
        return fit(replace(record, force=record.force + noise)).parameters["C1"]

    scatter = np.std([c1(seed) for seed in range(200)])
    assert fit(with_noise(record)).std_errors["C1"] == pytest.approx(scatter, rel=0.2)


def test_several_records_are_fitted_sample_by_sample(record):
    other = replace(with_noise(record), approach=record.approach + 0.02)
    both = fit([record, other], window=(0.5, 2.5))
    u, v, f = (
        np.concatenate([getattr(r.window(0.5, 2.5), name) for r in (record, other)])
        for name in ("approach", "rate", "force")
    )
    expected = np.linalg.lstsq(np.column_stack([u, u**2, u**3, v]), f)[0]
    np.testing.assert_allclose([both.parameters[k] for k in ("K1", "K2", "K3", "C1")], expected, rtol=1e-7)
    assert both.samples == f.size and both.window == ((0.5, 2.5), (0.5, 2.5))


def shorter(record):
    """The record without its last sample: another one."""
    return record.window(float(record.t[0]), float(record.t[-2]))


@pytest.mark.parametrize("model", ["cubic", "memory"])
def test_a_record_counts_once(record, model):
    """Twice the same data would make the intervals of the fit narrower than it is known."""
    again = replace(record, t=record.t.copy(), n=64)
    for records in ([record, record], [shorter(record), record, again]):
        with pytest.raises(InputError, match=r"^records.* = .the record of records.*: must be another one"):
            fit(records, model)


def test_records_of_different_contacts_are_refused(record):
    a, b = (replace(r, point=MoesPoint(M, 10.0, 0.5)) for r, M in ((record, 200.0), (shorter(record), 300.0)))
    with pytest.raises(InputError, match=r"records\[1\]\.point = 'M 300.* 'M 200.*'$"):
        fit([a, b])
    with pytest.raises(InputError, match=r"records\[1\]"):
        fit([a, "b"])


@pytest.mark.parametrize("model", ["cubic", "memory"])
@pytest.mark.parametrize("records", [5, None, SimpleNamespace(t=[0.0, 1.0])])
def test_what_is_no_record_names_from_result(records, model):
    with pytest.raises(InputError, match=r"^records = .*a ContactRecord or a sequence of them.*from_result"):
        fit(records, model)


def test_json_keys_of_the_command_line(record):
    result = fit(record, "linear")
    document = json.loads(json.dumps(result.to_dict()))
    assert {"model", "parameters", "rms", "e_f", "root", "tangent", "valid", "condition"} <= set(document)
    assert set(document["parameters"]) == {"K1", "C1"} and {"low", "high"} <= set(document["valid"])
    assert document["window"] == [[1.0, 3.0]]
    assert len(document["covariance"]) == 2 and set(document["intervals"]) == {"K1", "C1"}


def test_source_of_the_data(record):
    point = MoesPoint(200.0, 10.0, 0.5)
    described = replace(record, point=point, n=64, domain=(-4.5, 1.5, 3.0), motion={"kind": "free"})
    source = fit(described).element.source
    assert source["point"] == point.to_dict() and source["n"] == 64 and source["motion"] == {"kind": "free"}
    assert fit([described, replace(shorter(described), n=128)]).element.source["n"] == [64, 128]


def test_assumptions_in_the_source(record):
    point = MoesPoint(200.0, 10.0, 0.5)
    described = replace(record, point=point, domain=(-4.5, 1.5, 3.0))
    short = assumptions(point, domain=Domain()).short()
    assert fit(described).element.source["assumptions"] == short
    # of several regions, the one with the least oil
    shorter = replace(described, force=described.force * 1.001, domain=(-1.5, 1.5, 3.0))
    assert not fit([described, shorter]).element.source["assumptions"]["fully flooded"]["holds"]
    elsewhere = replace(described, domain=(1.0, 2.0, 3.0))
    assert fit(elsewhere).element.source["assumptions"]["fully flooded"]["holds"] is None
    assert "assumptions" not in fit(replace(described, point=None)).element.source


def test_measured_record_in_si(record, scales):
    s = scales
    measured = ContactRecord(
        record.t * s.time, record.approach * s.length, record.rate * s.rate, record.force * s.force,
        units="SI", static_load=s.force,
    )  # fmt: skip
    result, twin = fit(measured), fit(record)
    si = twin.element.to_si(s)
    assert result.parameters == pytest.approx(si.parameters, rel=1e-6, abs=0.0)
    assert result.root == pytest.approx(twin.root * s.length, rel=1e-9, abs=0.0)
    assert result.tangent == pytest.approx(twin.tangent * s.stiffness, rel=1e-6, abs=0.0)
    assert result.e_acc is None and result.element.units == "SI"
    assert fit(replace(measured, static_load=None)).root is None


@pytest.mark.parametrize("model", ["linear", "cubic", "polynomial", "power"])
def test_a_fit_is_in_the_units_of_the_point(record, model):
    """At an OperatingPoint it is that of the Moes numbers in SI, with the uncertainty of a fit in SI."""
    bent = replace(record, force=record.force + 1e-3 * np.sin(40.0 * record.t), point=BALL.moes)
    given, s = bent.in_units_of(BALL), BALL.scales
    result, twin = fit(given, model), fit(given.dimensionless, model)
    si = twin.element.to_si(s)
    assert result.element.units == "SI" and result.element.parameters == result.parameters
    assert result.parameters == pytest.approx(si.parameters, rel=1e-12, abs=0.0)
    assert result.element.validity.approach == pytest.approx(si.validity.approach, rel=1e-12, abs=0.0)
    assert result.valid == result.element.validity.to_dict()
    assert result.root == pytest.approx(twin.root * s.length, rel=1e-9, abs=0.0)
    assert result.tangent == pytest.approx(twin.tangent * s.stiffness, rel=1e-9)
    assert result.window[0] == pytest.approx([t * s.time for t in twin.window[0]], rel=1e-12, abs=0.0)
    assert (result.rms, result.e_f) == (twin.rms, twin.e_f)
    assert result.element.fit["root"] == result.root and result.element.source["scales"]["force"] == s.force
    measured = replace(given, point=None, units="SI")  # fitted in SI numbers
    plain = fit(measured, model)
    assert result.std_errors == pytest.approx(plain.std_errors, rel=1e-3, abs=0.0)
    for name, interval in plain.intervals.items():
        size = max(map(abs, interval))
        assert result.intervals[name] == pytest.approx(interval, abs=1e-3 * size), name
    errors = np.sqrt(np.diag(plain.covariance))
    np.testing.assert_allclose(
        result.covariance / np.outer(errors, errors), plain.covariance / np.outer(errors, errors), atol=2e-3
    )


def test_a_window_counts_in_the_time_of_the_record(record):
    unit = BALL.scales.time
    si = replace(record, point=BALL.moes).in_units_of(BALL)
    assert fit(si, window=(0.5 * unit, 2.0 * unit)).samples == fit(record, window=(0.5, 2.0)).samples
    with pytest.raises(
        InputError, match=r"^window = \(0\.5, 2\.0\): must be one that holds 4 samples of t in \[0\.0, "
    ):
        fit(si, window=(0.5, 2.0))


def test_without_inertia_there_is_no_acceleration_error(record):
    assert fit(replace(record, mass=None)).e_acc is None


def test_constant_record_names_its_columns(record):
    still = replace(record, approach=np.full(301, 0.87), rate=np.sin(record.t))
    with pytest.raises(InputError, match=r"columns approach, approach\^2, approach\^3 = .* varies too little"):
        fit(still)
    with pytest.raises(InputError, match=r"columns approach, approach\^2, approach\^3, rate = "):
        fit(replace(still, rate=np.zeros(301)))


def test_zero_rate_is_named(record):
    with pytest.raises(InputError, match="columns rate = "):
        fit(replace(record, rate=np.zeros(301)))


def test_constant_force_is_refused(record):
    with pytest.raises(InputError, match="force"):
        fit(replace(record, force=np.ones(301)))


def test_more_parameters_than_samples(record):
    with pytest.raises(InputError, match="more than the 4 parameters"):
        fit(record, window=(1.0, 1.031))


@pytest.mark.parametrize("window", [3.0, (1.0,), ("a", "b"), (5.0, 9.0)])
def test_bad_windows(record, window):
    with pytest.raises(InputError):
        fit(record, window=window)


def test_negative_damping_is_refused_not_exported(record):
    with pytest.raises(InputError, match="C1"):
        fit(replace(record, force=record.force - 0.1 * record.rate))


@pytest.mark.parametrize(("model", "name"), [("linear", "C1"), ("cubic", "C1"), ("power", "C1")])
def test_undamped_record_has_no_damping(record, model, name):
    spring = {"linear": record.approach, "cubic": record.approach**3, "power": (record.approach + 0.1) ** 1.5}[
        model
    ]
    below = 1e-11 * record.rate  # what rounding leaves, made certain to be negative
    result = fit(replace(record, force=spring - below), model)
    cut = record.window(*result.window[0])
    assert result.parameters[name] == 0.0 and result.element.damping(0.87, 0.1) == 0.0 and result.rms < 1e-5
    assert result.rms > 0.0 and np.ptp(result.element.force(0.87, cut.rate)) == 0.0


def test_damping_is_zero_only_within_its_standard_error(record):
    error = fit(with_noise(record)).std_errors["C1"]
    noisy = with_noise(record)
    c1 = fit(noisy).parameters["C1"]
    barely = replace(noisy, force=noisy.force - (c1 + 0.9 * error) * noisy.rate)
    assert fit(barely).parameters["C1"] == 0.0
    with pytest.raises(InputError, match="C1"):
        fit(replace(noisy, force=noisy.force - (c1 + 1.2 * error) * noisy.rate))


@pytest.mark.parametrize(
    "spoil",
    [
        lambda r: replace(r, rate=-r.rate),
        lambda r: replace(r, rate=1e-3 * r.rate),
        lambda r: replace(r, rate=np.roll(r.rate, 5)),
        lambda r: replace(r, rate=2.0 * r.rate),
    ],
    ids=["sign", "units", "delay", "factor"],
)
@pytest.mark.parametrize("model", ["cubic", "power"])
def test_rate_that_is_not_the_derivative_is_refused(record, model, spoil):
    with pytest.raises(InputError, match="derivative of approach"):
        fit(spoil(record), model)


def test_noisy_rate_with_an_offset_is_accepted(record):
    noise = 0.1 * np.std(record.rate) * np.random.default_rng(2).standard_normal(len(record))
    assert fit(replace(record, rate=record.rate + noise + 0.05)).rms < 0.05


def test_validity_box_is_what_the_records_covered(record):
    result = fit([record, replace(shorter(record), motion={"kind": "harmonic", "Omega": 9.0})], window=(1.0, 3.0))
    cut, element = record.window(1.0, 3.0), result.element
    assert (element.low, element.high) == (cut.approach.min(), cut.approach.max())
    assert element.rate == np.abs(cut.rate).max()
    assert element.load_range == (cut.force.min(), cut.force.max())
    assert element.omega_range == (pytest.approx(6.0, rel=0.02), 9.0)
    assert result.valid["omega"] == list(element.omega_range) and element.rms == result.rms
