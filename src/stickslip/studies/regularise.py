"""Convergence to a selection rule: runs with a regularisation of decreasing size, compared with the exact solution of each rule.

The paper (Campillo et al. 1996, section 3) needs a selection rule because its contact has neither inertia nor memory. A little of
either makes the slip rate unique. The limit of vanishing size shows which rule, if any, the physics selects.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from stickslip.engine_input.prepare import prepare
from stickslip.foundation.arguments import for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import NumberSeries, Quantity
from stickslip.problem.problem import Problem
from stickslip.problem.selection_rule import names, unknown
from stickslip.run.simulate import simulate
from stickslip.scenarios.source import read_duration_and_problem
from stickslip.solution.solution import Solution
from stickslip.studies.regularisations import SlipDifference, check_massless, difference, kind_of, passage, regularised
from stickslip.studies.verdict import Errors, Verdict, groups, judge, local_orders, order_of
from stickslip.study import MAX_PIECES, RunsCompared, StudyWithDataset, TextProgress, telling, uninterrupted

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario


LARGEST_SHARE, FACTOR, COUNT = 30.0, 4.0, 8
"""Default sizes: the largest is the two-way travel time over LARGEST_SHARE; each of COUNT is the one before over FACTOR."""
RESOLVED = 100.0
"""Differences below this multiple of rtol times the range of slip count as numerical error."""
FIRST_JUMPS = 12
"""Largest number of jumps that are timed."""


SIZES = NumberSeries(Quantity("s", "time in which the slip rate settles", above=0), least=3)
"""Sizes of regularisations."""


@dataclass(frozen=True, eq=False, repr=False)
class Regularisation(RunsCompared, StudyWithDataset):
    """The result of `regularise`, which compares all runs from t = 0 to `until` (s).

    `problem` has no regularisation, and `exact` holds its run under each selection rule. `runs` are regularised, one for each of
    the descending `sizes` (s), and each took so many `seconds` of computing time.
    """

    problem: Problem
    by: str
    sizes: Floats
    rtol: float
    exact: dict[str, Solution]
    runs: tuple[Solution, ...]
    seconds: tuple[float, ...]

    def _all_runs(self) -> tuple[Solution, ...]:
        return *self.exact.values(), *self.runs

    @cached_property
    def floor(self) -> float:
        """The mean slip difference (m) below which runs are equal to within their accuracy."""
        first = next(iter(self.exact.values()))
        return RESOLVED * self.rtol * max(float(np.ptp(first.slip(np.linspace(0.0, self.until, 101)))), 1e-300)

    @cached_property
    def groups(self) -> tuple[tuple[str, ...], ...]:
        """The rules in groups that have the same exact solution."""
        return tuple(groups(tuple(self.exact), self._apart, self.floor))

    @cached_property
    def _apart(self) -> dict[tuple[str, str], float]:
        found = {(rule, rule): 0.0 for rule in self.exact}
        for a, b in combinations(self.exact, 2):
            found[a, b] = found[b, a] = difference(self.exact[a], self.exact[b], self.until).mean
        return found

    @cached_property
    def differences(self) -> dict[tuple[str, ...], list[SlipDifference]]:
        """The differences in slip (m) of each run from the exact solution of each group of rules."""
        return {group: [difference(run, self.exact[group[0]], self.until) for run in self.runs] for group in self.groups}

    def errors(self, rule: str) -> Floats:
        """Return the mean magnitude of the slip difference (m) from the exact solution of a rule, for each size, shape (n,)."""
        return np.array([found.mean for found in self.differences[self._group(rule)]])

    def _group(self, rule: str) -> tuple[str, ...]:
        if rule not in self.exact:
            raise InputError(f"regularise: rule '{rule}' was not asked for; {nearest(rule, self.exact)}")
        return next(group for group in self.groups if rule in group)

    @cached_property
    def changes(self) -> Floats:
        """The mean magnitude of the slip difference (m) between each run and the one before, shape (n,); NaN first."""
        pairs = zip(self.runs[1:], self.runs[:-1], strict=True)
        return np.array([np.nan, *(difference(run, before, self.until).mean for run, before in pairs)])

    @cached_property
    def verdict(self) -> Verdict:
        """The rule to which the runs converge, and the order of convergence."""
        against = {group: self.errors(group[0]) for group in self.groups}
        apart = {a: min([math.inf, *(self._apart[a[0], b[0]] for b in self.groups if b != a)]) for a in self.groups}
        return judge(Errors(self.sizes, against, self.changes, apart, self.floor))

    @property
    def target(self) -> str:
        """The rule against which jumps are timed: the one to which the runs converge, otherwise the nearest one."""
        return self.verdict.rules[0] if self.verdict.rules else min(self.exact, key=lambda rule: float(self.errors(rule)[-1]))

    @cached_property
    def jumps(self) -> pd.DataFrame:
        """The jumps in the exact solution of the target rule.

        Columns: time (s), cause, rate_before and rate_after (m/s); order, with which the delay of the regularised runs decreases;
        expected, the order from theory: "2/3" at a fold, "1 (log)" for a jump out of rest under a ramp of load, and "1" for a jump
        caused by a jump of the load.
        """
        shocks = self.shocks
        table = shocks[["time", "cause", "rate_before", "rate_after"]].copy()
        table["order"] = [order_of(self.sizes, self.delays[:, j]).power for j in range(len(shocks))]
        ramped = (shocks.cause == "fold") | ((shocks.cause == "start") & (self.problem.excess == 0.0))
        table["expected"] = np.select([ramped & (shocks.rate_before == 0.0), ramped], ["1 (log)", "2/3"], "1")
        return table

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """The first shocks of the target's exact solution before `until` (at most FIRST_JUMPS): see `Solution.shocks`."""
        shocks = self.exact[self.target].shocks
        return shocks[shocks.time < self.until].head(FIRST_JUMPS)

    @cached_property
    def delays(self) -> Floats:
        """The delay (s) of each run (row) at each of the `jumps` (column), relative to the exact solution.

        A run makes a jump when its slip rate passes the middle between the rates before and after; NaN if it does not.
        """
        shocks = self.shocks
        times = shocks.time.to_numpy(float)
        edges = np.concatenate([[0.0], 0.5 * (times[1:] + times[:-1]), [self.until]])
        found = np.full((len(self.runs), len(times)), np.nan)
        for j, (at, before, after) in enumerate(zip(times, shocks.rate_before, shocks.rate_after, strict=True)):
            for i, run in enumerate(self.runs):
                found[i, j] = passage(run, 0.5 * (before + after), after > before, at, (edges[j], edges[j + 1])) - at
        return found

    @cached_property
    def table(self) -> pd.DataFrame:
        """A table with one row for each size.

        Columns: size (s); the parameter of the kind of regularisation; for each rule ``mean_``, ``largest_`` and ``end_``, the slip
        difference (m) from its exact solution, and ``order_``, between neighbouring sizes; change, the mean difference (m) from the
        size before; ``delay_`` of each jump (s); pieces of history; seconds of computing time; status.
        """
        kind = kind_of(self.by)
        columns: dict[str, object] = {"size": self.sizes}
        if kind.parameter != "time":
            columns[kind.parameter] = [kind.value(self.problem, size) for size in self.sizes.tolist()]
        for group, found in self.differences.items():
            for rule in group:
                name = rule.replace("-", "_")
                columns |= {f"{part}_{name}": [getattr(one, part) for one in found] for part in ("mean", "largest", "end")}
                columns[f"order_{name}"] = self.local_orders(rule)
        columns["change"] = self.changes
        columns |= {f"delay_{j + 1}": delay for j, delay in enumerate(self.delays.T)}
        columns["pieces"] = [len(run.history) for run in self.runs]
        columns["seconds"] = list(self.seconds)
        columns["status"] = [run.status.name for run in self.runs]
        return pd.DataFrame(columns)

    def local_orders(self, rule: str) -> Floats:
        """Return the order of the errors relative to a rule between each size and the one before, shape (n,); NaN first."""
        return local_orders(self.sizes, self.errors(rule))

    def _lines(self) -> tuple[str, ...]:
        return f"regularised by {kind_of(self.by).title}, {len(self.sizes)} sizes", self.verdict.text, self.stopped


def default_sizes(two_way_time: float) -> tuple[float, ...]:
    """Return the default sizes R / 30, R / 120, ... R / 491 520 (s)."""
    return tuple(two_way_time / LARGEST_SHARE / FACTOR**k for k in range(COUNT))


@for_users
def regularise(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    by: str = "contact-mass",
    sizes: Sequence[float | str | WithUnit] | WithUnit | None = None,
    rules: Sequence[str] | None = None,
    *,
    rtol: float = 1e-10,
    progress: TextProgress | bool | None = None,
    max_pieces: int = MAX_PIECES,
) -> Regularisation:
    """Run a massless contact under each selection rule, and with regularisations of decreasing size, and compare the runs.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        Problem with a slab without contact mass and a law without a state, its scenario, the name of a bundled scenario, or a
        scenario file.
    duration : float or str, optional
        Duration of each run (s, or a text with a unit); by default the scenario's.
    by : str
        Kind of regularisation: "contact-mass" (Z size), "lag" (LaggedFriction of time `size`) or "direct-effect" (the same with
        direct = variation of mu * size / R).
    sizes : sequence of float or str, optional
        Three or more different times (s, or texts with units); R/30 to R/491 520 by default.
    rules : sequence of str, optional
        Selection rules to compare with; by default all built-in ones that the problem may have.
    rtol : float
        Relative tolerance of the runs.
    progress : bool or callable, optional
        True shows the progress in one line, on a terminal or in a notebook. A function is called with a line of text as each run
        begins.
    max_pieces : int
        Largest number of pieces of history of one run. A run that needs more ends early, and all runs are compared up to that time.

    Raises
    ------
    InputError
        If there is nothing to regularise (a block, a contact with mass, a law with a state), if the kind is unknown or does not
        suit the law, if a rule is unknown or none is given, or if the sizes are not three or more different positive times.
    KeyboardInterrupt
        If the user presses Ctrl-C.
    """
    lasts, given = read_duration_and_problem("regularise", problem, duration)
    slab = check_massless(given)
    times = _checked(default_sizes(slab.two_way_time) if sizes is None else sizes)
    softened = [regularised(given, by, size) for size in times.tolist()]
    exact, runs, seconds = {}, [], []
    with telling(progress, "regularise") as tell:
        for rule in _known(given.rules if rules is None else rules):
            tell(f"exact answer, {rule}")
            exact[rule], _ = _run(replace(given, selection=rule), lasts, rtol, max_pieces)
        for i, (size, one) in enumerate(zip(times.tolist(), softened, strict=True)):
            tell(f"size {size:.3g} s, {i + 1} of {len(times)}")
            run, spent = _run(one, lasts, rtol, max_pieces)
            runs.append(run)
            seconds.append(spent)
    return Regularisation(given, by, times, rtol, exact, tuple(runs), tuple(seconds))


def _run(problem: Problem, duration: float, rtol: float, max_pieces: int) -> tuple[Solution, float]:
    """Run a problem, and return the solution and the seconds that it took, without compilation."""
    prepare(problem, rtol)
    start = time.perf_counter()
    solution = uninterrupted(simulate(problem, duration, rtol, max_pieces=max_pieces, shortest_event=0.0))
    return solution, time.perf_counter() - start


def _checked(sizes: Sequence[float | str | WithUnit] | WithUnit) -> Floats:
    times = np.sort(SIZES.check("regularise", "sizes", sizes))[::-1]
    twice = times[1:][np.diff(times) == 0.0]
    if twice.size:
        raise InputError(f"regularise: sizes must be different times, got {twice[0]:g} s twice")
    return times


def _known(rules: Sequence[str]) -> tuple[str, ...]:
    for rule in rules:
        if rule not in names():
            raise InputError(f"regularise: selection rule '{rule}' {unknown(rule)}")
    if not rules:
        raise InputError(f"regularise: needs a selection rule to compare with; allowed: {', '.join(names())}")
    return tuple(dict.fromkeys(rules))
