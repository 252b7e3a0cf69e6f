"""`CompiledList`: structures of one type, such as the bearings of a rotor, that kernels index like a tuple.

The length of a tuple is part of its type: a kernel that takes one is compiled anew for every number of bearings.
Here every structure is a row of words of 8 bytes in memory, as numba lays it out, from which kernels load it.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numba import typeof
from numba.core import cgutils, types
from numba.extending import (
    NativeValue,
    intrinsic,
    make_attribute_wrapper,
    models,
    overload,
    register_model,
    unbox,
)

WORD = np.dtype(np.int64)
_WORDS = types.Array(types.int64, 2, "C")
_COMPILED: Any = {"jit_options": {"_nrt": False}}


class CompiledList:
    """Named tuples of arrays and numbers, all of one numba type; kernels write into their arrays.

    Parameters
    ----------
    items : iterable of tuple
        At least one. Their arrays live as long as the list.

    Raises
    ------
    TypeError
        Types that differ, or a field that is no array, whole number or real number.
    """

    def __init__(self, items: Iterable[Any]) -> None:
        self._items = tuple(items)
        found = list(dict.fromkeys(typeof(item) for item in self._items))
        if len(found) != 1:
            raise TypeError(f"structures of one type are needed, not of {len(found)}: {found}")
        self.words = np.array([_words(item) for item in self._items], WORD)
        self._numba_type_ = _ListType(found[0], self.words.shape[1])

    def __len__(self) -> int:
        return len(self._items)

    def __getitem__(self, index: int) -> Any:
        return self._items[index]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._items)


def _words(value: Any) -> list[int]:
    """Words of a value: of an array those of numba's `ArrayModel`, which then counts no references to it."""
    match value:
        case tuple():
            return [word for part in value for word in _words(part)]
        case np.ndarray():
            return [0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides]
        case float():
            return [int(np.float64(value).view(WORD))]
        case int() if not isinstance(value, bool):
            return [value]
    raise TypeError(f"an array or a number is needed, not {value!r}")


class _ListType(types.Type):
    """Type of a list of structures of type `item`, of so many words each."""

    def __init__(self, item: types.Type, width: int) -> None:
        self.item, self.width = item, width
        super().__init__(f"CompiledList({item}, {width})")


@register_model(_ListType)
class _ListModel(models.StructModel):
    def __init__(self, manager: Any, kind: _ListType) -> None:
        super().__init__(manager, kind, [("words", _WORDS)])


make_attribute_wrapper(_ListType, "words", "words")


@unbox(_ListType)
def _unbox(kind: _ListType, value: Any, c: Any) -> NativeValue:
    words = c.pyapi.object_getattr_string(value, "words")
    native = cgutils.create_struct_proxy(kind)(c.context, c.builder)
    native.words = c.unbox(_WORDS, words).value
    c.pyapi.decref(words)  # the list holds it
    return NativeValue(native._getvalue())


@intrinsic
def _load(typing: Any, items: Any, row: Any) -> Any:
    """Load a structure from its row of words."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.get_data_type(items.item)
        assert context.get_abi_sizeof(data) == WORD.itemsize * items.width, "numba lays structures out differently"
        words = context.make_array(row)(context, builder, args[1])
        return context.unpack_value(builder, items.item, builder.bitcast(words.data, data.as_pointer()))

    return items.item(items, row), generate


@overload(len, **_COMPILED)
def _len(items):
    if isinstance(items, _ListType):
        return lambda items: items.words.shape[0]
    return None


@overload(operator.getitem, **_COMPILED)
def _getitem(items, index):
    if isinstance(items, _ListType):
        return lambda items, index: _load(items, items.words[index])  # type: ignore[call-arg]
    return None
