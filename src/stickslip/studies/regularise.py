"""To which selection rule does physics converge? Runs with a regularisation of shrinking size against the rules' exact answers.

The paper (Campillo et al. 1996, section 3) needs a rule because the contact has no inertia and no memory. Give it a little of
either and the slip rate is unique; let it shrink, and see which rule is left.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip import YEAR
from stickslip.engine_input.prepare import prepare
from stickslip.foundation.errors import InputError, nearest
from stickslip.problem.problem import Problem
from stickslip.problem.selection_rule import SELECTION_RULES, names, unknown
from stickslip.run.simulate import simulate
from stickslip.solution.solution import Solution
from stickslip.studies.regularisations import check_massless, kind_of, regularised
from stickslip.studies.run_distance import Difference, difference, passage
from stickslip.studies.verdict import Errors, Order, Verdict, groups, judge, local_orders, order_of
from stickslip.trajectory.history import Floats

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MAX_PIECES = 200_000
LARGEST_SHARE, FACTOR, COUNT = 30.0, 4.0, 8
"""Default sizes: from a 30th of the round trip down, each a quarter of the one before."""
RESOLVED = 100.0
"""Differences below this many rtol of the slip are not looked at."""
FIRST_JUMPS = 12

Report = Callable[[str], Any]


@dataclass(frozen=True, eq=False, repr=False)
class Regularisation:
    """What `regularise` found. `exact`: the massless run under each rule; `runs` and `seconds` (of computing): one for each size.

    Everything is compared from t = 0 to `until` (s), which all runs have reached.
    """

    problem: Problem
    by: str
    sizes: Floats
    rtol: float
    exact: dict[str, Solution]
    runs: tuple[Solution, ...]
    seconds: tuple[float, ...]

    @cached_property
    def until(self) -> float:
        """Time (s) up to which runs are compared: where the first of them ended."""
        return min(float(run.breaks[-1]) for run in (*self.exact.values(), *self.runs))

    @cached_property
    def floor(self) -> float:
        """Mean slip difference (m) below which runs are the same to their accuracy."""
        first = next(iter(self.exact.values()))
        return RESOLVED * self.rtol * max(float(np.ptp(first.slip(np.linspace(0.0, self.until, 101)))), 1e-300)

    @cached_property
    def groups(self) -> tuple[tuple[str, ...], ...]:
        """The rules, those with the same answer together."""
        return tuple(groups(tuple(self.exact), self._apart, self.floor))

    @cached_property
    def _apart(self) -> dict[tuple[str, str], float]:
        pairs = ((one, other) for one in self.exact for other in self.exact)
        return {(a, b): difference(self.exact[a], self.exact[b], self.until).mean if a != b else 0.0 for a, b in pairs}

    @cached_property
    def differences(self) -> dict[tuple[str, ...], list[Difference]]:
        """Of the slip (m) of each run from the exact answer of each group of rules."""
        return {group: [difference(run, self.exact[group[0]], self.until) for run in self.runs] for group in self.groups}

    def errors(self, rule: str) -> Floats:
        """Mean magnitude of the slip difference (m) from the exact answer of a rule, for each size."""
        return np.array([found.mean for found in self.differences[self._group(rule)]])

    def _group(self, rule: str) -> tuple[str, ...]:
        if rule not in self.exact:
            raise InputError(f"regularise: rule '{rule}' was not asked for; {nearest(rule, self.exact)}")
        return next(group for group in self.groups if rule in group)

    @cached_property
    def changes(self) -> Floats:
        """Mean magnitude of the slip difference (m) between each run and the one before; NaN for the first."""
        pairs = zip(self.runs[1:], self.runs[:-1], strict=True)
        return np.array([np.nan, *(difference(run, before, self.until).mean for run, before in pairs)])

    @cached_property
    def verdict(self) -> Verdict:
        """To which rule the runs tend, and with what order."""
        against = {group: self.errors(group[0]) for group in self.groups}
        apart = {a: min([math.inf, *(self._apart[a[0], b[0]] for b in self.groups if b != a)]) for a in self.groups}
        return judge(Errors(self.sizes, against, self.changes, apart, self.floor))

    @property
    def target(self) -> str:
        """The rule against which jumps are timed: the one the runs tend to, else the one they come nearest to."""
        return self.verdict.rules[0] if self.verdict.rules else min(self.exact, key=lambda rule: float(self.errors(rule)[-1]))

    @property
    def stopped(self) -> str:
        """Why the comparison ends before the duration that was asked for; empty if it does not."""
        early = [run for run in (*self.exact.values(), *self.runs) if not run.status.ok]
        reasons = ", ".join(dict.fromkeys(run.status.name for run in early))
        years = f" ({self.until / YEAR:.6g} years)" if self.until > 0.1 * YEAR else ""
        return f"compared up to {self.until:.6g} s{years} only, where the first run ended ({reasons})" if early else ""

    @cached_property
    def jumps(self) -> pd.DataFrame:
        """Jumps of the target's exact answer: time (s), cause, rate_before, rate_after (m/s), the order with which their delay
        falls, and what theory expects: "2/3" at a fold, "1 (log)" out of rest, where the load has jumped "1"."""
        from stickslip.studies.tables import jumps_table

        return jumps_table(self)

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """The first shocks of the target's exact answer, up to `until`: see `Solution.shocks`."""
        shocks = self.exact[self.target].shocks
        return shocks[shocks.time < self.until].head(FIRST_JUMPS)

    @cached_property
    def delays(self) -> Floats:
        """How much later (s) than in the exact answer each run (row) does each of the `jumps` (column); NaN where it does not.

        A jump is done when the slip rate passes the middle between the rates before and after.
        """
        shocks = self.shocks
        times = shocks.time.to_numpy(float)
        edges = np.concatenate([[0.0], 0.5 * (times[1:] + times[:-1]), [self.until]])
        found = np.full((len(self.runs), len(times)), np.nan)
        for j, (at, before, after) in enumerate(zip(times, shocks.rate_before, shocks.rate_after, strict=True)):
            for i, run in enumerate(self.runs):
                found[i, j] = passage(run, 0.5 * (before + after), after > before, at, edges[j], edges[j + 1]) - at
        return found

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a size: size (s), the kind's own parameter; for each rule mean_, largest_ and end_ (slip difference, m) and
        order_ between neighbouring sizes; change (m); delay_ of each jump (s); pieces, seconds (of computing) and status."""
        from stickslip.studies.tables import sizes_table

        return sizes_table(self)

    def delay_order(self, jump: int) -> Order:
        """Order with which the delay of a jump (a row of `jumps`) falls."""
        return order_of(self.sizes, self.delays[:, jump])

    def local_orders(self, rule: str) -> Floats:
        """Order of the errors against a rule between each size and the one before."""
        return local_orders(self.sizes, self.errors(rule))

    def plot(self) -> Figure:
        """Errors against size, and the runs approaching a jump."""
        from stickslip.figures.studies.regularise import data, draw

        return draw(data(self))

    def __repr__(self) -> str:
        lines = [f"regularised by {kind_of(self.by).title}, {len(self.sizes)} sizes", self.verdict.text, self.stopped]
        return "\n".join(["stickslip Regularisation", *(f"  {line}" for line in lines if line)])


def default_sizes(two_way_time: float) -> tuple[float, ...]:
    """R / 30, R / 120, ... R / 491 520, in s."""
    return tuple(two_way_time / LARGEST_SHARE / FACTOR**k for k in range(COUNT))


def regularise(
    problem: Problem,
    duration: float,
    by: str = "contact-mass",
    sizes: Sequence[float] | None = None,
    rules: Sequence[str] = SELECTION_RULES,
    rtol: float = 1e-10,
    *,
    progress: Report | None = None,
    max_pieces: int = MAX_PIECES,
) -> Regularisation:
    """Run a massless contact under each rule, then with a contact mass, a lag or a direct effect of each size, and compare.

    by: "contact-mass" (Z size), "lag" (LaggedFriction of time `size`) or "direct-effect" (the same with
    direct = variation of mu * size / R). sizes: times (s), three or more; default R/30 to R/491 520. A run that needs more than
    max_pieces ends early, and all are compared up to there. Ctrl-C raises KeyboardInterrupt.

    Raises InputError where there is nothing to regularise: a block, a contact with mass, a law with a state; for a law that the
    kind does not suit; for sizes that are not positive, different and three at least.
    """
    slab = check_massless(problem)
    times = _checked(default_sizes(slab.two_way_time) if sizes is None else sizes)
    tell = progress or (lambda text: None)
    softened = [regularised(problem, by, size) for size in times.tolist()]
    exact = {}
    for rule in _known(rules):
        tell(f"exact answer, {rule}")
        exact[rule] = _run(replace(problem, selection=rule), duration, rtol, max_pieces)[0]
    done = []
    for i, (size, one) in enumerate(zip(times.tolist(), softened, strict=True)):
        tell(f"size {size:.3g} s, {i + 1} of {len(times)}")
        done.append(_run(one, duration, rtol, max_pieces))
    return Regularisation(problem, by, times, rtol, exact, tuple(run for run, _ in done), tuple(spent for _, spent in done))


def _run(problem: Problem, duration: float, rtol: float, max_pieces: int) -> tuple[Solution, float]:
    """A run, and the seconds that it took, compilation aside."""
    prepare(problem, rtol)
    start = time.perf_counter()
    solution = simulate(problem, duration, rtol, max_pieces=max_pieces, shortest_event=0.0)
    if solution.status.name == "interrupted":
        raise KeyboardInterrupt
    return solution, time.perf_counter() - start


def _checked(sizes: Sequence[float]) -> Floats:
    times = np.sort(np.asarray(sizes, float).ravel())[::-1]
    if len(times) < 3 or not (np.isfinite(times).all() and (times > 0.0).all() and (np.diff(times) < 0.0).all()):
        raise InputError(f"regularise: sizes must be three or more different positive times in s, got {list(sizes)}")
    return times


def _known(rules: Sequence[str]) -> tuple[str, ...]:
    for rule in rules:
        if rule not in names():
            raise InputError(f"regularise: selection rule '{rule}' {unknown(rule)}")
    if not rules:
        raise InputError(f"regularise: needs a selection rule to compare with; allowed: {', '.join(names())}")
    return tuple(dict.fromkeys(rules))
