"""Find an edge along one parameter by bisection on exact runs: where stick-slip, a slip event or a number of pulses changes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.contact import FROM_REST_WITHIN, FromRest, SteadySlidings, steady_slidings
from stickslip.engine import share_sticking
from stickslip.foundation.arguments import for_users
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.problem import INITIAL_STATES, STEADY, Problem
from stickslip.problem.scenarios import ParameterPath, Scenario, find_parameter, read_source
from stickslip.run.longer_runs import held_in_longer_runs
from stickslip.run.simulate import simulate
from stickslip.run.study import StudyWithDataset, TextProgress, telling, uninterrupted
from stickslip.solution import Solution

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

WHAT: dict[str, Callable[[Solution], bool | int]] = {
    "sticking": lambda run: share_sticking(run.history) > 0.0,
    "events": lambda run: len(run.events),
    "pulses": lambda run: int(run.events.pulses.sum()),
}
"""What may change along a parameter: whether the contact sticks in the last third of a run, how many events or pulses it has."""
SETTLED_OUTCOME = "sticking"
"""That of them which is asked of the end of a run, and should not depend on its length."""
WITHIN = 1e-3
"""Default width of the last bracket, as a share of its upper end."""
MOST_DOUBLINGS = 12
"""Largest number of times that a range is doubled where no upper end is given."""
CYCLES = 100
"""Duration of the runs from rest, in times that a cycle of stick-slip takes at the critical rate."""
UNSETTLED = "without load, in the state of steady sliding, because only rounding would disturb the problem's own steady sliding"
"""How runs start that would begin in steady sliding, and why."""
MOST_PIECES = 100_000
"""Largest number of pieces of each run from rest."""

What = str | Callable[[Solution], Any]
"""A name in WHAT, or a function of a solution that returns True or False, or a whole number."""


@dataclass(frozen=True, repr=False)
class Edge(StudyWithDataset):
    """The result of `find`: the last bracket, between whose ends what was looked for changes."""

    parameter: str
    """Full name of the parameter."""
    unit: str
    what: str
    low: float
    high: float
    """Values of the parameter (SI) at the two ends."""
    at_low: bool | int
    at_high: bool | int
    """What the exact runs gave there."""
    table: pd.DataFrame = field(compare=False)
    """The runs, in the order in which they were made: the parameter (SI), and what they gave."""
    duration: float = math.nan
    """Duration of the runs (s)."""
    meaning: str = ""
    """Declared meaning of the parameter."""
    start: str = ""
    """How the runs started, if not as the problem does."""
    longer: str = ""
    """Whether longer runs give the same at both ends; "" if that was not asked for."""

    @property
    def runs(self) -> int:
        """The number of runs."""
        return len(self.table)

    @property
    def text(self) -> str:
        """Say in one sentence where the edge is."""
        ends = f"{brief(self.low, self.unit, 9)} and {brief(self.high, self.unit, 9)}"
        changes = f"{self.what}: {_word(self.at_low)} below, {_word(self.at_high)} above"
        runs = f"{self.runs} exact runs of {brief(self.duration, 's')}"
        starts = f", which start {self.start}" if self.start else ""
        return f"between {self.parameter} = {ends} ({changes}), by {runs}{starts}" + (f"; {self.longer}" if self.longer else "")

    def _about(self) -> Iterable[str]:
        return (self.text, f"{self.parameter} in {self.unit}" if self.unit not in ("", "1") else "")

    def to_dataset(self) -> xr.Dataset:
        """Return what `plot` draws, in SI units."""
        from stickslip.figures.runs import find as drawn

        return drawn.edge_data(self)

    def _figure(self) -> Callable[..., Any]:
        from stickslip.figures.runs import find as drawn

        return drawn.draw_edge

    def _sentences(self) -> Iterable[str]:
        return (self.text,)


def _word(value: bool | int) -> str:
    return ("yes" if value else "no") if isinstance(value, bool) else str(value)


def unsettled(problem: Problem) -> Problem:
    """Return a problem that starts without load, in the state of steady sliding, in place of one that starts in steady sliding."""
    if not (problem.has_initial_rate and problem.starts_steadily):
        return problem
    states: dict[str, Any] = dict.fromkeys(INITIAL_STATES[: len(problem.friction.states)], STEADY)
    return replace(problem, initial_rate=None, initial_load=0.0, **states)


@for_users
def find(
    problem: Problem | Scenario | str | Path,
    along: str = "pull_rate",
    low: float | str | WithUnit | None = None,
    high: float | str | WithUnit | None = None,
    *,
    what: What = "sticking",
    duration: float | str | WithUnit | None = None,
    within: float = WITHIN,
    progress: TextProgress | bool | None = None,
) -> Edge:
    """Find where something changes along one parameter, by bisection on exact runs.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        The problem, its scenario, the name of a bundled scenario, or a scenario file. If it starts in steady sliding, the runs for
        a name in `what` start without load instead: in an exact run only rounding disturbs steady sliding.
    along : str
        The parameter that is varied, as in a sweep: "pull_rate", "body.stiffness", "friction.alpha", "initial.excess" ...
    low, high : float or str, optional
        The two values between which to search (SI, or texts with units). Without them the search along the pull rate begins at
        the rate at which steady sliding becomes stable, and goes up from there.
    what : str or callable
        "sticking": whether the contact rests in the last third of a run (or nearly does, see the quantity of that name in sweeps).
        "events", "pulses": how many there are. Or a function of a `Solution` that returns True or False, or a whole number.
    duration : float or str, optional
        Duration of the runs (s), long enough for what happens at the start to be over. By default it is that of the scenario, and
        for "sticking" it is doubled until runs twice as long give the same at both ends; if it is given, the result says whether.
    within : float
        Width of the last bracket, as a share of its upper end.
    progress : bool or callable, optional
        True shows the progress in one line; a function is called with a line of text after each run.

    Returns
    -------
    Edge
        The two ends of the last bracket, what the runs gave there, and all runs. Between two positive ends the search halves the
        ratio, otherwise the distance. If there are several changes, it finds one of them.

    Raises
    ------
    InputError
        If the runs at both ends give the same, if a run does not reach its end, or if a name is unknown.
    KeyboardInterrupt
        If the user presses Ctrl-C.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
    >>> body = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=2.0)
    >>> axis = ss.Problem(body, law, pull_rate=0.1, initial_load=0.0)
    >>> edge = ss.studies.find(axis, "pull_rate", 0.05, 1.0, duration=20.0, within=0.01)
    >>> edge.at_low, edge.at_high
    (True, False)
    """
    if isinstance(what, str) and what not in WHAT:
        raise InputError(f"find: what: {ascii(what)[:60]} is unknown; {nearest(what, WHAT)} (or a function of a solution)")
    if not 0.0 < within < 1.0:
        raise InputError(f"find: within must lie between 0 and 1, got {within!r}")
    scenario = read_source("find", problem, duration)
    parameter = find_parameter(scenario, along, "find")
    if not isinstance(parameter.declared, Quantity):
        raise InputError(f"find: {parameter.name} is no number that could be halved")
    ends = [None if end is None else parameter.declared.check("find", parameter.name, end) for end in (low, high)]
    with telling(progress, "find") as tell:
        search = _EdgeSearch(scenario, parameter, what, scenario.duration, tell)
        span = search.ends(*ends)
        edge = search.edge(*span, within)
        return held_in_longer_runs(search, edge, span, within, given=duration is not None) if what == SETTLED_OUTCOME else edge


def from_rest(problem: Problem, found: SteadySlidings, tell: TextProgress = lambda text: None) -> FromRest | None:
    """Find up to which pull rate a contact from rest sticks, though steady sliding is stable; None if there is nothing to find.

    A dozen exact runs begin a little above the critical rate. Their number and length depend on the problem alone.
    """
    critical = found.regained
    if not critical:
        return None
    if problem.has_initial_rate:
        problem = replace(problem, initial_rate=None, initial_load=0.0, initial_excess=None)
    body, fall = problem.body, problem.strength - min(abs(one.traction) for one in found.slidings)
    lasts = CYCLES * (body.round_trip_time + max(fall, 0.0) / (body.stiffness * critical))
    scenario = Scenario(problem, lasts)
    search = _EdgeSearch(scenario, find_parameter(scenario, "pull_rate", "steady"), "sticking", lasts, tell, MOST_PIECES)
    sticks, slides, stopped, fastest = None, None, None, fastest_pull(found)
    rate = critical * (1.0 + FROM_REST_WITHIN)
    if rate > fastest:
        return FromRest(None, None, 0, lasts, found.unit, fastest=fastest)
    try:
        for _ in range(MOST_DOUBLINGS):
            if not search.at(math.copysign(rate, found.pull_rate)):
                slides = rate
                break
            sticks, rate = rate, min(2.0 * rate, fastest)
            if sticks == fastest:
                break
        while sticks is not None and slides is not None and slides - sticks > FROM_REST_WITHIN * slides:
            rate = math.sqrt(sticks * slides)
            sticks, slides = (rate, slides) if search.at(math.copysign(rate, found.pull_rate)) else (sticks, rate)
    except InputError:  # a run did not reach its end: what was found before holds
        stopped = rate
    return FromRest(sticks, slides, len(search.seen), lasts, found.unit, stopped, fastest if sticks == fastest else None)


def fastest_pull(found: SteadySlidings) -> float:
    """Return the pull rate (m/s) that makes the body slide as fast as its waves run: faster is not meant; inf without waves."""
    assert found.problem is not None
    changes = [one for one in found.changes if one.pull_rate is not None]
    given_way = max((abs(one.pull_rate) - one.rate for one in changes), default=0.0)  # type: ignore[arg-type] # filtered above
    return found.problem.body.fastest_rate + max(given_way, 0.0)


@dataclass(frozen=True)
class _EdgeSearch:
    """A search for an edge along one parameter of a scenario; `seen` collects the runs."""

    scenario: Scenario
    parameter: ParameterPath
    what: What
    duration: float
    tell: TextProgress
    most_pieces: int | None = None
    seen: dict[float, bool | int] = field(default_factory=dict)

    def longer(self, factor: float) -> _EdgeSearch:
        """Return the same search by runs that last longer by a factor."""
        return replace(self, duration=factor * self.duration, seen={})

    @property
    def name(self) -> str:
        return self.what if isinstance(self.what, str) else getattr(self.what, "__name__", "what")

    def starts(self, problem: Problem) -> Problem:
        """Return a problem as it starts in a run: unless the user looks for something of their own, not in steady sliding."""
        return unsettled(problem) if isinstance(self.what, str) else problem

    def at(self, value: float) -> bool | int:
        """Return what a run with a value (SI) of the parameter gives."""
        if value not in self.seen:
            problem = self.starts(self.scenario.with_values({self.parameter.name: value}).problem)
            run = uninterrupted(simulate(problem, self.duration, max_pieces=self.most_pieces))
            place = f"{self.parameter.name} = {brief(value, self.parameter.unit)}"
            if not run.status.ok:
                raise InputError(f"find: the run at {place} did not reach its end: {run.status}")
            self.seen[value] = _plain(WHAT[self.what](run) if isinstance(self.what, str) else self.what(run), place)
            self.tell(f"{place}: {self.name} {_word(self.seen[value])}")
        return self.seen[value]

    def ends(self, low: float | None, high: float | None) -> tuple[float, float]:
        """Return the two ends of the search, in ascending order; where they are left out, from steady sliding."""
        if low is not None and high is not None:
            if low == high:
                raise InputError(f"find: the two ends of {self.parameter.name} must differ, got {low:g} twice")
            return min(low, high), max(low, high)
        if self.parameter.name != "loading.pull_rate" or (low is None) != (high is None):
            raise InputError(f"find: give two values of {self.parameter.name} between which to look")
        found = steady_slidings(self.scenario.problem)
        gained, fastest = [one.pull_rate for one in found.changes if one.stable_above and one.pull_rate], fastest_pull(found)
        if not gained:
            raise InputError(
                "find: give two pull rates between which to look: there is none at which steady sliding becomes stable"
            )
        least = 0.9 * abs(gained[-1])
        most = min(2.0 * least, fastest) if least < fastest else 2.0 * least
        for _ in range(MOST_DOUBLINGS):
            if self.at(most) != self.at(least) or most == fastest:
                break
            most = min(2.0 * most, fastest)
        return least, most

    def edge(self, low: float, high: float, within: float) -> Edge:
        """Return the edge between two values (SI)."""
        at_low, at_high = self.at(low), self.at(high)
        if at_low == at_high:
            ends = f"{brief(low, self.parameter.unit)} and {brief(high, self.parameter.unit)}"
            raise InputError(
                f"find: at both {self.parameter.name} = {ends} it is {self.name}: {_word(at_low)}; give ends that differ"
            )
        while high - low > within * abs(high):
            middle = math.sqrt(low) * math.sqrt(high) if low > 0.0 else 0.5 * (low + high)
            if not low < middle < high:
                break
            if self.at(middle) != at_low:
                high, at_high = middle, self.at(middle)
            else:
                low = middle
        one, values = self.parameter, list(self.seen.values())
        import pandas as pd  # takes half a second to load, which `check` does not need

        table = pd.DataFrame({one.name: list(self.seen), self.name: values})
        meaning, start = one.declared.meaning, UNSETTLED if self.starts(self.scenario.problem) is not self.scenario.problem else ""
        return Edge(one.name, one.unit, self.name, low, high, at_low, at_high, table, self.duration, meaning, start)


def _plain(value: Any, place: str) -> bool | int:
    """Return what a user's function gave as True, False or a whole number. Raises InputError for anything else."""
    plain = value.item() if hasattr(value, "item") else value
    if isinstance(plain, bool | int):
        return plain
    if isinstance(plain, float) and plain.is_integer():
        return int(plain)
    raise InputError(f"find: what must be True, False or a whole number, got {ascii(plain)[:60]} at {place}")
