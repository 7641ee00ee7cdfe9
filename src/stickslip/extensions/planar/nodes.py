"""The numbers of each node of a planar contact, each checked as those of a problem are."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.other_values import unchecked, with_values
from stickslip.foundation.quantities import Quantity, in_units, quantities_of
from stickslip.friction import FrictionLaw
from stickslip.friction.contract import one_argument
from stickslip.friction.formula import evaluate
from stickslip.problem import LOAD, Problem, put_many

NODES_ALL_CHECKED = 256
"""Up to this many different nodes are all checked as problems of their own; of more, the extremes and some others are."""
MAY_VARY = ("friction.", "body.normal_stress", "initial.")
"""Beginnings of the names of what may vary along the contact."""


@dataclass(frozen=True)
class NodeValues:
    """The numbers of each node. Arrays have the shape of the contact, after the axes that are mentioned."""

    problems: tuple[Problem, ...]
    """Different problems of the nodes; of more than NODES_ALL_CHECKED, those with extremes of a number, and some others."""
    normal: Floats
    """Normal stress, Pa."""
    load: Floats
    """Load at t = 0, Pa."""
    excess: Floats
    """Load minus static strength at t = 0, Pa."""
    slip: Floats
    """Slip at t = 0, m."""
    law_slip: Floats
    """Slip at t = 0 as the law counts it, m."""
    states: Floats
    """States at t = 0 in the form that the formulas use; one more axis in front, for the states."""
    static_excess: Floats
    """Static friction minus the formula at v = 0+."""
    knots: Floats
    """Places where one piece of the law ends and the next begins, m or m/s; one more axis in front, for the knots."""
    numbers: tuple[dict[str, Floats], ...]
    """The parameters of the formulas by name, for each piece of the law."""

    def slopes(self, reach: float) -> tuple[float, float]:
        """Return the steepest fall and the steepest rise of strength with slip (Pa/m), at any node.

        They are 0 for friction that depends on a state, or not on slip.

        Parameters
        ----------
        reach
            Range of slip (m) from the start for evaluating strength: at 1000 places, half of them close to the start.
        """
        fall = rise = 0.0
        for problem in self.problems:
            law = problem.friction
            if law.states or not law.depends_on_slip:
                continue
            slip = problem.law_slip + np.union1d(np.linspace(0.0, reach, 500), np.geomspace(1e-6 * reach, reach, 500))
            slopes = problem.normal * np.diff(law.coefficient(slip)) / np.diff(slip)
            fall, rise = max(fall, -float(slopes.min())), max(rise, float(slopes.max()))
        return fall, rise

    def steepest_fall(self, reach: float, impedance: float) -> float:
        """Return the steepest fall of strength with slip (Pa/m), at any node: see `slopes`.

        Under a law with states it is the fall with the change of the states, in their initial values, at the slip rate (m/s) that
        radiation alone would allow: the load over an impedance (Pa s/m).
        """
        fall = self.slopes(reach)[0]
        for problem in (one for one in self.problems if one.friction.states):
            law, slip, states = problem.friction, problem.law_slip, problem.states
            rate = abs(problem.strength + problem.excess) / impedance
            evolved = [evaluate(tree, law.numbers(0), slip, rate, *states) for tree in law.state_trees()]
            by_state = law.slopes(slip, rate, one_argument(states))[2:]
            fall = max(fall, -problem.normal * float(by_state @ evolved) / rate)
        return fall

    def is_unique(self, impedance: float, slip: float, rate: float) -> bool:
        """Return False if Z v + S mu(u, v) falls with the slip rate at any node, within some slip (m) from the start.

        It is evaluated at 60 slips and 200 slip rates up to 4 times `rate` (m/s), under laws of slip and slip rate only. A contact
        that has not slipped is unique.
        """
        if rate == 0.0:
            return True
        rates = np.union1d(np.linspace(0.0, 4.0 * rate, 100), np.geomspace(1e-9 * rate, 4.0 * rate, 100))
        for problem in self.problems:
            law = problem.friction
            if law.states or not (law.depends_on_slip and law.depends_on_rate):
                continue
            slips = problem.law_slip + np.linspace(0.0, slip, 60)[:, None]
            if (np.diff(impedance * rates + problem.normal * law.coefficient(slips, rates), axis=1) < 0.0).any():
                return False
        return True

    @property
    def law(self) -> FrictionLaw:
        """The law of one of the nodes; all nodes have the same formulas."""
        return self.problems[0].friction


def node_values(problem: Problem, along: Mapping[str, Floats], shape: tuple[int, ...]) -> NodeValues:
    """Return the numbers of the nodes of a contact: those of its problem, and values (SI) that vary `along` it, by name.

    Raises InputError if a name is unknown, or a node would have a number that its problem does not allow.
    """
    names = full_names(problem, along, "PlanarSlab: along")
    columns = np.stack([values.ravel() for values in along.values()], axis=1) if along else np.zeros((1, 0))
    rows, which = np.unique(columns, axis=0, return_inverse=True) if along else (columns, np.zeros(int(np.prod(shape)), int))
    different = {full: rows[:, i] for i, full in enumerate(names.values())}

    def at(places: Any) -> list[Problem]:
        values = (rows[place].tolist() for place in places)
        return [put_many(problem, dict(zip(different, row, strict=True))) for row in values]

    if len(rows) <= NODES_ALL_CHECKED:
        problems = at(range(len(rows)))
        found = _of_problems(problems)
    else:
        for full, values in different.items():
            for place in np.flatnonzero(~varying(problem)[full][0].allows(values))[:1]:
                at([place])  # says what is wrong
        problems, found = at(_extremes(rows)), _of_many(problem, different)
    if any(one.friction.trees() != problem.friction.trees() for one in problems):
        raise InputError(f"PlanarSlab: {', '.join(names)}: the formula of friction would differ from node to node")

    def spread(values: Any) -> Floats:
        """Return an array whose last axis, over different nodes, is replaced by the axes of the contact."""
        placed = np.asarray(values, float)[..., np.ravel(which)]
        return placed.reshape(*placed.shape[:-1], *shape)

    numbers = tuple({name: spread(values) for name, values in piece.items()} for piece in found.pop("numbers"))
    return NodeValues(problems=tuple(problems), numbers=numbers, **{name: spread(values) for name, values in found.items()})


def _of_problems(problems: list[Problem]) -> dict[str, Any]:
    """Return the fields of `NodeValues` but `problems`, with one entry for each problem along the last axis of all arrays."""
    laws = [one.friction for one in problems]
    return {
        "normal": [one.normal for one in problems],
        "load": [one.strength + one.excess for one in problems],
        "excess": [one.excess for one in problems],
        "slip": [one.initial_slip for one in problems],
        "law_slip": [one.law_slip for one in problems],
        "states": np.reshape([one.states for one in problems], (len(problems), -1)).T,
    } | _of_laws(laws)


def _of_laws(laws: list[FrictionLaw]) -> dict[str, Any]:
    numbers = [[law.numbers(i) for law in laws] for i in range(len(laws[0].pieces))]
    return {
        "static_excess": [law.static_excess for law in laws],
        "knots": np.reshape([law.knots for law in laws], (len(laws), -1)).T,
        "numbers": [{name: [row[name] for row in rows] for name in laws[0].parameters()} for rows in numbers],
    }


# ---- more different nodes than can each be a problem of their own -----------------------------------------------------------


def _extremes(rows: Floats) -> list[int]:
    """Return at most NODES_ALL_CHECKED rows: extremes of each column, of differences, products and ratios of two, and others."""
    columns = list(rows.T)
    with np.errstate(all="ignore"):
        both = [found for one, other in combinations(columns, 2) for found in (one * other, one / other, one - other)]
    ends = {int(end(one)) for one in (*columns, *map(np.nan_to_num, both)) for end in (np.argmin, np.argmax)}
    return sorted({*ends, *np.linspace(0, len(rows) - 1, max(2, NODES_ALL_CHECKED - len(ends)), dtype=int).tolist()})


def _of_many(problem: Problem, rows: Mapping[str, Floats]) -> dict[str, Any]:
    """Return what `_of_problems` returns of the problems with these values, each of which is allowed, from arrays."""
    count, law = len(next(iter(rows.values()))), problem.friction
    of_law = {name.removeprefix("friction."): values for name, values in rows.items() if name.startswith("friction.")}
    laws, which = [law], np.zeros(count, int)
    if of_law and law.many:
        found = _of_arrays(problem, of_law)
    else:
        if of_law:
            kinds, which = np.unique(np.stack(list(of_law.values()), axis=1), axis=0, return_inverse=True)
            laws = [with_values(law, dict(zip(of_law, kind, strict=True))) for kind in kinds.tolist()]
        found = {name: np.asarray(values)[..., which] for name, values in _of_laws(laws).items() if name != "numbers"}
        found["numbers"] = [{name: np.asarray(one)[which] for name, one in piece.items()} for piece in _of_laws(laws)["numbers"]]
    slip = rows.get("initial.slip", np.full(count, problem.initial_slip))
    law_slip = np.abs(slip) if law.counts == "path" else slip
    law_slip = np.zeros(count) if law.memory == "since-arrest" else law_slip
    normal = rows.get("body.normal_stress", np.full(count, problem.normal))
    strength = normal * (_at_rest(law, found, law_slip) + found["static_excess"])
    excess = rows.get("initial.excess")
    if excess is None and ("initial.load" in rows or problem.initial_excess is None):
        excess = _excess(rows.get("initial.load", problem.load), strength)
    excess = np.full(count, problem.initial_excess) if excess is None else excess
    states: Any = _states([replace(problem, friction=one) for one in laws], which, rows.get("initial.state")) if law.states else []
    start = {"normal": normal, "load": strength + excess, "excess": excess, "slip": slip, "law_slip": law_slip}
    return start | found | {"states": np.reshape(states, (len(law.states), count))}


def _of_arrays(problem: Problem, rows: Mapping[str, Floats]) -> dict[str, Any]:
    """Return what `_of_laws` returns of the laws with these values, for a law that takes arrays. Raises InputError."""
    law, count = problem.friction, len(next(iter(rows.values())))
    law = with_values(law, rows, unchecked)
    fine = np.broadcast_to((np.asarray(law.range()[0]) >= 0.0) & (np.asarray(law.static_excess) >= 0.0), count)
    for place in np.flatnonzero(~fine)[:1]:
        with_values(problem.friction, {name: float(values[place]) for name, values in rows.items()})  # says what is wrong
    numbers = {name: np.broadcast_to(getattr(law, name), count) for name in law.parameters()}
    knots = np.reshape([np.broadcast_to(one, count) for one in law.knots], (-1, count))
    return {"static_excess": np.broadcast_to(law.static_excess, count), "knots": knots, "numbers": [numbers] * len(law.pieces)}


def _at_rest(law: FrictionLaw, found: Mapping[str, Any], slip: Floats) -> Floats:
    """Return the formula of a law at v = 0+ and these slips (m), in the healed state, from numbers and knots of each node."""
    piece = np.sum(found["knots"] <= (slip if law.knot_variable == "slip" else 0.0), axis=0)
    values = np.empty(slip.shape)
    for i in np.unique(piece).tolist():
        at = piece == i
        numbers = SimpleNamespace(**{name: one[at] for name, one in found["numbers"][i].items()})
        values[at] = law.pieces[i](numbers, slip[at], np.zeros(int(at.sum())), *(np.zeros(int(at.sum())) for _ in law.states))
    return values


def _states(problems: list[Problem], which: NDArray[np.intp], first: Floats | None) -> Floats:
    """Return the states, as formulas use them, of nodes: problem `which` of some, with other values of the first state if given."""
    if first is None:
        return np.transpose([one.states for one in problems])[:, which]
    found = np.empty((len(problems[0].friction.states), len(which)))
    for problem, at in zip(problems, np.split(np.argsort(which, kind="stable"), np.cumsum(np.bincount(which))[:-1]), strict=True):
        values, back = np.unique(first[at], return_inverse=True)
        others = problem.given_states[1:]
        found[:, at] = np.transpose([problem.friction.inner_states((one, *others)) for one in values.tolist()])[:, back]
    return found


def _excess(load: Any, strength: Floats) -> Floats:
    """Return loads minus strengths (Pa), as `Problem.excess` does."""
    near = 4 * np.spacing(strength)
    backward = np.where(np.abs(load + strength) <= near, -strength - strength, load - strength)
    return np.where(np.abs(load - strength) <= near, 0.0, backward)


def varying(problem: Problem) -> dict[str, tuple[Quantity, float]]:
    """Return the numbers of a problem that may vary along a contact, by name: what is declared of each, and its value (SI)."""
    found = {one.name: (one.declared, one.value) for one in problem.parameters.values() if one.name.startswith(MAY_VARY)}
    for name, value in (("initial.load", problem.load), ("initial.excess", problem.excess)):
        found[name] = in_units(quantities_of(Problem)[name.replace(".", "_")], {LOAD: problem.load_unit}), value
    for state, value in zip(problem.friction.states[:1], problem.given_states, strict=False):
        found["initial.state"] = Quantity(state.unit, state.meaning), value
    return found


def full_names(problem: Problem, names: Iterable[str], who: str) -> dict[str, str]:
    """Return the full names of numbers that may vary, by the given names. Raises InputError, which begins with `who`."""
    allowed = varying(problem)
    found = {name: full_name(name, allowed, f"{who}: ", "is not a number that can vary along the contact") for name in names}
    given: dict[str, str] = {}
    for name, full in found.items():
        if given.setdefault(full, name) != name:
            raise InputError(f"{who}: {given[full]} and {name} are the same number")
    if {"initial.load", "initial.excess"} <= set(given):
        raise InputError(f"{who}: initial.load and initial.excess exclude each other")
    return found
