"""The cycle of a body with waves near the end of a run: where it is cut, and after how many meetings with the cut it closes."""

from __future__ import annotations

import numpy as np

from stickslip.engine import History
from stickslip.extensions.cycles.section import onsets
from stickslip.extensions.cycles.waves.mesh import mesh_of
from stickslip.extensions.cycles.waves.orbit import WaveOrbit, closed
from stickslip.extensions.cycles.waves.section import WaveSection, place_in
from stickslip.extensions.cycles.waves.sources import source_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem

MOST_MEETINGS, CLOSES = 16, 3e-2
"""A run is compared with itself so many meetings with the section ago (1); it closes where it comes as close (1) as this."""
TOO_FAR = 0.3
"""No cycle is near a run that comes no closer to itself than this (1)."""

ONCE = 1e-6
"""A cycle is back where it began if its wave misses that by no more than this share (1) of its extent."""


def near_end(history: History, problem: Problem, rtol: float) -> WaveOrbit:
    """Return the cycle near the end of a run. Raises InputError if there is none."""
    section = WaveSection(problem, len(onsets(history).time) > 2, rtol, _mean_rate(history) / problem.first_pull_rate)
    met = section.met(history)
    if len(met.time) < 2 or met.time[-1] < 2.0 * problem.round_trip_time:
        raise InputError(
            "cycle: the run does not come back: it neither begins to slip twice after a rest, nor passes its mean slip rate twice:"
            " give a longer run (near), or another start"
        )
    every = _meetings(history, met.time)
    end, period = float(met.time[-1]), float(met.time[-1] - met.time[-1 - every])
    source = source_of(history, end)
    mesh = mesh_of(source, source.kinks(period))
    found = closed(section, place_in(history, met, len(met.time) - 1, mesh), period)
    once = _first_time_round(found)
    return found if once is None else closed(section, found.closed.start, once)


def _first_time_round(orbit: WaveOrbit) -> float | None:
    """Return the period (s) of a cycle that has been found as several of its periods; None if it is found as one."""
    run, mesh = orbit.closed, orbit.closed.start.mesh
    for time in orbit.section.met(run.history).time.tolist():
        there = source_of(run.history, time).at(mesh.phases) if time < run.end - ONCE * orbit.period else np.full(1, np.inf)
        if np.abs(there - run.start.wave).max() <= ONCE * run.start.scale[-1]:
            return float(time - run.begin)
    return None


def _mean_rate(history: History) -> float:
    """Return the mean slip rate (m/s) in the last half of a run."""
    begin, end = history.find(np.array([0.5, 1.0]) * history.duration, "left"), history.duration
    slips = history.slipped(begin)
    return float((slips[1] - slips[0]) / (0.5 * end))


def _meetings(history: History, times: Floats) -> int:
    """Return after how many meetings with the section the run comes back best, by its wave. Raises InputError if it never does."""
    phases = np.linspace(0.0, history.round_trip_time, 129, endpoint=False)
    last = source_of(history, float(times[-1])).at(phases)
    most = min(MOST_MEETINGS, int(np.sum(times > 1.001 * history.round_trip_time)) - 1)
    missed = [np.abs(source_of(history, float(times[-1 - n])).at(phases) - last).max() for n in range(1, most + 1)]
    shares = np.array(missed) / np.ptp(last)
    if shares.min() > TOO_FAR:
        raise InputError(
            f"cycle: the run does not come back: its wave is {100.0 * shares.min():.2g} % off at best: it has not settled, or never"
            " repeats itself: give a longer run (near), or ask lyapunov whether disturbances grow"
        )
    close = np.flatnonzero(shares <= CLOSES)
    return 1 + int(close[0] if len(close) else np.argmin(shares))
