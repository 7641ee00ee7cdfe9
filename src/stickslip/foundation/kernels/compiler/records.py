"""How machine code sees records and rows (see `kernels.memory.pointers`)."""

from __future__ import annotations

import operator
from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.core.typing.templates import AttributeTemplate
from numba.extending import infer_getattr, lower_builtin, lower_getattr_generic, lower_setattr_generic, models, register_model

from stickslip.foundation.kernels.compiler.addresses import FLOATS, INTEGER, INTEGERS, rule, typed_as
from stickslip.foundation.kernels.compiler.lanes import LANES
from stickslip.foundation.kernels.memory import pointers, records
from stickslip.foundation.kernels.memory.pointers import SeenAs, SeenIn
from stickslip.foundation.kernels.memory.records import MemoryRecord, Slot
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH


class LaneRow(types.Type):  # type: ignore[misc] # numba is untyped
    """The type of a row of floats in one lane: a pointer to the lane's number at its first place."""


LANE_ROW, LANE_ROWS = LaneRow("LaneRow"), types.CPointer(LANES)
OF_VIEWS = {
    SeenIn.PLAIN: (types.float64, FLOATS, 1),
    SeenIn.ALL_LANES: (LANES, LANE_ROWS, SIMD_WIDTH),
    SeenIn.ONE_LANE: (types.float64, LANE_ROW, SIMD_WIDTH),
}
"""The types of floats and of rows of floats in each view, and the distance of a record's places in memory."""
OF_ADDRESSES = {records.FLOATS: FLOATS, records.INTEGERS: INTEGERS, pointers.LANES: LANE_ROWS}


class RecordPointer(types.Type):  # type: ignore[misc]
    """The type of a record in compiled code: a pointer to its first place, and how the record is seen."""

    def __init__(self, record: type[MemoryRecord], view: SeenIn = SeenIn.PLAIN) -> None:
        self.record, self.view = record, view
        self.number, self.row, self.stride = OF_VIEWS[view]
        super().__init__(name=f"{view.name} {record.__module__}.{record.__name__}")

    def type_of(self, place: Slot) -> Any:
        """Return the type that a field has in compiled code: a record inside this one is seen in the same way."""
        if place.kind in (float, int):
            return self.number if place.kind is float else types.int64
        if isinstance(place.kind, type):
            return RecordPointer(place.kind, self.view)
        return self.row if place.inside else OF_ADDRESSES[place.kind]

    def address(self, builder: Any, pointer: Any, place: Slot) -> Any:
        """Write the calculation of a field's address from that of its record."""
        return builder.gep(pointer, [ir.Constant(INTEGER, self.stride * place.first)], inbounds=True)


@register_model(RecordPointer)
@register_model(LaneRow)
class _PointerModel(models.PrimitiveModel):  # type: ignore[misc] # numba
    """The representation of such a pointer in machine code: the address of a 64-bit place."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, INTEGER.as_pointer())


@infer_getattr
class _Fields(AttributeTemplate):  # type: ignore[misc] # numba
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


def _nth_typed(pointer: Any, n: Any) -> Any:
    """Return the signature of indexing records in a row, lanes of a record, or numbers in a row of one lane; else None."""
    if not isinstance(n, types.Integer) or not isinstance(pointer, (RecordPointer, LaneRow)):
        return None
    return (types.float64 if pointer == LANE_ROW else pointer)(pointer, types.int64)


def _assigned_typed(row: Any, n: Any, number: Any) -> Any:
    """Return the signature of assigning a number in a row of one lane; else None."""
    return types.none(LANE_ROW, types.int64, types.float64) if row == LANE_ROW and isinstance(n, types.Integer) else None


typed_as(operator.getitem, _nth_typed, 2)
typed_as(operator.setitem, _assigned_typed, 3)


@lower_builtin(operator.getitem, RecordPointer, types.Integer)
def _nth(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
    """Write the calculation of the address of a record in a row of records, or of a lane of a record."""
    apart = called.args[0].record.total if called.args[0].view is SeenIn.PLAIN else 1
    return builder.gep(arguments[0], [builder.mul(arguments[1], ir.Constant(INTEGER, apart))])


def _in_row(builder: Any, row: Any, k: Any) -> Any:
    """Write the calculation of the address of number k in a row of a lane."""
    address = builder.gep(row, [builder.mul(k, ir.Constant(INTEGER, SIMD_WIDTH))])
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


def register() -> None:
    """Make rules for all functions that see memory as something."""
    while SeenAs.known:
        _register(SeenAs.known.pop())


def _register(one: SeenAs) -> None:
    seen = OF_ADDRESSES[one.kind] if one.kind in OF_ADDRESSES else RecordPointer(one.kind, one.view)  # type: ignore[arg-type]

    @rule(one, lambda memory: seen(types.int64 if isinstance(memory, types.Integer) else memory), 1)
    def write(context: Any, builder: Any, called: Any, arguments: Any) -> Any:
        (given,), (found,), wanted = called.args, arguments, context.get_value_type(seen)
        if isinstance(given, types.Integer):
            return builder.inttoptr(found, wanted)
        if isinstance(given, types.Array):
            found = context.make_array(given)(context, builder, found).data
        return builder.bitcast(found, wanted)
