"""The pieces of a history by their addresses: of arrays that are handed on, compiled code counts references."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.engine.codegen.compiler import ahead, floats, integers, kernel
from stickslip.engine.state.layout import TERMS, Floats, Integers, Store
from stickslip.engine.state.workspace import REAL, WHOLE


class Pieces(NamedTuple):
    """The tables of a `Store` as pointers, row after row."""

    whole: Integers
    real: Floats
    load: Floats
    rate: Floats


@kernel
def pieces_of(store: Store) -> Pieces:
    """The pieces of a history; the caller keeps it alive."""
    tables = store.real.ctypes.data, store.load.ctypes.data, store.rate.ctypes.data
    return Pieces(integers(store.whole.ctypes.data), floats(tables[0]), floats(tables[1]), floats(tables[2]))


@kernel
def whole_of(store: Pieces, n: int) -> Integers:
    """Row of a piece in `Store.whole`."""
    return ahead(store.whole, WHOLE * n)


@kernel
def real_of(store: Pieces, n: int) -> Floats:
    """Row of a piece in `Store.real`."""
    return ahead(store.real, REAL * n)


@kernel
def load_of(store: Pieces, n: int) -> Floats:
    """Its load as a polynomial."""
    return ahead(store.load, TERMS * n)


@kernel
def rate_of(store: Pieces, n: int) -> Floats:
    """Its slip rate as a polynomial."""
    return ahead(store.rate, TERMS * n)
