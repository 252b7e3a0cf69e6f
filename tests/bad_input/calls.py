"""Python calls with bad input: what a script of a user may hold."""

from functools import cache
from pathlib import Path

import numpy as np

import fmu
import reduced_models as rm
from ehlcontact import (
    Dent,
    Domain,
    FreeVibration,
    FullContact,
    Geometry,
    Grid,
    HarmonicLoad,
    KeepSettings,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    Roughness,
    TimeSteps,
    TransverseRidge,
    Waviness,
    impedance,
    load,
    save,
    simulate,
    solve_steady,
)

OIL = Lubricant(0.0367, 2e-8)
BALL = {
    "ball_diameter": 7.94e-3,
    "pitch_diameter": 39.04e-3,
    "conformity": 0.52,
    "speed_rpm": 3000.0,
    "load": 34.0,
}
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
    return FullContact(point(), grid=Grid(n=32))


def record(**changes):
    columns = {"T": LINE, "approach": 0.8 + 0.1 * LINE, "rate": 0.1 + 0.0 * LINE, "force": 1.0 + LINE}
    return rm.ContactRecord(**(columns | changes))


def cubic(**changes):
    return rm.CubicContact(**({"K1": 1.0, "K2": 0.1, "K3": 0.1, "C1": 0.01, **BOX} | changes))


CALLS = {
    # operating points
    "kappa of Ry/Rx": (lambda: solve_steady(MoesPoint(200, 10, 12.0)), ("kappa", "between 0.04 and 8, what the")),
    "M of newtons": (lambda: solve_steady(MoesPoint(1e6, 10, 0.5)), ("M", "between 0.1 and 60000, what the")),
    "L of a soft oil": (lambda: solve_steady(MoesPoint(200, 60, 0.5)), ("L", "between 0 and 40, what the")),
    "L hardly above 0": (
        lambda: solve_steady(MoesPoint(200, 1e-320, 0.5)),
        ("L", "0, or between 1e-06 and 40, what"),
    ),
    "alpha in 1/GPa": (
        lambda: solve_steady(MoesPoint(200, 10, 0.5, alpha=22.0)),
        ("alpha", "between 1e-10 and 1e-06 1/Pa (in", "in 1/GPa? then 2.2e-08 1/Pa"),
    ),
    "eta0 in mPa s": (
        lambda: solve_steady(MoesPoint(200, 10, 0.5, eta0=40.0)),
        ("eta0", "between 0.0001 and 5 Pa s (in", "in mPa s? then 0.04 Pa s"),
    ),
    "a tuple for a point": (lambda: solve_steady((200, 10, 0.5)), ("point", "a MoesPoint or an OperatingPoint")),
    "a law of others": (
        lambda: MoesPoint(200, 10, 0.5, viscosity="Roelands"),
        ("viscosity", "one of roelands, barus"),
    ),
    "radius in mm": (
        lambda: Geometry(4.0, 20.0),
        ("radius_x", "between 1e-05 and 1 m (in mm?", "in mm? then 0.004 m"),
    ),
    "E in GPa": (
        lambda: Geometry(0.004, 0.02, e1=206.0),
        ("e1", "between 1e+06 and 2e+12 Pa (in", "in GPa? then 2.06e+11 Pa"),
    ),
    "nearly a line": (lambda: Geometry(0.004, 900.0), ("radius_x/radius_y", "such that 1e-3 < kappa < 1e3")),
    "ball in mm": (
        lambda: bearing(ball_diameter=7.94),
        ("ball_diameter", "between 0.0001 and 0.5 m (in mm?", "in mm? then 0.00794 m"),
    ),
    "ball in um": (lambda: bearing(ball_diameter=7.94e-6), ("ball_diameter", "between 0.0001 and 0.5 m")),
    "pitch in mm": (
        lambda: bearing(pitch_diameter=39.04),
        ("pitch_diameter", "between 0.0005 and 10 m (in mm?", "in mm? then 0.03904 m"),
    ),
    "pitch below ball": (
        lambda: bearing(pitch_diameter=5e-3),
        ("pitch_diameter", "above ball_diameter = 0.00794"),
    ),
    "conformity in %": (
        lambda: bearing(conformity=52.0),
        ("conformity", "above 0.5 (a tighter groove", "in %? then 0.52"),
    ),
    "conformity of the radius": (lambda: bearing(conformity=0.5), ("conformity", "above 0.5 (a tighter groove")),
    "load in GN": (lambda: solved(load=3.4e7), ("M", "between 0.1 and 60000, what the")),
    "load in MN": (lambda: solved(load=3.4e4), ("M", "between 0.1 and 60000, what the")),
    "eta0 in mPa s, SI": (
        lambda: bearing(Lubricant(36.7, 2e-8)),
        ("eta0", "between 0.0001 and 5 Pa s (in", "in mPa s? then 0.0367 Pa s"),
    ),
    "eta0 kinematic": (
        lambda: Lubricant(4.2e-5, 2e-8),
        ("eta0", "> 6.31e-5 Pa s for Roelands' law", "in m2/s? then 0.03654 Pa s"),
    ),
    "alpha in 1/GPa, SI": (
        lambda: bearing(Lubricant(0.0367, 20.0)),
        ("alpha", "between 1e-10 and 1e-06 1/Pa (in", "in 1/GPa? then 2e-08 1/Pa"),
    ),
    "alpha 0, SI": (lambda: bearing(Lubricant(0.0367, 0.0)), ("alpha", "a finite number > 0")),
    "grade": (lambda: Lubricant.iso_vg(70, temperature=50.0), ("iso_vg", "one of 10, 15, 22, 32, 46, 68,")),
    "grade in words": (
        lambda: Lubricant.iso_vg("68", temperature=50.0),
        ("iso_vg", "one of 10, 15, 22, 32, 46, 68,"),
    ),
    "temperature in K": (
        lambda: Lubricant.iso_vg(68, temperature=323.0),
        ("temperature", "between 20 and 120 (degrees"),
    ),
    "viscosity index": (
        lambda: Lubricant.iso_vg(68, temperature=50.0, viscosity_index=160.0),
        ("viscosity_index", "between 80 and 120, as mineral"),
    ),
    "density in g/cm3": (
        lambda: Lubricant.iso_vg(68, temperature=50.0, density_15=0.87),
        ("density_15", "between 800 and 950 kg/m3 (given", "given in g/cm3?"),
    ),
    # regions, grids, motions
    "region inside out": (lambda: Domain(1.5, -4.5, 3.0), ("x_in", "between -100 and -1.2 (left of")),
    "motion before the point": (
        lambda: simulate(FreeVibration(Omega_n=5.0), point()),
        ("motion", "a motion such as FreeVibration or"),
    ),
    "Omega_n in rad/s of a bearing": (
        lambda: simulate(point(), FreeVibration(Omega_n=3e5)),
        ("Omega_n", "between 1e-06 and 1000 (in units", "in units of u_sum/(2a"),
    ),
    "amplitude in %": (lambda: HarmonicLoad(Omega=3.0, amplitude=10.0), ("amplitude", "above 0 and below 1 (")),
    "ramp to nothing": (lambda: RampLoad(0.0, 1.0, Omega_n=2.4), ("ratio", "a finite number > 0")),
    "times that fall": (lambda: PrescribedLoad([0.0, 2.0, 1.0, 3.0], [1.0] * 4), ("T[2]", "above T[1] = 2.0")),
    "loads that pull": (
        lambda: PrescribedLoad([0.0, 1.0, 2.0, 3.0], [1.0, 1.0, -1.0, 1.0]),
        ("values", "loads > 0 (the contact must stay"),
    ),
    "approaches too few": (lambda: PrescribedApproach([0.0], [0.9]), ("length of T", "at least 4")),
    "approaches and times": (
        lambda: PrescribedApproach([0.0, 1.0, 2.0, 3.0], [0.9] * 3),
        ("length of values", "4"),
    ),
    "until before dt": (
        lambda: simulate(point(), FreeVibration(Omega_n=5.0), time=TimeSteps(until=0.1, dt=1.0)),
        ("dt", "at most until = 0.1"),
    ),
    "error in %": (
        lambda: simulate(point(), FreeVibration(Omega_n=5.0), time=TimeSteps(local_error=5.0)),
        ("local_error", "between 1e-08 and 0.1"),
    ),
    "snapshot later": (
        lambda: simulate(
            point(), FreeVibration(Omega_n=5.0), time=TimeSteps(until=1.0), keep=KeepSettings(snapshots=(2.0,))
        ),
        ("snapshots", "at most until = 1.0"),
    ),
    "ridge of no width": (lambda: TransverseRidge(0.1, 0.0), ("width", "a finite number > 0")),
    "dent in words": (lambda: Dent("deep", 0.5), ("depth", "a finite number")),
    "roughness of no height": (lambda: Roughness.synthetic(0.0, 0.5, 0.1), ("sigma", "a finite number > 0")),
    "roughness in words": (lambda: Roughness("rough", 0.1, 0.1, 0.5), ("heights", "a table of numbers")),
    "roughness with holes": (
        lambda: Roughness.measured(np.full((9, 9), np.nan), 0.1, 0.1, 0.5),
        ("heights", "finite: fill in what is missing"),
    ),
    "roughness finer than the mesh": (
        lambda: simulate(
            point(),
            FreeVibration(Omega_n=5.0),
            grid=Grid(n=64),
            surface=Roughness.synthetic(0.01, 0.5, 0.1, kappa=0.5),
        ),
        ("surface.shortest", "at least 0.75 semi-axes, 4 of the mesh of 0.188: raise n, or smooth the surface"),
    ),
    "waves of no length": (lambda: Waviness(0.1, 0.0), ("wavelength", "a finite number > 0")),
    "frequency below 0": (lambda: impedance(point(), Omega=[-1.0]), ("Omega", "finite, >= 0 and <= 200")),
    "frequency without its unit": (
        lambda: impedance(point(), [50.0]),
        ("frequency", "Omega (dimensionless), omega (rad/s), hz or rpm"),
    ),
    "full contact backwards": (
        lambda: full_contact().advance(-1.0, 0.8, 0.0),
        ("dt", "a finite number > 0"),
    ),
    # files
    "load a folder": (lambda: load(Path(__file__).parent), ("file", "a readable result, element or bearing")),
    "load a script": (lambda: load(__file__), ("file", "a complete file of a result")),
    "load a number": (lambda: load(5), ("file", "the name of a file")),
    "save a number": (lambda: save(5, "none.h5"), ("object to save", "result, element or bearing")),
    "load an element of Python": (
        lambda: load(__file__, rm.ContactElement),
        ("file", "a complete file of a contact element"),
    ),
    "an atlas of Python": (lambda: rm.Atlas(__file__), ("atlas", "a complete file of a table of an atlas")),
    # elements, fits, atlas
    "K1 in words": (lambda: cubic(K1="1"), ("K1", "a finite number")),
    "damping below 0": (lambda: cubic(C1=-0.01), ("C1", "a finite number >= 0")),
    "range that falls": (lambda: cubic(low=1.0, high=0.7), ("low", "below high = 0.7")),
    "units": (lambda: cubic(units="mm"), ("units", "one of dimensionless, SI")),
    "record too short": (lambda: record(T=[0.0, 1.0]), ("length of T", "at least 4")),
    "record of two lengths": (lambda: record(force=LINE[:-1]), ("length of force", "20")),
    "record back in time": (lambda: record(T=LINE[::-1]), ("T[1]", "above T[0] = 1.0")),
    "record nan": (lambda: record(force=LINE * np.nan), ("force[0]", "a finite number")),
    "fit nothing": (lambda: rm.fit([]), ("records", "at least one record")),
    "fit a file name": (lambda: rm.fit("r.h5"), ("records[0]", "a ContactRecord;")),
    "fit twice": (lambda: rm.fit([record(), record()]), ("records[1]", "another one: each counts once")),
    "fit model": (lambda: rm.fit(record(), "quartic"), ("model", "one of linear, cubic, polynomial,")),
    "fit window": (lambda: rm.fit(record(), window=(1.0, 0.0)), ("start", "below end = 0.0")),
    "atlas point": (lambda: rm.Atlas().at((200, 10, 0.5)), ("point", "a MoesPoint or an OperatingPoint")),
    "atlas light": (lambda: rm.Atlas().element(MoesPoint(0.5, 10, 0.5)), ("M", "between 1 and 30000, the box of")),
    "atlas model": (lambda: rm.Atlas().element(point(), "linear"), ("model", "one of memory, wide, cubic")),
    "atlas oil": (
        lambda: rm.Atlas().element(MoesPoint(200, 10, 0.5, eta0=3.0)),
        ("eta0", "between 0.002 and 1 Pa s, the", "in mPa s? then 0.003 Pa s"),
    ),
    "atlas law": (
        lambda: rm.Atlas().at(MoesPoint(200, 10, 0.5, viscosity="barus")),
        ("viscosity", "roelands, the law of the atlas"),
    ),
    # FMUs
    "export a file name": (
        lambda: fmu.export_contact("e.json", "x.fmu"),
        ("element", "a contact element"),
    ),
    "export a version": (
        lambda: fmu.export_contact(cubic(), "x.fmu", fmi=4),
        ("fmi", "2 or 3"),
    ),
    "export a name": (
        lambda: fmu.export_contact(cubic(), "x.fmu", model_name=""),
        ("model_name", "1 to 100 printable characters"),
    ),
    "export for no platform": (
        lambda: fmu.export_contact(cubic(), "x.fmu", platforms=["linux64", "win32"]),
        ("platforms", "'win32'", "aarch64-darwin or all"),
    ),
    "export nowhere": (lambda: fmu.export_contact(cubic(), "/none/x.fmu"), ("path", "in a folder that exists")),
    "verify a file of text": (
        lambda: fmu.verify_references(__file__),
        ("path", "a readable FMU (File is not a zip file)"),
    ),
    "verify nothing": (lambda: fmu.verify("/none/x.fmu", cubic()), ("path", "a readable FMU ([Errno 2] No such")),
}
