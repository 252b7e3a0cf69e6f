"""`bearing_matrices`: about any point, of bearings and sets, and as texts that other programs read."""

import ast
import json
import re
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ehlcontact import InputError, Lubricant
from reduced_models import BallBearing, BearingSet, OutsideValidityWarning, bearing_matrices
from reduced_models.rotor.bearing_matrices import BearingMatrices, rigid_arm
from reduced_models.rotor.matrix_text import PROGRAMS

OIL = Lubricant.iso_vg(68, temperature=50.0)
LOAD = (0.0, -300.0, 500.0)


@pytest.fixture(scope="module")
def bearing() -> BallBearing:
    return BallBearing.catalogue("7205", oil=OIL)


@pytest.fixture(scope="module")
def table(bearing: BallBearing) -> BearingMatrices:
    return bearing_matrices(bearing, LOAD, [3000.0, 6000.0])


@pytest.fixture(scope="module")
def moved(bearing: BallBearing) -> BearingMatrices:
    return bearing_matrices(bearing, LOAD, 3000.0, hz=[50.0, 400.0]).about((0.0, 0.0, 0.02))


class TestMatrices:
    def test_those_of_coefficients(self, bearing: BallBearing, table: BearingMatrices) -> None:
        own = bearing.coefficients(LOAD, speed_rpm=6000.0, hz=100.0)
        assert table.hz[:, 0] == pytest.approx([50.0, 100.0])
        scale = np.sqrt(np.outer(np.diag(own.stiffness[0]), np.diag(own.stiffness[0])))
        assert np.abs(table.stiffness[1, 0, :5, :5] - own.stiffness[0]).max() <= 1e-12 * scale.max()
        assert not table.stiffness[..., 5, :].any() and not table.damping[..., 5].any()

    def test_symmetric_at_rest(self, bearing: BallBearing) -> None:
        assert bearing_matrices(bearing, LOAD, 0.0, hz=10.0).asymmetry < 1e-9

    def test_damping_takes_energy_about_every_point(self, table: BearingMatrices) -> None:
        far = table.about((0.01, -0.02, 0.05)).damping
        least = np.linalg.eigvalsh(0.5 * (far + np.swapaxes(far, -1, -2)))[..., 0]
        assert least.min() > -1e-9 * np.abs(far).max()

    def test_about_a_point_and_back(self, table: BearingMatrices) -> None:
        back = table.about((0.01, -0.02, 0.05)).about((0.0, 0.0, 0.0))
        assert np.abs(back.stiffness - table.stiffness).max() < 1e-12 * table.stiffness.max()

    def test_about_a_point_by_differences(self, bearing: BallBearing) -> None:
        """Loads at the point, by statics those at the bearing; motion of the point, as of a rigid arm."""
        dry, arm = bearing.dry, np.array([0.0, 0.0, 0.02])
        full = np.array([*LOAD, *dry.equilibrium(LOAD, cage_angle=0.3).load[3:]])

        def motion(change: NDArray[np.float64]) -> NDArray[np.float64]:
            at_bearing = np.concatenate([change[:3], np.cross(arm, change[:3])[:2] + change[3:]])
            u = dry.equilibrium(tuple(full + at_bearing), cage_angle=0.3).displacement
            return np.concatenate([u[:3] + np.cross([*u[3:], 0.0], arm), u[3:]])

        steps = np.array([1.0, 1.0, 1.0, 0.02, 0.02]) * 0.05
        compliance = [
            (8.0 * (motion(d) - motion(-d)) - (motion(2.0 * d) - motion(-2.0 * d))) / 12.0 / size
            for d, size in ((row, row.max()) for row in np.diag(steps))
        ]
        inverse = np.linalg.inv(np.transpose(compliance))
        own = np.zeros((6, 6))
        own[:5, :5] = dry.coefficients(tuple(full), cage_angle=0.3, hz=1.0).stiffness[0]
        T = rigid_arm(-arm)
        K = (T.T @ own @ T)[:5, :5]
        assert np.abs(inverse - K).max() < 1e-6 * np.abs(K).max()
        blocks = slice(0, 3), slice(3, 5)
        for rows in blocks:
            for columns in blocks:
                part = K[rows, columns]
                assert np.abs((inverse - K)[rows, columns]).max() < 1e-6 * np.abs(part).max()

    def test_a_set_is_the_sum_of_its_bearings_moved(self, bearing: BallBearing) -> None:
        places = (-0.03, 0.045)
        facings, offsets = ("+z", "-z"), (8e-6, 8e-6)
        both = BearingSet(bearings=[bearing, bearing], facings=facings, positions=places, offsets=offsets)
        load = (20.0, -300.0, 100.0)
        whole = bearing_matrices(both, load, 3000.0, hz=200.0)
        found = both.coefficients(load, speed_rpm=3000.0, hz=200.0)
        assert whole.stiffness[0, 0, :3, :3] == pytest.approx(found.stiffness[0, :3, :3], rel=1e-9, abs=1.0)
        state = both.equilibrium(load, speed_rpm=3000.0, cage_angle=0.0)
        held = both.coefficients(load, speed_rpm=3000.0, hz=200.0, cage_angle=0.0)
        total = np.zeros((6, 6))
        for place, facing, own in zip(places, both.facings, state.bearings, strict=True):
            signs = np.array([1.0, 1.0, *[1.0 if facing == "+z" else -1.0] * 3])
            K = np.zeros((6, 6))
            one = bearing.coefficients(tuple(own.load), speed_rpm=3000.0, hz=200.0, cage_angle=0.0)
            K[:5, :5] = one.stiffness[0] * np.outer(signs, signs)
            T = rigid_arm(np.array([0.0, 0.0, place]))
            total += T.T @ K @ T
        for rows in (slice(0, 3), slice(3, 5)):
            difference = (total[:5, :5] - held.stiffness[0])[rows, rows]
            assert np.abs(difference).max() < 1e-7 * np.abs(held.stiffness[0][rows, rows]).max()

    def test_a_facing_mirrors(self, bearing: BallBearing, table: BearingMatrices) -> None:
        mirrored = bearing_matrices(bearing, (0.0, -300.0, -500.0), [3000.0, 6000.0], facing="-z")
        signs = np.array([1.0, 1.0, -1.0, -1.0, -1.0, -1.0])
        assert mirrored.stiffness == pytest.approx(table.stiffness * np.outer(signs, signs), rel=1e-12, abs=1e-3)


def numbers(line: str) -> list[float]:
    return [float(text) for text in line.split(",")[1:]]


def large_fields(text: str) -> Iterator[tuple[str, list[str]]]:
    """Cards of Nastran in large fields: a name of 8 characters, four fields of 16."""
    for line in text.splitlines():
        if line[0] != "$" and line[:8].rstrip().endswith("*"):
            yield line[:8].rstrip(), [line[at : at + 16].strip() for at in range(8, 72, 16)]


class TestTexts:
    def test_csv(self, table: BearingMatrices, tmp_path: Path) -> None:
        lines = [line for line in table.write(tmp_path / "k.csv").read_text().splitlines() if line[0] != "#"]
        head, rows = lines[0].split(","), np.array([[float(one) for one in line.split(",")] for line in lines[1:]])
        assert head[2] == "K_x_x [N/m]" and head[-8] == "C_tilt_y_tilt_y [N m s]"
        assert rows[:, 0].tolist() == [3000.0, 6000.0]
        assert np.array_equal(rows[:, 2:38].reshape(2, 6, 6), table.stiffness[:, 0])
        assert np.array_equal(rows[:, 38:].reshape(2, 6, 6), table.damping[:, 0])

    def test_json(self, table: BearingMatrices) -> None:
        read = json.loads(table.text("json"))
        assert np.array_equal(read["damping"], table.damping)
        assert read["rows_and_columns"][3] == "tilt_x" and "N/m" in read["units"]

    def test_combi214(self, table: BearingMatrices) -> None:
        values = dict(re.findall(r"\$ ([KC]\d\d)_1\(2,1\) = (\S+)", table.text("ansys-combi214", shaft_along="x")))
        assert float(values["K11"]) == table.stiffness[1, 0, 0, 0]
        assert float(values["C22"]) == table.damping[1, 0, 1, 1]

    def test_matrix27(self, moved: BearingMatrices) -> None:
        lines = moved.text("ansys-matrix27", hz=400.0, units="mm").splitlines()
        at = next(n for n, line in enumerate(lines) if line.startswith("R,1,"))
        upper = np.array([value for line in lines[at : at + 13] for value in numbers(line.replace("R,1,", "R,"))])
        K = np.zeros((12, 12))
        K[np.triu_indices(12)] = upper
        half = 0.5 * (moved.stiffness[0, 1] + moved.stiffness[0, 1].T)
        scale = np.outer(*[np.repeat([1.0, 1e3], 3)] * 2) * 1e-3  # N/mm, N, N mm
        assert K[:6, :6] == pytest.approx(np.triu(half * scale), rel=1e-12)
        assert K[:6, 6:] == pytest.approx(-half * scale, rel=1e-12)
        assert upper[57] == K[6, 6] == pytest.approx(1e-3 * half[0, 0])  # C58, as the element's manual says

    def test_matrix27_tells_what_it_leaves_out(self, bearing: BallBearing) -> None:
        table = bearing_matrices(bearing, LOAD, 3000.0)
        skew = table.stiffness.copy()
        skew[..., 0, 1] += 0.01 * skew[..., 0, 0]
        with pytest.warns(OutsideValidityWarning, match="not symmetric"):
            replace(table, stiffness=skew).text("ansys-matrix27")

    def test_nastran_dmig(self, moved: BearingMatrices) -> None:
        """In large fields, as pyNastran 1.4 (NumPy 1) reads them too."""
        read = {"KB7": np.zeros((6, 6)), "BB7": np.zeros((6, 6))}
        name, column = "", 0
        for card, fields in large_fields(moved.text("nastran-dmig", hz=50.0, node=7)):
            if card == "DMIG*":
                name, node, column = fields[0], int(fields[1]), int(fields[2])
                assert node == 7
            elif card == "*":
                assert int(fields[0]) == 7
                read[name][int(fields[1]) - 1, column - 1] = float(fields[2].replace("D", "E"))
        assert read["KB7"] == pytest.approx(moved.stiffness[0, 0], rel=1e-9)
        assert read["BB7"] == pytest.approx(moved.damping[0, 0], rel=1e-9)

    def test_nastran_cbush(self, moved: BearingMatrices) -> None:
        cards = list(large_fields(moved.text("nastran-cbush", hz=50.0, node=7)))
        assert cards[0] == ("CBUSH*", ["7", "7", "7", ""]) and cards[1][1][3] == "0"
        flat = [field.replace("D", "E") for _, fields in cards[2:] for field in fields]
        assert (flat[0], flat[1], flat[8], flat[9]) == ("7", "K", "", "B")
        assert [float(one) for one in flat[2:8]] == pytest.approx(
            np.diag(moved.stiffness[0, 0]).tolist(), rel=1e-9
        )
        assert [float(one) for one in flat[10:16]] == pytest.approx(
            np.diag(moved.damping[0, 0]).tolist(), rel=1e-9
        )

    def test_abaqus_and_links(self, moved: BearingMatrices) -> None:
        K, C = np.zeros((6, 6)), np.zeros((6, 6))
        into = K
        for line in moved.text("abaqus", hz=50.0, node=7).splitlines():
            if line.startswith("*MATRIX INPUT"):
                into = K if "NAME=K_BEARING_7," in line else C
            elif line[0].isdigit():
                node, i, other, j, value = line.split(", ")
                assert node == other == "7"
                into[int(i) - 1, int(j) - 1] = float(value)
        assert np.array_equal(K, moved.stiffness[0, 0]) and np.array_equal(C, moved.damping[0, 0])
        ways = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")
        for line in moved.text("links", hz=50.0).splitlines():
            if line[0] != "#":
                _, row, _, column, k, c = line.split()
                place = ways.index(row), ways.index(column)
                assert (float(k), float(c)) == (K[place], C[place])

    def test_texts_of_two_bearings_share_no_number_or_name(self, moved: BearingMatrices) -> None:
        """Definitions by what other cards of a model refer to."""
        defined = {
            "ansys-combi214": r"^(?:ET|R|\*DIM),\w+",
            "ansys-matrix27": r"^(?:ET|R),\w+",
            "nastran-dmig": r"^DMIG +\w+",
            "nastran-cbush": r"^(?:C|P)BUSH\* +\w+",
            "abaqus": r"^\*MATRIX INPUT, NAME=\w+",
        }
        for program, pattern in defined.items():
            first, second = (
                re.findall(pattern, moved.text(program, hz=50.0, node=node), re.MULTILINE) for node in (1, 2)
            )
            assert len(first) == len(second) >= 2 and not set(first) & set(second), program

    def test_exudyn(self, moved: BearingMatrices) -> None:
        text = moved.text("exudyn", hz=50.0)
        ast.parse(text)
        pytest.importorskip("exudyn")
        names: dict[str, object] = {}
        exec(text, names)
        assert np.array_equal(names["stiffness"], moved.stiffness[0, 0])
        connector = names["bearing"](0, 1)  # type: ignore[operator]
        assert np.array_equal(connector.damping, moved.damping[0, 0])

    @pytest.mark.parametrize("program", [program for program in PROGRAMS if program != "json"])
    def test_every_header_has_frame_units_and_signs(self, moved: BearingMatrices, program: str) -> None:
        text = moved.text(program) if program == "csv" else moved.text(program, hz=50.0)
        turns, units, signs = "the shaft turns from X to Y", "units: N, m, rad, s", "signs: F = K u"
        for words in ("o------ X", turns, units, signs, "(0, 0, 20) mm from"):
            assert words in text

    def test_comments_are_ascii(self, moved: BearingMatrices) -> None:
        noted = replace(moved, name="Lüfter", reservations=("film 0.24 µm ± 9.4 % at 70 °C",))
        text = noted.text("nastran-dmig", speed_rpm=3000.0, hz=50.0)
        assert text.isascii() and "film 0.24 um +- 9.4 % at 70 degC" in text and "L?fter" in text

    def test_axes_of_the_other_program(self, moved: BearingMatrices) -> None:
        text = moved.text("links", hz=50.0, shaft_along="x")
        values = {
            tuple(line.split()[1:4:2]): float(line.split()[4]) for line in text.splitlines() if line[0] != "#"
        }
        K = moved.stiffness[0, 0]
        assert values["UX", "UX"] == K[2, 2] and values["UY", "UY"] == K[0, 0] and values["UZ", "UZ"] == K[1, 1]
        assert values["UZ", "ROTY"] == K[1, 3]


class TestRefused:
    @pytest.mark.parametrize(
        ("program", "given", "named"),
        [
            ("nastran", {}, "program"),
            ("nastran-dmig", {}, "hz"),
            ("nastran-dmig", {"hz": 60.0}, "hz"),
            ("abaqus", {"hz": 50.0, "speed_rpm": 4000.0}, "speed_rpm"),
            ("abaqus", {"hz": 50.0, "node": 0}, "node"),
            ("abaqus", {"hz": 50.0, "units": "cm"}, "units"),
            ("abaqus", {"hz": 50.0, "shaft_along": "w"}, "shaft_along"),
            ("csv", {"hz": 50.0}, "hz"),
            ("ansys-combi214", {"speed_rpm": 3000.0}, "speed_rpm"),
        ],
    )
    def test_texts(self, moved: BearingMatrices, program: str, given: dict[str, object], named: str) -> None:
        with pytest.raises(InputError, match=f"^{named}"):
            moved.text(program, **given)  # type: ignore[arg-type]

    def test_a_file_without_a_program(self, moved: BearingMatrices, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"program .*nastran-dmig"):
            moved.write(tmp_path / "bearing.inp")

    def test_a_point_far_away(self, moved: BearingMatrices) -> None:
        with pytest.warns(OutsideValidityWarning, match=r"30 m from the centre of the bearing"):
            moved.about((0.0, 0.0, 30.0))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            moved.about((0.0, 0.0, 0.3))

    def test_no_bearing(self) -> None:
        with pytest.raises(InputError, match=r"^bearing"):
            bearing_matrices("6205", LOAD, 3000.0)  # type: ignore[arg-type]

    def test_a_facing_of_a_set(self, bearing: BallBearing) -> None:
        with pytest.raises(InputError, match=r"^facing"):
            bearing_matrices(BearingSet.pair(bearing, "back to back", preload=100.0), LOAD, 3000.0, facing="-z")


def test_the_summary_has_the_tilts():
    table = bearing_matrices(BallBearing.catalogue("7205"), (0.0, -300.0, 500.0), speeds_rpm=[3000.0])
    lines = repr(table).splitlines()
    assert f"K_tilt_x {1e-3 * table.stiffness[0, 0, 3, 3]:.4g} N m/mrad" in lines[3] and "tilt" not in lines[2]
    planar = bearing_matrices(BallBearing.catalogue("6205"), (0.0, -300.0), speeds_rpm=[3000.0])
    assert "tilt" not in repr(planar)
