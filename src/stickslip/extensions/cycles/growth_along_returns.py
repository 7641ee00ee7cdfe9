"""How disturbances of a rigid body grow: the derivatives of its returns to a section, one after the other along a long run.

A return takes a disturbance of load and states on the section to that at the next one, so that a shift in time is left out. After
each return the disturbance is made as small as it was.

Source: Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15, 9.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.contact import steady_slidings
from stickslip.engine import History, Positions
from stickslip.engine.input import SHARE_OF_TOLERANCE
from stickslip.extensions.cycles.exponent import MeasuredGrowth, along, law_in, whole_run
from stickslip.extensions.cycles.find_cycle import check_can_be_followed, without_load
from stickslip.extensions.cycles.lag import is_wound
from stickslip.extensions.cycles.orbit import extent_of
from stickslip.extensions.cycles.section import Return, Section, coordinates, onsets, passages
from stickslip.extensions.cycles.tangent import FIRST_STATE_ROW, RATE_ROW, values_at
from stickslip.foundation.arrays import Floats, Integers1
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.friction.contract import one_argument
from stickslip.friction.formula import value_and_slopes
from stickslip.problem import Problem
from stickslip.problem.bodies import as_on_spring
from stickslip.run import TextProgress

STEADY_SHARE = 1e-6
"""A run whose slip rate varies by less than this share (1) of the pull rate at its end has come to steady sliding."""
SETTLING_SHARE = 0.1
"""This share (1) of the time after what is skipped does not count: a disturbance turns to where it grows fastest then."""
LATEST_SHARE = 0.5
"""By this share (1) of the duration the contact must have passed the pull rate twice."""
FEWEST_RETURNS = 4
"""The smallest number of returns (1) over which an exponent is the mean."""
RETURN_TRIES = 8
"""How often a run to a return may be doubled (1)."""
RESTS_END_ALL = "each rest ends all disturbances, because only the load is left then (exponent minus infinity, exactly)"
GAUSS_PLACES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(8)


def growth_of_rigid(problem: Problem, skip: float, duration: float, rtol: float, tell: TextProgress) -> MeasuredGrowth:
    """Return how disturbances grow along a run of a rigid body from `skip` to `duration` (s). Raises InputError."""
    check_can_be_followed(problem, "lyapunov")
    history = _begun(without_load(problem), skip, duration, rtol)
    tell(f"run of {brief(history.duration, 's')}")
    rests = len(onsets(history).time)
    if rests > 1 and not problem.friction.states and not is_wound(problem):
        return MeasuredGrowth(np.zeros(1), np.zeros(1), -math.inf, 0.0, history.duration, RESTS_END_ALL, events=rests)
    if is_steady(history):
        return _steady(problem)
    return _along_returns(Section(problem, at_onset=False, rtol=rtol), history, duration, tell)


def _begun(problem: Problem, skip: float, duration: float, rtol: float) -> History:
    """Return a run up to `skip` (s), or longer if the contact passes the pull rate fewer than two times by then."""
    lasts = max(skip, 1e-3 * duration)
    while True:
        run = whole_run(problem, lasts, rtol, "to leave out less at the start (a shorter skip), or a shorter duration")
        if len(passages(run.history).time) > 1 or lasts >= LATEST_SHARE * duration:
            return run.history
        lasts = min(2.0 * lasts, LATEST_SHARE * duration)


def is_steady(history: History) -> bool:
    """Return True if the slip rate no longer varies in the last quarter of a run; about a set point at rest it always may."""
    if history.problem.first_pull_rate == 0.0:
        return False
    late = np.flatnonzero(history.start + history.store.speed + history.store.bend >= 0.75 * history.duration)
    rates = _rates(history, late)
    pull = history.problem.first_pull_rate
    return bool(np.abs(rates - pull).max() <= STEADY_SHARE * pull)


def _rates(history: History, pieces: Integers1) -> Floats:
    """Return slip rates (m/s) at the beginning, in the middle and at the end of pieces."""
    return history.rate(Positions.inside(np.repeat(pieces, 3), np.tile([0.0, 0.5, 1.0], len(pieces))))


def _steady(problem: Problem) -> MeasuredGrowth:
    """Return the growth of disturbances of the steady sliding to which a run has come."""
    growth = steady_slidings(problem).slidings[-1].growth
    how = "that of the steady sliding to which the run comes"
    return MeasuredGrowth(np.array([0.0, 1.0]), np.array([0.0, growth]), growth, 0.0, 1.0, how)


def _along_returns(section: Section, history: History, duration: float, tell: TextProgress) -> MeasuredGrowth:
    """Return how disturbances grow along the returns after a run, up to `duration` (s)."""
    met, passes = passages(history), "passes the pull rate" if section.problem.first_pull_rate > 0.0 else "slips forwards"
    if len(met.time) < 2:
        raise InputError(
            f"lyapunov: in the first {brief(history.duration, 's')} the contact {passes} fewer than two times:"
            " give a longer duration"
        )
    usual = float(met.time[-1] - met.time[0]) / (len(met.time) - 1)
    place = coordinates(values_at(history, Positions.inside(met.piece[-1:], met.place[-1:])), at_onset=False)[:, 0]
    scale = extent_of(history, False, len(history) - 1)
    time, size, rests, divergence = float(met.time[-1]), 0.0, False, 0.0
    skip = time + SETTLING_SHARE * (duration - time)
    way = scale / math.sqrt(len(scale))
    times, grown_to, extents = [], [], []
    while time < duration:
        if time >= skip:
            times.append(time)
            grown_to.append(size)
        now = section.returned(place, usual, RETURN_TRIES)
        if is_steady(now.history):  # its own decay is a disturbance that the section leaves out
            return _steady(section.problem)
        way = now.slopes(exactly=False) @ way
        grown = float(np.linalg.norm(way / scale))
        if not grown > 0.0:
            return MeasuredGrowth(np.zeros(1), np.zeros(1), -math.inf, 0.0, time, RESTS_END_ALL)
        if time >= skip:
            extents.append(float(np.ptp(_rates(now.history, np.arange(now.piece + 1)))))
            divergence, rests = divergence + _divergence(now), rests or now.sticks
        way, place, time, size = way / grown, now.end, time + now.time, size + math.log(grown)
        if len(times) % 16 == 1:
            tell(f"{brief(time, 's')} of {brief(duration, 's')}")
    times.append(time)
    grown_to.append(size)
    if len(times) <= FEWEST_RETURNS:
        raise InputError(
            f"lyapunov: the contact {passes} {len(times)} times between {brief(skip, 's')} and {brief(duration, 's')}:"
            f" more than {FEWEST_RETURNS} are needed: give a longer duration"
        )
    counted = times[-1] - times[0]
    to = "the pull rate" if section.problem.first_pull_rate > 0.0 else "slip forwards"
    how = f"measured over {len(times) - 1} returns to {to} in {brief(counted, 's')} (rtol {section.rtol:g})"
    known = max(section.rtol * SHARE_OF_TOLERANCE, float(np.finfo(float).eps))
    every = -math.inf if rests else divergence / counted
    return along(np.array(times), np.array(grown_to), np.array(extents), how, events=len(times) - 1, sum_of_all=every, known=known)


def _divergence(one: Return) -> float:
    """Return the logarithm (1) of the growth of a volume of disturbances in a return; NaN under a law of several formulas."""
    store, count, problem = one.history.store, one.piece + 1, one.history.problem
    if len(problem.friction.pieces) > 1:
        return math.nan
    ends = np.append(np.ones(count - 1), one.place)
    at = Positions.inside(np.repeat(np.arange(count), len(GAUSS_PLACES)), (ends[:, None] * 0.5 * (GAUSS_PLACES + 1.0)).ravel())
    lasts = np.repeat(ends, len(GAUSS_PLACES)) * (store.speed[at.piece] + 2.0 * store.bend[at.piece] * at.xi)
    lasts *= np.tile(0.5 * GAUSS_WEIGHTS, count)
    values, mode, found = values_at(one.history, at), store.mode[at.piece], 0.0
    for direction in np.unique(mode).tolist():
        here = mode == direction
        found += float(lasts[here] @ _trace(problem, values[:, here], direction))
    return found


def _trace(problem: Problem, values: Floats, direction: int) -> Floats:
    """Return the divergence (1/s) of the motion where load, slip rate and states, a row each, are known."""
    law = law_in(problem, direction)
    signs = np.ones(len(law.states))
    if direction < 0:
        signs[list(problem.friction.reverses)] = -1.0
    states = values[FIRST_STATE_ROW : FIRST_STATE_ROW + len(signs)]
    rate, seen = np.abs(values[RATE_ROW]), [sign * state for sign, state in zip(signs, states, strict=True)]
    found = np.zeros(len(rate))
    if direction:
        body = as_on_spring(problem.body)
        found -= (body.total_damping + problem.normal * law.slopes(0.0, rate, one_argument(seen))[1]) / body.inertia
    for n, tree in enumerate(law.state_trees()):
        found += value_and_slopes(tree, law.numbers(), np.zeros(len(rate)), rate, *seen)[1][2 + n]
    return found
