"""The springs between the blocks of a chain or a lattice, as rows of neighbours."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity

SPRING = Quantity("N/m", "stiffness of a spring between two blocks", at_least=0)
Floats = NDArray[np.float64]
Whole = NDArray[np.int64]
WHERE = "Chain: coupling"


class Couplings(NamedTuple):
    """For each block its neighbours and the springs to them, row after row: block j owns the places starts[j] to starts[j + 1].

    Neighbours that lie opposite each other stand side by side, and a place without a neighbour names the block itself with a spring
    of 0: a sum in pairs then has the same bits from either end of the chain. `walls` are the springs (N/m) to walls at rest.
    """

    starts: Whole
    neighbours: Whole
    springs: Floats
    walls: Floats


def one_stiffness(name: str, value: Any) -> float:
    """Return one stiffness (N/m). Raises InputError."""
    return SPRING.check("Chain", name, value)


def is_sparse(value: Any) -> bool:
    """Return True for a sparse matrix of scipy."""
    return hasattr(value, "tocsr") and hasattr(value, "nnz")


def checked_coupling(value: Any, shape: tuple[int, ...], ends: str) -> Any:
    """Return the coupling of a chain (n,) or a lattice (rows, columns) as it is kept: a number, an array, a pair, or a matrix."""
    if is_sparse(value):
        return _checked_matrix(value, int(np.prod(shape)), ends)
    if len(shape) == 2:
        pair = value if isinstance(value, tuple | list | np.ndarray) else (value, value)
        if len(pair) != 2:
            raise InputError(
                f"{WHERE} of a lattice must be a number or a pair (along rows, along columns), got {len(pair)} numbers"
            )
        return tuple(one_stiffness(f"coupling {way}", one) for way, one in zip(("along rows", "along columns"), pair, strict=True))
    if isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim > 0):
        count = {"free": shape[0] - 1, "periodic": shape[0], "fixed": shape[0] + 1}[ends]
        if len(value) != count:
            raise InputError(f"{WHERE} of {shape[0]} blocks with {ends} ends must have {count} springs, got {len(value)}")
        return array_of(SPRING, "coupling", value)
    return one_stiffness("coupling", value)


def array_of(kind: Quantity, name: str, value: Any) -> Floats:
    """Return numbers of a list or an array, checked, as an array that cannot be written. Raises InputError."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiu":
        found = value.astype(float).ravel()
        for i in np.flatnonzero(~kind.allows(found))[:1]:
            kind.check("Chain", f"{name}[{i}]", float(found[i]))
    else:
        found = np.array([float(kind.check("Chain", f"{name}[{i}]", one)) for i, one in enumerate(value)])
    found.flags.writeable = False
    return found


def _checked_matrix(matrix: Any, count: int, ends: str) -> Any:
    if ends != "free":
        raise InputError(f"{WHERE} is a matrix, which says of all springs what they join: ends must be 'free', got '{ends}'")
    if matrix.shape != (count, count):
        raise InputError(f"{WHERE} must be a matrix of {count} by {count}, got {' by '.join(map(str, matrix.shape))}")
    found = matrix.tocsr().astype(float)
    found.sum_duplicates()
    found.eliminate_zeros()
    if not SPRING.allows(found.data).all():
        raise InputError(f"{WHERE} must have springs of 0 or more N/m, finite, got {found.data[~SPRING.allows(found.data)][0]:g}")
    if found.diagonal().any():
        raise InputError(f"{WHERE}: the diagonal of the matrix must be 0: entry [j, k] is the spring between blocks j and k")
    if (found != found.T).nnz:
        raise InputError(f"{WHERE}: the matrix must be symmetric: a spring pulls at both of its ends")
    return found


def couplings_of(coupling: Any, shape: tuple[int, ...], ends: str) -> Couplings:
    """Return the rows of neighbours of a checked coupling."""
    if is_sparse(coupling):
        rows = coupling.indptr.astype(np.int64), coupling.indices.astype(np.int64), np.array(coupling.data, float)
        return Couplings(*rows, np.zeros(coupling.shape[0]))
    return _of_chain(coupling, shape[0], ends) if len(shape) == 1 else _of_lattice(coupling, shape, ends)


def _of_chain(coupling: Any, count: int, ends: str) -> Couplings:
    """Return the rows of a chain: two places for each block, towards the first block and towards the last."""
    springs = np.full(count + 1, coupling) if isinstance(coupling, float) else np.zeros(count + 1)
    if not isinstance(coupling, float):
        springs[{"free": slice(1, -1), "periodic": slice(1, None), "fixed": slice(None)}[ends]] = coupling
    if ends == "periodic":
        springs[0] = springs[-1]
    walls = np.zeros(count)
    places = np.column_stack((np.arange(-1, count - 1), np.arange(1, count + 1))) % count
    held = np.column_stack((springs[:-1], springs[1:]))
    if ends != "periodic":
        walls[0], walls[-1] = (held[0, 0], held[-1, 1]) if ends == "fixed" and count > 1 else (0.0, 0.0)
        if ends == "fixed" and count == 1:
            walls[0] = held[0, 0] + held[0, 1]
        held[0, 0] = held[-1, 1] = 0.0
        places[0, 0], places[-1, 1] = 0, count - 1
    return Couplings(np.arange(0, 2 * count + 1, 2), places.ravel(), held.ravel(), walls)


def _of_lattice(coupling: Any, shape: tuple[int, ...], ends: str) -> Couplings:
    """Return the rows of a lattice: two places for the neighbours in the same row, and two for those in the same column."""
    numbers = np.arange(shape[0] * shape[1]).reshape(shape)
    places, springs = np.empty((*shape, 4), np.int64), np.empty((*shape, 4))
    walls = np.zeros(shape)
    for k, (axis, step) in enumerate(((1, 1), (1, -1), (0, 1), (0, -1))):
        places[..., k] = np.roll(numbers, step, axis)
        springs[..., k] = coupling[0 if axis == 1 else 1]
        if ends != "periodic":
            border = [slice(None), slice(None)]
            border[axis] = slice(0, 1) if step == 1 else slice(-1, None)
            edge = tuple(border)
            walls[edge] += springs[..., k][edge] if ends == "fixed" else 0.0
            springs[..., k][edge] = 0.0
            places[..., k][edge] = numbers[edge]
    return Couplings(np.arange(0, 4 * numbers.size + 1, 4), places.ravel(), springs.ravel(), walls.ravel())
