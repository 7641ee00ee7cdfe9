"""Parts of the engine that are compiled apart come when a run needs them, and not before."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine import on_demand
from stickslip.engine.on_demand import PART_MODULES, function_of
from stickslip.engine.session import Session
from stickslip.engine.state.layout import EnginePart, NearFold
from stickslip.engine.state.workspace import Run
from stickslip.run.options import CallOptions

F = ss.friction
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
FREE = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=0.0)
FOLDING = ss.Problem(FREE, F.HyperbolicRate(0.8, 0.3, 1.0), pull_rate=2.6, initial_load=6e7, selection="maximal")
"""The slip rate goes round a loop with two folds."""
DIPPING = ss.Problem(SLAB, F.FromExpression("0.6 - 0.61*sin(u/3)", counts="path"), initial_excess=1e6)
"""Friction falls below zero at a slip of 3 arcsin(60/61) m, which is 4.17 m."""
PASSES = 150
"""Passes of the loop (1): FOLDING passes several folds in them, and is not at its end."""
NEEDED = {
    "a rate law that keeps off its folds": (ss.load_scenario("fig6-slab").problem, 12.0, set()),
    "folds": (FOLDING, 8.0, {EnginePart.FOLDS}),
    "friction below zero": (DIPPING, 8.0, {EnginePart.NEGATIVE_FRICTION}),
}


@pytest.mark.parametrize("what", NEEDED)
def test_a_run_gets_the_parts_that_it_needs(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    problem, duration, parts = NEEDED[what]
    monkeypatch.setattr(on_demand, "_at_hand", np.zeros(len(PART_MODULES), np.int64))
    run = ss.simulate(problem, duration)
    assert {part for part, address in zip(PART_MODULES, on_demand._at_hand, strict=True) if address} - {
        EnginePart.ECHO_QUEUE
    } == parts
    if problem is DIPPING:
        assert run.slip(run.history.duration) == pytest.approx(3.0 * math.asin(60.0 / 61.0), rel=1e-6)


def test_each_part_is_a_kernel_in_its_module() -> None:
    assert set(PART_MODULES) == set(EnginePart) - {EnginePart.NONE}
    assert {part: function_of(part).__name__ for part in PART_MODULES} == {part: part.name.lower() for part in PART_MODULES}


def passed(takes_part_away: bool) -> tuple[int, np.ndarray]:
    """Run FOLDING pass by pass; return how often its folds were taken away beside one, and its pieces."""
    run, taken = Session.begin(FOLDING, CallOptions(8.0)), 0
    lent = Run(run.memory)
    for n in range(PASSES):
        run.advance(1)
        if takes_part_away and n % 2 == 1 and run.count.at_fold != NearFold.NONE and lent.folds != 0:
            lent.folds, taken = 0, taken + 1
    return taken, run.history().store.pieces


def test_a_run_that_is_taken_up_beside_a_fold_asks_for_folds_again() -> None:
    """As in a new process, which has lent nothing. A call that asks makes no pass."""
    (_, kept), (taken, again) = passed(takes_part_away=False), passed(takes_part_away=True)
    assert taken > 3
    assert 20 < len(again) <= len(kept)
    assert kept[: len(again)].tobytes() == again.tobytes()
