"""A run under a law with states that ends as soon as it has settled to a cycle."""

from __future__ import annotations

from stickslip.extensions.cycles.limit_cycle import is_stable
from stickslip.extensions.cycles.orbit import Orbit, closed_if_settled, places_of
from stickslip.extensions.cycles.section import Section, passages
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.run import TextProgress, uninterrupted
from stickslip.run.simulate import simulate
from stickslip.run.study import MAX_PIECES

FIRST_NEAR = 4.0
"""The first run lasts so many times what a cycle may take (1)."""
PARTS = 4
"""Largest number of parts (1) of a run that is to settle; each lasts twice as long as the one before it."""


def time_of_cycle(problem: Problem) -> float:
    """Return about how long (s) a cycle may take: a free oscillation, and the time to load the contact."""
    falls = problem.normal * problem.friction.variation
    return problem.body.round_trip_time + 2.0 * falls / (problem.body.stiffness * problem.first_pull_rate)


def settled(problem: Problem, wait: float, rtol: float, tell: TextProgress) -> Orbit | None:
    """Return the stable cycle to which a run under a law with states settles, as soon as it has; None if it takes long.

    The run is made in parts, each from the last passage of the one before it, until two passages in it are close to each other, and
    Newton's iteration leads from there to a stable cycle next to the run. `wait` is the time (s) before the motion begins.
    """
    if not problem.friction.states:
        return None
    section, start, lasts = Section(problem, at_onset=False, rtol=rtol), problem, FIRST_NEAR * time_of_cycle(problem)
    for _ in range(PARTS):
        run = uninterrupted(simulate(start, wait + lasts, rtol, max_pieces=MAX_PIECES))
        if not run.status.ok:
            return None
        tell(f"run of {brief(wait + lasts, 's')}")
        met, lasts = passages(run.history), 2.0 * lasts
        found = closed_if_settled(section, run.history, met) if len(met.time) > 2 else None
        if found is not None and is_stable(found.multipliers):
            return found
        if len(met.time):
            start, wait = section.start_at(places_of(run.history, met)[:, -1]), 0.0
    return None
