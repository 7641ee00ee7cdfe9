"""Define records in lanes: memory with named places (see `records`), each of which holds a number for every lane.

Compiled code sees such memory in two ways. `all_lanes(record)(address).rate` is a number in every lane: the processor works on all
at once. `one_lane(record)(address)[n].rate` is the number of lane n. A row of floats is indexed in both.
"""

from __future__ import annotations

import operator
from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.extending import intrinsic, lower_builtin, lower_getattr_generic, lower_setattr_generic, models, register_model

from stickslip.engine.codegen.numba_privates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from stickslip.engine.codegen.records import FLOATS, Record, Slot
from stickslip.engine.codegen.simd import LANES, POINTER, VECTOR, WIDTH

NUMBER = ir.DoubleType()


class AllLanes(types.Type):  # type: ignore[misc] # numba is untyped
    """The type of a record in all lanes: a pointer to the vector at its first place."""

    def __init__(self, record: type[Record]) -> None:
        self.record = record
        super().__init__(name=f"all lanes of {record.__module__}.{record.__name__}")


class OneLane(types.Type):  # type: ignore[misc]
    """The type of a record in one lane: a pointer to the lane's number at its first place."""

    def __init__(self, record: type[Record]) -> None:
        self.record = record
        super().__init__(name=f"one lane of {record.__module__}.{record.__name__}")


class LaneRow(types.Type):  # type: ignore[misc]
    """The type of a row of floats in one lane: a pointer to the lane's number at its first place."""


LANE_ROW = LaneRow("LaneRow")


@register_model(AllLanes)
class _VectorPointer(models.PrimitiveModel):  # type: ignore[misc]
    """The representation in machine code: the address of a vector."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR.as_pointer())


@register_model(OneLane)
@register_model(LaneRow)
class _NumberPointer(models.PrimitiveModel):  # type: ignore[misc]
    """The representation in machine code: the address of a number."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, NUMBER.as_pointer())


def _type_of(place: Slot, of: type[types.Type], number: Any, row: Any) -> Any:
    """Return the type of a field: a number, a row, or a record that is seen in the same way (`of`)."""
    if place.kind is float:
        return number
    return row if place.kind is FLOATS else of(place.kind)


def _define(of: type[types.Type], number: Any, row: Any, stride: int) -> None:
    """Define the fields of records that are seen in one way; `stride` is the distance between two places."""

    @infer_getattr
    class Fields(AttributeTemplate):  # type: ignore[misc]
        key = of

        def generic_resolve(self, kind: Any, name: str) -> Any:
            place = kind.record.places.get(name)
            return None if place is None else _type_of(place, of, number, row)

    def address(builder: Any, pointer: Any, place: Slot) -> Any:
        return builder.gep(pointer, [ir.Constant(ir.IntType(64), stride * place.first)])

    @lower_getattr_generic(of)
    def get(context: Any, builder: Any, kind: Any, pointer: Any, name: str) -> Any:
        place = kind.record.places[name]
        found = address(builder, pointer, place)
        return builder.load(found) if place.kind is float else found

    @lower_setattr_generic(of)
    def put(context: Any, builder: Any, called: Any, arguments: Any, name: str) -> None:
        builder.store(arguments[1], address(builder, arguments[0], called.args[0].record.places[name]))


_define(AllLanes, LANES, POINTER, 1)
_define(OneLane, types.float64, LANE_ROW, WIDTH)


@infer_global(operator.getitem)
class _Index(AbstractTemplate):  # type: ignore[misc]
    """Tells numba that a lane can be chosen by its number, and a number in a row by its place."""

    def generic(self, arguments: Any, keywords: Any) -> Any:
        """Return the signature of the indexing, or None if the arguments are something else."""
        if not isinstance(arguments[1], types.Integer):
            return None
        if isinstance(arguments[0], OneLane):
            return signature(arguments[0], arguments[0], types.int64)
        return signature(types.float64, LANE_ROW, types.int64) if arguments[0] == LANE_ROW else None


@infer_global(operator.setitem)
class _Assign(AbstractTemplate):  # type: ignore[misc]
    """Tells numba that numbers in a row can be assigned."""

    def generic(self, arguments: Any, keywords: Any) -> Any:
        """Return the signature of the assignment, or None if the arguments are something else."""
        if arguments[0] == LANE_ROW and isinstance(arguments[1], types.Integer):
            return signature(types.none, LANE_ROW, types.int64, types.float64)
        return None


@lower_builtin(operator.getitem, OneLane, types.Integer)
def _nth_lane(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    """Write the calculation of the address of a lane's first number."""
    return builder.gep(arguments[0], [arguments[1]])


def _in_row(builder: Any, pointer: Any, k: Any) -> Any:
    """Write the calculation of the address of number k in a row of a lane."""
    return builder.gep(pointer, [builder.mul(k, ir.Constant(ir.IntType(64), WIDTH))])


@lower_builtin(operator.getitem, LaneRow, types.Integer)
def _get_in_row(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    """Write the reading of a number in a row."""
    return builder.load(_in_row(builder, *arguments))


@lower_builtin(operator.setitem, LaneRow, types.Integer, types.Float)
def _set_in_row(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    """Write the assignment of a number in a row."""
    builder.store(arguments[2], _in_row(builder, *arguments[:2]))
    return context.get_dummy_value()


@intrinsic
def floats_of(typingctx: Any, pointer: Any) -> Any:
    """Return a record or a row in lanes as a pointer to floats, for a function of the law that works on all lanes."""

    def codegen(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(FLOATS))

    return FLOATS(pointer), codegen


@intrinsic
def rows_of(typingctx: Any, record: Any) -> Any:
    """Return a record in all lanes as a pointer to the vector at its first place, which is indexed like an array."""

    def codegen(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
        return arguments[0]

    return POINTER(record), codegen


def _at(kind: Any) -> Any:
    """Return a function for compiled code that sees the memory at an address as a record in lanes."""

    @intrinsic
    def at(typingctx: Any, address: Any) -> Any:
        def codegen(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
            return builder.inttoptr(arguments[0], context.get_value_type(kind))

        return kind(types.int64), codegen

    return at


def all_lanes(record: type[Record]) -> Any:
    """Return a function for compiled code that sees the memory at an address as a record in all lanes."""
    return _at(AllLanes(record))


def one_lane(record: type[Record]) -> Any:
    """Return a function for compiled code that sees the memory at an address as a record in lane 0."""
    return _at(OneLane(record))
