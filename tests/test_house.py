"""Rules that no linter checks: docstrings, silence, one decorator of kernels, the wheel, light imports."""

import ast
import re
import subprocess
import sys
import tomllib
from importlib.resources import files
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("ehlcontact", "reduced_models", "fmu")
SOURCES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
NAMES = [str(path.relative_to(ROOT)) for path in SOURCES]
FOLDERS = sorted({str(Path(name).parent) for name in NAMES})


def test_all_packages_were_found():
    assert {name.split("/")[0] for name in NAMES} == set(PACKAGES)
    assert len(NAMES) > 40


def public(tree, prefix=""):
    """Public functions, classes and methods of a module, with dotted names."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) and node.name[0] != "_":
            if any(ast.unparse(decorator) == "overload" for decorator in node.decorator_list):
                continue  # a signature; the function itself is described
            yield prefix + node.name, node
            if isinstance(node, ast.ClassDef):
                yield from public(node, f"{prefix}{node.name}.")


def test_everything_public_is_described():
    missing = []
    for name, path in zip(NAMES, SOURCES, strict=True):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        missing += [] if ast.get_docstring(tree) else [name]
        missing += [f"{name}: {what}" for what, node in public(tree) if not ast.get_docstring(node)]
    assert missing == []


def test_every_folder_opens_with_a_table_of_its_modules():
    for folder in FOLDERS:
        table = ast.get_docstring(ast.parse((ROOT / folder / "__init__.py").read_text(encoding="utf-8")))
        rows = re.findall(r"^(?:\| ([\w/]+) \||``([\w/]+)`` )", table, flags=re.M)
        listed = {(first or second).rstrip("/") for first, second in rows} - {"module", "package"}
        entries = {path.stem for path in (ROOT / folder).glob("*.py")} - {"__init__", "__main__"}
        entries |= {Path(inner).name for inner in FOLDERS if str(Path(inner).parent) == folder}
        assert listed - {"csrc"} == entries, folder


def test_library_is_silent():
    calls = [
        f"{name}:{node.lineno}"
        for name, path in zip(NAMES, SOURCES, strict=True)
        if not name.startswith("ehlcontact/cli/")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in ("print", "breakpoint")
    ]
    assert calls == []


def test_kernels_have_one_decorator():
    """Numba's options are set in one place; see `ehlcontact/jit.py` for why not fastmath."""
    stray = [
        name
        for name in NAMES
        if name != "ehlcontact/jit.py" and "njit" in (ROOT / name).read_text(encoding="utf-8")
    ]
    assert stray == []


def relative(folder, pattern):
    return {str(path.relative_to(folder)) for path in Path(str(folder)).rglob(pattern)}


def test_data_files_are_installed():
    """What the checkout has, the imported package has too: in CI that is the one from the wheel."""
    data = {
        "fmu": ("*.c", "*.h", "*.txt", "*.png", "py.typed"),
        "ehlcontact": ("*.j2", "*.js", "*.css", "py.typed", "*.csv"),
        "reduced_models": ("py.typed", "*.h5", "*.c", "*.h"),
    }
    for package, patterns in data.items():
        for pattern in patterns:
            wanted = relative(ROOT / package, pattern)
            assert wanted and wanted <= relative(files(package), pattern), (package, pattern)


def test_wheel_takes_whole_packages():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    wheel = project["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert wheel == {"packages": list(PACKAGES)}
    ignored = (ROOT / ".gitignore").read_text(encoding="utf-8").split()
    assert not {"*.c", "*.h", "csrc/", "fmu/", "*.j2", "*.js", "*.css"} & set(
        ignored
    )  # hatchling leaves out what git ignores


def test_import_is_light():
    """Heavy or optional libraries are imported where they are used."""
    heavy = ("matplotlib", "fmpy", "control", "typer", "rich", "pydantic", "jinja2", "ross", "plotly")
    heavy += ("xarray", "pandas", "pint")
    code = f"import sys, {', '.join(PACKAGES)}; print(*[m for m in {heavy!r} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_version_is_stated_once_and_alike():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    from ehlcontact import __version__

    assert project["project"]["version"] == __version__


def test_parts_of_scipy_are_loaded_by_what_needs_them():
    """``scipy.optimize.brentq``, not from an import at the top: a third of the start of a program."""
    loads = [
        name
        for name, path in zip(NAMES, SOURCES, strict=True)
        if re.search(r"^from scipy", path.read_text(), re.M)
    ]
    assert loads == []


def called(node):
    """Calls of an expression that are made as it is read: not those of functions in it."""
    if isinstance(node, ast.Call):
        yield ast.unparse(node.func)
    if not isinstance(node, ast.Lambda):
        for part in ast.iter_child_nodes(node):
            yield from called(part)


def test_tests_solve_nothing_while_they_are_collected():
    """Every worker collects all tests, and would compile the solver."""
    solves, found = {"solve_steady", "simulate", "impedance", "OilBalance"}, []
    for path in (ROOT / "tests").rglob("test_*.py"):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.Assign) and solves & set(called(node.value)):
                found.append(f"{path.name}:{node.lineno}")
    assert found == []
