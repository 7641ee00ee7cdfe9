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

from stickslip.extensions.cycles.edges import MEANING, CycleEdge
from stickslip.extensions.cycles.limit_cycle import LimitCycle, is_stable, row_of
from stickslip.extensions.cycles.measures import Measures
from stickslip.foundation.show import brief
from stickslip.problem import Problem
from stickslip.problem.scenarios import ParameterPath
from stickslip.run import Study


class PointOnBranch(NamedTuple):
    """A cycle on a branch: the value (SI) of the parameter, its numbers, and the name of the edge if it is one."""

    value: float
    measures: Measures
    multipliers: NDArray[Any]
    sticks: bool
    edge: str

    @property
    def stable(self) -> bool | None:
        """Whether its disturbances fade."""
        return is_stable(self.multipliers)


@dataclass(frozen=True, eq=False, repr=False)
class BranchOfCycles(Study):
    """The result of `follow`: the cycles along a branch in their order, and its edges.

    `table` has a row for each: the parameter, then the columns of `LimitCycle.table`, and edge, the name of an edge or "", in SI.
    """

    start: LimitCycle
    parameter: ParameterPath = field(compare=False)
    points: tuple[PointOnBranch, ...] = field(compare=False)
    edges: tuple[CycleEdge, ...] = field(compare=False)
    """The edges in their order: name, value (SI) of the parameter, and the cycle next to it."""
    to: float = np.nan

    @property
    def problem(self) -> Problem:
        """The problem at the beginning of the branch."""
        return self.start.problem

    @cached_property
    def table(self) -> pd.DataFrame:
        """The cycles along the branch, in SI."""
        rows = [
            {self.parameter.name: one.value} | row_of(one.measures, one.multipliers) | {"edge": one.edge} for one in self.points
        ]
        return pd.DataFrame(rows)

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
        return tuple(self._sentences())

    def _sentences(self) -> Iterable[str]:
        return self.text, *self.edge_texts

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.cycles.figures.branch import draw_branch

        return draw_branch
