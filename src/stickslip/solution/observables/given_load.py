"""What drivers and moving ground do at given times, from the fields of a problem alone.

The engine works on tables that `engine.input` makes of these fields. A comparison that read the tables would agree with whatever
stands in them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem import LoadingHistory, Problem, far_at_first
from stickslip.solution.observables.asked import observables_of

BESIDE_BREAK = 1e-10
"""Loads are compared this far (1) before and after a break of the loading, too, as a share of the round trip or of the time."""


def value_at(given: float | LoadingHistory, time: Floats, inside: Floats) -> Floats:
    """Return what may vary in time at times (s), by the straight parts that hold at the times `inside`; constant before 0 s."""
    if not isinstance(given, LoadingHistory):
        return np.full(np.shape(time), given)
    start, value, slope = given.parts
    n = np.maximum(np.searchsorted(start, inside, side="right") - 1, 0)
    amplitude, frequency, phase = given.tone
    since = np.maximum(time, 0.0)
    return np.asarray(value[n] + slope[n] * (since - start[n]) + amplitude * np.sin(frequency * since + phase))


def pulled(problem: Problem, time: Floats) -> Floats:
    """Return how far (m) the driver has been pulled since the start at times (s)."""
    if not isinstance(problem.pull_rate, LoadingHistory):
        return np.asarray(problem.pull_rate * time)
    start, value, slope = problem.pull_rate.parts
    amplitude, frequency, phase = problem.pull_rate.tone
    lasting = np.diff(start)
    whole = np.append(0.0, np.cumsum(lasting * (value[:-1] + 0.5 * slope[:-1] * lasting)))
    n = np.maximum(np.searchsorted(start, time, side="right") - 1, 0)
    since = time - start[n]
    swung = 2.0 * amplitude / frequency * np.sin(0.5 * frequency * time) * np.sin(0.5 * frequency * time + phase)
    return np.asarray(whole[n] + since * (value[n] + 0.5 * slope[n] * since) + swung)


def squared_pull(problem: Problem, time: Floats) -> Floats:
    """Return the integral (m^2/s) of the square of the pull rate from the start to times (s >= 0)."""
    if not isinstance(problem.pull_rate, LoadingHistory):
        return np.asarray(problem.pull_rate * problem.pull_rate * time)
    start, value, slope = problem.pull_rate.parts
    amplitude, frequency, phase = problem.pull_rate.tone

    def within(n: Any, since: Floats) -> Floats:
        """Return the integral over the first `since` (s) of segments, with cos and sin at the start and at the end of that."""
        line = value[n] + slope[n] * since
        straight = since * (value[n] * line + slope[n] * slope[n] * since * since / 3.0)
        begun = frequency * start[n] + phase
        ended = begun + frequency * since
        mixed = (
            value[n] * np.cos(begun) - line * np.cos(ended) + slope[n] * (np.sin(ended) - np.sin(begun)) / frequency
        ) / frequency
        swung = 0.5 * since - 0.25 * (np.sin(2.0 * ended) - np.sin(2.0 * begun)) / frequency
        return np.asarray(straight + amplitude * (2.0 * mixed + amplitude * swung))

    whole = np.append(0.0, np.cumsum(within(np.arange(len(start) - 1), np.diff(start))))
    n = np.maximum(np.searchsorted(start, time, side="right") - 1, 0)
    return np.asarray(whole[n] + within(n, time - start[n]))


def far_excess_at(problem: Problem, time: Floats, inside: Floats) -> Floats:
    """Return the stress far beyond the first driver minus the reference strength (Pa) at times (s); see `value_at`."""
    if problem.far_stress is None:
        first = np.full(np.shape(time), far_at_first(problem))
    else:
        first = value_at(problem.far_stress, time, inside) - problem.strength
    return np.asarray(first + problem.far_stress_rate * time)


def share_at(problem: Problem, inside: Floats) -> Floats:
    """Return the share (1) of a wave that the driver of a uniform body sends back at times (s)."""
    start, share = np.array(problem.driver_steps).T
    return np.asarray(share[np.maximum(np.searchsorted(start, inside, side="right") - 1, 0)])


def sent_at(problem: Problem, time: Floats, inside: Floats) -> Floats:
    """Return what the driver of a uniform body sends at times (s) beside the wave that it reflects (Pa), minus its reference.

    It is Z (1 - r) V + (1 + r) s, with the far stress s and the share r of the moment.
    """
    body, share = problem.body, share_at(problem, inside)
    pulls = body.impedance * (1.0 - share) * value_at(problem.pull_rate, time, inside)
    gives = share > -1.0
    return np.asarray(pulls + np.where(gives, (1.0 + share) * far_excess_at(problem, time, inside), 0.0) if gives.any() else pulls)


def of_ground(problem: Problem, time: Floats, inside: Floats) -> tuple[Floats, Floats]:
    """Return the velocity (m/s) and the acceleration (m/s^2) of the ground at times (s); zeros where it is at rest."""
    if problem.ground is None:
        return np.zeros(np.shape(time)), np.zeros(np.shape(time))
    return problem.ground.velocity_at(time, inside), problem.ground.acceleration_at(time, inside)


def breaks_at_contact(problem: Problem) -> Floats:
    """Return the times (s) when breaks of loading and ground, and changes of the driver, are felt at the contact."""
    given = [one for one in (problem.pull_rate, problem.far_stress) if isinstance(one, LoadingHistory)]
    starts = np.concatenate([*(one.parts[0] for one in given), np.array([start for start, _ in problem.driver_steps])])
    found = [starts + way for way in observables_of(problem).ways(problem)]
    if problem.force_in_time is not None:
        found.append(problem.force_in_time.parts[0])
    if problem.ground is not None:
        found += [problem.ground.start + late for late in (0.0, problem.body.round_trip_time)]
    times = np.unique(np.concatenate(found))
    return times[times > 0.0]


def beside(problem: Problem, times: Floats) -> Floats:
    """Return the times (s) just before and just after given ones: where a break in the wrong place shows."""
    away = BESIDE_BREAK * np.maximum(problem.round_trip_time, times)
    return np.concatenate([times - away, times + away])
