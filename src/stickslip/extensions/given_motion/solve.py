"""Solve for the states of a law along a given motion, in compiled code, and keep every step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stickslip.engine import compile_formula
from stickslip.extensions.given_motion.compiled import along_motion as at
from stickslip.extensions.given_motion.compiled.nodes import PLACES_IN_STEP
from stickslip.extensions.given_motion.intervals import MotionInIntervals
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.uncompiled import lend_memory
from stickslip.friction.law import FrictionLaw

AT_ONCE = 2_000
"""Steps between two reports of progress."""
MOST_STEPS = 20_000_000
"""Largest number of steps of a run."""
LEAST_TOLERANCE = 1e-14
"""Smallest tolerance (1) of a step: below it all is rounding."""


@dataclass(frozen=True, eq=False)
class StepsOfStates:
    """The states, in the form that formulas use, in all steps: the polynomial through the values at Radau's points."""

    interval: Floats
    """The interval of each step, as a whole number."""
    since: Floats
    """The start (s) of each step since the start of its interval."""
    length: Floats
    values: Floats
    """(steps, states, points): the states at the points."""
    errors: Floats
    """(steps, states): bounds of the errors of the states at the ends of steps."""


def solve_states(
    law: FrictionLaw,
    motion: MotionInIntervals,
    start: tuple[float, ...],
    tolerance: float,
    report: Callable[[float], object] | None = None,
) -> StepsOfStates:
    """Follow the states of a law, given in the form of the formulas, along a motion; `report` is told the time (s) now and then.

    Raises InputError where the states cannot be followed.
    """
    tree, many = law.trees()[0], len(law.states)
    formula = compile_formula(tree, law.parameters(), law.state_trees())
    constants = np.zeros(formula.size)
    formula.fill(np.array(law.piece_values(0), float), 0.0, constants)
    lend_memory(constants)
    reverses = np.array([float(one.reverses) for one in law.states])
    scales = np.array([one.scale for one in law.states])
    compiled = at.LawWithStates(
        formula.address("state_value"),
        constants.ctypes.data,
        many,
        law.normal_coupling,
        reverses,
        scales,
        max(tolerance, LEAST_TOLERANCE),
    )
    now = np.zeros(at.LEVELS + 3 * at.MOST_STATES_HERE)
    now[at.LEVELS : at.LEVELS + many] = start
    now[at.LEVELS + 2 * at.MOST_STATES_HERE :][:many] = np.abs(start)
    table = motion.table()
    now[at.TRIED] = float(table[0, at.LASTING])
    found: list[tuple[Floats, Floats, Floats]] = []
    while now[at.AT_INTERVAL] < len(table):
        kept = at.KeptSteps(np.zeros((AT_ONCE, 3)), np.zeros((AT_ONCE, many * PLACES_IN_STEP)), np.zeros((AT_ONCE, many)))
        count = at.follow_states(table, compiled, now, kept, AT_ONCE)
        if count < 0 or len(found) * AT_ONCE > MOST_STEPS:
            place = int(now[at.AT_INTERVAL])
            time = float(motion.start[place] + now[at.SINCE])
            why = "no step is short enough" if count < 0 else f"{MOST_STEPS} steps are not enough"
            raise InputError(f"simulate: the state of {type(law).__name__} cannot be followed beyond {time:.9g} s: {why}")
        found.append((kept.steps[:count], kept.states[:count], kept.errors[:count]))
        if report is not None and now[at.AT_INTERVAL] < len(table):
            report(float(motion.start[int(now[at.AT_INTERVAL])] + now[at.SINCE]))
    steps, states, errors = (np.concatenate(parts) for parts in zip(*found, strict=True))
    del formula  # its machine code is needed up to here
    return StepsOfStates(
        steps[:, 0].astype(np.int64), steps[:, 1], steps[:, 2], states.reshape(-1, many, PLACES_IN_STEP), _finite(errors)
    )


def _finite(errors: Floats) -> Floats:
    """Return bounds of errors; one that is no number bounds nothing."""
    return np.where(np.isnan(errors), math.inf, errors)
