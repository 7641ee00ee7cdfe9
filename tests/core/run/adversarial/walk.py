"""Integration by scipy's DOP853 that cannot step over a feature: its steps are held to what the features' widths allow."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

Floats = NDArray[np.float64]
RTOL = 1e-12
WIDTHS, SHARE = 0.5, 0.4
"""A step crosses at most so much of a width, or so much of the distance to the feature, whichever is larger."""


MOST_STEPS = 20_000


class TooStiffError(RuntimeError):
    """An explicit method would need more than MOST_STEPS steps."""


class Place(NamedTuple):
    """A coordinate that meets a feature: its value from (t, y), and where and how wide the feature is."""

    at: Callable[[float, Floats], float]
    centre: float
    detail: float

    def room(self, t: float, y: Floats) -> float:
        """How far the coordinate may move in one step."""
        return max(WIDTHS * self.detail, SHARE * abs(self.at(t, y) - self.centre))


@dataclass
class Path:
    """A solution in pieces of dense output."""

    ends: list[float] = field(default_factory=list)
    pieces: list[Any] = field(default_factory=list)
    stopped: bool = False
    """True where the path ended because `stop` fell to zero."""

    def __call__(self, t: float) -> Floats:
        """The state at time t, s."""
        i = int(np.searchsorted(self.ends, t))
        return np.asarray(self.pieces[min(i, len(self.pieces) - 1)](t), float)

    @property
    def end(self) -> float:
        """Where the path ends, s."""
        return self.ends[-1]


Right = Callable[[float, Floats], Sequence[float]]


def walk(right: Right, start: float, state: Sequence[float], end: float, places: Sequence[Place], scale: Sequence[float],
         stop: Callable[[float, Floats], float] | None = None) -> Path:  # fmt: skip
    """Integrate y' = right(t, y) from `start` to `end`, or to where `stop` first falls through zero.

    `scale` holds the size of each component; errors are controlled to RTOL of it and of the component.
    """
    path, t, y = Path(), start, np.asarray(state, float)
    tolerance = 1e-3 * RTOL * np.asarray(scale, float)
    solver = DOP853(right, t, y, end, rtol=RTOL, atol=tolerance, first_step=1e-9 * (end - start))
    factor = 1.0
    for _ in range(MOST_STEPS):
        if t >= end:
            return path
        solver.max_step = factor * _longest(right, t, y, places, end - start)
        solver.h_abs = min(solver.h_abs, solver.max_step)
        solver.step()
        if solver.status == "failed":
            raise TooStiffError(f"the truth cannot go on at {t:g} s")
        dense = solver.dense_output()
        if _strays(t, y, solver, dense, places):
            factor *= 0.5
            solver = DOP853(right, t, y, end, rtol=RTOL, atol=tolerance, first_step=min(0.5 * (solver.t - t), end - t))
            continue
        factor = min(2.0 * factor, 1.0)
        new = float(solver.t)
        path.pieces.append(dense)
        if stop is not None and stop(new, solver.y) <= 0.0 and len(path.pieces) > 1:
            root = brentq(lambda x, d=dense: stop(x, d(x)), t, new, xtol=1e-16 * max(new, 1e-3), rtol=1e-15)  # type: ignore[misc]
            path.ends.append(float(root))
            path.stopped = True
            return path
        path.ends.append(new)
        t, y = new, solver.y.copy()
    raise TooStiffError(f"stiff at {t:g} of {end:g} s")


def _longest(right: Right, t: float, y: Floats, places: Sequence[Place], span: float) -> float:
    """Longest step that stays within the room of every place, judged by the velocities at its start."""
    longest, tiny = span / 50.0, 1e-7 * span
    velocity = np.asarray(right(t, y))
    for place in places:
        speed = abs(place.at(t + tiny, y + tiny * velocity) - place.at(t, y)) / tiny
        if speed > 0.0:
            longest = min(longest, 0.7 * place.room(t, y) / speed)
    return max(longest, 1e-12 * span)


def _strays(t: float, y: Floats, solver: Any, dense: Any, places: Sequence[Place]) -> bool:
    """Return True if somewhere in the step a coordinate left the room that it had at the step's start."""
    for place in places:
        here, room = place.at(t, y), place.room(t, y)
        for share in (0.25, 0.5, 0.75, 1.0):
            x = t + share * (float(solver.t) - t)
            if not abs(place.at(x, np.asarray(dense(x))) - here) <= 1.01 * room:
                return not math.isclose(t, float(solver.t), rel_tol=1e-14)
    return False
