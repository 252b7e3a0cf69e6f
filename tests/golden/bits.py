"""Every number of the library to the last bit, to hold two checkouts against each other on one machine.

    python tests/golden/bits.py before.json            # in the old checkout
    python tests/golden/bits.py after.json before.json # in the new one: prints what differs, exit code 1 if any
    python tests/golden/bits.py after.json before.json --only bearings fmus

Scalars are kept as hexadecimal floats, arrays as the digest of their bytes beside their sum, so that a small
difference can be told from a wild one. Only public names are used: the layout of the library may change under it.
Wall times and versions are left out, and BLAS has one thread: with more, LU factors round differently from run to
run. Use a fresh ``NUMBA_CACHE_DIR`` for each checkout, and run twice: the process that compiles the kernels rounds
transient films differently from those that find them compiled. For other machines there is `golden.json`.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import sys
import tempfile
import warnings
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import simulate_fmu
from threadpoolctl import threadpool_limits

from ehlcontact import (
    ConvergenceError,
    Dent,
    Domain,
    FreeVibration,
    Grid,
    HarmonicLoad,
    KeepSettings,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    TimeSteps,
    TransientContact,
    Waviness,
    impedance,
    read,
    save,
    simulate,
    solve_steady,
)
from ehlcontact.film import film_of, track_wave
from ehlcontact.film.over_time import film_wave
from fmu import export, export_system
from reduced_models import (
    Atlas,
    BallBearing,
    ContactRecord,
    Disc,
    Shaft,
    SpeedProfile,
    SpringContact,
    Support,
    campbell,
    compare,
    fit,
    fit_memory,
    jeffcott_rotor,
    linearise,
    rotor_on_bearings,
    simulate_oscillator,
    simulate_rotor,
    unbalance_response,
)
from reduced_models.fitting.sensitivity import sensitivity
from reduced_models.fitting.wide_range_fit import wide_range_from_solves
from reduced_models.rotor.decay import log_decrement
from reduced_models.rotor.linear_contact import film_impedance, impedance_about

sys.path.insert(0, str(Path(__file__).parents[1]))  # the tests' own helpers

from argument_groups import grouped, with_grid

PAPER = MoesPoint(200, 10, 0.5)
NARROW = MoesPoint(500, 15, 0.12)
BEARING = OperatingPoint.ball_bearing(
    Lubricant(0.0367, 2.0e-8),
    ball_diameter=7.94e-3,
    pitch_diameter=39.04e-3,
    conformity=0.52,
    speed_rpm=3000.0,
    load=300.0,
)
SIZES = {"disc_mass": 3.0, "journal_mass": 0.2, "shaft_stiffness": 2e6, "unbalance": 2e-5, "speed_rpm": 3000.0}
UPRIGHT = jeffcott_rotor(bearings=1, load=(0.0, -268.0), **SIZES)
VEE = jeffcott_rotor(half_angle=0.35, bearings=1, load=(0.0, -500.0), **SIZES)
OIL = Lubricant.iso_vg(68, temperature=50.0)
T = np.linspace(0.0, 1.0, 21)
LEFT_OUT = {"seconds", "version", "law", "rotor", "element"}
# Names of old, under which other checkouts have the numbers.
RENAMED = {"error_bars": "error", "error_estimate": "error", "inlet_saturation": "squeeze"}
RENAMED |= {name: name.lower() for name in ("X", "Y", "T", "P", "H", "snapshot_T", "snapshot_P", "snapshot_H")}
LEFT = re.compile(r"\.file\.schema$")  # what other checkouts have and this one does not
Leaves = Iterator[tuple[str, Any]]


def leaves(name: str, value: Any) -> Leaves:
    """All numbers and arrays in `value`, by dotted name."""
    if value is None or isinstance(value, bool | int | float | str | np.generic | np.ndarray):
        yield name, value
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            if (
                field.name not in LEFT_OUT
                and field.name[0] != "_"
                and field.name not in ("law", "rotor", "element")
            ):
                yield from leaves(f"{name}.{RENAMED.get(field.name, field.name)}", getattr(value, field.name))
    elif isinstance(value, Mapping):
        for key, entry in value.items():
            if key not in LEFT_OUT:
                yield from leaves(f"{name}.{RENAMED.get(key, key)}", entry)
    elif isinstance(value, list | tuple):
        for i, entry in enumerate(value):
            yield from leaves(f"{name}[{i}]", entry)


def named(name: str, value: Any, names: str) -> Leaves:
    """Attributes of `value` under names that stay where classes change."""
    for one in names.split():
        yield from leaves(f"{name}.{one}", getattr(value, one))


def plain(value: Any) -> Any:
    """A leaf as JSON that differs where a bit does."""
    if isinstance(value, np.ndarray):
        content = np.ascontiguousarray(value)
        digest = hashlib.sha256(content.tobytes()).hexdigest()[:16]
        return f"{content.dtype}{list(content.shape)} {digest} sum {float(np.sum(content.astype(complex)).real)!r}"
    if isinstance(value, float | np.floating):
        return f"{float(value).hex()} = {float(value)!r}"
    return value if value is None or isinstance(value, bool | str) else str(value)


def steady_films() -> Leaves:
    """Fields on given and on chosen grids, both methods, failures too."""
    cases: dict[str, tuple[Any, dict[str, Any]]] = {
        "paper": (PAPER, {"n": 64}),
        "chosen": (PAPER, {}),
        "circle": (MoesPoint(20, 10, 1.0), {"n": 64, "tol": 1e-8}),
        "barus": (MoesPoint(50, 6, 0.5, viscosity="barus", density="incompressible"), {"n": 64}),
        "isoviscous": (MoesPoint(200, 0, 1.0), {}),
        "deep groove": (MoesPoint(2900, 19, 0.11), {}),
        "along rolling": (MoesPoint(50, 6, 2.0), {}),
        "light": (MoesPoint(5, 12, 0.12), {}),
        "thin": (MoesPoint(3786, 5.9, 0.7), {}),
        "newton": (PAPER, {"n": 64, "method": "newton", "tol": 1e-8}),
        "approach": (PAPER, {"n": 64, "approach": 0.6}),
        "pressed": (PAPER, {"n": 64, "approach": 1.3}),
        "domain": (PAPER, {"n": 64, "domain": Domain(-3.0, 1.5, 2.0)}),
        "bearing": (BEARING.moes, {}),
        "few cycles": (PAPER, {"n": 64, "max_cycles": 1, "throw": False}),
        "no room": (PAPER, {"n": 32, "domain": Domain(-1.2, 1.2, 1.2), "throw": False}),
        "unresolved": (MoesPoint(10000, 2, 0.5), {"n": 32, "throw": False}),
    }
    for name, (point, options) in cases.items():
        result = solve_steady(point, **with_grid(**options))
        yield from leaves(name, result)
        numbers = result.to_dict() if hasattr(result, "to_dict") else result.summary()  # older checkouts
        yield from leaves(name, {k: v for k, v in numbers.items() if k not in ("seconds", "version")})
    yield from named("si", solve_steady(BEARING), "x y p h approach force h_central h_min p_max moment")
    yield from leaves("film", film_of(solve_steady(BEARING.moes, grid=Grid(n=64))).constriction)


def records() -> Leaves:
    """Histories of every motion, in fixed and in controlled steps, over surfaces, stopped and resumed."""
    cases: dict[str, tuple[Any, Any, dict[str, Any]]] = {
        "free": (PAPER, FreeVibration(Omega_n=5.13), {"n": 32}),
        "offset": (PAPER, FreeVibration(Omega_n=2.56, offset=0.05), {"n": 32, "until": 1.0}),
        "harmonic": (PAPER, HarmonicLoad(Omega=np.pi), {"n": 32, "until": 1.0}),
        "inertia": (PAPER, HarmonicLoad(Omega=np.pi, Omega_n=5.13), {"n": 32, "until": 1.0}),
        "ramp": (PAPER, RampLoad(1.5, 0.5, Omega_n=5.13), {"n": 32, "until": 1.0}),
        "load": (PAPER, PrescribedLoad(T, 1.0 + 0.1 * T), {"n": 32}),
        "approach": (PAPER, PrescribedApproach(T, 0.88 + 0.05 * np.sin(np.pi * T) ** 2), {"n": 32}),
        "controlled": (PAPER, RampLoad(1.5, 0.5, Omega_n=5.13), {"n": 32, "until": 1.0, "local_error": 1e-3}),
        "controlled approach": (
            PAPER,
            PrescribedApproach(T, 0.88 + 0.05 * np.sin(np.pi * T) ** 2),
            {"n": 32, "local_error": 1e-3, "snapshots": (0.5, 1.0)},
        ),
        "dent": (PAPER, HarmonicLoad(Omega=np.pi), {"n": 64, "until": 0.5, "surface": Dent(0.05, 0.8, speed=1.2)}),
        "waves": (PAPER, HarmonicLoad(Omega=np.pi), {"n": 64, "until": 0.5, "surface": Waviness(0.01, 0.8)}),
        "narrow": (NARROW, FreeVibration(Omega_n=5.13), {"until": 0.2, "snapshots": (0.1,)}),
        "SI": (BEARING, FreeVibration(Omega_n=BEARING.Omega_n(0.5)), {"n": 64, "until": BEARING.scales.time}),
        "failing": (PAPER, RampLoad(60.0, 0.3, Omega_n=5.13), {"n": 32, "until": 0.5, "throw": False}),
    }
    for name, (point, motion, options) in cases.items():
        result = simulate(point, motion, **grouped(**options))
        yield from leaves(name, result)
        if result.steps > 2:
            yield from leaves(f"{name} between", result.at([0.25 * result.t[-1], 0.7 * result.t[-1]]))
        if name == "SI":
            yield from named(
                "si",
                result,
                "t approach rate acceleration force load h_central h_min x y h_midplane p_midplane static_approach"
                " static_load mass",
            )
    wave = film_wave(simulate(PAPER, HarmonicLoad(Omega=np.pi), grid=Grid(n=32), time=TimeSteps(until=4.0)))
    yield from leaves("wave", track_wave(wave))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "run.h5"
        simulate(
            PAPER,
            FreeVibration(Omega_n=5.13),
            grid=Grid(n=32),
            time=TimeSteps(until=0.25, dt=0.0125),
            keep=KeepSettings(checkpoint=file),
        )
        yield from leaves(
            "resumed",
            simulate(
                PAPER,
                FreeVibration(Omega_n=5.13),
                grid=Grid(n=32),
                time=TimeSteps(until=0.5, dt=0.0125),
                keep=KeepSettings(restart=file),
            ),
        )


def responses() -> Leaves:
    """Impedances."""
    omega = [0.0, 0.05, 0.25, 3.0, 12.0, 30.0]
    yield from leaves("paper", impedance(PAPER, Omega=omega, grid=Grid(n=32)))
    yield from leaves("chosen", impedance(PAPER, Omega=omega))
    yield from leaves("narrow", impedance(NARROW, Omega=omega))
    yield from leaves("light", impedance(MoesPoint(5, 12, 0.12), Omega=omega))
    at_bearing = impedance(BEARING, Omega=omega)
    yield from leaves("SI", at_bearing)
    yield from named("si", at_bearing, "omega hz stiffness damping")


def full_contact() -> Leaves:
    """The film as a force element, with a return to a saved state and a step that fails."""
    contact = TransientContact(PAPER, grid=Grid(n=32))
    forces = [contact.advance(0.05, 0.88 + 0.02 * k) for k in range(6)]
    state = contact.save_state()
    forces += [contact.advance(0.3, 0.7), contact.advance(0.1, 0.3)]
    contact.restore_state(state)
    try:
        contact.advance(1e-3, 4.0)
    except ConvergenceError as error:
        yield "refused", str(error)
    forces += [contact.advance(0.01, 0.95), contact.h_central, contact.h_min]
    yield "forces", np.array(forces)


def fits() -> Leaves:
    """Every model fitted to the same records."""
    free = ContactRecord.from_result(simulate(PAPER, FreeVibration(Omega_n=5.13), grid=Grid(n=32)))
    harmonic = ContactRecord.from_result(simulate(PAPER, HarmonicLoad(Omega=2.0 * np.pi), grid=Grid(n=32)))
    for model in ("linear", "cubic", "polynomial", "power"):
        yield from leaves(model, fit([free, harmonic], model=model).to_dict())
        yield from leaves(f"{model} of one", fit(free, model=model).to_dict())
    yield from leaves("window", fit(free, window=(0.5, 2.0)).to_dict())
    response = impedance(PAPER, Omega=[0.0, *np.geomspace(0.03, 60.0, 14)], grid=Grid(n=32))
    memory = fit_memory(response, [free], lags=6)
    yield from leaves("memory", memory.to_dict())
    yield from leaves("memory chosen", fit_memory(response).to_dict())
    yield from leaves("sensitivity", sensitivity([free, harmonic]))
    yield from element("fitted memory", memory.element)
    wide = wide_range_from_solves(
        PAPER,
        loads=[0.3, 0.7, 1.0, 1.8],
        memory_loads=[0.5, 1.0],
        Omega=[0.0, *np.geomspace(0.05, 30.0, 9)],
        n=32,
    )
    yield from element("wide from solves", wide)


def element(name: str, contact: Any) -> Leaves:
    """Forces, tangents, statics, steps and the file of an element."""
    low, high = contact.low, contact.high
    u = np.linspace(low - 0.6 * (high - low), high + 0.6 * (high - low), 41)
    scale = (high - low) * (1.0 if contact.units == "dimensionless" else 2e4)
    v = scale * np.array([-3.0, -0.7, 0.0, 0.4, 2.5])
    yield f"{name}.spring", np.asarray(contact.spring(u))
    yield f"{name}.tangent", np.array([contact.spring_tangent(float(x)) for x in u])
    middle = float(contact.spring(0.5 * (low + high)))
    yield (
        f"{name}.approach_at",
        np.array([contact.approach_at(share * middle) for share in (0.05, 0.6, 1.0, 1.4, 5.0)]),
    )
    if callable(getattr(contact, "force", None)):
        for what in ("force", "stiffness", "damping"):
            yield f"{name}.{what}", getattr(contact, what)(u[:, None], v[None, :])
        yield f"{name}.rate_at", contact.rate_at(0.5 * (low + high), 1.01 * middle)
    dt = 0.05 if contact.units == "dimensionless" else 1e-6
    contact.rest(low)
    steps = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for k in range(40):
            at = 0.5 * (low + high) + 0.7 * (high - low) * np.sin(0.3 * k)
            rate = 0.7 * (high - low) * 0.3 / dt * np.cos(0.3 * k)
            steps += [*contact.step_tangents(dt, at, rate), contact.advance(dt, at, rate)]
    yield f"{name}.steps", np.array(steps)
    if hasattr(contact, "drive"):
        unit, w = "Omega" if contact.units == "dimensionless" else "omega", np.array([0.0, 0.01, 1.0, 6.0, 40.0])
        yield f"{name}.impedance", contact.impedance(**{unit: w * 0.05 / dt}).value
        states = np.linspace(-0.01, 0.02, contact.state_count)
        force, rates = contact.state_rates(states, 0.5 * (low + high), v[3])
        yield f"{name}.rates", np.append(rates, force)
        t = np.linspace(0.0, 20.0 * dt, 30)
        yield f"{name}.drive", contact.drive(t, np.linspace(low, high, 30), np.full(30, (high - low) / t[-1]))
    with tempfile.TemporaryDirectory() as folder:
        path = save(contact, Path(folder) / "element.json")
        content = json.loads(path.read_text())
        yield from leaves(f"{name}.file", {key: content[key] for key in content if key != "header"})
        again = read(path)
    yield f"{name}.again", again.spring(0.5 * (low + high))


def elements() -> Leaves:
    """Elements by hand, from the atlas, and in SI."""
    box = {"low": 0.75, "high": 1.0, "rate": 0.6}
    by_hand = {
        "linear": SpringContact.linear(1.14, 0.013, **box),
        "cubic": SpringContact.cubic(0.624, 0.75, -0.174, 0.013, **box),
        "polynomial": SpringContact.polynomial(0.62, 0.02, 0.75, 0.004, -0.17, 0.002, 0.01, **box),
        "polynomial without rate": SpringContact.polynomial(0.62, 0.02, 0.75, 0.0, -0.17, 0.0, 0.01, 0.75, 1.0),
        "power": SpringContact.power(0.9, 1.6, 0.12, 0.03, 0.014, **box),
    }
    for name, contact in by_hand.items():
        yield from element(name, contact)
        yield from element(f"{name} in SI", contact.to_si(BEARING.scales))
    atlas = Atlas()
    for name, point in {
        "paper": PAPER,
        "narrow": NARROW,
        "light": MoesPoint(7, 3, 0.3),
        "heavy": MoesPoint(9000, 16, 0.1),
        "isoviscous": MoesPoint(300, 0, 0.9),
        "bearing": BEARING,
    }.items():
        yield from leaves(f"atlas {name}", atlas.at(getattr(point, "moes", point)))
        between = atlas.at(point).impedance(Omega=[0.0, 0.02, 0.7, 5.0, 20.0])
        yield from named(f"atlas {name} between", between, "omega stiffness damping")
        if name == "bearing":
            yield from named(
                "atlas si", atlas.at(point), "approach h_central h_min moment omega stiffness damping"
            )
        for model in ("wide", "memory", "cubic"):
            if not (model == "cubic" and name == "light"):
                yield from element(f"{model} {name}", atlas.element(point, model, **at(model)))


def at(model: str) -> dict[str, float]:
    """Frequency of an element that is asked for one."""
    return {"Omega": 2.0 * np.pi} if model == "cubic" else {}


ROTOR = "t disc disc_velocity journal journal_velocity approach rate force iterations status"


def motions() -> Leaves:
    """Jeffcott rotors and oscillators on elements, and on the full film."""
    atlas = Atlas()
    runs = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for model in ("wide", "memory", "cubic"):
            first, second = (atlas.element(BEARING, model, **at(model)) for _ in range(2))
            runs[model] = simulate_rotor(UPRIGHT.on([first]), dt=2e-4, until=0.02)
            yield from named(f"rotor {model}", runs[model], ROTOR)
            pair = simulate_rotor(VEE.on([first, second]), dt=2e-4, until=0.02)
            yield from named(f"vee {model}", pair, ROTOR)
            dimensionless = atlas.element(PAPER, model, **at(model))
            for omega_n in (5.13, None):
                swing = simulate_oscillator(
                    dimensionless, np.linspace(0.0, 1.0, 21), Omega_n=omega_n, load=1.05, u0=0.87, v0=0.1
                )
                yield from leaves(f"oscillator {model} {omega_n}", swing)
        full = TransientContact(BEARING, grid=Grid(n=64))
        start = (UPRIGHT.rest_at([full.static_approach]), np.zeros(2))
        run = simulate_rotor(UPRIGHT.on([full]), dt=2e-4, until=0.004, start=start, tolerance=1e-4)
    yield from named("rotor full", run, ROTOR)
    yield from leaves("compared", compare(run, runs["memory"]).to_dict())
    t = np.linspace(0.0, 0.1, 2001)
    yield from leaves("decay", log_decrement(t, np.exp(-30.0 * t) * np.cos(600.0 * t) + 1e-3, omega=600.0))
    wide = atlas.element(BEARING, "wide")
    film = film_impedance(impedance(BEARING, Omega=[0.0, 0.05, 0.25, 3.0, 12.0, 30.0]))
    for name, rotor, films in (
        ("elements", VEE, [impedance_about(wide, 0.5 * abs(VEE.load.sum()) / np.cos(0.35))] * 2),
        ("full films", UPRIGHT, [film]),
    ):
        linear = linearise(rotor.on(films))
        modes = [[mode.omega, mode.decrement, mode.support_share] for mode in linear.modes()]
        yield f"linear on {name}.modes", np.array(modes)
        yield f"linear on {name}.unbalance", linear.unbalance_response(rpm=[500.0, 3000.0, 9000.0]).amplitude
    # twice until it differs from the run before by rounding at most
    yield "equilibrium", VEE.on([wide, wide.copy()]).equilibrium()[2:]


def bearings() -> Leaves:
    """States and coefficients of ball bearings: with films, dry, tight, loose, with losses and inertia."""
    rough = {"rq_ball": 3e-8, "rq_race": 1e-7}
    cases = {
        "film": BallBearing.catalogue("6205", oil=OIL, **rough),
        "dry": BallBearing.catalogue("6205"),
        "loose": BallBearing.catalogue("6204", oil=OIL, clearance=8e-6),
        "tight": BallBearing.catalogue("6205", oil=OIL, clearance=-4e-6),
        "losses": BallBearing.catalogue("6205", oil=OIL, loss_factor=0.02),
        "inertia": BallBearing.catalogue("6205", oil=OIL, ball_inertia=True),
    }
    state = "displacement stiffness angles force approach h_central h_min lambda_ratio moment rolling_torque"
    for name, bearing in cases.items():
        yield from leaves(f"{name}.frequencies", bearing.frequencies(3000.0))
        for pull, speed in (((0.0, -1000.0), 3000.0), ((300.0, -150.0), 9000.0)):
            yield from named(f"{name} {pull} {speed:g}", bearing.equilibrium(pull, speed_rpm=speed), state)
        for angle in (None, 0.1):
            found = bearing.coefficients(
                (200.0, -800.0), speed_rpm=3000.0, cage_angle=angle, hz=[0.0, 5.0, 90.0, 1e3, 2e4]
            )
            yield from named(f"{name} small {angle}", found, "omega stiffness damping displacement peak_to_peak")


def bearing_rotors() -> Leaves:
    """Shafts on ball bearings: runs at one speed and over speeds, modes, unbalance."""
    film = BallBearing.catalogue("6205", oil=OIL)
    loose = BallBearing.catalogue("6204", oil=OIL, clearance=4e-6, loss_factor=0.01)
    housing = {"housing_mass": 2.0, "housing_stiffness": (8e7, 2e8), "housing_damping": 300.0}
    disc = {"diameter": 0.2, "width": 0.03, "bore": 0.025, "unbalance": 1e-5}
    overhung = rotor_on_bearings(
        Shaft(length=0.3, diameter=0.025, density=0.0),
        discs=[Disc.cylinder(position=0.3, **disc)],
        supports=[
            Support(position=0.02, bearing=film, journal_mass=0.5),
            Support(position=0.17, bearing=loose, journal_mass=0.5, **housing),
        ],
    )
    heavy, dry = BallBearing.catalogue("6205", oil=OIL, ball_inertia=True), BallBearing.catalogue("6205")
    beam = rotor_on_bearings(
        Shaft(length=0.3, diameter=0.03),
        discs=[Disc.cylinder(position=0.15, **disc)],
        supports=[Support(position=0.0, bearing=heavy), Support(position=0.3, bearing=dry)],
    )
    speeds = SpeedProfile(np.array([0.0, 0.01, 0.02]), np.array([3000.0, 8000.0, 6000.0]))
    history = "t speed_rpm displacement velocity ring iterations largest_load"
    for name, rotor in {"overhung": overhung, "beam": beam}.items():
        yield from named(name, rotor, "mass stiffness load")
        yield f"{name}.equilibrium", rotor.equilibrium(3000.0)
        for course, at_speed in {"constant": 3000.0, "run-up": speeds}.items():
            run = simulate_rotor(rotor, speed_rpm=at_speed, dt=1e-5, until=0.02)
            yield from named(f"{name} {course}", run, history)
            yield f"{name} {course}.force", run.force.reshape(run.ring.shape)
        moved = rotor.equilibrium(3000.0) + 1e-7, np.zeros(rotor.size)
        run = simulate_rotor(rotor, speed_rpm=3000.0, dt=1e-5, until=0.01, start=moved)
        yield from named(f"{name} pushed", run, history)
        yield f"{name} pushed.force", run.force.reshape(run.ring.shape)
        for passage in (True, False):
            small = linearise(rotor, 3000.0, passage=passage)
            modes = [[m.omega, m.eigenvalue.real, m.whirl] for m in small.modes(6)]
            yield f"{name} modes {passage}", np.array(modes)
            yield f"{name} receptance {passage}", small.receptance(hz=[10.0, 200.0, 3000.0])
        system = small.to_control(tolerance=0.0)
        for matrix in "ABCD":
            yield f"{name} control {matrix}", np.asarray(getattr(system, matrix))
        lines = campbell(rotor, [1000.0, 3000.0, 6000.0], count=4)
        yield from named(f"{name} campbell", lines, "speed_rpm omega growth whirl")
        response = unbalance_response(rotor, [1000.0, 3000.0, 6000.0])
        yield from named(f"{name} unbalance", response, "speed_rpm cosine sine nodes")


def fmus() -> Leaves:
    """Steps of FMUs in co-simulation and model exchange, and all texts inside, generated sources included."""
    atlas = Atlas()
    made = {
        "linear": SpringContact.linear(1.14, 0.013, low=0.75, high=1.0, rate=0.6),
        "polynomial": SpringContact.polynomial(
            0.62, 0.02, 0.75, 0.004, -0.17, 0.002, 0.01, low=0.75, high=1.0, rate=0.6
        ),
        "power": SpringContact.power(0.9, 1.6, 0.12, 0.03, 0.014, low=0.75, high=1.0, rate=0.6),
        **{model: atlas.element(PAPER, model, **at(model)) for model in ("wide", "memory", "cubic")},
        "wide in SI": atlas.element(BEARING, "wide"),
    }
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for fmi in (2, 3):
            for name, contact in made.items():
                path = export(contact, Path(folder) / f"{name}{fmi}.fmu", fmi=fmi)
                yield from texts(f"{name} {fmi}", path)
                scale = (contact.high - contact.low) * (1.0 if contact.units == "dimensionless" else 2e4)
                yield from fmu_steps(f"{name} {fmi}", path, contact, scale)
            closed = [made["wide in SI"], made["wide in SI"].copy()]
            for name, contacts in (("rotor alone", None), ("rotor", closed)):
                rotor, outside = (VEE, "all") if contacts is None else (VEE.on(contacts), ())
                path = export(rotor, Path(folder) / f"{name}{fmi}.fmu", fmi=fmi, outside=outside)
                yield from texts(f"{name} {fmi}", path)
                for kind, dt in (("CoSimulation", 1e-5), ("ModelExchange", 1e-7)):
                    options = {"solver": "Euler", "stop_time": 200 * dt, "step_size": dt, "output_interval": dt}
                    found = simulate_fmu(str(path), fmi_type=kind, **options)
                    for column in found.dtype.names:
                        yield f"{name} {fmi} {kind}.{column}", np.asarray(found[column])
            path = export_system(VEE.on(closed), Path(folder) / f"system{fmi}.ssp", fmi=fmi)
            yield from texts(f"system {fmi}", path)


def fmu_steps(name: str, path: Path, contact: Any, scale: float) -> Leaves:
    """Force of a contact that is pressed and let go."""
    dt = 0.05 if contact.units == "dimensionless" else 1e-6
    t = dt * np.arange(101)
    swing = 0.7 * (contact.high - contact.low)
    motion = np.zeros(t.size, [("time", float), ("approach", float), ("rate", float)])
    motion["time"] = t
    motion["approach"] = 0.5 * (contact.low + contact.high) + swing * np.sin(0.3 * t / dt)
    motion["rate"] = 0.3 * swing / dt * np.cos(0.3 * t / dt)
    for kind in ("CoSimulation", "ModelExchange"):
        found = simulate_fmu(
            str(path),
            fmi_type=kind,
            solver="Euler",
            stop_time=float(t[-1]),
            step_size=dt,
            output_interval=dt,
            input=motion,
            output=["force", "stiffness", "damping"],
        )
        for column in found.dtype.names:
            yield f"{name} {kind}.{column}", np.asarray(found[column])


def texts(name: str, path: Path) -> Leaves:
    """Digests of all files of an archive but libraries and pictures."""
    with zipfile.ZipFile(path) as archive:
        for entry in sorted(archive.namelist()):
            if entry.endswith((".c", ".h", ".xml", ".ssd", ".csv", ".txt", ".json")):
                yield f"{name}/{entry}", hashlib.sha256(archive.read(entry)).hexdigest()[:16]


GROUPS: dict[str, Callable[[], Leaves]] = {
    f.__name__: f
    for f in (
        steady_films,
        records,
        responses,
        full_contact,
        fits,
        elements,
        motions,
        bearings,
        bearing_rotors,
        fmus,
    )
}


def main() -> None:
    """Write the bits, and compare them with those of another checkout."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("target", type=Path, help="JSON file to write")
    parser.add_argument("other", type=Path, nargs="?", help="JSON file of another checkout")
    parser.add_argument("--only", nargs="+", choices=GROUPS, default=list(GROUPS), help="groups; all by default")
    given = parser.parse_args()
    found: dict[str, Any] = {}
    with threadpool_limits(1, user_api="blas"):
        for name in given.only:
            found |= {f"{name}: {leaf}": plain(value) for leaf, value in GROUPS[name]()}
            print(f"{name}: {len(found)} in all", flush=True)
    given.target.write_text(json.dumps(found, indent=0) + "\n")
    if given.other is None:
        return
    stored = json.loads(given.other.read_text()).items()
    known = {k: v for k, v in stored if k.split(": ")[0] in given.only and not LEFT.search(k)}
    differing = [k for k in known if known[k] != found.get(k, "absent")]
    for key in differing:
        print(f"{key}{off(known[key], found.get(key))}\n    {known[key]}\n    {found.get(key, 'absent')}")
    new = len(found.keys() - known.keys())
    print(f"{len(known) - len(differing)} alike, {len(differing)} differ from {given.other}; {new} new")
    if differing:
        raise SystemExit(1)


def off(known: Any, found: Any) -> str:
    """By how much a number, or the sum of an array, has changed."""
    try:
        before, after = (float(re.split("= |sum ", text)[1]) for text in (known, found))
    except (TypeError, IndexError, ValueError):
        return ""
    return f": changed by {abs(after - before) / max(abs(before), 1e-300):.1e} of it"


if __name__ == "__main__":
    main()
