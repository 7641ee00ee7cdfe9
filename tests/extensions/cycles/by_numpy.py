"""The equation of disturbances along a run in NumPy: ten of Radau's points on each of a fixed number of parts of a piece.

Derivatives are those that a law gives to Python (`FrictionLaw.slopes`), matrices are solved by LAPACK, and nothing is eliminated by
hand: no line is shared with the machine code that it is compared with.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.engine import History, Positions
from stickslip.extensions.cycles.tangent import values_at
from stickslip.friction.contract import one_argument
from stickslip.friction.formula import value_and_slopes
from stickslip.problem.bodies import as_on_spring

STAGES = 10


def radau() -> tuple[Any, Any]:
    """Return places and coefficients of Radau's method, from integrals of Lagrange's polynomials by Gauss's rule."""
    series = np.polynomial.legendre.Legendre.basis(STAGES - 1) - np.polynomial.legendre.Legendre.basis(STAGES)
    places = 0.5 * (np.sort(series.roots().real) + 1.0)
    places[-1] = 1.0
    nodes, weights = np.polynomial.legendre.leggauss(STAGES)
    nodes, coefficients = 0.5 * (nodes + 1.0), np.empty((STAGES, STAGES))
    for j, own in enumerate(places):
        others = np.delete(places, j)
        for i, end in enumerate(places):
            values = np.prod((end * nodes[:, None] - others) / (own - others), axis=1)
            coefficients[i, j] = 0.5 * end * weights @ values
    return places, coefficients


PLACES, COEFFICIENTS = radau()


def law_of(history: History, direction: int) -> Any:
    law = history.problem.friction
    return law.ways[1] if direction < 0 else law


def signs_of(history: History, direction: int) -> Any:
    signs = np.ones(len(history.problem.friction.states))
    if direction < 0:
        signs[list(history.problem.friction.reverses)] = -1.0
    return signs


def pace(history: History, piece: int, place: float) -> Any:
    """Return dy/dt, that of the slip rate from the balance of forces."""
    direction, problem = int(history.store.mode[piece]), history.problem
    body, law, signs = as_on_spring(problem.body), law_of(history, direction), signs_of(history, direction)
    load, rate, *states = values_at(history, Positions.inside(piece, place))[:, 0]
    seen = signs * states
    grows = 0.0
    if direction:
        mu = float(law.coefficient(0.0, abs(rate), one_argument(tuple(seen))))
        grows = (load - body.total_damping * rate - direction * problem.normal * mu) / body.inertia
    changes = [float(value_and_slopes(tree, law.numbers(), 0.0, abs(rate), *seen)[0]) for tree in law.state_trees()]
    return np.array([body.stiffness * (problem.first_pull_rate - rate), grows, *(signs * changes)])


def slopes(history: History, piece: int, places: Any) -> Any:
    """Return the derivatives of dy/dt by y at places in a piece."""
    direction, problem = int(history.store.mode[piece]), history.problem
    body, law, signs = as_on_spring(problem.body), law_of(history, direction), signs_of(history, direction)
    values = values_at(history, Positions.inside(piece, places))
    rates, seen = np.abs(values[1]), [sign * state for sign, state in zip(signs, values[2:], strict=True)]
    found = np.zeros((len(places), len(values), len(values)))
    if direction:
        mu = law.slopes(0.0, rates, one_argument(seen))
        found[:, 0, 1], found[:, 1, 0] = -body.stiffness, 1.0 / body.inertia
        found[:, 1, 1] = -(body.total_damping + problem.normal * mu[1]) / body.inertia
        for n, sign in enumerate(signs):
            found[:, 1, 2 + n] = -direction * sign * problem.normal * mu[2 + n] / body.inertia
    for n, tree in enumerate(law.state_trees()):
        by = value_and_slopes(tree, law.numbers(), np.zeros(len(places)), rates, *seen)[1]
        found[:, 2 + n, 1] = signs[n] * direction * by[1]
        for other, sign in enumerate(signs):
            found[:, 2 + n, 2 + other] = signs[n] * sign * by[2 + other]
    return found


def on_part(history: History, piece: int, begin: float, length: float) -> Any:
    """Return the matrix of a part of a piece."""
    store, places = history.store, begin + length * PLACES
    paces = length * (store.speed[piece] + 2.0 * store.bend[piece] * places)
    by_place = paces[:, None, None] * slopes(history, piece, places)
    size = by_place.shape[1]
    crossed = np.einsum("iab,ij->iajb", by_place, COEFFICIENTS).reshape(STAGES * size, STAGES * size)
    stages = np.linalg.solve(np.eye(STAGES * size) - crossed, by_place.reshape(STAGES * size, size))
    return np.eye(size) + np.einsum("i,iab->ab", COEFFICIENTS[-1], stages.reshape(STAGES, size, size))


def at_event(history: History, piece: int) -> Any:
    """Return the factor of disturbances between a piece and the one before it."""
    before, after = (int(history.store.mode[n]) for n in (piece - 1, piece))
    law, size = history.problem.friction, 2 + len(history.problem.friction.states)
    rates = [abs(float(history.rate(Positions.inside(n, 0.5))[0])) for n in (piece - 1, piece)]
    knot = law.knot_variable == "rate" and int(law.piece_at(0.0, rates[0])) != int(law.piece_at(0.0, rates[1]))
    if (before == after and not knot) or (before == -after and not law.sticks):
        return np.eye(size)
    low, high, normal = pace(history, piece - 1, 1.0), pace(history, piece, 0.0), np.eye(size)[1]
    if before == 0:
        states = signs_of(history, after) * values_at(history, Positions.inside(piece - 1, 1.0))[2:, 0]
        by = law_of(history, after).slopes(0.0, 0.0, one_argument(tuple(states)))[2:]
        normal = np.array([1.0, 0.0, *(-after * signs_of(history, after) * history.problem.normal * by)])
    return np.eye(size) + np.outer(high - low, normal) / (normal @ low)


def grown(history: History, last: int, place: float, parts: int = 4) -> Any:
    """Return by what matrix a disturbance at the start of a run is multiplied up to a place in a piece."""
    found = np.eye(2 + len(history.problem.friction.states))
    for piece in range(last + 1):
        found = at_event(history, piece) @ found if piece else found
        length = (place if piece == last else 1.0) / parts
        for part in range(parts):
            found = on_part(history, piece, part * length, length) @ found
    return found
