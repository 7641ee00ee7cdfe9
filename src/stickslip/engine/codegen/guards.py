"""Limit the length of a step so that it cannot jump over a part of the friction law that is invisible where the step starts.

The last coefficients of a Taylor series decide how long a step is. They do not see a part of the formula that is smaller than
rounding where the step starts: exp(z) beside a sum of order one while z < -45, a quotient whose denominator is huge, a high power
of a small base. Such a part matters again only when its argument has moved far enough. Therefore every such node of the formula is
a guard of the step: its argument, whose series is known, may move in the critical direction by a limited distance, its room. While
the node is hidden below rounding, the room extends to where the node begins to matter; once it is visible, the room is so small
that the last coefficients of the series are reliable.

A guard is expressed as a pull: 1 / room, with the sign of the critical direction. In a step pull x (argument - argument at the
start) must stay below 1. The numbers max(pull x coefficient, 0), with the Taylor coefficients of the argument, are the coefficients
of an upper bound of this product.
"""

from __future__ import annotations

from dataclasses import dataclass

from stickslip.friction.formula.expression import Expression, nodes_of

HIDDEN = 50.0
"""Magnitude of an exponent beyond which exp, or its inverse, is lost beside a number of order one: e^-50 is 2e-22."""
IN_SIGHT = 8.0
"""Largest change of an exponent in one step, dimensionless; up to here the terms of order 17 and 18 bound those that follow."""
SHARE = 0.9
"""Largest fraction of its distance from zero by which a denominator, or the argument of sqrt, may fall in one step."""
TINIEST = 1e-300
"""Number that is added to a denominator that may vanish, to avoid a division by zero."""

TRANSCENDENTAL = ("exp", "tanh", "pow")
"""Operations whose results can fall below rounding by themselves. A denominator or root that contains one of them needs no guard
of its own, because that operation has one: a denominator 1 + exp(z) may fall by orders of magnitude without harm."""


@dataclass(frozen=True)
class Guard:
    """A guard of the step: the operation of its node, the argument whose change is limited, and the exponent of a power."""

    operation: str
    argument: Expression
    exponent: Expression | None = None

    def pull(self, argument: str, exponent: str) -> str:
        """Return the source text of the pull (see the module), given the names of the values of the argument and the exponent."""
        if self.operation == "pow":
            return f"power_pull({argument}, {exponent})"
        if self.operation in ("exp", "tanh"):
            unit = 1.0 if self.operation == "exp" else 0.5  # tanh(a) is a function of exp(2 a)
            towards_zero = f"{argument} / (abs({argument}) + {TINIEST!r})"
            return f"-({towards_zero}) / max(abs({argument}) - {unit * HIDDEN!r}, {unit * IN_SIGHT!r})"
        return f"-1.0 / ({SHARE!r} * {argument} + {TINIEST!r})"


def guards_of(nodes: list[Expression]) -> list[Guard]:
    """Return the guards among the nodes of a formula, without those whose argument is constant."""
    found: dict[Guard, None] = {}
    for node in nodes:
        guarded = _guarded(node)
        if guarded is not None and _varies(guarded):
            found[Guard(node.operation, guarded, node.arguments[1] if node.operation == "pow" else None)] = None
    return list(found)


def _guarded(node: Expression) -> Expression | None:
    """Return the argument that must be guarded at a node, or None if the node needs no guard.

    A logarithm needs none: it changes too slowly to be below rounding at one end of a step and to matter at the other.
    """
    if node.operation in TRANSCENDENTAL:
        return node.arguments[0]
    if node.operation not in ("div", "sqrt"):
        return None
    argument = node.arguments[1] if node.operation == "div" else node.arguments[0]
    hides = any(part.operation in TRANSCENDENTAL for part in nodes_of(argument))
    return None if hides else argument


def _varies(node: Expression) -> bool:
    """Return True if a node depends on slip, slip rate or state."""
    return any(part.operation in ("slip", "rate", "state") for part in nodes_of(node))
