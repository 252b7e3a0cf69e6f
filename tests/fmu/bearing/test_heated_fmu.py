"""FMU of a ball bearing whose films heat up: it is verified at export, and its films are the hot ones."""

import fmpy
import pytest

from ehlcontact import Lubricant
from fmu import export
from reduced_models import BallBearing

RPM, LOAD = 10_000.0, 2000.0


@pytest.mark.slow
def test_films_and_torque_are_those_of_the_bearing(tmp_path):
    oil = Lubricant.iso_vg(68, temperature=50.0)
    bearing = BallBearing.catalogue("6305", oil=oil, thermal=True)
    path = export(bearing, tmp_path / "hot.fmu", speeds_rpm=RPM, load=LOAD)
    end = fmpy.simulate_fmu(str(path), stop_time=1e-5)[-1]
    state = bearing.equilibrium((0.0, -LOAD), speed_rpm=RPM)
    cold = BallBearing.catalogue("6305", oil=oil).equilibrium((0.0, -LOAD), speed_rpm=RPM)
    assert end["smallest_film"] == pytest.approx(state.h_min.min(), rel=2e-3)
    assert end["rolling_torque"] == pytest.approx(state.rolling_torque, rel=5e-3)
    assert end["smallest_film"] < 0.85 * cold.h_min.min()
