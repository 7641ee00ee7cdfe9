"""The cycle of a body with waves near the end of a run: where it is cut, and after how many meetings with the cut it closes."""

from __future__ import annotations

import numpy as np

from stickslip.contact import steady_slidings
from stickslip.engine import History
from stickslip.extensions.cycles.orbit import STEADY_SHARE
from stickslip.extensions.cycles.section import onsets
from stickslip.extensions.cycles.waves.mesh import mesh_of
from stickslip.extensions.cycles.waves.orbit import WaveOrbit, closed
from stickslip.extensions.cycles.waves.section import WaveSection, place_in
from stickslip.extensions.cycles.waves.sources import source_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem

MOST_MEETINGS, CLOSES = 16, 3e-2
"""A run is compared with itself so many meetings with the section ago (1); it closes where it comes as close (1) as this."""
TOO_FAR = 0.3
"""No cycle is near a run that comes no closer to itself than this (1)."""
NEARLY_STEADY, LAST_PART, LOOKED_AT = 0.2, 0.1, 200
"""A run that is no farther from stable steady sliding than a share (1) of its slip rate comes to it if it is nearer in its last
part (1, of its duration) than in the part before; so many times (1) in each tell it."""

ONCE = 1e-5
"""A cycle is back where it began if its wave misses that by no more than this share (1) of its extent."""


def near_end(history: History, problem: Problem, rtol: float) -> WaveOrbit:
    """Return the cycle near the end of a run. Raises InputError if there is none."""
    section = WaveSection(problem, len(onsets(history).time) > 2, rtol, _mean_rate(history) / problem.first_pull_rate)
    met = section.met(history)
    if len(met.time) < 2 or met.time[-1] < 2.0 * problem.round_trip_time:
        raise InputError(
            steady_text(history, problem)
            or "cycle: the run does not come back: it neither begins to slip twice after a rest, nor passes its mean slip rate"
            " twice: give a longer run (near), or another start"
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
    shares = np.array(missed) / np.maximum(np.ptp(last), np.finfo(float).tiny)
    if shares.min() > TOO_FAR or is_steady(_last_rates(history)[1], history.problem):
        off = f"is {100.0 * shares.min():.2g} % off at best" if shares.min() < 1.0 else "does not come near itself"
        raise InputError(
            steady_text(history, history.problem)
            or f"cycle: the run does not come back: its wave {off}: it has not settled, or never repeats itself: give a longer run"
            " (near), or ask lyapunov whether disturbances grow"
        )
    close = np.flatnonzero(shares <= CLOSES)
    return 1 + int(close[0] if len(close) else np.argmin(shares))


def _last_rates(history: History) -> Floats:
    """Return slip rates (m/s) in the last part of a run, and in the part before it, which comes first."""
    end, lasts = history.duration, max(LAST_PART * history.duration, history.round_trip_time)
    times = np.maximum(end - np.linspace(2.0 * lasts, 0.0, 2 * LOOKED_AT), 0.0)
    return history.rate(history.find(times, "left")).reshape(2, LOOKED_AT)


def is_steady(rates: Floats, problem: Problem) -> bool:
    """Return True if slip rates (m/s) are those of steady sliding."""
    return bool(rates.min() > 0.0 and np.ptp(rates) <= STEADY_SHARE * problem.first_pull_rate)


def steady_text(history: History, problem: Problem) -> str:
    """Say in one sentence that a run comes to steady sliding, and at what slip rate; "" if it does not."""
    before, last = _last_rates(history)
    rate, comes = float(last.mean()), is_steady(last, problem)
    if not comes and last.min() > 0.0:
        try:
            stable = [float(one.rate) for one in steady_slidings(problem).slidings if one.stable]
        except InputError:
            stable = []
        rate = min(stable, key=lambda one: abs(one - rate), default=np.inf)
        off = np.abs(last - rate).max()
        comes = bool(off <= NEARLY_STEADY * rate < np.inf and off < np.abs(before - rate).max())
    if not comes:
        return ""
    return f"cycle: the run comes to steady sliding at {brief(rate, problem.unit_of('pull_rate'))}: no cycle is near this run"
