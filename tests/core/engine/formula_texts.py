"""Hashes of the text that is generated for formulas: those of all laws, and of trees drawn at random.

python -m tests.core.engine.formula_texts    # keeps the hashes of the present code in formula_texts.json
"""

from __future__ import annotations

import hashlib
import json
import random
from collections.abc import Iterator
from pathlib import Path

from stickslip.engine.formula_code.taylor_series import ORDER, SIGNATURES, FormulaWriter
from stickslip.friction import LAWS
from stickslip.friction.formula import expression as e
from stickslip.friction.formula.expression import Expression
from stickslip.friction.formula.operations import FUNCTIONS
from tests.core.engine.drawn import example_law

KEPT = Path(__file__).with_suffix(".json")
TREES, GROUP = 300, 50
"""Number of trees, and of trees that share a hash."""
NAMES = ("a", "b", "c")
"""Parameters of the trees."""


def text_of(formula: Expression, parameters: tuple[str, ...], state_rates: tuple[Expression, ...], order: int) -> str:
    """All functions that are written for a formula."""
    writer = FormulaWriter(formula, parameters, order, state_rates)
    return "\n".join(f"{part}:\n" + "\n".join(writer.statements(part)) for part in SIGNATURES)


def tree(rng: random.Random, depth: int, states: int) -> Expression:
    """A formula of all operations, in which parts are shared."""
    if depth == 0 or rng.random() < 0.1:
        leaves = [e.SLIP, e.RATE, *e.STATES[:states], *map(e.Parameter, NAMES)]
        return rng.choice([*leaves, e.as_expression(rng.choice((0.0, 1.0, 2.0, 0.5, -1.5)))])
    kind = rng.choice(("add", "sub", "mul", "div", "pow", "whole", "shared", *FUNCTIONS))
    one = tree(rng, depth - 1, states)
    if kind in FUNCTIONS:
        return Expression(kind, (one,))
    if kind == "whole":
        return one ** rng.choice((2, 3, -1, 5))
    if kind == "pow":
        return Expression("pow", (one, rng.choice((e.Parameter("a"), e.as_expression(0.5), e.as_expression(-1.25)))))
    if kind == "shared":
        return one * one + one
    return Expression(kind, (one, tree(rng, depth - 1, states)))


def random_texts() -> Iterator[str]:
    """The texts of the trees drawn at random; every third has a state, every ninth two."""
    for seed in range(TREES):
        rng = random.Random(seed)
        states = (seed % 3 == 0) + (seed % 9 == 0)
        formula, rates = tree(rng, 3, states), tuple(tree(rng, 2, states) for _ in range(states))
        yield text_of(formula, NAMES, rates, 3)


def _digest(*texts: str) -> str:
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


def hashes() -> dict[str, str]:
    """The hash of each law's text, and of each group of random trees."""
    found = {}
    for kind in LAWS:
        law = example_law(kind)
        texts = [text_of(one, law.parameters(), law.state_trees(), ORDER) for one in law.trees()]
        found[kind] = _digest(*texts)
    drawn = list(random_texts())
    for first in range(0, TREES, GROUP):
        found[f"trees {first} to {first + GROUP - 1}"] = _digest(*drawn[first : first + GROUP])
    return found


if __name__ == "__main__":
    KEPT.write_text(json.dumps(hashes(), indent=0) + "\n", encoding="utf-8")
