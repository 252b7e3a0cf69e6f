"""Files of every kind that are damaged, foreign or absurd: changes of a sound file, and commands that read it."""

import io
import json
import os
import zipfile
from pathlib import Path

import h5py
import numpy as np
from argument_groups import grouped
from tiny_study import SMALL

from ehlcontact import Grid, HarmonicLoad, MoesPoint, save, simulate, solve_steady
from reduced_models import SpringContact
from reduced_models.atlas.surface import shipped_file

POINT = ("--M", "20", "--L", "5", "--kappa", "0.5")
RUN = {"n": 32, "until": 0.2, "dt": 0.05}
STUDY = SMALL
DEEP = '{"a":' * 100_000 + "1" + "}" * 100_000

COMMANDS = {  # what reads a kind of file: arguments for its name and for a folder of results
    "result": lambda file, out: ("fit", file, "--save", out / "kept.json"),
    "checkpoint": lambda file, out: (
        *("simulate", *POINT, "--n", "32", "--harmonic", "3", "--until", "0.2", "--dt", "0.05"),
        *("--restart", file, "--save", out / "kept.h5"),
    ),
    "element": lambda file, out: ("export", file, "-o", out / "kept.fmu", "--force"),
    "study": lambda file, out: ("run", file, "-o", out / "new"),
    "atlas": lambda file, out: ("element", *POINT, "--atlas", file, "--save", out / "kept.json"),
}
SUFFIX = {
    "result": ".h5",
    "checkpoint": ".h5",
    "element": ".json",
    "study": ".toml",
    "atlas": ".h5",
}


def make_good(folder):
    """Content of a sound file of every kind, and of a steady film."""
    point = MoesPoint(20, 5, 0.5)
    save(
        simulate(point, HarmonicLoad(Omega=3.0), **grouped(**RUN, checkpoint=folder / "checkpoint")),
        folder / "result",
    )
    save(solve_steady(point, grid=Grid(n=16), throw=False), folder / "steady")
    save(SpringContact.cubic(K1=1.0, K2=0.1, K3=0.1, C1=0.01, low=0.7, high=1.0), folder / "element")
    (folder / "study").write_text(STUDY)
    (folder / "atlas").write_bytes(shipped_file("film").read_bytes())
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def content(kind, data):
    """The same bytes, whatever the good file."""
    return lambda good: data if isinstance(data, bytes) else data.encode()


def cut(share):
    return lambda good: good[: int(share * len(good))]


def of(kind):
    """The sound file of another kind."""
    return kind


def hdf5(edit, mode="a"):
    """The HDF5 file edited by ``edit(file)``; in mode "w" a new one."""

    def made(good):
        stream = io.BytesIO(good if mode == "a" else b"")
        with h5py.File(stream, mode) as file:
            edit(file)
        return stream.getvalue()

    return made


def array(name, change):
    def edit(file):
        new = change(file[name][...])
        del file[name]
        file[name] = new

    return hdf5(edit)


def attribute(name, value):
    return hdf5(lambda file: file.attrs.__setitem__(name, value))


def header_of(**changes):
    """An HDF5 file with other entries in its header."""

    def edit(file):
        entries = json.loads(file.attrs["header"]) | changes
        file.attrs["header"] = json.dumps({key: value for key, value in entries.items() if value is not None})

    return hdf5(edit)


def promised(file):
    """An array of 8 TB, of which nothing is there."""
    del file["t"]
    file.create_dataset("t", shape=(10**12,), dtype=float)


def flipped(at):
    def made(good):
        data = bytearray(good)
        data[int(at * len(data))] ^= 0xFF
        return bytes(data)

    return made


def flipped_number(good):
    """A byte of an array altered: one in the middle of the file may lie in a gap between them."""
    found = []
    with h5py.File(io.BytesIO(good)) as file:
        file.visititems(lambda _, one: found.append(one.id) if getattr(one, "chunks", None) else None)
        chunk = found[len(found) // 2].get_chunk_info(0)
        at = chunk.byte_offset + chunk.size // 2
    return flipped((at + 0.5) / len(good))(good)


def element(**changes):
    def made(good):
        document = json.loads(good)
        for key, value in changes.items():
            document[key] = value if not isinstance(value, dict) else document[key] | value
        return json.dumps(document).encode()

    return made


def study(old, new):
    assert old in STUDY
    return lambda good: STUDY.replace(old, new, 1).encode()


def metadata(**changes):
    """An atlas with other metadata."""

    def edit(file):
        file.attrs["metadata"] = json.dumps(json.loads(file.attrs["metadata"]) | changes)

    return hdf5(edit)


def zipped(good):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as file:
        file.writestr("a.txt", "text")
    return stream.getvalue()


def stored(value, **options):
    stream = io.BytesIO()
    np.save(stream, value, **options)
    return stream.getvalue()


ANY = {  # of any kind; a study may not be empty
    "binary": lambda good: bytes(range(256)) * 8,
    "utf-16": lambda good: "[a]\nb = 1\n".encode("utf-16"),
    "a picture": lambda good: b"\x89PNG\r\n\x1a\n" + bytes(100),
    "half": cut(0.5),
    "text": lambda good: b"T,u\n0,1\n",
}
HDF5 = {
    "empty": cut(0.0),
    "only begun": cut(0.02),
    "nearly whole": cut(0.999),
    "signature": lambda good: good[:8],
    "byte in the structure": flipped(0.005),
    "byte of a number": flipped_number,
    "foreign": hdf5(lambda file: file.__setitem__("P", np.zeros(3)), "w"),
    "class of others": hdf5(lambda file: file.attrs.__setitem__("header", '{"class": "Sofa", "format": 1}'), "w"),
    "header that is an array": hdf5(lambda file: file.attrs.__setitem__("header", np.zeros(3)), "w"),
    "no header": hdf5(lambda file: file.attrs.__delitem__("header")),
    "newer": header_of(format=99),
    "format in words": header_of(format="one"),
    "no format": header_of(format=None),
    "a class without end": header_of(**{"class": "x" * 100_000}),
}
VERSION = {"version that is no text": attribute("version", 3.0), "deep": attribute("version", DEEP)}
BAD = {
    "result": HDF5
    | VERSION
    | {
        "a steady film": of("steady"),
        "a checkpoint": of("checkpoint"),
        "an atlas": of("atlas"),
        "no fields": hdf5(
            lambda file: file.attrs.__setitem__("header", '{"class": "SimulationResult", "format": 2}'), "w"
        ),
        "times in words": array("t", lambda old: np.array([b"a"] * old.size)),
        "times in rows": array("t", lambda old: old[None, :]),
        "times that are no numbers": array("t", lambda old: old * np.nan),
        "times that fall": array("t", lambda old: old[::-1]),
        "too few forces": array("force", lambda old: old[:-1]),
        "no force": hdf5(lambda file: file.__delitem__("force")),
        "a group for an array": hdf5(lambda file: (file.__delitem__("force"), file.create_group("force"))),
        "a number for an array": hdf5(lambda file: (file.__delitem__("t"), file.attrs.__setitem__("t", "1.0"))),
        "an array for a number": hdf5(lambda file: (file.attrs.__delitem__("n"), file.__setitem__("n", [1.0]))),
        "a link to itself": hdf5(lambda f: (f.__delitem__("t"), f.__setitem__("t", h5py.SoftLink("/t")))),
        "a link into nowhere": hdf5(
            lambda f: (f.__delitem__("t"), f.__setitem__("t", h5py.ExternalLink("x", "t")))
        ),
        "an array without end": hdf5(promised),
        "unknown status": attribute("status", '"sleepy"'),
        "not converged": attribute("status", '"stagnated"'),
        "impossible point": attribute("point", '{"M": -1, "L": 5, "kappa": 0.5}'),
        "half a point": attribute("point", '{"M": 20}'),
        "a point that breaks off": attribute("point", "{"),
        "half of a point in SI": attribute("point", '{"load": 20.0, "u_sum": 1.0}'),
        "unknown motion": attribute("motion", '{"kind": "waltz"}'),
        "domain in words": attribute("domain", '"wide"'),
        "another n": attribute("n", "48"),
        "n in words": attribute("n", '"many"'),
    },
    "checkpoint": HDF5
    | VERSION
    | {
        "a result": of("result"),
        "older": header_of(format=0),
        "another version": attribute("version", '"0.0.1"'),
        "no inputs": hdf5(lambda file: file.attrs.__delitem__("inputs")),
        "inputs in words": attribute("inputs", '"none"'),
        "too few films": array("record/h_midplane", lambda old: old[:-1]),
        "no entries": array("record/t", lambda old: old[:0]),
        "entries that are no numbers": array("record/force", lambda old: np.full_like(old, np.nan)),
        "no force": hdf5(lambda file: file["record"].__delitem__("force")),
        "a layer of a flooded contact": hdf5(
            lambda file: file.__setitem__("record/layer_behind", file["record/p_midplane"][...])
        ),
        "films in rows": array("record/h_midplane", lambda old: old[:, :-1]),
        "snapshots of no time": array("record/snapshot_t", lambda old: np.zeros(3)),
        "half a factor": array("film/factors/lu/0", lambda old: old[:-1]),
        "another grid": array("film/P", lambda old: old[:-1, :-1]),
        "no numbers": array("film/mass", lambda old: old * np.nan),
        "no film": hdf5(lambda file: file.__delitem__("film")),
        "scale in words": attribute("scale", '"large"'),
    },
    "element": {
        "empty": cut(0.0),
        "null": content("element", "null"),
        "a list": content("element", "[1, 2]"),
        "a number": content("element", "5"),
        "deep": content("element", DEEP),
        "deep lists": content("element", "[" * 100_000),
        "deep parameters": lambda good: good.replace(b'"K1": 1.0', b'"K1": ' + DEEP.encode()),
        "nan": content("element", '{"header": NaN}'),
        "no header at all": content("element", '{"a": 1}'),
        "5000 digits": lambda good: good.replace(b'"K1": 1.0', b'"K1": ' + b"9" * 5000),
        "400 digits": lambda good: good.replace(b'"K1": 1.0', b'"K1": ' + b"9" * 400),
        "too large a number": lambda good: good.replace(b'"K1": 1.0', b'"K1": 1e999'),
        "half a character": lambda good: good.replace(b'"cubic"', rb'"\ud800"'),
        "half a character in its source": lambda good: good.replace(
            b'"source": null', rb'"source": {"a": "\udfff"}'
        ),
        "a key twice": lambda good: good.replace(b'"K1": 1.0', b'"K1": 2.0, "K1": 1.0'),
        "a key of others": element(remark="mine"),
        "a parameter of others": element(parameters={"K4": 1.0}),
        "a bound of others": element(valid={"temperature": 50.0}),
        "a band below 0": element(valid={"omega": [-1, 5]}),
        "stiffness of no contact": element(parameters={"K1": 1e200}),
        "rate of no contact": element(valid={"rate": 1e200}),
        "no header": element(header=None),
        "a bearing": element(header={"class": "BallBearing"}),
        "another class": element(header={"class": "FilmContact"}),
        "class of others": element(header={"class": "Sofa"}),
        "newer": element(header={"format": 99}),
        "format in words": element(header={"format": "1"}),
        "kind of others": element(kind="spline"),
        "a long kind": element(kind="x" * 100_000),
        "units of others": element(units="mm"),
        "parameters in a list": element(parameters=[1, 2]),
        "parameter in words": element(parameters={"K1": "one"}),
        "parameter that is true": element(parameters={"K1": True}),
        "no contact": element(parameters={"C1": -1.0}),
        "no range": element(valid={"low": None}),
        "a range that falls": element(valid={"low": 2.0}),
        "source in words": element(source="here"),
    },
    "study": {
        "empty": cut(0.0),
        "deep": content("study", "a = " + "[" * 100_000),
        "5000 digits": study("balls = 9", "balls = " + "9" * 5000),
        "half a character": study('race = "inner"', 'race = "\\ud800"'),
        "zero byte": study('race = "inner"', 'race = "\0"'),
        "twice": study("balls = 9", "balls = 9\nballs = 9"),
        "a date": study("balls = 9", "balls = 2026-01-01"),
        "a list": study("balls = 9", "balls = [9, [9]]"),
        "JSON": content("study", '{"bearing": {}}'),
    },
    "atlas": HDF5
    | {
        "a zip file": zipped,
        "one array": lambda good: stored(np.zeros(3)),
        "a pickled object": lambda good: stored(np.array([{}], dtype=object), allow_pickle=True),
        "a result": of("result"),
        "metadata in a list": attribute("metadata", "[]"),
        "no box": metadata(box=5),
        "no metadata": hdf5(lambda file: file.attrs.__delitem__("metadata")),
        "no damping": hdf5(lambda file: file.__delitem__("columns/damping")),
        "too few points": array("points", lambda old: old[:-1]),
        "no numbers": array("columns/damping", lambda old: old * np.nan),
        "words": array("columns/damping", lambda old: old.astype("S8")),
    },
}
for kind, table in BAD.items():
    table |= {name: made for name, made in ANY.items() if (kind, name) not in {("study", "half")}}
MISSING = ("missing", "a folder", "too long", "below a file", "not text", "a pipe")


def missing(folder, kind, name):
    """A path of that kind at which no file can be read."""
    suffix = SUFFIX[kind]
    (folder / "file").write_text("")
    (folder / f"folder{suffix}").mkdir()
    os.mkfifo(folder / f"pipe{suffix}")
    return {
        "missing": folder / f"none{suffix}",
        "a folder": folder / f"folder{suffix}",
        "too long": folder / ("x" * 300 + suffix),
        "below a file": folder / "file" / f"x{suffix}",
        "a pipe": folder / f"pipe{suffix}",
        "not text": Path(os.fsdecode(os.fsencode(folder) + b"/\xff" + suffix.encode())),
    }[name]
