"""Find at what rate small disturbances of a motion grow: `ss.studies.lyapunov`."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Protocol

import numpy as np

from stickslip.extensions.cycles.asked import CYCLE_KINDS
from stickslip.extensions.cycles.exponent import LOST_SHARE, LyapunovExponent, MeasuredGrowth
from stickslip.foundation.arguments import for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario, read_source
from stickslip.run import TextProgress, special_solver_of, telling, uninterrupted
from stickslip.run.simulate import simulate

RUN_DURATION = Quantity("s", "duration of the run along which disturbances are followed", above=0)
SKIPPED_TIME = Quantity("s", "time at the start of the run that does not count", at_least=0)
RUN_TOLERANCE = Quantity("1", "relative tolerance of the runs", at_least=1e-15, at_most=1e-6)
RTOL = 1e-10
"""Default tolerance of the runs (1)."""
SKIPPED_SHARE = 0.2
"""Share of the run (1) that does not count unless another is given."""


class PartedRuns(Protocol):
    """What a run of an extension tells of disturbed runs beside it: sizes of disturbances, when they part, and how they grow."""

    sizes: Floats
    horizons: Floats
    exponent: float
    exponent_error: float
    growth_per_event: float
    events: int


@for_users
def lyapunov(
    problem: Problem | Scenario | str | Path | Any,
    duration: float | str | WithUnit | None = None,
    *,
    skip: float | str | WithUnit | None = None,
    rtol: float = RTOL,
    progress: TextProgress | bool | None = None,
) -> LyapunovExponent:
    """Find at what rate small disturbances of a motion grow, with the error of this rate: the largest Lyapunov exponent.

    Parameters
    ----------
    problem : Problem, Scenario, str, Path or Chain
        Any problem whose friction does not change with all slip, a chain of blocks, or a scenario of one of them: its name, its
        file or itself.
    duration : float or str, optional
        Duration (s) of the run; by default that of the scenario.
    skip : float or str, optional
        Time (s) at its start that does not count, until the motion is the one that stays; a fifth of the duration by default.
    rtol : float
        Tolerance of the runs, relative.
    progress : bool or callable, optional
        True shows the progress in one line; a function is called with a line of text now and then.

    Returns
    -------
    LyapunovExponent
        The exponent (1/s), its standard error, the growth from one event to the next, and for how long events are predictable.

    Raises
    ------
    InputError
        If friction changes with all slip, if the contact comes to rest for ever, or if the run is too short.
    KeyboardInterrupt
        If the user presses Ctrl-C.

    Notes
    -----
    A shift in time is no disturbance here. Of a cycle the exponent is ln|multiplier| divided by the period. Disturbances of a rigid
    body are taken from one return to the pull rate to the next by the linear equation along the run. Those of a slab without masses
    are multiplied by each echo, at each phase of the round trip by itself. Of a chain, disturbed runs are compared, as
    `ChainRun.predictability` does it. Of all others two exact runs that differ by a millionth are compared after each round trip,
    and then made as close again (Benettin et al. 1980, Meccanica 15, 9). The error is that of a mean of increments that depend on
    each other.

    Examples
    --------
    >>> import stickslip as ss
    >>> slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
    >>> law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    >>> fast = ss.Problem(slab, law, pull_rate=0.1, initial_excess=1.0)
    >>> found = ss.studies.lyapunov(fast, "1 hour")
    >>> print(found.chaotic)
    True
    """
    RUN_TOLERANCE.check("lyapunov", "rtol", rtol)
    given = None if duration is None else RUN_DURATION.check("lyapunov", "duration", duration)
    with telling(progress, "lyapunov") as tell:
        source: Any = problem if special_solver_of(problem) else read_source("lyapunov", problem, given, any_kind=True)
        if special_solver_of(source) is not None:
            return LyapunovExponent(source, _of_parted_runs(source, given, skip))
        left_out = skipped_of(source.duration, skip)
        follow = CYCLE_KINDS[source.problem.body.structure].growth(source.problem, rtol)
        return LyapunovExponent(source.problem, follow(source.problem, left_out, source.duration, rtol, tell))


def skipped_of(duration: float, skip: float | str | WithUnit | None) -> float:
    """Return the time (s) at the start of a run that does not count. Raises InputError."""
    if skip is None:
        return SKIPPED_SHARE * duration
    found = float(SKIPPED_TIME.check("lyapunov", "skip", skip))
    if found >= duration:
        raise InputError(f"lyapunov: skip must be less than the duration {brief(duration, 's')}, got {brief(found, 's')}")
    return found


def _of_parted_runs(source: Any, duration: float | None, skip: object) -> MeasuredGrowth:
    """Return how disturbances grow in runs of an extension, from disturbed runs beside the run. Raises InputError."""
    solved = source.to_solve if isinstance(source, Scenario) else source
    if not hasattr(getattr(solved, "run_type", None), "predictability"):
        if isinstance(source, Scenario):
            read_source("lyapunov", source)  # which says what is for it
        raise InputError(f"lyapunov: how disturbances of a {type(solved).__name__} grow is not followed")
    if skip is not None:
        raise InputError("lyapunov: skip is for runs along which disturbances are followed; here runs from the start are compared")
    run: Any = uninterrupted(simulate(source, duration) if duration is not None else simulate(source))
    parted: PartedRuns = run.predictability()
    parts = np.isfinite(parted.horizons).all(axis=0)
    time, growth = parted.horizons[:, parts].mean(axis=0)[::-1], np.log(LOST_SHARE / parted.sizes[parts])[::-1]
    if np.isnan(parted.exponent):
        raise InputError("lyapunov: too few of the disturbed runs part from the run: give a longer duration")
    how = f"measured on {parted.horizons.size} disturbed runs (see ChainRun.predictability)"
    per_event = float(np.log(parted.growth_per_event))
    return MeasuredGrowth(
        time, growth, parted.exponent, parted.exponent_error, run.duration, how, parted.events, np.nan, parted.sizes[0], per_event
    )
