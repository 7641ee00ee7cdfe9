"""Work out what follows from the statements of a friction law: expression trees, values, slopes and bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, reduce
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.arrays import anywhere, at_least, everywhere, shared
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import NumberSeries, Quantity, fields_of, quantities_of
from stickslip.friction.contract import Formula, LawContract, one_argument
from stickslip.friction.formula.bounds import bounds
from stickslip.friction.formula.differences import value_and_slopes
from stickslip.friction.formula.expression import RATE, SLIP, STATES, Expression, Parameter, as_expression, depends_on
from stickslip.friction.formula.operations.sets import Interval

Literals = tuple[tuple[str, float], ...]
"""Names and values of the parameters that enter a formula as plain numbers."""


@lru_cache(maxsize=256)
def _trees(pieces: tuple[Formula, ...], parameters: tuple[str, ...], literals: Literals, states: int) -> tuple[Expression, ...]:
    """Return the formulas as expression trees; laws that differ only in the values of their parameters share them."""
    symbols = SimpleNamespace(**({name: Parameter(name) for name in parameters} | dict(literals)))
    made = {formula: as_expression(formula(symbols, SLIP, RATE, *STATES[:states])) for formula in dict.fromkeys(pieces)}
    return tuple(made[formula] for formula in pieces)


@lru_cache(maxsize=256)
def _contain(trees: tuple[Expression, ...], variable: Expression) -> bool:
    return any(depends_on(tree, variable) for tree in dict.fromkeys(trees))


@dataclass(frozen=True)
class LawValues(LawContract):
    """What follows from a law's statements: its numbers, formulas as trees, values, slopes and bounds."""

    # ---- the numbers in the formulas ----------------------------------------------------------------------------------------

    def parameters(self) -> tuple[str, ...]:
        """Return the names of the numbers in the formulas, in the order of their values in compiled code."""
        return tuple(quantities_of(type(self)))

    def piece_values(self, i: int) -> tuple[float, ...]:
        """Return the values of `parameters` in piece i: the values of the law, unless its pieces have different values."""
        values = (getattr(self, name) for name in self.parameters())
        return tuple(value if isinstance(value, float) or np.ndim(value) else float(value) for value in values)

    def numbers(self, i: int = 0) -> dict[str, float]:
        """Return the values of `parameters` in piece i, by name."""
        return dict(zip(self.parameters(), self.piece_values(i), strict=True))

    def literals(self) -> dict[str, float]:
        """Return the parameters that enter the tree as plain numbers because its shape depends on them: whole exponents."""
        return {name: getattr(self, name) for name, declared in quantities_of(type(self)).items() if declared.whole}

    def inner_states(self, given: Sequence[float]) -> tuple[float, ...]:
        """Return the states, given as users see them, in the form that the formulas use."""
        if len(given) < 2:
            return tuple(float(self.inner_state(value)) for value in given)
        return tuple(float(value) for value in self.inner_state(np.asarray(given, float)))

    # ---- the formulas as trees ----------------------------------------------------------------------------------------------

    def trees(self) -> tuple[Expression, ...]:
        """Return the formulas of `pieces` as expression trees in SLIP, RATE, parameters and, for a law with states, STATES."""
        return self._own_trees

    @cached_property
    def _own_trees(self) -> tuple[Expression, ...]:
        return _trees(self.pieces, self.parameters(), tuple(self.literals().items()), len(self.states))

    def state_trees(self) -> tuple[Expression, ...]:
        """Return dw/dt of each state as an expression tree in the variables of `trees`."""
        if not self.states:
            return ()
        rates = self.state_rate if isinstance(self.state_rate, tuple) else (self.state_rate,)
        return _trees(rates, self.parameters(), tuple(self.literals().items()), len(self.states))

    # ---- values -------------------------------------------------------------------------------------------------------------

    def piece_at(self, u: ArrayLike, v: ArrayLike = 0.0) -> NDArray[np.intp]:
        """Return the index of the piece that applies at slip u (m) and slip rate v (m/s); arguments broadcast.

        At a knot it is the piece above the knot.
        """
        has_knots = isinstance(self.knots, np.ndarray) or bool(self.knots)
        if not has_knots and isinstance(u, float) and isinstance(v, float):
            return np.zeros((), np.intp)
        if not has_knots:
            return np.zeros(np.broadcast(u, v).shape, np.intp)
        slip, rate = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        return np.asarray(np.searchsorted(np.asarray(self.knots), slip if self.knot_variable == "slip" else rate, side="right"))

    def piece_coefficient(self, i: int, u: Any, v: Any, w: Any = 0.0) -> Any:
        """Return mu by the formula of piece i, also outside its interval; complex slips and rates give complex values."""
        return self.pieces[i](SimpleNamespace(**self.numbers(i)), u, v, *self.each_state(w))

    def each_state(self, w: Any) -> tuple[Any, ...]:
        """Return the states in `w`: `w` itself, or its rows if the law has several states; a single number stands for all."""
        many = len(self.states)
        return tuple(w) if many > 1 and np.ndim(w) else (w,) * many

    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Return the friction coefficient mu (no unit) while the contact slips; the arguments broadcast.

        `u` is the slip (m) as the law counts it, `v` the magnitude of the slip rate (m/s), where 0 means the limit v = 0+, and `w`
        the state in the form that the formulas use (`inner_state`); for several states it is an array with one more axis in front.
        """
        if len(self.pieces) == 1 and isinstance(u, float) and isinstance(v, float) and isinstance(w, float):
            return self._at_one_point(np.float64(u), np.float64(v), [np.float64(w)] * len(self.states))
        slip, rate, *states = self._broadcast(u, v, w)
        if len(self.pieces) == 1 and not slip.ndim:
            return self._at_one_point(slip[()], rate[()], [state[()] for state in states])
        values = np.empty(slip.shape)
        with np.errstate(over="ignore", under="ignore"):  # exp(-v / 1e-9) may underflow; in a denominator exp(v / 1e-9) overflows
            for i, chosen in self._by_piece(slip, rate):
                there = one_argument([state[chosen] for state in states])
                values[chosen] = self.piece_coefficient(i, slip[chosen], rate[chosen], there)
        return values

    def _at_one_point(self, slip: Any, rate: Any, states: Sequence[Any]) -> NDArray[np.float64]:
        with np.errstate(over="ignore", under="ignore"):
            return np.asarray(self.piece_coefficient(0, slip, rate, one_argument(states)), float)

    def static_coefficient(self, u: ArrayLike) -> NDArray[np.float64]:
        """Return the static friction coefficient at slip u (m): the largest |traction| / normal stress while v = 0."""
        return self.coefficient(u) + self.static_excess

    def slopes(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Return the derivatives of mu by slip (1/m), by slip rate (s/m) and by each state, with one more axis in front.

        The arguments are those of `coefficient`. The derivatives are exact but for rounding.
        """
        slip, rate, *states = self._broadcast(u, v, w)
        found, trees = np.empty((2 + len(states), *slip.shape)), self.trees()
        for i, chosen in self._by_piece(slip, rate):
            there = (one[chosen] for one in (slip, rate, *states))
            found[:, chosen] = value_and_slopes(trees[i], self.numbers(i), *there)[1]
        return found

    def _broadcast(self, u: ArrayLike, v: ArrayLike, w: ArrayLike) -> Sequence[NDArray[np.float64]]:
        given = [np.asarray(one, float) for one in (u, v, *self.each_state(w))]
        return given if all(one.shape == given[0].shape for one in given) else np.broadcast_arrays(*given)

    def _by_piece(self, slip: NDArray[np.float64], rate: NDArray[np.float64]) -> list[tuple[int, Any]]:
        """Return each piece that applies somewhere, and where, as an index of the arrays."""
        if len(self.pieces) == 1:
            return [(0, ...)]
        piece = self.piece_at(slip, rate)
        return [(i, piece == i) for i in np.unique(piece).tolist()]

    # ---- properties -----------------------------------------------------------------------------------------------------------

    @cached_property
    def depends_on_slip(self) -> bool:
        """True if mu changes with slip."""
        return self._depends_on(SLIP)

    @cached_property
    def depends_on_rate(self) -> bool:
        """True if mu changes with slip rate, or steps down from static to sliding friction."""
        return self.static_excess != 0.0 or self._depends_on(RATE)

    def _depends_on(self, variable: Expression) -> bool:
        knotted = len(self.pieces) > 1 and self.knot_variable == variable.operation
        return knotted or _contain(self.trees(), variable)

    @property
    def creeps(self) -> bool:
        """True if the contact never rests, but slips at rates that differ by orders of magnitude, as faults do."""
        return not self.sticks and not self.reverses

    @property
    def states_range(self) -> bool:
        """True if the law states its `range`."""
        return type(self).range is not LawValues.range

    @override
    def range(self) -> tuple[float, float]:
        low, high = (at_least(0.0, end) for end in self._bounds)
        return (low, high) if isinstance(low, np.ndarray) or isinstance(high, np.ndarray) else (float(low), float(high))

    @property
    @override
    def can_be_negative(self) -> bool:
        return not (self.states_range or self.reverses) and not everywhere(self._bounds[0] >= 0.0)

    @cached_property
    def _bounds(self) -> Interval:
        """Bounds of the formula over all slips, slip rates and states, and the largest friction at rest."""
        found = []
        edges = {"slip": (0.0 if self.counts == "path" else -np.inf, np.inf), "rate": (0.0, np.inf)}
        first, last = edges[self.knot_variable]
        for i, (tree, ends) in enumerate(zip(self.trees(), pairwise((first, *self.knots, last)), strict=True)):
            numbers, place = self.numbers(i), edges | {self.knot_variable: ends}
            found.append(bounds(tree, numbers, place["slip"], place["rate"]))
            if anywhere(self.static_excess):
                rest = bounds(tree, numbers, place["slip"], (0.0, 0.0))
                found.append((found[-1][0], rest[1] + self.static_excess))
        lows, highs = zip(*found, strict=True)
        return shared(reduce(np.minimum, lows)), shared(reduce(np.maximum, highs))

    @cached_property
    def variation(self) -> float:
        """A finite size of the friction coefficient's changes (no unit).

        It is the upper minus the lower bound of `range`. For friction without an upper bound it is the change between slip rates
        0+ and 1 m/s, at slip 0.
        """
        low, high = self.range()
        if everywhere(np.isfinite(high)):
            return high - low
        return float(np.ptp(self.coefficient(0.0, np.linspace(0.0, 1.0, 101))))

    @property
    def rate_scales(self) -> tuple[float, ...]:
        """The characteristic slip rates (m/s): the parameters in m/s, and the inverses of those in s/m."""
        scales: list[float] = []
        for name, (declared, _) in fields_of(type(self)).items():
            item = declared.item if isinstance(declared, NumberSeries) else declared
            if isinstance(item, Quantity) and item.unit in ("m/s", "s/m"):
                value = getattr(self, name) or ()
                sizes = [abs(number) for number in (value if isinstance(value, tuple) else (value,)) if number]
                scales += [size if item.unit == "m/s" else 1.0 / size for size in sizes]
        return tuple(scales)


def as_number(value: Any) -> float:
    """Return a number as a float, and nan for anything else."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return math.nan


def stated_range(law: LawValues) -> tuple[float, float]:
    """Return the bounds of a law's friction coefficient, as it states them. Raises InputError if they are not two numbers."""
    given: Any = law.range()
    if not (isinstance(given, tuple | list) and len(given) == 2 and as_number(given[0]) <= as_number(given[1])):
        raise InputError(
            f"{type(law).__name__}: range() must return two numbers, a lower and an upper bound of mu, got {str(given)[:60]}"
        )
    return as_number(given[0]), as_number(given[1])
