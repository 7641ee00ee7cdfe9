"""Ask whether an edge holds in longer runs: what happens at the start of a run dies out slowly beside an edge.

The two ends of the last bracket are run for twice the time. If they give something else, the runs were short, and the edge is
looked for again in the longer ones, unless the duration was given.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol, TypeVar

from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief

MOST_DOUBLED = 5
"""Largest number of times that the duration is doubled."""
WIDER = 8.0, 4.0
"""An edge that has moved is looked for within the first number times the bracket, and then in steps that grow by the second."""


class FoundEdge(Protocol):
    """The last bracket of a search."""

    @property
    def low(self) -> float:
        """The lower end (SI)."""
        ...

    @property
    def high(self) -> float:
        """The upper end (SI)."""
        ...

    @property
    def at_low(self) -> bool | int:
        """What the run gave at the lower end."""
        ...

    @property
    def at_high(self) -> bool | int:
        """What the run gave at the upper end."""
        ...

    @property
    def unit(self) -> str:
        """The unit of both ends."""
        ...


Edge = TypeVar("Edge", bound=FoundEdge)


class SearchByRuns(Protocol[Edge]):
    """A search by runs of one duration (s)."""

    @property
    def duration(self) -> float:
        """The duration of the runs (s)."""
        ...

    def at(self, value: float) -> bool | int:
        """Return what a run gives at a value."""
        ...

    def edge(self, low: float, high: float, within: float) -> Edge:
        """Return the edge between two values."""
        ...

    def longer(self, factor: float) -> SearchByRuns[Edge]:
        """Return the same search by longer runs."""
        ...


def held_in_longer_runs(search: SearchByRuns[Edge], edge: Edge, span: tuple[float, float], within: float, *, given: bool) -> Edge:
    """Return an edge as it is in runs that are long enough, with a sentence in `longer`.

    `span` are the ends of the search. If the duration was `given`, the edge stays, and the sentence says whether it holds.
    """
    short = list[str]()
    for _ in range(MOST_DOUBLED):
        lasts, twice = (brief(factor * search.duration, "s") for factor in (1.0, 2.0))
        told = f" ({'; '.join(short)})" if short else ""
        longer = search.longer(2.0)
        try:
            if longer.at(edge.low) == edge.at_low and longer.at(edge.high) == edge.at_high:
                return replace(edge, longer=f"runs of {twice} give the same at both ends{told}")  # type: ignore[type-var]
            if given:
                moved = edge.low if longer.at(edge.low) != edge.at_low else edge.high
                why = f"runs of {lasts} are short: at {brief(moved, edge.unit, 6)} those of {twice} give something else"
                return replace(edge, longer=f"{why}; leave the duration out, or give a longer one")  # type: ignore[type-var]
            short.append(f"runs of {lasts} were short: {brief(edge.low, edge.unit, 6)}")
            low, high = _bracket(longer, edge, span)
            search, edge = longer, longer.edge(low, high, within)
        except InputError as error:
            return replace(edge, longer=f"whether runs of {twice} give the same is not known: {error}")  # type: ignore[type-var]
    return replace(edge, longer=f"it still moved when the runs were made longer{told}")  # type: ignore[type-var]


def _bracket(longer: SearchByRuns[Edge], edge: Edge, span: tuple[float, float]) -> tuple[float, float]:
    """Return two values between which longer runs change. Raises InputError if there are none in the search."""
    down = longer.at(edge.low) != edge.at_low
    known, wanted, end = (edge.low, edge.at_low, span[0]) if down else (edge.high, edge.at_high, span[1])
    step = WIDER[0] * (edge.high - edge.low) * (-1.0 if down else 1.0)
    value = known
    while longer.at(value) != wanted:
        if value == end:
            raise InputError(
                f"they give the same at both ends of the search, {brief(span[0], edge.unit)} and {brief(span[1], edge.unit)}"
            )
        known, value, step = value, max(value + step, end) if down else min(value + step, end), step * WIDER[1]
    return (value, known) if down else (known, value)
