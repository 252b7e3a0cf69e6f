"""Any dataclass in an HDF5 file: made in memory, written in one move, rebuilt from the annotations of its class.

================================================ =========================================================
value                                            stands as
================================================ =========================================================
array                                            dataset, its order in memory kept
dataclass or sequence that holds arrays          group, its members by name or number
class with ``to_dict`` and ``from_dict``         attribute, JSON of that dictionary
number, text, None, enum; what holds only these  attribute, JSON
================================================ =========================================================

The file names the class and a format number, which its owner raises when the fields change their meaning. A field
with ``metadata={"later": True}`` and a default came without that: older files have none.
"""

from __future__ import annotations

import json
import os
import uuid
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

import h5py
import numpy as np

from ehlcontact.errors import InputError
from ehlcontact.files.replacement import is_file, parse_json, write_bytes

# Of HDF5 itself: the first that has checksums on all its structure; read by HDF5 1.10 (2016) and newer.
LAYOUT = ("v110", "v110")
NUMBERS = "bfiu"  # kinds of dtype: all that is ever stored
PLAIN: dict[Any, Any] = {float: (float, int), int: int, str: str}  # what JSON may hold for an annotation


@contextmanager
def making(path: str | os.PathLike[str], field: str) -> Iterator[h5py.File]:
    """Give an empty HDF5 file in memory; its image is written to `path` in one move if nothing was raised.

    In memory, because HDF5 cannot close what it cannot flush: on a full disk the process ends in a segmentation
    fault, whatever was caught. It costs the size of the file, twice for a moment.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    with h5py.File(uuid.uuid4().hex, "w", driver="core", backing_store=False, libver=LAYOUT) as file:
        yield file
        file.flush()
        image = file.id.get_file_image()
    write_bytes(path, image, field)


def write(record: Any, path: str | os.PathLike[str], field: str, number: int = 1) -> Path:
    """Write a dataclass; an existing file is replaced in one move, or kept if anything fails.

    Parameters
    ----------
    record : dataclass
    path : path
    field : str
        What the file is called in messages.
    number : int
        Format number.

    Raises
    ------
    InputError
        The folder does not exist or cannot be written to.
    """
    with making(path, field) as file:
        file.attrs["format"] = number
        set_text(file, "class", type(record).__name__)
        for name, value in _members(record):
            _put(file, name, value)
    return Path(path)


def read(
    path: str | os.PathLike[str],
    classes: Mapping[str, type[Any]],
    field: str,
    what: str,
    numbers: tuple[int, int] = (1, 1),
) -> Any:
    """Read what `write` wrote.

    Parameters
    ----------
    path : path
    classes : mapping
        What may be read, by the name of its class.
    field, what : str
        What the file is called in messages, and what was wanted.
    numbers : (int, int)
        Oldest and newest format number that can be read.

    Raises
    ------
    InputError
        No such file, not HDF5, truncated, none of `classes`, of an older or a newer format.
    """
    source = Path(path)
    if not is_file(source):
        raise InputError(field, str(source), f"an existing HDF5 {what}")
    try:
        with h5py.File(source, "r") as file:
            cls = classes.get(text_of(file, "class") if "class" in file.attrs else "")
            number = None if cls is None else int(file.attrs["format"])
            oldest, newest = numbers
            if number is not None and oldest <= number <= newest:
                return _build(cls, file)
    except InputError as error:  # of a member that its own class refuses
        raise InputError(f"{source}: {error.field}", error.value, error.allowed) from None
    except Exception:  # whatever h5py, numpy and classes raise on what is damaged, or not what it says it is
        raise InputError(field, str(source), f"a complete HDF5 {what}") from None
    if number is None:
        raise InputError(field, str(source), f"a {what}")
    if number > newest:
        raise InputError(field, str(source), f"of format {newest} or older; upgrade to read it")
    raise InputError(field, str(source), f"a {what} of format {oldest} or newer; make it anew")


def put(group: h5py.Group, name: str, value: np.ndarray) -> None:
    """Store an array."""
    filled = value.ndim > 0 and value.size > 0  # there is something to pack
    # with a checksum, so that a damaged number is told and not read
    data = group.create_dataset(
        name, data=value, compression="gzip" if filled and value.ndim > 1 else None, fletcher32=filled
    )
    if value.flags.f_contiguous and not value.flags.c_contiguous:
        set_text(data, "order", "F")


def take(data: h5py.Dataset) -> np.ndarray:
    """Return an array that `put` wrote.

    Raises
    ------
    ValueError
        Not of numbers, or only promised: of any size, with nothing behind it.
    """
    if data.dtype.kind not in NUMBERS or (data.size and not data.id.get_storage_size()):
        raise ValueError(f"{data.name} holds no numbers")
    # LAPACK's factors, say, solve with another rounding when they come back in the other order
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


def _members(value: Any) -> Iterator[tuple[str, Any]]:
    """Members of a dataclass by name, of a sequence by number; without those that are None because nobody said."""
    if is_dataclass(value):
        named = ((f, getattr(value, f.name)) for f in fields(value))
        return ((f.name, member) for f, member in named if f.default is not None or member is not None)
    return ((str(k), member) for k, member in enumerate(value))


def _holds_arrays(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return True
    if hasattr(value, "from_dict") or not (is_dataclass(value) or isinstance(value, list | tuple)):
        return False
    return any(_holds_arrays(member) for _, member in _members(value))


def _put(group: h5py.Group, name: str, value: Any) -> None:
    if isinstance(value, np.ndarray):
        put(group, name, value)
    elif _holds_arrays(value):
        inner = group.create_group(name)
        for key, member in _members(value):
            _put(inner, key, member)
    else:
        set_text(group, name, json.dumps(_plain(value)))


def _plain(value: Any) -> Any:
    """`value`, which holds no arrays, as `json` takes it."""
    if hasattr(value, "from_dict"):
        return value.to_dict()
    if is_dataclass(value):
        return {name: _plain(member) for name, member in _members(value)}
    return [_plain(member) for member in value] if isinstance(value, list | tuple) else value


def _take(group: h5py.Group, name: str, hint: Any) -> Any:
    if name not in group:
        return _rebuild(hint, parse_json(text_of(group, name), nan=True))
    item = group[name]
    if isinstance(item, h5py.Dataset):
        if not _allows_array(hint):
            raise TypeError(f"{name} is no array")
        return take(item)
    kind = _kind(hint)
    if is_dataclass(kind):
        return _build(kind, item)
    hints = _member_hints(kind, len(item) + len(item.attrs))
    return get_origin(kind)(_take(item, str(k), inner) for k, inner in enumerate(hints))


def _rebuild(hint: Any, value: Any) -> Any:
    """What `hint` announces, from its JSON."""
    kind = _kind(hint)
    if value is None or kind is Any:
        return value
    if hasattr(kind, "from_dict"):
        return kind.from_dict(value)
    if isinstance(kind, type) and is_dataclass(kind):
        hints = get_type_hints(kind)
        return kind(**{name: _rebuild(hints[name], value[name]) for name in value})
    if get_origin(kind) in (list, tuple):
        members = zip(_member_hints(kind, len(value)), value, strict=True)
        return get_origin(kind)(_rebuild(inner, member) for inner, member in members)
    if isinstance(kind, type) and issubclass(kind, Enum):
        return kind(value)
    if get_origin(kind) is np.ndarray or (kind in PLAIN and not isinstance(value, PLAIN[kind])):
        raise TypeError(f"{value!r} is no {kind}")
    return value


def _allows_array(hint: Any) -> bool:
    kinds = get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)
    return any(kind is Any or get_origin(kind) is np.ndarray for kind in kinds)


def _build(cls: Any, group: h5py.Group) -> Any:
    """Dataclass `cls` of the members of a group; those that came ``later`` than the format may be missing."""
    hints = get_type_hints(cls)
    there = [f for f in fields(cls) if f.name in group or f.name in group.attrs or not f.metadata.get("later")]
    return cls(**{f.name: _take(group, f.name, hints[f.name]) for f in there})


def _kind(hint: Any) -> Any:
    """The first class of a union that is neither None nor an array; any other `hint` itself."""
    if get_origin(hint) not in (Union, UnionType):
        return hint
    return next(kind for kind in get_args(hint) if kind is not NoneType and get_origin(kind) is not np.ndarray)


def _member_hints(kind: Any, size: int) -> tuple[Any, ...]:
    """Annotations of the `size` members of ``list[T]``, ``tuple[T, ...]`` or ``tuple[S, T]``."""
    hints = get_args(kind)
    if get_origin(kind) is list or hints[-1] is Ellipsis:
        return hints[:1] * size
    return hints
