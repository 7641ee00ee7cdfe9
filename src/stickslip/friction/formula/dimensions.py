"""Check the units of a formula: it must be a pure number, with u in m and v in m/s."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from stickslip.foundation.errors import InputError
from stickslip.friction.formula.expression import RATE, SLIP, Expression, nodes_of
from stickslip.friction.formula.text import quoted

Dimension = dict[str, Fraction]
"""Exponents of m, kg and s in a unit; those that are zero are left out."""


def dimension(unit: str) -> Dimension:
    """Return the dimension of a unit such as "m s^-1"; an empty text is that of a pure number."""
    powers: Dimension = {}
    for factor in unit.split():
        base, _, power = factor.partition("^")
        powers[base] = Fraction(power or 1)
    return powers


def unit_text(powers: Dimension) -> str:
    """Return a dimension as text such as "m s^-1", which `dimension` can read."""
    return " ".join(base if power == 1 else f"{base}^{power}" for base, power in powers.items() if power)


def check_dimensions(tree: Expression, units: Mapping[str, str], state: str | None = None) -> None:
    """Raise InputError that names the part with a wrong unit, unless the formula is a pure number.

    A parameter without a unit is a pure number. If the formula is the rate of change of a state, `state` is the unit of the state.
    """
    found: dict[Expression, Dimension] = {SLIP: dimension("m"), RATE: dimension("m s^-1")}
    for node in nodes_of(tree):
        if node.operation == "parameter":
            found[node] = dimension(units.get(node.name, ""))
        elif node not in found:
            found[node] = _of(node, [found[argument] for argument in node.arguments])
    if state is not None:
        wanted = _clean({**dimension(state), "s": dimension(state).get("s", Fraction(0)) - 1})
        zero = tree.operation == "constant" and tree.value == 0.0
        if found[tree] != wanted and not zero:
            is_in = unit_text(found[tree]) or "a pure number"
            must = f"it must be in {unit_text(wanted)}, the unit of the state over s"
            raise InputError(f"{must}, but {quoted(tree)} is {is_in}; {_HINT}")
    elif found[tree]:
        raise InputError(
            f"the friction coefficient must be a pure number, but {quoted(tree)} is in {unit_text(found[tree])}; {_HINT}"
        )


_HINT = "u is in m, v in m/s, a number without unit is a pure number"


def _of(node: Expression, arguments: list[Dimension]) -> Dimension:
    if node.operation in ("add", "sub"):
        return _same(node, *arguments)
    if node.operation in ("mul", "div"):
        a, b = arguments
        sign = 1 if node.operation == "mul" else -1
        return _clean({base: a.get(base, Fraction(0)) + sign * b.get(base, Fraction(0)) for base in {**a, **b}})
    if node.operation in ("pow", "sqrt"):
        return _power(node, arguments)
    if arguments and arguments[0]:
        raise InputError(f"{quoted(node)}: its argument must be a pure number, but is in {unit_text(arguments[0])}; {_HINT}")
    return {}


def _same(node: Expression, a: Dimension, b: Dimension) -> Dimension:
    zero = Expression("constant", value=0.0)
    if a != b and zero not in node.arguments:
        one, other = (unit_text(x) or "a pure number" for x in (a, b))
        raise InputError(f"{quoted(node)}: {one} and {other} cannot be added or subtracted; {_HINT}")
    return b if node.arguments[0] == zero else a


def _power(node: Expression, arguments: list[Dimension]) -> Dimension:
    base = arguments[0]
    if not base:
        exponent_has_unit = len(arguments) == 2 and bool(arguments[1])
        if exponent_has_unit:
            raise InputError(f"{quoted(node)}: its exponent must be a pure number, but is in {unit_text(arguments[1])}")
        return {}
    if node.operation == "pow" and node.arguments[1].operation != "constant":
        raise InputError(
            f"{quoted(node)}: {unit_text(base)} to a power that is a parameter has no fixed unit; divide it by one first"
        )
    exponent = Fraction(1, 2) if node.operation == "sqrt" else Fraction(node.arguments[1].value).limit_denominator(1000)
    return _clean({name: power * exponent for name, power in base.items()})


def _clean(powers: Dimension) -> Dimension:
    return {base: powers[base] for base in sorted(powers) if powers[base]}
