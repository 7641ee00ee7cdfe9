"""Read a formula tree from text, by a whitelist over Python's syntax tree; no text is ever evaluated.

Allowed are numbers, the variables u (slip, m) and v (slip rate, m/s), pi, declared parameters, + - * /, ** with an exponent that
does not depend on u or v, and the functions in FUNCTIONS and COMPOSED of `stickslip.friction.formula.functions`. Length, depth and
size are limited because the text is untrusted.
"""

from __future__ import annotations

import ast
import math
import warnings
from collections.abc import Collection
from functools import lru_cache

from stickslip.foundation.errors import InputError, nearest
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
from stickslip.friction.formula.functions import COMPOSED
from stickslip.friction.formula.operations import FUNCTIONS, OPERATIONS

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
ALLOWED = f"allowed are numbers, u, v, pi, declared parameters, + - * / ** and {', '.join(FUNCTIONS)}"
"""End of a message about a part that is not allowed."""
KINKED = ("abs", "min", "max", "where", "minimum", "maximum", "sign", "heaviside", "clip", "floor", "ceil")
"""Functions with kinks or jumps that users try, which have no Taylor series there."""
KINKS = "for a kink or a jump use a law such as piecewise-linear-rate, piecewise-linear-slip or table; for a smooth step tanh"
"""End of a message about a formula with a kink."""
UNDECLARED = "is neither u, v, pi nor a declared parameter"
"""Part of the message about a name that an expression must not use."""

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
        raise InputError(f"the character {odd!a} is not allowed; {ALLOWED}")
    tree = _Reader(text, names, states).read(_syntax(text), 0)
    if len(nodes_of(tree)) > MOST_OPERATIONS:
        raise InputError(f"more than {MOST_OPERATIONS} operations, powers written out as products")
    return tree


def _syntax(text: str) -> ast.expr:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python may warn about code such as 1(2), which `_Reader` refuses
            return ast.parse(text.strip(), mode="eval").body
    except (RecursionError, MemoryError):
        raise InputError("nested too deeply") from None
    except (SyntaxError, ValueError) as error:
        if "=" in text and not set("<>!") & set(text) and "==" not in text:
            raise InputError(
                f"{_shown(text)} is not an expression, because of its sign =; write only what comes after it"
            ) from None
        where = f" at character {error.offset}" if isinstance(error, SyntaxError) and error.offset else ""
        raise InputError(f"{_shown(text)} is not an expression: mistake{where}; {ALLOWED}") from None


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
        raise InputError(f"{self.part(node)} is not allowed; {ALLOWED}")

    def number(self, node: ast.Constant) -> Expression:
        if type(node.value) not in (int, float):
            raise InputError(f"{self.part(node)} is not allowed; {ALLOWED}")
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
            raise InputError(f"the operator in {self.part(node)} is not allowed{hint}; {ALLOWED}")
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
        if isinstance(node.func, ast.Attribute) and node.func.attr in (*FUNCTIONS, *COMPOSED, *KINKED):
            raise InputError(f"{self.part(node.func)} is written {node.func.attr}, without the name of a library")
        if not isinstance(node.func, ast.Name):
            raise InputError(f"{self.part(node)} is not allowed; {ALLOWED}")
        name = node.func.id
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
