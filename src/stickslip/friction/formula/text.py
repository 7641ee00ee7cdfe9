"""Read a formula tree from text, check its units, and write it as text that reads back as the same tree.

It is read by a whitelist over Python's syntax tree; no text is ever evaluated. Allowed are numbers, the variables u (slip, m) and v
(slip rate, m/s), pi, declared parameters, + - * /, ** with an exponent that does not depend on u or v, and the functions in
FUNCTIONS and COMPOSED of `stickslip.friction.formula.functions`. Length, depth and size are limited because the text is untrusted.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Collection, Mapping
from fractions import Fraction
from functools import lru_cache

from stickslip.foundation.errors import InputError, nearest, never_show
from stickslip.friction.formula.expression import (
    RATE,
    SLIP,
    STATES,
    VARIABLES,
    Expression,
    Parameter,
    as_expression,
    depends_on,
    nodes_of,
)
from stickslip.friction.formula.functions import COMPOSED, OTHER_NAMES
from stickslip.friction.formula.operations import FUNCTIONS, OPERATIONS, operation_of
from stickslip.friction.formula.operations.operation import FORMULA_UNITS, Dimension, unit_text, without_zeros
from stickslip.friction.formula.operations.powers import POW

LONGEST = 1000
"""Largest number of characters in an expression, which is untrusted."""
DEEPEST = 100
"""Largest number of nested levels, within Python's limit of recursion; a sum of n terms has n levels."""
MOST_OPERATIONS = 250
"""Largest number of distinct nodes in the tree: each is compiled for every order of the Taylor series."""
LARGEST_EXPONENT = 100.0
"""Largest size of an exponent: powers of slips and slip rates up to 10 (m or m/s) stay far from overflow."""
RESERVED = ("u", "v", "pi", *FUNCTIONS)
"""Names that a parameter cannot have because they mean something else in an expression."""
ALLOWED_PARTS = f"allowed are numbers, u, v, pi, declared parameters, + - * / ** and {', '.join(FUNCTIONS)}"
"""End of a message about a part that is not allowed."""
KINKED = ("abs", "min", "max", "where", "minimum", "maximum", "sign", "heaviside", "clip", "floor", "ceil")
"""Functions with kinks or jumps that users try, which have no Taylor series there."""
KINKS = "for a kink or a jump use a law such as piecewise-linear-rate, piecewise-linear-slip or table; for a smooth step tanh"
"""End of a message about a formula with a kink."""
UNDECLARED = "is neither u, v, pi nor a declared parameter"
"""Part of the message about a name that an expression must not use."""

FORMULA = "<formula of stickslip>"
"""What Python takes for the file and the module of a formula."""

_BINARY: dict[type[ast.operator], str] = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.Pow: "pow"}
"""Operations of nodes for the operators of Python's syntax tree."""


@lru_cache(maxsize=256)
def parse(text: str, names: tuple[str, ...], states: tuple[str, ...] = ()) -> Expression:
    """Return the tree of an expression in u, v, the named parameters and the states of those names.

    Raise InputError with one line that says which part is wrong.
    """
    if len(text) > LONGEST:
        raise InputError(f"longer than {LONGEST} characters")
    if not text.isascii() or not text.isprintable():
        odd = next(c for c in text if not (c.isascii() and c.isprintable()))
        raise InputError(f"the character {odd!a} is not allowed; {ALLOWED_PARTS}")
    tree = _Reader(text, names, states).read(_syntax(text), 0)
    if len(nodes_of(tree)) > MOST_OPERATIONS:
        raise InputError(f"more than {MOST_OPERATIONS} operations, powers written out as products")
    return tree


def _syntax(text: str) -> ast.expr:
    never_show(module=FORMULA)  # Python may warn about code such as 1or 2, which `_Reader` refuses
    try:
        return ast.parse(text.strip(), FORMULA, mode="eval").body
    except (RecursionError, MemoryError):
        raise InputError("nested too deeply") from None
    except (SyntaxError, ValueError) as error:
        if "=" in text and not set("<>!") & set(text) and "==" not in text:
            raise InputError(
                f"{_shown(text)} is not an expression, because of its sign =; write only what comes after it"
            ) from None
        where = f" at character {error.offset}" if isinstance(error, SyntaxError) and error.offset else ""
        raise InputError(f"{_shown(text)} is not an expression: mistake{where}; {ALLOWED_PARTS}") from None


class _Reader:
    """Translate the Python syntax tree of one expression to a formula tree."""

    def __init__(self, text: str, names: Collection[str], states: tuple[str, ...]) -> None:
        self.text, self.names, self.states = text.strip(), names, states

    def read(self, node: ast.expr, depth: int) -> Expression:
        """Return the formula tree of a part. Raise InputError for anything that is not allowed."""
        if depth > DEEPEST:
            raise InputError(f"nested more than {DEEPEST} deep, at {self.part(node)}")
        if isinstance(node, ast.Constant):
            return self.number(node)
        if isinstance(node, ast.Name):
            return self.variable(node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
            return self.signed(node, depth)
        if isinstance(node, ast.BinOp):
            return self.binary(node, depth)
        if isinstance(node, ast.Call):
            return self.call(node, depth)
        if isinstance(node, ast.IfExp | ast.Compare):
            raise InputError(f"{self.part(node)} is not allowed, because it is a branch; {KINKS}")
        if isinstance(node, ast.Tuple):
            raise InputError(f"{self.part(node)} is not allowed, because of its comma; a decimal point is written as in 0.5")
        raise InputError(f"{self.part(node)} is not allowed; {ALLOWED_PARTS}")

    def number(self, node: ast.Constant) -> Expression:
        if type(node.value) not in (int, float):
            raise InputError(f"{self.part(node)} is not allowed; {ALLOWED_PARTS}")
        try:
            value = float(node.value)  # type: ignore[arg-type] # checked above
        except OverflowError:
            value = math.inf
        if not math.isfinite(value):
            raise InputError(f"the number {self.part(node)} is too large")
        return as_expression(value)

    def variable(self, node: ast.Name) -> Expression:
        if node.id in self.names:
            return Parameter(node.id)
        if node.id in self.states:
            return STATES[self.states.index(node.id)]
        if node.id in ("u", "v", "pi"):
            return {"u": SLIP, "v": RATE, "pi": as_expression(math.pi)}[node.id]
        if node.id in FUNCTIONS:
            raise InputError(f"{self.part(node)} is a function: write {node.id}(...)")
        known = [*self.names, *self.states, "u", "v"]
        hint = nearest(node.id, known)
        is_state = not self.states and not hint.startswith("did")
        more = f'; a state: give evolution = "d{node.id}/dt = ..."' if is_state else ""
        raise InputError(f"{self.part(node)} {UNDECLARED}; {hint}{more}")

    def signed(self, node: ast.UnaryOp, depth: int) -> Expression:
        inner = self.read(node.operand, depth + 1)
        if isinstance(node.op, ast.UAdd):
            return inner
        return as_expression(-inner.value) if isinstance(node.operand, ast.Constant) else -inner

    def binary(self, node: ast.BinOp, depth: int) -> Expression:
        if type(node.op) not in _BINARY:
            hint = "; a power is written **" if isinstance(node.op, ast.BitXor) else ""
            raise InputError(f"the operator in {self.part(node)} is not allowed{hint}; {ALLOWED_PARTS}")
        left, right = self.read(node.left, depth + 1), self.read(node.right, depth + 1)
        if isinstance(node.op, ast.Pow):
            self.check_exponent(node, right)
        return self.made(node, _BINARY[type(node.op)], left, right)

    def check_exponent(self, node: ast.BinOp, exponent: Expression) -> None:
        if any(depends_on(exponent, variable) for variable in VARIABLES):
            raise InputError(f"the exponent of {self.part(node)} must not contain u or v; exp(y * log(x)) is x**y")
        if exponent.operation == "constant" and abs(exponent.value) > LARGEST_EXPONENT:
            raise InputError(f"the exponent of {self.part(node)} must be within {LARGEST_EXPONENT:g}")

    def call(self, node: ast.Call, depth: int) -> Expression:
        if isinstance(node.func, ast.Attribute) and node.func.attr in (*FUNCTIONS, *COMPOSED, *OTHER_NAMES, *KINKED):
            raise InputError(f"{self.part(node.func)} is written {node.func.attr}, without the name of a library")
        if not isinstance(node.func, ast.Name):
            raise InputError(f"{self.part(node)} is not allowed; {ALLOWED_PARTS}")
        name = OTHER_NAMES.get(node.func.id, node.func.id)
        if name in KINKED:
            raise InputError(f"the function {self.part(node.func)} has a kink or a jump; {KINKS}")
        if name not in FUNCTIONS and name not in COMPOSED:
            raise InputError(f"the function {self.part(node.func)} is unknown; {nearest(name, [*FUNCTIONS, *COMPOSED])}")
        if len(node.args) != 1 or node.keywords or isinstance(node.args[0], ast.Starred):
            raise InputError(f"{self.part(node)}: {name} takes one number")
        return self.made(node, name, self.read(node.args[0], depth + 1))

    def made(self, node: ast.expr, operation: str, *arguments: Expression) -> Expression:
        try:
            result: Expression = (OPERATIONS | COMPOSED)[operation](*arguments)
        except InputError:
            raise InputError(f"too many operations with powers written out as products, at {self.part(node)}") from None
        return result

    def part(self, node: ast.expr) -> str:
        return _shown(ast.get_source_segment(self.text, node) or self.text)


def _shown(text: str) -> str:
    shown = ascii(text)
    return shown if len(shown) <= 60 else f"{shown[:56]}...'"


def dimension(unit: str) -> Dimension:
    """Return the dimension of a unit such as "m s^-1"; an empty text is that of a pure number."""
    powers: Dimension = {}
    for factor in unit.split():
        base, _, power = factor.partition("^")
        powers[base] = Fraction(power or 1)
    return powers


def check_dimensions(tree: Expression, units: Mapping[str, str], state: str | None = None, *, by_angle: bool = False) -> None:
    """Raise InputError that names the part with a wrong unit, unless the formula is a pure number.

    A parameter without a unit is a pure number. If the formula is the rate of change of a state, `state` is the unit of the state.
    With `by_angle` slip has no unit: the contact turns.
    """
    slip, rate = ("", "s^-1") if by_angle else ("m", "m s^-1")
    found: dict[Expression, Dimension] = {SLIP: dimension(slip), RATE: dimension(rate)}
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
            raise InputError(f"{must}, but {quoted(tree)} is {is_in}; {FORMULA_UNITS}")
    elif found[tree]:
        raise InputError(
            f"the friction coefficient must be a pure number, but {quoted(tree)} is in {unit_text(found[tree])}; {FORMULA_UNITS}"
        )


_MINUS, _ATOM = 3, 5
"""Precedence of a leading minus, between product and power, and of a part that never needs parentheses."""


def to_text(node: Expression) -> str:
    """Return the formula in ordinary notation, with few parentheses."""
    return _written(node)[0]


def quoted(node: Expression) -> str:
    """Return a part of a formula in quotes, cut off after 60 characters, for a message."""
    text = to_text(node)
    return f"'{text}'" if len(text) <= 60 else f"'{text[:57]}...'"


def _written(node: Expression) -> tuple[str, int]:
    if node.operation == "constant":
        number = repr(float(node.value)).removesuffix(".0")
        return number, _ATOM if number[0] != "-" else _MINUS
    if not node.arguments:
        return node.name, _ATOM
    operation = operation_of(node)
    if not operation.sign:
        return f"{node.operation}({to_text(node.arguments[0])})", _ATOM
    base, count = _power_of(node)
    if count > 1:
        return f"{_enclosed(base, _ATOM)}**{count}", POW.rank
    left, right = node.arguments
    if node.operation == "sub" and left == Expression("constant", value=0.0) and right.operation != "constant":
        return f"-{_enclosed(right, _MINUS)}", _MINUS
    if operation is POW:
        return f"{_enclosed(left, _ATOM)}**{_enclosed(right, _ATOM)}", POW.rank
    return f"{_enclosed(left, operation.rank)} {operation.sign} {_enclosed(right, operation.rank + 1)}", operation.rank


def _power_of(node: Expression) -> tuple[Expression, int]:
    """Return base and exponent of a product that was typed as a whole power, and the node itself with 1 for any other.

    A power is parsed into products by repeated squaring, so that the tree of the power is that of the product.
    """
    if node.operation != "mul":
        return node, 1
    left, right = node.arguments
    base, count = _power_of(left)
    if left == right:
        return base, 2 * count
    return (base, count + 1) if count % 2 == 0 and right == base else (node, 1)


def _enclosed(node: Expression, least: int) -> str:
    text, rank = _written(node)
    return text if rank >= least else f"({text})"
