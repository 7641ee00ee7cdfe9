"""The friction law as a curve of the friction coefficient against slip or slip rate, over what a run passed through and more."""

from __future__ import annotations

import numpy as np

from stickslip.explorer.model.answer import Floats, LawPicture, Motion
from stickslip.friction import FrictionLaw, LaggedFriction, RateAndState
from stickslip.problem.problem import Problem
from stickslip.solution.solution import Solution
from stickslip.trajectory.history import Positions

POINTS = 600
"""Number of points of the curve."""
BEYOND = 0.15
"""Share of what the run passed through that is shown before and after it."""
SCALES = 4.0
"""Number of characteristic slip rates of the law that are shown at least."""
DECADES = 14
"""Largest number of decades of slip rate that a logarithmic axis shows."""


def law_picture(solution: Solution, motion: Motion) -> LawPicture:
    """Return the friction law of a run as a curve."""
    law = solution.problem.friction
    if law.depends_on_slip and not law.depends_on_rate:
        return _along_slip(solution)
    return _along_rate(solution.problem, np.abs(motion.slip_rate))


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
    log = law.state is not None
    if log:
        top = 10.0 * max(visited[1], min(scales, default=1e-6))
        bottom = max(0.1 * min(float(moving.min()) if moving.size else top, min(scales, default=top)), top * 10.0**-DECADES)
        rate = np.geomspace(bottom, top, POINTS)
    else:
        top = max((1.0 + BEYOND) * visited[1], SCALES * min(scales, default=0.0)) or 1.0
        knots = [knot for knot in law.knots if 0.0 < knot < top and law.knot_variable == "rate"]
        rate = np.unique(np.concatenate([np.linspace(0.0, top, POINTS // 2), np.geomspace(1e-6 * top, top, POINTS // 2), knots]))
    return LawPicture("slip_rate", rate, _coefficient(problem, rate), visited, log)


def _coefficient(problem: Problem, rate: Floats) -> Floats:
    """Return the coefficient at slip rates, in steady sliding for a law with a state, at the slip of the start for one of slip."""
    law = problem.friction
    if isinstance(law, RateAndState):
        return law.steady_coefficient(rate)
    if isinstance(law, LaggedFriction):
        return law.coefficient(problem.law_slip, rate, rate)
    return law.coefficient(problem.law_slip, rate, problem.state)
