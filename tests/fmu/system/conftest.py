"""One system for the session: a rotor in two contacts with film memory, out of balance."""

from pathlib import Path
from typing import NamedTuple

import pytest

from ehlcontact import Lubricant, OperatingPoint
from fmu import export_system
from reduced_models import Atlas, Rotor, jeffcott_rotor


class System(NamedTuple):
    rotor: Rotor
    path: Path


@pytest.fixture(scope="session")
def parts() -> dict[str, Rotor]:
    """On two unlike contacts of a 6205, 1.8 kN not symmetric about them; moving in both directions, and in y."""
    oil = Lubricant(eta0=0.037, alpha=2.0e-8)
    balls = {"ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3, "speed_rpm": 3000, "load": 486}
    points = [OperatingPoint.ball_bearing(oil, conformity=conformity, **balls) for conformity in (0.52, 0.53)]
    contacts = [Atlas().element(point, "wide") for point in points]
    rotor = {
        "half_angle": 0.35,
        "disc_mass": 20.0,
        "journal_mass": 1.0,
        "shaft_stiffness": 2e7,
        "shaft_damping": 200.0,
        "unbalance": 2e-4,
        "speed_rpm": 3000.0,
        "load": (150.0, -1620.0),
    }
    return {moving: jeffcott_rotor(directions=moving, **rotor).on(contacts) for moving in ("xy", "y")}


@pytest.fixture(scope="session")
def system(parts, made_once) -> System:
    """In FMI 2."""
    name, rotor = "rotor on contacts.ssp", parts["xy"]
    folder = made_once("system", lambda folder: export_system(rotor, folder / name))
    return System(rotor, folder / name)


@pytest.fixture(scope="session")
def system_3(parts, made_once) -> System:
    """In FMI 3, of a rotor that moves in y only."""
    name, rotor = "upright.ssp", parts["y"]
    folder = made_once("system 3", lambda folder: export_system(rotor, folder / name, fmi=3))
    return System(rotor, folder / name)
