"""Follow a cycle along one number of its problem: `ss.studies.follow`."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from stickslip.engine import Positions
from stickslip.extensions.cycles.asked import CYCLE_KINDS
from stickslip.extensions.cycles.branch import BranchOfCycles, PointOnBranch
from stickslip.extensions.cycles.edges import (
    NOT_FOUND,
    STEADY_END,
    CycleEdge,
    edges_between,
    end_in_steady_sliding,
    first_stick,
    loss_of_stick,
)
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.measures import measures_of
from stickslip.extensions.cycles.orbit import extent_of
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.extensions.cycles.section import coordinates, passages
from stickslip.extensions.cycles.tangent import values_at
from stickslip.foundation.arguments import for_users
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import ParameterPath, find_parameter
from stickslip.run import TextProgress, telling

STEPS, MOST_POINTS = 40, 200
"""About how many steps cross the range (1), and the largest number of cycles on a branch."""
LONGER, SHORTER, SHORTEST = 1.5, 0.5, 1e-4
"""By what factors steps grow and shrink, and the shortest (1, of the range and of the extent of the first cycle)."""
SHARE_OF_EXTENT = 0.25
"""A step moves the start of a cycle by no more than this share (1) of its extent."""
STRAIGHT, SAME_PERIOD = 0.8, 0.3
"""A step is too long if the branch turns by more than this cosine (1), or the period changes by more than this share."""
VANISHING = 2e-3
"""A cycle whose amplitude is below this share (1) of the pull rate ends in steady sliding."""
NEXT_TO_EDGE = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Distances (1, shares of the range) from an edge, where a branch is taken up again, with or without rest."""
CLOSE_PERIOD = 0.1
"""Cycles that meet at an edge have periods that differ by no more than this share (1), next to it."""
MOST_PARTS = 4
"""Largest number of parts of a branch (1), which alternately rest and do not."""


@for_users
def follow(
    cycle: LimitCycle,
    along: str = "pull_rate",
    *,
    to: float | str | WithUnit,
    steps: int = STEPS,
    progress: TextProgress | bool | None = None,
) -> BranchOfCycles:
    """Follow a cycle along one number of its problem, through folds, with the edges where it changes.

    Parameters
    ----------
    cycle : LimitCycle
        The cycle where the branch begins, from `stickslip.studies.cycle`.
    along : str
        The parameter that is varied, as in a sweep: "pull_rate", "body.stiffness", "friction.parameters.v1" ...
    to : float or str
        Its value (SI, or a text with a unit) at the other end. Behind a fold the branch may come back to where it began.
    steps : int
        About how many steps cross the range.
    progress : bool or callable, optional
        True shows the progress in one line; a function is called with a line of text after each cycle.

    Returns
    -------
    BranchOfCycles
        The cycles in their order along the branch, and its edges.

    Raises
    ------
    InputError
        If the parameter is unknown or is no number, or if there is no other value to go to.
    KeyboardInterrupt
        If the user presses Ctrl-C.

    Notes
    -----
    Start and parameter are changed together along the branch (pseudo-arclength), so that it can turn back. Edges: a fold of cycles
    (multiplier +1), period doubling (-1), Neimark-Sacker (a pair on the unit circle), loss of stick (the arrest is grazed), first
    stick, and steady sliding, where a cycle vanishes. Branches that begin at an edge are not followed, but for those with and
    without rest that meet where stick is lost.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
    >>> block = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=2.0)
    >>> start = ss.studies.cycle(ss.Problem(block, law, pull_rate=0.28, initial_load=0.0))
    >>> branch = ss.studies.follow(start, "pull_rate", to=0.35, steps=4)
    >>> print([f"{edge.name} at {edge.value:.6f} m/s" for edge in branch.edges])
    ['loss of stick at 0.302222 m/s']
    """
    if not isinstance(cycle, LimitCycle):
        raise InputError(f"follow: needs a cycle, as ss.studies.cycle finds it, got {type(cycle).__name__}")
    parameter = find_parameter(cycle.scenario, along, "follow")
    if not isinstance(parameter.declared, Quantity) or parameter.name.startswith(("initial.", "run.")):
        raise InputError(f"follow: {parameter.name} is no number on which a cycle depends: give one of the body, law or loading")
    begin = number_of(cycle, parameter)
    end = float(parameter.declared.check("follow", "to", to))
    if end == begin:
        raise InputError(f"follow: to: {parameter.name} is {brief(begin, parameter.unit)} already: give another value")
    if steps < 1:
        raise InputError(f"follow: steps must be 1 or more, got {steps}")
    with telling(progress, "follow") as tell:
        search = _Following(cycle, parameter, (begin, end), steps, tell)
        search.run()
    return BranchOfCycles(cycle, parameter, tuple(search.points), tuple(search.edges), end)


def number_of(cycle: LimitCycle, parameter: ParameterPath) -> float:
    """Return the value (SI) of a parameter of the cycle's problem."""
    return float(cycle.scenario.problem.parameters[parameter.name].value)


@dataclass
class _Following:
    """A branch while it is followed."""

    cycle: LimitCycle
    parameter: ParameterPath
    ends: tuple[float, float]
    steps: int
    tell: TextProgress
    points: list[PointOnBranch] = field(default_factory=list)
    edges: list[CycleEdge] = field(default_factory=list)

    @property
    def span(self) -> float:
        """The range of the parameter, SI."""
        return abs(self.ends[1] - self.ends[0])

    def run(self) -> None:
        """Follow all parts of the branch."""
        orbit = self.cycle.orbit
        path = CYCLE_KINDS[self.cycle.problem.body.structure].path(orbit, self.cycle.scenario, self.parameter, self.span)
        start = path.at_value(self.ends[0], orbit.place, orbit.period)
        if start.way[-1] * (self.ends[1] - self.ends[0]) < 0.0:
            start = replace(start, way=-start.way)
        part: tuple[Path, PlaceOnBranch] | None = (path, start)
        for _ in range(MOST_PARTS):
            if part is None:
                return
            part = self._part(*part)

    def _add(self, place: PlaceOnBranch, edge: str = "") -> None:
        if len(self.points) >= MOST_POINTS:
            raise InputError(f"follow: the branch has more than {MOST_POINTS} cycles: give fewer steps, or a nearer end (to)")
        self.points.append(PointOnBranch(place.value, measures_of(place.orbit), place.orbit.multipliers, place.orbit.sticks, edge))
        period, at = brief(place.orbit.period, "s"), brief(place.value, self.parameter.unit)
        self.tell(f"{self.parameter.name} = {at}: period {period}")

    def _edge(self, edge: CycleEdge) -> None:
        self.edges.append(edge)
        self._add(PlaceOnBranch(edge.value, edge.orbit, np.zeros(0)), edge.name)

    def _part(self, path: Path, now: PlaceOnBranch) -> tuple[Path, PlaceOnBranch] | None:
        """Follow a part of the branch; return where the next one begins, or None at its end."""
        self._add(now)
        length, amplitudes = 1.0 / self.steps, [self.points[-1].measures.amplitude]
        values, low, high = [now.value], min(self.ends), max(self.ends)
        while True:
            step = min(length, path.longest_step(now, SHARE_OF_EXTENT))
            new = self._stepped(path, now, step)
            if new is None:
                length = SHORTER * step
                if length >= SHORTEST * min(1.0, path.longest_step(now, 1.0)):
                    continue
                return self._at_end(path, now, values, amplitudes)
            if not low <= new.value <= high:
                self._to_the_end(path, now, new)
                return None
            for edge in edges_between(path, now, new, step):
                self._edge(edge)
            self._add(new)
            amplitudes.append(self.points[-1].measures.amplitude)
            values.append(new.value)
            now, length = new, min(LONGER * step, 2.0 / self.steps)
            if amplitudes[-1] < VANISHING * now.orbit.section.problem.first_pull_rate and amplitudes[-1] < amplitudes[-2]:
                return self._at_end(path, now, values, amplitudes)

    def _stepped(self, path: Path, now: PlaceOnBranch, step: float) -> PlaceOnBranch | None:
        """Return the next cycle; None if the step is too long."""
        try:
            new = path.step(now, step)
        except NoCycleError:
            return None
        same = abs(new.orbit.period - now.orbit.period) <= SAME_PERIOD * now.orbit.period
        straight = abs(float(new.way @ now.way)) >= STRAIGHT
        if not (same and straight) or new.orbit.sticks != now.orbit.sticks:
            return None
        return new if new.way @ now.way > 0.0 else replace(new, way=-new.way)

    def _to_the_end(self, path: Path, now: PlaceOnBranch, new: PlaceOnBranch) -> None:
        """Add the cycle at the end of the range that a step has passed, and the edges before it."""
        value = min(max(new.value, min(self.ends)), max(self.ends))
        share = (value - now.value) / (new.value - now.value)
        guess = now.orbit.place + share * (new.orbit.place - now.orbit.place)
        try:
            last = path.at_value(value, guess, now.orbit.period, now.way)
        except NoCycleError:
            return
        length = float(np.linalg.norm(path.together(last.orbit.place, value) - path.together(now.orbit.place, now.value)))
        for edge in edges_between(path, now, last, length):
            self._edge(edge)
        self._add(last)

    def _at_end(
        self, path: Path, now: PlaceOnBranch, values: list[float], amplitudes: list[float]
    ) -> tuple[Path, PlaceOnBranch] | None:
        """Say why a part of the branch ends, and return where the next one begins; None if none does."""
        end = path.end_beyond(now)
        if end is not None:
            self._edge(end)
            return None
        if path.at_onset:
            beyond = now.value + np.sign(now.way[-1]) * max(2.0 * SHORTEST, 1.0 / self.steps) * self.span
            edge, last = loss_of_stick(path, now, float(beyond))
            self._edge(edge)
            return self._without_rest(path, edge, last)
        small = amplitudes[-1] < 0.05 * now.orbit.section.problem.first_pull_rate
        if len(values) > 1 and small and amplitudes[-1] < amplitudes[-2]:
            found = end_in_steady_sliding(path, np.array(values), np.array(amplitudes))
            if found is not None:
                self._edge(CycleEdge(STEADY_END, found, now.orbit))
                return None
        if now.orbit.section.problem.friction.sticks and not now.orbit.sticks:
            touched = first_stick(path, now)
            if touched is not None:
                self._edge(touched[0])
                return self._with_rest(path, *touched) if path.joins else None
        self._edge(CycleEdge(NOT_FOUND, now.value, now.orbit))
        return None

    def _without_rest(self, path: Path, edge: CycleEdge, last: PlaceOnBranch) -> tuple[Path, PlaceOnBranch] | None:
        """Return where cycles without rest begin, at an edge where stick is lost."""
        met = passages(last.orbit.closed.history)
        if not len(met.time):
            return None
        at = values_at(last.orbit.closed.history, Positions.inside(met.piece[:1], met.place[:1]))
        place = coordinates(at, at_onset=False)[:, 0]
        other = self._other(path, edge, at_onset=False)
        along = np.eye(len(other.scales))[0]  # the load where the pull rate is passed is the largest: less of it does not graze
        for share in NEXT_TO_EDGE:
            target = other.together(place, edge.value) - share * along
            try:
                found = other.at(target, along, edge.orbit.period)
            except NoCycleError:
                continue
            if _is_next_to(edge, found, at_onset=False):
                return other, found if found.way[0] < 0.0 else replace(found, way=-found.way)
        return None

    def _with_rest(self, path: Path, edge: CycleEdge, last: PlaceOnBranch) -> tuple[Path, PlaceOnBranch] | None:
        """Return where cycles with rest begin, at an edge where the slip rate touches 0; under laws with states none is found."""
        if last.orbit.section.problem.friction.states:
            return None
        other = self._other(path, edge, at_onset=True)
        came_up = len(self.points) > 1 and self.points[-1].value >= self.points[-2].value
        for share in NEXT_TO_EDGE:
            for sign in (1.0, -1.0) if came_up else (-1.0, 1.0):
                value = edge.value + sign * share * self.span
                try:
                    found = other.at_value(value, np.zeros(0), edge.orbit.period)
                except NoCycleError:
                    continue
                if _is_next_to(edge, found, at_onset=True):
                    return other, found if found.way[-1] * sign > 0.0 else replace(found, way=-found.way)
        return None

    def _other(self, path: Path, edge: CycleEdge, *, at_onset: bool) -> Path:
        """Return the path of cycles next to an edge that are cut at the other section."""
        extent = extent_of(edge.orbit.closed.history, at_onset, edge.orbit.closed.piece)
        return replace(path, at_onset=at_onset, scales=np.append(extent, self.span))


def _is_next_to(edge: CycleEdge, found: PlaceOnBranch, *, at_onset: bool) -> bool:
    """Return True if a cycle may be the one that meets another at an edge."""
    return abs(found.orbit.period - edge.orbit.period) <= CLOSE_PERIOD * edge.orbit.period and found.orbit.sticks == at_onset
