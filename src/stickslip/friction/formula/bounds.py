"""Bound a formula over intervals of slip and slip rate, and over discs of complex numbers.

Bounds need not be sharp. Those of `Enclosure` and `on_discs` include rounding; those of `bounds` are guaranteed but for it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.differences import slope_formula, tape_of_changes
from stickslip.friction.formula.expression import RATE, SLIP, STATES, Expression, nodes_of
from stickslip.friction.formula.on_boxes import OnBoxes, bound_boxes
from stickslip.friction.formula.on_cells import OnCells, enclose_cells
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.operations.enclosures import COUNT, ORDERS
from stickslip.friction.formula.operations.sets import EVERYTHING, Disc, Interval
from stickslip.friction.formula.tape import tape_of_bounds


def bounds(tree: Expression, numbers: Mapping[str, Any], slip: Interval, rate: Interval) -> Interval:
    """Return bounds of the formula while slip (m) and slip rate (m/s) stay in their intervals, at any state.

    The law's numbers and the ends of intervals may be arrays with one entry for each member of a batch. A number may also be an
    interval: the bounds then hold for all numbers in it.
    """
    names, free = _free(tree)
    tape = tape_of_changes((tree,), names)
    given = [_as_interval(numbers[name]) for name in names]
    variables = [_as_interval(one) if is_free else EVERYTHING for one, is_free in zip((slip, rate), free, strict=True)]
    shapes = {np.shape(end) for one in (*given, *variables) for end in one if not isinstance(end, float)}
    shape = np.broadcast_shapes(*shapes) if shapes else ()
    variables += [EVERYTHING] * len(STATES)
    boxes, found = math.prod(shape), np.empty((2, *shape))
    room = np.empty((tape.longest, 2))
    ends = _ends_of(given, shape, boxes), _ends_of(variables, shape, boxes)
    bound_boxes(OnBoxes(tape.steps, tape.values, *ends, room), found.reshape(2, boxes))
    return found[0], found[1]


@lru_cache(maxsize=256)
def _free(tree: Expression) -> tuple[tuple[str, ...], tuple[bool, bool]]:
    """Return the names of the parameters in a formula, and whether slip and slip rate are in it."""
    nodes = nodes_of(tree)
    return tuple(node.name for node in nodes if node.operation == "parameter"), (SLIP in nodes, RATE in nodes)


def _as_interval(given: Any) -> Interval:
    return given if isinstance(given, tuple) else (given, given)


def _ends_of(intervals: Sequence[Interval], shape: tuple[int, ...], boxes: int) -> Floats:
    """Return low and high ends of numbers, which broadcast to a shape, for all boxes: shape (2, boxes, numbers)."""
    if not shape:
        return np.array([[interval] for interval in zip(*intervals, strict=True)] if intervals else np.empty((2, 1, 0)), float)
    ends = np.empty((2, boxes, len(intervals)))
    for place, interval in enumerate(intervals):
        for column, end in zip(ends[:, :, place], interval, strict=True):
            column[:] = np.broadcast_to(end, shape).reshape(-1)
    return ends


def _number(node: Expression, numbers: Mapping[str, Any]) -> Any:
    return numbers[node.name] if node.operation == "parameter" else node.value


class Enclosure:
    """Bounds of formulas' Taylor coefficients by the slip rate, by interval arithmetic that includes rounding.

    `numbers` holds the law's numbers by name. They and the slip (m) are single ones, have one entry for each member, or are
    intervals of such. `formula` is the place of each member's formula in `trees`.
    """

    def __init__(self, trees: tuple[Expression, ...], numbers: Mapping[str, Any], slip: Any, formula: Any = 0) -> None:
        """Raise InputError for a formula with a state."""
        tape = tape_of_bounds(trees, tuple(numbers))
        given = (*numbers.values(), slip)
        sides = [end for one in given for end in (one if isinstance(one, tuple) else (one,))]
        members = max(getattr(one, "size", 1) for one in (formula, *sides))  # a number has one, and no size
        ends = np.empty((2, members, len(given)))
        for place, one in enumerate(given):
            ends[0, :, place], ends[1, :, place] = one if isinstance(one, tuple) else (one, one)
        spans, room = np.empty((members, 2), np.int64), np.empty((tape.longest + 1, COUNT + 1))
        spans[:], room[-1] = tape.spans[formula], -1.0
        self.formulas = OnCells(tape.steps, tape.values, spans, ends, room)

    def on(self, low: Floats, high: Floats, member: Any = 0) -> Floats:
        """Return the bounds on cells of slip rates, from `low` to `high` (m/s), each of one `member`; shape (2, 3, cells).

        They are low and high ends of mu, dmu/dv (s/m) and half of d2mu/dv2 (s2/m2).
        """
        found = np.empty((len(low), COUNT))
        alone = len(self.formulas.spans) == 1
        members = np.zeros(len(low), np.int64) if alone else np.ascontiguousarray(np.broadcast_to(member, low.shape), np.int64)
        enclose_cells(self.formulas, members, np.ascontiguousarray(low), np.ascontiguousarray(high), found)
        return found.T.reshape(2, ORDERS, -1)


def bends_one_way(tree: Expression, numbers: Mapping[str, Any], slip: Interval) -> bool:
    """Return True if a formula is proven to be convex, or concave, over all slip rates; slips (m) and numbers as in `bounds`."""
    low, high = bounds(slope_formula(slope_formula(tree, RATE), RATE), numbers, slip, (0.0, np.inf))
    return bool(np.all(low >= 0.0) or np.all(high <= 0.0))


def on_discs(tree: Expression, numbers: Mapping[str, ArrayLike], variables: Mapping[Expression, Disc]) -> Disc:
    """Return a formula on the discs of its variables, which broadcast; `numbers` holds the law's parameters by name.

    A disc of complex numbers lies around a real centre. The disc of a node contains every value that the node takes for arguments
    in their own discs, the rounding of this evaluation included. With tiny radii it is the formula at a point, with a bound on its
    rounding; with the radii of a step it bounds the formula around all of the step. If an operation has no analytic continuation on
    a disc, the radius is infinite or not a number. Source: Rump 2010, Acta Numerica 19.
    """
    found = dict(variables)
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.arguments:
                found[node] = operation_of(node).disc(*(found[argument] for argument in node.arguments))
            elif node not in found:
                found[node] = Disc.of(np.asarray(numbers[node.name] if node.operation == "parameter" else node.value, float))
    return found[tree]


def largest(values: Disc) -> Floats:
    """Return an upper bound of the magnitude on each disc; infinite where nothing is known."""
    return np.asarray(np.nan_to_num(values.most, nan=np.inf, posinf=np.inf))
