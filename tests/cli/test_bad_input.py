"""Bad input: exit 2 and one line that names the field, its value and what is allowed."""

import h5py
import pytest
from tiny_study import STUDY

GOOD = {"--M": "20", "--L": "5", "--kappa": "0.5"}


def steady(**changes):
    options = GOOD | {f"--{name}": value for name, value in changes.items()}
    return ["steady", *(part for pair in options.items() for part in pair)]


def test_a_grid_that_would_not_fit_into_memory(refused, monkeypatch, tmp_path):
    """Said before anything is tried or written."""
    monkeypatch.setattr("ehlcontact.solver.memory.available_bytes", lambda: 5e6)
    point = [part for pair in GOOD.items() for part in pair]
    words = ("n = 256", "fits into memory", "nodes take about", "GB", "0.005 GB are free")
    for command in (["steady"], ["simulate", "--free", "5"], ["impedance", "--Omega", "1"]):
        refused(("--" + words[0], *words[1:]), *command, *point, "--n", "256")
    kept = tmp_path / "kept.h5"
    kept.write_bytes(b"a result of old")
    refused(words, *steady(n="256"), "--save", kept)
    assert kept.read_bytes() == b"a result of old"
    study = tmp_path / "study.toml"
    study.write_text(STUDY.replace("n_transient = 32", "n_transient = 64"))
    refused(("study.toml: solver.n_transient = 64", *words[1:]), "run", study, "-o", tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("field", "value", "allowed"),
    [
        ("M", "0", "> 0"),
        ("M", "-20", "> 0"),
        ("M", "nan", "> 0"),
        ("M", "inf", "> 0"),
        ("L", "-1", ">= 0"),
        ("L", "nan", ">= 0"),
        ("kappa", "0", "between 0.01 and 100"),
        ("kappa", "1e-3", "between 0.01 and 100"),
        ("alpha", "0", "> 0"),
        ("alpha", "-1e-8", "> 0"),
        ("eta0", "0", "> 0"),
        ("eta0", "1e-6", "6.31e-5"),
        ("viscosity", "honey", "roelands"),
        ("density", "lead", "dowson-higginson"),
        ("n", "100", "multiple of 16"),
        ("n", "0", "multiple of 16"),
        ("n", "4096", "2048"),
    ],
)
def test_operating_point_and_grid(refused, field, value, allowed):
    shown = value if field in ("viscosity", "density") else f"{float(value):g}"
    words = (field, allowed) if field == "eta0" else (field, shown.lstrip("-").split("e-")[0], allowed)
    refused(words, *steady(**{field: value}))


@pytest.mark.parametrize(
    ("bounds", "words"),
    [
        (("-1", "1.5", "3"), ("--domain XA", "-1.0", "-1.2")),
        (("-4", "1", "3"), ("--domain XB", "1.0", "1.2")),
        (("-4", "1.5", "nan"), ("--domain YMAX", "nan", "finite")),
    ],
)
def test_domain(refused, bounds, words):
    refused(words, *steady(), "--domain", *bounds)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], ("motion", "--free, --harmonic, --ramp")),
        (["--free", "5", "--harmonic", "3"], ("motion", "exactly one")),
        (["--ramp", "3", "1"], ("--omega-n", "--ramp")),
        (["--ramp", "-3", "1", "--omega-n", "2"], ("--ramp RATIO", "-3.0", "> 0")),
        (["--free", "0"], ("--free", "0.0", "> 0")),
        (["--free", "nan"], ("--free", "nan", "> 0")),
        (["--free", "5", "--amplitude", "0.2"], ("--amplitude", "0.2", "--harmonic")),
        (["--free", "5", "--omega-n", "2"], ("--omega-n", "2.0", "--harmonic or --ramp")),
        (["--harmonic", "3", "--rate", "0.1"], ("--rate", "0.1", "--free")),
        (["--harmonic", "3", "--amplitude", "1.5"], ("amplitude", "1.5", "below 1")),
        (["--harmonic", "3", "--until", "-1"], ("until", "-1.0", "> 0")),
        (["--harmonic", "3", "--dt", "nan"], ("dt", "nan", "> 0")),
        (["--harmonic", "3", "--until", "1", "--dt", "2"], ("--dt", "2.0", "until")),
        (["--harmonic", "3", "--error", "0"], ("error", "0.0", "> 0")),
        (["--harmonic", "3", "--error", "0.5"], ("error", "0.5", "0.1")),
        (["--harmonic", "3", "--checkpoint", "c.txt"], ("--checkpoint", "c.txt", ".h5")),
        (["--harmonic", "3", "--checkpoint", "none/c.h5"], ("--checkpoint", "none/c.h5", "exists")),
        (["--harmonic", "3", "--restart", "none.h5"], ("restart", "none.h5", "checkpoint")),
    ],
)
def test_motions(refused, point, options, words):
    refused(words, "simulate", *point, "--n", "32", *options)


@pytest.mark.parametrize("option", ["--save", "--json"])
def test_results_need_a_place_before_anything_is_solved(refused, point, tmp_path, monkeypatch, option):
    monkeypatch.setattr("ehlcontact.steady.solve_steady", None)  # never reached
    (tmp_path / "file").write_text("")
    name = "r.h5" if option == "--save" else "r.json"
    refused((option, "none", "exists"), "steady", *point, option, tmp_path / "none" / name)
    refused((option, "file", "exists"), "steady", *point, option, tmp_path / "file" / name)
    refused((option, "ending" if option == "--save" else "not a folder"), "steady", *point, option, tmp_path)
    refused((option, "/proc/"), "steady", *point, option, f"/proc/{name}")


def test_files_that_are_not_ours(refused, tmp_path):
    (tmp_path / "text.h5").write_text("not HDF5")
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["x"] = [1.0]
    whole = (tmp_path / "foreign.h5").read_bytes()
    (tmp_path / "cut.h5").write_bytes(whole[: len(whole) // 2])
    for name in ("none.h5", "text.h5", "foreign.h5", "cut.h5"):
        refused(("file", name, "must be"), "fit", tmp_path / name)
    (tmp_path / "cut.json").write_text('{"schema": "ehlcontact-element", "ver')
    (tmp_path / "foreign.json").write_text('{"a": 1}')
    for name in ("none.json", "cut.json", "foreign.json"):
        refused((name, "must be"), "export", tmp_path / name, "-o", tmp_path / "x.fmu")


def test_memory_takes_whole_records(refused):
    refused(("--window", "memory"), "fit", "r.h5", "--model", "memory", "--window", "1", "2")


@pytest.mark.parametrize("option", ["--hz", "--rpm", "--frequency"])
@pytest.mark.parametrize("command", [("impedance",), ("element", "--model", "cubic")])
def test_frequencies_in_si_are_sent_to_their_dimensionless_name(refused, point, command, option):
    refused((option, "--Omega", "2a/u_sum", "no unit of time"), *command, *point, option, "50")


def test_export_options(refused, tmp_path):
    refused(("--model", "quartic", "linear"), "fit", "r.h5", "--model", "quartic")
    refused(("--fmi", "7", "2 or 3"), "export", "e.json", "-o", "x.fmu", "--fmi", "7")
    refused(("bearing.toml", "readable TOML"), "export", "bearing.toml", "-o", "x.fmu")
    refused(("--output", ".fmu"), "export", "e.json", "-o", tmp_path / "x.zip")
    refused(("--output", "exists"), "export", "e.json", "-o", tmp_path / "none" / "x.fmu")
