"""The contact of a grid: solve `impedance v + S mu(u, v) = load` in each step, with stick where it is admissible.

If friction falls fast enough with the slip rate, several slip rates solve the equation. A program then takes one of them, by the
way in which it searches. `SEARCHES` has the usual ways.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.problem.problem import Problem
from stickslip.schemes.contract import Answer, Meeting

SEARCHES = {
    "stick-first": "stick wherever the static strength holds, otherwise the smallest root",
    "continue": "the root next to the slip rate of the step before, in the direction in which the equation is violated",
    "newton": "Newton's method from the slip rate of the step before, without safeguards; stick if it leaves slip",
    "fastest": "the largest root",
}
"""Ways to search for a root, each with its meaning."""
POINTS = 48
"""Number of slip rates, in each of two sets, at which roots are looked for."""
ROUNDING = 16.0 * float(np.finfo(float).eps)
"""A load that exceeds the strength by less than this share of it does not begin slip."""
NEWTON_STEPS = 50
"""Largest number of Newton's steps."""
Missing = Callable[[Floats], Floats]


class GridContact:
    """The friction of a problem, for one run of a scheme; `search`, one of SEARCHES, says how a root is looked for.

    Friction that is regularised by `smoothing`, a slip rate v0 (m/s), is mu tanh(v/v0) and never sticks; 0 stands for friction with
    stick. Raises InputError if the search is unknown, or the law has a state or remembers slip since the last arrest only.
    """

    def __init__(self, problem: Problem, search: str = "stick-first", smoothing: float = 0.0) -> None:
        law = problem.friction
        if search not in SEARCHES:
            raise InputError(f"schemes: there is no search {ascii(search)[:60]}; {nearest(search, SEARCHES)}")
        if law.states or law.memory == "since-arrest" or not law.sticks:
            raise InputError(
                f"schemes: {law.kind} friction remembers more than slip, or never sticks: the schemes have no such contact"
            )
        self.law, self.normal, self.search, self.smoothing = law, problem.normal, search, smoothing
        self._path = law.counts == "path"
        self._law_slip, self._slip = problem.law_slip, problem.initial_slip
        self._bottom = float(law.range()[0])
        self._yields = problem.excess == 0.0 and (problem.first_pull_rate > 0.0 or problem.far_stress_rate > 0.0)

    def meet(self, meeting: Meeting, before: float) -> Answer:
        """Solve the contact equation of a step; `before` is the slip rate (m/s) of the step before."""
        strength = self.normal * float(self.law.static_coefficient(self._seen(meeting.slip)))
        margin = -ROUNDING if self._yields else ROUNDING  # a load at the strength that is about to rise begins slip at once
        holds = abs(meeting.load) <= strength * (1.0 + margin) and not self.smoothing
        self._yields = False
        way = 1.0 if meeting.load >= 0.0 else -1.0
        rate = way * self._root(meeting, way, max(way * before, 0.0), holds)
        slip = meeting.slip + meeting.slip_per_rate * rate
        self._law_slip, self._slip = self._seen(slip), slip
        return Answer(rate, meeting.load - meeting.impedance * rate)

    def _seen(self, slip: Any) -> Any:
        """Return the slip that the law sees (m): the path so far, if it counts the path."""
        return self._law_slip + abs(slip - self._slip) if self._path else slip

    def _root(self, meeting: Meeting, way: float, before: float, holds: bool) -> float:
        """Return the magnitude of the slip rate, m/s."""
        load = abs(meeting.load)

        def missing(rate: Floats) -> Floats:
            seen = self._seen(meeting.slip + way * meeting.slip_per_rate * rate)
            friction = self.normal * self.law.coefficient(seen, rate)
            if self.smoothing:
                friction = friction * np.tanh(rate / self.smoothing)
            return meeting.impedance * rate + friction - load

        if holds and (self.search == "stick-first" or (before == 0.0 and self.search != "fastest")):
            return 0.0
        if not (self.law.depends_on_rate or meeting.slip_per_rate or self.smoothing):
            return max(-float(missing(np.zeros(()))) / meeting.impedance, 0.0)
        if self.search == "newton":
            found = _newton(missing, before, meeting.impedance)
            if found is not None and (found > 0.0 or holds):
                return found
        top = max(2.0 * (load - self.normal * min(self._bottom, 0.0)) / meeting.impedance, 2.0 * before, 1e-300)
        return _scan(missing, 0.0 if self.search == "stick-first" else before, top, self.search)


def _scan(missing: Missing, start: float, top: float, search: str) -> float:
    """Return the root that a search finds between 0 and `top` (m/s), where more is resisted than loads; 0 if it finds none."""
    rates = np.unique(np.concatenate([[start], np.linspace(0.0, top, POINTS), np.geomspace(1e-12 * top, top, POINTS)]))
    below = missing(rates) < 0.0
    rising, falling = np.flatnonzero(below[:-1] & ~below[1:]), np.flatnonzero(~below[:-1] & below[1:])
    place = int(np.searchsorted(rates, start))
    if search == "fastest":
        chosen = rising[-1:]
    elif below[place] or start == 0.0:
        chosen = rising[rising >= place][:1]
    else:  # slip is too fast: the root below, unless the resistance exceeds the load all the way down
        chosen = rising[rising < place][-1:]
        if falling.size and chosen.size and not below[0]:
            chosen = chosen if falling[falling < place].size else chosen[:0]
    if not chosen.size:
        return 0.0
    k = int(chosen[0])
    return float(brentq(lambda rate: float(missing(np.asarray(rate))), rates[k], rates[k + 1], xtol=1e-300, rtol=1e-14))


def _newton(missing: Missing, start: float, impedance: float) -> float | None:
    """Return the root of Newton's method from a slip rate (m/s): 0 if it leaves slip, None if it does not converge."""
    rate = start
    for _ in range(NEWTON_STEPS):
        width = 1e-7 * max(rate, 1e-9)
        value, above = missing(np.array([rate, rate + width])).tolist()
        slope = (above - value) / width
        step = -value / (slope or impedance)
        rate += step
        if rate <= 0.0:
            return 0.0
        if abs(step) <= 1e-10 * rate:
            return float(rate)
    return None
