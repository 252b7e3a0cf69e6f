"""Behaviour of every kind of element, dimensionless and in SI. A new kind needs an example in `MADE`, no more."""

import json
import math
import warnings
from dataclasses import asdict, dataclass, replace

import numpy as np
import pytest

import reduced_models
from ehlcontact import save
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from ehlcontact.store import read as read_file
from reduced_models import (
    FilmContact,
    OutsideValidityWarning,
    SpringContact,
)
from reduced_models.elements.base import ContactElement
from reduced_models.rotor.contact_protocol import has_tangents

BOX = {"low": 0.75, "high": 1.0, "rate": 1.2, "load_range": (0.8, 1.2), "omega_range": (3.0, 6.0)}
BOX |= {"fit": {"rms": 0.01}, "source": {"n": 64}}
FILTERS = {"inlet_saturation": 0.25, "lag_rate": 5.4, "inlet_rate": 33.0, "fast_rate": 60.0}
GAINS = (0.001, 0.002, 0.005, 0.013, 0.0, 0.009, 0.011, 0.0, 0.0, 0.0, 0.021)
LOADS = np.array([0.005, 0.02, 0.1, 0.3, 1.0, 3.0])
CURVE = LOADS ** (2.0 / 3.0) - [0.0649, 0.0659, 0.0626, 0.0574, 0.0499, 0.0400]
SLOWER = LOADS ** (2.0 / 3.0) - 0.5 * (LOADS ** (2.0 / 3.0) - CURVE)
ROWS = tuple(tuple(scale * g for g in GAINS) for scale in (2.0, 1.0, 0.6))
HALVES = tuple(tuple(0.5 * g for g in row) for row in ROWS)

MADE = {
    "linear": SpringContact.linear(1.15, 0.0124, **BOX),
    "cubic": SpringContact.cubic(0.806, 0.346, 0.054, 0.013, **BOX),
    "polynomial": SpringContact.polynomial(0.806, 0.004, 0.346, 0.002, 0.054, -0.001, 0.010, **BOX),
    "power": SpringContact.power(0.95, 1.7, 0.15, -0.05, 0.013, **BOX),
    "memory": FilmContact.memory(film=0.129, exponent=0.13, gains=GAINS, **FILTERS, **BOX),
    "wide": FilmContact.wide(LOADS, CURVE, (0.03, 0.3, 2.0), ROWS, **FILTERS, **BOX),
    "speed": FilmContact.over_speed(
        (0.4, 1.0, 1.5),
        LOADS,
        (SLOWER, CURVE, CURVE),
        (0.03, 0.3, 2.0),
        (HALVES, ROWS, ROWS),
        **{**FILTERS, "inlet_saturation": (0.25, 0.25, 0.25)},
        **BOX,
    ),
}
SCALES = Scales(force=1000.0, length=4e-6, time=2e-5, a=2e-4, b=1e-3, pressure=1.5e9)

pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")


@dataclass
class Dimensionless:
    """An element in any units, asked and answering without units."""

    element: ContactElement
    force: float = 1.0
    length: float = 1.0
    time: float = 1.0

    def _inputs(self, dt, u, v):
        return dt * self.time, u * self.length, v * self.length / self.time

    def advance(self, dt, u, v):
        return self.element.advance(*self._inputs(dt, u, v)) / self.force

    def tangents(self, dt, u, v):
        units = self.force, self.force / self.length, self.force / self.length * self.time
        return np.array(self.element.step_tangents(*self._inputs(dt, u, v))) / units

    def spring(self, u):
        return self.element.spring(np.asarray(u) * self.length) / self.force

    def slope(self, u):
        return self.element.spring_tangent(u * self.length) * self.length / self.force

    def approach_at(self, force):
        return self.element.approach_at(force * self.force) / self.length

    def rest(self, u):
        return self.element.rest(u * self.length) / self.force


@pytest.fixture(params=MADE)
def element(request):
    """A fresh one: at rest, nothing warned of."""
    return replace(MADE[request.param])


@pytest.fixture(params=["dimensionless", "SI"])
def asked(request, element):
    if request.param == "SI":
        return Dimensionless(element.to_si(SCALES), SCALES.force, SCALES.length, SCALES.time)
    return Dimensionless(element)


def test_every_kind_is_here(element):
    classes = {cls for cls in vars(reduced_models).values() if isinstance(cls, type) and hasattr(cls, "kinds")}
    kinds = {kind for cls in classes for kind in cls.kinds}
    assert set(MADE) == kinds and all(e.kind == name for name, e in MADE.items())
    assert has_tangents(element)


def test_static_force_rises_without_a_jump(asked):
    u, du = np.linspace(-2.0, 4.0, 3001, retstep=True)
    force, slope = asked.spring(u), np.array([asked.slope(x) for x in u])
    assert np.all(force >= 0.0) and np.all(np.diff(force) >= 0.0) and np.all(slope >= 0.0)
    # between two nodes the force grows by what the slopes say: it has no jump, they only where it begins
    np.testing.assert_allclose(np.diff(force), 0.5 * du * (slope[1:] + slope[:-1]), rtol=2e-3, atol=1e-4)
    assert asked.spring(50.0) > 8.0 * asked.spring(10.0)  # like a dry contact or steeper, in the end


def test_static_answers_agree(asked):
    for u in (0.5, 0.75, 0.87, 1.0, 1.4):
        force = asked.spring(u)
        assert force > 0.0 and asked.spring(np.array([[u]]))[0, 0] == force
        assert asked.approach_at(force) == pytest.approx(u, rel=1e-9)
        assert asked.rest(u) == pytest.approx(force, rel=1e-12)
        assert asked.advance(0.1, u, 0.0) == pytest.approx(force, rel=1e-9)
        slope = (asked.spring(u + 1e-6) - asked.spring(u - 1e-6)) / 2e-6
        assert asked.slope(u) == pytest.approx(slope, rel=1e-2 if u in (0.75, 1.0) else 1e-5)  # curvature may jump
    for load in (1e-3, 0.4, 1.0, 1.02, 5.0):
        assert asked.spring(asked.approach_at(load)) == pytest.approx(load, rel=1e-12, abs=1e-12)


def test_step_forces_never_pull_and_never_jump(asked):
    asked.rest(0.87)
    u, du = np.linspace(-0.5, 2.0, 801, retstep=True)
    for dt in (1e-2, 1.0):
        for v in (-40.0, -1.5, 0.0, 0.4, 40.0):
            force, stiffness, _ = np.array([asked.tangents(dt, x, v) for x in u]).T
            assert np.all(force >= 0.0)
            steepest = np.maximum(np.abs(stiffness[1:]), np.abs(stiffness[:-1]))
            assert np.all(np.abs(np.diff(force)) <= 1.5 * du * steepest + 0.05 * du)


def test_step_tangents_are_differences_of_the_force(asked):
    rng = np.random.default_rng(1)
    compared = 0
    for _ in range(150):
        asked.rest(rng.uniform(0.0, 1.5))
        asked.advance(0.3, rng.uniform(0.0, 1.5), rng.normal())
        dt, u, v, h = 10.0 ** rng.uniform(-2.0, 1.5), rng.uniform(-0.4, 2.0), 3.0 * rng.normal(), 1e-7
        force, stiffness, damping = asked.tangents(dt, u, v)
        ends = [asked.tangents(dt, u + a, v + b)[0] for a, b in ((h, 0.0), (-h, 0.0), (0.0, h), (0.0, -h))]
        if force == 0.0:
            assert stiffness == damping == 0.0
        elif min(ends) > 1e-3:  # across the edge of the clipped force a difference is no derivative
            compared += 1
            assert stiffness == pytest.approx((ends[0] - ends[1]) / (2.0 * h), rel=1e-4, abs=1e-5)
            assert damping == pytest.approx((ends[2] - ends[3]) / (2.0 * h), rel=1e-4, abs=1e-5)
    assert compared > 60


@pytest.mark.parametrize("omega", [0.05, math.pi, 30.0])
@pytest.mark.parametrize(
    ("centre", "amplitude", "third"), [(0.87, 0.01, 0.0), (0.87, 0.1, 0.3), (0.8, 0.7, 0.0), (0.2, 0.6, 0.3)]
)
def test_no_closed_cycle_gives_energy(asked, omega, centre, amplitude, third):
    """The box, beyond both of its ends, and surfaces that part."""
    steps, periods = 400, max(2, math.ceil(0.6 * omega))
    phase = 2.0 * np.pi * np.arange(steps * periods + 1) / steps
    u = centre + amplitude * (np.sin(phase) + third * np.sin(3.0 * phase))
    v = omega * amplitude * (np.cos(phase) + 3.0 * third * np.cos(3.0 * phase))
    asked.rest(u[0])
    dt = 2.0 * np.pi / (omega * steps)
    force = [asked.advance(dt, *at) for at in zip(u[1:], v[1:], strict=True)]
    last = slice(-steps, None)
    work = np.mean(np.array(force)[last] * v[last]) * 2.0 * np.pi / omega
    assert work > 0.0


def test_steps_have_the_force_of_their_tangents_and_states_are_restored(asked):
    e = asked.element
    rng = np.random.default_rng(3)
    way = [(0.05, *at) for at in zip(rng.uniform(0.6, 1.1, 40), 0.5 * rng.normal(size=40), strict=True)]
    asked.rest(0.8)
    for step in way[:20]:
        asked.advance(*step)
    state = e.save_state()
    kept = None if state is None else state.copy()
    first = []
    for step in way[20:]:
        expected = e.step_tangents(*asked._inputs(*step))[0]
        first.append(e.advance(*asked._inputs(*step)))
        assert first[-1] == expected
    np.testing.assert_array_equal(state, kept)  # a copy, not the work array
    e.restore_state(state)
    other = e.copy()
    for step in way[:5]:
        other.advance(*asked._inputs(*step))
    assert [e.advance(*asked._inputs(*step)) for step in way[20:]] == first
    assert other == e and type(other) is type(e)


def test_scalars_and_arrays_take_the_same_way(element):
    if not isinstance(element, SpringContact):
        return
    u, v = np.meshgrid(np.linspace(-0.5, 2.0, 41), [-30.0, -0.5, 0.0, 0.7, 30.0])
    each = np.array([element.step_tangents(0.0, *at) for at in zip(u.ravel(), v.ravel(), strict=True)]).T
    for name, values in zip(("force", "stiffness", "damping"), each, strict=True):
        method = getattr(element, name)
        np.testing.assert_array_equal(method(u, v), values.reshape(u.shape))
        assert isinstance(method(0.9, 0.5), float) and isinstance(method(1, 0), float)
    np.testing.assert_array_equal(element.spring(u), element.force(u, 0.0))
    for at, rate in ((0.8, -0.9), (0.95, 1.1), (0.7, 2.0)):
        force = element.force(at, rate)
        assert force > 0.0 and element.rate_at(at, force) == pytest.approx(rate, rel=1e-9)


def test_si_is_the_same_element_in_other_units(element):
    si = element.to_si(SCALES)
    asked = Dimensionless(si, SCALES.force, SCALES.length, SCALES.time)
    assert type(si) is type(element) and si.units == "SI" and si.fit == element.fit
    assert si.source == {**(element.source or {}), "scales": asdict(SCALES)} and si.time == SCALES.time
    for u in (-0.5, 0.6, 0.9, 1.3):
        assert asked.spring(u) == pytest.approx(element.spring(u), rel=1e-10, abs=1e-12)
        for v in (-30.0, -0.5, 0.0, 2.0):
            theirs = element.step_tangents(0.1, u, v)
            np.testing.assert_allclose(asked.tangents(0.1, u, v), theirs, rtol=1e-10, atol=1e-12)
    ours, theirs = si.validity, element.validity
    assert ours.approach == pytest.approx([x * SCALES.length for x in theirs.approach])
    assert ours.rate == pytest.approx(theirs.rate * SCALES.rate)
    assert ours.load == pytest.approx([x * SCALES.force for x in theirs.load])
    assert ours.omega == pytest.approx([x / SCALES.time for x in theirs.omega])
    with pytest.raises(InputError, match="dimensionless"):
        si.to_si(SCALES)


def test_si_refuses_the_scales_of_another_contact(element, tmp_path):
    fitted = replace(element, source={"scales": asdict(SCALES)})
    for one in (fitted, read_file(save(fitted, tmp_path / "element.json"))):
        for wrong in ("force", "length", "time"):
            with pytest.raises(InputError, match=r"^scales = .*the element was fitted at"):
                one.to_si(replace(SCALES, **{wrong: 1.00001 * getattr(SCALES, wrong)}))
        assert one.to_si(replace(SCALES, force=(1.0 + 1e-9) * SCALES.force)).units == "SI"
        with pytest.raises(InputError, match=r"^scales = 5:"):
            one.to_si(5)
    # Nobody knows the scales of an element from a dimensionless point.
    for source in (None, {"n": 64}, {"scales": None}):
        assert replace(fitted, source=source).to_si(replace(SCALES, force=7.0)).units == "SI"


def test_file_keeps_every_bit(asked, tmp_path):
    e = asked.element
    path = save(e, tmp_path / "e.json")
    back = read_file(path)
    assert back == e and type(back) is type(e) and read_file(path, type(e)) == e
    assert (back.fit, back.source, back.validity) == (e.fit, e.source, e.validity)
    for u in (-0.5, 0.6, 0.9, 1.3):
        at = asked._inputs(0.1, u, 0.3)
        assert back.spring(at[1]) == e.spring(at[1]) and back.step_tangents(*at) == e.step_tangents(*at)
    document = json.loads(path.read_text())
    assert (document["header"]["class"], document["kind"]) == (type(e).__name__, e.kind)
    assert list(document["parameters"]) == list(e.parameter_names)
    assert list(document["valid"]) == ["low", "high", "rate", "load", "omega"]
    other = SpringContact if e.state_count else FilmContact
    with pytest.raises(InputError, match=rf"class '{type(e).__name__}'"):
        read_file(path, other)


def test_files_without_a_coefficient_or_with_text_name_it(element, tmp_path):
    path = save(element, tmp_path / "wrong.json")
    document = json.loads(path.read_text())
    for name in element.parameter_names:
        for entries in ({name: "much"}, {name: None}, {name: True}):
            path.write_text(json.dumps(document | {"parameters": document["parameters"] | entries}))
            with pytest.raises(InputError, match=rf"wrong\.json: parameters\.{name}") as caught:
                read_file(path)
            assert "\n" not in str(caught.value)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda e: e.advance(0.1, 1.2, 0.0), r"approach 1\.2 \(fitted 0\.75 to 1\)"),
        (lambda e: e.advance(0.1, 0.5, 0.0), r"approach 0\.5 \(fitted 0\.75 to 1\)"),
        (lambda e: e.advance(0.1, 0.9, -3.0), r"rate 3 \(fitted up to 1\.2\)"),
        (lambda e: e.warn_outside([0.9], [1.0], force=[0.9, 1.5]), r"force 1\.5 \(fitted 0\.8 to 1\.2\)"),
        (lambda e: e.warn_outside([0.9], [1.0], Omega=13.0), r"Omega 13 \(fitted Omega 3 to 6\)"),
    ],
)
def test_leaving_the_box_warns_once(element, call, words):
    with pytest.warns(
        OutsideValidityWarning, match=rf"^{type(element).__name__} \({element.kind}\) used outside .*{words}"
    ) as told:
        for _ in range(3):
            call(element)
    assert len(told) == 1 and told[0].filename == __file__
    with pytest.warns(OutsideValidityWarning):  # another element, its own warning
        call(replace(element))


def test_an_impedance_outside_the_box_has_a_reservation(element):
    assert element.impedance(load=1.0, Omega=4.0).reservation == ""
    light, fast = element.impedance(load=0.5, Omega=4.0), element.impedance(Omega=13.0)
    head = "outside the validity box of the element: "
    assert light.reservation == f"{head}load 0.5 (fitted 0.8 to 1.2)" and light.to_dict()["reservation"]
    assert fast.reservation == f"{head}Omega 13 (fitted Omega 3 to 6)" and fast.reservation in str(fast)


def test_no_warning_within_the_margin_or_for_evaluations(element):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        at_corners = replace(element, load_range=(0.0, 2.0))  # where no data is
        at_corners.advance(0.1, 0.75, -1.2)
        at_corners.advance(0.1, 1.01, 1.25)
        element.warn_outside([0.74, 1.01], [1.25], Omega=11.9, force=[0.785, 1.215])
        element.warn_outside()
        element.step_tangents(0.1, 5.0, 9.0), element.spring(np.linspace(0, 5, 9)), element.approach_at(9.0)
    assert element.is_valid(0.75, 1.2, Omega=6.0) and not element.is_valid(0.9, 0.5, Omega=7.0)
    np.testing.assert_array_equal(element.is_valid([0.7, 0.8, 0.8], [0.0, -0.5, -2.0]), [False, True, False])
    assert element.is_valid(1.0) and not element.is_valid(1.0001) and not element.is_valid(0.9, 1.2001)
    assert replace(element, omega_range=None).is_valid(0.9, Omega=1e9)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"low": 1.0}, "low"),
        ({"high": math.inf}, "high"),
        ({"units": "mm"}, "units"),
        ({"rate": -1.0}, "rate"),
        *[({name: bad}, name) for name in ("load_range", "omega_range") for bad in (3.0, (1.0,), (2.0, 1.0))],
        ({"load_range": (0.0, math.nan)}, "load_range"),
    ],
)
def test_bad_boxes_are_named(element, changes, field):
    with pytest.raises(InputError) as caught:
        replace(element, **changes)
    assert caught.value.field == field


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_motions_that_are_not_finite_are_named(element, bad):
    """Else a rotor sees no force, as after lift-off."""
    states = np.zeros(element.state_count)
    calls = [
        (lambda: element.advance(0.1, bad, 0.0), "approach"),
        (lambda: element.state_rates(states, bad, 0.0), "approach"),
        (lambda: element.state_rates(states, 0.9, bad), "rate"),
        (lambda: element.state_rates(np.append(states[1:], bad), 0.9, 0.0), "states"),
        (lambda: element.state_rates(np.zeros(states.size + 1), 0.9, 0.0), "states"),
        (lambda: element.spring(bad), "approach"),
        (lambda: element.spring([0.9, bad]), "approach"),
        (lambda: element.spring_tangent(bad), "approach"),
        (lambda: element.rest(bad), "approach"),
    ]
    if hasattr(element, "drive"):
        for k, name in enumerate(("T", "approach", "rate")):
            record = [[0.0, 0.1, 0.2], [0.9, 0.9, 0.9], [0.0, 0.0, 0.0]]
            record[k][1] = bad
            calls.append((lambda record=record: element.drive(*record), rf"{name}\[[12]\]"))
    for call, name in calls:
        with pytest.raises(InputError, match=rf"^{name}") as caught:
            call()
        assert "\n" not in str(caught.value)


def test_bad_coefficients_and_forces_are_named(element):
    for name in element.parameter_names:
        for bad in (math.nan, math.inf, "x", None):
            with pytest.raises(InputError, match=name):
                replace(element, **{name: bad})
    for bad in (0.0, -1.0, math.nan, "x"):
        with pytest.raises(InputError, match="force"):
            element.approach_at(bad)


def one_loop(contact, dt, u, v):
    """What a user writes once, whatever the element: forces along a motion, and rates of the states at rest."""
    at = contact.at_rest(u[0])
    forces = [at.advance(dt, float(a), float(b)) for a, b in zip(u, v, strict=True)]
    still, rates = at.state_rates(np.zeros(at.state_count), float(u[0]), 0.0)
    return at, np.array(forces), still, rates


def test_one_loop_serves_every_kind(asked):
    element = asked.element
    T = np.linspace(0.0, 1.0, 21)
    u = (0.87 + 0.01 * np.sin(3.0 * T)) * asked.length
    v = 0.03 * np.cos(3.0 * T) * asked.length / asked.time
    before = element.save_state()
    moved, forces, still, rates = one_loop(element, T[1] * asked.time, u, v)
    assert type(moved) is type(element) and moved is not element
    assert np.array_equal(element.save_state(), before)  # its own state stayed
    assert np.all(forces > 0.0) and np.ptp(forces) > 0.01 * forces.mean()
    assert still == pytest.approx(element.spring(float(u[0])), rel=1e-12)
    assert rates.shape == (element.state_count,) and np.all(rates == 0.0)
    assert (element.state_count > 0) == (not isinstance(element, SpringContact))
    if isinstance(element, SpringContact):  # what they have besides, at any place and rate
        assert np.array_equal(forces, element.force(u, v))
        for ask in (element.stiffness, element.damping):
            assert ask(u, v).shape == u.shape


def test_at_rest_by_place_or_by_load(asked):
    element, load = asked.element, 0.9 * asked.force
    place = element.approach_at(load)
    by_load, by_place = element.at_rest(load=load), element.at_rest(place)
    assert np.array_equal(by_load.save_state(), by_place.save_state())
    still = 1e-9 * asked.time
    assert by_load.advance(still, place, 0.0) == pytest.approx(load, rel=1e-9)
    assert element.at_rest().save_state() is None or np.array_equal(
        element.at_rest().save_state(), element.copy().save_state()
    )
    with pytest.raises(InputError, match=r"^approach and load = "):
        element.at_rest(place, load=load)
    with pytest.raises(InputError, match=r"^load = "):
        element.at_rest(load=0.0)


@pytest.mark.parametrize("load", [None, 0.6, 1.4])
def test_state_space_is_the_impedance_and_what_python_control_linearises(asked, load):
    """F over u of `to_ss`, with v = i w u, at any load; and of `to_control` by differences."""
    control = pytest.importorskip("control")
    element, omega = asked.element, np.geomspace(0.01, 30.0, 7) / asked.time
    at, unit = None if load is None else load * asked.force, "Omega" if asked.force == 1.0 else "omega"
    block, nonlinear = element.to_ss(at), element.to_control()
    found = control.frequency_response(block, omega).frdata[0]
    found = found.reshape(2, omega.size) if found.ndim > 1 else found
    expected = element.impedance(load=at, **{unit: omega}).value
    np.testing.assert_allclose(found[0] + 1j * omega * found[1], expected, rtol=1e-9)
    for one in (block, nonlinear):
        assert (one.input_labels, one.output_labels, one.nstates) == (["u", "v"], ["F"], element.state_count)
    assert nonlinear.state_labels == block.state_labels
    u, rest = element.approach_at(asked.force * (load or 1.0)), np.zeros(block.nstates)
    for k, step in enumerate((1e-6 * asked.length, 1e-6 * asked.length / asked.time)):
        up, down = (nonlinear.output(0.0, rest, np.array([u, 0.0]) + d * np.eye(2)[k])[0] for d in (step, -step))
        assert (up - down) / (2.0 * step) == pytest.approx(block.D[0, k], rel=1e-5)
    if block.nstates:
        np.testing.assert_allclose(nonlinear.dynamics(0.0, rest, [u, step]) / step, block.B[:, 1], rtol=1e-9)


def test_figure_of_every_kind(asked, tmp_path):
    """Force over the approach, K and C over frequency, with the units of the element."""
    figure = asked.element.plot(tmp_path / "element.png")
    units = ("µm", "Hz", "Hz") if asked.force != 1.0 else ("dry approach", "u_sum/(2a)", "u_sum/(2a)")
    assert tuple(axes.get_xlabel().partition(" [")[2].rstrip("]") for axes in figure.axes) == units
    force = figure.axes[0].lines[0].get_xydata()
    inside = force[np.isfinite(force[:, 1])]
    low, high = asked.element.low, asked.element.high
    factor = 1e6 if asked.force != 1.0 else 1.0
    assert low * factor <= inside[:, 0].min() and inside[:, 0].max() <= high * factor
    assert inside[5, 1] == pytest.approx(asked.element.spring(inside[5, 0] / factor), rel=1e-9)
    assert (tmp_path / "element.png").stat().st_size > 5000
