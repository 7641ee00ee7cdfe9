"""Define records: memory with named places, which compiled code and Python read and write by the same names.

A record is a sequence of 8-byte places, filled by floats, 64-bit integers, addresses, rows of floats and other records. Compiled
code holds a pointer to the first place, so that `run.state.xi` is one load at a fixed distance, without reference counting. Python
wraps the same memory as an object: `State(numbers).xi`.

    class State(Record):
        xi: float  # where in the piece of load the contact is
        row: int
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self, get_type_hints

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.kernels.uncompiled import Pointer, pointer_at

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class AddressOf:
    """The type of an address in compiled code: a pointer to numbers of this type, which is indexed like an array."""

    number: type


FLOATS, INTEGERS = AddressOf(float), AddressOf(int)
"""Addresses of floats, and of whole numbers."""


@dataclass(frozen=True)
class Slot:
    """The position of a field in its record and its size, both in places of 8 bytes, and its type."""

    first: int
    size: int
    kind: Any  # float, int, a record, or the type of an address
    inside: bool  # True if the record or the row of floats itself lies here; False if it is a number or an address


@dataclass(frozen=True)
class _Wanted:
    """The declaration of a field: its type, its size in places, and whether it lies inside the record."""

    kind: Any
    size: int
    inside: bool


def floats_at() -> Any:
    """Declare a field that holds the address of floats."""
    return _Wanted(FLOATS, 1, False)


def floats_inside(size: int) -> Any:
    """Declare a row of `size` floats that lie in the record itself."""
    return _Wanted(FLOATS, size, True)


def records_at(record: type[MemoryRecord]) -> Any:
    """Declare a field that holds the address of records, one after the other: `run.history[n].phase_from`."""
    return _Wanted(record, 1, False)


def inside(record: type[MemoryRecord], size: int | None = None) -> Any:
    """Declare a record that lies in this one and takes `size` places, by default as many as it has."""
    return _Wanted(record, record.total if size is None else size, True)


class MemoryRecord:
    """The base class of all records. Fields are annotations; a float or an integer needs nothing else.

    The memory of a record that has only floats is an array of floats. Any other record lies in an array of 64-bit integers, which
    holds the bits of its floats.
    """

    places: ClassVar[dict[str, Slot]] = {}
    """The place of each field, by name."""
    total: ClassVar[int] = 0
    """Number of 8-byte places of a record."""
    memory_type: ClassVar[type] = np.float64
    """Type of the numbers in the array that holds a record."""

    def __init_subclass__(cls) -> None:
        first, cls.places = 0, {}
        for name, kind in get_type_hints(cls).items():
            if name in ("places", "total", "memory_type"):
                continue
            wanted = cls.__dict__.get(name, _Wanted(kind, 1, False))
            cls.places[name] = Slot(first, wanted.size, wanted.kind, wanted.inside)
            first += wanted.size
        cls.total = first
        has_only_floats = all(place.kind is float or (place.inside and place.kind is FLOATS) for place in cls.places.values())
        cls.memory_type = np.float64 if has_only_floats else np.int64
        for name, place in cls.places.items():
            setattr(cls, name, _descriptor(place, name, cls.memory_type))

    def __init__(self, numbers: Any) -> None:
        self.numbers = numbers

    @classmethod
    def table(cls, *shape: int) -> NDArray[Any]:
        """Return memory filled with zeros for an array of records; its last axis is that of their places."""
        return np.zeros((*shape, cls.total), cls.memory_type)

    @classmethod
    def of(cls, table: NDArray[Any]) -> Any:  # the fields are arrays and not the numbers that their annotations say
        """Return the records in a table as one object; each of its fields is an array with one entry for each record.

        The arrays share the table's memory. A row of floats in the record becomes the last axis of its array.
        """
        return cls(table.T if table.ndim == 2 else np.moveaxis(table, -1, 0))

    def __getitem__(self, n: int) -> Self:
        """Return the record that lies n records after this one, in plain Python as in compiled code."""
        return type(self)(self.numbers.ahead(n * self.total))  # a `Pointer` of uncompiled code

    def copy(self) -> Self:
        """Return a copy with its own memory."""
        return type(self)(self.numbers.copy())


class _Number:
    """Python's access to a number in a record, or to one number of each if the memory has the shape (places, records)."""

    def __init__(self, place: int) -> None:
        self.place = place

    def __get__(self, record: MemoryRecord | None, owner: type[MemoryRecord]) -> Any:
        return self if record is None else record.numbers[self.place]

    def __set__(self, record: MemoryRecord, value: Any) -> None:
        record.numbers[self.place] = value


class _FloatAmongIntegers(_Number):
    """Python's access to a float in a record whose memory is an array of integers."""

    def __get__(self, record: MemoryRecord | None, owner: type[MemoryRecord]) -> Any:
        return self if record is None else record.numbers[self.place].view(np.float64)

    def __set__(self, record: MemoryRecord, value: Any) -> None:
        record.numbers[self.place] = np.asarray(value, np.float64).view(np.int64)[()]


class _Inside:
    """Python's access to a row of floats or a record that lies inside another record; the view is made once and kept."""

    def __init__(self, place: Slot, name: str) -> None:
        self.place, self.name = place, name

    def __get__(self, record: MemoryRecord | None, owner: type[MemoryRecord]) -> Any:
        if record is None:
            return self
        begin, end = self.place.first, self.place.first + self.place.size
        found: Any
        if self.place.kind is FLOATS and isinstance(record.numbers, Pointer):
            found = record.numbers.ahead(begin).as_floats()
        elif self.place.kind is FLOATS and record.numbers.ndim > 1:
            rows = record.numbers[begin:end]
            found = (rows.T if rows.ndim == 2 else np.moveaxis(rows, 0, -1)).view(np.float64)
        elif self.place.kind is FLOATS:  # up to the end of the record: some functions write beyond a row into the next one
            found = Pointer(record.numbers.view(np.float64), begin)
        else:
            found = self.place.kind(record.numbers[begin:end].view(self.place.kind.memory_type))
        record.__dict__[self.name] = found
        return found


class _Address:
    """Python's access to an address in a record: a pointer into the array that was lent (see `uncompiled.lend_memory`)."""

    def __init__(self, place: Slot) -> None:
        self.place = place.first
        self.record: type[MemoryRecord] | None = place.kind if isinstance(place.kind, type) else None
        self.kind = self.record.memory_type if self.record else np.float64 if place.kind is FLOATS else np.int64

    def __get__(self, record: MemoryRecord | None, owner: type[MemoryRecord]) -> Any:
        if record is None:
            return self
        pointer = pointer_at(record.numbers[self.place], self.kind)
        return self.record(pointer) if self.record else pointer

    def __set__(self, record: MemoryRecord, pointer: Pointer) -> None:
        record.numbers[self.place] = pointer.address


def _descriptor(place: Slot, name: str, memory_type: type) -> Any:
    """Return the object through which Python reads and writes a field."""
    if place.kind is float and memory_type is np.int64:
        return _FloatAmongIntegers(place.first)
    if place.kind in (float, int):
        return _Number(place.first)
    return _Inside(place, name) if place.inside else _Address(place)
