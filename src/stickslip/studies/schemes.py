"""Numerical schemes beside the exact solution: errors, orders, pulses, and the selection rule that each of them follows.

The paper (Campillo et al. 1996) fears that the rule may be "implicitly present in the numerical scheme independently of the assumed
physical hypothesis". With the exact solution of every rule this can be measured.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

import stickslip
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import write
from stickslip.problem.problem import Problem
from stickslip.problem.selection_rule import SELECTION_RULES
from stickslip.run.simulate import simulate
from stickslip.scenarios.source import read_duration_and_problem
from stickslip.schemes.contract import Scheme
from stickslip.schemes.registry import scheme_of
from stickslip.schemes.run import check_suitable, run_scheme
from stickslip.schemes.series import Series
from stickslip.solution.solution import Solution
from stickslip.studies.run_distance import difference
from stickslip.studies.scheme_measures import COLUMNS, Measured
from stickslip.studies.study import Study, TextProgress, telling, uninterrupted
from stickslip.studies.verdict import CLEARLY, FEWEST, Errors, Verdict, groups, judge

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario

CELLS = (25, 50, 100, 200)
"""Meshes that are taken if none are given."""
SAME = 1e-8
"""Solutions of rules whose mean slip differs by less than this share of the final slip are the same."""


@dataclass(frozen=True, eq=False, repr=False)
class Schemes(Study):
    """The result of `schemes` and `judge_series`.

    Attributes
    ----------
    problem : Problem
        Problem.
    exact : dict of Solution
        Exact run under each selection rule.
    series : tuple of Series
        Series of each scheme and mesh that was finished.
    interrupted : bool
        True if Ctrl-C ended the study before all meshes were done.
    """

    problem: Problem
    exact: dict[str, Solution]
    series: tuple[Series, ...]
    interrupted: bool = False

    @cached_property
    def until(self) -> float:
        """The time (s) up to which series and solutions are compared."""
        return min(*(run.history.span[1] for run in self.exact.values()), *(float(one.time[-1]) for one in self.series))

    @property
    def own(self) -> Solution:
        """The exact solution under the problem's own selection rule."""
        return self.exact[self.problem.rule]

    @cached_property
    def _apart(self) -> dict[tuple[str, str], float]:
        found = {(rule, rule): 0.0 for rule in self.exact}
        for a, b in combinations(self.exact, 2):
            found[a, b] = found[b, a] = difference(self.exact[a], self.exact[b], self.until).mean
        return found

    @cached_property
    def groups(self) -> tuple[tuple[str, ...], ...]:
        """The rules in groups that have the same exact solution."""
        floor = SAME * max(abs(float(self.own.slip(self.until)) - self.problem.initial_slip), 1e-300)
        return tuple(groups(tuple(self.exact), self._apart, floor))

    @cached_property
    def distance(self) -> dict[tuple[str, ...], float]:
        """The mean slip difference (m) from the solution of each group of rules to the nearest other one; inf if there is none."""
        return {a: min([math.inf, *(self._apart[a[0], b[0]] for b in self.groups if b != a)]) for a in self.groups}

    def errors(self, series: Series) -> dict[tuple[str, ...], float]:
        """Return the mean slip difference (m) of a series from the exact solution of each group of rules."""
        return {group: Measured(series, self.exact[group[0]], self.until).slip_error for group in self.groups}

    def rule_of(self, series: Series) -> str:
        """Return the rules that a series follows: it is clearly nearer to their solution than that is to any other."""
        if len(self.groups) == 1:
            return "unique"
        errors = self.errors(series)
        best = min(errors, key=lambda group: errors[group])
        return ", ".join(best) if errors[best] < CLEARLY * self.distance[best] else "none"

    @cached_property
    def table(self) -> pd.DataFrame:
        """The table with a row for each scheme and mesh; columns and units are in `stickslip.studies.scheme_measures.COLUMNS`."""
        rows = []
        for one in self.series:
            own = {"scheme": one.name, "cells": one.cells, "step": one.step, "rule": self.rule_of(one)}
            rows.append(own | Measured(one, self.own, self.until).row())
        table = pd.DataFrame(rows, columns=list(COLUMNS))
        for name in ("slip", "rate"):
            table[f"{name}_order"] = _orders(table, f"{name}_error")
        return table

    @cached_property
    def verdicts(self) -> dict[str, str]:
        """What each scheme follows on all meshes: a rule, with or without convergence to it; "none"; "unique"; or it depends."""
        return {str(scheme): self._verdict(str(scheme)) for scheme in self.table.scheme.unique()}

    def _verdict(self, scheme: str) -> str:
        found = list(dict.fromkeys(self.table.rule[self.table.scheme == scheme]))
        if len(found) > 1:
            return f"depends on the mesh ({'; '.join(found)})"
        limit = self.limit(scheme)
        converges = found[0] in ("unique", "none") or limit is None or limit.rules
        return found[0] if converges else f"near {found[0]}, without converging to it"

    def limit(self, scheme: str) -> Verdict | None:
        """Return the rule to which the runs of a scheme converge, as `regularise` decides it; None for fewer than three meshes."""
        runs = sorted((one for one in self.series if one.name == scheme), key=lambda one: -one.step)
        if len(runs) < FEWEST:
            return None
        errors = [self.errors(one) for one in runs]
        time = np.linspace(0.0, self.until, 2001)
        slips = [np.interp(time, one.time, one.slip) for one in runs]
        changes = np.array([np.nan, *(float(np.abs(b - a).mean()) for a, b in pairwise(slips))])
        against = {group: np.array([error[group] for error in errors]) for group in self.groups}
        return judge(Errors(np.array([one.step for one in runs]), against, changes, self.distance, 0.0))

    def to_netcdf(self, path: str | Path) -> Path:
        """Write the table and what `plot` draws as netCDF, and return the path."""
        dataset = self.table.rename_axis("row").to_xarray()
        for name, (unit, meaning) in COLUMNS.items():
            dataset[name].attrs = {"long_name": meaning, "units": unit or "1"}
        drawn = self.to_dataset()
        return write(dataset.merge(drawn.drop_vars(set(dataset.variables) & set(drawn.variables))), Path(path))

    def _about(self) -> Iterator[str]:
        yield f"stickslip {stickslip.__version__}: numerical schemes beside the exact solution"
        for name, (unit, meaning) in COLUMNS.items():
            yield f"{name}{f' ({unit})' if unit else ''}: {meaning}"

    def _lines(self) -> Iterator[str]:
        yield f"{len(self.series)} runs, compared up to {self.until:.6g} s"
        if self.interrupted:
            yield "interrupted: these are the runs that were finished"
        if len(self.groups) == 1:
            yield "all selection rules have the same solution here"
        else:
            yield from (f"{scheme} follows {rule}" for scheme, rule in self.verdicts.items())


def _orders(table: pd.DataFrame, column: str) -> list[float]:
    """Return the order of an error between each mesh and the one before of the same scheme; NaN for the first."""
    found = [math.nan]
    for before, after in pairwise(table[["scheme", "step", column]].itertuples(index=False)):
        usable = before[0] == after[0] and before[1] != after[1] and min(before[2], after[2]) > 0.0
        found.append(math.log(before[2] / after[2]) / math.log(before[1] / after[1]) if usable else math.nan)
    return found[: len(table)]


def exact_runs(problem: Problem, duration: float, rtol: float, tell: TextProgress) -> dict[str, Solution]:
    """Return the exact solution of a problem under its own selection rule and under all built-in ones."""
    found = {}
    for rule in dict.fromkeys((problem.rule, *SELECTION_RULES)):
        tell(f"exact answer, {rule}")
        selected = problem if rule == problem.rule else replace(problem, selection=rule)
        found[rule] = uninterrupted(simulate(selected, duration, rtol))
    return found


def schemes(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    scheme: str | Scheme | Sequence[str | Scheme] = "central-differences",
    cells: Sequence[int] = CELLS,
    *,
    search: str = "stick-first",
    courant: float | None = None,
    rtol: float = 1e-10,
    progress: TextProgress | bool | None = None,
) -> Schemes:
    """Run numerical schemes on several meshes, and compare them with the exact solution of every selection rule.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        Problem with a slab without contact mass and a law without a state, its scenario, the name of a bundled scenario, or a
        scenario file.
    duration : float or str, optional
        Duration of each run (s, or a text with a unit); by default the scenario's.
    scheme : str, Scheme or sequence of them
        Names in `stickslip.schemes.registry.SCHEMES`, or objects like `stickslip.schemes.contract.Scheme`.
    cells : sequence of int
        Number of cells in the thickness, for each mesh.
    search : str
        How the contact looks for a root: a name in `stickslip.schemes.contact.SEARCHES`.
    courant : float, optional
        Courant number c dt / dx, by default each scheme's own.
    rtol : float
        Relative tolerance of the exact runs.
    progress : bool or callable, optional
        True shows the progress in one line. A function is called with a line of text as each run begins.

    Returns
    -------
    Schemes
        The series, their table and figure. After Ctrl-C it holds the runs that were finished.

    Raises
    ------
    InputError
        If the problem does not suit the schemes, if a name is unknown, or if cells or the Courant number are out of range.
    KeyboardInterrupt
        If the user presses Ctrl-C before the first run of a scheme is finished.
    """
    lasts, given = read_duration_and_problem("schemes", problem, duration)
    check_suitable(given)
    several = [scheme] if isinstance(scheme, str) or not isinstance(scheme, Sequence) else scheme
    chosen = [scheme_of(one) for one in several]
    meshes = sorted({int(count) for count in cells})
    if not meshes or not chosen:
        raise InputError("schemes: needs a scheme and a mesh or more")
    done: list[Series] = []
    interrupted = False
    with telling(progress, "schemes") as tell:
        exact = exact_runs(given, lasts, rtol, tell)
        try:
            for one in chosen:
                for count in meshes:
                    tell(f"{one.name}, {count} cells")
                    done.append(run_scheme(given, lasts, one, count, search=search, courant=courant))
        except KeyboardInterrupt:
            if not done:
                raise
            interrupted = True
    return Schemes(given, exact, tuple(done), interrupted)


def judge_series(
    series: Series | Sequence[Series],
    problem: Problem | Scenario | str | Path,
    *,
    rtol: float = 1e-10,
    progress: TextProgress | bool | None = None,
) -> Schemes:
    """Compare series of any other program with the exact solution of every selection rule.

    Parameters
    ----------
    series : Series or sequence of Series
        Slip since t = 0, slip rate and traction over time; `stickslip.io.series.read_series` reads them from a file.
    problem : Problem, Scenario, str or Path
        Problem that the program has solved, as for `schemes`.
    rtol : float
        Relative tolerance of the exact runs.
    progress : bool or callable, optional
        As for `schemes`.

    Returns
    -------
    Schemes
        The series with their table and figure.

    Raises
    ------
    InputError
        If the problem is not a slab's, or no series is given.
    KeyboardInterrupt
        If the user presses Ctrl-C.
    """
    several = (series,) if isinstance(series, Series) else tuple(series)
    if not several:
        raise InputError("judge_series: needs a series or more")
    lasts = max(float(one.time[-1]) for one in several)
    _, given = read_duration_and_problem("judge_series", problem, lasts)
    with telling(progress, "judge_series") as tell:
        return Schemes(given, exact_runs(given, lasts, rtol, tell), several)
