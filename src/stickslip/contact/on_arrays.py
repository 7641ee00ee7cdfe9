"""The friction law and the contact equation at many points at once, for solvers that have a whole line or plane of contact.

The formulas are those that the engine compiles, evaluated by numpy. Each point has its own slip, slip rate, state and load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.contact.equation import Resistance
from stickslip.contact.uniqueness import regime_at
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.contract import one_argument
from stickslip.friction.formula.differences import value_and_slopes
from stickslip.friction.formula.expression import Expression
from stickslip.friction.law import FrictionLaw

ITERATIONS = 200
"""Largest number of steps of Newton's method or bisection: bisection alone takes some 60 for all digits."""


class Friction(NamedTuple):
    """A quantity of the law at each point, with its derivatives by slip, slip rate and state.

    The quantity is the friction coefficient (no unit), or the rate of change of a state (its unit per second). For a law with two
    states `by_state` has one more axis in front, for the states.
    """

    value: Floats
    by_slip: Floats
    by_rate: Floats
    by_state: Floats


@dataclass(frozen=True)
class ContactOnArrays:
    """A friction law under a normal stress (Pa), on a contact whose slip sends waves of an impedance (Pa s/m) away.

    Raises InputError for an impedance or a normal stress that is not positive everywhere.
    """

    law: FrictionLaw
    impedance: float | Floats
    normal: float | Floats

    def __post_init__(self) -> None:
        for name in ("impedance", "normal"):
            given = np.asarray(getattr(self, name), float)
            if not (np.isfinite(given) & (given > 0.0)).all():
                raise InputError(f"ContactOnArrays: {name} must be finite and above 0 at every point")

    @cached_property
    def _is_irregular(self) -> bool:
        """True if friction depends on the slip rate only, and several slip rates may solve the contact equation somewhere."""
        law = self.law
        if law.states or law.depends_on_slip or not law.depends_on_rate:
            return False
        return regime_at(Resistance(law, float(np.min(self.impedance / np.asarray(self.normal, float))), 1.0, 0.0)) != "regular"

    def friction(self, slip: ArrayLike, rate: ArrayLike, state: ArrayLike = 0.0) -> Friction:
        """Return the friction coefficient of slip: see `FrictionLaw.coefficient` for the arguments, which broadcast."""
        trees = self.law.trees()
        return self._at_each_piece(lambda piece: trees[piece], slip, rate, state)

    def state_rate(self, slip: ArrayLike, rate: ArrayLike, state: ArrayLike, number: int = 0) -> Friction:
        """Return the rate of change of a state, the first by default, with the arguments of `friction`.

        Raises InputError for a law without that state.
        """
        if number >= len(self.law.states):
            raise InputError(f"ContactOnArrays: {self.law.kind} has no {'second ' if self.law.states else ''}state")
        tree = self.law.state_trees()[number]
        return self._at_each_piece(lambda _: tree, slip, rate, state)

    def _at_each_piece(self, tree_of: Callable[[int], Expression], slip: ArrayLike, rate: ArrayLike, state: ArrayLike) -> Friction:
        given = (slip, rate, *(self.law.each_state(state) or (0.0,)))
        places = np.stack(np.broadcast_arrays(*(np.asarray(one, float) for one in given)))
        found, piece = np.empty((2 + len(places) - 1, *places.shape[1:])), self.law.piece_at(places[0], places[1])
        for i in np.unique(piece).tolist():
            own = piece == i
            value, slopes = value_and_slopes(tree_of(i), self.law.numbers(i), *places[:, own])
            found[:, own] = value, *slopes
        value, by_slip, by_rate, *by_state = found
        return Friction(value, by_slip, by_rate, by_state[0] if len(by_state) == 1 else np.stack(by_state))

    def rate(self, load: ArrayLike, slip: ArrayLike, state: ArrayLike = 0.0) -> Floats:
        """Return the slip rate v >= 0 (m/s) that solves Z v + S mu(u, v) = load at each point (paper eqs 12-13).

        `load` (Pa) is along the direction of slip: what the traction would be if the contact could not slip. `slip` (m) is as the
        law counts it, and `state` in the form that the formulas use, for a law that has one; a row for each of two. The rate is 0
        where the strength bears the load. Raises InputError if several slip rates solve the equation at a point. This is proven for
        friction that depends on the slip rate only; under other laws the slopes of Z v + S mu at 21 slip rates tell.
        """
        if self._is_irregular:
            raise self._several()
        given = (load, slip, self.impedance, self.normal, *(self.law.each_state(state)))
        load, slip, impedance, normal, *states = np.broadcast_arrays(*(np.asarray(one, float) for one in given))
        state = one_argument(states)
        at_rest = normal * (self.friction(slip, 0.0, state).value + self.law.static_excess)
        slips = load > at_rest
        found = np.zeros(load.shape)
        if slips.any():
            there = one_argument([one[slips] for one in states])
            found[slips] = self._root(load[slips], slip[slips], there, impedance[slips], normal[slips])
        return found

    def _root(self, load: Floats, slip: Floats, state: Any, *contact: Floats) -> Floats:
        """Return the root of each point by Newton's method, which bisects where it would leave the bracket."""
        impedance, normal = contact

        def missing(rate: Floats) -> tuple[Floats, Floats]:
            mu = self.friction(slip, rate, state)
            return impedance * rate + normal * mu.value - load, impedance + normal * mu.by_rate

        low = np.zeros(load.shape)
        high = np.maximum((load - normal * self.friction(slip, 0.0, state).value) / impedance, np.finfo(float).tiny)
        for _ in range(ITERATIONS):  # friction that falls with the slip rate lets the contact slip faster than this
            too_slow = missing(high)[0] < 0.0
            if not too_slow.any():
                break
            high = np.where(too_slow, 2.0 * high, high)
        rate = 0.5 * high
        for _ in range(ITERATIONS):
            value, slope = missing(rate)
            low, high = np.where(value <= 0.0, rate, low), np.where(value > 0.0, rate, high)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = rate - value / slope
            middle = np.where(low > 0.0, np.sqrt(low) * np.sqrt(high), 1e-3 * high)
            following = np.where((low < step) & (step < high), step, middle)
            done = (np.abs(following - rate) <= 1e-15 * rate) | (np.nextafter(low, high) >= high)
            rate = np.where(done, rate, following)
            if done.all():
                break
        self._check_unique(missing, rate)
        return rate

    def _check_unique(self, missing: Callable[[Floats], tuple[Floats, Any]], rate: Floats) -> None:
        """Refuse solutions that are not the only ones, as far as slopes between rest and the solution, and beyond it, show."""
        for share in (*np.linspace(0.0, 1.0, 17), 1.5, 2.0, 4.0, 16.0):
            if (missing(share * rate)[1] <= 0.0).any():
                raise self._several()

    def _several(self) -> InputError:
        return InputError(
            f"ContactOnArrays: under {self.law.kind} several slip rates may solve the contact equation, because friction falls with"
            " the slip rate faster than Z v rises: a selection rule must decide, which only stickslip.simulate follows"
        )
