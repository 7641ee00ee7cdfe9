"""Records: memory with named places, read and written by the same words in compiled code and in Python.

A record is a run of 8-byte places, each a float, a whole number, an address or a record of its own. Compiled code gets a pointer
to the first place; `run.state.xi` is then one load at a known distance, without any count of references. Python wraps the same
memory as an object: `State(numbers).xi`.

    class State(Record):
        xi: float  # where in the piece of load the contact is
        row: int
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self, get_type_hints

import llvmlite.ir as ir
import numpy as np
from numba import types
from numba.core import datamodel
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    lower_setattr_generic,
    models,
    register_model,
)
from numpy.typing import NDArray

from stickslip.engine.codegen.uncompiled import UNCOMPILED, Pointer, pointer_at

Floats = NDArray[np.float64]
FLOATS, INTEGERS = types.CPointer(types.float64), types.CPointer(types.int64)
"""What compiled code sees of an address: a pointer that is indexed like an array."""


@dataclass(frozen=True)
class Place:
    """Where a field of a record is (in places of 8 bytes), how many places it has, and what it is."""

    first: int
    size: int
    kind: Any  # float, int, a record, or a pointer's type
    inside: bool  # the record or the row of numbers lies here, and not its address


@dataclass(frozen=True)
class _Wanted:
    kind: Any
    size: int
    inside: bool


def floats_at() -> Any:
    """Declare the address of floats."""
    return _Wanted(FLOATS, 1, False)


def integers_at() -> Any:
    """Declare the address of whole numbers."""
    return _Wanted(INTEGERS, 1, False)


def row(size: int) -> Any:
    """Declare so many floats that lie in the record itself."""
    return _Wanted(FLOATS, size, True)


def inside(record: type[Record], size: int | None = None) -> Any:
    """Declare a record that lies in this one, in at least so many places."""
    return _Wanted(record, record.total if size is None else size, True)


class Record:
    """The base of all records. Their fields are annotations; a float or a whole number needs no more than that."""

    places: ClassVar[dict[str, Place]] = {}
    total: ClassVar[int] = 0
    """How many places a record has."""

    def __init_subclass__(cls) -> None:
        first, cls.places = 0, {}
        for name, kind in get_type_hints(cls).items():
            if name in ("places", "total"):
                continue
            wanted = cls.__dict__.get(name, _Wanted(kind, 1, False))
            cls.places[name] = Place(first, wanted.size, wanted.kind, wanted.inside)
            first += wanted.size
            setattr(cls, name, _descriptor(cls.places[name], name))
        cls.total = first

    def __init__(self, numbers: NDArray[Any]) -> None:
        self.numbers = numbers

    def copy(self) -> Self:
        """Return a copy with its own memory."""
        return type(self)(self.numbers.copy())


class _Number:
    """A number of a record, for Python: a column of them where the memory holds many records side by side."""

    def __init__(self, place: int) -> None:
        self.place = place

    def __get__(self, record: Record | None, owner: type[Record]) -> Any:
        return self if record is None else record.numbers[self.place]

    def __set__(self, record: Record, value: Any) -> None:
        record.numbers[self.place] = value


class _Inside:
    """A row of floats, or a record, that lies in another one, for Python: found once and kept."""

    def __init__(self, place: Place, name: str) -> None:
        self.place, self.name = place, name

    def __get__(self, record: Record | None, owner: type[Record]) -> Any:
        if record is None:
            return self
        begin, end = self.place.first, self.place.first + self.place.size
        if self.place.kind is FLOATS:  # up to the end of the record: some functions write on into the row that follows
            found: Any = Pointer(record.numbers.view(np.float64), begin)
        else:
            kind = np.int64 if int in get_type_hints(self.place.kind).values() else np.float64
            found = self.place.kind(record.numbers[begin:end].view(kind))
        record.__dict__[self.name] = found
        return found


class _Address:
    """An address in a record, for Python: a pointer into the array that has been lent."""

    def __init__(self, place: Place) -> None:
        self.place, self.kind = place.first, np.float64 if place.kind is FLOATS else np.int64

    def __get__(self, record: Record | None, owner: type[Record]) -> Any:
        return self if record is None else pointer_at(record.numbers[self.place], self.kind)

    def __set__(self, record: Record, pointer: Pointer) -> None:
        record.numbers[self.place] = pointer.address


def _descriptor(place: Place, name: str) -> Any:
    if place.kind in (float, int):
        return _Number(place.first)
    return _Inside(place, name) if place.inside else _Address(place)


class RecordPointer(types.Type):  # type: ignore[misc] # numba is untyped
    """What compiled code knows of a record: a pointer to its first place."""

    def __init__(self, record: type[Record]) -> None:
        self.record = record
        super().__init__(name=f"pointer to {record.__module__}.{record.__name__}")


@register_model(RecordPointer)
class _PointerModel(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: datamodel.DataModelManager, kind: RecordPointer) -> None:
        super().__init__(manager, kind, ir.IntType(64).as_pointer())


def _type_of(place: Place) -> Any:
    """Return numba's type of a field."""
    if place.kind is float:
        return types.float64
    if place.kind is int:
        return types.int64
    return RecordPointer(place.kind) if isinstance(place.kind, type) else place.kind


@infer_getattr
class _Fields(AttributeTemplate):  # type: ignore[misc]
    key = RecordPointer

    def generic_resolve(self, kind: RecordPointer, name: str) -> Any:
        """Return the type of a field; None if there is none of this name."""
        place = kind.record.places.get(name)
        return None if place is None else _type_of(place)


def _address(builder: Any, pointer: Any, place: Place) -> Any:
    return builder.gep(pointer, [ir.Constant(ir.IntType(64), place.first)], inbounds=True)


@lower_getattr_generic(RecordPointer)
def _get(context: Any, builder: Any, kind: RecordPointer, pointer: Any, name: str) -> Any:
    place = kind.record.places[name]
    wanted = context.get_value_type(_type_of(place))
    address = _address(builder, pointer, place)
    if place.inside:
        return builder.bitcast(address, wanted)
    return builder.load(builder.bitcast(address, wanted.as_pointer()))


@lower_setattr_generic(RecordPointer)
def _set(context: Any, builder: Any, signature: Any, arguments: Any, name: str) -> None:
    pointer, value = arguments
    place = signature.args[0].record.places[name]
    builder.store(value, builder.bitcast(_address(builder, pointer, place), value.type.as_pointer()))


@intrinsic
def numbers_of(typingctx: Any, record: Any) -> Any:
    """Return a record of floats as a pointer to them."""

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(FLOATS))

    return FLOATS(record), codegen


@intrinsic
def whole_numbers_of(typingctx: Any, record: Any) -> Any:
    """Return a record of whole numbers as a pointer to them."""

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(INTEGERS))

    return INTEGERS(record), codegen


def record_at(record: type[Record]) -> Any:
    """Return a function for kernels from memory, an array of whole numbers or a pointer to it, to the record in it."""
    if UNCOMPILED:
        return record
    kind, pointer = RecordPointer(record), ir.IntType(64).as_pointer()

    @intrinsic
    def at(typingctx: Any, memory: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            given = signature.args[0]
            if isinstance(given, types.Array):
                return builder.bitcast(context.make_array(given)(context, builder, arguments[0]).data, pointer)
            if isinstance(given, types.Integer):
                return builder.inttoptr(arguments[0], pointer)
            return builder.bitcast(arguments[0], pointer)

        return kind(memory), codegen

    return at


if UNCOMPILED:

    def numbers_of(record: Record) -> Pointer:
        """Return the numbers of a record."""
        return Pointer(record.numbers)

    whole_numbers_of = numbers_of
