"""No call of compiled code can last for ever: Ctrl-C and a closed page are noticed only between two calls.

Every loop of compiled code runs over a range, counts down or up to a bound, or is on a list here with the reason why it ends. The
sources are read as syntax trees, so that a new loop without a bound fails the test.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.formula_code.taylor_series import SIGNATURES, FormulaWriter
from stickslip.engine.series import polynomial
from stickslip.engine.series.polynomial import MOST_CROSSINGS, NONE, crossings
from stickslip.engine.state.layout import TERMS
from stickslip.foundation.code_key import PACKAGE
from stickslip.foundation.kernels.code import compiled_sources
from stickslip.friction.piecewise import PiecewiseLaw
from tests.core.engine.compiled import compiled

COMPILERS = ("kernel", "inlined", "entry", "exact", "exact_entry")
"""Decorators of compiled functions."""
OTHER_LOOPS = {
    ("taylor_step.py", "expand_series"): "unit is at most 1, and falls by 1e-3 each time until it is below 1e-300",
    ("runs.py", "run_group"): "looks at the flag that stops the batch after each step; every member's run ends",
    ("runs.py", "advance_member"): "looks at the flag that stops the batch after each call of the engine, which is bounded",
    ("lanes.py", "step_under"): "each pass clears a bit of a whole number",
    ("lanes.py", "choose_length"): "each pass clears a bit of a whole number",
    ("contact_equation.py", "face"): "each pass goes to the next piece of a law, whose last one has no end",
    ("along_motion.py", "take_step"): "each pass shortens a step to at most nine tenths, or a quarter, down to the shortest",
    ("advance.py", "advance"): "each pass spends at least 1 of a budget",
    ("steps.py", "take_samples"): "each pass goes to the next sample, in one direction",
    ("steps.py", "expand"): "unit falls by 1e-3 each time until it is below 1e-300",
    ("lists.py", "rests_from_now"): "each pass goes to the next moving block, and the one that is looked for is among them",
    ("loads.py", "piece_of"): "each pass goes to the next piece of a law, in one direction",
    ("certificate.py", "least_share"): "each pass goes to the next disc of a list, in one direction",
    ("merged_creep.py", "plan_group"): "each pass takes the next piece of a round trip, in one direction",
    ("layer_replay.py", "first_change"): "each pass halves what is between two bounds",
    ("turn_search.py", "edges_of"): "each pass goes to the next edge, at a higher slip rate, up to the end of the piece",
    ("turn_search.py", "first_cells"): "each pass goes to the next edge, at a higher slip rate, up to the end of the piece",
    ("turn_search.py", "search_contact"): "each pass takes from what is left to examine; then nothing is cut any more",
    ("turning_points.py", "piece_next_to_rest"): "each pass goes to the next piece of a history, in one direction",
}
"""Loops that no syntax tells to end, by file and function, with the reason why they do."""
RECURSIONS = {
    ("echo_queue.py", "in_order"): "each call goes down one level of a finite tree",
    ("echo_queue.py", "join"): "each call takes one node off one of two finite trees",
    ("echo_queue.py", "split"): "each call goes down one level of a finite tree",
    ("echo_queue.py", "without_first"): "each call goes down one level of a finite tree",
}
"""Functions that call themselves, with the reason why this ends."""

Functions = Iterator[tuple[str, ast.FunctionDef]]


def compiled_functions() -> Functions:
    """Yield the name of the file and the syntax tree of every compiled function."""
    for path in [*compiled_sources(), *PACKAGE.glob("extensions/*/compiled/*.py")]:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and any(name_of(one) in COMPILERS for one in node.decorator_list):
                yield path.name, node


def name_of(decorator: ast.expr) -> str:
    called = decorator.func if isinstance(decorator, ast.Call) else decorator
    return called.id if isinstance(called, ast.Name) else ""


def counts(loop: ast.While) -> bool:
    """Return True if a loop counts towards a bound: its last statement moves a number that its condition compares with it."""
    step, tests = loop.body[-1], loop.test.values if isinstance(loop.test, ast.BoolOp) else [loop.test]
    if isinstance(loop.test, ast.BoolOp) and not isinstance(loop.test.op, ast.And):
        return False
    if not (isinstance(step, ast.AugAssign) and isinstance(step.target, ast.Name) and isinstance(step.value, ast.Constant)):
        return False
    if any(isinstance(node, ast.Continue) for node in ast.walk(loop)) or not step.value.value > 0:
        return False
    rises, counter = isinstance(step.op, ast.Add), step.target.id
    if not rises and not isinstance(step.op, ast.Sub | ast.RShift):
        return False
    return any(is_bound(test, counter, rises) and not changes(loop, test) for test in tests)


def is_bound(test: ast.expr, counter: str, rises: bool) -> bool:
    """Return True if a condition keeps a counter below a bound (above it, if it falls)."""
    if not (isinstance(test, ast.Compare) and len(test.ops) == 1 and isinstance(test.left, ast.Name) and test.left.id == counter):
        return False
    return isinstance(test.ops[0], (ast.Lt, ast.LtE) if rises else (ast.Gt, ast.GtE))


def changes(loop: ast.While, test: ast.expr) -> bool:
    """Return True if the loop assigns to a name in the bound of a condition."""
    assert isinstance(test, ast.Compare)
    bound = {node.id for node in ast.walk(test.comparators[0]) if isinstance(node, ast.Name)}
    return any(isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in bound for node in ast.walk(loop))


def test_every_loop_in_compiled_code_has_a_bound() -> None:
    open_ends = set()
    for file, function in compiled_functions():
        for node in ast.walk(function):
            if isinstance(node, ast.While) and not counts(node):
                open_ends.add((file, function.name))
            elif isinstance(node, ast.For):
                over = node.iter.func if isinstance(node.iter, ast.Call) else node.iter
                bounded = isinstance(over, ast.Tuple) or (isinstance(over, ast.Name) and over.id == "range")
                assert bounded, f"{file}, {function.name}: line {node.lineno} runs over something that is no range"
    assert open_ends == set(OTHER_LOOPS)


def test_every_recursion_in_compiled_code_is_known() -> None:
    found = set()
    for file, function in compiled_functions():
        calls = {node.func.id for node in ast.walk(function) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
        if function.name in calls:
            found.add((file, function.name))
    assert found == set(RECURSIONS)


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("while n > 0 and c[n] == 0.0:\n    n -= 1", True),
        ("while node >= 1:\n    node >>= 1", True),
        ("while n < len(c):\n    n += 1", True),
        ("while True:\n    n += 1", False),
        ("while start < 1.0:\n    start, width = following(start, width)", False),
        ("while n > 0:\n    n += 1", False),
        ("while n < top or c[n] == 0.0:\n    n += 1", False),
        ("while n < top:\n    top = 2 * n\n    n += 1", False),
        ("while n < top:\n    if c[n] > 0.0:\n        continue\n    n += 1", False),
        ("while n < top:\n    if c[n] > 0.0:\n        n += 1", False),
    ],
)
def test_the_reader_of_loops_knows_which_ones_count(text: str, ends: bool) -> None:
    (loop,) = ast.parse(text).body
    assert isinstance(loop, ast.While)
    assert counts(loop) == ends


def test_the_code_of_formulas_has_no_loops() -> None:
    law = ss.friction.RateAndState(**ss.friction.RateAndState.example)
    writer = FormulaWriter(law.trees()[0], law.parameters(), state_rates=law.state_trees())
    for part in SIGNATURES:
        tree = ast.parse("\n".join(writer.statements(part)))
        assert not any(isinstance(node, ast.While | ast.For | ast.comprehension) for node in ast.walk(tree))


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", [0, 1, 5, TERMS - 1])
def test_a_polynomial_that_is_not_finite_has_no_roots(wrong: float, place: int) -> None:
    """Each of these calls would bisect [0, 1] into 1e15 parts if nothing ended it."""
    c, first_descent = np.linspace(1.0, -1.0, TERMS), compiled(polynomial.first_descent)
    c[place] = wrong
    assert first_descent(c.copy(), np.empty(TERMS)) in (NONE, 0.0)  # 0 where the polynomial starts at minus infinity
    assert not np.isfinite(compiled(polynomial.extremes)(c)).any()
    assert crossings(c, np.empty(MOST_CROSSINGS), np.empty(TERMS)) == 0


@pytest.mark.parametrize("order", [1, 9, TERMS - 2])
@pytest.mark.parametrize("root", [0.3, 0.5, 1.0 / 3.0, 0.7])
def test_the_limit_of_a_bisection_is_not_reached_by_roots_of_high_order(root: float, order: int) -> None:
    """A root of order n is known to the nth root of rounding; clusters of roots took 400 of the intervals allowed at most."""
    c = np.zeros(TERMS)
    c[: order + 1] = -np.polynomial.polynomial.polyfromroots(np.full(order, root))
    assert compiled(polynomial.first_descent)(c, np.empty(TERMS)) == pytest.approx(root, abs=3.0 * 1e-16 ** (1.0 / order))


@pytest.mark.parametrize(
    ("points", "least"),
    [
        ({"slip": [0.0, 1e-104, 1.0]}, "1e-104 m"),
        ({"rate": [0.0, 0.5, 1.0, 1.0 + 3e-16]}, None),
        ({"slip": [0.0, 1e-99, 1.0]}, None),
    ],
)
def test_points_too_close_for_finite_coefficients_are_refused_in_one_line(
    points: dict[str, list[float]], least: str | None
) -> None:
    friction = [0.6, 0.5, 0.4, 0.3][: len(next(iter(points.values())))]
    if least is None:
        assert np.isfinite(ss.friction.FromTable(friction=friction, **points).rows).all()
        return
    with pytest.raises(ss.InputError, match=rf"^FromTable: the points at 0 and {least} are too close .* 1e-100 m is allowed$"):
        ss.friction.FromTable(friction=friction, **points)


@pytest.mark.parametrize("law", [ss.friction.PiecewiseLinearSlip, ss.friction.PiecewiseLinearRate])
def test_lines_too_steep_for_floats_are_refused_in_one_line(law: type[PiecewiseLaw]) -> None:
    with pytest.raises(
        ss.InputError, match=r"the points at 0 and 1e-310 m(/s)? are too close together: .* 1e-300 m(/s)? is allowed$"
    ):
        law((0.0, 1e-310, 1.0), (0.6, 0.5, 0.4))  # type: ignore[call-arg]
    law((0.0, 1e-300, 1.0), (0.6, 0.5, 0.4))  # type: ignore[call-arg]


@pytest.mark.filterwarnings("ignore:invalid value")
@pytest.mark.parametrize("body", [ss.ElasticSlab(2800, 3500, 1e4, 1e8), ss.SpringBlock(2.8e12, 3.43e13, 1e14)])
def test_a_run_that_meets_coefficients_that_are_not_finite_ends(
    body: ss.ElasticSlab | ss.SpringBlock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the check of its points the law has the coefficients that once froze a run: the engine itself must leave."""
    monkeypatch.setattr(PiecewiseLaw, "_check_coefficients", lambda law: None)
    law = ss.friction.PiecewiseLinearSlip((0.0, 1e-310, 1.0), (0.6, 0.5, 0.4))
    with np.errstate(all="ignore"), pytest.raises(ss.InputError, match="left the range of floating-point numbers"):
        ss.simulate(ss.Problem(body, law, pull_rate=0.1, initial_excess=0.0), 20.0, max_pieces=1000)
