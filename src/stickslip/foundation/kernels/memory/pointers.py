"""How compiled code sees memory: records by the names of their fields (see `records`), and rows of floats, integers or lanes.

A record may lie in memory as it is, or in lanes: then each of its places holds a number for every lane, one beside the other.
Compiled code sees such memory in two ways. `all_lanes(record)(address).rate` is a number in every lane: the processor works on all
at once. `one_lane(record)(address)[n].rate` is the number of lane n. A row of floats is indexed in both.

The functions here are plain Python, for use without compiler; machine code has rules of its own for them (`kernels.compiler`).
"""

from __future__ import annotations

from enum import Enum, auto
from typing import Any, ClassVar

from stickslip.foundation.kernels.memory.records import FLOATS, INTEGERS, AddressOf, MemoryRecord
from stickslip.foundation.kernels.uncompiled import Pointer


class SeenIn(Enum):
    """A way to see a record."""

    PLAIN = auto()
    ALL_LANES = auto()
    ONE_LANE = auto()


LANES = AddressOf(object)
"""Addresses of lanes."""


class SeenAs:
    """A function for compiled code that sees memory as `kind`: given as an array, an address, a pointer or a record."""

    known: ClassVar[list[SeenAs]] = []
    """All such functions, for which `kernels.compiler` has rules."""

    def __init__(self, kind: AddressOf | type[MemoryRecord], view: SeenIn = SeenIn.PLAIN) -> None:
        self.kind, self.view = kind, view
        self.known.append(self)

    def __call__(self, memory: Any) -> Any:
        """Return a pointer to the numbers of a record, or the first record in an array or behind a pointer."""
        if isinstance(self.kind, AddressOf):
            return Pointer(memory.numbers)
        if isinstance(memory, self.kind):
            return memory
        return self.kind(Pointer(memory.reshape(-1)) if getattr(memory, "ndim", 1) > 1 else memory)


numbers_of, whole_numbers_of = SeenAs(FLOATS), SeenAs(INTEGERS)
"""The numbers of a record that has only floats, or only integers, as a row; also a record in lanes, for the functions of a law."""
rows_of = SeenAs(LANES)
"""A record in all lanes, or an address (bytes, a multiple of 64), as a row of lanes."""


def record_at(record: type[MemoryRecord]) -> Any:
    """Return a function with which kernels turn memory (an array, or a pointer to it) or a record into the first record there."""
    return SeenAs(record)


def all_lanes(record: type[MemoryRecord]) -> Any:
    """Return a function for compiled code that sees the memory at an address as a record in all lanes."""
    return SeenAs(record, SeenIn.ALL_LANES)


def one_lane(record: type[MemoryRecord]) -> Any:
    """Return a function for compiled code that sees the memory at an address as a record in lane 0."""
    return SeenAs(record, SeenIn.ONE_LANE)
