"""Numerical schemes beside the exact solution: errors, orders, pulses, and the selection rule that each of them follows.

The paper (Campillo et al. 1996) fears that the rule may be "implicitly present in the numerical scheme independently of the assumed
physical hypothesis". With the exact solution of every rule this can be measured.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

import stickslip
from stickslip.extensions.schemes.contract import Scheme, Series
from stickslip.extensions.schemes.judgement import TOLERANCE, Judgement
from stickslip.extensions.schemes.measures import COLUMNS_OF_SCHEMES, MeasuredSeries, in_units, said_of
from stickslip.extensions.schemes.regularisations import LAB
from stickslip.extensions.schemes.run import FEWEST_CELLS, LARGEST_CELLS, check_runs, run_scheme
from stickslip.extensions.schemes.shocks import SHOCK_COLUMNS
from stickslip.extensions.schemes.traits import orders_of, why_not_told
from stickslip.extensions.schemes.verdict import NONE, SAME_PATH, UNTOLD, RulePaths, change, exact_runs, local_orders
from stickslip.foundation.arguments import check_whole, for_users
from stickslip.foundation.atomic_write import write_table
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.problem import Problem
from stickslip.problem.scenarios import read_source
from stickslip.run import Study, TextProgress, telling
from stickslip.solution import Solution

if TYPE_CHECKING:
    from stickslip.problem.scenarios import Scenario

CELLS = (25, 50, 100, 200)
"""Meshes that are taken if none are given."""
FEWEST, FALLING, NEGLIGIBLE = 3, 0.75, 0.02
"""On three meshes or more, a distance from a rule that stays above 2 % must fall below 3/4 of the coarsest mesh's."""
SETTLES = f"{NONE}, but tends to an answer of its own"
"""Verdict on a scheme whose ever finer meshes come together far from the path of every rule."""


@dataclass(frozen=True, eq=False, repr=False)
class Schemes(Study):
    """The result of `schemes` and `judge_series`: the exact run under each selection rule, and the series that were finished.

    `interrupted` is True if Ctrl-C ended the study before all meshes were done. `tolerance` is the largest share that a series
    of another program may be off, None if the series are those of schemes.
    """

    problem: Problem
    exact: dict[str, Solution]
    series: tuple[Series, ...]
    interrupted: bool = False
    tolerance: float | None = None

    @cached_property
    def until(self) -> float:
        """The time (s) up to which series and solutions are compared."""
        return min(*(run.history.span[1] for run in self.exact.values()), *(float(one.time[-1]) for one in self.series))

    @property
    def own(self) -> Solution:
        """The exact solution under the problem's own selection rule."""
        return self.exact[self.problem.rule]

    @cached_property
    def paths(self) -> RulePaths:
        """The exact paths of all rules, with the distances between them."""
        return RulePaths(self.exact, self.until)

    @cached_property
    def measured(self) -> tuple[MeasuredSeries, ...]:
        """Each series beside the exact solution under the problem's own rule."""
        return tuple(MeasuredSeries(one, self.own, self.until) for one in self.series)

    @cached_property
    def judgements(self) -> tuple[Judgement, ...]:
        """Each series beside the exact one: whether it passes, and what explains how far it is off."""
        tolerance = TOLERANCE if self.tolerance is None else self.tolerance
        return tuple(Judgement(one, self.paths, tolerance) for one in self.measured)

    @property
    def passed(self) -> bool:
        """True if every series is as near to the exact one as the tolerance asks."""
        return all(one.passed for one in self.judgements)

    @cached_property
    def table(self) -> pd.DataFrame:
        """The table with a row for each scheme and mesh; `columns` has their units and meanings."""
        rows = []
        for one in self.measured:
            own = {"scheme": one.series.name, "cells": one.series.cells, "step": one.series.step}
            misses = self.paths.misses(one.series)
            named = {f"miss_{rule}": miss for rule, miss in misses.items()}
            rows.append(own | one.row() | named | {"rule": self.paths.followed(one.series, misses)})
        table = pd.DataFrame(rows, columns=list(self.columns))
        for _, meshes in table.groupby("scheme", sort=False):
            for name in ("slip", "rate"):
                errors = meshes[f"{name}_error"].to_numpy(float)
                table.loc[meshes.index, f"{name}_order"] = local_orders(meshes.step.to_numpy(float), errors)
            for before, after in pairwise(meshes.index):
                found = change(self.series[before], self.series[after], self.until)
                table.loc[after, ["slip_change", "rate_change"]] = list(found)
        return table

    @property
    def told(self) -> tuple[str, ...]:
        """What is said of series of another program: whether each passes, what is off, what explains it, and how errors fall."""
        texts = [text for one in self.judgements for text in one.texts]
        return tuple(text for text in (*texts, orders_of(self.measured)) if text)

    @property
    def not_told(self) -> str:
        """Why the problem cannot tell selection rules apart, and which benchmarks can; "" if it can."""
        from stickslip.extensions.schemes.problems import OF_ONE_CONTACT  # here, because those are made of this

        return why_not_told(self.paths, self.problem, [one.name for one in OF_ONE_CONTACT if one.tells_rules])

    @property
    def columns(self) -> dict[str, tuple[str, str]]:
        """The columns of the table, each with its unit and meaning."""
        meaning = "distance from the exact path of {}, as a share of the distance from that to the next rule's path"
        return in_units(COLUMNS_OF_SCHEMES, self.problem.body.load_unit) | {
            f"miss_{rule}": ("", meaning.format(rule)) for rule in self.exact
        }

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """Each exact shock beside that of each series; columns and units: `stickslip.extensions.schemes.shocks.SHOCK_COLUMNS`."""
        pairs = [(one.series, shock) for one in self.measured for shock in one.shocks]
        rows = [{"scheme": series.name, "cells": series.cells, **shock._asdict()} for series, shock in pairs]
        return pd.DataFrame(rows, columns=list(SHOCK_COLUMNS))

    @cached_property
    def verdicts(self) -> dict[str, str]:
        """What each scheme follows on all meshes: a rule, maybe from some mesh on; none; cannot tell; or it depends on the mesh."""
        return {str(scheme): self._verdict(str(scheme)) for scheme in self.table.scheme.unique()}

    def _verdict(self, scheme: str) -> str:
        rows = self.table[self.table.scheme == scheme].sort_values("step", ascending=False, kind="stable")
        found = rows.rule.tolist()
        last = found[-1]
        if last in (NONE, UNTOLD):
            if len(set(found)) > 1:
                return _depends(found)
            return SETTLES if last == NONE and self._settles(rows) else last
        misses = rows[f"miss_{last.split(' or ')[0]}"].tolist()
        stays = misses[-1] > NEGLIGIBLE and misses[-1] > FALLING * misses[0]
        if len(found) >= FEWEST and stays:
            return f"{NONE}: near {last}, without coming closer to it on finer meshes"
        first = next(k for k in range(len(found)) if set(found[k:]) == {last})
        if set(found[:first]) - {NONE, UNTOLD}:
            return _depends(found)
        cells = int(rows.cells.iloc[first])
        return f"{last}, from {cells} cells on" if first and cells else last

    def _settles(self, rows: pd.DataFrame) -> bool:
        """Return whether the changes from mesh to mesh fall so fast, and are so small, that they lead to the path of no rule.

        If each is at most FALLING = 3/4 of the one before, all that are left together are at most three times the last one. This
        must be less than FALLING of the distance from each path, in slip or in slip rate.
        """
        changes = rows[["slip_change", "rate_change"]].to_numpy(float)[1:]
        left = changes[-1:] * FALLING / (1.0 - FALLING)
        gaps = np.array([self.paths.gap(self.series[int(rows.index[-1])], rule) for rule in self.exact])
        falls = (changes[1:] <= FALLING * changes[:-1]) | (changes[1:] <= SAME_PATH * np.array(self.paths.size))
        return len(changes) >= FEWEST - 1 and bool(falls.all() and (left < FALLING * gaps).any(axis=1).all())

    def shocks_to_csv(self, path: str | Path) -> Path:
        """Write the table of shocks as CSV, with the meaning of its columns in comment lines (#), and return its path."""
        return write_table(Path(path), self.shocks, said_of(in_units(SHOCK_COLUMNS, self.problem.body.load_unit)))

    def _about(self) -> Iterator[str]:
        yield f"stickslip {stickslip.__version__}: numerical schemes beside the exact solution"
        yield from said_of(self.columns)

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.schemes.figure import draw_schemes

        return draw_schemes

    def _sentences(self) -> Iterator[str]:
        yield f"{len(self.series)} runs, compared up to {self.until:.6g} s"
        if self.interrupted:
            yield "interrupted: these are the runs that were finished"
        yield self.not_told
        if not self.not_told:
            yield from (f"{scheme} follows {rule}" for scheme, rule in self.verdicts.items())
        if self.tolerance is not None:
            yield from self.told


def _depends(found: list[str]) -> str:
    return f"depends on the mesh ({'; '.join(dict.fromkeys(found))})"


def _scheme_of(scheme: str | Scheme) -> Scheme:
    """Return the scheme of a name, or a scheme as it is. Raises InputError for an unknown name and for what is no scheme."""
    if isinstance(scheme, str):
        if scheme not in LAB:
            raise InputError(f"schemes: there is no scheme {ascii(scheme)[:60]}; {nearest(scheme, LAB)}")
        return LAB[scheme]
    missing = [name for name in ("name", "title", "order", "courant", "largest_courant", "begin") if not hasattr(scheme, name)]
    if missing:
        raise InputError(f"schemes: a scheme needs {', '.join(missing)}: see stickslip.extensions.schemes.contract.Scheme")
    return scheme


@for_users
def schemes(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    scheme: str | Scheme | Sequence[str | Scheme] = "central-differences",
    cells: int | Sequence[int] = CELLS,
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
        Names in `stickslip.extensions.schemes.regularisations.LAB`, each once, or objects like
        `stickslip.extensions.schemes.contract.Scheme`.
    cells : int or sequence of int
        Number of cells in the thickness, for each mesh.
    search : str
        How the contact looks for a root: a name in `stickslip.extensions.schemes.run.SEARCHES`.
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

    See Also
    --------
    stickslip.studies.judge_series : judge the output of your own program in the same way.

    Examples
    --------
    >>> import stickslip as ss
    >>> study = ss.studies.schemes("fig6-slab", scheme="characteristics", cells=[50, 100])
    >>> print(study.table[["scheme", "cells", "slip_error"]].to_string(index=False))
             scheme  cells  slip_error
    characteristics     50    0.061670
    characteristics    100    0.030765
    """
    scenario = read_source("schemes", problem, duration)
    lasts, given = scenario.duration, scenario.problem
    several = [scheme] if isinstance(scheme, str) or not isinstance(scheme, Sequence) else scheme
    chosen = [_scheme_of(one) for one in several]
    twice = next((one.name for i, one in enumerate(chosen) if one.name in {other.name for other in chosen[:i]}), None)
    if twice is not None:
        raise InputError(f"schemes: the scheme {ascii(twice)[:60]} is given twice")
    counts = cells if isinstance(cells, Iterable) and not isinstance(cells, str) else [cells]
    meshes = sorted({check_whole("schemes: cells", count, FEWEST_CELLS, LARGEST_CELLS) for count in counts})
    if not meshes or not chosen:
        raise InputError("schemes: needs a scheme and a mesh or more")
    check_runs(given, lasts, chosen, meshes, search=search, courant=courant)
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
