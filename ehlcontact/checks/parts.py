"""Ranges of the parts of machines: shafts, discs, bearings, supports, records; each with the slips of its unit.

What lies outside is no part of a rotor on rolling bearings: from spindles of dentists to wind turbines.
"""

from __future__ import annotations

from ehlcontact.checks.admissible_range import INPUTS, Quantity

MM, UM = {"mm": 1e-3}, {"µm": 1e-6, "nm": 1e-9, "mm": 1e-3}
MOST_SPEEDS = 10_000  # of a list, each of which takes a solve

# Shafts and discs
SHAFT_LENGTH = Quantity("m", (1e-6, 100.0), (5e-3, 20.0), MM)
SHAFT_DIAMETER = Quantity("m", (1e-6, 10.0), (1e-3, 3.0), MM)
BORE = Quantity("m", (1e-6, 10.0), (5e-4, 3.0), MM, zero=True)
SET_PLACE = Quantity("m", (0.0, 5.0), (1e-3, 2.0), MM, signed=True)  # of a bearing of a set
PLACE = Quantity("m", (0.0, 100.0), (1e-3, 20.0), MM, signed=True)  # along a shaft
MODULUS = INPUTS["e1"]
SHAFT_MODULUS = MODULUS._replace(limits=(MODULUS.limits[0], 1e20))  # next to infinite: a rigid shaft
DENSITY = Quantity("kg/m3", (1e-15, 25e3), (500.0, 23e3), {"g/cm3": 1e3}, slips=True)  # next to 0: no inertia
DENSITY_OR_NONE = DENSITY._replace(zero=True)  # 0: without mass
OIL_DENSITY = Quantity("kg/m3", (300.0, 5e3), (600.0, 2500.0), {"g/cm3": 1e3})
MASS = Quantity("kg", (1e-6, 1e6), (1e-3, 1e5), {"g": 1e-3, "t": 1e3})
MASS_OR_NONE = MASS._replace(zero=True)
RING_MASS = MASS._replace(limits=(1e-9, MASS.limits[1]))  # next to nothing: the ring follows its bearing
INERTIA = Quantity("kg m2", (1e-15, 1e7), (1e-9, 1e5), {"kg mm2": 1e-6, "g mm2": 1e-9}, zero=True)
FILM = Quantity("m", (0.0, 1e-2), (1e-9, 1e-4), UM, signed=True)  # a gap, of rough surfaces below 0 too
PRESSURE = Quantity("Pa", (1e-3, 1e13), (1e5, 1e11), {"GPa": 1e9, "MPa": 1e6})
UNBALANCE = Quantity("kg m", (0.0, 1e5), (1e-9, 10.0), {"g mm": 1e-6}, signed=True)
DAMPING_TIME = Quantity("s", (1e-15, 10.0), (1e-9, 0.1), {"us": 1e-6, "ms": 1e-3}, zero=True)

# Supports
STIFFNESS = Quantity("N/m", (1e-3, 1e15), (1e3, 1e12), {"N/um": 1e6, "N/mm": 1e3})
SHAFT_STIFFNESS = STIFFNESS._replace(limits=(1e-3, 1e20))  # next to infinite: a rigid shaft
STIFFNESS_OR_NONE = STIFFNESS._replace(zero=True)
DAMPING = Quantity("N s/m", (1e-12, 1e12), (1e-2, 1e7), {"N s/mm": 1e3}, zero=True)
FORCE = Quantity("N", (0.0, 1e8), (0.0, 1e7), {"mN": 1e-3}, signed=True)
PRELOAD = Quantity("N", (1e-6, 1e8), (0.1, 1e6), {"kN": 1e3, "mN": 1e-3}, zero=True)
LOAD = INPUTS["load"]
RATING = Quantity("N", (1e-3, 1e9), (10.0, 1e8), {"kN": 1e3})
GRAVITY = Quantity("m/s2", (0.0, 1e3), (0.0, 100.0), {"mm/s2": 1e-3}, signed=True)
OFFSET = Quantity("m", (0.0, 0.1), (1e-9, 1e-3), UM, signed=True)  # along a shaft, of rings

# Bearings
BALL_DIAMETER, PITCH_DIAMETER, SPEED = INPUTS["ball_diameter"], INPUTS["pitch_diameter"], INPUTS["speed_rpm"]
SPEED_OR_NONE = Quantity("rev/min", (0.0, SPEED.limits[1]), SPEED.usual, SPEED.others)
FILM_LAND = Quantity("m", (1e-6, 10.0), (1e-3, 1.0), MM)  # of a squeeze film damper
CLEARANCE = Quantity("m", (1e-8, 0.05), (5e-6, 2e-3), UM | {"um": 1e-6})  # radial, of a journal
GAP = Quantity("m", (1e-9, 0.01), (1e-8, 1e-4), UM)  # beyond which a film carries nothing
LAYER = Quantity("m", (1e-15, 1e-2), (1e-9, 1e-3), UM)  # of oil
DISTANCE = Quantity("m", (0.0, 10.0), (2e-3, 5.0), MM)  # of the planes of two bearings
HEIGHT = Quantity("m", (1e-13, 0.1), (1e-9, 1e-3), UM)  # of a feature of a race or a ball
EXCESS = Quantity("m", (0.0, 0.01), (1e-9, 1e-4), UM, signed=True)
TRACK = Quantity("m", (1e-9, 100.0), (1e-5, 1.0), {"mm": 1e-3, "µm": 1e-6})  # lengths along a track
# Of features in a contact: tens of nanometres to some micrometres high, some to hundreds of micrometres long
FILM_HEIGHT = Quantity("m", (1e-13, 1e-4), (1e-9, 1e-5), UM, signed=True)
FILM_LENGTH = Quantity("m", (1e-8, 0.02), (1e-6, 2e-3), {"mm": 1e-3, "µm": 1e-6}, signed=True)
RIM = HEIGHT._replace(zero=True)
EDGE = TRACK._replace(zero=True)
TEMPERATURE = Quantity("degrees Celsius", (-100.0, 250.0), (5.0, 200.0), shifts={"K": -273.15})

# Signals and runs
SPEEDS = Quantity("rev/min", SPEED.limits, SPEED.usual, SPEED.others, signed=True, most=MOST_SPEEDS)
SECONDS = Quantity("s", (1e-9, 1e7), (1e-3, 1e5), {"ms": 1e-3, "us": 1e-6})
RATE = Quantity("Hz", (1e-3, 1e9), (10.0, 1e7), {"kHz": 1e3})
NOISE = Quantity("m/s2", (1e-12, 1e6), (1e-6, 1e4), {"g": 9.81}, zero=True)
NATURAL = Quantity("Hz", (1e-3, 1e9), (0.1, 1e6), {"kHz": 1e3})
MODAL_MASS = Quantity("kg", (0.0, 1e9), (1e-6, 1e6), {"g": 1e-3}, signed=True)
FEED = Quantity("m3/s", (1e-24, 1.0), (1e-18, 1e-3), {"mm3/s": 1e-9}, zero=True)
SHARE = Quantity("", (0.0, 1.0), (0.0, 1.0))
TIMES = Quantity("s", (0.0, 1e7), (1e-6, 1e5), {"ms": 1e-3, "us": 1e-6})
STEP = Quantity("s", (1e-15, 10.0), (1e-9, 0.1), {"us": 1e-6, "ms": 1e-3})  # of an integration
APPROACH = Quantity("m", (0.0, 0.1), (1e-9, 1e-3), UM, signed=True)  # of two bodies
TOLERANCE = Quantity("", (1e-15, 0.5), (1e-12, 0.1))
INDEX_OF_REFRACTION = Quantity("", (1.0, 5.0), (1.0, 5.0))
VISCOSITY = Quantity("m2/s", (1e-9, 1.0), (1e-6, 0.1), {"mm2/s": 1e-6})  # kinematic
DYNAMIC_VISCOSITY = INPUTS["eta0"]
RATIO_OF_LOADS = Quantity("", (1e-6, 1e3), (1e-2, 20.0))
DRY_APPROACHES = Quantity("dry approaches", (0.0, 1e3), (0.0, 10.0), signed=True)
ANY = Quantity("", (0.0, 1e30), (0.0, 1e30), signed=True)
LARGEST_LOAD = Quantity("", (1e-9, 1e9), (1e-3, 1e3))  # over the mean load
