"""Eight neighbouring numbers at a time, in the vector registers of the processor.

The kernels of a sweep do the same arithmetic at every node. LLVM does not find that by itself in loops over a
dozen arrays that might overlap, so it is written out here: ``at(a, j, eight(i))`` is ``a[j, i:i+8]`` as one number
of eight lanes, for which ``+ - * /`` and the functions below work as for a float. With a plain index all of them
work on floats, so a formula stands once for both. On processors with shorter registers LLVM splits the lanes.

Memory is read and written where the indices say, unchecked: a line has eight nodes at least, and no index is
negative. All of this is for compiled kernels only.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model

LANES = 8
intrinsic: Any = extending.intrinsic


class LanesType(types.Type):
    """Eight numbers."""

    def __init__(self) -> None:
        super().__init__(name="Lanes")


class EightType(types.Type):
    """Index of the first of eight neighbouring nodes."""

    def __init__(self) -> None:
        super().__init__(name="Eight")


lanes, eight_index = LanesType(), EightType()
_DOUBLE, _WORD = ir.DoubleType(), ir.IntType(64)
_VECTOR, _WORDS = ir.VectorType(_DOUBLE, LANES), ir.VectorType(_WORD, LANES)


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, fe_type: Any) -> None:
        super().__init__(dmm, fe_type, _VECTOR)


@register_model(EightType)
class _EightModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, fe_type: Any) -> None:
        super().__init__(dmm, fe_type, _WORD)


def _splat(builder: Any, value: Any) -> Any:
    empty = ir.Constant(_VECTOR, ir.Undefined)
    first = builder.insert_element(empty, value, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(first, empty, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))


def _as(context: Any, builder: Any, value: Any, given: Any, wanted: Any) -> Any:
    """`value` as lanes or float."""
    if given is not lanes:
        value = context.cast(builder, value, given, types.float64)
        return _splat(builder, value) if wanted is lanes else value
    return value


_NUMBERS = (types.Float, types.Integer)


def _common(*given: Any) -> Any:
    """Lanes where one of the types is, float64 where all are numbers, else None."""
    if not all(t is lanes or isinstance(t, _NUMBERS) for t in given):
        return None
    return lanes if lanes in given else types.float64


class _Arithmetic(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        if lanes in args and _common(*args) is lanes:
            return signature(lanes, *args)
        return None


def _arithmetic(op: Any, instruction: str) -> None:
    infer_global(op)(type(f"_{instruction}", (_Arithmetic,), {}))

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        a, b = (_as(context, builder, v, t, lanes) for v, t in zip(args, sig.args, strict=True))
        return getattr(builder, instruction)(a, b, flags=("contract", "nsz"))

    for pair in ((LanesType, LanesType), (LanesType, types.Number), (types.Number, LanesType)):
        lower_builtin(op, *pair)(lower)


for _op, _instruction in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
    (operator.iadd, "fadd"),
    (operator.isub, "fsub"),
    (operator.imul, "fmul"),
):
    _arithmetic(_op, _instruction)


def _operator(op: Any, given: tuple[Any, ...], result: Any, lower: Any) -> None:
    """Define an operator of the types here; integers of any size stand for int64."""

    def generic(self: Any, args: Any, kws: Any) -> Any:
        if len(args) == len(given) and args[0] is given[0] and all(isinstance(t, types.Integer) for t in args[1:]):
            return signature(result, *given)
        return None

    infer_global(op)(type("_Operator", (AbstractTemplate,), {"generic": generic}))
    lower_builtin(op, *given)(lambda context, builder, sig, args: lower(builder, *args))


_operator(operator.neg, (lanes,), lanes, lambda builder, x: builder.fneg(x))
_operator(operator.add, (eight_index, types.int64), eight_index, lambda builder, i, k: builder.add(i, k))
_operator(operator.sub, (eight_index, types.int64), eight_index, lambda builder, i, k: builder.sub(i, k))
_operator(
    operator.gt, (eight_index, types.int64), types.boolean, lambda builder, i, k: builder.icmp_signed(">", i, k)
)


@intrinsic
def eight(typing_context: Any, i: Any) -> Any:
    """Index of nodes `i` to ``i + 7``; `i` > n of all of them stands for ``i > n`` of the first."""

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return context.cast(builder, args[0], sig.args[0], types.int64)

    return eight_index(i), generate


def _pointer(context: Any, builder: Any, array: Any, value: Any, indices: Any) -> Any:
    made = context.make_array(array)(context, builder, value)
    return cgutils.get_item_pointer(context, builder, array, made, indices, wraparound=False)


def _row_indices(context: Any, builder: Any, sig: Any, args: Any) -> list[Any]:
    j = context.cast(builder, args[1], sig.args[1], types.intp)
    i = args[2] if sig.args[2] is eight_index else context.cast(builder, args[2], sig.args[2], types.intp)
    return [j, i]


@intrinsic
def at(typing_context: Any, a: Any, j: Any, i: Any) -> Any:
    """``a[j, i]``, or ``a[j, i:i+8]``; contiguous lines, and no index below 0."""

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        pointer = _pointer(context, builder, sig.args[0], args[0], _row_indices(context, builder, sig, args))
        if sig.args[2] is eight_index:
            return builder.load(builder.bitcast(pointer, _VECTOR.as_pointer()), align=8, typ=_VECTOR)
        return builder.load(pointer, typ=_DOUBLE)

    return (lanes if i is eight_index else types.float64)(a, j, i), generate


@intrinsic
def put(typing_context: Any, a: Any, j: Any, i: Any, value: Any) -> Any:
    """``a[j, i] = value``, or ``a[j, i:i+8] = value``."""

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        pointer = _pointer(context, builder, sig.args[0], args[0], _row_indices(context, builder, sig, args))
        wanted = lanes if sig.args[2] is eight_index else types.float64
        value = _as(context, builder, args[3], sig.args[3], wanted)
        if wanted is lanes:
            builder.store(value, builder.bitcast(pointer, _VECTOR.as_pointer()), align=8)
        else:
            builder.store(value, pointer)
        return context.get_dummy_value()

    return types.void(a, j, i, value), generate


@intrinsic
def put_transposed(typing_context: Any, a: Any, j: Any, i: Any, b: Any, k: Any, m: Any) -> Any:
    """``a[j:j+8, i:i+8] = b[k:k+8, m:m+8].T``, without looking at either as numbers."""

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        def pointers(array: int) -> list[Any]:
            numbers = (array + 1, array + 2)
            line, column = (context.cast(builder, args[q], sig.args[q], types.intp) for q in numbers)
            lines = [builder.add(line, ir.Constant(line.type, q)) for q in range(LANES)]
            found = (_pointer(context, builder, sig.args[array], args[array], [q, column]) for q in lines)
            return [builder.bitcast(pointer, _VECTOR.as_pointer()) for pointer in found]

        square = [builder.load(pointer, align=8, typ=_VECTOR) for pointer in pointers(3)]
        for side in (4, 2, 1):  # blocks of this side beside the diagonal change places
            for q in (q for q in range(LANES) if not q & side):
                above, below = square[q], square[q + side]
                masks = _ahead(side), [c + side for c in _ahead(side)]
                square[q], square[q + side] = (builder.shuffle_vector(above, below, _mask(c)) for c in masks)
        for pointer, line in zip(pointers(0), square, strict=True):
            builder.store(line, pointer, align=8)
        return context.get_dummy_value()

    return types.void(a, j, i, b, k, m), generate


def _ahead(side: int) -> list[int]:
    """Numbers that a line takes of itself, or from 8 on of the line `side` below."""
    return [c if not c & side else LANES + c - side for c in range(LANES)]


def _mask(numbers: list[int]) -> Any:
    return ir.Constant(ir.VectorType(ir.IntType(32), LANES), numbers)


@intrinsic
def any_positive(typing_context: Any, x: Any) -> Any:
    """Whether one of eight numbers is > 0."""

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        flags = builder.fcmp_ordered(">", args[0], ir.Constant(_VECTOR, None))
        byte = ir.IntType(LANES)
        return builder.icmp_unsigned("!=", builder.bitcast(flags, byte), ir.Constant(byte, 0))

    return types.boolean(x), generate


@intrinsic
def lane(typing_context: Any, x: Any, k: Any) -> Any:
    """Number `k` of eight."""

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.extract_element(args[0], args[1])

    return types.float64(x, k), generate


def _of_two(name: str, build: Any) -> Any:
    """A function of two numbers, of lanes where one of them is."""

    def typed(typing_context: Any, a: Any, b: Any) -> Any:
        common = _common(a, b)

        def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            pair = [_as(context, builder, v, t, common) for v, t in zip(args, sig.args, strict=True)]
            return build(builder, *pair)

        return common(a, b), generate

    typed.__name__ = name
    return intrinsic(typed)


larger = _of_two("larger", lambda b, x, y: b.select(b.fcmp_ordered(">", x, y), x, y))
smaller = _of_two("smaller", lambda b, x, y: b.select(b.fcmp_ordered("<", x, y), x, y))


@intrinsic
def where_positive(typing_context: Any, x: Any, a: Any, b: Any) -> Any:
    """`a` where `x` > 0, else `b`."""
    common = _common(x, a, b)

    def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        x, a, b = (_as(context, builder, v, t, common) for v, t in zip(args, sig.args, strict=True))
        zero = ir.Constant(_VECTOR if common is lanes else _DOUBLE, None if common is lanes else 0.0)
        return builder.select(builder.fcmp_ordered(">", x, zero), a, b)

    return common(x, a, b), generate


def _of_one(name: str, build: Any) -> Any:
    """A function of one number, float or lanes."""

    def typed(typing_context: Any, x: Any) -> Any:
        common = _common(x)

        def generate(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            value = _as(context, builder, args[0], sig.args[0], common)
            number, word = (_VECTOR, _WORDS) if common is lanes else (_DOUBLE, _WORD)
            return build(builder, value, number, word)

        return common(x), generate

    typed.__name__ = name
    return intrinsic(typed)


def _root(builder: Any, x: Any, number: Any, word: Any) -> Any:
    name = f"llvm.sqrt.v{LANES}f64" if number is _VECTOR else "llvm.sqrt.f64"
    function = cgutils.get_or_insert_function(builder.module, ir.FunctionType(number, [number]), name)
    return builder.call(function, [x])


def _word(word: Any, value: int) -> Any:
    return ir.Constant(word, [value] * LANES) if isinstance(word, ir.VectorType) else ir.Constant(word, value)


_ONE = 1023 << 52  # bits of 1.0


def _power_of_two(builder: Any, x: Any, number: Any, word: Any) -> Any:
    bits = builder.shl(builder.bitcast(x, word), _word(word, 52))
    return builder.bitcast(builder.add(bits, _word(word, _ONE)), number)


def _mantissa(builder: Any, x: Any, number: Any, word: Any) -> Any:
    bits = builder.and_(builder.bitcast(x, word), _word(word, (1 << 52) - 1))
    return builder.bitcast(builder.or_(bits, _word(word, _ONE)), number)


def _exponent(builder: Any, x: Any, number: Any, word: Any) -> Any:
    bits = builder.lshr(builder.bitcast(x, word), _word(word, 52))
    return builder.bitcast(builder.or_(bits, _word(word, 1075 << 52)), number)


root = _of_one("root", _root)
power_of_two = _of_one("power_of_two", _power_of_two)  # 2^k for x = 1.5 2^52 + k
mantissa = _of_one("mantissa", _mantissa)  # m for x = 2^e m, 1 <= m < 2
exponent = _of_one("exponent", _exponent)  # 2^52 + e + 1023 for it
