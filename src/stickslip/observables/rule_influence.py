"""Influence of the selection rule on a run: the shocks that it decided, and the first time at which it had a choice.

The rule has a choice while the load lies strictly between the folds, where several stable slip rates solve the contact equation.
At any other load one slip rate solves it, and every rule takes that one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.branches import Branch, branches
from stickslip.contact.uniqueness import Uniqueness, uniqueness
from stickslip.foundation.constants import YEAR

if TYPE_CHECKING:
    from stickslip.solution.solution import Solution

Floats = NDArray[np.float64]
Side = Literal["left", "right"]
Regime = Literal["regular", "irregular", "continuum"]

_ROUNDING = 1e-12
"""Distance from the ends of the window between the folds, as a share of it, within which a load has no choice: a start at the
static strength has none.
"""
_SLIPS = 33
"""Number of slips along a run at which the branches are computed to find its regime."""
_CANDIDATES = 50
"""Largest number of intervals that are searched for the first time between the folds: it bounds the cost of a search that fails."""


@dataclass(frozen=True)
class Choices:
    """Decisions of the selection rule in a run.

    `regime` is that of the contact. `shocks` says for each row of `solution.shocks` whether the rule decided it: the load was
    between the folds before or after the shock, or the load reached a fold by itself (cause "fold"). `since` is the first time
    (s) at which the load lay between the folds, or None. For a law whose folds move with slip `shocks` is empty and `since` is
    None.
    """

    rule: str
    regime: Regime
    shocks: NDArray[np.bool_]
    since: float | None = None


def choices(solution: Solution) -> Choices:
    """Return what the selection rule decided in a run.

    The search for `since` uses the 2000 times of `solution.curve` and all breaking points: it overlooks a visit between the folds
    that begins and ends between two of these times.
    """
    problem = solution.problem
    contact = uniqueness(problem)
    if contact.resistance is None or not problem.friction.depends_on_rate:
        return Choices(problem.rule, contact.regime, np.zeros(0, bool))
    if problem.friction.depends_on_slip:
        return Choices(problem.rule, _regime_on_the_way(solution, contact), np.zeros(0, bool))
    if contact.window is None:
        return Choices(problem.rule, contact.regime, np.zeros(len(solution.shocks), bool))
    table = solution.shocks
    time = table.time.to_numpy(float)
    between = [_between(contact, solution, time, side) for side in ("left", "right")]
    starts = (table.cause == "start").to_numpy()
    decided = (table.cause == "fold").to_numpy() | (between[0] & ~starts) | between[1]
    return Choices(problem.rule, contact.regime, decided, _first_between(contact, solution))


def _between(contact: Uniqueness, solution: Solution, time: Floats, side: Side) -> NDArray[np.bool_]:
    """Return True where the load, of either sign, is strictly between the folds."""
    return _inside(contact, solution.load(time, side=side) if len(time) else np.zeros(0))


def _inside(contact: Uniqueness, load: Floats) -> NDArray[np.bool_]:
    return np.equal(_place(contact, load), 0.0)


def _place(contact: Uniqueness, load: Floats) -> Floats:
    """Return -1 below the folds, 0 strictly between them and +1 above, for loads of either sign."""
    assert contact.window is not None
    assert contact.resistance is not None
    low, high = contact.window
    excess, rounding = np.abs(load) - contact.resistance.strength, _ROUNDING * (high - low)
    return np.where(excess <= low + rounding, -1.0, np.where(excess >= high - rounding, 1.0, 0.0))


def _first_between(contact: Uniqueness, solution: Solution) -> float | None:
    """Return the first time (s) at which the load is between the folds, or None.

    The time is a sample, or is found between two samples that lie on different sides of the folds.
    """
    time, load = solution.curve("load")
    place = _place(contact, load)
    passed = (place[1:] == 0.0) | ((place[1:] != place[:-1]) & (np.diff(time) > 0.0))
    candidates = np.flatnonzero(np.append(place[0] == 0.0, passed))[:_CANDIDATES]
    found = (_refined(contact, solution, float(time[max(k - 1, 0)]), float(time[k])) for k in candidates.tolist())
    return next((at for at in found if at is not None), None)


def _refined(contact: Uniqueness, solution: Solution, low: float, high: float) -> float | None:
    """Return the first time in an interval with the load between the folds, to the resolution of time.

    Returns None if the load only jumps across the folds.
    """
    while True:
        times = np.linspace(low, high, 33)
        place = _place(contact, solution.load(times))
        change = np.flatnonzero((place == 0.0) | (place != place[0]))
        if not change.size:
            return None
        first = int(change[0])
        if first == 0 or times[first] - times[first - 1] <= 4.0 * np.spacing(high):
            return float(times[first]) if place[first] == 0.0 else None
        low, high = float(times[first - 1]), float(times[first])


def _regime_on_the_way(solution: Solution, contact: Uniqueness) -> Regime:
    """Return "irregular" if the contact is irregular at any of the slips that the run passes."""
    if contact.regime != "regular":
        return contact.regime
    slips = solution.slip(solution.breaks)
    problem = solution.problem
    if problem.friction.counts == "path":
        slips = problem.law_slip + np.append(0.0, np.cumsum(np.abs(np.diff(slips))))
    for slip in np.linspace(slips.min(), slips.max(), _SLIPS).tolist():
        if several(branches(problem, slip)):
            return "irregular"
    return "regular"


def several(stable: tuple[Branch, ...]) -> bool:
    """Return True if the branches give some load more than one slip rate."""
    return len(stable) > 1 or stable[0].rate_from > 0.0 or stable[0].excess_from < 0.0


def selection_note(solution: Solution) -> str:
    """Return one line on whether the result depends on the selection rule, and how much of it."""
    found = choices(solution)
    if found.regime == "regular":
        return f"{found.rule}: without effect, the solution is unique"
    rests = f"{found.rule}: the contact equation has several solutions, this run depends on the rule"
    if solution.problem.friction.depends_on_slip:
        return rests
    shocks, decided = len(found.shocks), int(found.shocks.sum())
    if found.since is None and not decided:
        return f"{rests}; it decided none of the {shocks} shocks: the load was never between the folds"
    since = "" if found.since is None else f": the load was between the folds first at {_time(found.since)}"
    return f"{rests}; it decided {decided} of the {shocks} shocks{since}"


def _time(t: float) -> str:
    return f"{t:.6g} s" if t < 1e5 else f"{t / YEAR:.6g} years"
