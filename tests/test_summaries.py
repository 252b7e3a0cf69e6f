"""What results and elements say and show of themselves: five short lines without an array, a figure, tables."""

import importlib
import inspect
import pkgutil
import re
import sys
from dataclasses import fields, is_dataclass, replace

import control
import numpy as np
import pytest
from balls import OF_6205

import ehlcontact
import fmu
import reduced_models
from ehlcontact import (
    Grid,
    HarmonicLoad,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    RunSettings,
    TimeSteps,
    TransientContact,
    excitation,
    impedance,
    response,
    simulate,
    solve_steady,
)
from ehlcontact.assumptions.table import Assumption, Assumptions
from ehlcontact.film import film_history, film_of, interferogram
from ehlcontact.film.over_time import FilmHistory, FilmWave, WaveTrack, film_wave
from ehlcontact.film.plane import Film, Interferogram
from ehlcontact.lubricant import Carreau, Eyring, LimitingShear
from ehlcontact.point import Scales
from ehlcontact.results import Response, SteadyResult, Traction
from ehlcontact.results.picture import LoadZone, Map, in_unit
from ehlcontact.results.table import QuantityTable
from ehlcontact.status import Status
from ehlcontact.summary import Summary, contact_text, counted, span
from ehlcontact.transient.result import Instants, SimulationResult
from fmu.bearing.model import BearingModel
from fmu.references.check import Interface, ReferenceCheck
from fmu.rotor.model import RotorModel
from fmu.verification import Verification
from reduced_models import (
    Atlas,
    BallBearing,
    BallDiameter,
    BearingMount,
    BearingSet,
    ContactMount,
    ContactRecord,
    Disc,
    OilBalance,
    Rotor,
    Shaft,
    SpeedProfile,
    Support,
    Unbalance,
    campbell,
    compare,
    fit,
    jeffcott_rotor,
    linearise,
    rotor_on_bearings,
    simulate_oscillator,
    simulate_rotor,
    unbalance_response,
)
from reduced_models.atlas.answer import AtlasAnswer, AtlasAnswers
from reduced_models.atlas.waves import FilterAnswer, contact_filter
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.excitation import BearingExcitation
from reduced_models.bearing.oil_and_heat import OilAndHeat
from reduced_models.bearing.oil_balance import OilHistory
from reduced_models.bearing.set_result import SetState
from reduced_models.bearing.sliding import BearingFriction
from reduced_models.elements.base import ContactElement
from reduced_models.fitting.result import ElementFit, FitResult, MemoryFit
from reduced_models.fitting.sensitivity import Sensitivity, sensitivity
from reduced_models.rotor.bearing_films import ContactHistory, FullFilm
from reduced_models.rotor.campbell import Campbell
from reduced_models.rotor.damping_budget import DampingBudget
from reduced_models.rotor.linear_contact import impedance_about
from reduced_models.rotor.linearise import LinearRotor
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.ross_rotor import RossCallback
from reduced_models.rotor.settling import Settling
from reduced_models.rotor.unbalance_result import UnbalanceResponse
from reduced_models.signals import (
    MeasuredPath,
    ModalPath,
    RecordCase,
    SystemPath,
    envelope_spectrum,
    order_spectrum,
)
from reduced_models.signals.indicators import indicators
from reduced_models.signals.records import VibrationRecord
from reduced_models.signals.spectra import EnvelopeSpectrum, OrderSpectrum

# Classes that are only returned, or of a special field: they stay in their modules, and are like the others.
RETURNED = (
    *(Assumption, Assumptions, Film, FilmHistory, FilmWave, Instants, Interferogram, Scales, WaveTrack),
    *(Response, Traction, Status, AtlasAnswer, FilterAnswer, BearingExcitation),
    *(BearingFriction, SetState, OilAndHeat, OilHistory, ElementFit, MemoryFit, Sensitivity, Campbell),
    DampingBudget,
    *(LinearRotor, UnbalanceResponse, ContactHistory, EnvelopeSpectrum, OrderSpectrum),
    *(SteadyResult, SimulationResult, BearingState, FitResult, RotorResult, VibrationRecord),
    *(Carreau, Eyring, LimitingShear, ContactElement, FullFilm, RossCallback),
    *(BearingModel, RotorModel, Verification, ReferenceCheck),
)
# What a user gives, or a few numbers: shown as they are.
SHOWN = "PrescribedApproach", "PrescribedLoad", "Roughness", "SpeedHistory", "Waves"
INPUT, NUMBERS, KIND = "an input", "a few numbers, which its summary has", "no result: it is used by its kind"
# Public classes without `plot`, and why.
WITHOUT_PLOT = {
    **dict.fromkeys(("Dent", "TransverseRidge", "Waviness", "Roughness", "Domain", "Grid", "OilLayer"), INPUT),
    **dict.fromkeys(("RaceWaviness", "BallWaviness", "BallDiameter", "Spall", "Indentation", "FullFilm"), INPUT),
    **dict.fromkeys(("SpeedHistory", "Heat", "Asperities", "Waves"), INPUT),
    **dict.fromkeys(("Eyring", "Carreau", "LimitingShear", "ShearThinning"), INPUT),
    **dict.fromkeys(("TimeSteps", "KeepSettings", "RunSettings"), INPUT),
    **dict.fromkeys(("MoesPoint", "OperatingPoint", "Geometry", "Lubricant", "Scales"), INPUT),
    **dict.fromkeys(("FreeVibration", "HarmonicLoad", "RampLoad", "PrescribedApproach", "PrescribedLoad"), INPUT),
    **dict.fromkeys(
        (
            "BallBearing",
            "BearingSet",
            "LinearBearing",
            "SqueezeFilmDamper",
            "BearingMount",
            "Unbalance",
            "PeriodicForce",
            "ContactMount",
            "Rotor",
        ),
        INPUT,
    ),
    **dict.fromkeys(("MeasuredPath", "ModalPath", "SystemPath", "RecordCase"), INPUT),
    **dict.fromkeys(("Shaft", "Disc", "Support"), INPUT),
    **dict.fromkeys(("BearingModel", "RotorModel", "OilBalance"), INPUT),
    **dict.fromkeys(("Assumption", "Assumptions"), "words and one number each: print it"),
    **dict.fromkeys(("BearingFriction", "OilAndHeat"), NUMBERS),
    **dict.fromkeys(("ReferenceCheck", "Verification"), NUMBERS),
    **dict.fromkeys(("InputError", "ConvergenceError", "OutsideValidityWarning", "BuildError"), KIND),
    **dict.fromkeys(("VerificationError", "Status"), KIND),
    **dict.fromkeys(("RossCallback", "BearingMotion", "TransientContact"), "stepped: its run has one"),
    "Atlas": "what it answers has one",
    "LinearRotor": "asked for modes and responses, by frequency",
}


@pytest.fixture(scope="module")
def point():
    oil = Lubricant.iso_vg(68, temperature=60.0)
    return OperatingPoint.ball_bearing(oil, **OF_6205, speed_rpm=3000.0, load=49.0)


@pytest.fixture(scope="module")
def results(point):
    """One of everything."""
    moes, motion = MoesPoint(20, 5, 0.5), HarmonicLoad(Omega=3.0)
    film = solve_steady(point, grid=Grid(n=32))
    run = simulate(
        point,
        motion,
        grid=Grid(n=16),
        time=TimeSteps(until=point.scales.time, dt=0.05 * point.scales.time),
        run=RunSettings(throw=False),
    )
    record, atlas = ContactRecord.from_result(run), Atlas()
    oil = point.lubricant
    bearing = BallBearing.catalogue("6205", oil=oil, rq_race=1e-7)
    down, element = (0.0, -500.0), atlas.element(MoesPoint(200, 10, 0.5), "memory")
    oiled = OilBalance(bearing=bearing, load=down, speed_rpm=3000.0)
    pair = BearingSet.pair(bearing, preload=100.0, distance=0.1)
    rotor = Rotor(
        mass=5.0 * np.eye(2),
        stiffness=np.zeros((2, 2)),
        load=np.array([0.0, -500.0]),
        mounts=(BearingMount(bearing=bearing, x=0, y=1),),
        unbalances=(Unbalance(x=0, y=1, amount=1e-6),),
    )
    speeds, found = [2000.0, 4000.0], impedance(point, hz=[50.0, 100.0], grid=Grid(n=32))
    return [
        film, film.dimensionless, film_of(film), solve_steady(moes, grid=Grid(n=16), throw=False),
        run, run.dimensionless, run.at(run.t[1:3]),
        record, found, found.dimensionless, impedance(moes, Omega=1.0, grid=Grid(n=16)),
        excitation(point, hz=[5e3, 1e4], grid=Grid(n=32)), excitation(moes, wavelength=8.0, grid=Grid(n=16)),
        response(point, to="speed", hz=[0.0, 1e4], grid=Grid(n=32)),
        response(moes, to="speed", Omega=3.0, grid=Grid(n=16)),
        response(point, to="layer", hz=[0.0, 1e4], grid=Grid(n=32), supply=OilLayer(over_flooded=1.0)),
        atlas.at(point), atlas.at(point).dimensionless, atlas.at(moes), atlas.at(point).impedance(hz=50.0),
        contact_filter(MoesPoint(200, 10, 0.5), wavelength=[4.0, 8.0, 16.0]),
        atlas.over([20.0, 30.0], 5.0, 0.5), element, atlas.element(point), atlas.element(point, "cubic", rpm=3000),
        atlas.element_over_speed(point),
        bearing.equilibrium(down, speed_rpm=3000.0), BallBearing.catalogue("6205").equilibrium(down),
        bearing.coefficients(down, speed_rpm=3000.0, hz=50.0), campbell(rotor, speeds, count=1),
        unbalance_response(rotor, speeds), simulate_rotor(rotor, speed_rpm=3000.0, dt=1e-4, until=1e-3),
        simulate_oscillator(element, np.linspace(0.0, 1.0, 5), Omega_n=3.0, u0=0.87),
        fit(record, model="linear"), linearise(rotor, 3000.0), linearise(rotor, 3000.0).modes(1)[0],
        linearise(rotor, 3000.0).damping_budget(1),
        *films_of(film, run), *rotors(atlas.element(point, "cubic", rpm=3000), bearing), sensitivity(record),
        pair, pair.equilibrium((0.0, 0.0, 0.0), speed_rpm=3000.0),
        bearing.excitation([BallDiameter(ball=0, excess=1e-7)], (0.0, 0.0, 300.0), speed_rpm=3000.0),
        SpeedProfile.ramp(0.0, 3000.0, 1.0), bearing, BearingMount(bearing=bearing, x=0, y=1),
        TransientContact(point, grid=Grid(n=32)), *spectra(),
        *verifications(), film.traction([0.01, 0.1], Eyring()),
        *(ContactHistory(*np.linspace(1e-6, 2e-6, 100).reshape(5, 20), np.ones(20, int), at, 0.0)
          for at in (None, point)),
        oiled, oiled.history(OilLayer(over_flooded=1.0), [0.0, 1.0, 10.0]),
    ]  # fmt: skip


def record_case(path):
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=40.0))
    return RecordCase(
        bearing=bearing, load=(0.0, -300.0), speed_rpm=1800.0, path=path, label="healthy", seconds=2000 / 12e3
    )


def spectra():
    tone, hz = np.sin(np.linspace(0.0, 3000.0, 2000)), np.array([0.0, 50.0, 100.0])
    path = ModalPath(hz=[50.0, 80.0], damping=0.1 * np.ones(2), mass=[1.0, 2.0])
    return [
        path, MeasuredPath(hz, path.response(hz)), SystemPath(control.tf([1.0, 0.0, 0.0], [1.0, 10.0, 1e4])),
        envelope_spectrum(tone, 1000.0, (100.0, 400.0)),
        VibrationRecord(signal=tone.astype(np.float32), rate=1e3, columns=record_case(path).columns()),
        record_case(path),
        order_spectrum(tone, 1000.0, np.linspace(0.0, 200.0, 2000), most=20.0),
    ]  # fmt: skip


def verifications():
    """Those that pass, and those that fail in all ways at once."""
    wrong = ("start 1.0 [m] in the FMU, " * 20, "another")
    interfaces = tuple(
        Interface(name, 9, ("force",), 1.0, "force", 0.1) for name in ("co-simulation", "model exchange")
    )
    return [
        Verification((), 100, 10, 5, *3 * (1e-16,), 0),
        Verification(wrong, 100, 10, 5, 1e-3, 0.1, float("inf"), 2, 1e-16, 1e-5),
        ReferenceCheck("3.0", (), interfaces, 1e-9),
        ReferenceCheck("3.0", wrong, interfaces, 1e-9),
    ]


def films_of(film, run):
    whole = film_of(film)
    return whole.along, whole.across, interferogram(whole, 5e-7), film_history(run), film_wave(run)


def rotors(element, bearing):
    """Rotors on a contact and on bearings, and their results."""
    mount = ContactMount(angle=-np.pi / 2)
    rotor = jeffcott_rotor(
        disc_mass=9.0, journal_mass=0.5, shaft_stiffness=5e6, mounts=(mount,), speed_rpm=3000.0, unbalance=1e-5,
        directions="y",
    )  # fmt: skip
    run = simulate_rotor(rotor.on([element]), dt=1e-4, until=0.01)
    linear = linearise(rotor.on([impedance_about(element, 45.0)]))
    shaft, disc = Shaft(length=[0.1, 0.2], diameter=0.02, bore=[0.0, 0.01]), Disc(position=0.1, mass=2.0)
    supports = [Support(position=0.0, bearing=bearing, housing_mass=1.0, housing_stiffness=1e8)]
    supports.append(Support(position=0.3, bearing=bearing))
    whole = rotor_on_bearings(shaft, supports=supports, discs=[disc])
    return [
        rotor, run, compare(run, run), linear, linear.modes()[0], shaft, disc,
        *supports, whole, Settling((0.5, 0.1, 0.001), 0.01),
    ]  # fmt: skip


def test_summaries_are_short(results):
    for thing in results:
        if not isinstance(thing, Summary):
            continue
        lines = repr(thing).splitlines()
        assert 1 <= len(lines) <= 5, repr(thing)
        assert lines[0].startswith(f"{thing._summary_name()}: ")
        assert max(map(len, lines)) <= 118, repr(thing)
        assert "array" not in repr(thing) and "[0." not in repr(thing)
        page = thing._repr_html_()
        assert page.count("<br>") == len(lines) - 1 and "<strong>" in page
        assert re.sub(r"\s+", "", re.sub("<[^>]*>", "", page)) == re.sub(
            r"\s+", "", repr(thing).replace("<", "&lt;")
        )


def test_they_say_what_is_there(point, results):
    film, run = results[0], results[4]
    assert f"{1e6 * film.h_central:.4g} (±" in repr(film) and "49 N" in repr(film) and "converged" in repr(film)
    assert "unresolved" in repr(replace(film, status=Status.UNRESOLVED))
    assert f"force {span(run.force, 1.0, 'N')}" in repr(run) and f"{run.steps} steps" in repr(run)
    state = next(thing for thing in results if isinstance(thing, BearingState))
    assert f"heaviest {state.force[state.heaviest, 0]:.4g} N" in repr(state) and "lambda" in repr(state)


def test_every_public_result_of_arrays_has_a_summary():
    """So that a new one that dumps them is seen here."""
    left = []
    for name, value in public_classes().items():
        if is_dataclass(value) and name not in SHOWN:
            kinds = [str(field.type) for field in fields(value)]
            if any("NDArray" in kind or "Array" in kind or "_Floats" in kind for kind in kinds):
                left += [] if issubclass(value, Summary) else [name]
    assert left == []


# Dimensionless, or in the units of a point that they do not know: shown as they are made.
RAW = {
    *("TimeSteps", "KeepSettings", "RunSettings", "Domain", "Grid", "Waves", "SpeedHistory", "Roughness"),
    *("FreeVibration", "HarmonicLoad", "RampLoad", "PrescribedLoad", "PrescribedApproach"),
    *("Dent", "TransverseRidge", "Waviness", "BearingModel", "RotorModel"),
}


def test_every_public_class_of_quantities_has_a_summary():
    shown = {name: kind for name, kind in public_classes().items() if is_dataclass(kind)}
    assert {name for name, kind in shown.items() if not issubclass(kind, Summary)} == RAW


def test_summaries_have_units(point, results):
    """Of each class that a user makes or is given, words that its summary must hold."""
    film = solve_steady(point, grid=Grid(n=16), thermal=True, throw=False)
    record = next(thing for thing in results if isinstance(thing, ContactRecord))
    spring = Atlas().element(point, "cubic", rpm=3000)
    scales, oil, bearing = point.scales, point.lubricant, BallBearing.catalogue("6205")
    free = simulate_oscillator(spring, [0.0, 1e-4], mass=3.0, u0=spring.high, load=49.0)
    table = [
        (point, ("49 N", "m/s", "GPa", "radius_x 3.163 mm", "e1 206 GPa", "mPa s", "1/GPa", "1/K", "60 °C")),
        (point.moes, ("M ", "L ", "kappa ", "1/GPa", "mPa s")),
        (point.geometry, ("radius_x 3.163 mm", "radius_y 103.2 mm", "e2 206 GPa")),
        (oil, ("mPa s", "1/GPa", "temperature_slope", "1/K", "temperature 60 °C")),
        (scales, ("force 49 N", "length ", "µm", "µs", "MPa")),
        (ehlcontact.assumptions(point), ("hold", "not judged, for an input is missing: ")),
        (ehlcontact.assumptions(point)["isothermal"], ("isothermal ", "phi_T", "at least 0.9")),
        (film.temperature, ("% thinner", " K", "surfaces up to")),
        (indicators(np.sin(np.linspace(0.0, 3000.0, 2000)), 2e3), ("in the unit of the signal", "mm/s rms")),
        (record, ("µs", "approach ", "µm", " N")),
        (record.dimensionless, ("2a/u_sum", "delta_H", "f0")),
        (fit(record, model="linear"), ("N/m", "N s/m", "root ", "µm", "N/µm")),
        (spring, ("N/m2", "N/m3", "N s/m")),
        (Atlas().element(point), ("coefficients dimensionless", " m", " N", "Hz")),
        (free, ("µs", "µm", " N")),
        (OilLayer(h=1e-7), ("100 nm",)),
        (ehlcontact.Heat(), ("W/(m K)", "J/(m3 K)")),
        (Eyring(), ("5 MPa",)),
        (ehlcontact.Asperities(1e-7), ("rq 100 nm",)),
        (BallDiameter(ball=0, excess=1e-7), ("excess 100 nm",)),
        (Unbalance(x=0, y=1, amount=1e-6), ("amount 1 g mm", "rad")),
        (ContactMount(angle=-1.5), ("angle -1.5 rad", "offset 0 m")),
        (FullFilm(ball=0, race="inner", between=(0.0, 1e-3)), ("between 0 .. 1 ms",)),
        (bearing.frequencies(3000.0), ("bpfo ", "Hz")),
    ]
    for thing, words in table:
        text = repr(thing)
        assert [word for word in words if word not in text] == [], text
        assert text.startswith(f"{thing._summary_name()}: ") and len(text.splitlines()) <= 5, text
    to = {thing.to: repr(thing) for thing in results if isinstance(thing, Response)}
    assert all("phase " in to[kind] and "°" in to[kind] for kind in ("speed", "layer", "waves"))


def public_classes():
    """Those that a package shows, and those that are only returned."""
    packages = (ehlcontact, reduced_models, reduced_models.signals, fmu)
    shown = [getattr(package, name) for package in packages for name in dir(package)]
    return {value.__name__: value for value in (*shown, *RETURNED) if inspect.isclass(value)}


def test_every_public_result_has_a_figure():
    """A new class without one stands in the list, with its reason."""
    without = {name for name, kind in public_classes().items() if not hasattr(kind, "plot")}
    assert without == set(WITHOUT_PLOT)


def labelled(panel):
    """Whether every axis of a panel has a label."""
    if isinstance(panel, LoadZone):
        return panel.title
    axes = (one[1] for one in (panel.x, panel.y, panel.values)) if isinstance(panel, Map) else (panel.x, panel.y)
    return all(in_unit(label)[0] for label in axes)


@pytest.mark.parametrize("in_files", [False, pytest.param(True, marks=pytest.mark.long)])
def test_figures_are_drawn(results, tmp_path, in_files):
    """Every axis says what it shows, and in which unit where it has one."""
    drawn = set()
    for thing in results:
        long_enough = not isinstance(thing, RotorResult) or thing.t.size > 16
        if hasattr(thing, "plot") and long_enough and type(thing) not in drawn:
            figure = thing.plot(tmp_path / "figure.png" if in_files else None)
            drawn.add(type(thing))
            assert figure.axes, thing
            assert not in_files or (tmp_path / "figure.png").stat().st_size > 5000, thing
            if type(thing).plot is QuantityTable.plot:
                assert all(map(labelled, thing.picture().panels)), thing
    wanted = {kind for kind in public_classes().values() if hasattr(kind, "plot") and not inspect.isabstract(kind)}
    alike = {"MemoryFit", "ElementFit", "WaveTrack"}
    assert {kind.__name__ for kind in wanted - drawn} == alike


def test_a_figure_of_a_point_in_si_is_in_si(results):
    names = {axes.get_xlabel() for axes in results[0].plot().axes if axes.get_xlabel()}
    places = "place along rolling [µm]", "place across [µm]"
    assert names == {
        places[1],
        *(f"{place.replace(' [', f', {other} = 0 [')}" for place, other in zip(places, "yx", strict=True)),
    }
    films = [thing for thing in results if isinstance(thing, SteadyResult) and isinstance(thing.point, MoesPoint)]
    assert films[0].plot().axes[0].get_xlabel() == "place across [b]"
    answer = next(thing for thing in results if isinstance(thing, AtlasAnswer))
    assert [axes.get_xscale() for axes in answer.plot().axes] == ["symlog"] * 2  # it begins at rest
    with pytest.raises(ehlcontact.InputError, match=r"path = .*a file name ending in one of"):
        results[0].plot("figure.docx")


def test_tables_of_xarray(results):
    xarray = pytest.importorskip("xarray")
    for thing in results:
        if isinstance(thing, QuantityTable):
            data = thing.to_xarray()
            assert isinstance(data, xarray.Dataset)
            assert data.attrs["result"] == thing._summary_name()
            assert all(values.attrs["units"] and values.attrs["long_name"] for values in data.data_vars.values())
            assert not [dim for dim in data.dims if dim.startswith("dim_")]
    film, run = results[0].to_xarray(), results[4].to_xarray()
    assert film.h.dims == ("x", "y") and film.h.attrs == {"units": "m", "long_name": "film"}
    assert float(film.h.sel(x=0.0, y=0.0, method="nearest")) == pytest.approx(float(film.h_central), rel=0.05)
    assert run.force.dims == ("t",) and run.h_midplane.dims == ("t", "x") and run.force.attrs["units"] == "N"
    state = next(thing for thing in results if isinstance(thing, BearingState)).to_xarray()
    assert list(state.race.values) == ["inner", "outer"] and state.force.sel(race="outer").shape == (9,)
    answer = next(thing for thing in results if isinstance(thing, AtlasAnswer))
    data = answer.to_xarray()
    assert (
        np.array_equal(data.stiffness_error, answer.error_bars["stiffness"])
        and data.attrs["M"] == answer.point.moes.M
    )


def test_tables_of_pandas(results):
    pandas = pytest.importorskip("pandas")
    for thing in results:
        if hasattr(thing, "to_pandas"):
            assert isinstance(thing.to_pandas(), pandas.DataFrame) and len(thing.to_pandas()), thing
    film, run, found = results[0], results[4], results[8]
    grid = film.to_pandas()
    assert list(grid.columns) == ["p [Pa]", "h [m]"] and grid.index.names == ["x [m]", "y [m]"]
    assert np.array_equal(grid["h [m]"].to_numpy().reshape(film.h.shape), film.h)
    history = run.to_pandas()
    assert np.array_equal(history["force [N]"], run.force) and history.index.name == "t [s]"
    assert np.array_equal(found.to_pandas()["damping [N s/m]"], found.damping)
    kind = {type(thing): thing for thing in results}
    balls = kind[BearingState].to_pandas()
    assert np.array_equal(balls["force_outer [N]"], kind[BearingState].force[:, 1])
    K = kind[BearingCoefficients].to_pandas()
    assert np.array_equal(K["stiffness_xy [N/m]"], kind[BearingCoefficients].stiffness[:, 0, 1])
    turned = next(thing for thing in results if isinstance(thing, RotorResult) and thing.names)
    assert np.array_equal(turned.to_pandas()["displacement_disc_y [m]"], turned.disc[:, 1])
    many = kind[AtlasAnswers].to_pandas()
    assert np.array_equal(many["h_min [delta_H]"], kind[AtlasAnswers].h_min) and len(many) == 2
    found = kind[FitResult]
    table = found.to_pandas()
    assert table.loc["K1", "value"] == found.parameters["K1"] and table.attrs["rms"] == found.rms
    assert (
        table.loc["K1", "low"] == found.intervals["K1"][0]
        and table.loc["K1", "std_error"] == found.std_errors["K1"]
    )


@pytest.mark.parametrize(("library", "method"), [("xarray", "to_xarray"), ("pandas", "to_pandas")])
def test_a_missing_library_is_one_line(results, monkeypatch, library, method):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(
        ehlcontact.InputError, match=rf"^{library} = None: must be installed: pip install 'ehl.*tables"
    ):
        getattr(results[0], method)()


def test_a_contact_in_si_is_headed_by_load_speed_and_pressure():
    point = OperatingPoint.ball_bearing(Lubricant(0.0367, 2.0e-8), **OF_6205, speed_rpm=3000.0, load=300.0)
    moes = "M 1832, L 18.86, kappa 0.1071"
    assert contact_text(point.moes) == moes
    assert (
        contact_text(point) == f"300 N, u_sum {point.u_sum:.4g} m/s, {point.scales.pressure / 1e9:.3g} GPa; {moes}"
    )


def test_one_frequency_of_an_element_is_no_unknown_contact():
    element = Atlas().element(MoesPoint(200, 10, 0.5), "cubic", Omega=0.1)
    assert repr(element.impedance(Omega=0.1)).startswith("Response: 1 frequency, omega 0.1\n  stiffness K 1.469")
    assert counted(2, "frequency", "frequencies") == "2 frequencies" and counted(0, "step") == "0 steps"


def test_span():
    assert span([1.0, 3.0], 2.0, "N") == "2 .. 6 N" and span([2.0, 2.0]) == "2" and span([np.nan]) == "none"


def rooms():
    """The three packages, and every room in them whose `__init__` shows names."""
    for package in (ehlcontact, reduced_models, fmu):
        yield package
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if found.ispkg and not found.name.startswith(("ehlcontact.cli", "ehlcontact.solver")):  # insides
                room = importlib.import_module(found.name)
                shown = [k for k, v in vars(room).items() if k[0] != "_" and not inspect.ismodule(v)]
                if set(shown) - {"annotations"}:
                    yield room


def test_dir_lists_public_names_only():
    for package in rooms():
        listed = dir(package)
        inner = [name for name in listed if inspect.ismodule(getattr(package, name))]
        assert inner == [] and listed and "annotations" not in listed, package
        assert not [name for name in listed if name.startswith("_") and name != "__version__"], package
        assert set(getattr(package, "__all__", listed)) == set(listed), package


def test_the_three_packages_list_what_they_show():
    assert {len(dir(package)) > 9 for package in (ehlcontact, reduced_models)} == {True}
    assert {"export", "verify", "export_system"} <= set(dir(fmu))
