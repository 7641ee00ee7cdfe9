"""Summary quantities that a sweep keeps for each member: built-in ones by name, or functions supplied by the user."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import share_sticking
from stickslip.foundation.errors import InputError, nearest, some_of
from stickslip.problem.scenarios import Scenario, check_solved_by_core
from stickslip.run import special_solver_of
from stickslip.solution.observables.severity import severity

if TYPE_CHECKING:
    from stickslip.contact import Uniqueness
    from stickslip.solution import Solution

QUANTITIES_LISTED = "`stickslip sweep --help` lists all"
"""Where all quantities are."""
Of = Callable[["Solution"], Any]
"""A function of a solution that returns a number."""


@dataclass(frozen=True)
class Summary:
    """A number that summarises a whole run: its name and meaning in the dataset of a sweep, its SI unit, and what computes it.

    The units "slip", "slip_rate", "load" and "energy" stand for those of the body (`names.si_unit`). `of` returns it for a
    `Solution`, or NaN where the run has no such number. A flag is 1 for yes and 0 for no. A share runs from 0 to 1, and `ends` says
    in words what these are. Figures draw a line at the number in `line`, which also says in words what lies there.
    """

    name: str
    unit: str
    meaning: str
    of: Of
    is_flag: bool = False
    ends: tuple[str, str] | None = None
    line: tuple[float, str] | None = None

    def value(self, solution: Solution) -> float:
        """Return the quantity of a solution."""
        return float(self.of(solution))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle a built-in quantity by its name, so that another process recognises it as built-in; others by their contents."""
        if QUANTITIES.get(self.name) is self:
            return _built_in, (self.name,)
        return Summary, (self.name, self.unit, self.meaning, self.of, self.is_flag, self.ends, self.line)


def _built_in(name: str) -> Summary:
    return QUANTITIES[name]


def _first(column: str) -> Of:
    return lambda solution: solution.events[column].iloc[0] if len(solution.events) else np.nan


def _at_peak(column: str) -> Of:
    return lambda solution: (
        solution.events[column].iloc[int(solution.events.peak_rate.argmax())] if len(solution.events) else np.nan
    )


def _recurrence(statistic: Callable[[NDArray[np.float64]], Any], least: int) -> Of:
    """Return a statistic of the times from the start of each slip event to the start of the next, if there are enough."""

    def of(solution: Solution) -> Any:
        between = solution.events.recurrence.to_numpy(float)[1:]
        return statistic(between) if len(between) >= least else np.nan

    return of


@lru_cache(maxsize=1)
def _energies(solution: Solution) -> dict[str, float]:
    """Return the energies at the end of a run, kept for the last solution because several quantities ask for them in turn."""
    found = solution.energy(solution.history.duration)
    return {str(name): float(values.item()) for name, values in found.items() if values.dims == ("time",)}  # not of each layer


def _energy(part: str) -> Of:
    return lambda solution: _energies(solution)[part]


def _slip(solution: Solution) -> float:
    return float(solution.slip(solution.history.duration)) - solution.problem.initial_slip


def _sticking(solution: Solution) -> float:
    """Return the share of sticking in the last third of a run; NaN if the run has not reached its end."""
    return share_sticking(solution.history) if solution.status.ok else np.nan


def _severity(solution: Solution) -> float:
    """Return the severity of stick-slip in the last third of a run; NaN if the run has not reached its end."""
    return severity(solution) if solution.status.ok else np.nan


def _uniqueness(solution: Solution) -> Uniqueness:
    from stickslip.contact import uniqueness_of

    return uniqueness_of(solution.problem)


def _irregular(solution: Solution) -> bool:
    from stickslip.contact import regime_of

    return regime_of(solution.problem) != "regular"


IRREGULAR = "several slip rates solve the contact equation at some load, at the initial slip"
STICKING = "share of the last third of the run in which the contact rests, or under a law without rest hardly moves"
SEVERITY = "severity of stick-slip: half the range of the slip rate over its mean, in the last third of the run"
_ALL = (
    Summary("events", "1", "slip events", lambda solution: len(solution.events)),
    Summary("pulses", "1", "pulses of all slip events", lambda solution: solution.events.pulses.sum()),
    Summary("shocks", "1", "jumps of slip rate", lambda solution: len(solution.shocks)),
    Summary("slip", "slip", "slip of the whole run", _slip),
    Summary("peak_rate", "slip_rate", "largest slip rate of all slip events", _at_peak("peak_rate")),
    Summary("peak_time", "s", "when the slip rate is largest", _at_peak("peak_time")),
    Summary("first_start", "s", "start of the first slip event", _first("start")),
    Summary("first_end", "s", "end of the first slip event", _first("end")),
    Summary("first_duration", "s", "duration of the first slip event", _first("duration")),
    Summary("first_slip", "slip", "slip of the first slip event, negative if it slips back", _first("slip")),
    Summary("first_traction_drop", "load", "friction before minus friction after the first slip event", _first("traction_drop")),
    Summary("first_static_drop", "load", "stiffness times slip of the first slip event", _first("static_drop")),
    Summary("recurrence", "s", "mean time from the start of one slip event to that of the next", _recurrence(np.mean, 1)),
    Summary(
        "recurrence_cv",
        "1",
        "coefficient of variation of the recurrence times",
        _recurrence(lambda between: between.std(ddof=1) / between.mean(), 2),
    ),
    Summary("end_time", "s", "end of the run", lambda solution: solution.history.duration),
    Summary("arrested", "1", "at rest at the end of the run", lambda s: s.slip_rate(s.history.duration) == 0.0, is_flag=True),
    Summary("sticking", "1", STICKING, _sticking, ends=("slides", "sticks")),
    Summary("severity", "1", SEVERITY, _severity, line=(1.0, "severity 1: full stick-slip")),
    Summary("irregular", "1", IRREGULAR, _irregular, is_flag=True),
    Summary(
        "branches",
        "1",
        "rising branches of the contact equation at the initial slip",
        lambda solution: max(len(_uniqueness(solution).branches), 1),
    ),
    Summary("work", "energy", "work of the driver", _energy("work")),
    Summary("heat", "energy", "friction heat", _energy("heat")),
    Summary("damped", "energy", "energy dissipated by damping of block or contact, or drag of layers", _energy("damped")),
    Summary("radiated", "energy", "energy radiated through a driver of finite impedance", _energy("radiated")),
    Summary("trapped", "energy", "energy of the waves inside the body at the end", _energy("trapped")),
    Summary("balance", "energy", "energy balance of the run: zero for an exact solution", _energy("balance")),
)
QUANTITIES = {one.name: one for one in _ALL}
"""The built-in quantities, by name."""
DEFAULT = ("events", "pulses", "slip", "peak_rate", "first_duration", "recurrence", "arrested")
"""The quantities that a sweep keeps if none are given."""

TAKEN = ("status", "reason", "time", "member")
"""Names in the dataset of a sweep that a user's quantity cannot have."""
_NAME_OF_QUANTITY = re.compile(r"(?!series_)[A-Za-z][A-Za-z0-9_ ]{0,59}")

Wanted = str | tuple[str, str, Of] | Summary
"""A quantity that a user asks for: the name of a built-in one, (name, unit, function of a solution), or a `Summary`."""


def quantities_for(scenario: Scenario) -> Mapping[str, Summary]:
    """Return the quantities that a sweep of a scenario may keep by name, for a scenario of an extension those of its solver.

    Raises InputError if the solver has none.
    """
    solver = special_solver_of(scenario)
    if solver is None or solver.summaries is None:
        check_solved_by_core("sweep", scenario)
        return QUANTITIES
    return {name: Summary(name, *one) for name, one in solver.summaries().items()}


def quantities_named(wanted: Iterable[Wanted] | None, known: Mapping[str, Summary] = QUANTITIES) -> tuple[Summary, ...]:
    """Return the quantities that were asked for, among those that are known; for None those that are kept by default.

    Raises InputError for an unknown or repeated name, and for an empty list.
    """
    if wanted is None:
        wanted = DEFAULT if known is QUANTITIES else known
    found = tuple(_one(item, known) for item in ([wanted] if isinstance(wanted, str) else wanted))
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"sweep: the quantity '{name}' is given twice")
    if not found:
        raise InputError(f"sweep: no quantity is given; allowed: {some_of(known, listed=QUANTITIES_LISTED)}")
    return found


def _one(item: Wanted, known: Mapping[str, Summary]) -> Summary:
    if isinstance(item, Summary):
        return item
    if isinstance(item, str):
        if item not in known:
            raise InputError(f"sweep: quantity {ascii(item)[:60]} is unknown; {nearest(item, known, listed=QUANTITIES_LISTED)}")
        return known[item]
    if len(item) != 3 or not isinstance(item[0], str) or not isinstance(item[1], str) or not callable(item[2]):
        raise InputError("sweep: a quantity must be a name, or (name, unit, function of a solution)")
    name, unit, of = item
    if name in known or name in TAKEN or not _NAME_OF_QUANTITY.fullmatch(name):
        raise InputError(f"sweep: quantity {ascii(name)[:60]}: choose another name, made of letters, digits, spaces and _")
    return Summary(name, unit, name, of)
