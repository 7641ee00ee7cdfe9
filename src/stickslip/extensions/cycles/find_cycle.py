"""Find the periodic motion near a run: `ss.studies.cycle`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from stickslip.extensions.cycles.asked import CYCLE_KINDS
from stickslip.extensions.cycles.found import FoundCycle
from stickslip.extensions.cycles.lag import is_wound, loading_rate
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.foundation.arguments import for_users
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.problem import INITIAL_STATES, TOO_MANY, Problem
from stickslip.problem.bodies import as_on_spring
from stickslip.problem.scenarios import Scenario, read_source
from stickslip.run import TextProgress, telling, uninterrupted
from stickslip.run.simulate import simulate

NEAR = Quantity("s", "duration of the run at whose end a cycle is looked for", above=0)
TOLERANCE_OF_RUNS = Quantity("1", "relative tolerance of the runs", at_least=1e-15, at_most=1e-6)
RTOL = 1e-12
"""Default tolerance of the runs (1)."""
FIRST_NEAR, LONGER, ATTEMPTS = 4.0, 8.0, 4
"""Without a duration: the first run lasts so many times what a cycle may take, the next longer by a factor, up to so many runs."""
INSTEAD = "a run and its events say how it moves, and find where that changes"
"""What can be done where no cycle is looked for."""


@for_users
def cycle(
    problem: Problem | Scenario | str | Path,
    near: float | str | WithUnit | None = None,
    *,
    rtol: float = RTOL,
    progress: TextProgress | bool | None = None,
) -> LimitCycle:
    """Find the periodic motion of a rigid body, slab or string near the end of a run, with its multipliers.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        A rigid body on a spring, or a slab or string whose waves fade, of layers or sections or behind a machine too, under a
        steady pull, or an axis in a position loop about a set point at rest (pull rate 0) or along a ramp; its scenario, the name
        of a bundled scenario, or a scenario file. Where it starts decides which cycle is found. If it starts in steady sliding, the
        run starts without load instead.
    near : float or str, optional
        Duration (s) of the run at whose end the cycle is looked for. By default it is long enough for some cycles, and is made
        longer up to three times if no cycle is found. To find an unstable cycle start near it, and give about two periods.
    rtol : float
        Tolerance of the runs, relative.
    progress : bool or callable, optional
        True shows the progress in one line; a function is called with a line of text after each run.

    Returns
    -------
    LimitCycle
        The cycle: its period, multipliers, greatest and least slip rate and traction, and a run of one period.

    Raises
    ------
    InputError
        If cycles of such a body are not found or what moves it varies, or if Newton's iteration finds no cycle.
    KeyboardInterrupt
        If the user presses Ctrl-C.

    Notes
    -----
    The motion is cut where slip begins after a rest, or, if the contact never rests, where the slip rate passes the pull rate
    upwards; about a set point at rest, a small rate. Newton's iteration moves the start of a run until it comes back to it. The
    multipliers are the eigenvalues of the derivative of this return, from the linear equation of disturbances along the run. A slab
    or string starts with the wave of a round trip as well, and with rate and push of a machine. Where the equation of disturbances
    does not know its driver or its law, the derivative is known by differences of runs.

    Examples
    --------
    >>> import stickslip as ss
    >>> block = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0)
    >>> found = ss.studies.cycle(ss.Problem(block, ss.friction.Coulomb(0.6, 0.4), pull_rate=0.1, initial_load=0.0))
    >>> print(f"{found.period:.6f} s, {found.slip:.6f} m, multiplier {found.multipliers[0]:.1f}")
    0.203025 s, 0.020302 m, multiplier 0.0
    """
    scenario = Scenario(problem, 1.0) if isinstance(problem, Problem) else read_source("cycle", problem)
    check_can_be_followed(scenario.problem, "cycle")
    TOLERANCE_OF_RUNS.check("cycle", "rtol", rtol)
    with telling(progress, "cycle") as tell:
        begin = without_load(scenario.problem)
        if near is not None:
            return LimitCycle(_searched(begin, (float(NEAR.check("cycle", "near", near)),), rtol, tell), scenario)
        wait = (scenario.problem.load - begin.load) / loading_rate(begin)
        lasts, kind = FIRST_NEAR * time_of_cycle(begin), CYCLE_KINDS[begin.body.structure]
        found = kind.settled(begin, (wait, lasts), rtol, tell)
        if found is None:
            first = lasts if isinstance(problem, Problem) else scenario.duration
            found = _searched(begin, _durations(first, lasts), rtol, tell)
        return LimitCycle(found, scenario)


def _durations(first: float, least: float) -> list[float]:
    """Return the durations (s) of runs at whose end a cycle is looked for, from the first one on."""
    found = [first]
    for _ in range(ATTEMPTS - 1):
        found.append(max(LONGER * found[-1], least))
    return found


def without_load(problem: Problem) -> Problem:
    """Return a problem that starts in steady sliding as one that starts without load: in a run only rounding would disturb it."""
    if not (problem.has_initial_rate and problem.starts_steadily):
        return problem
    states: dict[str, Any] = dict.fromkeys(INITIAL_STATES[: len(problem.friction.states)], "steady")
    return replace(problem, initial_rate=None, initial_load=0.0, **states)


def time_of_cycle(problem: Problem) -> float:
    """Return about how long (s) a cycle may take: a free oscillation, and the time to load the contact."""
    law = problem.friction
    falls = law.variation if law.states else min(law.variation, float(law.static_coefficient(0.0)))
    turn = as_on_spring(problem.body).period if is_wound(problem) else problem.body.round_trip_time
    return float(turn + 2.0 * problem.normal * falls / loading_rate(problem))


def _searched(problem: Problem, durations: Sequence[float], rtol: float, tell: TextProgress) -> FoundCycle:
    """Return the cycle near the end of a run, of the next duration (s) where none is found. Raises InputError."""
    kind = CYCLE_KINDS[problem.body.structure]
    for lasts in durations:
        run = uninterrupted(simulate(problem, lasts, rtol, max_pieces=kind.most_pieces))
        tell(f"run of {brief(lasts, 's')}")
        full = not run.status.ok
        if full and not (kind.may_be_cut and run.status.name == TOO_MANY):
            raise InputError(f"cycle: the run at whose end a cycle is looked for did not reach it: {run.status}")
        try:
            return kind.near_end(run.history, problem, rtol)
        except InputError:
            if lasts == durations[-1] or full:
                raise
    raise AssertionError("there is at least one duration")


def check_can_be_followed(problem: Problem, who: str) -> None:
    """Refuse a problem whose cycles are not looked for. Raises InputError, which begins with `who`."""
    kind, pull = CYCLE_KINDS[problem.body.structure], problem.first_pull_rate
    if why := kind.refusal(problem):
        raise InputError(f"{who}: {why}; {INSTEAD}")
    if not (pull > 0.0 or (kind.may_be_held and pull == 0.0)) or not math.isfinite(pull):
        least = "0 or above" if kind.may_be_held else "above 0"
        unit = problem.unit_of("pull_rate")
        cure = f"to pull backwards count slip the other way, and give {brief(-pull, unit)}" if pull < 0.0 else "a little is enough"
        raise InputError(f"{who}: pull_rate must be {least}, got {pull:g} {unit}: {cure}")
