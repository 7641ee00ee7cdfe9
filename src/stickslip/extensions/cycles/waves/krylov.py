"""Linear equations and leading eigenvalues of an operator that is known by what it does: GMRES and Arnoldi's iteration.

Sources: Saad & Schultz 1986, SIAM J. Sci. Stat. Comput. 7, 856; Arnoldi 1951, Q. Appl. Math. 9, 17.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats

Operator = Callable[[Floats], Floats]
"""A linear operator."""
EXHAUSTED = 1e-14
"""A new direction is rounding where so small a share (1) is left: the space is whole."""
FIRST_LOOK, EVERY = 16, 4
"""Eigenvalues are looked at in a space of so many directions (1), and each time so many more."""
SMALL_MATRIX, MOST_OF_MATRIX, LOOKS_EVERY, TO_ROUNDING = 120, 56, 8, 1e-12
"""A matrix with fewer rows (1) is looked at whole, of others spaces of so many directions, each time so many more; errors (1) that
are rounding."""
EXACT, KNOWN, ROUGHLY_KNOWN = 1e-7, 1e-5, 0.03
"""Errors (1) of eigenvalues: what is wanted of large ones, what is called known, and what is called roughly known."""


def _spaces(operator: Operator, start: Floats, most: int) -> Iterator[tuple[Floats, Floats]]:
    """Yield bases of growing spaces, in columns, with the operator in them: one row more than columns."""
    basis, matrix = np.zeros((len(start), most + 1)), np.zeros((most + 1, most))
    basis[:, 0] = start / np.linalg.norm(start)
    for n in range(most):
        new = operator(basis[:, n])
        size = np.linalg.norm(new)
        for _ in range(2):  # a second time, because rounding leaves a part along the others
            along = basis[:, : n + 1].T @ new
            matrix[: n + 1, n] += along
            new = new - basis[:, : n + 1] @ along
        matrix[n + 1, n] = np.linalg.norm(new)
        whole = matrix[n + 1, n] <= EXHAUSTED * size
        if not whole:
            basis[:, n + 1] = new / matrix[n + 1, n]
        yield basis[:, : n + 1], matrix[: n + 2, : n + 1]
        if whole:
            return


def solved(operator: Operator, right: Floats, accuracy: float, most: int) -> tuple[Floats, float, int]:
    """Return x with operator(x) = right up to a share (1) of its size, the share that is left, and the number of directions."""
    size = float(np.linalg.norm(right))
    if size == 0.0:
        return np.zeros(len(right)), 0.0, 0
    found, left, count = np.zeros(len(right)), 1.0, 0
    for basis, matrix in _spaces(operator, right, most):
        first = np.zeros(len(matrix))
        first[0] = size
        weights = np.linalg.lstsq(matrix, first, rcond=None)[0]
        found, count = basis @ weights, len(weights)
        left = float(np.linalg.norm(first - matrix @ weights)) / size
        if left <= accuracy:
            break
    return found, left, count


def largest(matrix: Floats, many: int, least: float) -> NDArray[Any]:
    """Return up to `many` of the largest eigenvalues of a matrix, to rounding: the first, and others larger in size than `least`.

    A large matrix is looked at in a growing space first, which is enough where few of them stand out.
    """
    if len(matrix) > SMALL_MATRIX:
        start = np.random.default_rng(0).normal(size=len(matrix))
        for basis, inside in _spaces(matrix.__matmul__, start, MOST_OF_MATRIX):
            count = basis.shape[1]
            if count % LOOKS_EVERY and inside[-1, -1] > TO_ROUNDING * np.abs(inside).max():
                continue
            values, vectors = np.linalg.eig(inside[:-1])
            order = np.argsort(-np.abs(values), kind="stable")
            missed = np.abs(inside[-1, -1] * vectors[-1])[order]
            found = _first_of(values[order], many, least)
            if missed[: len(found)].max() <= TO_ROUNDING * np.abs(values).max():
                return found
    values = np.linalg.eigvals(matrix)
    return _first_of(values[np.argsort(-np.abs(values), kind="stable")], many, least)


def _first_of(values: NDArray[Any], many: int, least: float) -> NDArray[Any]:
    """Return the first of eigenvalues that become smaller, as `largest` does; a pair is not parted."""
    count = max(1, min(many, int(np.sum(np.abs(values) > least))))
    return np.asarray(values[: count + (count < len(values) and values[count - 1].imag > 0.0)], complex)


def leading(operator: Operator, start: Floats, many: int, large: float, most: int) -> NDArray[Any]:
    """Return up to `many` of the largest eigenvalues.

    Those larger in size than `large` are exact. If there are none, others are returned that are known, or roughly the largest.
    """
    values, missed = np.zeros(0, complex), np.zeros(0)
    for basis, matrix in _spaces(operator, start, most):
        count = basis.shape[1]
        if count < most and (count < FIRST_LOOK or count % EVERY) and matrix[-1, -1] > EXACT * np.abs(matrix).max():
            continue
        values, vectors = np.linalg.eig(matrix[:-1])
        order = np.argsort(-np.abs(values), kind="stable")
        values, missed = values[order], np.abs(matrix[-1, -1] * vectors[-1])[order]
        big = np.abs(values) > large
        if missed[big].max(initial=0.0) <= EXACT and (big.any() or missed[0] <= ROUGHLY_KNOWN):
            break
    known = np.minimum.accumulate(missed <= KNOWN)
    found = values[known] if known.any() else values[: 2 if values[0].imag else 1]
    return found[: many + (many < len(found) and found[many - 1].imag > 0.0)]
