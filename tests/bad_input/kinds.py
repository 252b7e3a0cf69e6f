"""Bad arguments by kind: units, flags, text and True in columns, objects where lists belong, paths, callbacks.

`ARGUMENTS` has for each call good arguments and, by name,
    groups of bad values; every pair is a case. `CALLS` are
single ones.
"""

from functools import cache
from math import inf, nan

import numpy as np
import pandas as pd
from balls import OF_6205

import ehlcontact as ehl
import fmu
import reduced_models as rm
from ehlcontact import Lubricant
from ehlcontact.film import interferogram
from ehlcontact.lubricant import Eyring
from reduced_models.bearing.cage_slip import cage_slip
from reduced_models.bearing.oil_balance import OilBalance
from reduced_models.bearing.sliding import bearing_friction
from reduced_models.rotor.compare import compare
from reduced_models.rotor.decay import log_decrement
from reduced_models.rotor.rotor import Parameter
from reduced_models.signals import records, sampling, transfer_path

HUGE = 10**400
NO_NUMBER = (nan, inf, True, "1", None, [1.0, 2.0], 1j, HUGE, b"1")
NO_FLAG = ("no", "yes", 0, 1, 1.0, None, [], "False")
NO_PATH = (5, b"x", "", "a\0b", None, 1.5, ["x"], "x" * 300)
NO_CALL = (3, "print", [print], 1.0)
NO_NAME = (5, None, b"x", ["a"], 1.5)
TEXT, TRUE = ["1", "2"], [1.0, True]
NO_COLUMN = (
    TEXT, TRUE, pd.Series(TEXT), pd.Series(TRUE, dtype=object), np.array(TEXT, object), np.array(TRUE, object),
    memoryview(b"12"), bytearray(b"12"), np.array(["1", "2"]), {1.0, 2.0}, {"a": 1.0}, [nan, 1.0], [1j, 2.0],
        "12",
)  # fmt: skip
SHAFT = {"length": 0.3, "diameter": 0.02}
DISC = {"position": 0.15, "mass": 2.0, "diametral_inertia": 1e-3, "polar_inertia": 1e-3}
BALLS = {"balls": 9, "ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3}
EYE, OUT = np.eye(2), OF_6205 | {"speed_rpm": 3000.0, "load": 34.0}


@cache
def dry():
    return rm.BallBearing(**BALLS)


@cache
def spindle():
    return rm.BallBearing(**BALLS, contact_angle=0.26)


@cache
def wet():
    return rm.BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))


def shaft(**changes):
    return rm.Shaft(**(SHAFT | changes))


def support(**changes):
    return rm.Support(**({"position": 0.0, "bearing": dry()} | changes))


def housed(**changes):
    return support(**({"housing_mass": 1.0, "housing_stiffness": 1e7} | changes))


def sprung(**changes):
    return rm.Support(**({"position": 0.0, "bearing": spindle(), "preload": 100.0} | changes))


def disc(**changes):
    return rm.Disc(**(DISC | changes))


def cylinder(**changes):
    return rm.Disc.cylinder(**({"position": 0.1, "diameter": 0.2, "width": 0.03} | changes))


def ball_bearing(**changes):
    return rm.BallBearing(**(BALLS | changes))


def pair(**changes):
    return rm.BearingSet.pair(**({"bearing": spindle()} | changes))


def bearing_set(**changes):
    good = {"bearings": [spindle()] * 2, "facings": ("+z", "-z"), "positions": (-0.02, 0.02)}
    return rm.BearingSet(**(good | changes))


def spall(**changes):
    return rm.Spall(**({"race": "outer", "angle": 0.0, "length": 1e-3, "depth": 1e-5} | changes))


def dent(**changes):
    return rm.Indentation(**({"race": "outer", "angle": 0.0, "length": 1e-3, "depth": 1e-5} | changes))


def waves(**changes):
    return rm.RaceWaviness(**({"race": "outer", "waves": 9, "amplitude": 1e-6} | changes))


def larger(**changes):
    return rm.BallDiameter(**({"ball": 0, "excess": 1e-6} | changes))


def path(**changes):
    return transfer_path.ModalPath(**({"hz": [900.0, 2e3], "damping": [0.05, 0.05], "mass": [3.0, 3.0]} | changes))


def case(**changes):
    good = {"bearing": wet(), "load": (0.0, -500.0), "speed_rpm": 1500.0, "path": path(), "label": "new"}
    return records.RecordCase(**(good | changes))


@cache
def balance():
    return OilBalance(bearing=wet(), load=(0.0, -500.0), speed_rpm=1500.0)


def linear():
    return rm.LinearBearing(1e8 * EYE, 1e3 * EYE)


def damper(**changes):
    given = {"length": 0.02, "radius": 0.06, "clearance": 1e-4, "viscosity": 0.01}
    return rm.SqueezeFilmDamper(**(given | changes))


def rotor(**changes):
    mounts = (rm.BearingMount(bearing=linear(), x=0, y=1),)
    return rm.Rotor(**({"mass": EYE, "stiffness": 0.0 * EYE, "mounts": mounts} | changes))


def on_bearings(**changes):
    ends = [rm.Support(position=at, bearing=linear()) for at in (0.0, 0.3)]
    return rm.rotor_on_bearings(**({"shaft": shaft(), "supports": ends, "discs": [disc()]} | changes))


@cache
def standing():
    return on_bearings()


def run(**changes):
    return rm.simulate_rotor(**({"rotor": standing(), "speed_rpm": 1e3, "dt": 1e-4, "until": 1e-3} | changes))


def modes(**changes):
    return rm.linearise(**({"rotor": standing(), "speed_rpm": 1e3} | changes))


def speeds(call):
    return lambda **changes: call(**({"rotor": standing(), "speeds_rpm": [1e3, 2e3]} | changes))


def made(**changes):
    return records.make_records(**({"cases": [case()], "folder": "records"} | changes))


def written(**changes):
    signal = records.VibrationRecord(signal=np.zeros(5), rate=1e3, columns={"n_samples": 5, "signal_id": "a"})
    return records.write_dataset(**({"records": [signal], "folder": "records"} | changes))


def exported(**changes):
    return fmu.export(**({"model": cubic(), "path": "x.fmu"} | changes))


def cubic():
    return rm.SpringContact.cubic(K1=1.0, K2=0.1, K3=0.1, C1=0.01, low=0.7, high=1.0)


@cache
def ended():
    """A short run of a film."""
    steps = ehl.TimeSteps(until=0.2, dt=0.1, tol=1e-2)
    return ehl.simulate(ehl.MoesPoint(20, 5, 1), ehl.FreeVibration(Omega_n=5.0), grid=ehl.Grid(n=16), time=steps)


def asperities(name):
    return lambda **changes: getattr(ehl.Asperities(1e-7), name)(**(ARGUMENTS_OF[name] | changes))


ARGUMENTS_OF = {
    "pressure": {"gap": 1e-7, "e_reduced": 2e11},
    "stiffness": {"gap": 1e-7, "e_reduced": 2e11},
    "load_share": {"h_central": 1e-7, "mean_pressure": 1e9, "e_reduced": 2e11},
}
MILLIMETRES, MICROMETRES = (300.0, 2e4), (10.0, 200.0)
FORCES = (1e12, -1e12)

ARGUMENTS = [
    (shaft, {
        "length": (*MILLIMETRES, 0.0, *NO_COLUMN), "diameter": (20.0, -0.02, *NO_COLUMN), "bore": (15.0, nan,
        "x"),
        "youngs_modulus": (206.0, 2.06e5, 0.0, *NO_NUMBER), "density": (7.8, 2.7, -1.0, *NO_NUMBER),
        "damping_time": (20.0, *NO_NUMBER), "shear": NO_FLAG, "poisson_ratio": (30.0, True, "x"),
        "elements": (0, 1e3, 10**9, "8", True),
    }),
    (lambda **k: rm.Shaft.jeffcott(**({"stiffness": 1e8, "span": 0.3} | k)),
        {"stiffness": (1e-6, 1e30, *NO_NUMBER), "span": (300.0, *NO_NUMBER), "damping": (-1.0, "x", True)}),
    (disc, {
        "position": (150.0, *NO_NUMBER), "mass": (1e-9, 1e12, *NO_NUMBER),
        "diametral_inertia": (1000.0, -1.0, *NO_NUMBER), "polar_inertia": (1000.0, True), "damping": (1e20,
        "x"),
        "unbalance": (2000.0, True, "x", nan), "phase": (90.0, True, "x"),
        "load": (FORCES, (1e12, 0.0), 5.0, *NO_COLUMN),
    }),
    (cylinder, {"diameter": (200.0, "x"), "width": (30.0, True), "density": (7.8, nan, None), "bore": (50.0,
        "x")}),
    (support, {
        "position": (150.0, *NO_NUMBER), "preload": (1e12, -1.0, "x", True), "journal_mass": (1e12, "x", True),
        "preload_stiffness": (1e30, -1.0, "x"), "outer_ring_mass": (1e12, 0.0, "x"), "offset": (10.0, "x",
        True),
        "bearing": ("6205", None, 5, [5]), "facing": ("z", 1, None), "cage_angle": (90.0, "x", True),
    }),
    (housed, {
        "housing_mass": (1e12, 0.0, "x", True), "housing_stiffness": (1e-9, 1e30, "x", True, TEXT, TRUE),
        "housing_damping": (1e20, "x", True, TEXT),
    }),
    (sprung, {"preload": (1e12, nan, "x"), "preload_stiffness": (1e30, True)}),
    (ball_bearing, {
        "ball_diameter": (7.94, True, "x"), "pitch_diameter": (39.04, *NO_NUMBER), "density": (7.8, 0.0,
        *NO_NUMBER),
        "youngs_modulus": (206.0, True, "x"), "clearance": (10.0, True, "x", nan), "cutoff_gap": (10.0, 0.0,
        True, "x"),
        "rq_ball": (0.1, True, "x"), "rq_race": (True, "x"), "contact_angle": (25.0, True, "x"),
        "loss_factor": (True, "x"), "ball_inertia": NO_FLAG, "name": NO_NAME, "conformity_inner": (52.0, True,
        1.04, "x"),
        "conformity_outer": (True, "x", nan), "poisson_ratio": (True, "x"), "features": (5, "x", [5]),
        "shoulder_inner": (35.0, True, "x"), "shoulder_outer": (True, "x"), "balls": (True, "9", 9.0, 2),
        "dynamic_rating": (14.0, 0.0, True, "x"), "static_rating": (7.85, 1e6, True, "x"),
        "atlas": (5, True), "race_control": (True, None), "turning": (True, None, 5.0, "both", (1.0,), (nan, 1.0)),
    }),
    (pair, {
        "distance": (15.0, 0.0, 1e-4, -1.0, *(x for x in NO_NUMBER if x is not None)), "preload": (1e12, 0.0,
        True, "x"),
        "offset": (10.0, True, "x"), "spring": (1e12, True, "x"), "may_lift_off": NO_FLAG, "name": NO_NAME,
        "bearing": ("6205", None, 5), "other": ("6205", 5),
    }),
    (bearing_set, {
        "bearings": (spindle, "ab", 5, [5, 6], None), "positions": ((-15.0, 15.0), 0.02, TEXT, "ab"),
        "offsets": ((10.0, 10.0), 1e-6, TEXT), "facings": ("zz", 5, None), "spring": (1e12, True, "x"),
    }),
    (spall, {
        "length": (True, "x", nan, 0.0, 1e3), "depth": (10.0, True, "x"), "edge": (10.0, True, "x"),
        "angle": (90.0, True, "x"),
    }),
    (dent, {"length": (True, "x"), "depth": (10.0, True), "rim": (10.0, True, "x")}),
    (waves, {"amplitude": (10.0, True, "x", nan), "phase": (90.0, True, "x"), "waves": (True, 2.0, 10**9)}),
    (larger, {"excess": (10.0, True, "x", nan), "ball": (True, 1.0, -1)}),
    (path, {"hz": (*NO_COLUMN, [-1.0, 2.0]), "damping": (*NO_COLUMN, [5.0, 5.0]), "mass": (*NO_COLUMN, [-1.0,
        -2.0])}),
    (case, {
        "seconds": (1e9, 1e6, *NO_NUMBER), "mass": (1e-12, 1e12, *NO_NUMBER), "rate": (12.0, True, "x"),
        "noise": (-1.0, True, "x", nan), "speed_rpm": (1e12, True, "x", HUGE), "load": (*NO_COLUMN, FORCES),
        "label": (5, "", "a b", "x" * 300, None), "seed": (1.0, True, -1), "bearing": ("6205", None),
        "path": (5, None),
    }),
    (lambda **k: balance().feed_for(**k), {"layer": (0.1, 1e3, *NO_NUMBER)}),
    (lambda **k: balance().history(**({"layer": ehl.OilLayer(h=1e-7), "t": [0.0, 1.0]} | k)),
        {"t": ([1.0, 0.0], TEXT, TRUE), "layer": (1e-7, None)}),
    (lambda **k: OilBalance(**({"bearing": wet(), "load": (0.0, -500.0), "speed_rpm": 1500.0} | k)),
        {"speed_rpm": (1e12, True, "x"), "feed": (True, "x"), "load": (TEXT, 5.0, "ab"), "bearing": ("6205",
            None)}),
    (lambda **k: Lubricant(**k),
        {"temperature": (323.0, 1e4, True, "x", nan), "temperature_slope": (True, "x"), "eta0": (40.0, True),
         "alpha": (18.0, 0.018, 1e-11, True, "x"), "rho0": (0.87, True, "x", nan, 0.0)}),
    (lambda **k: ehl.Heat(**k), {"temperature": (323.0, True, "x"), "conductivity": (True, "x")}),
    (lambda **k: rm.Unbalance(**({"x": 0, "y": 1, "amount": 1e-4} | k)),
        {"amount": (1e9, True, "x", nan), "phase": (90.0, True, "x")}),
    (lambda **k: rm.SpeedProfile(**({"t": [0.0, 1.0], "speed_rpm": [1e3, 2e3]} | k)),
        {"t": (*NO_COLUMN, [1.0, 0.0]), "speed_rpm": (*NO_COLUMN, [1e9, 1.0])}),
    (lambda **k: rm.SpeedProfile.ramp(**({"first_rpm": 1e3, "last_rpm": 2e3, "seconds": 1.0} | k)),
        {"first_rpm": NO_NUMBER, "last_rpm": (1e9, True), "seconds": (-1.0, *NO_NUMBER)}),
    (rotor, {
        "mass": ([[1.0, 0.5], [0.0, 1.0]], [TEXT, TEXT], -EYE), "gyroscopic": (EYE, [[0.0, 1.0], [1.0, 0.0]]),
        "mounts": (linear, 5, "ab", None, [5]), "unbalances": (5, "x", [5]), "speed_rpm": (1e9, True, "x"),
        "stiffness": ([TRUE, TRUE], "x"), "load": (*NO_COLUMN,), "nodes": (5, ["a"], {"a": 5}),
        "parameters": (5, [5]),
    }),
    (on_bearings, {
        "shaft": (5, None), "supports": (support, 5, "ab", [5, 6], None), "discs": (disc, 5, "x", [5]),
        "gravity": (9.81, TEXT, (0.0, -9810.0), TRUE), "axial": ("no", 1, 0),
    }),
    (run, {
        "rotor": (5, None), "dt": (0.0, -1e-4, True, "x"), "until": (-1.0, True, "x"), "callback": NO_CALL,
        "speed_rpm": (True, "x", HUGE, 1e12), "start": ("x", 5), "tolerance": (True, "x"), "rho_inf": (True,
        "x"),
        "max_iterations": (True, 1.5, "x"),
    }),
    (modes, {"rotor": (5, None), "passage": NO_FLAG, "signed_damping": NO_FLAG, "speed_rpm": (True, "x", HUGE,
        1e12)}),
    (speeds(rm.campbell), {
        "speeds_rpm": (np.linspace(1.0, 1e4, 39_000), *NO_COLUMN), "passage": NO_FLAG, "rotor": (5, None),
        "count": (True, 1.5, "x"),
    }),
    (speeds(rm.unbalance_response), {
        "speeds_rpm": (np.linspace(1.0, 1e4, 39_000), *NO_COLUMN), "passage": NO_FLAG, "rotor": (5, None),
    }),
    (made, {
        "processes": (0, -1, "2", True, 1.5), "cases": (5, "ab", None, [5], case), "folder": NO_PATH,
        "progress": NO_CALL, "scheduler": (5, b"x"),
    }),
    (written, {"records": (5, "ab", None, [5], []), "folder": NO_PATH, "title": NO_NAME}),
    (lambda **k: records.VibrationRecord(**({"signal": np.zeros(3), "rate": 1e3,
        "columns": {"n_samples": 3}} | k)),
        {"signal": ([0.0, 1.0, nan], "abc", None, 5.0), "rate": (0.0, True, "x"), "columns": (5, None)}),
    (lambda **k: sampling.shaft_angle(**({"t": [0.0, 1.0], "speed_rpm": [1e3, 1e3]} | k)),
        {"t": (*NO_COLUMN, [1.0, 0.0], [[0.0], [1.0]]), "speed_rpm": (*NO_COLUMN, [1.0, 2.0, 3.0])}),
    (lambda **k: sampling.housing_acceleration(**({"run": None, "path": path(), "rate": 1e3} | k)),
        {"run": (None, 5, "x")}),
    (lambda **k: bearing_friction(**({"bearing": wet(), "load": (0.0, -500.0), "speed_rpm": 1500.0,
                                     "law": Eyring(5e6)} | k)),
        {"bearing": ("6205", None, 5), "law": (5, None, "x"), "heat": NO_FLAG, "speed_rpm": (True, "x"),
         "load": (TEXT, "ab")}),
    (lambda **k: cage_slip(**({"bearing": wet(), "load": (0.0, -500.0), "speed_rpm": 1500.0,
                              "law": Eyring(5e6)} | k)),
        {"bearing": ("6205", None, 5), "law": (5, None), "drag": (True, "x"), "speed_rpm": (True, "x")}),
    (lambda **k: ehl.PrescribedLoad.from_function(**({"load": lambda T: 1.0, "until": 1.0} | k)),
        {"load": NO_CALL, "steps": (0, -5, 1.5, "x", True, 10**12), "until": (True, "x")}),
    (lambda **k: ehl.SpeedHistory.from_function(**({"speed": lambda T: 1.0, "until": 1.0} | k)),
        {"speed": NO_CALL, "steps": (0, 1.5, "x", True)}),
    (lambda **k: ehl.SpeedHistory([0.0, 1.0, 2.0, 3.0], [1.0] * 4).way(**k), {"T": (nan, True, "x", None)}),
    (lambda **k: ended().dissipated(**k), {"start": (nan, True, "x", None, [0.0]), "end": (nan, "x", None)}),
    (lambda **k: cubic().restore_state(**k), {"state": (5, "x", np.zeros(3))}),
    (lambda **k: ehl.Domain.for_load(**k), {"largest_load": (nan, True, "x", None, -1.0, inf)}),
    (lambda **k: ehl.Domain.for_point(**k), {"point": (5, None, "x", (200, 10, 0.5))}),
    *((asperities(name), {field: (nan, True, "x",
        None, *((206.0,) if field == "e_reduced" else ()))
        for field in ARGUMENTS_OF[name]}) for name in ARGUMENTS_OF),
    (lambda **k: ehl.OperatingPoint.ball_on_flat(**({"lubricant": Lubricant(), "ball_diameter": 0.019,
        "entrainment_speed": 1.0, "load": 30.0} | k)), {"lubricant": ("x", None, 5), "load": (True, "x")}),
    (lambda **k: ehl.OperatingPoint.ball_bearing(**({"lubricant": Lubricant(), **OUT} | k)),
        {"lubricant": ("x", None, 5), "speed_rpm": (HUGE, True)}),
    (lambda **k: interferogram(**({"film": None, "wavelength": 6e-7} | k)), {"film": (None, 5, "x")}),
    (lambda **k: rm.fit_memory(**({"response": None} | k)), {"response": (5, "x"), "records": (5, "x", [5],
        None)}),
    (lambda **k: compare(**({"full": None, "reduced": None} | k)), {"full": (None, 5, "x")}),
    (exported, {
        "path": NO_PATH[:-1], "overwrite": NO_FLAG, "progress": NO_CALL, "model_name": (5, b"x", ["a"]),
        "fmi": (True, "2", 5), "model": (5, None, "x"), "platforms": (5, True),
    }),
    (lambda **k: ehl.RunSettings(**k), {"throw": NO_FLAG, "callback": NO_CALL}),
    (lambda **k: ehl.solve_steady(**({"point": ehl.MoesPoint(200, 10, 0.5)} | k)),
        {"throw": NO_FLAG, "refine": NO_FLAG}),
    (lambda **k: ehl.Roughness(**({"heights": np.eye(9), "dx": 0.1, "dy": 0.1,
        "shortest_wavelength": 0.5} | k)),
        {"periodic": NO_FLAG, "heights": (np.array([TEXT, TEXT]), "x")}),
    (lambda **k: ehl.read(k.pop("file", "none.h5"), **k), {"file": NO_PATH, "kind": ("x", 5, None)}),
    (lambda **k: ehl.save(**({"record": dry(), "path": "x.json"} | k)), {"path": NO_PATH}),
    (lambda **k: log_decrement(**({"t": np.arange(9.0), "signal": np.ones(9), "omega": 1.0} | k)),
        {"t": (np.arange(9.0)[::-1], TEXT, TRUE), "signal": (TEXT, "x"), "omega": (True, "x", nan)}),
    (lambda **k: rm.LinearBearing(**({"stiffness": 1e8 * EYE, "damping": EYE} | k)),
        {"stiffness": ([TEXT, TEXT], [TRUE, TRUE], "x", None), "speeds_rpm": (TEXT, TRUE, [2.0, 1.0], 5.0),
         "name": NO_NAME}),
    (damper,
        {**dict.fromkeys(("length", "clearance", "viscosity"), NO_NUMBER), "radius": NO_NUMBER[:4],
         "stiffness": (*NO_NUMBER, -1.0, 1e20), "leakage": (*NO_NUMBER, 2.0, -0.1), "seals": (5, None, "shut"),
         "cavitation": NO_FLAG, "groove": NO_FLAG, "name": NO_NAME}),
    (lambda **k: damper().forces(**({"displacement": (0.0, 0.0), "velocity": (0.0, 0.0)} | k)),
        {"displacement": (TEXT, "x", None, (0.0, nan), 1e-5),
         "velocity": (TEXT, "x", (0.0, inf), (1.0, 2.0, 3.0), np.zeros((3, 2)).T)}),
    (lambda **k: damper().eccentricity(**k), {"displacement": (TEXT, "x", None, 1e-5)}),
    (lambda **k: damper().circular_orbit(**({"eccentricity": 0.5, "omega": 100.0} | k)),
        {"eccentricity": (0.0, 1.0, True, "x"), "omega": (True, "x", nan)}),
    (lambda **k: dry().equilibrium(**({"load": (0.0, -500.0)} | k)),
        {"load": (*NO_COLUMN, None, 5.0, FORCES), "speed_rpm": (-1e9, True, "x", HUGE, nan),
         "cage_angle": (90.0, True, "x"), "tilt": (5.0, TEXT)}),
    (lambda **k: Parameter(**({"name": "a", "unit": "kg", "text": "b", "value": 1.0} | k)),
        {"positive": NO_FLAG, "value": (True, "x", None), "parts": (5, "x")}),
]  # fmt: skip


def pits():
    """Two spalls at one place, each as deep as a ball is allowed to have them, are deeper together."""
    deep = spall(length=5e-3, depth=3e-3)
    return ball_bearing(features=[deep, spall(length=5e-3, depth=3e-3, angle=0.01)])


def pint_mixed():
    pint = __import__("pint").UnitRegistry()
    return shaft(length=[0.1, 100.0 * pint.mm], diameter=0.02)


CALLS = {
    "spalls deeper than a ball together": (pits, "depth"),
    "a quantity after a number": (pint_mixed, "length[0]"),
}

GUESSES = [  # the unit that a value was probably given in, and what it is then
    (lambda: shaft(youngs_modulus=206.0), "youngs_modulus", "GPa? then 2.06e+11 Pa"),
    (lambda: shaft(diameter=[20.0]), "diameter", "mm? then 0.02 m"),
    (lambda: shaft(density=7.8), "density", "g/cm3? then 7800 kg/m3"),
    (lambda: ball_bearing(density=7.8), "density", "g/cm3? then 7800 kg/m3"),
    (lambda: ball_bearing(pitch_diameter=39.04), "pitch_diameter", "mm? then 0.03904 m"),
    (lambda: ball_bearing(cutoff_gap=10.0), "cutoff_gap", "µm? then 1e-05 m"),
    (lambda: pair(distance=15.0), "distance", "mm? then 0.015 m"),
    (lambda: bearing_set(positions=(-15.0, 15.0)), "positions[0]", "mm? then -0.015 m"),
    (lambda: balance().feed_for(0.1), "layer", "µm? then 1e-07 m"),
    (lambda: spall(depth=10.0), "depth", "µm? then 1e-05 m"),
    (lambda: Lubricant(temperature=323.0), "temperature", "K? then 49.85 degrees Celsius"),
    (lambda: disc(position=150.0), "position", "mm? then 0.15 m"),
]
