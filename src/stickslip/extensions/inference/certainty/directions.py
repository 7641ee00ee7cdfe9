"""Find moves of the free numbers that leave the fitted curve unchanged, and the combinations that are determined all the same."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.fit.model import Model
from stickslip.foundation.arrays import Floats

FAINT = 0.02
"""A direction with less than this share of the largest effect is tried in runs, to see whether it has any effect."""
MOVED, SHORTEST = 0.02, 1e-4
"""Longest and shortest move along a direction, in searched numbers, to look for an effect."""
IDLE = 0.1
"""A number has no influence if a factor e on it changes all residuals together by less than this many standard deviations."""
CORRECTIONS = 10
"""Largest number of steps back to the former residuals: a direction without effect may bend."""
SURE_BELOW, LEAST_SHARE = 1e-9, 30.0
"""Least effect (as a share of the largest) of the directions used for such steps; multiple of the runs' noise that is no effect."""
TAKES_PART = 0.1
"""A number belongs to those that move together without effect if its own move has an effect above this (standard deviations)."""
SAME_PRODUCT = 0.02
"""A product of powers that changes by less than this share along a direction counts as constant."""
POWERS = (1, -1, 2, -2)
"""Powers to try for a product of two numbers, the simplest first."""
COUNTED = {2: "neither of the two", 3: "none of the three", 4: "none of the four", 5: "none of the five"}
BETTER = 3.0
"""A combination of two numbers is reported if it is known better than either by this factor."""


def null_directions(model: Model, x: Floats, slopes: Floats, columns: NDArray[np.intp]) -> Floats:
    """Return moves of some searched numbers that change nothing, shape (number of numbers, number of moves).

    The curvature only proposes a direction; the numbers are then moved along it, back to the same residuals, and compared.
    `slopes` are the derivatives with respect to the numbers in `columns`.
    """
    sizes = np.linalg.norm(slopes, axis=0)
    left, effect, right = np.linalg.svd(slopes / sizes, full_matrices=False)
    noise = LEAST_SHARE * model.noise
    found: list[Floats] = []
    for k in range(len(effect) - 1, -1, -1):
        if effect[k] > FAINT * effect[0]:
            break
        used = [j for j in range(k) if effect[j] > SURE_BELOW * effect[0]]
        back = (right[used].T / effect[used]) @ left[:, used].T / sizes[:, None]
        move = _moved(model, x, columns, right[k] / sizes, back)
        if move is not None and move[1] < IDLE * np.max(np.abs(move[0])) + noise:
            found.append(move[0])
    return np.array(found).T.reshape(len(columns), -1)


def _moved(model: Model, x: Floats, columns: NDArray[np.intp], direction: Floats, back: Floats) -> tuple[Floats, float] | None:
    """Return how far the numbers moved, and by how much that changed all residuals; None if the limits leave no room."""
    low, high = (end[columns] for end in model.limits)
    before, begin = model.residual(x), x[columns]
    way = MOVED
    while way >= SHORTEST:
        for side in (way, -way):
            y = begin + side * direction / np.max(np.abs(direction))
            for _ in range(CORRECTIONS):
                if np.any((y < low) | (y > high)):
                    break
                place = x.copy()
                place[columns] = y
                change = model.residual(place) - before
                size = float(np.linalg.norm(change))
                if size < 0.3 * IDLE * way:
                    return y - begin, size
                last, y = y, y - back @ change
            else:
                return last - begin, size
        way *= 0.1
    return None


def without(slopes: Floats, moves: Floats) -> Floats:
    """Return derivatives without the effect of some moves."""
    if not moves.size:
        return slopes
    sizes = np.linalg.norm(slopes, axis=0)
    basis = np.linalg.qr(moves * sizes[:, None])[0]
    return np.asarray((slopes / sizes) @ (np.eye(len(sizes)) - basis @ basis.T) * sizes)


def families(slopes: Floats, moves: Floats) -> list[tuple[list[int], list[int]]]:
    """Return sets of numbers that move together without effect, each with its moves, by their indices."""
    along = np.abs(moves) * np.linalg.norm(slopes, axis=0)[:, None]
    found: list[tuple[list[int], list[int]]] = []
    for k in range(moves.shape[1]):
        numbers, together = set(np.flatnonzero(along[:, k] > TAKES_PART).tolist()), [k]
        for other in [one for one in found if numbers & set(one[0])]:
            found.remove(other)
            numbers, together = numbers | set(other[0]), together + other[1]
        found.append((sorted(numbers), together))
    return found


def constants(moves: Floats) -> list[Floats]:
    """Return powers whose products stay constant along moves of the logarithms; [] if there are too few simple ones.

    `moves` has the shape (number of numbers, number of moves).
    """
    count = len(moves)
    wanted, chosen = count - moves.shape[1], list[Floats]()
    pairs = sorted(combinations(range(count), 2), key=lambda pair: pair[1] - pair[0])
    for (i, j), (p, q) in product(pairs, product(POWERS[::2], POWERS)):
        powers = np.zeros(count)
        powers[[i, j]] = p, q
        changed, size = np.abs(powers @ moves), np.abs(powers) @ np.abs(moves)
        if (
            len(chosen) < wanted
            and np.all(changed <= SAME_PRODUCT * size)
            and np.linalg.matrix_rank([*chosen, powers]) > len(chosen)
        ):
            chosen.append(powers)
    return chosen if len(chosen) == wanted else []


def formula(labels: Sequence[str], powers: Floats) -> str:
    """Return a product of powers as text, such as "body.thickness/body.wave_speed"; the last one is above the stroke."""
    powers = powers * np.sign(powers[np.flatnonzero(powers)[-1]])
    above = [(name, p) for name, p in zip(labels, powers.tolist(), strict=True) if p > 0.0]
    below = [(name, -p) for name, p in zip(labels, powers.tolist(), strict=True) if p < 0.0]
    texts = ["*".join(name if p == 1.0 else f"{name}^{p:g}" for name, p in part) for part in (above, below)]
    return "/".join(text for text in texts if text)


def told(labels: Sequence[str], moves: Floats, slopes: Floats, factor: float) -> Iterator[tuple[list[int], str]]:
    """Yield sets of numbers that move together, by their indices, and a sentence on what is determined ("" if that is not simple).

    The sentence holds if all numbers are logarithms. The numbers are in the order in which a body or a law declares them.
    """
    sizes = np.linalg.norm(slopes, axis=0)
    inverse = np.linalg.pinv(without(slopes, moves) / sizes, rcond=SURE_BELOW) / sizes[:, None] if moves.size else slopes.T
    for numbers, together in families(slopes, moves):
        kept = constants(moves[np.ix_(numbers, together)]) if len(numbers) > 1 else []
        names, known = [labels[i] for i in numbers], []
        for powers in kept:
            width = factor * float(np.linalg.norm(powers @ inverse[numbers]))
            known.append(f"{formula(names, powers)} (to {100.0 * width:.2g} %)")
        fix = "one of them" if len(together) == 1 else f"{len(together)} of them"
        none = COUNTED.get(len(names), "none of them")
        yield numbers, f"the record determines {' and '.join(known)}, but {none}: fix {fix}" if known else ""


def better_known(values: Floats, covariance: Floats, names: tuple[str, str], *, alike: bool) -> str:
    """Return a simple combination of two positive numbers that is known much better than either; "" if there is none.

    `covariance` is that of their logarithms. Numbers of the same unit (`alike`) are combined as sum and difference, others as
    product and ratio.
    """
    for sign in (1.0, -1.0):
        weights = np.array([1.0, sign]) * (values if alike else 1.0)
        width = math.sqrt(max(float(weights @ covariance @ weights), 0.0))
        if not width * BETTER < float(np.min(np.abs(weights) * np.sqrt(np.diag(covariance)))):
            continue
        if not alike:
            return f"{formula(names, np.array([1.0, sign]))} (± {100.0 * width:.2g} %) much better than either"
        total = f"{names[0]} {'+' if sign > 0.0 else '-'} {names[1]}"
        return f"{total} = {weights.sum():.4g} ± {width:.2g} much better than either"
    return ""
