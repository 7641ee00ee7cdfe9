"""Independent answers for composed laws whose steps cannot jump: enclosures of friction over every stretch of the way.

A slab under a law of slip, Z v + S mu(u) = load: time is the integral of Z du / (load - S mu(u)), on pieces that are halved until v
is enclosed to RATIO of itself on each, and slip ends at the first root of load - S mu, where pieces are as short as rounding
allows. A block is integrated by DOP853, whose steps are halved until friction is enclosed to NARROW along them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

from benchmarks.composed_laws import BLOCK, SLAB, Composed
from benchmarks.enclosures import Floats, Interval, Law

RATIO = 0.05
NARROW = 2e-4
SHORTEST = 3e-15
"""Length of a piece (m) that is not halved any more."""
FINEST = 1e-9
"""Length of a piece (m) that is not halved any more for the sake of its integral: rounding of v decides there."""
MOST_PIECES, MOST_STEPS, AHEAD = 40_000, 6000, 48
"""Limits; and the number of steps of a block that are looked at together."""
DISTURBANCE, DECIDED = 1e-12, 1e-8
"""An answer is left out where a load changed by DISTURBANCE of the normal load changes it by more than DECIDED of itself."""
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(16)


class UndecidedError(RuntimeError):
    """The truth is out of reach, or rounding decides it."""


class Answer(NamedTuple):
    """Slip (m) at the end of the run or at the first arrest, and when that is (s; None: not before the end of the run)."""

    slip: float
    arrest: float | None


def truth_of(one: Composed) -> Answer:
    """The answer. Raises UndecidedError if there is none that rounding leaves alone."""
    find = _of_slab if one.kind == "slab, u" else _of_block
    found, other = find(one, one.excess), find(one, one.excess + DISTURBANCE * one.normal)
    if not found.slip > 0.0 or (found.arrest is None) != (other.arrest is None):
        raise UndecidedError("grazing")
    pairs = [(found.slip, other.slip), *([(found.arrest, other.arrest)] if found.arrest and other.arrest else [])]
    if any(abs(a - b) > DECIDED * abs(a) for a, b in pairs):
        raise UndecidedError("rounding decides")
    return found


# ---- a slab under a law of slip ---------------------------------------------------------------------------------------------


def _rate(law: Law, load: float, u: Floats) -> Floats:
    return (load - SLAB.normal_stress * np.broadcast_to(law(u, 0.0), u.shape)) / SLAB.impedance


def _of_slab(one: Composed, excess: float) -> Answer:
    law, normal = one.law, SLAB.normal_stress
    load = normal * float(law(0.0, 0.0)) + excess
    edges = np.linspace(0.0, 0.02, 9)
    left, time = 0.0, 0.0
    while True:  # stretch by stretch, so that nothing is looked at beyond the end
        low, high = _settled(law, load, *_resolved(law, load, _with_features(edges, one)))
        spent = _times(law, load, low, high) if len(low) else np.empty(0)
        until = time + np.cumsum(spent)
        over = np.flatnonzero(until >= one.duration)
        if len(over):
            n = int(over[0])
            return Answer(_slip_at(law, load, (low[n], high[n]), one.duration - (until[n] - spent[n])), None)
        end = float(high[-1]) if len(high) else left
        if end < edges[-1] * (1.0 - 1e-14):
            return Answer(end, None)  # the slip that the contact approaches for ever
        left, time = float(edges[-1]), float(until[-1])
        width = min(
            2.0 * (edges[-1] - edges[0]), max((one.duration - time) * 1.5 * float(_rate(law, load, np.array([left]))[0]), 1e-6)
        )
        edges = left + np.linspace(0.0, width, 9)
        if left > 10.0 or not np.isfinite(time):
            raise UndecidedError("no end")


def _with_features(edges: Floats, one: Composed) -> Floats:
    """Edges with more of them around the features, so that no feature lies between the nodes of a piece that it hardly changes."""
    near = np.concatenate((np.linspace(0.0, 4.0, 9), np.geomspace(5.0, 1e6, 30)))
    more = [c + side * w * near for _, c, w in one.features for side in (-1.0, 1.0)]
    found = np.unique(np.concatenate([edges, *more]))
    return found[(found >= edges[0]) & (found <= edges[-1])]


def _resolved(law: Law, load: float, edges: Floats) -> tuple[Floats, Floats]:
    """Pieces in order, on each of which the slip rate is enclosed to RATIO of itself; they end where it may vanish."""
    low, high = edges[:-1], edges[1:]
    done_low, done_high, stop = [], [], np.inf
    while len(low):
        mu = law.over(Interval(low, high), Interval(np.zeros_like(low), np.zeros_like(low)))
        least = (load - SLAB.normal_stress * mu.high) / SLAB.impedance
        most = (load - SLAB.normal_stress * mu.low) / SLAB.impedance
        good = (least > 0.0) & (most - least <= RATIO * most)
        tiny = high - low <= SHORTEST * np.maximum(high, 1.0)
        never = most < 0.0  # friction exceeds the load on the whole piece: slip ends before it
        ended = never | (tiny & ~good)
        if ended.any():
            stop = min(stop, float(low[ended].min()))
        done_low.append(low[good])
        done_high.append(high[good])
        kept = ~good & ~ended & (low < stop)
        low, high = low[kept], high[kept]
        middle = 0.5 * (low + high)
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
        if len(low) + sum(map(len, done_low)) > MOST_PIECES:
            raise UndecidedError("too many pieces")
    lows, highs = np.concatenate(done_low), np.concatenate(done_high)
    order = np.argsort(lows)
    lows, highs = lows[order], highs[order]
    inside = lows < stop
    return lows[inside], highs[inside]


def _settled(law: Law, load: float, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Pieces halved until Gauss's rule on each and on its halves agree: what hardly changes v may be narrow all the same."""
    for _ in range(40):
        middle = 0.5 * (low + high)
        halves, whole = _times(law, load, low, high), _times(law, load, low, middle) + _times(law, load, middle, high)
        rough = (np.abs(halves - whole) > 1e-12 * np.abs(whole).sum()) & (high - low > FINEST)
        if not rough.any():
            return low, high
        low, high = np.concatenate((low, middle[rough])), np.concatenate((np.where(rough, middle, high), high[rough]))
        order = np.argsort(low)
        low, high = low[order], high[order]
        if len(low) > MOST_PIECES:
            raise UndecidedError("too many pieces")
    return low, high


def _times(law: Law, load: float, low: Floats, high: Floats) -> Floats:
    """Duration of each piece, s, by Gauss's rule on both halves."""
    quarter = 0.25 * (high - low)
    total = np.zeros_like(low)
    for middle in (low + quarter, high - quarter):
        u = middle[:, None] + quarter[:, None] * POINTS
        total += (quarter[:, None] * WEIGHTS / _rate(law, load, u)).sum(axis=1)
    return total


def _slip_at(law: Law, load: float, piece: tuple[float, float], time: float) -> float:
    """The slip in a piece at which a time has passed since its start."""
    begin, end = piece

    def late(u: float) -> float:
        return float(_times(law, load, np.array([begin]), np.array([u]))[0]) - time

    return float(brentq(late, begin, end, xtol=1e-15 * max(end, 1e-3), rtol=1e-14)) if late(end) > 0.0 else end


# ---- a block ----------------------------------------------------------------------------------------------------------------


def _of_block(one: Composed, excess: float) -> Answer:
    """Up to the first arrest, or the end of the run."""
    law, normal = one.law, BLOCK.normal_force
    rest = float(law(0.0, 0.0))

    def right(t: float, y: Floats) -> list[float]:
        slip, rate = y.tolist()
        return [rate, (excess - BLOCK.stiffness * slip - normal * (law.at(slip, rate) - rest)) / BLOCK.mass]

    t, y, longest, taken = 0.0, np.zeros(2), np.inf, 0
    while taken < MOST_STEPS:
        ahead = _ahead(DOP853(right, t, y, one.duration, longest, rtol=1e-12, atol=1e-15, first_step=min(1e-9, longest)), t)
        narrow = _are_narrow(law, np.array([step.dense(np.linspace(step.begin, step.end, 9)) for step in ahead]))
        for step, is_narrow in zip(ahead, narrow, strict=True):
            if not is_narrow:
                longest = 0.4 * (step.end - step.begin)
                break
            if step.rate <= 0.0 and step.begin > 0.0:
                end = float(brentq(lambda x, d=step.dense: float(d(x)[1]), step.begin, step.end, xtol=1e-16, rtol=1e-15))  # type: ignore[misc]
                return Answer(float(step.dense(end)[0]), end)
            t, y, taken = step.end, step.dense(step.end), taken + 1
        else:
            longest *= 8.0
        if t >= one.duration:
            return Answer(float(y[0]), None)
        if longest < 1e-13:
            raise UndecidedError("steep")
    raise UndecidedError("too many steps")


class _Step(NamedTuple):
    """A step of the integration: its ends (s), the slip rate at its end (m/s), and slip and slip rate along it."""

    begin: float
    end: float
    rate: float
    dense: Callable[[Any], Floats]


def _ahead(solver: DOP853, begin: float) -> list[_Step]:
    """Take a few steps, which are looked at together."""
    found: list[_Step] = []
    while len(found) < AHEAD and solver.status == "running":
        solver.step()
        if solver.status == "failed":
            raise UndecidedError("stiff")
        found.append(_Step(begin, float(solver.t), float(solver.y[1]), solver.dense_output()))
        begin = float(solver.t)
        if found[-1].rate <= 0.0:
            break
    return found


def _are_narrow(law: Law, path: Floats) -> NDArray[np.bool_]:
    """Return where friction is enclosed to NARROW in eight boxes around a step; `path` has shape (steps, 2, 9)."""
    low, high = np.minimum(path[..., :-1], path[..., 1:]), np.maximum(path[..., :-1], path[..., 1:])
    spare = 0.1 * (high - low)
    low, high = np.maximum(low - spare, 0.0), np.maximum(high + spare, 0.0)
    mu = law.over(Interval(low[:, 0], high[:, 0]), Interval(low[:, 1], high[:, 1]))
    return ((mu.high - mu.low) <= NARROW).all(axis=1)
