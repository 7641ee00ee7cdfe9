"""How disturbances of a run grow where no equation of disturbances is followed: two exact runs that differ a little.

The run and another one, which differs from it by a millionth, go on for some round trips. Then it is measured how far apart they
are, without the part along the motion, which is a shift in time, and the other run is put as close to the run as before.

Source: Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15, 9; of bodies with delays Farmer 1982, Physica D 4, 366.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from stickslip.engine import History
from stickslip.engine.input import SHARE_OF_TOLERANCE
from stickslip.extensions.cycles.asked import not_steady
from stickslip.extensions.cycles.disturbed.measure import Measure, first_disturbance
from stickslip.extensions.cycles.disturbed.pair import Pair
from stickslip.extensions.cycles.exponent import ERROR_BATCHES, MeasuredGrowth, drift_of
from stickslip.extensions.cycles.find_cycle import without_load
from stickslip.extensions.cycles.section import onsets
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.run import TextProgress

KEPT_APART = 1e-6
"""The size of the disturbance (1, a share of the motion) after each comparison."""
FEWEST_COMPARISONS = 16
"""The smallest number of comparisons (1) an exponent is the mean of."""
FEWEST_IN_PART = 4
"""The smallest number of comparisons (1) in a part of the run, of whose slopes the error is made."""
SETTLING_SHARE = 0.1
"""This share (1) of the time after what is skipped does not count: a disturbance turns to where it grows fastest then."""
ENDED_SHARE = 1e-6
"""A disturbance that falls to this share (1) of itself from one comparison to the next has ended but for rounding."""
ENDS_ALL = (
    "from one comparison of two runs to the next a disturbance ends but for rounding (exponent minus infinity, or far below 0)"
)


def growth_of_pair(problem: Problem, skip: float, duration: float, rtol: float, tell: TextProgress) -> MeasuredGrowth:
    """Return how disturbances grow along a run from `skip` to `duration` (s). Raises InputError."""
    _check(problem)
    begin = skip + SETTLING_SHARE * (duration - skip)
    pair = Pair.begin(without_load(problem), duration, rtol, shifts=not not_steady(problem) and problem.far_stress_rate == 0.0)
    if not duration - begin > FEWEST_COMPARISONS * pair.interval:
        fewest = math.ceil(FEWEST_COMPARISONS / (1.0 - SETTLING_SHARE) + 1.0)
        raise InputError(
            f"lyapunov: duration must be longer than skip by {fewest} round trips of {brief(pair.interval, 's')} or more"
        )
    measure, stand, found = Measure.of(pair.run), pair.stand, Growing()
    measure.see(stand)
    pair.differ_by(first_disturbance(stand, measure).times(KEPT_APART))
    while (time := stand.time) < duration:
        stand, counts = pair.lead(), time >= begin
        if not counts:
            measure.see(stand)
        way, apart = pair.apart(stand, measure)
        if not apart > ENDED_SHARE * KEPT_APART:
            if counts:
                return MeasuredGrowth(np.zeros(1), np.zeros(1), -math.inf, 0.0, time, ENDS_ALL)
            way, apart = first_disturbance(stand, measure), KEPT_APART
        if counts:
            found.note(pair.run.history(), time, stand.time, math.log(apart / KEPT_APART))
        pair.differ_by(way.times(KEPT_APART))
        if len(found.times) % 64 == 1:
            tell(f"{brief(time, 's')} of {brief(duration, 's')}")
    if len(found.times) <= FEWEST_COMPARISONS:
        raise InputError(
            f"lyapunov: two runs could be compared {max(len(found.times) - 1, 0)} times only between {brief(begin, 's')} and"
            f" {brief(duration, 's')}, and {FEWEST_COMPARISONS} are needed: give a longer duration"
        )
    each = ", each phase of the round trip by itself" if measure.by_phase else ""
    how = f"measured on two runs that differ by {KEPT_APART:g}{each}, compared {len(found.times) - 1} times in {{}} (rtol {rtol:g})"
    return found.mean(how, max(rtol * SHARE_OF_TOLERANCE, float(np.finfo(float).eps)))


def _check(problem: Problem) -> None:
    """Refuse friction that changes with all slip. Raises InputError."""
    law = problem.friction
    if law.depends_on_slip and (law.memory == "all" or law.states):
        raise InputError(
            f"lyapunov: under {type(law).__name__} friction changes with all slip: the motion never comes to one that stays, and a"
            " mean rate of growth says nothing; ss.studies.compare puts two runs side by side"
        )


@dataclass
class Growing:
    """What is noted at each comparison."""

    times: list[float] = field(default_factory=list)
    """Times (s) of comparisons, behind that of the start."""
    growth: list[float] = field(default_factory=list)
    """Logarithm (1) of the size of a disturbance at these times."""
    rates: list[Floats] = field(default_factory=list)
    """Slip rates (m/s) from one to the next, the least and the greatest."""
    events: int = 0
    """Number of onsets of slip."""

    def note(self, history: History, begin: float, end: float, grown: float) -> None:
        """Take note of a part of a run, at whose end a disturbance has grown by so much (1, a logarithm)."""
        if not self.times:
            self.times, self.growth = [begin], [0.0]
        self.times.append(end)
        self.growth.append(self.growth[-1] + grown)
        here = np.flatnonzero(history.start >= begin * (1.0 - 1e-12))
        if len(here):
            rate = history.store.rate[here]
            ends = np.append(rate[:, 0], rate.sum(axis=1))
            self.rates.append(np.array([ends.min(), ends.max()]))
            self.events += int((onsets(history).time >= begin).sum())

    def mean(self, how: str, known: float) -> MeasuredGrowth:
        """Return the mean rate, as the slope of a line, and its error, from the slopes in parts of the run."""
        time, growth = np.array(self.times), np.array(self.growth)
        counted = float(time[-1] - time[0])
        exponent = slope_of(time, growth)
        count = min(ERROR_BATCHES, len(time) // FEWEST_IN_PART)
        parts = np.array([slope_of(*part) for part in np.array_split(np.array([time, growth]), count, axis=1)])
        ranges = np.array([np.ptp(part) for part in np.array_split(np.array(self.rates), ERROR_BATCHES) if len(part)])
        drift = drift_of(ranges[ranges > 0.0])
        error = math.hypot(float(np.std(parts, ddof=1)) / math.sqrt(count), drift / counted)
        how, events = how.format(brief(counted, "s")), self.events or math.nan
        return MeasuredGrowth(time, growth, exponent, error, counted, how, events, known=known, drift=drift)


def slope_of(time: Floats, growth: Floats) -> float:
    """Return the slope of a straight line (1/s): a disturbance of a cycle swings, and its ends would tell less."""
    away = time - time.mean()
    return float(away @ (growth - growth.mean()) / (away @ away))
