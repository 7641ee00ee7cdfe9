"""A branch of cycles while it is followed: its steps, its edges, and the parts that join there."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from stickslip.extensions.cycles.branch import PointOnBranch
from stickslip.extensions.cycles.doubling import MOST_DOUBLED, end_of_doubling, first_doubled
from stickslip.extensions.cycles.edges import (
    DOUBLING,
    END_OF_HUNTING,
    FIRST_STICK,
    GRAZING,
    LOSS_OF_STICK,
    NOT_FOUND,
    STEADY_END,
    CycleEdge,
    edges_between,
    end_in_steady_sliding,
    first_stick,
    loss_of_stick,
)
from stickslip.extensions.cycles.found import is_of_kind, kind_of
from stickslip.extensions.cycles.hunting import end_of_hunting
from stickslip.extensions.cycles.lag import usual_rate
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.measures import measures_of
from stickslip.extensions.cycles.meeting import with_other_impacts, with_rest, without_rest
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.extensions.cycles.reaching import STRAIGHT, at_end_of_range, between, first_place, past_end
from stickslip.extensions.cycles.resuming import (
    edge_of,
    is_at_its_end,
    step_to_go_on,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import ParameterPath
from stickslip.run import TextProgress

MOST_POINTS = 200
"""The largest number of cycles (1) that are followed at once."""
LONGER, SHORTER, SHORTEST = 1.5, 0.5, 1e-4
"""By what factors steps grow and shrink, and the shortest (1, of the range and of the extent of the first cycle)."""
SHARE_OF_EXTENT = 0.25
"""A step moves the start of a cycle by no more than this share (1) of its extent."""
SAME_PERIOD = 0.3
"""A step is too long if the period changes by more than this share (1)."""
VANISHING = 2e-3
"""A cycle whose amplitude is below this share (1) of the pull rate ends in steady sliding, or of a free slip at a set point."""
JOINING = (LOSS_OF_STICK, FIRST_STICK, GRAZING)
"""Edges behind which another part of a branch begins."""
MOST_PARTS = 8
"""Largest number of parts of a branch (1), between corners and edges where stick is lost or begins."""


class FullBranchError(Exception):
    """No more cycles are followed at once."""


class Recent(NamedTuple):
    """Values (SI) of the parameter and amplitudes (m/s) of the cycles at the end of a part of a branch."""

    values: Floats
    amplitudes: Floats


@dataclass
class Following:
    """A branch while it is followed."""

    cycle: LimitCycle
    parameter: ParameterPath
    ends: tuple[float, float]
    steps: int
    tell: TextProgress
    double: bool = False
    points: list[PointOnBranch] = field(default_factory=list)
    edges: list[CycleEdge] = field(default_factory=list)
    had: int = 0
    """The number (1) of cycles that an earlier branch has followed."""
    number: int = 0
    """The number (1) of the part: one more for each that begins at a period doubling."""
    doubled: int = 0
    """How often the period has doubled (1)."""
    doublings: list[tuple[int, Path, CycleEdge]] = field(default_factory=list)
    """Where the period doubles: how often it has done so before, the path, and the edge."""

    @property
    def span(self) -> float:
        """The range of the parameter, SI."""
        return abs(self.ends[1] - self.ends[0])

    def run(self, earlier: list[PointOnBranch]) -> None:
        """Follow all parts of the branch, from the end of earlier cycles on if there are any."""
        path, start = first_place(self.cycle, self.parameter, self.ends)
        if earlier and is_at_its_end(earlier, self.ends):
            self._taken_over(path, earlier)
            self._next_doubled()
            return
        length = 1.0 / self.steps
        if earlier:
            self._taken_over(path, earlier)
            path, start, length = step_to_go_on(path, earlier[-1])
        else:
            self._add(path, start, length)
        part: tuple[Path, PlaceOnBranch] | None = (path, start)
        for _ in range(MOST_PARTS):
            if part is None or self.doubled:
                break
            path, start = part
            part = self._part(path, start, length)
            length = 1.0 / self.steps
            if part is not None and past_end(part[1].value, self.ends) is not None:
                break  # the next one begins beyond the range
            if part is not None:
                self._add(*part, length)
        else:
            if part is not None:
                self._edge(CycleEdge(NOT_FOUND, part[1].value, part[1].orbit))
        if self.doubled:
            self._part(path, start, length)
        self._next_doubled()

    def _taken_over(self, path: Path, earlier: list[PointOnBranch]) -> None:
        """Take over earlier cycles with their edges."""
        self.points, self.had = list(earlier), len(earlier)
        self.number, self.doubled = earlier[-1].part, earlier[-1].doubled
        for one in [one for one in earlier if one.edge]:
            self.edges.append(edge_of(one, path.cut(at_onset=one.at_onset)))
            self._note(path.cut(at_onset=one.at_onset), self.edges[-1], one.doubled)

    def _note(self, path: Path, edge: CycleEdge, doubled: int) -> None:
        """Note where a branch of cycles of twice the period begins, if they are wished."""
        if self.double and edge.name == DOUBLING and doubled < MOST_DOUBLED:
            self.doublings.append((doubled, path, edge))

    def _next_doubled(self) -> None:
        """Follow the cycles of twice the period from the doublings that are left."""
        while self.number < len(self.doublings):
            doubled, path, edge = self.doublings[self.number]
            self.number, self.doubled = self.number + 1, doubled + 1
            begun = first_doubled(path, edge)
            if begun is not None:
                self._add(path, begun, 1.0 / self.steps)
                self._part(path, begun, 1.0 / self.steps)

    def _add(self, path: Path, place: PlaceOnBranch, length: float) -> None:
        """Add a cycle of a branch, and the length (1) of the step that leads on from it."""
        if len(self.points) - self.had >= MOST_POINTS:
            raise FullBranchError
        self._keep(place, "", length * place.way * path.scales if place.orbit.is_kept else np.zeros(0))

    def _keep(self, place: PlaceOnBranch, edge: str, ahead: Floats) -> None:
        """Keep a cycle, which may be an edge, and the step ahead from there."""
        orbit = place.orbit
        start = np.array(orbit.place) if orbit.is_kept else np.zeros(0)
        numbers = place.value, measures_of(orbit), orbit.multipliers, orbit.sticks, edge
        self.points.append(PointOnBranch(*numbers, self.number, self.doubled, start, ahead))
        at = brief(place.value, self.parameter.unit)
        self.tell(f"{self.parameter.name} = {at}: period {brief(orbit.period, 's')}")

    def _edge(self, edge: CycleEdge) -> None:
        self.edges.append(edge)
        self._keep(PlaceOnBranch(edge.value, edge.orbit, np.zeros(0)), edge.name, np.zeros(0))

    def _part(self, path: Path, now: PlaceOnBranch, length: float) -> tuple[Path, PlaceOnBranch] | None:
        """Follow a part of the branch behind its last cycle, by a first step of this length (1).

        Returns where the next one begins, or None at its end.
        """
        while True:
            *_, before, amplitude = [0.0, 0.0, *self._recent().amplitudes]
            if amplitude < min(VANISHING * usual_rate(now.orbit.section.problem), before):
                return self._at_end(path, now)
            step = min(length, path.longest_step(now, SHARE_OF_EXTENT))
            shortest = SHORTER * step < SHORTEST * min(1.0, path.longest_step(now, 1.0))
            new = self._stepped(path, now, step, shortest=shortest)
            if new is None:
                last = at_end_of_range(path, now, step, self.ends)
                if last is not None:
                    self._add_last(path, now, last)
                    return None
                if shortest:
                    return self._at_end(path, now)
                length = SHORTER * step
                continue
            halves = end_of_doubling(path, now, new)
            if halves is not None and past_end(halves.value, self.ends) is None:
                self._edge(halves)
                return None
            if halves is None and kind_of(new.orbit) != kind_of(now.orbit):  # once more round, but it is not found where it begins
                return self._at_end(path, now)
            if past_end(new.value, self.ends) is not None:
                last = between(path, now, new, self.ends)
                if last is not None:
                    self._add_last(path, now, last)
                return None
            for edge in edges_between(path, now, new, step):
                self._edge(edge)
                self._note(path, edge, self.doubled)
            length = min(LONGER * step, 2.0 / self.steps)
            self._add(path, new, length)
            now = new

    def _recent(self) -> Recent:
        """Return the cycles at the end of the part that is followed, without edges."""
        since = list(takewhile(lambda one: one.part == self.number and one.edge not in JOINING, reversed(self.points)))
        here = [one for one in reversed(since) if not one.edge]
        return Recent(np.array([one.value for one in here]), np.array([one.measures.amplitude for one in here]))

    def _stepped(self, path: Path, now: PlaceOnBranch, step: float, *, shortest: bool) -> PlaceOnBranch | None:
        """Return the next cycle; None if the step is too long. The shortest may change the period of a cycle that rests."""
        try:
            new = path.step(now, step)
        except NoCycleError:
            return None
        same = abs(new.orbit.period - now.orbit.period) <= SAME_PERIOD * now.orbit.period
        # Next to where rest is grazed a branch turns at once.
        straight = abs(float(new.way @ now.way)) >= STRAIGHT or (shortest and path.at_onset and same)
        same = same or (shortest and path.at_onset)
        if not (same and straight) or not is_of_kind(new.orbit, now.orbit, exactly=not shortest):
            return None
        return new if new.way @ now.way > 0.0 else replace(new, way=-new.way)

    def _add_last(self, path: Path, now: PlaceOnBranch, last: PlaceOnBranch) -> None:
        """Add the cycle at the end of the range, and the edges before it."""
        length = float(np.linalg.norm(path.together(last.orbit.place, last.value) - path.together(now.orbit.place, now.value)))
        for edge in edges_between(path, now, last, length):
            self._edge(edge)
            self._note(path, edge, self.doubled)
        self._add(path, last, 1.0 / self.steps)

    def _at_end(self, path: Path, now: PlaceOnBranch) -> tuple[Path, PlaceOnBranch] | None:
        """Say why a part of the branch ends, and return where the next one begins; None if none does."""
        end = path.end_beyond(now)
        if end is not None:
            if end.edge is not None:
                self._edge(end.edge)
            onward: tuple[Path, PlaceOnBranch] | None = end.onward
            return onward
        gone, sizes = end_of_hunting(path, now), self._recent().amplitudes
        if gone is not None and sizes[-1] < sizes[0]:
            self._edge(CycleEdge(END_OF_HUNTING, gone, now.orbit))
            return None
        if path.at_onset or now.orbit.section.problem.body.has_stops:
            beyond = now.value + np.sign(now.way[-1]) * max(2.0 * SHORTEST, 1.0 / self.steps) * self.span
            end = past_end(float(beyond), self.ends)
            edge, last = loss_of_stick(path, now, float(beyond) if end is None else end)
            if path.at_onset or edge.name == GRAZING:
                self._edge(edge)
                return (with_other_impacts if edge.name == GRAZING else without_rest)(path, edge, last)
        found = end_in_steady_sliding(path, *self._recent())
        if found is not None:
            self._edge(CycleEdge(STEADY_END, found, now.orbit))
            return None
        if now.orbit.section.problem.friction.sticks and not now.orbit.sticks:
            touched = first_stick(path, now)
            if touched is not None:
                self._edge(touched[0])
                came_up = bool(np.all(np.diff([one.value for one in self.points[-2:]]) >= 0.0))
                return with_rest(path, *touched, came_up=came_up) if path.joins else path.rest_begun(touched[0])
        self._edge(CycleEdge(NOT_FOUND, now.value, now.orbit))
        return None
