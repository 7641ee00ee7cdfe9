"""The numbers of each node of a planar contact, each checked as those of a problem are."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.quantities import Quantity, in_units, quantities_of
from stickslip.friction import FrictionLaw
from stickslip.friction.contract import one_argument
from stickslip.problem.problem import LOAD, Problem

Floats = NDArray[np.float64]
START = {"initial.load": "initial_load", "initial.excess": "initial_excess", "initial.state": "initial_state"}
"""Names of numbers of the start that may vary beside those in `problem.parameters`, and the fields of `Problem` that hold them."""
MAY_VARY = ("friction.", "body.normal_stress", "initial.")
"""Beginnings of the names of what may vary along the contact."""


@dataclass(frozen=True)
class NodeValues:
    """The numbers of each node. Arrays have the shape of the contact, after the axes that are mentioned."""

    problems: tuple[Problem, ...]
    """The different problems of the nodes."""
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
            Slip (m) from the start up to which strength is looked at: at 1000 places, half of them close to the start.
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
            law, slip, tiny = problem.friction, problem.law_slip, 1e-100
            rate, states, numbers = (
                abs(problem.strength + problem.excess) / impedance,
                problem.states,
                SimpleNamespace(**law.numbers(0)),
            )
            evolutions = law.state_rate if isinstance(law.state_rate, tuple) else (law.state_rate,)
            along_slip = [
                w + 1j * tiny * evolve(numbers, slip, rate, *states) / rate for w, evolve in zip(states, evolutions, strict=True)
            ]
            found = law.piece_coefficient(0, np.complex128(slip), np.complex128(rate), one_argument(along_slip))
            fall = max(fall, -problem.normal * float(np.imag(found)) / tiny)
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
    if not along:
        problems, which = [problem], np.zeros(int(np.prod(shape)), int)
    else:
        rows, which = np.unique(np.stack([values.ravel() for values in along.values()], axis=1), axis=0, return_inverse=True)
        problems = [_with(problem, dict(zip(names.values(), row.tolist(), strict=True))) for row in rows]
    laws = [one.friction for one in problems]
    if any(law.trees() != laws[0].trees() for law in laws):
        raise InputError(f"PlanarSlab: {', '.join(names)}: the formula of friction would differ from node to node")

    def spread(values: Any) -> Floats:
        """Return an array whose last axis, over the problems, is replaced by the axes of the contact."""
        found = np.asarray(values, float)[..., np.ravel(which)]
        return found.reshape(*found.shape[:-1], *shape)

    numbers = [[law.numbers(i) for law in laws] for i in range(len(laws[0].pieces))]
    return NodeValues(
        problems=tuple(problems),
        normal=spread([one.normal for one in problems]),
        load=spread([one.strength + one.excess for one in problems]),
        excess=spread([one.excess for one in problems]),
        slip=spread([one.initial_slip for one in problems]),
        law_slip=spread([one.law_slip for one in problems]),
        states=spread(np.reshape([one.states for one in problems], (len(problems), -1)).T),
        static_excess=spread([law.static_excess for law in laws]),
        knots=spread(np.reshape([law.knots for law in laws], (len(laws), -1)).T),
        numbers=tuple({name: spread([row[name] for row in rows]) for name in laws[0].parameters()} for rows in numbers),
    )


def varying(problem: Problem) -> dict[str, tuple[Quantity, float]]:
    """Return the numbers of a problem that may vary along a contact, by name: what is declared of each, and its value (SI)."""
    found = {one.name: (one.declared, one.value) for one in problem.parameters.values() if one.name.startswith(MAY_VARY)}
    for name, value in (("initial.load", problem.load), ("initial.excess", problem.excess)):
        found[name] = in_units(quantities_of(Problem)[START[name]], {LOAD: problem.load_unit}), value
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


def _with(problem: Problem, values: Mapping[str, float]) -> Problem:
    """Return the problem with other values of some of its numbers."""
    for name, value in values.items():
        if name in START:
            others: dict[str, Any] = {"initial_load": None, "initial_excess": None} if START[name] != "initial_state" else {}
            problem = replace(problem, **(others | {START[name]: value}))
        else:
            problem = problem.parameters[name].put(value)
    return problem
