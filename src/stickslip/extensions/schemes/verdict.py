"""Which selection rule a series follows, and orders of convergence.

A series is judged by its distance to the exact path of each rule in slip and in slip rate. Slip alone is too kind: a contact that
stops and starts again several times can have the mean slip of one that never stops.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import NamedTuple

import numpy as np

from stickslip.contact import folds_not_followed
from stickslip.extensions.schemes.contract import Series
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem
from stickslip.run import TextProgress, uninterrupted
from stickslip.run.simulate import simulate
from stickslip.solution import Solution


def local_orders(sizes: Floats, errors: Floats) -> Floats:
    """Return the order between each size and the one before; NaN for the first."""
    with np.errstate(divide="ignore", invalid="ignore"):
        steps = np.diff(np.log(np.abs(errors))) / np.diff(np.log(sizes))
    return np.concatenate([[np.nan], np.where(np.isfinite(steps), steps, np.nan)])


def groups(rules: Sequence[str], apart: Mapping[tuple[str, str], float], floor: float) -> list[tuple[str, ...]]:
    """Group the rules whose solutions differ by no more than the floor (m), in the order of `rules`."""
    found: dict[str, list[str]] = {}
    for rule in rules:
        first = next((one for one in found if apart[one, rule] <= floor), rule)
        found.setdefault(first, []).append(rule)
    return [tuple(group) for group in found.values()]


STRICT = 0.125
"""A series follows a rule if its distance to that rule's path is below this share of the distance to the next rule's path."""
LATE = 1.5
"""A path that is late, or early, by up to so many steps of a series cannot be told from one that is not."""
SAME_PATH = 1e-8
"""Paths whose distance is below this share of the largest mean slip, and of the largest mean slip rate, are the same."""
UNIFORM = 20_001
"""Compare exact paths at this many evenly spaced times; the breaks of their histories are added."""
NONE, UNTOLD = "none", "cannot tell"
"""Verdicts on a series that follows no rule, and on one that could follow all of them."""


class Gap(NamedTuple):
    """A distance between two paths: mean magnitudes over time of the differences in slip (m) and in slip rate (m/s)."""

    slip: float
    rate: float


def mean_magnitude(values: Floats, time: Floats) -> float:
    """Return the mean magnitude over time."""
    return float(np.trapezoid(np.abs(values), time) / (time[-1] - time[0]))


def change(coarse: Series, fine: Series, until: float) -> Gap:
    """Return the distance between two series, at the times of the first up to a time (s)."""
    time = coarse.time[coarse.time <= until]
    pairs = [(coarse.slip, fine.slip), (coarse.rate, fine.rate)]
    return Gap(*(mean_magnitude(one[: time.size] - np.interp(time, fine.time, other), time) for one, other in pairs))


def travel_time(series: Series, exact: Solution) -> float:
    """Return the travel time of a cell, s; 0 if the number of cells is unknown."""
    return exact.problem.body.time_to_driver / series.cells if series.cells else 0.0


def cell_time(series: Series, exact: Solution) -> float:
    """Return the time (s) that a series cannot resolve: the travel time of a cell, or the step of time if that is longer."""
    return max(travel_time(series, exact), series.step)


@dataclass(frozen=True, eq=False)
class RulePaths:
    """The exact solution under each selection rule, up to a time (s) that all of them cover."""

    exact: Mapping[str, Solution]
    until: float

    @cached_property
    def _time(self) -> Floats:
        breaks = [run.breaks[run.breaks <= self.until] for run in self.exact.values()]
        return np.unique(np.concatenate([np.linspace(0.0, self.until, UNIFORM), *breaks]))

    @cached_property
    def _paths(self) -> dict[str, tuple[Floats, Floats]]:
        return {rule: self._path(rule, self._time) for rule in self.exact}

    def _path(self, rule: str, time: Floats) -> tuple[Floats, Floats]:
        run = self.exact[rule]
        return run.slip(time) - run.problem.initial_slip, run.slip_rate(time)

    @cached_property
    def apart(self) -> dict[tuple[str, str], Gap]:
        """The distance between the paths of each two rules."""
        found = {(rule, rule): Gap(0.0, 0.0) for rule in self.exact}
        for a, b in combinations(self.exact, 2):
            pairs = zip(self._paths[a], self._paths[b], strict=True)
            found[a, b] = found[b, a] = Gap(*(mean_magnitude(one - other, self._time) for one, other in pairs))
        return found

    @cached_property
    def size(self) -> Gap:
        """The largest mean slip and mean slip rate of all paths."""
        sizes = [[mean_magnitude(values, self._time) for values in path] for path in self._paths.values()]
        return Gap(*np.max(sizes, axis=0).tolist())

    @cached_property
    def peak(self) -> float:
        """The largest slip rate of all paths, m/s."""
        return max(float(np.abs(rate).max()) for _, rate in self._paths.values())

    def groups(self, unresolved: float = 0.0) -> tuple[tuple[str, ...], ...]:
        """Return the rules in groups whose paths are the same, or differ by less than a shift of the peak by a time (s)."""
        floor = Gap(
            max(SAME_PATH * self.size.slip, self.peak * unresolved),
            max(SAME_PATH * self.size.rate, self.peak * unresolved / self.until),
        )
        over = {pair: max(gap.slip / (floor.slip or 1e-300), gap.rate / (floor.rate or 1e-300)) for pair, gap in self.apart.items()}
        return tuple(groups(tuple(self.exact), over, 1.0))

    def gap(self, series: Series, rule: str) -> Gap:
        """Return the distance from a series to the path of a rule."""
        kept = series.time <= self.until
        time = series.time[kept]
        slip, rate = self._path(rule, time)
        return Gap(mean_magnitude(series.slip[kept] - slip, time), mean_magnitude(series.rate[kept] - rate, time))

    def late(self, series: Series, rule: str) -> Gap:
        """Return the distance from the path of a rule to the same path late by LATE steps of a series.

        Slip is then off by the slip rate times the delay. The slip rate is off by each of its changes for the time of the delay.
        """
        delay, (_, rate) = LATE * series.step, self._paths[rule]
        changes = float(np.abs(np.diff(rate, prepend=0.0)).sum())
        return Gap(delay * mean_magnitude(rate, self._time), delay * changes / self.until)

    def misses(self, series: Series) -> dict[str, float]:
        """Return how far a series is from the path of each rule, as a share of the distance from that path to the next one.

        The larger share of slip and slip rate counts. If the series cannot tell any rules apart, it is a share of the largest mean
        slip and mean slip rate.
        """
        told = self.groups(cell_time(series, self.exact[next(iter(self.exact))]))
        found = {}
        for rule in self.exact:
            gap = self.gap(series, rule)
            others = [self.apart[rule, group[0]] for group in told if rule not in group]
            scale = Gap(min(one.slip for one in others), min(one.rate for one in others)) if others else self.size
            shares = [0.0 if value == 0.0 else value / max(unit, 1e-300) for value, unit in zip(gap, scale, strict=True)]
            found[rule] = max(shares)
        return found

    def followed(self, series: Series, misses: Mapping[str, float] | None = None) -> str:
        """Return the rules that a series follows, joined by "or"; NONE; or UNTOLD if it would be any of all rules.

        A series that follows none may be as near to some as if it were late: it then follows these. `misses` are those of the
        series, if they are known already.
        """
        misses, told = misses or self.misses(series), self.groups(cell_time(series, self.exact[next(iter(self.exact))]))
        group = next((group for group in told if min(misses[rule] for rule in group) < STRICT), ())
        group = group or tuple(rule for rule in self.exact if np.less_equal(self.gap(series, rule), self.late(series, rule)).all())
        return UNTOLD if (group and len(told) == 1) or len(group) == len(self.exact) else " or ".join(group) or NONE


def exact_runs(problem: Problem, duration: float, rtol: float, tell: TextProgress) -> dict[str, Solution]:
    """Return the exact solution of a problem under its own selection rule and under all built-in ones that are followed for it."""
    found = {}
    for rule in dict.fromkeys((problem.rule, *problem.rules)):
        selected = problem if rule == problem.rule else replace(problem, selection=rule)
        if rule != problem.rule and folds_not_followed(selected):
            continue
        tell(f"exact answer, {rule}")
        found[rule] = uninterrupted(simulate(selected, duration, rtol))
    return found
