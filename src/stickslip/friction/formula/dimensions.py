"""Check the units of a formula: it must be a pure number, with u in m and v in m/s."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from stickslip.foundation.errors import InputError
from stickslip.friction.formula.expression import RATE, SLIP, Expression, nodes_of
from stickslip.friction.formula.operations import operation_of
from stickslip.friction.formula.operations.operation import UNITS, Dimension, unit_text, without_zeros
from stickslip.friction.formula.text import quoted


def dimension(unit: str) -> Dimension:
    """Return the dimension of a unit such as "m s^-1"; an empty text is that of a pure number."""
    powers: Dimension = {}
    for factor in unit.split():
        base, _, power = factor.partition("^")
        powers[base] = Fraction(power or 1)
    return powers


def check_dimensions(tree: Expression, units: Mapping[str, str], state: str | None = None) -> None:
    """Raise InputError that names the part with a wrong unit, unless the formula is a pure number.

    A parameter without a unit is a pure number. If the formula is the rate of change of a state, `state` is the unit of the state.
    """
    found: dict[Expression, Dimension] = {SLIP: dimension("m"), RATE: dimension("m s^-1")}
    for node in nodes_of(tree):
        if node.operation == "parameter":
            found[node] = dimension(units.get(node.name, ""))
        elif node.arguments:
            try:
                found[node] = operation_of(node).unit(node, *(found[argument] for argument in node.arguments))
            except InputError as error:
                raise InputError(f"{quoted(node)}: {error}") from None
        else:
            found.setdefault(node, {})
    if state is not None:
        wanted = without_zeros({**dimension(state), "s": dimension(state).get("s", Fraction(0)) - 1})
        zero = tree.operation == "constant" and tree.value == 0.0
        if found[tree] != wanted and not zero:
            is_in = unit_text(found[tree]) or "a pure number"
            must = f"it must be in {unit_text(wanted)}, the unit of the state over s"
            raise InputError(f"{must}, but {quoted(tree)} is {is_in}; {UNITS}")
    elif found[tree]:
        raise InputError(
            f"the friction coefficient must be a pure number, but {quoted(tree)} is in {unit_text(found[tree])}; {UNITS}"
        )
