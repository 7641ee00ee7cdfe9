"""Decisions of the selection rule in a run.

The rule has a choice while the load lies strictly between the folds, where several stable slip rates solve the contact equation.
At any other load one slip rate solves it, and every rule takes that one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.contact import Uniqueness, branches_of, regime_when_pressed, resistance, uniqueness_of
from stickslip.engine import History, Side, shock_columns
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import YEAR
from stickslip.foundation.show import brief_repr
from stickslip.problem import Branch

Regime = Literal["regular", "irregular", "continuum"]

_ROUNDING = 1e-12
"""The rule has no choice at loads closer than this to the ends of the window between the folds, as a share of the window. So it has
none at a start at the static strength.
"""
_SLIPS = 33
"""To find the regime of a run, branches are computed at this many slips along it."""
_CANDIDATES = 50
"""At most this many intervals are searched for the first time between the folds: it bounds the cost of a search that fails."""


@dataclass(frozen=True)
class RuleInfluence:
    """Decisions of the selection rule in a run, in a `regime` of the contact.

    `shocks` says for each row of `solution.shocks` whether the rule decided it: the load was between the folds before or after the
    shock, or the load reached a fold by itself (cause "fold"). `since` is the first time (s) with the load between the folds, or
    None. `folds_move` is True if folds move with slip or normal load; then `shocks` is empty and `since` is None.
    """

    rule: str
    regime: Regime
    shocks: NDArray[np.bool_]
    since: float | None = None
    folds_move: bool = False

    units: ClassVar = {"since": "s"}
    __repr__ = brief_repr

    @property
    def note(self) -> str:
        """One line on whether the result depends on the selection rule, and how much of it."""
        if self.regime == "regular":
            return f"{self.rule}: without effect, the solution is unique"
        depends = f"{self.rule}: the contact equation has several solutions, this run depends on the rule"
        return f"{depends}; {self.decided}" if self.decided else depends

    @property
    def decided(self) -> str:
        """What the rule decided, in a few words; empty if it has no effect, or if folds move."""
        if self.regime == "regular" or self.folds_move:
            return ""
        shocks, decided = len(self.shocks), int(self.shocks.sum())
        found = f"it decided {decided or 'none'} of the {shocks} shocks" if shocks else "no shock occurred"
        if self.since is None and not decided:
            return f"{found}: the load was never between the folds"
        return found + ("" if self.since is None else f": the load was between the folds first at {_time(self.since)}")


def rule_influence(history: History, load_curve: Callable[[], tuple[Floats, Floats]]) -> RuleInfluence:
    """Return what the selection rule decided in a run.

    `load_curve` returns times (s) and loads (Pa) along the run; it is called only if the rule has a choice at some load. The search
    for `since` overlooks a visit between the folds that begins and ends between two times of the curve.
    """
    problem = history.problem
    contact = uniqueness_of(problem)
    if contact.resistance is None or not problem.friction.depends_on_rate:
        return RuleInfluence(problem.rule, contact.regime, np.zeros(0, bool))
    if problem.friction.depends_on_slip or problem.normal_varies:
        return RuleInfluence(problem.rule, _regime_on_the_way(history, contact), np.zeros(0, bool), folds_move=True)
    shocks = shock_columns(history)
    time, cause = shocks["time"], np.array(shocks["cause"], object)
    if contact.window is None and (contact.backward is None or contact.backward.window is None):
        return RuleInfluence(problem.rule, contact.regime, np.zeros(len(time), bool))
    before, after = (_side_of_folds(contact, _load(history, time, side)) == 0.0 for side in ("left", "right"))
    decided = (cause == "fold") | (before & (cause != "start")) | after
    return RuleInfluence(problem.rule, contact.regime, decided, _first_between(history, contact, *load_curve()))


def _load(history: History, time: Floats, side: Side = "right") -> Floats:
    return history.problem.strength + history.excess(history.find(time, side))


def _side_of_folds(contact: Uniqueness, load: Floats) -> Floats:
    """Return -1 below the folds, 0 strictly between them and +1 above, for loads of either sign."""
    behind = contact.backward
    return _side(contact, load) if behind is None else np.where(load < 0.0, _side(behind, load), _side(contact, load))


def _side(contact: Uniqueness, load: Floats) -> Floats:
    if contact.window is None:
        return np.full(load.shape, -1.0)
    assert contact.resistance is not None
    low, high = contact.window
    excess, rounding = np.abs(load) - contact.resistance.strength, _ROUNDING * (high - low)
    return np.where(excess <= low + rounding, -1.0, np.where(excess >= high - rounding, 1.0, 0.0))


def _first_between(history: History, contact: Uniqueness, time: Floats, load: Floats) -> float | None:
    """Return the first time (s) with the load between the folds, or None.

    The time is one of the curve, or is found between two of them with loads on different sides of the folds.
    """
    place = _side_of_folds(contact, load)
    passed = (place[1:] == 0.0) | ((place[1:] != place[:-1]) & (np.diff(time) > 0.0))
    candidates = np.flatnonzero(np.append(place[0] == 0.0, passed))[:_CANDIDATES]
    found = (_refined(history, contact, float(time[max(k - 1, 0)]), float(time[k])) for k in candidates.tolist())
    return next((at for at in found if at is not None), None)


def _refined(history: History, contact: Uniqueness, low: float, high: float) -> float | None:
    """Return the first time in an interval with the load between the folds, to the resolution of time.

    Returns None if the load only jumps across the folds.
    """
    while True:
        times = np.linspace(low, high, 33)
        place = _side_of_folds(contact, _load(history, times))
        change = np.flatnonzero((place == 0.0) | (place != place[0]))
        if not change.size:
            return None
        first = int(change[0])
        if first == 0 or times[first] - times[first - 1] <= 4.0 * np.spacing(high):
            return float(times[first]) if place[first] == 0.0 else None
        low, high = float(times[first - 1]), float(times[first])


def _regime_on_the_way(history: History, contact: Uniqueness) -> Regime:
    """Return "irregular" if the contact is irregular at any of the slips that the run passes, or under any of its normal loads."""
    problem = history.problem
    if contact.regime != "regular" or not problem.friction.depends_on_slip:
        return regime_when_pressed(problem) if contact.regime == "regular" else contact.regime
    slips = problem.initial_slip + history.slipped(history.find(history.breaks, "right"))
    if problem.friction.counts == "path":
        slips = problem.law_slip + np.append(0.0, np.cumsum(np.abs(np.diff(slips))))
    on_the_way = np.linspace(slips.min(), slips.max(), _SLIPS).tolist()
    most = problem.normal if problem.normal_load is None else problem.normal_load.highest
    contacts = (resistance(problem, slip, most) for slip in on_the_way)
    return "irregular" if any(_several(branches_of(g)) for g in contacts) else "regular"


def _several(stable: tuple[Branch, ...]) -> bool:
    """Return True if the branches give some load more than one slip rate."""
    return len(stable) > 1 or stable[0].rate_from > 0.0 or stable[0].excess_from < 0.0


def _time(t: float) -> str:
    return f"{t:.6g} s" if t < 1e5 else f"{t / YEAR:.6g} years"
