"""`save` and `read`: files of results, elements and bearings. What was computed, by hash: `content_store`.

Every file begins with the same header: class, format number, version of the library. Classes with ``from_dict``
(elements and bearings, which people read and edit) become JSON of their ``to_dict``; all others become HDF5:

================================================ =========================================================
value                                            in the HDF5 file
================================================ =========================================================
array                                            dataset; its order in memory is kept
dataclass or sequence that holds arrays          group; members by name or number
everything else                                  attribute, JSON; where there is a ``to_dict``, of that
================================================ =========================================================

A class is registered by the decorator `stored`. It is rebuilt from the annotations of its fields, or by
``from_dict``, and then checked by its ``require_complete``, if it has one.
"""

from __future__ import annotations

import json
import os
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path
from reprlib import repr as shortened
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

import h5py
import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import shown
from ehlcontact.checks.kinds import FILE
from ehlcontact.errors import InputError
from ehlcontact.files import is_file, parse_json, read_text, write_bytes
from ehlcontact.version import __version__

WRITTEN = "JSON or HDF5 as `save` writes it"
HEADER = "header"  # its key in JSON, its attribute in HDF5
SIGNATURE = b"\x89HDF\r\n\x1a\n"  # first bytes of an HDF5 file
# Layout of HDF5 itself: the first with checksums on all its structure; read by HDF5 1.10 (2016) and newer.
LAYOUT = ("v110", "v110")
NUMBERS = "bfiuc"  # kinds of dtype that are stored
PLAIN: dict[Any, Any] = {float: (float, int), int: int, str: str}  # what JSON may hold for an annotation
ARRAYS = np.ndarray, get_origin(NDArray[Any])  # origins of hints of arrays: from numpy 2.5 on an alias
PACKAGES = ("ehlcontact", "reduced_models")  # their public classes are registered when they are imported

T = TypeVar("T")


@dataclass(frozen=True)
class _Stored:
    """A registered class."""

    cls: type[Any]
    what: str
    number: int


_NOTHING = _Stored(NoneType, "nothing", 0)
_classes: dict[str, _Stored] = {}


def stored(what: str, number: int = 1) -> Callable[[type[T]], type[T]]:
    """Register a class for `save` and `read`.

    Parameters
    ----------
    what : str
        What an instance is called in messages.
    number : int
        Format number, raised when fields change their meaning.
    """

    def register(cls: type[T]) -> type[T]:
        _classes[cls.__name__] = _Stored(cls, what, number)
        return cls

    return register


def save(record: Any, path: str | os.PathLike[str], field: str = "path") -> Path:
    """Write a result, an element or a bearing, replacing an existing file in one move, or not at all.

    Parameters
    ----------
    record : object
        Of a registered class. Elements and bearings become JSON, results HDF5.
    path : path
    field : str
        Name of the path in messages.

    Raises
    ------
    InputError
        No object that can be saved; the folder does not exist or cannot be written to.
    """
    FILE.take(field, path, False)
    return write_bytes(path, content_of(record), field)


def content_of(record: Any) -> bytes:
    """Content of the file of a result, an element or a bearing; raises `InputError` for anything else."""
    entry = _classes.get(type(record).__name__)
    if entry is None or type(record) is not entry.cls:
        raise InputError("object to save", shown(record), _wanted(object))
    header = {"class": type(record).__name__, "format": entry.number, "version": __version__}
    if hasattr(record, "from_dict"):
        document = {HEADER: header, **record.to_dict()}
        return (json.dumps(document, indent=2, allow_nan=False) + "\n").encode()
    # In memory, because HDF5 cannot close what it cannot flush: on a full disk the process ends in a segmentation
    # fault, whatever was caught. It costs the size of the file, twice for a moment.
    with h5py.File(uuid.uuid4().hex, "w", driver="core", backing_store=False, libver=LAYOUT) as file:
        set_text(file, HEADER, json.dumps(header))
        for name, value in _tree(record).items():
            _put(file, name, value)
        file.flush()
        return bytes(file.id.get_file_image())


def read(path: str | os.PathLike[str], kind: type[T] = object, field: str = "file") -> T:  # type: ignore[assignment]
    """Read what `save` wrote.

    Parameters
    ----------
    path : path
    kind : type
        Class, or base class, that is wanted; by default any.
    field : str
        Name of the path in messages.

    Raises
    ------
    InputError
        No such file; none of this library; truncated or damaged; of another class or format than wanted. The
        message names the file and what is wrong with it.
    """
    if not isinstance(kind, type):
        raise InputError("kind", shown(kind), "a class of results, elements or bearings")
    FILE.take(field, path, False)
    name, wanted = str(path), _wanted(kind)
    reader = _read_hdf5 if _is_hdf5(path) else _read_json
    try:
        header, content = reader(path)
    except OSError as error:
        raise InputError(field, name, f"a readable {wanted} ({error.strerror or 'damaged'})") from None
    except UnicodeDecodeError:  # neither HDF5 nor text
        raise InputError(field, name, f"a complete file of a {wanted}, {WRITTEN}{_other_kind(path)}") from None
    except (TypeError, ValueError) as error:  # no path; no JSON
        raise InputError(field, name, f"a complete file of a {wanted}, {WRITTEN} ({error})") from None
    except Exception:  # whatever h5py and numpy raise on what is damaged
        raise InputError(field, name, f"a complete file of a {wanted}") from None
    entry, wrong = _entry(header, kind)
    if wrong:
        raise InputError(field, name, f"a {wanted}{wrong}")
    try:
        record = _build(entry.cls, content)
        if hasattr(record, "require_complete"):
            record.require_complete()
    except InputError as error:
        raise InputError(f"{name}: {error.field}", error.value, error.allowed) from None
    except Exception as error:  # whatever classes raise on what is missing or does not fit
        reason = f" ({error})" if type(error) is ValueError else ""
        raise InputError(field, name, f"a complete file of a {wanted}{reason}") from None
    return cast(T, record)


def _other_kind(path: str | os.PathLike[str]) -> str:
    """What a file that `save` did not write looks like, in words; else empty."""
    with open(path, "rb") as file:
        archive = file.read(4) == b"PK\x03\x04"
    return "; this one is a zip archive, as FMUs are, which fmu.verify takes" if archive else ""


def _wanted(kind: type[Any]) -> str:
    """Classes that would do, in words."""
    found = sorted({entry.what for entry in _classes.values() if issubclass(entry.cls, kind)})
    return " or ".join(found) if kind is not object else "result, element or bearing of this library"


def _entry(header: Any, kind: type[Any]) -> tuple[_Stored, str]:
    """Registered class that a header names, and what is wrong with it: unknown, not of `kind`, another format."""
    found = header if isinstance(header, dict) else {}
    cls, number = found.get("class"), found.get("format")
    if isinstance(cls, str) and cls not in _classes:
        for package in PACKAGES:
            import_module(package)
    entry = _classes.get(cls, _NOTHING) if isinstance(cls, str) else _NOTHING
    if entry is _NOTHING or not issubclass(entry.cls, kind):
        return entry, f"; its header names the class {shortened(cls)}" if found else "; it has no header"
    if type(number) is not int or number != entry.number:
        newer = type(number) is int and number > entry.number
        advice = "a newer version wrote it" if newer else "make the file anew"
        return entry, f" of format {entry.number}, not {shortened(number)}: {advice}"
    return entry, ""


def _is_hdf5(path: str | os.PathLike[str]) -> bool:
    """Whether a file begins as HDF5 does; False where it cannot be read."""
    try:
        if not is_file(path):
            return False
        with Path(path).open("rb") as stream:
            return stream.read(len(SIGNATURE)) == SIGNATURE
    except (OSError, ValueError):  # not to be read, or no path: `read` takes it as JSON then, and says why not
        return False


def _read_json(path: str | os.PathLike[str]) -> tuple[Any, Any]:
    """Header and content of a JSON file."""
    document = parse_json(read_text(path))
    if not isinstance(document, dict):
        return None, None
    return document.pop(HEADER, None), document


def _read_hdf5(path: str | os.PathLike[str]) -> tuple[Any, Any]:
    """Header and content of an HDF5 file."""
    # Without a lock: some file systems (NFS) have none, and `save` replaces files in one move.
    with h5py.File(path, "r", locking=False) as file:
        header = parse_json(text_of(file, HEADER)) if HEADER in file.attrs else None
        return header, _content(file) if isinstance(header, dict) else None


def put(group: h5py.Group, name: str, value: np.ndarray) -> None:
    """Store an array."""
    filled = value.ndim > 0 and value.size > 0  # there is something to pack
    # with a checksum, so that a damaged number raises an error
    packing = {"compression": "gzip", "shuffle": True} if filled and value.ndim > 1 else {}
    data = group.create_dataset(name, data=value, fletcher32=filled, **packing)
    if value.flags.f_contiguous and not value.flags.c_contiguous:
        set_text(data, "order", "F")


def take(data: h5py.Dataset) -> np.ndarray:
    """Return an array that `put` wrote.

    Raises
    ------
    ValueError
        Not of numbers, or of a size without anything stored behind it.
    """
    if data.dtype.kind not in NUMBERS or (data.size and not data.id.get_storage_size()):
        raise ValueError(f"{data.name} holds no numbers")
    # LAPACK's factors, for one, solve with another rounding when they come back in the other order
    in_columns = "order" in data.attrs and text_of(data, "order") == "F"
    return np.asfortranarray(data[...]) if in_columns else data[...]


def set_text(group: h5py.Group, name: str, text: str) -> None:
    """Set an attribute, of fixed length: others lie in HDF5's global heap, the one part without a checksum."""
    content = text.encode("utf-8")
    group.attrs.create(name, content, dtype=h5py.string_dtype("utf-8", len(content)))


def text_of(group: h5py.Group, name: str) -> str:
    """Text of an attribute, of fixed length or not."""
    text = group.attrs[name]
    return text.decode("utf-8") if isinstance(text, bytes) else str(text)


def _tree(value: Any) -> Any:
    """Dictionaries, lists, arrays and plain values that a value consists of."""
    if hasattr(value, "from_dict"):
        return value.to_dict()
    if is_dataclass(value):
        return {name: _tree(getattr(value, name)) for name in _names(value)}
    return [_tree(member) for member in value] if isinstance(value, list | tuple) else value


def _holds_arrays(tree: Any) -> bool:
    members = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ()
    return isinstance(tree, np.ndarray) or any(_holds_arrays(member) for member in members)


def _put(group: h5py.Group, name: str, tree: Any) -> None:
    """Store a tree: an array as dataset, what holds arrays as group, the rest as attribute."""
    if isinstance(tree, np.ndarray):
        put(group, name, tree)
    elif _holds_arrays(tree):
        inner = group.create_group(name)
        for key, member in tree.items() if isinstance(tree, dict) else enumerate(tree):
            _put(inner, str(key), member)
    else:
        set_text(group, name, json.dumps(tree))


def _content(group: h5py.Group) -> dict[str, Any]:
    """Tree of a group; attributes of others, which are no JSON, are left out."""
    found: dict[str, Any] = {}
    for name in group.attrs:
        try:
            found[name] = parse_json(text_of(group, name), nan=True)
        except ValueError:  # an attribute that another program added to the file: it is none of ours
            pass
    for name, item in group.items():
        found[name] = take(item) if isinstance(item, h5py.Dataset) else _content(item)
    return found


def _build(hint: Any, tree: Any) -> Any:
    """Rebuild what an annotation announces from its tree; raises any exception where it does not fit."""
    if tree is None:
        return None
    kind = _kind(hint, tree)
    if kind is Any:
        return tree
    if isinstance(tree, np.ndarray):
        if get_origin(kind) not in ARRAYS:
            raise TypeError(f"an array in place of {hint}")
        return tree
    if hasattr(kind, "from_dict"):
        return kind.from_dict(tree)
    if isinstance(kind, type) and is_dataclass(kind):
        hints = get_type_hints(kind)
        return kind(**{name: _build(hints[name], tree[name]) for name in _names(kind)})
    if get_origin(kind) in (list, tuple):
        members = [tree[str(k)] for k in range(len(tree))] if isinstance(tree, dict) else tree
        inner = get_args(kind)
        if get_origin(kind) is list or inner[-1] is Ellipsis:
            inner = inner[:1] * len(members)
        return get_origin(kind)(_build(one, member) for one, member in zip(inner, members, strict=True))
    if isinstance(kind, type) and issubclass(kind, Enum):
        return kind(tree)
    if get_origin(kind) in ARRAYS or (kind in PLAIN and not isinstance(tree, PLAIN[kind])):
        raise TypeError(f"{tree!r} is no {kind}")
    return tree


def _kind(hint: Any, tree: Any) -> Any:
    """The member of a union that fits the tree; any other annotation itself."""
    if get_origin(hint) not in (Union, UnionType):
        return hint
    kinds = [kind for kind in get_args(hint) if kind is not NoneType]
    if isinstance(tree, np.ndarray):
        return next((kind for kind in kinds if get_origin(kind) in ARRAYS or kind is Any), None)
    kinds = [kind for kind in kinds if get_origin(kind) not in ARRAYS]
    same = (kind for kind in kinds if is_dataclass(kind) and set(_names(kind)) == set(tree))
    return next(same, kinds[0]) if isinstance(tree, Mapping) else kinds[0]


def _names(cls: Any) -> list[str]:
    """Fields of a file: what a class is made of, but for what its metadata leaves out (``stored`` is False)."""
    return [f.name for f in fields(cls) if f.init and f.metadata.get("stored", True)]
