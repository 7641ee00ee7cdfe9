"""Slow sliding of a slab under a law with states that never sticks, such as rate and state: motion averaged over round trips.

Under a rigid driver, from one round trip to the next and at each offset phi in it,

    tau_n - tau_(n-1) = Z (2 V - v_n - v_(n-1)),

the trapezoidal rule for dtau/dn = 2 Z (V - v). While little changes in a round trip, tau(phi, n) is a smooth function of n: a
*pattern* of waves that bounces in the slab and rises slowly where the contact is slower than the driver. Its offsets feel each
other only through the states w, which change by what a whole round trip adds:

    S mu(v, w) = tau(phi, n),    dw/dn = T <dw/dt(v, w)>,    <> the mean over the offsets of a round trip of length T.

These are ordinary differential equations in n. Within a round trip the states deviate from the averaged ones by what the pattern
adds, their *ripple* r(phi), whose mean is zero. To second order, v and dw/dt are those at the states w + r. The terms of third
order that are left out are estimated as what the ripple does, times the largest relative change of the slip rate in a round trip.
Left out, too, is the difference between the sum and the integral, Z/6 d2v/dn2 in dtau/dn: it acts as if a third of the slab's mass
slipped with the contact, beside the mass that the contact may have itself (m_c, as m_c/T instead of Z/6). What both do to the slip
shows where the motion is followed three times side by side: with the ripple, without it, and with ripple and inertia. Within the
round trip a mass of the contact must have nothing to do: the force m_c dv/dphi is far smaller than the direct effect S dmu/dln v.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from stickslip.engine.state.layout import Floats
from stickslip.friction.formula import RATE, STATES, evaluate, slope_formula
from stickslip.problem import Problem

OFFSETS = 12
"""The motion is followed at this many offsets in each stretch of the round trip."""
ROUNDS_TO_MEAN = 3
"""Number of rounds to match the averaged motion to a round trip."""
BOTH, PLAIN, HEAVY = range(3)
"""The three motions that are followed side by side: with ripple, without it, and with ripple and inertia."""
RIPPLES, INERTIA = np.array([1.0, 0.0, 1.0]), np.array([[0.0], [0.0], [1.0]])
"""Which of them have ripple, and which inertia."""
PLACES_OF_OFFSETS = 0.5 - 0.5 * np.cos(np.pi * (np.arange(OFFSETS) + 0.5) / OFFSETS)
"""Places of the offsets in a stretch, on [0, 1]: the roots of a Chebyshev polynomial."""
_BASIS = [np.polynomial.Chebyshev.basis(k, domain=[0.0, 1.0]) for k in range(OFFSETS)]
_SHARES = np.linalg.inv(np.array([one(PLACES_OF_OFFSETS) for one in _BASIS]).T)
_IN_X = [one.convert(kind=np.polynomial.Polynomial, domain=[0.0, 1.0], window=[0.0, 1.0]).coef for one in _BASIS]
_POWERS = np.array([np.pad(one, (0, OFFSETS - 1 - k)) for k, one in enumerate(_IN_X)]).T
INTEGRALS = np.array([one.integ(lbnd=0.0)([*PLACES_OF_OFFSETS, 1.0]) for one in _BASIS]).T @ _SHARES
"""Integrals from 0 to each of these places and to 1, of the polynomial through values there."""

SLOPES = np.array([one.deriv()(PLACES_OF_OFFSETS) for one in _BASIS]).T @ _SHARES
"""Slopes at these places, of the polynomial through values there."""


def through(values: Floats, places: Floats) -> Floats:
    """Return the polynomial through values at PLACES_OF_OFFSETS at other places on [0, 1]."""
    return np.asarray(np.polynomial.chebyshev.chebval(2.0 * places - 1.0, _SHARES @ values))


def to_powers(values: Floats) -> Floats:
    """Return the coefficients, in powers of the place, of the polynomial through values at PLACES_OF_OFFSETS (OFFSETS, ...)."""
    return np.asarray(_POWERS @ (_SHARES @ values))  # one after the other: their product would lose nine digits


@dataclass(frozen=True)
class Offsets:
    """Offsets in a round trip for following the motion: OFFSETS in each of some stretches of it."""

    edges: Floats  # (stretches + 1), s
    period: float  # s

    @classmethod
    def of(cls, edges: Floats, log_rate: Callable[[Floats], Floats], period: float, resolved: float) -> Self:
        """Return offsets in as few stretches, between some of the edges of pieces (s), as show the slip rate and its logarithm.

        A stretch of several pieces is halved until the polynomial through its offsets agrees in the middle of each piece, too,
        within `resolved`.
        """
        middle, kept, ahead = 0.5 * (edges[:-1] + edges[1:]), [0], [(0, len(edges) - 1)]
        while ahead:
            first, last = ahead.pop()
            start, width, within = edges[first], edges[last] - edges[first], middle[first:last]
            places, logs, there = (within - start) / width, log_rate(start + width * PLACES_OF_OFFSETS), log_rate(within)
            off = np.abs(through(logs, places) - there).max(), np.abs(through(np.exp(logs), places) / np.exp(there) - 1.0).max()
            if last - first == 1 or max(off) <= resolved:
                kept.append(last)
            else:
                half = (first + last) // 2
                ahead += [(half, last), (first, half)]
        return cls(edges[kept], period)

    @cached_property
    def phase(self) -> Floats:
        """The offsets (stretches, OFFSETS), s."""
        return np.asarray(self.edges[:-1, None] + PLACES_OF_OFFSETS * np.diff(self.edges)[:, None])

    @cached_property
    def share(self) -> Floats:
        """The offsets as shares of the round trip."""
        return np.asarray(self.phase.ravel() / self.period)

    @cached_property
    def weights(self) -> Floats:
        """The weights of a mean over the round trip."""
        return np.asarray((np.diff(self.edges)[:, None] * INTEGRALS[-1]).ravel() / self.period)

    def ripple(self, growth: Floats) -> tuple[Floats, Floats]:
        """Return how far what grows within a round trip is from its averaged growth: at the offsets, and where a round trip begins.

        `growth` is the rate of growth per round trip at the offsets (..., offsets). The mean of the ripple is zero.
        """
        stretches = growth.reshape(*growth.shape[:-1], *self.phase.shape) * (np.diff(self.edges)[:, None] / self.period)
        pieces = stretches @ INTEGRALS.T
        before = np.cumsum(pieces[..., -1], axis=-1) - pieces[..., -1]
        grown = (pieces[..., :-1] + before[..., None]).reshape(growth.shape) - self.share * (growth @ self.weights)[..., None]
        mean = grown @ self.weights
        return np.asarray(grown - mean[..., None]), np.asarray(-mean)


@dataclass(frozen=True)
class Slow:
    """Averaged motion at one moment, of three motions side by side. Rates are magnitudes, in the direction of the driver."""

    change: Floats  # (3, offsets + states + 1): of log rate, states and slip, in a round trip
    ripple: Floats  # (states, 3, offsets): of the states
    quicker: Floats  # (3, offsets): log of the rate at the states with their ripple, minus that of the averaged rate
    state_begins: Floats  # (3, states): ripple of the states where a round trip begins
    slip_begins: Floats  # (3,), m: the same of the slip
    pace: float  # largest relative change of the slip rate in a round trip, from load or states
    rises: bool  # True if friction rises with the slip rate everywhere


@dataclass(frozen=True)
class SlowMotion:
    """The equations of slow sliding, for three motions side by side.

    A state holds for each (a row) the logarithm of the slip rate (m/s) at the offsets, the states, and the slip (m).
    """

    problem: Problem
    offsets: Offsets

    @cached_property
    def size(self) -> int:
        """The number of offsets."""
        return self.offsets.phase.size

    @cached_property
    def speed(self) -> float:
        """The magnitude of the pull rate, m/s."""
        return abs(self.problem.first_pull_rate)

    def friction(self, rate: Floats, states: Floats) -> Floats:
        """Return friction S mu (Pa)."""
        law = self.problem.friction
        return np.asarray(self.problem.normal * evaluate(law.trees()[0], law.numbers(), self.problem.law_slip, rate, *states))

    def slopes(self, rate: Floats, states: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of friction by the logarithm of the slip rate (Pa) and by the states (Pa over their units)."""
        law = self.problem.friction
        at = law.numbers(), self.problem.law_slip, rate, *states
        by_rate, *by_state = (evaluate(slope_formula(law.trees()[0], one), *at) for one in (RATE, *STATES[: len(states)]))
        spread = [np.broadcast_to(one, rate.shape) for one in by_state]
        return np.asarray(self.problem.normal * rate * by_rate), self.problem.normal * np.array(spread)

    def evolution(self, rate: Floats, states: Floats) -> Floats:
        """Return by how much the states grow in a round trip at these rates (m/s)."""
        law = self.problem.friction
        at = law.numbers(), self.problem.law_slip, rate, *states
        return self.offsets.period * np.array([np.broadcast_to(evaluate(tree, *at), rate.shape) for tree in law.state_trees()])

    def at(self, y: Floats) -> Slow:
        """Return the motion in a state (3, offsets + states + 1)."""
        rate, w, mean = np.exp(y[:, : self.size]), y[:, self.size : -1].T[..., None], self.offsets.weights
        direct, by_state = self.slopes(rate, w)
        ripple, state_begins = self.offsets.ripple(self.evolution(rate, w))
        ripple = ripple * RIPPLES[:, None]
        quicker = -(by_state * ripple).sum(axis=0) / direct
        there = rate * np.exp(quicker)
        grows, slips = self.evolution(there, w + ripple) @ mean, self.offsets.period * there
        z2 = 2.0 * self.problem.body.impedance
        loaded, eased = z2 * (self.speed - there) / direct, (by_state * grows[..., None]).sum(axis=0) / direct
        faster = loaded - eased
        inertia = INERTIA * (z2 / 6.0 + 2.0 * self.problem.body.inertia / self.offsets.period)
        faster -= inertia * there * faster * faster / direct  # where v grows as 1/n or falls so, v'' = 2 v'^2 / v
        pace = max(float(np.abs(one[BOTH]).max()) for one in (loaded, eased))
        change = np.concatenate([faster, grows.T, (slips @ mean)[:, None]], axis=1)
        begins = state_begins.T * RIPPLES[:, None], self.offsets.ripple(slips)[1] * RIPPLES
        return Slow(change, ripple, quicker, *begins, pace, bool((direct > 0.0).all()))

    def push(self, y: Floats) -> float:
        """Return the largest force (as a share of the direct effect) that the mass of the contact takes to follow the pattern."""
        rate = np.exp(y[BOTH, : self.size])
        steepness = rate.reshape(self.offsets.phase.shape) @ SLOPES.T / np.diff(self.offsets.edges)[:, None]
        direct, _ = self.slopes(rate, y[BOTH, self.size : -1, None])
        return float(np.abs(self.problem.body.inertia * steepness.ravel() / direct).max())

    def start(self, rate: Floats, states: Floats) -> Floats:
        """Return the averaged state where a round trip begins, from the slip rates (m/s) in the one before and the states now."""
        log_rate = np.log(rate)
        y = np.tile(np.concatenate([log_rate, states, [0.0]]), (3, 1))
        for _ in range(ROUNDS_TO_MEAN):
            trip = RoundTrip(self, self.later(y, -1), y)
            log_rates = log_rate - trip.at_begin.quicker + y[:, : self.size] - trip.log_rate()
            now = trip.at_end
            y = np.concatenate([log_rates, states - now.state_begins, -now.slip_begins[:, None]], axis=1)
        return y

    def later(self, y: Floats, trips: int) -> Floats:
        """Return the averaged state a few round trips after y (before it if negative), by the classical Runge-Kutta method."""
        for _ in range(abs(trips)):
            sign = 1.0 if trips > 0 else -1.0
            a = sign * self.at(y).change
            b = sign * self.at(y + 0.5 * a).change
            c = sign * self.at(y + 0.5 * b).change
            y = y + (a + 2.0 * (b + c) + sign * self.at(y + c).change) / 6.0
        return y

    def means(self, y: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the averaged load (Pa), slip rate (m/s) and states of several states (moments, offsets + states + 1)."""
        rate, w, mean = np.exp(y[:, : self.size]), y[:, self.size : -1], self.offsets.weights
        load = self.friction(rate, w.T[..., None]) + self.problem.body.impedance * rate
        return np.asarray(load @ mean), np.asarray(rate @ mean), w


@dataclass(frozen=True)
class RoundTrip:
    """The averaged motion in one round trip: what it is where the round trip begins and ends, and a cubic between."""

    motion: SlowMotion
    begin: Floats
    end: Floats

    @cached_property
    def at_begin(self) -> Slow:
        """The motion where the round trip begins."""
        return self.motion.at(self.begin)

    @cached_property
    def at_end(self) -> Slow:
        """The motion where the round trip ends."""
        return self.motion.at(self.end)

    def log_rate(self) -> Floats:
        """Return the logarithm of the averaged slip rate (m/s), at each offset when the round trip has come there."""
        return self._cubic(*(one[:, : self.motion.size] for one in self._ends))

    def states(self) -> Floats:
        """Return the averaged states (3, states, offsets) when the round trip has come to each offset."""
        return self._cubic(*(one[:, self.motion.size : -1, None] for one in self._ends))

    def with_ripple(self) -> tuple[Floats, Floats]:
        """Return the slip rate (m/s) and the states (states, offsets) of the contact at each offset, not averaged."""
        now = self.at_begin
        return np.exp(self.log_rate()[BOTH] + now.quicker[BOTH]), self.states()[BOTH] + now.ripple[:, BOTH]

    @property
    def _ends(self) -> tuple[Floats, Floats, Floats, Floats]:
        return self.begin, self.end, self.at_begin.change, self.at_end.change

    def _cubic(self, begin: Floats, end: Floats, first: Floats, last: Floats) -> Floats:
        """Return at the offsets a cubic with these values and slopes where the round trip begins and ends."""
        x, rise = self.motion.offsets.share, end - begin
        return np.asarray(begin + x * (first + x * (3.0 * rise - 2.0 * first - last + x * (first + last - 2.0 * rise))))
