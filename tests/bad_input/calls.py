"""Python calls with bad input: what a script of a user may hold."""

import copy
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from zipfile import ZipFile

import numpy as np
from balls import OF_6205

import fmu
import reduced_models as rm
from ehlcontact import (
    Dent,
    FreeVibration,
    Geometry,
    Grid,
    HarmonicLoad,
    KeepSettings,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedLoad,
    Roughness,
    TimeSteps,
    TransientContact,
    TransverseRidge,
    Waviness,
    impedance,
    read,
    save,
    simulate,
    solve_steady,
)
from reduced_models import LinearBearing
from reduced_models.elements.base import ContactElement

OIL = Lubricant(0.0367, 2e-8)
BALL = OF_6205 | {"speed_rpm": 3000.0, "load": 34.0}
BOX = {"low": 0.7, "high": 1.0}
LINE = np.linspace(0.0, 1.0, 20)


def bearing(oil=OIL, **changes):
    return OperatingPoint.ball_bearing(oil, **(BALL | changes))


def solved(**changes):
    """A steady film of a bearing's contact: refused before anything is solved."""
    return solve_steady(bearing(**changes))


@cache
def point():
    return MoesPoint(200, 10, 0.5)


@cache
def full_contact():
    """Solved, and compiled, before anything bad is asked of it."""
    return TransientContact(point(), grid=Grid(n=32))


@cache
def archive():
    """An archive with numbers, as an FMU is."""
    path = Path(mkdtemp()) / "x.fmu"
    with ZipFile(path, "w") as file:
        file.writestr("model.bin", bytes(range(256)))
    return path


def record(**changes):
    columns = {"t": LINE, "approach": 0.8 + 0.1 * LINE, "rate": 0.1 + 0.0 * LINE, "force": 1.0 + LINE}
    return rm.ContactRecord(**(columns | changes))


def cubic(**changes):
    return rm.SpringContact.cubic(**({"K1": 1.0, "K2": 0.1, "K3": 0.1, "C1": 0.01, **BOX} | changes))


@cache
def elements():
    """Files of an element about one load, and of one for every load."""
    return {kind: rm.Atlas().element(point(), kind).to_dict() for kind in ("memory", "wide")}


def element_of(kind, section=None, **changes):
    """An element from the entries of a file, some of them changed."""
    entries = copy.deepcopy(elements()[kind])
    (entries if section is None else entries[section]).update(changes)
    return rm.FilmContact.from_dict(entries)


def rows_of_gains():
    return len(elements()["wide"]["parameters"]["gains"])


def power(**changes):
    good = {"K": 1.0, "n": 1.5, "u0": 0.0, "F0": 0.0, "C1": 0.01}
    return rm.SpringContact.power(**(good | BOX | changes))


def jeffcott(**changes):
    parts = {"disc_mass": 2.0, "journal_mass": 0.3, "shaft_stiffness": 1e8}
    return rm.jeffcott_rotor(bearings=1, **(parts | changes))


MASKED = np.ma.masked_array(np.linspace(0.0, 1.0, 20), mask=[0] * 19 + [1])
HUGE = 10**400  # no float holds it

CALLS = {
    # numbers that are none, or too large for a float
    "M of 400 digits": (lambda: MoesPoint(HUGE, 10, 0.5), ("M", "a finite number > 0")),
    "M of 5000 digits": (lambda: MoesPoint(10**5000, 10, 0.5), ("M", "thousands of digits", "a finite number")),
    "Omega of 400 digits": (lambda: impedance(point(), Omega=HUGE), ("Omega", "numbers")),
    "Omega masked": (lambda: impedance(point(), Omega=MASKED), ("Omega", "without a masked one")),
    "until of 400 digits": (lambda: TimeSteps(until=HUGE), ("until", "a finite number > 0")),
    "times as text": (lambda: PrescribedLoad(["0", "1", "2", "3"], [1.0] * 4), ("T = 'list'", "numbers")),
    "loads that are true": (lambda: PrescribedLoad([0.0, 1.0, 2.0, 3.0], [True] * 4), ("values", "numbers")),
    "one load that is true": (lambda: PrescribedLoad([0.0, 1.0, 2.0, 3.0], [1.0, True, 1.0, 1.0]), ("values",)),
    "record as text": (lambda: record(force=["1"] * 20), ("force", "numbers")),
    "record masked": (lambda: record(force=MASKED), ("force", "without a masked one")),
    "one entry masked": (lambda: record(force=[1.0] * 19 + [np.ma.masked]), ("force", "numbers")),
    "an ESC in the value": (lambda: HarmonicLoad(Omega="\x1b[31m3"), ("Omega", r"'\x1b[31m3'")),
    # elements: numbers as text, and numbers that no contact has
    "approach as text": (lambda: cubic().advance(0.1, "0.8", 0.0), ("approach = '0.8'", "a number")),
    "approach that is true": (lambda: cubic().step_tangents(0.1, True, 0.0), ("approach = True", "a number")),
    "approach masked": (lambda: cubic().advance(0.1, np.ma.masked, 0.0), ("approach = masked", "a number")),
    "approaches as text": (lambda: cubic().spring(["0.8"]), ("approach", "numbers")),
    "approaches masked": (lambda: cubic().spring(MASKED), ("approach", "without a masked one")),
    "inside as text": (lambda: cubic().is_valid("0.8"), ("approach", "numbers")),
    "film as text": (lambda: element_of("memory").advance(0.1, "0.8", 0.0), ("approach = '0.8'", "a number")),
    "step as text": (lambda: element_of("memory").advance("1", 0.8, 0.0), ("dt = '1'", "a number")),
    "record of text": (lambda: element_of("memory").drive(["0", "1"], [0.8] * 2, [0.0] * 2), ("T", "numbers")),
    "record masked, driven": (lambda: element_of("memory").drive(MASKED, MASKED, MASKED), ("T", "masked")),
    "band below 0": (lambda: cubic(omega_range=(-1.0, 5.0)), ("omega_range", "low <= high, both >= 0")),
    "band below 0, read": (lambda: element_of("memory", "valid", omega=[-1, 5]), ("omega_range", ">= 0")),
    "rate of others": (lambda: element_of("memory", "valid", rate=1e200), ("rate", "at most 1e+15 in magnitude")),
    "unknown parameter": (
        lambda: element_of("memory", "parameters", fim=1),
        ("parameters.fim", "left out; known are"),
    ),
    "unknown bound": (lambda: element_of("wide", "valid", fim=1), ("valid.fim", "left out; known are")),
    "unknown entry": (lambda: element_of("wide", fim=1), ("fim", "left out; known are")),
    "film 1e200": (lambda: element_of("memory", "parameters", film=1e200), ("film", "between 1e-09 and 1e+06")),
    "film 1e-200": (lambda: element_of("memory", "parameters", film=1e-200), ("film", "between 1e-09 and 1e+06")),
    "exponent 1e200": (lambda: element_of("memory", "parameters", exponent=1e200), ("exponent", "0.02 and 10")),
    **{
        f"{name} {value:g} of {kind}": (
            lambda kind=kind, name=name, value=value: element_of(kind, "parameters", **{name: value}),
            (name, "between 1e-06 and 1e+06"),
        )
        for kind in ("memory", "wide")
        for name in ("lag_rate", "inlet_rate", "fast_rate")
        for value in (1e200, 1e-200)
    },
    "saturation 1e200": (
        lambda: element_of("memory", "parameters", inlet_saturation=1e200),
        ("inlet_saturation", "at most 1e+06 in magnitude"),
    ),
    "gains 1e200": (lambda: element_of("memory", "parameters", gains=[1e200] * 17), ("gains", "at most 1e+06")),
    "gains as text": (lambda: element_of("memory", "parameters", gains=["0.1"] * 17), ("gains", "numbers")),
    "loads 1e200": (
        lambda: element_of(
            "wide", "parameters", gain_loads=[0.1, *np.geomspace(1.0, 1e200, rows_of_gains() - 1).tolist()]
        ),
        ("gain_loads[-1]", "between 1e-12 and 1e+12"),
    ),
    "K1 1e200": (lambda: cubic(K1=1e200), ("spring at low", "the units may be wrong")),
    "C1 1e200": (lambda: cubic(C1=1e200), ("damping", "at most 1e+15 in magnitude")),
    "K 1e200": (lambda: power(K=1e200), ("spring at low", "the units may be wrong")),
    "F0 1e200": (lambda: power(F0=1e200), ("spring at low", "the units may be wrong")),
    "u0 1e200": (lambda: power(u0=1e200), ("spring at low", "the units may be wrong")),
    "exponent of a power 1e200": (lambda: power(n=1e200), ("spring", "must be")),
    # rotors and bearings
    "unbalance in g mm": (
        lambda: jeffcott(unbalance=2000.0),
        ("unbalance", "at most 0.02 kg m", "in g mm? then 0.002 kg m"),
    ),
    "unbalance of a disc": (
        lambda: rm.Disc(position=0.1, mass=2.0, unbalance=2000.0),
        ("unbalance", "at most 0.02 kg m", "in g mm? then 0.002 kg m"),
    ),
    "unbalance of matrices": (
        lambda: rm.Rotor(
            mass=np.eye(2),
            stiffness=np.eye(2),
            mounts=(rm.ContactMount(0.0, contact=cubic(), x=0, y=1),),
            unbalances=(rm.Unbalance(x=0, y=1, amount=2000.0),),
        ),
        ("unbalances[0].amount", "at most 2 kg m", "in g mm? then 0.002 kg m"),
    ),
    "shaft as text": (lambda: rm.Shaft(length=0.3, diameter="0.02"), ("diameter", "numbers")),
    "matrix as text": (
        lambda: rm.Rotor(mass=[["1"]], stiffness=[[1.0]], mounts=()),
        ("mass", "numbers"),
    ),
    "springs that are true": (lambda: LinearBearing(np.eye(2) > 0.0, np.eye(2)), ("stiffness", "numbers")),
    "speeds masked": (lambda: rm.SpeedProfile(MASKED, np.ones(20)), ("t", "without a masked one")),
    "dry and crushed": (
        lambda: rm.BallBearing.catalogue("6205").equilibrium((0.0, -1e6), speed_rpm=1000.0),
        ("load", "a ball carries at most", "5 GPa, beyond which no steel stays elastic"),
    ),
    # operating points
    "L hardly above 0": (
        lambda: solve_steady(MoesPoint(200, 1e-320, 0.5)),
        ("L", "0, or between 1e-06 and 40, what"),
    ),
    "a tuple for a point": (lambda: solve_steady((200, 10, 0.5)), ("point", "a MoesPoint or an OperatingPoint")),
    "a law of others": (
        lambda: MoesPoint(200, 10, 0.5, viscosity="Roelands"),
        ("viscosity", "one of roelands, barus"),
    ),
    "nearly a line": (lambda: Geometry(0.004, 900.0), ("radius_x/radius_y", "such that 1e-3 < kappa < 1e3")),
    "pitch below ball": (
        lambda: bearing(pitch_diameter=5e-3),
        ("pitch_diameter", "above ball_diameter = 0.00794"),
    ),
    "conformity of the radius": (lambda: bearing(conformity=0.5), ("conformity", "above 0.5 (a tighter groove")),
    "eta0 kinematic": (
        lambda: Lubricant(4.2e-5, 2e-8),
        ("eta0", "> 6.31e-5 Pa s for Roelands' law", "in m2/s? then 0.03654 Pa s"),
    ),
    # regions, grids, motions
    "motion before the point": (
        lambda: simulate(FreeVibration(Omega_n=5.0), point()),
        ("motion", "a motion such as FreeVibration or"),
    ),
    "Omega_n in rad/s of a bearing": (
        lambda: simulate(point(), FreeVibration(Omega_n=3e5)),
        ("Omega_n", "between 1e-06 and 1000 (in units", "in units of u_sum/(2a"),
    ),
    "loads that pull": (
        lambda: PrescribedLoad([0.0, 1.0, 2.0, 3.0], [1.0, 1.0, -1.0, 1.0]),
        ("values", "loads > 0 (the contact must stay"),
    ),
    "snapshot later": (
        lambda: simulate(
            point(), FreeVibration(Omega_n=5.0), time=TimeSteps(until=1.0), keep=KeepSettings(snapshots=(2.0,))
        ),
        ("snapshots", "at most until = 1.0"),
    ),
    "ridge of no width": (lambda: TransverseRidge(0.1, 0.0), ("width", "a finite number > 0")),
    "dent in words": (lambda: Dent("deep", 0.5), ("depth", "a finite number")),
    "roughness of no height": (lambda: Roughness.synthetic(0.0, 0.5, 0.1), ("rq", "a finite number > 0")),
    "roughness in words": (lambda: Roughness("rough", 0.1, 0.1, 0.5), ("heights", "a table of numbers")),
    "roughness with holes": (
        lambda: Roughness.measured(np.full((9, 9), np.nan), 0.1, 0.1, 0.5),
        ("heights", "finite: fill in what is missing"),
    ),
    "waves of no length": (lambda: Waviness(0.1, 0.0), ("wavelength", "a finite number > 0")),
    "frequency without its unit": (
        lambda: impedance(point(), [50.0]),
        ("frequency", "Omega (dimensionless), omega (rad/s), hz or rpm"),
    ),
    "Omega of a bearing": (
        lambda: rm.BallBearing.catalogue("6205").coefficients((0.0, -500.0), speed_rpm=3000.0, Omega=1.0),
        ("Omega = 1.0", "omega (rad/s), hz or rpm: there is no unit of time"),
    ),
    "frequency of a bearing without its unit": (
        lambda: rm.BallBearing.catalogue("6205").coefficients((0.0, -500.0), 50.0),
        ("frequency = 50.0", "named with its unit: omega (rad/s), hz or rpm"),
    ),
    "full contact backwards": (
        lambda: full_contact().advance(-1.0, 0.8, 0.0),
        ("dt", "a finite number > 0"),
    ),
    # files
    "load a folder": (lambda: read(Path(__file__).parent), ("file", "a readable result, element or bearing")),
    "load a script": (lambda: read(__file__), ("file", "a complete file of a result")),
    "load an archive": (
        lambda: read(archive()),
        ("file", "JSON or HDF5 as `save` writes it; this one is a zip archive, as FMUs are"),
    ),
    "radii exchanged": (
        lambda: solve_steady(OperatingPoint(Geometry(0.1032, 0.00316), OIL, load=486.0, u_sum=5.88)),
        ("kappa = 9.345", "radius_x is that along rolling; are both exchanged? then kappa = 0.107"),
    ),
    "load a number": (lambda: read(5), ("file", "the name of a file")),
    "save a number": (lambda: save(5, "none.h5"), ("object to save", "result, element or bearing")),
    "load an element of Python": (
        lambda: read(__file__, ContactElement),
        ("file", "a complete file of a contact element"),
    ),
    "an atlas of Python": (lambda: rm.Atlas(__file__), ("atlas", "a complete file of a table of an atlas")),
    # elements, fits, atlas
    "damping below 0": (lambda: cubic(C1=-0.01), ("C1", "a finite number >= 0")),
    "range that falls": (lambda: cubic(low=1.0, high=0.7), ("low", "below high = 0.7")),
    "record too short": (lambda: record(t=[0.0, 1.0]), ("length of t", "at least 4")),
    "record of two lengths": (lambda: record(force=LINE[:-1]), ("length of force", "20")),
    "record back in time": (lambda: record(t=LINE[::-1]), ("t[1]", "above t[0] = 1.0")),
    "record nan": (lambda: record(force=LINE * np.nan), ("force[0]", "a finite number")),
    "fit nothing": (lambda: rm.fit([]), ("records", "at least one record")),
    "fit a file name": (lambda: rm.fit("r.h5"), ("records[0]", "a ContactRecord;")),
    "fit model": (lambda: rm.fit(record(), "quartic"), ("model", "one of linear, cubic, polynomial,")),
    "atlas point": (lambda: rm.Atlas().at((200, 10, 0.5)), ("point", "a MoesPoint or an OperatingPoint")),
    # FMUs
    "export for no platform": (
        lambda: fmu.export(cubic(), "x.fmu", platforms=["linux64", "win32"]),
        ("platforms", "'win32'", "aarch64-darwin or all"),
    ),
    "export nowhere": (lambda: fmu.export(cubic(), "/none/x.fmu"), ("path", "in a folder that exists")),
    "verify a file of text": (
        lambda: fmu.verify_references(__file__),
        ("path", "a readable FMU (File is not a zip file)"),
    ),
    "verify nothing": (lambda: fmu.verify("/none/x.fmu", cubic()), ("path", "a readable FMU ([Errno 2] No such")),
}
