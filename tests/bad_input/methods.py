"""Bad arguments of methods, of tools of special fields and of newer parts: groups of values, as in `kinds`."""

from functools import cache

import numpy as np
from bad_input.kinds import (
    HUGE,
    NO_CALL,
    NO_COLUMN,
    NO_FLAG,
    NO_NAME,
    NO_NUMBER,
    NO_PATH,
    TEXT,
    TRUE,
    balance,
    case,
    cubic,
    disc,
    dry,
    ended,
    linear,
    on_bearings,
    path,
    rotor,
    spindle,
    standing,
    wet,
)

import ehlcontact as ehl
import reduced_models as rm
from ehlcontact.film import film_history, track_wave
from ehlcontact.hertz import most_loaded_ball
from ehlcontact.lubricant import Carreau, Eyring, LimitingShear
from ehlcontact.side_flow import layer_after_passes
from reduced_models.bearing.measured_order import angle_from_order, clearance_from_order
from reduced_models.bearing.oil_and_heat import oil_and_heat
from reduced_models.bearing.skf_friction import skf_friction
from reduced_models.fitting.wide_range_fit import wide_range_from_solves
from reduced_models.rotor.baselines import local_contact
from reduced_models.rotor.bearing_films import FullFilm, simulate_full_films
from reduced_models.rotor.decay import log_decrement
from reduced_models.rotor.events import contact_events
from reduced_models.rotor.linear_contact import film_impedance, impedance_about
from reduced_models.rotor.machine_state import machine_state, single_bearing_state
from reduced_models.rotor.rotor import Parameter
from reduced_models.rotor.settling import settling
from reduced_models.rotor.support_state import support_state
from reduced_models.signals import records

NO_OBJECT = (5, "x", None, [5], True)
NO_INDEX = (True, 1.5, "x", -1)
NO_COMPLEX = (TEXT, TRUE, None, "x", [np.nan])
LOAD, TIMES = (0.0, -500.0), [0.0, 1.0, 2.0, 3.0]
TABLE = {"T": TIMES, "values": [1.0] * 4}

RATED = {"bore": 25e-3, "outside": 52e-3, "dynamic_rating": 14e3, "static_rating": 7850.0}


@cache
def point():
    oil = ehl.Lubricant.iso_vg(68, temperature=50.0)
    return ehl.OperatingPoint(ehl.Geometry(3.2e-3, 0.1), oil, load=49.0, u_sum=5.9)


@cache
def machine():
    ends = [rm.Support(position=at, bearing=dry()) for at in (0.0, 0.3)]
    return on_bearings(supports=ends, discs=[disc(unbalance=1e-5)])


@cache
def run():
    """A rotor on dry bearings, for twenty steps."""
    return rm.simulate_rotor(machine(), speed_rpm=1e3, dt=1e-4, until=2e-3)


@cache
def at_rest():
    return rm.linearise(standing(), 1e3)


@cache
def moved():
    return rm.BearingMotion(dry(), 1e3, 1e-5, directions=("x", "y"))


def of(thing, name, good=None):
    """A call of a method, with good arguments in place of those that are left out."""
    return lambda **changes: getattr(thing(), name)(**((good or {}) | changes))


def call(function, **good):
    return lambda **changes: function(**(good | changes))


ARGUMENTS = [
    (call(ehl.OperatingPoint, geometry=ehl.Geometry(0.01, 0.02), lubricant=ehl.Lubricant(), load=9.0, u_sum=1.0),
        {"geometry": NO_OBJECT, "lubricant": NO_OBJECT}),
    (of(point, "Omega_n"), {"mass": (*NO_NUMBER, 0.0, -1.0)}),
    (lambda **k: ehl.Lubricant.iso_vg(**({"grade": 68, "temperature": 50.0} | k)),
        {"temperature": (HUGE, 323.0, True), "density_15": (HUGE, 0.875, True)}),
    (call(ehl.OilLayer, over_flooded=[0.5, 0.6], y=[0.0, 1.0]),
        {"over_flooded": ([[1.0, [2.0]]], [[1.0, 2.0], [3.0]], TEXT, TRUE)}),
    (of(lambda: ehl.OilLayer(over_flooded=[0.5, 0.6], y=[0.0, 1.0]), "at"), {"Y": NO_COLUMN}),
    (ehl.Heat, {name: (None, True, "x") for name in ("conductivity", "heat_capacity", "expansion", "slide_roll")}),
    *((of(law, "of", {"log_newton": [1.0, 2.0], "p": [1e9, 1e9]}),
        {"log_newton": (TEXT, TRUE, None), "p": (TEXT, TRUE)})
        for law in (Eyring, Carreau)),
    *((of(law, name), {"log_newton": (TEXT, TRUE, None, "12")}) for law in (Eyring, Carreau)
        for name in ("thinning", "thinning_slopes")),
    (of(LimitingShear, "limit"), {"p": (TEXT, TRUE, None)}),
    (of(lambda: ehl.Asperities(1e-7), "unit"), {"e_reduced": (206.0, 2.06e5, *NO_NUMBER)}),
    (of(lambda: ehl.Asperities(1e-7), "gap", {"pressure": 1e7, "e_reduced": 2e11}),
        {"e_reduced": (206.0, True), "pressure": NO_NUMBER}),
    (call(ehl.FreeVibration, Omega_n=5.0), {"made_at": (5, "x")}),
    (of(lambda: ehl.FreeVibration(Omega_n=5.0), "load"), {"T": NO_NUMBER}),
    (of(lambda: ehl.HarmonicLoad(Omega=5.0), "load"), {"T": NO_NUMBER}),
    (of(lambda: ehl.PrescribedLoad(**TABLE), "load"), {"T": NO_NUMBER}),
    (call(ehl.RampLoad.at, point=point(), load=60.0, duration=1e-3, mass=1.0),
        {"load": (1e12, *NO_NUMBER), "duration": (1e9, *NO_NUMBER), "mass": (1e12, *NO_NUMBER)}),
    (call(ehl.PrescribedLoad.at, point=point(), t=[0.0, 1e-4, 2e-4, 3e-4], load=[49.0] * 4),
        {"load": (*NO_COLUMN, [1e12] * 4), "t": NO_COLUMN}),
    (call(ehl.PrescribedApproach.at, point=point(), t=[0.0, 1e-4, 2e-4, 3e-4], approach=[1e-6] * 4),
        {"approach": (*NO_COLUMN, [1.0] * 4)}),
    (call(ehl.PrescribedApproach, **TABLE), {"values": ([1e9] * 4, TEXT)}),
    (call(ehl.PrescribedLoad.from_function, load=lambda T: 1.0, until=1.0),
        {"load": (lambda: 1.0, lambda T, U: 1.0)}),
    (call(ehl.KeepSettings),
        {"checkpoint": [x for x in NO_PATH if x is not None], "restart": (5, b"x", "", "a\0b")}),
    (call(ehl.TimeSteps), {"tol": (1e9, 0.0, True, "x")}),
    (call(ehl.solve_steady, point=ehl.MoesPoint(200, 10, 0.5)),
        {"tol": (1e9, True, "x"), "callback": (lambda: None,)}),
    (call(ehl.Waves), {"wavelength": [x for x in NO_COLUMN if x is not None], "speed": NO_NUMBER}),
    (call(ehl.Roughness.measured, heights=np.eye(9), dx=0.1, dy=0.1, shortest_wavelength=0.5),
        {"point": (5, "x"), "heights": (np.eye(9) > 0.0, [TEXT, TEXT])}),
    (of(ended, "at"), {"t": (HUGE, TEXT, TRUE)}),
    (of(ended, "dissipated"), {"start": (np.inf,)}),
    (film_history, {"run": NO_OBJECT}),
    (track_wave, {"wave": NO_OBJECT}),
    (call(layer_after_passes, point=point(), layer=1e-7, passes=[1.0]),
        {"layer": (0.1, 1e3, *NO_NUMBER), "point": NO_OBJECT}),
    (call(most_loaded_ball, radial_load=500.0, balls=9),
        {"radial_load": (1e30, True), "balls": (10**12, 0, True, 1.5)}),
    # elements, fits, atlas
    (lambda **k: rm.SpringContact.cubic(**({"K1": 1.0, "K2": 0.1, "K3": 0.1, "C1": 0.01, "low": 0.7,
        "high": 1.0} | k)),
        {"fit": (5, "x", [1]), "source": (5, "x", [1])}),
    (rm.SpringContact.from_dict, {"entries": NO_OBJECT}),
    (of(cubic, "rate_at", {"approach": 0.8, "force": 0.8}), {"approach": NO_NUMBER, "force": NO_NUMBER}),
    (of(cubic, "advance", {"dt": 0.1, "approach": 0.8, "rate": 0.0}), {"dt": ("x", True, None)}),
    (lambda **k: rm.ContactRecord(**({"t": TIMES, "approach": TIMES, "rate": TIMES, "force": TIMES} | k)), {
        "point": (5, "x"), "n": (True, "x", 1.5), "domain": (5, "x", (1.0, 2.0)), "motion": (5, "x"),
        "conditions": (5, "x"),
    }),
    (call(rm.ContactRecord.from_result, simulation=5), {"accept_unconverged": NO_FLAG}),
    (lambda **k: wide_range_from_solves(**({"point": ehl.MoesPoint(20, 5, 0.5)} | k)),
        {"point": NO_OBJECT, "loads": (TEXT, TRUE), "memory_loads": (TEXT, TRUE), "Omega": (TEXT, TRUE)}),
    (lambda **k: rm.Atlas().over(**({"M": [20.0, 30.0], "L": 5.0, "kappa": 0.5} | k)),
        {"M": NO_COLUMN, "L": (True, TEXT), "kappa": (True, TEXT)}),
    (call(local_contact, load=50.0, approach=1e-6, stiffness=1e8, damping=100.0),
        {"approach": (1.0, *NO_NUMBER), "load": (True, "x")}),
    (film_impedance, {"response": NO_OBJECT}),
    (lambda **k: impedance_about(**({"element": cubic(), "load": 0.8} | k)),
        {"element": NO_OBJECT, "load": (0.0, -1.0, *NO_NUMBER)}),
    (lambda **k: rm.simulate_oscillator(**({"element": cubic(), "T": TIMES, "Omega_n": 3.0, "u0": 0.87} | k)),
        {"rtol": (10.0, True), "load": (lambda: 1.0, "x", True)}),
    # bearings
    (of(dry, "equilibrium", {"load": LOAD}),
        {"load": ([[1.0, [2.0]]], [[1.0, 2.0], [3.0]]), "shaft_angle": NO_NUMBER}),
    (of(dry, "frequencies"), {"speed_rpm": (1e12, *NO_NUMBER)}),
    (of(dry, "orders_under", {"load": LOAD}), {"axial": (None, {}, True, 1e12)}),
    (rm.BallBearing.from_dict, {"entries": NO_OBJECT}),
    (of(lambda: rm.Spall(race="outer", angle=0.0, length=1e-3, depth=1e-5), "height"), {"x": NO_COLUMN}),
    (lambda **k: rm.BearingSet(**({"bearings": [spindle()] * 2, "facings": ("+z", "-z"), "positions": (0.0,
        0.1)} | k)),
        {"positions": ((0.0, 0.0),)}),
    (lambda **k: rm.BearingSet.tandem(spindle(), **k), {"count": (10**12, 1, True, 1.5)}),
    (lambda **k: angle_from_order(**({"bearing": dry(), "bpfo_order": 3.6} | k)), {"bearing": NO_OBJECT}),
    (lambda **k: clearance_from_order(**({"bearing": dry(), "axial": 200.0, "bpfo_order": 3.6} | k)),
        {"bearing": NO_OBJECT}),
    (call(skf_friction, name="6205", radial=500.0, speed_rpm=1e3, kinematic_viscosity=3e-5), {
        "name": NO_NAME, "radial": (1e30, *NO_NUMBER), "axial": (1e30, *NO_NUMBER), "speed_rpm": (1e12,
        *NO_NUMBER),
        "kinematic_viscosity": (30.0, *NO_NUMBER), "static_rating": (-1.0, True, "x", np.nan),
        "replenishment": (-1.0, *NO_NUMBER), "mu_boundary": (12.0, *NO_NUMBER), "mu_film": (-1.0, *NO_NUMBER),
    }),
    (lambda **k: oil_and_heat(**({"bearing": wet(), "load": LOAD, "speed_rpm": 1500.0} | k)),
        {"bearing": NO_OBJECT, "solve": NO_FLAG, "callback": NO_CALL}),
    (lambda **k: rm.OilBalance(**({"bearing": wet(), "load": LOAD, "speed_rpm": 1500.0} | k)),
        {"return_time": (True, "x", None, np.nan, -1.0), "returned": (True, "x", 50.0)}),
    (lambda **k: balance().films(**k), {"layer": (0.1, *NO_COLUMN)}),
    (lambda **k: balance().loss_rate(**k), {"layer": (0.1, 0.0, *NO_NUMBER)}),
    (of(moved, "forces", {"q": [0.0, 1e-6], "v": [0.0, 0.0]}),
        {"q": ([10.0, 0.0], TEXT), "v": ([1e12, 0.0], TRUE)}),
    (of(moved, "drive", {"q": np.zeros((3, 2)), "v": np.zeros((3, 2))}), {"q": NO_COLUMN}),
    # rotors
    (lambda **k: rotor().equilibrium(**k), {"speed_rpm": (1e12, *NO_NUMBER)}),
    (lambda **k: rotor().matrices(**k), {"omega": NO_NUMBER}),
    (lambda **k: rotor().check_contacts(**k), {"speed_rpm": (True, "x", np.nan, HUGE)}),
    (rotor, {"nodes": ({5: {"x": 0}}, {"a": {5: 0}}), "stiffness": (None,), "load": ((1e12, 0.0),)}),
    (call(rm.ContactMount, angle=0.0), {
        "contact": (5, "x", [5]), "x": NO_INDEX, "y": NO_INDEX, "offset": (10.0,), "count": (10**12, 0, True),
    }),
    (lambda **k: rm.BearingMount(**({"bearing": linear(), "x": 0, "y": 1} | k)), {
        "x": (None, [1], *NO_INDEX), "y": (None, *NO_INDEX), "housing": (5, ["a", "b"], (True, False)),
        "name": NO_NAME,
    }),
    (call(rm.Unbalance, x=0, y=1, amount=1e-4), {"x": NO_INDEX, "y": NO_INDEX}),
    (call(Parameter, name="a", unit="kg", text="b", value=1.0), {
        "parts": ({"mass": 5}, {"mass": "x"}, {5: np.eye(2)}, {"nonsense": np.eye(2)}),
    }),
    (lambda **k: linear().at(**k), {"speed_rpm": (True, "x", None, TEXT)}),
    (of(lambda: rm.SpeedProfile.constant(1e3), "at"), {"t": NO_COLUMN}),
    (call(rm.jeffcott_rotor, disc_mass=2.0, journal_mass=0.3, shaft_stiffness=1e8), {
        "disc_mass": (1e12,), "shaft_stiffness": (1e30,), "gravity": ((0.0, -9810.0),), "load": ((1e12, 0.0),),
        "bearings": (10**12, True), "mounts": (5, "x", [5]), "offset": (10.0,),
    }),
    (call(FullFilm, ball=0, race="inner", between=(0.0, 1e-3)), {
        "ball": (10**12, *NO_INDEX), "between": (("1", "2"), (True, 2.0), (2.0, 1.0), 5), "solved": NO_FLAG,
        "bearing": (10**12, *NO_INDEX),
    }),
    (lambda **k: simulate_full_films(**({"rotor": standing(), "films": 5, "speed_rpm": 1e3, "dt": 1e-4,
        "until": 1e-3} | k)),
        {"rho_inf": (True, "x", np.nan), "dt": (1e9, True), "processes": (0, True), "callback": NO_CALL}),
    (lambda **k: rm.simulate_rotor(**({"rotor": standing(), "speed_rpm": 1e3, "dt": 1e-4, "until": 1e-3} | k)),
        {"dt": (1e9,), "until": (1e12,), "max_iterations": (10**12,), "callback": (lambda: None,)}),
    (lambda **k: settling(**({"result": run()} | k)), {"result": NO_OBJECT, "limit": (0.0, 1e9, *NO_NUMBER)}),
    (lambda **k: contact_events(**({"result": run(), "load": 50.0} | k)),
        {"result": NO_OBJECT, "elements": (5, "ab", [5]), "load": (0.0, True)}),
    (lambda **k: log_decrement(**({"t": np.arange(9.0), "signal": np.arange(9.0), "omega": 1.0} | k)),
        {"omega": (1e12,)}),
    (of(at_rest, "support_impedance"), {"s": NO_COMPLEX}),
    (of(at_rest, "dynamic_stiffness"), {"s": NO_COMPLEX}),
    (of(at_rest, "nearest"), {"mode": NO_OBJECT}),
    (of(at_rest, "motion"), {"t": NO_COLUMN}),
    (lambda **k: rm.unbalance_response(machine(), [1e3, 2e3]).peaks(**k), {"node": (None, *NO_INDEX)}),
    (lambda **k: machine_state(**({"rotor": machine(), "speed_rpm": 1e3} | k)),
        {"names": (5, [5], "ab"), "positions": (5, TEXT, TRUE)}),
    (lambda **k: single_bearing_state(dry(), LOAD, 1e3, **k), {"name": NO_NAME}),
    (lambda **k: support_state(dry(), LOAD, 1e3, **k), {"name": NO_NAME, "position": (True, "x", 300.0)}),
    (lambda **k: run().part(**({"first": 1} | k)),
        {"first": (99, *NO_INDEX), "last": NO_INDEX, "keep_time": NO_FLAG}),
    (lambda **k: run().plot(**k), {"path": (5, b"x", "a\0b", ["x"])}),
    (lambda **k: rm.bearing_matrices(**({"bearing": dry(), "load": LOAD, "speeds_rpm": [1e3]} | k)),
        {"bearing": NO_OBJECT, "load": NO_COLUMN, "speeds_rpm": (1e12, *NO_COLUMN), "facing": NO_NAME}),
    (lambda **k: rm.geometry_from_ratings(**(RATED | k)),
        {"bore": NO_NUMBER, "outside": (1e-3, *NO_NUMBER), "dynamic_rating": (14.0, *NO_NUMBER),
         "static_rating": (7.85, 1e6, *NO_NUMBER), "f0": (1.0, True, "14"), "contact_angle": (40.0, True, "x"),
         "conformity": (1.04, True, "0.52"), "dynamic_excess": (8.0, *NO_NUMBER), "tolerance": (2.0, *NO_NUMBER)}),
    (lambda **k: rm.geometry_from_ratings(**RATED).bearing(**k),
        {"candidate": (99, True, None, "1", 1.0), "clearance": ("C9", True), "name": NO_NAME}),
    (lambda **k: path().response(**k), {"hz": NO_COLUMN}),
    (lambda **k: case(**k), {"waviness": (-1.0, *NO_NUMBER)}),
    (records.make_record, {"case": NO_OBJECT}),
]  # fmt: skip
