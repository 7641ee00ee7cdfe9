"""Prove bounds on the residual of the contact equation from a history alone, without anything that made it.

The engine's own bound of a step (`engine.contact_step.certificate`) rests on its series: their first coefficients are those of the
solution. Here the bound is proven for a finished step without that premise. Let g be the residual of the contact equation, y the
place in the step minus 1/2, and |g| <= M for |y| <= R, by the formula of the law on discs (`friction.formula.bounds`). The ellipse
with the ends of the step as its foci and the larger half-axis R lies in that disc, and has the parameter q = 2 R + sqrt(4 R^2 - 1).
Let p be the polynomial of degree n through the values of g at n + 1 Chebyshev points of the step. Then (Trefethen 2019,
Approximation Theory and Approximation Practice, ch. 8)

    |g - p| <= 4 M q^-n / (q - 1),    |p| <= sum of the sizes of its coefficients

on the whole step. If rounding matters, the largest of the values themselves says more than that sum: a polynomial of half that
degree is nowhere more than sqrt(2) times as large as at these points (Ehlich and Zeller 1964), and g differs from one by at most
2 M q^(-n / 2) / (q - 1).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import comb
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import TERMS, History
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import KINDS_OF_BODY
from stickslip.foundation.show import brief, brief_repr
from stickslip.friction.formula import VARIABLES, Disc, Expression, largest, on_discs
from stickslip.problem import Problem
from stickslip.solution.observables.given_on_discs import NormalLoads, missed_growth

Places = NDArray[np.intp]

ORDER = 32
"""Degree n of the polynomial through the values of g (1)."""
RADII = np.array([8.0, 5.6, 4.0, 2.8, 2.0, 1.5, 1.2, 1.0, 0.85, 0.75])
"""Radii R of the discs to try, in lengths of the step (1)."""
FIRST, SHARE, LARGEST = 32, 4096, 512
"""Numbers of steps to prove anew: the first of each kind, an even share of all, and those with the largest bounds."""
AT_ONCE = 128
"""Number of steps that are proven together: it keeps the memory bounded."""
POLYNOMIAL = 3e-15
"""Rounding of the value of a polynomial (1), relative to the sum of the sizes of its terms but for the first."""
OF_DURATION = 5e-16
"""Rounding of the duration of a step (1), relative to the round trip."""
SUM = 5e-16
"""Rounding of a sum of four terms (1), relative to the sum of their sizes."""


@dataclass(frozen=True)
class Proof:
    """Bounds on the residual of the contact equation at any moment of a run, the rounding of numbers included.

    Of `steps` steps of slip, `anew` are proven from the history and the law's formula alone, whatever made them: all of them in a
    short run, else the first of each kind, a share of the others, and those with the largest bounds. The bounds of the others are
    the engine's, with what was measured where each of them ends. Leaps over creep have error bounds of their own
    (`Solution.creep`). Method and proof: docs/theory/certificate.md.
    """

    residual: float
    """Largest bound, in `unit`, of |Z v + S mu(u, v) - load|, with inertia and damping where the contact has them."""
    relative: float
    """The same as a share (1) of the normal stress, or force."""
    steps: int
    """Number of steps of slip that have a bound."""
    anew: int
    """Number of them that are proven without the engine's series or stages."""
    unproven: int
    """Number of pieces of the history without a bound: they are measured at places only."""
    unproven_share: float
    """Share (1) of the sliding time that they last."""
    missed: float
    """Largest residual, in `unit`, that was measured at places of these pieces."""
    unit: str
    """Unit of the residual: Pa, N or N m."""

    units: ClassVar[dict[str, str]] = {"relative": "1", "unproven_share": "1"}
    __repr__ = brief_repr

    @property
    def short(self) -> str:
        """The bound in a few words."""
        but = f", but for {100.0 * self.unproven_share:.2g} % of the sliding time" if self.unproven else ""
        return f"to {self.relative:.1g} of the normal {KINDS_OF_BODY[self.unit].loads} at every moment{but}"

    @property
    def text(self) -> str:
        """One line on the bound."""
        share = f"{self.relative:.1g} of the normal {KINDS_OF_BODY[self.unit].loads}"
        found = f"the contact equation holds to {brief(self.residual, self.unit)} at every moment, {share}"
        if self.steps:
            found += f"; proven from the law's formula alone: {self.anew} of {self.steps} steps"
        if self.unproven:
            pieces = "1 piece" if self.unproven == 1 else f"{self.unproven} pieces"
            found += f", except in {100.0 * self.unproven_share:.2g} % of the sliding time ({pieces}), which has no bound: "
            found += f"measured at places there it is missed by {brief(self.missed, self.unit)}"
        return found


class Proven(NamedTuple):
    """Proven bounds for some pieces of a history: the largest one (Pa or N), and numbers of steps."""

    residual: float = 0.0
    steps: int = 0
    anew: int = 0
    unproven: int = 0
    unproven_share: float = 0.0  # 1: of the sliding time
    missed: float = 0.0  # Pa or N: measured at places of unproven pieces

    def proof(self, problem: Problem) -> Proof:
        """Return it as a `Proof`."""
        relative = self.residual / problem.normal
        without = (self.unproven, self.unproven_share, self.missed)
        return Proof(self.residual, relative, self.steps, self.anew, *without, problem.load_unit)


def proven(history: History) -> Proven:
    """Return the proven bounds for a history."""
    bound, steps, anew = bounds_of_pieces(history)
    residual = float(np.nanmax(bound, initial=0.0))
    without = np.flatnonzero(np.isnan(bound))
    if len(without) == 0:
        return Proven(residual, steps, anew)
    store, missed = history.store, 0.0
    lasting = np.abs(store.speed + store.bend)
    for some in np.array_split(without, len(without) // AT_ONCE + 1):
        missed = max(missed, float(_bounds(history, some)[0].max()))
    share = float(lasting[without].sum() / max(lasting[store.mode != 0].sum(), lasting[without].sum()))
    return Proven(residual, steps, anew, len(without), share, missed)


def bounds_of_pieces(history: History) -> tuple[Floats, int, int]:
    """Return a bound (Pa or N) for each piece of a history, the number of steps of slip, and that of those proven anew.

    The bound is not a number for a piece that is not proven.
    """
    store = history.store
    bound = store.residual + _rounding_of_terms(history)
    moving = np.flatnonzero((store.mode != 0) & np.isfinite(bound) & ~np.isin(store.trip, history.creep[:, 0]))
    chosen, anew = chosen_steps(store, moving), 0
    if history.problem.normal_load is not None and len(chosen) < len(moving):
        others = np.setdiff1d(moving, chosen)
        motion = MotionOnDiscs.of(history, others)  # friction is no larger than all that it balances
        size = sum(
            np.abs(one).sum(axis=1) for one in (motion.load, history.problem.body.total_damping * motion.rate, motion.thrust)
        )
        bound[others] += missed_growth(history, others) * size
    for some in np.array_split(chosen, len(chosen) // AT_ONCE + 1):
        seen, hidden, found = _bounds(history, some)
        known = hidden <= bound[some] + seen
        bound[some] = np.where(known, found, bound[some] + seen)
        anew += int(np.count_nonzero(known))
    return bound, len(moving), anew


def chosen_steps(store: Any, moving: Places) -> Places:
    """Return the steps that are proven anew, of those given: a kind is a piece of the law, a direction and a form of step."""
    if len(moving) <= SHARE:
        return moving
    kind = np.stack([store.law_piece[moving], store.mode[moving], store.bend[moving] != 0.0, _degree(store, moving)])
    _, of = np.unique(kind, axis=1, return_inverse=True)
    order = np.argsort(of, kind="stable")
    rank = np.arange(len(order)) - np.searchsorted(of[order], of[order])
    first = order[rank < FIRST]
    largest_ones = np.argsort(store.residual[moving])[-LARGEST:]
    even = np.linspace(0, len(moving) - 1, SHARE).astype(int)
    return np.asarray(moving[np.unique(np.concatenate([first[:SHARE], largest_ones, even]))])


def _degree(store: Any, n: Places) -> Places:
    """Return the degree of the slip rate's polynomial in pieces n: a series, an implicit step, or a straight line."""
    return np.asarray((store.rate[n] != 0.0).cumsum(axis=1).argmax(axis=1))


def _rounding_of_terms(history: History) -> Floats:
    """Return the rounding (Pa or N) of the terms of the contact equation, for each piece of a history."""
    store, problem = history.store, history.problem
    size = problem.strength + np.abs(store.load).sum(axis=1) + problem.body.total_damping * np.abs(store.rate).sum(axis=1)
    return np.asarray(POLYNOMIAL * np.where(store.mode != 0, size, 0.0))


# ---- one step after the other, from the history and the formula alone ------------------------------------------------------------

DEGREE = TERMS + 2
"""Number of coefficients (1) of the slip of a step, whose time is a parabola next to a fold."""
POINTS_OF_STEP = 0.5 - 0.5 * np.cos(np.pi * np.arange(ORDER + 1) / ORDER)
_POWERS = POINTS_OF_STEP ** np.arange(DEGREE)[:, None]
"""Powers of the Chebyshev points of a step, its two ends among them."""
_HALF_AT_ENDS = np.array([0.5, *[1.0] * (ORDER - 1), 0.5])
_COSINES = np.cos(np.pi / ORDER * (np.outer(np.arange(ORDER + 1), np.arange(ORDER + 1)) % (2 * ORDER)))
TO_CHEBYSHEV = 2.0 / ORDER * np.outer(_HALF_AT_ENDS, _HALF_AT_ENDS) * _COSINES
"""Matrix from values at these points to Chebyshev coefficients: a cosine transform of type I."""
_SHIFT = np.array([[comb(n, k) * 0.5 ** (n - k) if k <= n else 0.0 for k in range(DEGREE)] for n in range(DEGREE)])
"""Matrix from coefficients in xi to those in y = xi - 1/2."""
_RATIO = 2.0 * RADII + np.sqrt(4.0 * RADII**2 - 1.0)
"""q for each disc: the Chebyshev coefficients of a function that is bounded on the disc fall by q from order to order."""


def at_points(c: Floats) -> Disc:
    """Return the values of polynomials, one per row, at the Chebyshev points."""
    first, rest, powers = c[:, :1], c[:, 1:], _POWERS[1:]
    return Disc.of(first + rest @ powers, POLYNOMIAL * (np.abs(rest) @ powers) + SUM * np.abs(first))


def around_middle(c: Floats) -> Disc:
    """Return what polynomials, one per row, are on the discs of RADII around the middle of the step."""
    middle, orders = c @ _SHIFT, np.arange(1, DEGREE)[:, None]
    radius = np.abs(middle[:, 1:]) @ RADII**orders
    rounding = POLYNOMIAL * (np.abs(c) @ (0.5 + RADII) ** np.arange(DEGREE)[:, None])
    return Disc.of(middle[:, :1], radius + rounding)


class MotionOnDiscs(NamedTuple):
    """The motion in some steps, seen in the direction of slip: coefficients in xi, a row for each step, or discs of values."""

    slip: Any  # m: as the law counts it
    rate: Any  # m/s
    load: Any  # Pa or N
    thrust: Any  # Pa or N: the force of inertia
    states: list[Any]  # units of the states

    def on(self, places: Callable[[Floats], Disc]) -> MotionOnDiscs:
        """Return the discs of values that `places` makes of each polynomial."""
        states = [places(state) for state in self.states]
        return MotionOnDiscs(places(self.slip), places(self.rate), places(self.load), places(self.thrust), states)

    def pressed(self, given: list[Disc]) -> MotionOnDiscs:
        """Return the same with the last states, which follow from time alone, as given."""
        return self._replace(states=[*self.states[: -len(given)], *given])

    @classmethod
    def of(cls, history: History, n: Places) -> MotionOnDiscs:
        """Return the polynomials of pieces n of a history."""
        store, problem = history.store, history.problem
        way = store.mode[n, None].astype(float)
        rate, load, slip, thrust = (np.zeros((len(n), DEGREE)) for _ in range(4))
        rate[:, :TERMS], load[:, :TERMS] = way * store.rate[n], way * store.load[n]
        load[:, :1] += way * problem.strength
        order = np.arange(1, DEGREE)
        slip[:, 1:] = store.speed[n, None] * rate[:, :-1] / order
        slip[:, 2:] += 2.0 * store.bend[n, None] * rate[:, :-2] / order[1:]
        slip *= way if problem.friction.counts == "net" else 1.0
        slip[:, 0] = problem.law_slip + store.law_slip[n]
        if problem.body.has_inertia:
            thrust[:, :-1] = problem.body.inertia / store.speed[n, None] * order * rate[:, 1:]
        states = [np.pad(store.state[n, i], ((0, 0), (0, 2))) for i in range(len(problem.contact_law.states))]
        for i in problem.friction.reverses:
            states[i] *= way
        return cls(slip, rate, load, thrust, states)


def _bounds(history: History, n: Places) -> Floats:
    """Return the largest |g| (Pa or N) at the points of each of some steps, the error between them, and a bound on both."""
    found = np.full((3, len(n)), np.inf)
    piece = history.store.law_piece[n]
    for i in np.unique(piece).tolist():
        own = np.flatnonzero(piece == i)
        motion, unsure = MotionOnDiscs.of(history, n[own]), _unsure_duration(history, n[own])
        there, around = motion.on(at_points), motion.on(around_middle)
        if history.problem.normal_load is not None:  # S(t) is known from the problem: what the engine wrote is no premise
            normal = NormalLoads.of(history, n[own])
            there, around = there.pressed(normal.at(POINTS_OF_STEP)), around.pressed(normal.around_middle(RADII))
        with np.errstate(over="ignore", invalid="ignore"):  # where nothing is known, radii are infinite or no numbers
            values = _with_duration(_lacking(history.problem, i, there), there.thrust, unsure)
            everywhere = largest(_lacking(history.problem, i, around)) + unsure * largest(around.thrust)
            found[:, own] = from_points(values, everywhere)
    return found


def _unsure_duration(history: History, n: Places) -> Floats:
    """Return the relative rounding (1) of the duration of each of some steps, which is a difference of two times.

    Only the force of inertia needs the duration. Next to a fold, where time is a parabola, there is no such rounding.
    """
    if not history.problem.body.has_inertia:
        return np.zeros((len(n), 1))
    return np.asarray(OF_DURATION * history.round_trip_time / np.abs(history.store.speed[n, None]))


def _with_duration(lacking: Disc, thrust: Disc, unsure: Floats) -> Disc:
    """Return g for the duration, within its rounding, that suits the force of inertia best: it goes with its inverse."""
    square = (thrust.centre**2).sum(axis=1, keepdims=True)
    better = -(lacking.centre * thrust.centre).sum(axis=1, keepdims=True) / np.where(square > 0.0, square, 1.0)
    return lacking._replace(centre=lacking.centre + np.clip(np.nan_to_num(better), -unsure, unsure) * thrust.centre)


def _lacking(problem: Problem, piece: int, motion: MotionOnDiscs) -> Disc:
    """Return g = Z v + S mu + m dv/dt - load (Pa or N) where the motion is in discs, by the formula of a piece of the law."""
    law, damping, (slip, rate, load, thrust, states) = problem.contact_law, problem.body.total_damping, motion
    variables: dict[Expression, Disc] = dict(zip(VARIABLES, (slip, rate, *states), strict=False))
    mu = on_discs(law.trees()[piece], law.numbers(piece), variables)
    centre = damping * rate.centre + problem.normal * mu.centre + thrust.centre - load.centre
    radius = damping * rate.radius + problem.normal * mu.radius + thrust.radius + load.radius
    terms = damping * rate.most + problem.normal * mu.most + thrust.most + load.most
    return Disc(centre, radius + SUM * terms, 0.0)


def from_points(values: Disc, everywhere: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the largest value at the points of each step, the error between them, and a bound on both, from bounds M on RADII."""
    rounding, highest = values.radius.max(axis=1), np.abs(values.centre).max(axis=1)
    parts = np.abs(values.centre @ TO_CHEBYSHEV)
    hidden = (4.0 * everywhere * _RATIO**-ORDER / (_RATIO - 1.0)).min(axis=1)
    half = (2.0 * everywhere * _RATIO ** (-0.5 * ORDER) / (_RATIO - 1.0)).min(axis=1)
    by_sum = parts.sum(axis=1) + (ORDER + 1) ** 0.5 * 2.0 * rounding + hidden
    by_values = 2.0**0.5 * (highest + rounding + half) + half
    return np.nan_to_num(highest + rounding), np.nan_to_num(hidden, nan=np.inf), np.fmin(by_sum, by_values)
