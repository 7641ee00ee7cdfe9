"""The friction law as a curve of the friction coefficient against slip or slip rate, over what a run passed through and more."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stickslip.explorer.model.answer import CurveName, LawPicture, Motion
from stickslip.foundation.arrays import Floats
from stickslip.friction import FrictionLaw, LaggedFriction
from stickslip.friction.contract import one_argument
from stickslip.problem.problem import Problem
from stickslip.solution.solution import Solution
from stickslip.trajectory.history import Positions

POINTS = 600
"""Number of points of the curve."""
BEYOND = 0.15
"""Share of what the run passed through that is shown before and after it."""
SCALES = 4.0
"""Number of characteristic slip rates of the law that are shown at least."""
DECADES = 20
"""Largest number of decades of slip rate that a logarithmic axis shows."""
SEEN = 1e-3
"""Jumps that change the slip rate by a smaller share of it are not seen: pieces of the history meet within a tolerance only."""
PATH, INSIDE, CELLS = 20_000, 8, 500
"""The path has `INSIDE` points in each piece of the history, or fewer if there were more than `PATH`. Of those that lie in one of
`CELLS` times `CELLS` cells of the picture, one after the other, it keeps the first and the last."""


def law_picture(solution: Solution, motion: Motion) -> LawPicture:
    """Return the friction law of a run as a curve."""
    law = solution.problem.friction
    if law.depends_on_slip and not law.depends_on_rate:
        return _along_slip(solution)
    picture = _along_rate(solution.problem, np.abs(motion.slip_rate))
    return picture if not law.states else replace(picture, path=_path(solution))


def _along_slip(solution: Solution) -> LawPicture:
    history, law = solution.history, solution.problem.friction
    everywhere = np.arange(len(history))
    slips = np.concatenate([history.law_slip(Positions.inside(everywhere, end)) for end in (0.0, 1.0)])
    visited = float(slips.min()), float(slips.max())
    margin = BEYOND * (visited[1] - visited[0]) or _slip_scale(law)
    low = visited[0] - margin if law.counts == "net" and law.memory == "all" else max(visited[0] - margin, 0.0)
    knots = [knot for knot in law.knots if low < knot < visited[1] + margin]
    slip = np.union1d(np.linspace(low, visited[1] + margin, POINTS), knots)
    return LawPicture("slip", slip, law.static_coefficient(slip), visited, log=False)


def _slip_scale(law: FrictionLaw) -> float:
    """Return a slip (m) over which a law changes: that of its first knot, or one over its steepest relative slope at slip 0."""
    if law.knots:
        return abs(law.knots[-1]) or 1.0
    slope = abs(law.slopes(0.0)[0])
    return law.variation / slope if slope > 0.0 else 1.0


def _along_rate(problem: Problem, rates: Floats) -> LawPicture:
    law = problem.friction
    moving = rates[rates > 0.0]
    visited = (float(rates.min()), float(rates.max()))
    scales = [scale for scale in law.rate_scales if 0.0 < scale < np.inf]
    log = bool(law.states)
    if log:
        top = 10.0 * max(visited[1], min(scales, default=1e-6))
        bottom = max(0.1 * min(float(moving.min()) if moving.size else top, min(scales, default=top)), top * 10.0**-DECADES)
        rate = np.geomspace(bottom, top, POINTS)
    else:
        top = max((1.0 + BEYOND) * visited[1], SCALES * min(scales, default=0.0)) or 1.0
        knots = [knot for knot in law.knots if 0.0 < knot < top and law.knot_variable == "rate"]
        rate = np.unique(np.concatenate([np.linspace(0.0, top, POINTS // 2), np.geomspace(1e-6 * top, top, POINTS // 2), knots]))
    name, coefficient = _coefficient(problem, rate)
    return LawPicture("slip_rate", rate, coefficient, visited, log, name)


def _path(solution: Solution) -> Floats:
    """Return slip rate and friction coefficient along a run, with NaN at jumps and at rest.

    The times are those of the pieces of its history, because an event of seconds may lie in a run of years.
    """
    breaks = solution.breaks
    inside = min(max(PATH // len(breaks), 1), INSIDE)
    right = np.append(np.linspace(breaks[:-1], breaks[1:], inside, endpoint=False).T.ravel(), breaks[-1])
    order = np.argsort(np.concatenate([breaks, right]), kind="stable")  # the limits from the left first
    rate, traction = (
        np.concatenate([curve(breaks, side="left"), curve(right)])[order] for curve in (solution.slip_rate, solution.traction)
    )
    moves = np.where(rate == 0.0, np.nan, np.sign(rate))
    path = np.column_stack([moves * rate, moves * traction / solution.problem.normal])
    is_left = order < len(breaks)
    jumps = np.flatnonzero(is_left[:-1] & (np.abs(np.diff(rate)) > SEEN * np.abs(rate[1:]))) + 1
    return _thinned(np.insert(path, jumps, np.nan, axis=0))


def _thinned(path: Floats) -> Floats:
    """Return a path without points that a picture would show at the place of the one before."""
    place = np.column_stack([np.log10(path[:, 0]), path[:, 1]])
    low, high = np.nanmin(place, axis=0, initial=np.inf), np.nanmax(place, axis=0, initial=-np.inf)
    cell = np.round(CELLS * (place - low) / np.where(high > low, high - low, 1.0))
    moved = (cell[1:] != cell[:-1]).any(axis=1)
    kept: Floats = path[np.append(True, moved) | np.append(moved, True)]
    return kept


def _coefficient(problem: Problem, rate: Floats) -> tuple[CurveName, Floats]:
    """Return the coefficient at slip rates, at the slip of the start for a law of slip, in steady sliding for one with a state."""
    law = problem.friction
    if (steady := getattr(law, "steady_coefficient", None)) is not None:
        return "steady state", steady(rate)
    if isinstance(law, LaggedFriction):
        return "steady state", law.coefficient(problem.law_slip, rate, rate)
    name: CurveName = "law" if not law.states else "law at the state of the start"
    return name, law.coefficient(problem.law_slip, rate, one_argument(problem.states))
