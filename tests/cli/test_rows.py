"""Rows of tables: quantities with the units that people use, and their dimensionless values beside."""

from balls import OF_6205

from ehlcontact import Lubricant, MoesPoint, OperatingPoint
from ehlcontact.cli.rows import in_unit, quantity_rows
from reduced_models import Atlas

NAMES = dict.fromkeys(("approach", "h_min", "moment"), "")


def test_units_of_tables():
    assert in_unit(1.25e-6, "m") == "1.25 µm" and in_unit(0.9e9, "Pa") == "0.9 GPa"
    assert in_unit([1e-3, 4e-3, 2e-3], "s") == "1 .. 4 ms" and in_unit(70.0, "N") == "70 N"
    assert in_unit(0.5, "") == "0.5" and in_unit([2.0, 2.0], "N s/m") == "2 N s/m"


def test_a_dimensionless_point_has_its_scales_as_units():
    answer = Atlas().at(MoesPoint(50.0, 8.0, 0.3))
    rows = quantity_rows(answer, NAMES | {"h_min": "anywhere"}, {"approach": 0.001})
    assert [row[0] for row in rows] == ["mutual approach", "smallest film", "rolling resistance"]
    assert rows[0][1] == f"{answer.approach:.5f}".rstrip("0")
    assert rows[0][2] == "of the dry Hertz approach, ± 0.001"
    assert rows[1][2] == "of the dry Hertz approach, anywhere" and rows[2][2] == "of load times semi-axis a"


def test_a_point_in_si_has_both():
    oil = Lubricant.iso_vg(68, temperature=60.0)
    point = OperatingPoint.ball_bearing(oil, **OF_6205, speed_rpm=3000.0, load=50.0)
    answer = Atlas().at(point)
    approach, film, moment = quantity_rows(answer, NAMES, answer.error_bars)
    assert approach[1].endswith(" µm") and moment[1].endswith(" N mm")
    assert float(film[1].split()[0]) * 1e-6 - answer.h_min < 1e-4 * answer.h_min
    assert film[2].startswith(f"{answer.h_min:.4f}".rstrip("0")) and film[2].endswith(" µm") and "±" in film[2]
