"""Balls of bearings on a race that several tests compute."""

from ehlcontact import Lubricant, OperatingPoint

OF_6205 = {"ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3, "conformity": 0.52}
LARGE = {"ball_diameter": 12.3e-3, "pitch_diameter": 43.5e-3, "conformity": 0.52}
# Warm: shear heats its inlet, and sliding its film.
FAST = OperatingPoint.ball_bearing(Lubricant.iso_vg(68, temperature=50.0), **LARGE, speed_rpm=10_000.0, load=800.0)
