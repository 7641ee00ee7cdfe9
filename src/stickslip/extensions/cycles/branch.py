"""A branch of cycles along one number of a problem: the result of `ss.studies.follow`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stickslip.extensions.cycles.edges import CORNER, DOUBLING, FOLD, GRAZING, HALVING, MEANING, NOT_FOUND, TORUS, CycleEdge
from stickslip.extensions.cycles.hysteresis import Interval, joined, with_stable_cycles, with_stable_sliding
from stickslip.extensions.cycles.limit_cycle import NOT_KNOWN, LimitCycle, is_stable, row_of
from stickslip.extensions.cycles.measures import Measures
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.problem.scenarios import ParameterPath
from stickslip.run import Study

ON_THE_CIRCLE = (FOLD, DOUBLING, TORUS, HALVING)
"""The edges where a multiplier is on the unit circle: linear disturbances neither fade nor grow."""

GIVEN_UP, BOUNDS = (CORNER, GRAZING, NOT_FOUND), ("at most ", "at least ")
"""The edges at the end of a branch beyond which cycles may go on that are not found, and what is said of an interval to there."""


class PointOnBranch(NamedTuple):
    """A cycle on a branch: the value (SI) of the parameter, its numbers, and the name of the edge if it is one."""

    value: float
    measures: Measures
    multipliers: NDArray[Any]
    sticks: bool
    edge: str
    part: int = 0
    """The part of the branch (1): one more for each that begins at a period doubling."""
    doubled: int = 0
    """How often its period has doubled (1) since the first cycle."""
    start: Floats = np.zeros(0)
    """Where the section is met, as the path counts it; nothing at an onset of slip, or where a branch cannot go on."""
    ahead: Floats = np.zeros(0)
    """The next step along the branch, of start and parameter in SI; nothing at an edge, or where a branch cannot go on."""

    @property
    def at_onset(self) -> bool:
        """True if it is cut at an onset of slip, where a rest has left fewer coordinates than there are multipliers."""
        return len(self.start) < len(self.multipliers)

    @property
    def stable(self) -> bool | None:
        """Whether its disturbances fade; None at an edge where a multiplier is on the unit circle, but for rounding."""
        return None if self.edge in ON_THE_CIRCLE else is_stable(self.multipliers)


@dataclass(frozen=True, eq=False, repr=False)
class BranchOfCycles(Study):
    """The result of `follow`: the cycles along a branch in their order, and its edges.

    `table` has a row for each: the parameter, then the columns of `LimitCycle.table`, and edge, the name of an edge or "", in SI;
    part counts the parts that begin at period doublings, doubled how often the period has doubled, and start_1 and so on are load
    and inner states where the cycle begins; `follow` goes on from them, by a step of `ahead` along the parameter and of ahead_1 and
    so on along them.
    """

    start: LimitCycle
    parameter: ParameterPath = field(compare=False)
    points: tuple[PointOnBranch, ...] = field(compare=False)
    edges: tuple[CycleEdge, ...] = field(compare=False)
    """The edges in their order: name, value (SI) of the parameter, and the cycle next to it."""
    to: float = np.nan
    interrupted: bool = False
    """True if Ctrl-C ended it before its end: `follow(..., resume=branch)` goes on."""
    is_full: bool = False
    """True if it ends because no more cycles are followed at once: `follow(..., resume=branch)` goes on."""

    @property
    def problem(self) -> Problem:
        """The problem at the beginning of the branch."""
        return self.start.problem

    @cached_property
    def table(self) -> pd.DataFrame:
        """The cycles along the branch, in SI."""
        rows = []
        for one in self.points:
            row = {self.parameter.name: one.value} | row_of(one.measures, one.multipliers)
            if one.edge in ON_THE_CIRCLE:
                row["stable"] = NOT_KNOWN
            row |= {"edge": one.edge, "part": one.part, "doubled": one.doubled}
            row |= {f"start_{n}": value for n, value in enumerate(one.start.tolist(), 1)}
            *others, last = one.ahead.tolist() or [np.nan]
            rows.append(row | {"ahead": last} | {f"ahead_{n}": value for n, value in enumerate(others, 1)})
        return pd.DataFrame(rows)

    @cached_property
    def hysteresis(self) -> tuple[Interval, ...]:
        """Intervals (SI) of the parameter where a cycle of the branch and steady sliding are both stable."""
        values = [one.value for one in self.points]
        both = [with_stable_sliding(one, values, self._problem_at) for one in with_stable_cycles(self.points)]
        return tuple(joined([one for several in both for one in several]))

    def _problem_at(self, value: float) -> Problem:
        return self.start.scenario.problem.parameters[self.parameter.name].put(value)

    @property
    def hysteresis_text(self) -> str:
        """Say in one sentence where steady sliding and a cycle are both stable; "" if they are so nowhere."""
        unit = self.parameter.unit
        given_up = self.points[-1].value if self.points[-1].edge in GIVEN_UP else np.nan
        ends = [
            [f"{word if end == given_up else ''}{brief(end, unit, 10)}" for word, end in zip(BOUNDS, one, strict=True)]
            for one in self.hysteresis
        ]
        between = [" and ".join(both) for both in ends]
        if not between:
            return ""
        where = f"between {self.parameter.name} = {', and between '.join(between)}"
        return f"hysteresis {where}: steady sliding and a cycle are both stable, and the contact keeps to the one it came from"

    @property
    def interrupted_text(self) -> str:
        """Say in one sentence where it ended before its end, and why; "" if it did not."""
        at = f"{self.parameter.name} = {brief(self.points[-1].value, self.parameter.unit)}"
        goes_on = "the branch can go on there, from its table (--resume)"
        if self.is_full:
            cure = "give fewer steps or a nearer end (to)" + (f", or {goes_on}" if self.start.orbit.is_kept else "")
            return f"ended at {at} with as many cycles as are followed at once: {cure}"
        if not self.interrupted:
            return ""
        return f"interrupted at {at}" + (f": {goes_on}" if self.start.orbit.is_kept else "")

    @property
    def text(self) -> str:
        """Say in one sentence how far the branch goes."""
        values = [one.value for one in self.points]
        low, high = (brief(value, self.parameter.unit, 9) for value in (min(values), max(values)))
        kinds = [stable for stable, _ in groupby(one.stable for one in self.points if not one.edge)]
        words = {True: "stable", False: "unstable", None: "neutral"}
        return (
            f"{len(values)} cycles between {self.parameter.name} = {low} and {high}: {', then '.join(words[one] for one in kinds)}"
        )

    @property
    def edge_texts(self) -> tuple[str, ...]:
        """Say of each edge in one sentence where it is and what happens there."""
        return tuple(
            f"{edge.name} at {self.parameter.name} = {brief(edge.value, self.parameter.unit, 10)}: {MEANING[edge.name]}"
            for edge in self.edges
        )

    def _about(self) -> Iterable[str]:
        return tuple(text for text in self._sentences() if text)

    def _sentences(self) -> Iterable[str]:
        return self.text, *self.edge_texts, self.hysteresis_text, self.interrupted_text

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.cycles.figures.branch import draw_branch

        return draw_branch
