"""Arguments of Python functions that are refused by name: field = value: must be ..., for every bad value."""

from math import pi

import numpy as np
from argument_groups import grouped
from balls import OF_6205

from ehlcontact import (
    Domain,
    FreeVibration,
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
    RunSettings,
    TimeSteps,
    TransientContact,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.hertz import hertz_contact
from ehlcontact.solver.domain import check_intervals
from ehlcontact.transient.bodies import Motion

NAN, INF = float("nan"), float("inf")
NOT_POSITIVE = (0.0, -1.0, NAN, INF, True, None, "two", [1.0, 2.0], 1j)
NO_SHARE = (-0.1, 0.51, NAN, INF, True, None, "steel")  # Poisson's ratio
NO_SCATTER = (-0.1, NAN, True, "0.1")
NO_GRID = (0, -16, 8, 15, 33, 40, 100, 2064, 4096, 32.0, 64.5, NAN, INF, True, "x", [16])
NO_THREADS = (0, -1, 1.0, "2", True, 9999)
POINT, GEOMETRY = MoesPoint(200, 10, 0.5), Geometry(0.01, 0.02)
T = np.linspace(0.0, 2.0, 9)


def ball_bearing(**arguments):
    return OperatingPoint.ball_bearing(Lubricant(), **arguments)


def operating_point(**arguments):
    return OperatingPoint(GEOMETRY, Lubricant(), **arguments)


def from_function(until):
    return PrescribedLoad.from_function(lambda t: 1.0, until)


def run_until_1(**arguments):
    return simulate(POINT, HarmonicLoad(Omega=pi), **grouped(n=32, until=1.0, **arguments))


def tabulated(**arguments):
    return simulate(POINT, PrescribedLoad(T, 1.0 + T), **grouped(n=32, **arguments))


RUN = {"point": POINT, "motion": HarmonicLoad(Omega=pi), "grid": Grid(n=32)}
FIELDS = [  # function, good arguments, bad values of some
    (
        MoesPoint,
        {"M": 200.0, "L": 10.0, "kappa": 0.5},
        {
            "M": [*NOT_POSITIVE, np.bool_(True), "200", np.array([200.0])],
            "L": [-1.0, NAN, None, False],
            "kappa": [*NOT_POSITIVE, 0.009, 101.0],
            "alpha": NOT_POSITIVE,
            "eta0": [*NOT_POSITIVE, 6e-5],
            "viscosity": ["newton"],
            "density": [""],
        },
    ),
    (
        Geometry,
        {"radius_x": 0.01, "radius_y": 0.02},
        dict.fromkeys(("radius_x", "radius_y", "e1", "e2"), NOT_POSITIVE)
        | dict.fromkeys(("nu1", "nu2"), (*NO_SHARE, "0.3")),
    ),
    (
        hertz_contact,
        {"load": 10.0, "radius_x": 0.01, "radius_y": 0.02, "e_reduced": 2e11},
        dict.fromkeys(("load", "radius_x", "radius_y", "e_reduced"), (*NOT_POSITIVE, -INF)),
    ),
    (operating_point, {"load": 10.0, "u_sum": 1.0}, dict.fromkeys(("load", "u_sum"), NOT_POSITIVE)),
    (operating_point(load=60.0, u_sum=1.3).Omega_n, {}, {"mass": NOT_POSITIVE}),
    (
        ball_bearing,
        OF_6205 | {"speed_rpm": 3000.0, "load": 100.0},
        {
            "ball_diameter": [0.0, NAN, True],
            "pitch_diameter": [-0.04, 7.94e-3, None],
            "conformity": [0.5, 0.0, 11.0, NAN, "0.52"],
            "race": ["middle", "both", 1, ["inner"]],
            "speed_rpm": [0.0, -3000.0, INF, None],
            "load": [0.0, "heavy"],
            "e1": [0.0],
            "nu2": [0.51],
        },
    ),
    (
        Lubricant,
        {},
        {
            "eta0": [0.0, -0.04, NAN, 5e-5, True, None],  # Roelands' law takes 6.31e-5 Pa s and more
            "alpha": [-1e-8, INF, [1e-8]],
            "viscosity": ["Roelands", 1],
            "density": ["constant", None],
        },
    ),
    (
        Lubricant,
        {"eta0": 0.04, "alpha": 2e-8},
        dict.fromkeys(("eta0_scatter", "alpha_scatter", "temperature_slope"), NO_SCATTER),
    ),
    (
        Domain,
        {},
        {
            "x_in": [-1.0, 0.0, -101.0, NAN, -INF, None, "far", True],
            "x_out": [1.0, 0.0, -2.0, 101.0, NAN, INF, None, True],
            "y_max": [1.0, 0.0, -2.0, 101.0, NAN, INF, [3.0, 4.0], False],
        },
    ),
    (check_intervals, {}, {"n": NO_GRID}),
    (
        solve_steady,
        {"point": POINT},
        {
            "grid": [64, Domain()],
            "tol": [0.0, -1e-5, NAN, None],
            "approach": [NAN, INF, True],
            "point": [(200, 10, 0.5)],
            "max_cycles": [-1, "a"],
        },
    ),
    (impedance, {"point": POINT, "Omega": [1.0]}, {"grid": [64], "Omega": [[], [-1.0], [NAN]]}),
    (TransientContact, {"point": POINT}, {"grid": [64], "largest_load": [0.0, NAN], "tol": [-1.0], "point": [3]}),
    (
        simulate,
        RUN,
        {
            "grid": [64, None],
            "time": [1.0],
            "keep": [(0.5,)],
            "run": [False],
            "point": ["M200"],
            "motion": [1],
            "surface": [3],
        },
    ),
    (Grid, {}, {"n": NO_GRID, "domain": [(-4.5, 1.5, 3.0)], "deflection": ["", "FFT", None, 3]}),
    (
        TimeSteps,
        {},
        {
            "until": [0.0, NAN, True],
            "dt": [-0.1, INF],
            "periods": [0.0],
            "steps_per_period": [-80],
            "local_error": [0.0, -1e-3, 1e-9, 0.2, 0.5, NAN, INF, True, "small"],
            "tol": [0.0, NAN, "1e-3"],
        },
    ),
    (TimeSteps, {"until": 1.0, "dt": 0.1}, {"periods": [2.0], "steps_per_period": [80]}),
    (KeepSettings, {}, {"snapshots": [(-1.0,), (0.5, NAN), 0.5], "checkpoint_every": [-1.0, NAN]}),
    (RunSettings, {}, {"threads": NO_THREADS}),
    (solve_steady, {"point": POINT, "grid": Grid(n=64)}, {"threads": NO_THREADS}),
    (impedance, {"point": POINT, "Omega": [0.0]}, {"threads": NO_THREADS}),
    (TransientContact, {"point": POINT}, {"threads": NO_THREADS}),
    (run_until_1, {}, {"dt": [2.0, 1e-9], "snapshots": [(1.5,)]}),
    (tabulated, {}, {"periods": [2.0], "steps_per_period": [80]}),
    (FreeVibration, {}, {"Omega_n": NOT_POSITIVE}),
    (FreeVibration, {"Omega_n": 5.0}, {"offset": [NAN, 2.5], "rate": [INF]}),
    (
        HarmonicLoad,
        {"Omega": 1.0},
        {"Omega": [*NOT_POSITIVE, "3.14"], "amplitude": [*NOT_POSITIVE, 1.0], "Omega_n": [-1.0]},
    ),
    (
        RampLoad,
        {"ratio": 2.0, "duration": 1.0, "Omega_n": 2.0},
        dict.fromkeys(("ratio", "duration", "Omega_n"), NOT_POSITIVE),
    ),
    (from_function, {}, {"until": NOT_POSITIVE}),
]
NAMED = [  # what the message names is no argument, or depends on two of them
    ("offset", lambda: FreeVibration(Omega_n=5.0, offset=0.0, rate=0.0)),
    ("rate", lambda: FreeVibration(Omega_n=1.0, rate=2.6)),
    ("start", lambda: FreeVibration(Omega_n=1.0, start="backwards")),
    ("start", lambda: FreeVibration(Omega_n=1.0, start=-1)),
    ("start", lambda: FreeVibration(Omega_n=1.0, rate=0.1, start="opening")),
    ("start", lambda: FreeVibration(Omega_n=1.0, offset=0.1, start="opening")),
    ("Omega_n", lambda: PrescribedLoad(T, 1.0 + T, Omega_n=0.0)),
    ("values", lambda: PrescribedLoad(T, 1.0 - T)),
    ("values", lambda: PrescribedLoad([0.0, 1.0, 2.0, 3.0], ["a"] * 4)),
    ("length of values", lambda: PrescribedLoad(T, T[:-1])),
    ("length of T", lambda: PrescribedLoad(T[:3], T[:3] + 1.0)),
    ("values[5]", lambda: PrescribedLoad(T, np.where(T > 1.0, NAN, 1.0))),
    ("values[5]", lambda: PrescribedApproach(T, np.where(T > 1.0, INF, 1.0))),
    ("shape of T", lambda: PrescribedApproach(T.reshape(3, 3), T.reshape(3, 3))),
    ("T", lambda: PrescribedLoad(["a"] * 4, [1.0] * 4)),
    ("T[0]", lambda: PrescribedApproach(T + 1.0, T)),
    ("T[1]", lambda: PrescribedApproach(T[::-1] * 0.0, T)),
    ("T[2]", lambda: PrescribedLoad(np.array([0.0, 0.1, 0.1, 0.3]), np.ones(4))),
    ("motion.kind", lambda: Motion.from_dict({"kind": "waltz"})),
    ("motion.kind", lambda: Motion.from_dict({})),
    ("alpha", lambda: OperatingPoint(GEOMETRY, Lubricant(alpha=0.0), 10.0, 1.0)),
]
