"""Access the pieces of a history through pointers, because compiled code counts references to arrays that it hands on."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.engine.codegen.compiler import ahead, floats, integers, kernel
from stickslip.engine.state.layout import TERMS, Floats, Integers, Store
from stickslip.engine.state.workspace import REAL, WHOLE


class Pieces(NamedTuple):
    """The tables of a `Store` as pointers to their first numbers, row after row."""

    whole: Integers
    real: Floats
    load: Floats
    rate: Floats


@kernel
def pieces_of(store: Store) -> Pieces:
    """Return pointers to the tables of a history, which the caller keeps alive."""
    tables = store.real.ctypes.data, store.load.ctypes.data, store.rate.ctypes.data
    return Pieces(integers(store.whole.ctypes.data), floats(tables[0]), floats(tables[1]), floats(tables[2]))


@kernel
def whole_of(store: Pieces, n: int) -> Integers:
    """Return a pointer to the row of piece n in `Store.whole`."""
    return ahead(store.whole, WHOLE * n)


@kernel
def real_of(store: Pieces, n: int) -> Floats:
    """Return a pointer to the row of piece n in `Store.real`."""
    return ahead(store.real, REAL * n)


@kernel
def load_of(store: Pieces, n: int) -> Floats:
    """Return a pointer to the coefficients of the load (Pa or N, minus the reference strength) of piece n."""
    return ahead(store.load, TERMS * n)


@kernel
def rate_of(store: Pieces, n: int) -> Floats:
    """Return a pointer to the coefficients of the slip rate (m/s) of piece n."""
    return ahead(store.rate, TERMS * n)
