"""Represent the formula of a friction law as an expression tree.

A law states its formula once, with ordinary operators and the functions of `functions`. Called with numbers or arrays, the
formula returns a number or an array. Called with the symbols `SLIP`, `RATE`, `STATE` and `Parameter`, it returns an `Expression`
tree, and `stickslip.engine.formula_code.taylor_series` turns the tree into compiled code. No text is ever evaluated as Python here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NoReturn

import numpy as np

from stickslip.foundation.errors import InputError

LARGEST_SIZE = 10_000
"""Largest number of nodes of a formula, shared parts counted at each use: n repeated squarings make 2^n of them."""
LARGEST_POWER = 100
"""Largest whole exponent whose power is written as a product, because a product has a Taylor series at base 0 too."""


@dataclass(frozen=True)
class Expression:
    """A node of a formula: an operation on other nodes, a parameter, a constant, or one of the variables."""

    operation: str
    arguments: tuple[Expression, ...] = ()
    name: str = ""
    value: float = 0.0

    def __post_init__(self) -> None:
        """Compute hash and size from those of the arguments, because a walk over shared parts may take exponential time."""
        size = 1 + sum(argument.size for argument in self.arguments)
        if size > LARGEST_SIZE:
            raise InputError(f"formula: longer than {LARGEST_SIZE} operations")
        object.__setattr__(self, "_size", size)
        object.__setattr__(self, "_hash", hash((self.operation, self.arguments, self.name, self.value)))

    def __hash__(self) -> int:
        return int(self._hash)  # type: ignore[attr-defined] # set above

    def __eq__(self, other: object) -> bool:
        """Return True if two formulas are the same tree; refuse a comparison with a number, which is a branch on a value."""
        if self is other:
            return True
        if isinstance(other, int | float | np.number):
            self._refuse()
        if not isinstance(other, Expression) or hash(self) != hash(other):
            return False
        ours, theirs = ((node.operation, node.name, node.value) for node in (self, other))
        return ours == theirs and self.arguments == other.arguments

    def __reduce__(self) -> tuple[Any, ...]:
        """Rebuild a copy from its fields, so that another process computes its own hash: hashes of texts differ there."""
        return Expression, (self.operation, self.arguments, self.name, self.value)

    @property
    def size(self) -> int:
        """The number of nodes of the formula, shared parts counted at each use."""
        return int(self._size)  # type: ignore[attr-defined] # set above

    def __add__(self, other: Any) -> Expression:
        return Expression("add", (self, as_expression(other)))

    def __radd__(self, other: Any) -> Expression:
        return as_expression(other) + self

    def __sub__(self, other: Any) -> Expression:
        return Expression("sub", (self, as_expression(other)))

    def __rsub__(self, other: Any) -> Expression:
        return as_expression(other) - self

    def __mul__(self, other: Any) -> Expression:
        return Expression("mul", (self, as_expression(other)))

    def __rmul__(self, other: Any) -> Expression:
        return as_expression(other) * self

    def __truediv__(self, other: Any) -> Expression:
        return Expression("div", (self, as_expression(other)))

    def __rtruediv__(self, other: Any) -> Expression:
        return as_expression(other) / self

    def __neg__(self) -> Expression:
        return as_expression(0.0) - self

    def __pos__(self) -> Expression:
        return self

    def __pow__(self, exponent: Any) -> Expression:
        power = as_expression(exponent)
        if power.operation == "constant" and power.value.is_integer() and abs(power.value) <= LARGEST_POWER:
            product = _product(self, abs(int(power.value)))
            return product if power.value >= 0 else 1.0 / product
        return Expression("pow", (self, power))

    def __rpow__(self, base: Any) -> Expression:
        return as_expression(base) ** self

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Expression:
        """Return an expression for a numpy function of expressions, such as np.exp(v) in a user's function."""
        from stickslip.friction.formula.functions import of_numpy  # which is made of expressions

        return of_numpy(ufunc.__name__, method, inputs, options)

    def __array_function__(self, function: Callable[..., Any], types: Any, arguments: Any, options: Any) -> NoReturn:
        """Refuse functions of numpy that are not elementary, such as np.where and np.interp."""
        raise InputError(f"formula: np.{function.__name__} cannot be traced; {instead(self, *arguments)}")

    def _refuse(self, *others: Any) -> NoReturn:
        raise InputError(f"formula: a branch on the value of u, v or a parameter cannot be traced; {instead(self, *others)}")

    __bool__ = __lt__ = __le__ = __gt__ = __ge__ = _refuse

    def __abs__(self) -> Expression:
        if self == RATE:  # the slip rate in a formula is never negative
            return self
        if self == SLIP:
            return Magnitude(self, 'counts="path" makes u a length that is never negative')  # type: ignore[return-value] # it refuses all
        return Magnitude(self, "v is a magnitude already, np.sqrt(x**2 + small) is smooth")  # type: ignore[return-value] # likewise

    def __float__(self) -> float:
        cure = "use numpy's: np.exp instead of math.exp; points make a FromTable law"
        raise InputError(f"formula: math functions and float() cannot be traced; {cure}")

    __int__ = __float__


class Magnitude:
    """The magnitude of a formula: it can neither be compared, as in `if abs(y) < 1`, nor be a part of another formula."""

    __array_priority__ = 1000.0

    def __init__(self, inner: Expression, cure: str) -> None:
        self.inner, self._cure = inner, cure

    def _compared(self, *others: Any) -> NoReturn:
        self.inner._refuse(*others)

    def refuse(self, *_: Any, **__: Any) -> NoReturn:
        """Refuse to be a part of a formula. Raises InputError."""
        raise InputError(f"formula: abs has a kink and cannot be traced; {self._cure}")

    __bool__ = __lt__ = __le__ = __gt__ = __ge__ = _compared
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = refuse
    __pow__ = __rpow__ = __neg__ = __pos__ = __abs__ = __float__ = __int__ = __array_ufunc__ = __array_function__ = refuse


def instead(*parts: Any) -> str:
    """Return the laws to use instead of a formula with a kink, for the variables of the given parts of it."""
    nodes = [part for part in parts if isinstance(part, Expression)]
    found = {variable.name for variable in (SLIP, RATE) for node in nodes if depends_on(node, variable)}
    laws = {
        "u": "for a kink or a jump in u use PiecewiseLinearSlip, LinearSlipWeakening or FromTable(slip=..., friction=...)",
        "v": "for a kink or a jump in v use PiecewiseLinearRate or FromTable(rate=..., friction=...)",
    }
    return "; ".join([laws[name] for name in sorted(found, reverse=True)] + ["for a smooth step np.tanh"])


SLIP = Expression("slip", name="u")
"""Symbol of the slip u (m)."""
RATE = Expression("rate", name="v")
"""Symbol of the magnitude v of the slip rate (m/s)."""
STATES = tuple(Expression("state", name=name) for name in ("w", "w2", "w3", "w4"))
"""Symbols of the state variables of a law: of the only one, or of the first and the second."""
STATE = STATES[0]
VARIABLES = (SLIP, RATE, *STATES)
"""All variables of formulas."""


def _product(base: Expression, count: int) -> Expression:
    """Return base**count by repeated squaring."""
    if count == 0:
        return as_expression(1.0)
    half = _product(base, count // 2) if count > 1 else None
    square = base if half is None else half * half
    return square * base if half is not None and count % 2 else square


def Parameter(name: str) -> Expression:  # noqa: N802 - reads as the node it makes
    """Return the node of a named number of the law, whose value is known when the run starts."""
    return Expression("parameter", name=name)


def as_expression(value: Any) -> Expression:
    """Wrap a plain number as a constant node; a node stays what it is."""
    if isinstance(value, Magnitude):
        value.refuse()
    return value if isinstance(value, Expression) else Expression("constant", value=float(value))


def depends_on(node: Expression, variable: Expression) -> bool:
    """Return True if the formula contains the variable, one of VARIABLES."""
    return variable in nodes_of(node)


@lru_cache(maxsize=1024)
def nodes_of(root: Expression) -> tuple[Expression, ...]:
    """Return every distinct node of the tree, arguments before the nodes that use them, and `root` last."""
    found: dict[Expression, None] = {}

    def visit(node: Expression) -> None:
        if node not in found:
            for argument in node.arguments:
                visit(argument)
            found[node] = None

    visit(root)
    return tuple(found)


def __getattr__(name: str) -> Any:
    """Return a function such as `exp`, which laws of users have imported from here."""
    if not name.startswith("__"):  # as Python asks for __path__ in every import from here
        from stickslip.friction.formula import functions, operations

        if name in operations.FUNCTIONS:
            return getattr(functions, name)
    raise AttributeError(f"module {__name__} has no attribute {name!r}")
