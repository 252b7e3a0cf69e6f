"""The C sources of all FMUs under strict warnings, sanitizers and valgrind, and what their libraries export.

Random calls (`fuzz.c`, `fuzz3.c`): one that fails changes nothing, and OK never comes with a number that is not
finite.
"""

import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

import fmpy
import numpy as np
import pytest
from exported import OfRotor, model_of
from fmpy.build import build_platform_binary
from fmpy.validation import validate_fmu

from ehlcontact import Lubricant, MoesPoint
from fmu import export, verify
from fmu.archive import content_guid
from fmu.bearing.model import BearingModel
from fmu.bearing.set_model import SetModel
from fmu.contact_spec import contact_spec
from fmu.references.contact_references import film_motion, state_grid
from fmu.rotor.laws import law_names, laws_of
from fmu.sources import SOURCE_FOLDERS, source_files, standard_folder, standard_headers
from reduced_models import Atlas, BallBearing, BearingSet, Disc, Shaft, Support, rotor_on_bearings

pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
STRICT = ["-pedantic", "-Wall", "-Wextra", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror"]
SANITIZE = ["-fsanitize=address,undefined,float-divide-by-zero", "-fno-sanitize-recover=all"]
SANITIZED = [*STRICT, "-g", "-O0", *SANITIZE]
HERE = Path(__file__).parent
CONTACTS = ["cubic", "polynomial", "power_si", "wide_si", "memory", "speed"]
ROTORS = ["rotor alone", "rotor mixed", "rotor wide in y"]
BEARINGS = ["bearing planar", "bearing five", "bearing set"]
SHAFTS = ["shaft", "whole rotor"]
FUZZ = {2: "fuzz.c", 3: "fuzz3.c"}
MANY = 1_250_000  # calls of each version of FMI, over all kinds
FEW = 20_000  # of each kind, in the default suite
UNDER_VALGRIND = 2_000  # of each kind: it is some fifty times slower


def run(line, **options):
    return subprocess.run([str(part) for part in line], capture_output=True, text=True, timeout=1000, **options)


@pytest.fixture(scope="module")
def compiler() -> str:
    """A system compiler: zig brings no sanitizer runtime."""
    for name in ("gcc", "clang", "cc"):
        if shutil.which(name):
            return name
    pytest.skip("no system C compiler")


@pytest.fixture(scope="module")
def models(elements, rotors):
    """All that FMUs are made from."""
    oil = Lubricant.iso_vg(46, temperature=70.0)
    bearings = {
        "bearing planar": BearingModel(
            BallBearing.catalogue("6205", clearance=5e-6, oil=oil, loss_factor=0.05, ball_inertia=True), 3e3, 500.0
        ),
        "bearing five": BearingModel(
            BallBearing.catalogue("7205", oil=oil), (8e3, 1e4), (0.0, -300.0, 200.0), permittivity=2.2
        ),
        "bearing dry": BearingModel(BallBearing.catalogue("6205", clearance=5e-6), 3e3, 500.0),
    }
    shaft = rotor_on_bearings(
        Shaft(length=0.4, diameter=0.03, elements=2, damping_time=1e-5),
        discs=[Disc(position=0.25, mass=4.0, diametral_inertia=0.01, polar_inertia=0.02, unbalance=1e-4)],
        supports=[Support(position=at, bearing=BallBearing.catalogue("6205")) for at in (0.02, 0.38)],
    )
    oiled = BallBearing.catalogue("6205", clearance=5e-6, oil=oil, loss_factor=0.05)
    whole = rotor_on_bearings(
        Shaft(length=0.4, diameter=0.03, density=0.0),
        discs=[Disc(position=0.25, mass=4.0, unbalance=1e-4)],
        supports=[
            Support(position=at, bearing=bearing, journal_mass=0.2)
            for at, bearing in ((0.02, oiled), (0.38, BallBearing.catalogue("6205")))
        ],
    )
    shafts = {
        "shaft": OfRotor(shaft, {"outside": "all", "speed_rpm": 3e3, "inertia": 0.02}),
        "whole rotor": OfRotor(whole, {"speeds_rpm": 3e3, "inertia": 0.02}),
    }
    angular = BallBearing.catalogue("7205", oil=oil, loss_factor=0.05)
    bearings["bearing set"] = SetModel(BearingSet.pair(angular, spring=200.0), 8e3)
    over = {"speed": Atlas().element_over_speed(MoesPoint(200, 10, 0.5), (0.1, 4.0))}
    return elements | over | {f"rotor {name}": rotor for name, rotor in rotors.items()} | bearings | shafts


@pytest.fixture(scope="module")
def compiled(compiler, models, tmp_path_factory):
    """``compiled("cubic", 2, flags)``: sources of an FMU as a library, or with a program of this folder.

    The sources are compiled once for all programs that are linked with them.
    """
    folders = {}

    def compile_(*line):
        built = run([compiler, "-std=c99", *line])
        if built.returncode != 0 and "sanitize" in built.stderr:
            pytest.skip("no sanitizer runtime")
        assert (built.returncode, built.stderr) == (0, "")

    def make(
        name: str, fmi: int, flags: list[str], program: str | None = None, macros: Sequence[str] = ()
    ) -> Path:
        how = [*flags, "-fPIC" if program is None else "-ffp-contract=off"]
        include = ["-I", standard_folder()] if fmi == 3 else []
        folder = folders.get((name, fmi, *how))
        if folder is None:
            folder, spec = tmp_path_factory.mktemp(f"{name}{fmi}".replace(" ", "_")), model_of(models[name]).spec
            for file, content in source_files(spec, content_guid(spec, fmi), fmi).items():
                (folder / file).write_bytes(content)
            for unit in folder.glob("*.c"):
                compile_(*how, *include, "-I", folder, "-c", unit, "-o", unit.with_suffix(".o"))
            folders[(name, fmi, *how)] = folder
        source = ["-shared"] if program is None else [*macros, *include, "-I", folder, HERE / program]
        made = folder / ("library" if program is None else Path(program).stem)
        compile_(*how, *source, *sorted(folder.glob("*.o")), "-lm", "-o", made)
        return made

    return make


def random_calls_of(name):
    """Macros of `fuzz.c` for a rotor or a bearing: which variables it sets and reads."""
    if name in BEARINGS:
        positive = "VR_lead" if name == "bearing set" else "VR_largest_load_inner"
        given = {"INPUTS": "VR_y,VR_velocity_y", "OUTPUTS": f"{positive},VR_force_x,VR_force_y"}
        return [f"-DFUZZ_{macro}={text}" for macro, text in (given | {"USUAL": "0.0", "STEP": "1e-7"}).items()]
    if name in SHAFTS:
        # the first of them must not be negative, as motions may be
        given = {"INPUTS": "0,FIRST_DRIVE", "OUTPUTS": "VR_mass_scale,VR_angle,FIRST_RATE"}
        return [f"-DFUZZ_{macro}={text}" for macro, text in (given | {"USUAL": "1e2", "STEP": "1e-5"}).items()]
    if name == "speed":
        given = {"INPUTS": "VR_approach,VR_u_sum", "OUTPUTS": "VR_force,VR_stiffness,VR_damping"}
        return [f"-DFUZZ_{macro}={text}" for macro, text in (given | {"USUAL": "0.0", "STEP": "1e-6"}).items()]
    if name not in ROTORS:
        return []
    # the first of them must not be negative, as motions may be
    given = {"INPUTS": "0,1", "OUTPUTS": "VR_inner_step,FIRST_PLACE,FIRST_RATE", "USUAL": "1e3", "STEP": "1e-8"}
    return [f"-DFUZZ_{macro}={text}" for macro, text in given.items()]


def but(few, *others, long=()):
    """Cases of the default suite, those of `pytest -m long`, and others whose C is mostly that of these."""
    marks = ((pytest.mark.long, long), (pytest.mark.slow, others))
    return [*few, *(pytest.param(*case, marks=mark) for mark, cases in marks for case in cases)]


@pytest.mark.parametrize(
    "name",
    but(
        ["shaft"],
        *(("rotor alone",), ("rotor alone in y",), ("bearing planar",), ("bearing dry",)),
        long=(("rotor mixed",), ("bearing five",), ("bearing set",), ("whole rotor",)),
    ),
)
def test_strict_warnings_of_rotors(compiled, name):
    """Those of contacts: in the tests of libraries and of the driver."""
    compiled(name, 2, [*STRICT, "-O2"])


@pytest.mark.parametrize(("fmi", "name"), but([(2, "cubic"), (3, "wide_si")], (3, "cubic"), (3, "power_si")))
def test_a_library_exports_fmi(compiled, extracted, fmi, name):
    """In FMI 2 nothing else: its functions are those of one header."""
    library = compiled(name, fmi, [*STRICT, "-O2"])
    if shutil.which("nm") is None:
        pytest.skip("no nm")
    if fmi == 2:
        (library,) = (Path(extracted[name]) / "binaries" / "linux64").iterdir()
    lines = run(["nm", "-D", "--defined-only", library], check=True).stdout.splitlines()
    exported = {line.split()[-1] for line in lines}
    header = standard_headers(fmi)[f"fmi{fmi}Functions.h"].decode()
    declared = set(re.findall(rf"FMI{fmi}_Export\s+fmi{fmi}\w+TYPE\s+(fmi{fmi}\w+);", header))
    assert len(declared) == 44 if fmi == 2 else len(declared) > 70
    assert declared <= exported
    assert fmi == 3 or {symbol for symbol in exported if not symbol.startswith("_")} == declared


@pytest.mark.parametrize(
    ("fmi", "name"),
    but(
        [
            *((2, name) for name in ("cubic", "shaft")),
            (3, "wide_si"),
        ],
        *((2, name) for name in ("polynomial", "power_si", "memory", "rotor alone", "rotor wide in y")),
        *((2, "bearing planar"), (3, "cubic")),
        long=(
            *(
                (2, name)
                for name in ("speed", "wide_si", "rotor mixed", "bearing five", "bearing set", "whole rotor")
            ),
            *((3, name) for name in ("speed", "rotor mixed", "bearing set")),
        ),
    ),
)
def test_random_calls_under_sanitizers(compiled, fmi, name):
    calls = 2 * FEW if name in ROTORS else FEW // 4 if name in BEARINGS + SHAFTS else FEW
    if name == "whole rotor":
        calls //= 4  # a step of it is that of all its balls
    done = run([compiled(name, fmi, SANITIZED, FUZZ[fmi], random_calls_of(name)), calls, 1])
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", CONTACTS + BEARINGS + SHAFTS)
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_million_random_calls_under_sanitizers(compiled, fmi, name):
    program = compiled(name, fmi, SANITIZED, FUZZ[fmi], random_calls_of(name))
    for seed in (2, 3):
        done = run([program, MANY // len(CONTACTS) // 2, seed])
        assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", but(["cubic", "wide_si"], ("polynomial",), ("power_si",), ("memory",)))
def test_driver_under_sanitizers_agrees_with_python(compiled, elements, name):
    element = elements[name]
    h, u, v, expected, scales = wanted(element)
    text = "".join(f"{a!r} {b!r} {c!r}\n" for a, b, c in zip(h.tolist(), u.tolist(), v.tolist(), strict=True))
    done = run([compiled(name, 2, SANITIZED, "driver.c")], input=text)
    assert done.returncode == 0, done.stderr
    found = np.array(done.stdout.split(), dtype=float).reshape(-1, 3)
    assert found.shape == (u.size, 3)
    for k, (values, scale) in enumerate(zip(expected, scales, strict=True)):  # of a film the force alone
        assert np.allclose(found[:, k], values, rtol=1e-12, atol=1e-15 * scale)


def wanted(element):
    """Steps, approaches and rates; what an element says to each, and the size of it."""
    if element.state_count:
        T, u, v = film_motion(element)
        # from where the driver begins: at rest under the reference load
        T, u, v = np.append(-T[1], T), np.append(element.approach_at(element._units[0]), u), np.append(0.0, v)
        return np.diff(T), u[1:], v[1:], [element.drive(T, u, v)[1:]], [element._units[0]]
    u, v = state_grid(element)
    functions = (element.force, element.stiffness, element.damping)
    scales = element.step_tangents(1.0, element.high, 0.0)
    return np.full(u.size, 1e-3), u, v, [function(u, v) for function in functions], scales


@pytest.fixture
def valgrind() -> list[str]:
    """The command; a leak, or a use of memory that holds nothing, ends with its exit code."""
    program = shutil.which("valgrind")
    if program is None:
        pytest.skip("valgrind is not installed")
    return [program, "--quiet", "--error-exitcode=99", "--leak-check=full", "--errors-for-leak-kinds=all"]


@pytest.mark.slow
@pytest.mark.parametrize("name", CONTACTS)
@pytest.mark.parametrize("fmi", [2, 3])
def test_random_calls_under_valgrind(compiled, valgrind, fmi, name):
    done = run([*valgrind, compiled(name, fmi, ["-g", "-O1"], FUZZ[fmi]), UNDER_VALGRIND, 4])
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cubic", "wide_si"])
def test_driver_under_valgrind(compiled, valgrind, elements, name):
    u = contact_spec(elements[name])["approach"].start
    done = run([*valgrind, compiled(name, 2, ["-g", "-O1"], "driver.c")], input=f"1e-6 {u!r} 0.0\n")
    assert (done.returncode, done.stderr) == (0, "")
    assert len(done.stdout.split()) == 3


def test_valgrind_sees_what_is_wrong(compiler, valgrind, tmp_path):
    """A leak and a number that was never written."""
    for k, body in enumerate(("return malloc(8) == NULL;", 'int x[2]; return x[1] == 3 ? puts("") : 0;')):
        source, program = tmp_path / f"{k}.c", tmp_path / f"{k}"
        source.write_text(f"#include <stdio.h>\n#include <stdlib.h>\nint main(void) {{ {body} }}\n")
        run([compiler, "-O0", source, "-o", program], check=True)
        assert run([*valgrind, program]).returncode == 99


@pytest.mark.long
def test_sources_in_the_fmu_build_by_cmake(fmus, elements, tmp_path):
    if shutil.which("cmake") is None:
        pytest.skip("no cmake")
    folder, build = tmp_path / "fmu", tmp_path / "build"
    build.mkdir()
    fmpy.extract(str(fmus["wide_si"]), unzipdir=str(folder))
    (library,) = (folder / "binaries" / "linux64").iterdir()
    library.unlink()
    build_platform_binary(folder, build_dir=build)
    assert library.is_file()
    rebuilt = tmp_path / "rebuilt.fmu"
    with zipfile.ZipFile(rebuilt, "w") as archive:
        for path in folder.rglob("*"):
            archive.write(path, path.relative_to(folder))
    assert verify(rebuilt, elements["wide_si"]).passes


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", ["cubic", "linear", "cubic_si", *ROTORS])
def test_other_checkers_find_nothing(elements, unit, name, fmi, tmp_path):
    """fmpy's validation and fmutool."""
    pytest.importorskip("fmu_manipulation_toolbox")
    if name in ROTORS:
        path = unit(name.removeprefix("rotor "), fmi).path
    else:
        path = export(elements[name], tmp_path / "x.fmu", fmi=fmi)
    assert validate_fmu(str(path)) == []
    done = run([Path(sys.executable).with_name("fmutool"), "-input", path, "-check"])
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert f"compliant with FMI-{fmi}.0" in said and "No semantic error" in said
    assert "WARNING" not in said and "ERROR" not in said


def test_equal_contacts_share_a_law(rotors):
    names = {}
    for name in ("wide", "mixed"):
        model = rotors[name].model
        laws = laws_of(model, [contact_spec(element) for element in model.elements])
        names[name], texts = law_names(model, laws)
        assert all("model_step contact_law_" in text and '#include "' not in text for text in texts.values())
    assert names == {"wide": ["contact_law_1"] * 2, "mixed": ["contact_law_1", "contact_law_2"]}


def test_sources_are_ascii():
    for path in (path for folder in SOURCE_FOLDERS for path in folder.rglob("*.[ch]")):
        assert "\t" not in path.read_bytes().decode("ascii")
