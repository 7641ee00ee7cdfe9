"""How compiled code sees memory: records by the names of their fields (see `records`), and rows of floats, integers or lanes.

A record may lie in memory as it is, or in lanes: then each of its places holds a number for every lane, one beside the other.
Compiled code sees such memory in two ways. `all_lanes(record)(address).rate` is a number in every lane: the processor works on all
at once. `one_lane(record)(address)[n].rate` is the number of lane n. A row of floats is indexed in both.
"""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.extending import intrinsic, lower_builtin, lower_getattr_generic, lower_setattr_generic, models, register_model

from stickslip.engine.compile.numba_privates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from stickslip.engine.compile.uncompiled import UNCOMPILED, Pointer
from stickslip.engine.memory.records import FLOATS, INTEGERS, MemoryRecord, Slot
from stickslip.engine.memory.simd import LANES, POINTER, WHOLE, WIDTH


class LaneRow(types.Type):  # type: ignore[misc] # numba is untyped
    """The type of a row of floats in one lane: a pointer to the lane's number at its first place."""


LANE_ROW = LaneRow("LaneRow")


@dataclass(frozen=True)
class RecordView:
    """A way to see a record: the types of its floats and its rows of floats, and the distance of its places in memory."""

    name: str
    number: Any
    row: Any
    stride: int


PLAIN = RecordView("pointer to", types.float64, FLOATS, 1)
ALL_LANES, ONE_LANE = RecordView("all lanes of", LANES, POINTER, WIDTH), RecordView("one lane of", types.float64, LANE_ROW, WIDTH)


class RecordPointer(types.Type):  # type: ignore[misc]
    """The type of a record in compiled code: a pointer to its first place, and how the record is seen."""

    def __init__(self, record: type[MemoryRecord], view: RecordView = PLAIN) -> None:
        self.record, self.view = record, view
        super().__init__(name=f"{view.name} {record.__module__}.{record.__name__}")

    def type_of(self, place: Slot) -> Any:
        """Return the type that a field has in compiled code: a record inside this one is seen in the same way."""
        if place.kind in (float, int):
            return self.view.number if place.kind is float else types.int64
        if isinstance(place.kind, type):
            return RecordPointer(place.kind, self.view)
        return self.view.row if place.inside else place.kind

    def address(self, builder: Any, pointer: Any, place: Slot) -> Any:
        """Write the calculation of a field's address from that of its record."""
        return builder.gep(pointer, [ir.Constant(WHOLE, self.view.stride * place.first)], inbounds=True)


@register_model(RecordPointer)
@register_model(LaneRow)
class _PointerModel(models.PrimitiveModel):  # type: ignore[misc]
    """The representation of such a pointer in machine code: the address of a 64-bit place."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, WHOLE.as_pointer())


@infer_getattr
class _Fields(AttributeTemplate):  # type: ignore[misc]
    """Tells numba which fields a record has, and their types."""

    key = RecordPointer

    def generic_resolve(self, kind: RecordPointer, name: str) -> Any:
        """Return the type of a field, or None if the record has no field of this name."""
        place = kind.record.places.get(name)
        return None if place is None else kind.type_of(place)


@lower_getattr_generic(RecordPointer)
def _get(context: Any, builder: Any, kind: RecordPointer, pointer: Any, name: str) -> Any:
    """Write the reading of a field: a pointer if the field lies inside the record, otherwise its value."""
    place = kind.record.places[name]
    wanted, address = context.get_value_type(kind.type_of(place)), kind.address(builder, pointer, place)
    if place.inside:
        return builder.bitcast(address, wanted)
    return builder.load(builder.bitcast(address, wanted.as_pointer()))


@lower_setattr_generic(RecordPointer)
def _set(context: Any, builder: Any, called: Any, arguments: Any, name: str) -> None:
    """Write the assignment of a number or an address to a field."""
    (pointer, value), kind = arguments, called.args[0]
    address = kind.address(builder, pointer, kind.record.places[name])
    builder.store(value, builder.bitcast(address, value.type.as_pointer()))


@infer_global(operator.getitem)
class _Nth(AbstractTemplate):  # type: ignore[misc]
    """Tells numba what can be indexed: records in a row of records, lanes of a record, and numbers in a row of one lane."""

    def generic(self, arguments: Any, keywords: Any) -> Any:
        """Return the signature of the indexing, or None if the arguments are something else."""
        pointer, n = arguments
        if not isinstance(n, types.Integer) or not isinstance(pointer, (RecordPointer, LaneRow)):
            return None
        return signature(types.float64 if pointer == LANE_ROW else pointer, pointer, types.int64)


@infer_global(operator.setitem)
class _Assign(AbstractTemplate):  # type: ignore[misc]
    """Tells numba that numbers in a row of one lane can be assigned."""

    def generic(self, arguments: Any, keywords: Any) -> Any:
        """Return the signature of the assignment, or None if the arguments are something else."""
        if arguments[0] == LANE_ROW and isinstance(arguments[1], types.Integer):
            return signature(types.none, LANE_ROW, types.int64, types.float64)
        return None


@lower_builtin(operator.getitem, RecordPointer, types.Integer)
def _nth(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    """Write the calculation of the address of a record in a row of records, or of a lane of a record."""
    apart = called.args[0].record.total if called.args[0].view == PLAIN else 1
    return builder.gep(arguments[0], [builder.mul(arguments[1], ir.Constant(WHOLE, apart))])


def _in_row(builder: Any, row: Any, k: Any) -> Any:
    """Write the calculation of the address of number k in a row of a lane."""
    address = builder.gep(row, [builder.mul(k, ir.Constant(WHOLE, WIDTH))])
    return builder.bitcast(address, ir.DoubleType().as_pointer())


@lower_builtin(operator.getitem, LaneRow, types.Integer)
def _get_in_row(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    """Write the reading of a number in a row."""
    return builder.load(_in_row(builder, *arguments))


@lower_builtin(operator.setitem, LaneRow, types.Integer, types.Float)
def _set_in_row(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    """Write the assignment of a number in a row."""
    builder.store(arguments[2], _in_row(builder, *arguments[:2]))
    return context.get_dummy_value()


def seen_as(kind: Any) -> Any:
    """Return a function for compiled code that sees memory as `kind`: given as an array, an address, a pointer or a record."""

    @intrinsic
    def seen(typingctx: Any, memory: Any) -> Any:
        def codegen(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
            (given,), (found,), wanted = called.args, arguments, context.get_value_type(kind)
            if isinstance(given, types.Integer):
                return builder.inttoptr(found, wanted)
            if isinstance(given, types.Array):
                found = context.make_array(given)(context, builder, found).data
            return builder.bitcast(found, wanted)

        return kind(types.int64 if isinstance(memory, types.Integer) else memory), codegen

    return seen


numbers_of, whole_numbers_of = seen_as(FLOATS), seen_as(INTEGERS)
"""The numbers of a record that has only floats, or only integers, as a row; also a record in lanes, for the functions of a law."""
rows_of = seen_as(POINTER)
"""A record in all lanes, or an address (bytes, a multiple of 64), as a row of lanes."""


def record_at(record: type[MemoryRecord]) -> Any:
    """Return a function with which kernels turn memory (an array, or a pointer to it) or a record into the first record there."""
    if not UNCOMPILED:
        return seen_as(RecordPointer(record))
    return lambda memory: (
        memory if isinstance(memory, record) else record(Pointer(memory.reshape(-1)) if getattr(memory, "ndim", 1) > 1 else memory)
    )


def all_lanes(record: type[MemoryRecord]) -> Any:
    """Return a function for compiled code that sees the memory at an address as a record in all lanes."""
    return seen_as(RecordPointer(record, ALL_LANES))


def one_lane(record: type[MemoryRecord]) -> Any:
    """Return a function for compiled code that sees the memory at an address as a record in lane 0."""
    return seen_as(RecordPointer(record, ONE_LANE))


if UNCOMPILED:

    def numbers_of(record: MemoryRecord) -> Pointer:
        """Return a pointer to the numbers of a record."""
        return Pointer(record.numbers)

    whole_numbers_of = numbers_of
