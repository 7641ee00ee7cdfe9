"""Guards: where a step must end so that it cannot jump over a part of the law that leaves no trace at its start.

A Taylor step is as long as its last coefficients allow. They know nothing of a part of the formula that is smaller than rounding
where the step starts: exp(z) beside a sum of order one while z < -45, a quotient whose denominator is huge, a high power of a
small base. Such a part comes back only when its argument moves towards where it counts. So every such node guards the step: its
argument, of which the series is known, may move towards that place by a given room and no further. Out of sight the room reaches
to where the node begins to count; in sight it is so small that the last coefficients tell the truth.

A guard is written as a pull: 1 / room, with the sign of the direction that is guarded. The step may be so long that
pull x (argument - argument at the start) stays below 1, and max(pull x coefficient, 0) are the coefficients of a bound on that.
"""

from __future__ import annotations

from dataclasses import dataclass

from stickslip.friction.formula.expression import Expression, nodes_of

HIDDEN = 50.0
"""Exponent beyond which exp leaves nothing in double precision beside a number of order one (1): e^-50 is 2e-22."""
IN_SIGHT = 8.0
"""Change of an exponent in one step (1) up to which the terms of order 17 and 18 bound those that follow them."""
SHARE = 0.9
"""Share of the way to zero (1) that a denominator, or the argument of sqrt, may go in one step."""
TINIEST = 1e-300
"""Keeps a division by zero from being one."""

TRANSCENDENTAL = ("exp", "tanh", "pow")
"""Operations that vanish below rounding by themselves. What contains one of them is guarded by it, and needs no guard of its own:
a denominator 1 + exp(z) falls by orders of magnitude without harm."""


@dataclass(frozen=True)
class Guard:
    """A node that guards the step, by the operation that it guards and its argument."""

    operation: str
    argument: Expression
    exponent: Expression | None = None

    def pull(self, argument: str, exponent: str) -> str:
        """Write the pull, from the name of the argument's value (and of the exponent): see the module's docstring."""
        if self.operation == "pow":
            return f"power_pull({argument}, {exponent})"
        if self.operation in ("exp", "tanh"):
            unit = 1.0 if self.operation == "exp" else 0.5  # tanh(a) is a function of exp(2 a)
            towards_zero = f"{argument} / (abs({argument}) + {TINIEST!r})"
            return f"-({towards_zero}) / max(abs({argument}) - {unit * HIDDEN!r}, {unit * IN_SIGHT!r})"
        return f"-1.0 / ({SHARE!r} * {argument} + {TINIEST!r})"


def guards_of(nodes: list[Expression]) -> list[Guard]:
    """Find the guards among the nodes of a formula that vary."""
    found: dict[Guard, None] = {}
    for node in nodes:
        guarded = _guarded(node)
        if guarded is not None and _varies(guarded):
            found[Guard(node.operation, guarded, node.arguments[1] if node.operation == "pow" else None)] = None
    return list(found)


def _guarded(node: Expression) -> Expression | None:
    """Return the argument that a node guards, if it guards one.

    A logarithm needs no guard: it changes too slowly to be out of sight at one end of a step and to count at the other.
    """
    if node.operation in TRANSCENDENTAL:
        return node.arguments[0]
    if node.operation not in ("div", "sqrt"):
        return None
    argument = node.arguments[1] if node.operation == "div" else node.arguments[0]
    hides = any(part.operation in TRANSCENDENTAL for part in nodes_of(argument))
    return None if hides else argument


def _varies(node: Expression) -> bool:
    return any(part.operation in ("slip", "rate", "state") for part in nodes_of(node))
