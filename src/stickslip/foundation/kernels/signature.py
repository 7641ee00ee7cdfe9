"""What Python hands to machine code: numbers, and arrays as their address and shape, in the order of a function's annotations."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import addressof, c_char, c_double, c_int64
from dataclasses import dataclass
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

NO_BYTES = c_char * 0
"""What is read of an array to learn its address, in a quarter of the time that numpy's own `ctypes.data` takes."""
NUMBERS_IN_C = {float: c_double, int: c_int64, bool: c_int64}
"""What C makes of Python's numbers."""


@dataclass(frozen=True)
class ArrayOf:
    """An array: the type of its numbers, and its number of dimensions."""

    of: np.dtype[Any]
    dimensions: int


@dataclass(frozen=True)
class Fields:
    """A named tuple, and the kinds of its fields."""

    made: Callable[..., Any]
    kinds: tuple[Kind, ...]


Kind = type | ArrayOf | Fields
"""A kind of argument: float, int or bool, an array, or a named tuple of such."""


@dataclass(frozen=True)
class Signature:
    """The kinds of a function's arguments, and of its result: float, int, bool or None."""

    kinds: tuple[Kind, ...]
    result: type | None

    @property
    def in_c(self) -> tuple[Any, list[Any]]:
        """The types of C of the result and of all arguments."""
        return None if self.result is None else NUMBERS_IN_C[self.result], [one for kind in self.kinds for one in _in_c(kind)]


def signature_of(function: Callable[..., Any]) -> Signature:
    """Return the signature that a function's annotations declare."""
    *kinds, result = get_type_hints(function, include_extras=True).values()
    return Signature(tuple(map(_kind_of, kinds)), None if result is type(None) else result)


def _kind_of(hint: Any) -> Kind:
    if hint in NUMBERS_IN_C:
        return hint
    if get_origin(hint) is Annotated:
        array, dimensions = get_args(hint)
        return ArrayOf(np.dtype(get_args(get_args(array)[1])[0]), dimensions)
    return Fields(hint, tuple(map(_kind_of, get_type_hints(hint, include_extras=True).values())))


def _in_c(kind: Kind) -> list[Any]:
    if isinstance(kind, ArrayOf):
        return [c_int64] * (1 + kind.dimensions)
    if isinstance(kind, Fields):
        return [one for each in kind.kinds for one in _in_c(each)]
    return [NUMBERS_IN_C[kind]]


class Ready:
    """An array whose address and shape are looked up once, for one that is handed on again and again."""

    __slots__ = ("array", "kind", "numbers")

    def __init__(self, array: NDArray[Any]) -> None:
        self.array, self.kind = array, ArrayOf(array.dtype, array.ndim)
        self.numbers = flattened((self.kind,), (array,))


def flattened(kinds: tuple[Kind, ...], given: tuple[Any, ...]) -> list[Any]:
    """Return arguments as C takes them. Raises TypeError for an array that machine code would misread."""
    flat: list[Any] = []
    one: Any
    for kind, one in zip(kinds, given, strict=True):
        if type(one) is Ready and one.kind == kind:
            flat += one.numbers
        elif isinstance(kind, ArrayOf):
            one = one.array if type(one) is Ready else one  # of another kind, which is refused
            if one.dtype != kind.of or one.ndim != kind.dimensions or not one.flags.c_contiguous:
                raise TypeError(f"machine code takes {kind}, not {one.dtype} of shape {one.shape} and strides {one.strides}")
            own = one.flags.owndata and one.flags.writeable  # as it is of no view that numpy has broadcast
            flat += (addressof(NO_BYTES.from_buffer(one)) if own else one.ctypes.data, *one.shape)
        elif isinstance(kind, Fields):
            flat += flattened(kind.kinds, one)
        else:
            flat.append(kind(one))
    return flat
