# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One number per lane as a single value of the compiled loops: a vector of the processor, with the usual operators.

Arrays of the mechanics have the lanes (runs that are simulated side by side) as their last axis. `load` and `store`
move the lanes that start at a flat index of such an array; `lane`, a tuple as long as there are lanes, tells the
compiler how many, so that every number of lanes has loops of its own. Plain numbers mix with lanes.
"""

import operator
from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import intrinsic, lower_builtin, models, register_model

LANES = (1, 4)
"""How many lanes the loops are compiled for; four doubles fill a vector, and their matrix the cache."""
LaneTuple = tuple[int, ...]
"""`lane` of the compiled loops, see `lane_tuple`."""
Value = Any
"""A number in every lane, or one for all: exists inside the compiled loops only, where Numba knows its type."""
Four = tuple[Value, Value, Value, Value]
Typed = tuple[Any, Callable[..., Any]]
"""What an intrinsic gives Numba: the signature, and what builds the instructions."""


def lane_tuple(lanes: int) -> LaneTuple:
    """What tells the compiled loops the number of lanes."""
    return (0,) * lanes


class Lanes(types.Type):
    """Numba's type of one double per lane."""

    def __init__(self, count: int) -> None:
        self.count = count
        super().__init__(name=f"Lanes({count})")


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Lanes) -> None:
        super().__init__(manager, kind, _vector(kind.count))


def _vector(count: int) -> ir.VectorType:
    return ir.VectorType(ir.DoubleType(), count)


def _check(array: types.Array) -> None:
    if array.layout != "C" or array.dtype != types.float64:
        raise TypingError(f"found {array}; expected a contiguous array of doubles")


def _address(
    context: Any, builder: ir.IRBuilder, signature: Any, array: ir.Value, index: ir.Value, count: int
) -> ir.Value:
    data = context.make_array(signature.args[0])(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), _vector(count).as_pointer())


@intrinsic
def load(typing_context: Any, array: types.Array, index: types.Type, lane: types.BaseTuple) -> Typed:
    """The lanes that start at a flat index of a contiguous array."""
    _check(array)
    kind = Lanes(len(lane))

    def build(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]) -> ir.Value:
        address = _address(context, builder, signature, arguments[0], arguments[1], kind.count)
        return builder.load(address, align=8)

    return kind(array, types.intp, lane), build


@intrinsic
def store(typing_context: Any, array: types.Array, index: types.Type, value: Lanes) -> Typed:
    """Write lanes to where a flat index of a contiguous array says."""
    _check(array)

    def build(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]) -> ir.Value:
        address = _address(context, builder, signature, arguments[0], arguments[1], value.count)
        builder.store(arguments[2], address, align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, value), build


def _several(count: int) -> Any:
    @intrinsic
    def load_several(
        typing_context: Any, array: types.Array, index: types.Type, lane: types.BaseTuple
    ) -> Typed:
        _check(array)
        kind = Lanes(len(lane))

        def build(
            context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]
        ) -> ir.Value:
            first = _address(context, builder, signature, arguments[0], arguments[1], kind.count)
            places = [builder.gep(first, [ir.Constant(ir.IntType(64), n)]) for n in range(count)]
            values = [builder.load(place, align=8) for place in places]
            return context.make_tuple(builder, signature.return_type, values)

        return types.UniTuple(kind, count)(array, types.intp, lane), build

    return load_several


three, four = _several(3), _several(4)
"""The lanes at several places, one after the other, that start at a flat index."""


@intrinsic
def add(typing_context: Any, array: types.Array, index: types.Type, value: Lanes) -> Typed:
    """Add lanes to those at a flat index of a contiguous array."""
    _check(array)

    def build(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]) -> ir.Value:
        address = _address(context, builder, signature, arguments[0], arguments[1], value.count)
        total = builder.fadd(builder.load(address, align=8), arguments[2], flags=("fast",))
        builder.store(total, address, align=8)
        return context.get_dummy_value()

    return types.void(array, types.intp, value), build


@intrinsic
def zero(typing_context: Any, lane: types.BaseTuple) -> Typed:
    """Zero in every lane."""
    kind = Lanes(len(lane))

    def build(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]) -> ir.Value:
        return ir.Constant(_vector(kind.count), [0.0] * kind.count)

    return kind(lane), build


def _widened(builder: ir.IRBuilder, value: ir.Value, kind: types.Type, count: int) -> ir.Value:
    if isinstance(kind, Lanes):
        return value
    one = ir.IntType(32)
    undefined = ir.Constant(_vector(count), ir.Undefined)
    first = builder.insert_element(undefined, value, ir.Constant(one, 0))
    return builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(one, count), [0] * count))


def _overload_binary(python_operator: Callable[[Any, Any], Any], name: str) -> None:
    """Typed and lowered in place, not as a function to call: kernels compile in half the time."""

    @infer_global(python_operator)
    class _Typed(AbstractTemplate):
        def generic(self, args: tuple[types.Type, ...], kws: dict[str, types.Type]) -> Any:
            kind = next((x for x in args if isinstance(x, Lanes)), None)
            if kind is None or len(args) != 2:
                return None
            return kind(*(x if isinstance(x, Lanes) else types.float64 for x in args))

    def build(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]) -> ir.Value:
        count = signature.return_type.count
        wide = [_widened(builder, x, k, count) for x, k in zip(arguments, signature.args, strict=True)]
        return getattr(builder, name)(*wide, flags=("fast",))

    for kinds in ((Lanes, Lanes), (Lanes, types.Float), (types.Float, Lanes)):
        lower_builtin(python_operator, *kinds)(build)


for _operator, _name in (
    (operator.add, "fadd"),
    (operator.sub, "fsub"),
    (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):
    _overload_binary(_operator, _name)


def _function(function_name: str) -> Any:
    @intrinsic
    def function(typing_context: Any, value: Lanes) -> Typed:
        def build(
            context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]
        ) -> ir.Value:
            kind = ir.FunctionType(_vector(value.count), [_vector(value.count)])
            name = f"llvm.{function_name}.v{value.count}f64"
            callee = cgutils.get_or_insert_function(builder.module, kind, name)
            return builder.call(callee, arguments, fastmath=("fast",))

        return value(value), build

    return function


square_root, logarithm = _function("sqrt"), _function("log")


@intrinsic
def of_lane(typing_context: Any, value: Lanes, index: types.Type) -> Typed:
    """The number in one lane."""

    def build(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]) -> ir.Value:
        return builder.extract_element(*arguments)

    return types.float64(value, types.intp), build


@intrinsic
def with_lane(typing_context: Any, value: Lanes, index: types.Type, number: types.Type) -> Typed:
    """The lanes with another number in one of them."""

    def build(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Sequence[ir.Value]) -> ir.Value:
        return builder.insert_element(arguments[0], arguments[2], arguments[1])

    return value(value, types.intp, types.float64), build


@njit(inline="always")
def logarithm_near_one(value: Value, lane: LaneTuple) -> Value:
    """Natural logarithm, fast where every lane is within 0.82 and 1.22: 2 artanh s of s = (value - 1) / (value + 1)."""
    s = (value - 1.0) / (value + 1.0)
    far = False
    for n in range(len(lane)):
        far = far or not abs(of_lane(s, n)) < 0.1
    if far:
        return logarithm(value)
    q = s * s
    series = 1.0 / 11.0 + q * (1.0 / 13.0 + q * (1.0 / 15.0))
    series = 1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * series))
    return 2.0 * s * (1.0 + q * (1.0 / 3.0 + q * series))
