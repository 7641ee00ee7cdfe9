"""Say what is chosen of a start where its user has given nothing: one sentence for each choice.

What the contact does at t = 0+ is told by `stability.start_of`; here is what body, driver and states were before.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stickslip.foundation.show import brief
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import LoadingHistory, Problem
from stickslip.run.check.asked import CHECK_KINDS
from stickslip.run.check.ground import chosen_of_ground

GIVEN_BEFORE = ("pull_rate", "far_stress", "normal_load")
"""Fields of a problem that have, before the start, the value that they have then."""


def chosen_starts(problem: Problem) -> list[str]:
    """Return a sentence for each thing that is chosen at the start of a problem, without a capital and without a full stop."""
    inside = CHECK_KINDS[problem.body.structure].chosen(problem)
    return [*_load(problem), *_states(problem), *inside, *_before(problem)]


def _load(problem: Problem) -> Iterator[str]:
    if problem.initial_load is None and problem.initial_excess is None:
        what = "the load and the states are those" if problem.friction.states else "the load is that"
        yield f"{what} of steady sliding: {brief(problem.load, problem.load_unit)}"


def _states(problem: Problem) -> Iterator[str]:
    law = problem.friction
    if law.sticks and law.states and not (problem.has_initial_rate and problem.starts_steadily):
        healed = np.ravel(law.healed_state).tolist()
        for name, state, given, zero in zip(STATE_NAMES, law.states, problem.given_states, healed, strict=False):
            if given == zero:
                yield f"the {name.replace('_', ' ')} of friction is {brief(given, state.unit)}, that of a contact that has healed"
    if law.depends_on_slip and law.memory == "since-arrest" and problem.initial_slip != 0.0:
        yield "the start counts as an arrest, since which friction remembers no slip"


def _before(problem: Problem) -> Iterator[str]:
    """Yield what was before the start where something varies in time."""
    varying = [name.replace("_", " ") for name in GIVEN_BEFORE if isinstance(getattr(problem, name), LoadingHistory)]
    if varying:
        has = "have their values" if len(varying) > 1 else "has its value"
        yield f"before the start the {' and the '.join(varying)} {has} of 0 s"
    if problem.force is not None:
        yield "before the start no force acts: the initial load is that without it"
    yield from chosen_of_ground(problem)
