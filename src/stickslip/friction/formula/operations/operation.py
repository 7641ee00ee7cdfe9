"""The record of one operation of formulas, and what its rules may ask of the code that walks over a formula.

Rules on numbers compute: the value, how far it changes, its slope, its bounds. Rules on texts write lines of generated code, with
these names for node number i: c[i] is its value at the reference point, e{i} its difference from that value, n{i}_{k} its k-th
Taylor coefficient, w{i}_{k} = k n{i}_{k} the weight of that, r{i} its radius around the centre of a disc.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

import numpy as np

from stickslip.foundation.errors import InputError
from stickslip.friction.formula.expression import Expression, as_expression
from stickslip.friction.formula.operations.sets import Disc

LARGEST_EXPONENT = 150.0
"""Largest exponent, dimensionless, of an exp whose overflow is harmless; larger ones are replaced by it. A quotient over e^150 is
negligible, exp(-e^150) is zero, and the square and the series of e^150 are still finite."""
TINIEST = 1e-300
"""Smallest bound of a magnitude from below. In place of zero it makes radii huge instead of infinite, which proves as little, and
no division by zero."""
FRESH = 4
"""Number of terms of a sum that are added last, because they need the newest coefficients (see `sum_of`)."""

Dimension = dict[str, Fraction]
"""Exponents of m, kg and s in a unit; those that are zero are left out."""
FORMULA_UNITS = "u is in m, v in m/s, a number without unit is a pure number"
"""End of a message about a wrong unit."""


class Levels(Protocol):
    """What writes the values of a formula's nodes at one point: the names of these values."""

    index: dict[Expression, int]
    varies: dict[Expression, bool]

    def reference(self, node: Expression) -> str:
        """Return the name of a node's value at the reference point."""

    def coefficient(self, node: Expression, k: int) -> str | None:
        """Return the name of the k-th Taylor coefficient of a node, or None if it is zero."""

    def difference(self, node: Expression) -> str | None:
        """Return the name of a node's difference from its reference value, or None if the node is constant."""

    def level(self, node: Expression, difference: str, value: str | None = None) -> dict[str, str]:
        """Return the lines of a node's difference from the reference and of its value, by default the sum of both."""

    def vanishes(self, node: Expression) -> bool:
        """Return True if a node is 0 for any parameters at the reference point."""

    def largest_exponent(self, node: Expression) -> float:
        """Return the largest exponent of an exp node; beyond it, exp no longer grows."""

    def saturates(self, node: Expression) -> bool:
        """Return True for an exp that counts as a constant where it is huge."""


class SeriesWriter(Levels, Protocol):
    """What writes the Taylor series of a formula's nodes: sums that several operations share."""

    def products(self, a: Expression, b: Expression, k: int, orders: range) -> str:
        """Write the sum of a_j b_(k-j) over some orders j."""

    def weighted(self, a: Expression, b: Expression, k: int) -> str:
        """Write + (1/k) times the sum over 0 < j < k of j a_j b_(k-j), or nothing if k = 1."""

    def directly_weighted(self, a: Expression, b: Expression, k: int) -> str:
        """Write the sum over 0 < j <= k of j a_j b_(k-j), for an argument a whose weights come straight from the slip rate."""

    def is_direct(self, node: Expression) -> bool:
        """Return True for an argument whose weights come straight from the slip rate."""

    def parts(self, node: Expression) -> dict[Expression, str]:
        """Return a node as a linear combination of others, up to a constant: these nodes with their factors as texts."""


class BallsWriter(Protocol):
    """What writes the radii of a formula's nodes on discs of complex numbers."""

    @property
    def formula(self) -> Levels:
        """What has written the values at the centre."""

    def radius(self, node: Expression) -> str | None:
        """Return the name of a node's radius, or None if the node is constant."""

    def centre(self, node: Expression) -> str:
        """Return the name of a node's value at the centre."""

    def size(self, node: Expression) -> str:
        """Return the text of the magnitude of a node's value at the centre."""

    def most(self, node: Expression) -> str:
        """Return the text of an upper bound of a node's magnitude on the disc."""

    def least(self, node: Expression) -> str:
        """Return the name of a lower bound of a node's magnitude on the disc, at least TINIEST."""

    def logarithm(self, node: Expression) -> str:
        """Return the name of an upper bound of |log(value / centre)| of a node on the disc."""

    def varies_much(self, node: Expression) -> bool:
        """Return True if a node contains an operation whose results vary by orders of magnitude."""


@dataclass(frozen=True)
class Scaled:
    """A series that differs from that of a node by a factor, and is known earlier."""

    where: Callable[[SeriesWriter, Expression], bool]
    """True for nodes that have it."""
    total: Callable[[SeriesWriter, Expression, int], str]
    """Its k-th coefficient."""
    factor: Callable[[SeriesWriter, Expression, int], str]


@dataclass(frozen=True)
class Recurrence:
    """The Taylor series of an operation's result, order by order."""

    coefficient: Callable[[SeriesWriter, Expression, int], str]
    """The k-th coefficient of the node (k > 0), from those already known."""
    divisor: Callable[[SeriesWriter, Expression], str] | None = None
    """What it would divide by at each order, if anything: it multiplies with the reciprocal i{i}."""
    weights_of_argument: bool = False
    """True if it takes the weights w of its argument."""
    weights_of_result: bool = False
    """True if it takes those of its own coefficients."""
    scaled: Scaled | None = None

    @property
    def may_be_direct(self) -> bool:
        """True if the weights of the argument may come straight from the slip rate."""
        return self.weights_of_argument and self.scaled is not None


@dataclass(frozen=True)
class Radius:
    """How far values on discs may be from that at the centre.

    The last two rules are asked where values vary by orders of magnitude, and are given what follows from size and radius alone.
    """

    radius: Callable[[BallsWriter, Expression], str]
    least: Callable[[BallsWriter, Expression, str], str] | None = None
    """A lower bound of the magnitude."""
    logarithm: Callable[[BallsWriter, Expression, str], str] | None = None
    """An upper bound of |log(value / centre)|."""


def pure(_: Expression, *arguments: Dimension) -> Dimension:
    """Return the dimension of a function, whose argument must be a pure number. Raises InputError if it is not."""
    if arguments[0]:
        raise InputError(f"its argument must be a pure number, but is in {unit_text(arguments[0])}; {FORMULA_UNITS}")
    return {}


def unit_text(powers: Dimension) -> str:
    """Return a dimension as text such as "m s^-1", which `dimension` can read."""
    return " ".join(base if power == 1 else f"{base}^{power}" for base, power in powers.items() if power)


def without_zeros(powers: Dimension) -> Dimension:
    """Return a dimension in order, without the exponents that are zero."""
    return {base: powers[base] for base in sorted(powers) if powers[base]}


@dataclass(frozen=True)
class Operation:
    """All that is known about an operation: the code that walks over formulas asks it, and knows no operation by its name."""

    name: str
    value: Callable[..., Any]
    """Its value from numbers or arrays."""
    change: Callable[..., None]
    """How far its value changes between two points, without cancellation, and its derivative: see `operations.sets.STEP`."""
    slope_formula: Callable[..., Expression]
    """The formula of its derivative: from the node, and the formula of each argument's derivative."""
    bounds: Callable[..., None]
    """Bounds of its value, which leave out rounding: see `operations.sets`."""
    taylor: Callable[..., None]
    """Its Taylor coefficients by the slip rate as intervals, rounding included: see `operations.enclosures`."""
    disc: Callable[..., Disc]
    """The disc that holds its values, rounding included: from that of each argument."""
    order_zero: Callable[[Levels, Expression], Mapping[str, str]]
    """Lines by name that compute difference and value of a node, and what else its rules use."""
    derivative: Callable[..., str]
    """The text of its derivative: from the writer, the node, and the name of each argument's derivative, None for one that is 0."""
    recurrence: Recurrence
    ball: Radius
    called: tuple[Callable[..., Any], ...] = ()
    """Functions of numbers that its lines call by their names, in plain Python with `math`; the engine compiles them."""
    unit: Callable[..., Dimension] = pure
    """The dimension of its value: from the node and the dimension of each argument. Raises InputError if they do not match."""
    bounded: Callable[[Expression], Expression] = lambda node: node
    """The node as `taylor` should see it."""
    sign: str = ""
    """How it is written between its arguments; nothing for a function."""
    rank: int = 0
    """How tightly the sign binds: a larger number binds more tightly."""
    numpy_name: str = ""
    """Its name in numpy, where it is another one."""
    math_name: str = ""
    """Its name in Python's math, where it is another one."""
    companions: Callable[[Expression], Sequence[Expression]] = lambda node: (node,)
    """The node and those that its rules need beside it, such as cos for sin, in order of computation."""
    parts: Callable[[SeriesWriter, Expression], dict[Expression, str] | None] = lambda writer, node: None
    """A node as a linear combination of others, up to a constant: these nodes with their factors as texts; None if it is none."""
    linear: tuple[tuple[int, ...], ...] = ()
    """Groups of places of arguments: it is linear in each group together if the other arguments do not vary."""
    zeros: tuple[int, ...] = ()
    """Places of arguments that make the value 0 where they are 0."""
    settles: tuple[int, ...] = ()
    """Places of arguments whose growth beyond e^150 no longer changes the value, or has made it infinite already."""
    carries: tuple[int, ...] = ()
    """Places of arguments that make the value large if they are large and no other argument is small."""
    scales: bool = False
    """True if it multiplies or divides by other arguments, which may be small."""
    shrinks: bool = False
    """True if its value may be as small as another node is large."""
    varies_much: bool = False
    """True if its value varies by orders of magnitude without coming near zero."""
    overflows: bool = False
    """True for an exponential, whose exponent is limited where an overflow is harmless."""

    def __call__(self, *arguments: Any) -> Any:
        """Return the value from numbers or arrays, or the node if an argument is a formula."""
        if any(isinstance(argument, Expression) for argument in arguments):
            nodes = tuple(as_expression(argument) for argument in arguments)
            return self.value(*nodes) if self.sign else Expression(self.name, nodes)
        if self.sign:
            return self.value(*arguments)
        with np.errstate(over="ignore"):  # an exponential may overflow on the way to a finite value, as in exp(-exp(z))
            return self.value(*arguments)

    @property
    def in_math(self) -> str:
        """The name of the function in Python's math."""
        return self.math_name or self.name

    @property
    def on_arrays(self) -> np.ufunc:
        """The function of numpy."""
        function: np.ufunc = getattr(np, self.numpy_name or self.name)
        return function


def oldest_first(pairs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Sort the pairs of orders in a product's recurrence so that those which need the newest coefficients come last.

    Of two factors of one order the first is known before the second: it is often the weight of the other's argument.
    """
    return sorted(pairs, key=lambda pair: max(2 * pair[0], 2 * pair[1] + 1))


def sum_of(terms: list[str]) -> str:
    """Write the sum of terms, which are given oldest first: the older ones as a balanced tree, then the newest one by one.

    The tree is short and has little rounding error. The processor has finished it before the newest terms are known, and then needs
    only one addition for each of these.
    """
    if not terms:
        return "0.0"
    old = terms[: max(len(terms) - FRESH, 1)]
    return " + ".join([_balanced(old), *terms[len(old) :]])


def _balanced(terms: list[str]) -> str:
    """Write the sum of terms as a balanced binary tree."""
    if len(terms) == 1:
        return terms[0]
    half = len(terms) // 2
    return f"({_balanced(terms[:half])} + {_balanced(terms[half:])})"
