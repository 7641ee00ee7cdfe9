"""Comparison of several runs: their settings and results in one table and one figure."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

import stickslip
from stickslip.engine import SlipEvents
from stickslip.extensions.studies.reach_of_runs import reach_of_runs
from stickslip.foundation.arguments import for_users
from stickslip.foundation.constants import PAPER
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import si_unit
from stickslip.problem import Problem, default_event_rate, read_option
from stickslip.problem.scenarios import Scenario, read_source
from stickslip.run import Study, TextProgress, run_source, telling
from stickslip.solution import Solution
from stickslip.solution.files import read_solution
from stickslip.solution.observables import Pulses, extreme_tractions

COLUMNS = {
    "name": ("", "scenario, file, or the name that was given"),
    "rule": ("", "selection rule"),
    "regime": ("", "whether the contact equation has one solution (regular), several (irregular), or a continuum"),
    "end_slip": ("slip", "slip at the end of the run"),
    "displacement": ("slip", "largest displacement from the start of the run, negative if it is back"),
    "events": ("", "slip events, see `Solution.events`"),
    "wait": ("s", "time from the end of the first event to the start of the next; NaN if there is no next one"),
    "next_slip": ("slip", "slip of that next event, negative if it slips back"),
    "pulses": ("", "maxima of the slip rate in the largest event, see `Solution.events`"),
    "slip": ("slip", "slip of the largest event, negative if it slips back"),
    "peak_rate": ("slip_rate", "largest slip rate of the run"),
    "static_drop": ("load", "stiffness of the body times the slip of the largest event"),
    "dynamic_drop": (
        "load",
        "traction at rest before the largest event minus the smallest one while it slips, both against the slip",
    ),
    "duration": ("s", "duration of the first event; NaN if it is not over"),
    "shocks": ("", "jumps of the slip rate; it is smooth if there are none"),
    "load_unit": ("", "unit of the drops, which is that of the loads"),
    "status": ("", "what ended the run"),
}
"""Columns of the table, each with its unit, as `names.si_unit` understands it, and its meaning."""


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Study):
    """The result of `compare`: finished runs by name, and the `event` that the figure shows of each, in time since its start.

    The event is a row of `Solution.events`; None shows whole runs. `scenario` is the title of the one that was run under every
    selection rule, if the runs are those. Raises InputError if there are fewer than two runs, or if a run has no such event.
    """

    runs: dict[str, Solution]
    event: int | None = None
    scenario: str = ""

    def __post_init__(self) -> None:
        if len(self.runs) < 2:
            raise InputError(f"compare: needs two runs or more, got {len(self.runs)}")
        for name, solution in self.runs.items():
            count = len(solution.events)
            if self.event is not None and not -count <= self.event < count:
                raise InputError(f"compare: {name} has no slip event {self.event}: it has {count}, counted from 0")

    @cached_property
    def table(self) -> pd.DataFrame:
        """The table with one row for each run; columns and units are in `stickslip.extensions.studies.compare.COLUMNS`."""
        return pd.DataFrame([_row(name, solution) for name, solution in self.runs.items()], columns=list(COLUMNS))

    @property
    def problems(self) -> list[Problem]:
        """The problem of each run: results are shown in the units that all were given in."""
        return [run.problem for run in self.runs.values()]

    def _about(self) -> Iterator[str]:
        """Yield the version, the columns with their units, and every scenario in SI units, for the file of the table."""
        yield f"stickslip {stickslip.__version__}: runs side by side. Method: {PAPER}"
        for name, (_, meaning) in COLUMNS.items():
            yield f"{self._headings[name]}: {meaning}"
        for name, solution in self.runs.items():
            yield f"\n---- {name}: {solution.status}"
            yield Scenario(solution.problem, solution.asked_duration, solution.rtol, max_events=solution.max_events).to_toml()

    def __repr__(self) -> str:
        return f"{super().__repr__()}\n{self._shown_table().to_string(float_format='{:.6g}'.format)}"

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.studies.figures.compare import draw_compared

        return draw_compared

    def _sentences(self) -> Iterator[str]:
        yield f"of {', '.join(self.runs)}"
        yield self.reach_text

    @property
    def reach_text(self) -> str:
        """The ranges of the slips at the end and of the largest displacements."""
        return reach_of_runs(self.runs)

    def _shown_table(self) -> pd.DataFrame:
        return self.table.set_index("name").rename(columns=self._headings).T.rename_axis(columns=None)

    @property
    def _headings(self) -> dict[str, str]:
        """Each column with its unit, or units: the table may hold several kinds of bodies."""
        loads = dict.fromkeys(run.problem.load_unit for run in self.runs.values())
        return {name: f"{name} ({si_unit(unit, *loads)})" if unit else name for name, (unit, _) in COLUMNS.items()}


@for_users
def compare(
    *sources: str | Path | Scenario | Solution,
    rules: bool = False,
    names: Sequence[str] | None = None,
    event: int | None = None,
    duration: float | str | WithUnit | None = None,
    rtol: float | None = None,
    progress: TextProgress | bool | None = None,
) -> Comparison:
    """Compare two or more runs in one table and one figure.

    Parameters
    ----------
    *sources : str, Path, Scenario or Solution
        Scenarios (names of bundled ones, files, or `Scenario` objects) are run; solutions, also from files (.nc), are used as they
        are.
    rules : bool
        Run the one source under each selection rule; the runs are then called by their rules.
    names : sequence of str, optional
        Names of the runs, in the same order.
    event : int, optional
        Slip event of each run to show in the figure (0 the first, -1 the last), in time since its start.
    duration : float or str, optional
        Duration of the runs (s, or a text with a unit), in place of the scenarios' own.
    rtol : float, optional
        Relative tolerance, in place of the scenarios' own.
    progress : bool or callable, optional
        True shows the progress in one line, on a terminal or in a notebook. A function is called with the name of each run as it
        begins.

    Raises
    ------
    InputError
        If there are fewer than two runs, if a source is not a scenario or solution, if the number of names is wrong, if
        `duration` or `rtol` is out of range or given with a solution, if a run has no such event, or if `rules` is given with
        several sources, or with one that follows a single rule.
    KeyboardInterrupt
        If the user presses Ctrl-C.

    See Also
    --------
    stickslip.sweep : many runs that differ in the values of parameters only.

    Examples
    --------
    >>> import stickslip as ss
    >>> study = ss.studies.compare("fig5-slab-printed", "fig5-block-printed", names=["slab", "block"])
    >>> print(study.table[["name", "pulses", "slip", "shocks"]].round(4).to_string(index=False))
     name  pulses   slip  shocks
     slab       1 0.0006       2
    block       1 0.0074       0
    """
    if len(sources) < 2 and not rules:
        raise InputError(f"compare: needs two scenarios or runs, or more, got {len(sources)}; rules=True runs one under each rule")
    rtol = None if rtol is None else read_option("rtol", rtol, "compare")
    lasts = None if duration is None else read_option("duration", duration, "compare")
    ruled = under_each_rule(sources) if rules else []
    read = [run_source(source, lasts, rtol) for source in ruled or sources]
    called = distinct([source.name for source in read] if names is None else names)
    if len(called) != len(read):
        raise InputError(f"compare: names: {len(read)} are needed, got {len(called)}")
    runs = {}
    with telling(progress, "compare") as tell:
        for name, source in zip(called, read, strict=True):
            tell(name)
            runs[name] = source.solution(None)
    return Comparison(runs, event, title_of(ruled) if ruled else "")


def under_each_rule(sources: Sequence[str | Path | Scenario | Solution]) -> list[Scenario]:
    """Return the one scenario under each selection rule that it can be run with, named after the rule.

    Raises InputError for several sources, and for a problem that follows a single rule.
    """
    if len(sources) != 1:
        raise InputError(f"compare: every rule is that of one scenario, got {len(sources)} of them")
    scenario = _scenario_of(sources[0])
    rules = dict.fromkeys((*scenario.problem.rules, scenario.problem.rule))
    if len(rules) < 2:
        raise InputError(
            "compare: under friction of slip and slip rate the folds move with slip, and only perfect-delay is followed there: "
            "there are no rules to compare"
        )
    return [
        replace(scenario, name=rule, problem=scenario.problem if rule == scenario.problem.rule else _under(scenario.problem, rule))
        for rule in rules
    ]


def title_of(scenarios: Sequence[Scenario]) -> str:
    """Return what the runs of one scenario under each selection rule are called together."""
    return f"{scenarios[0].title or 'one problem'}: each selection rule"


def _under(problem: Problem, rule: str) -> Problem:
    return replace(problem, selection=rule)


def _scenario_of(source: str | Path | Scenario | Solution) -> Scenario:
    """Return the scenario of a source that `run_source` takes."""
    if isinstance(source, Solution):
        return source.scenario()
    if not isinstance(source, Scenario) and Path(str(source)).suffix == ".nc":
        return read_solution(Path(str(source))).scenario()
    return read_source("compare", source)


def distinct(names: Sequence[str]) -> list[str]:
    """Return the names, with (2), (3) ... appended to repeated ones."""
    repeats = [list(names[:i]).count(name) for i, name in enumerate(names)]
    return [f"{name} ({count + 1})" if count else name for name, count in zip(names, repeats, strict=True)]


def _row(name: str, solution: Solution) -> dict[str, Any]:
    problem, events = solution.problem, solution.events
    row = {
        "name": name,
        "rule": problem.rule,
        "regime": solution.rule_influence.regime,
        "end_slip": float(solution.slip()),
        "displacement": solution.reach.largest,
        "events": len(events),
        "pulses": 0,
        "shocks": len(solution.shocks),
        "peak_rate": solution.catalogue(0.0).peak_rate.max(),
        "load_unit": problem.load_unit,
        "status": solution.status.name,
    }
    if events.empty:
        return row
    n = int(events.slip.abs().to_numpy().argmax())
    largest, history, event_rate = events.iloc[n], solution.history, default_event_rate(problem)
    found = SlipEvents.of(history, event_rate)
    pulses = Pulses.of(history, found)
    before, smallest = extreme_tractions(history, found, pulses)
    return row | {
        "pulses": int(largest.pulses),
        "slip": largest.slip,
        "static_drop": largest.static_drop,
        "dynamic_drop": before[n] - smallest[n],
        "duration": events.duration.iloc[0],
        **({"wait": events.recurrence[1] - events.duration[0], "next_slip": events.slip[1]} if len(events) > 1 else {}),
    }
