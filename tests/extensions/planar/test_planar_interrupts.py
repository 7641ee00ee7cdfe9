"""Ctrl-C, sent as a signal at many phases of a planar run."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.extensions.planar.run import PlanarRun
from stickslip.extensions.planar.solution import Frames
from stickslip.extensions.planar.solver import PlanarSolver
from stickslip.run import run_loop
from stickslip.run.options import CallOptions
from tests.core.run.long_runs.signals import heard, lost
from tests.extensions.planar.patches import patch


@pytest.mark.slow
def test_a_signal_at_any_phase_of_a_planar_run_is_heard() -> None:
    """In one frame a round trip, so that all but two of its calls of the solver end between frames."""

    slab = patch(nodes=32, length=2e4)
    monkeypatch = pytest.MonkeyPatch()
    with monkeypatch.context() as changed:
        changed.setattr("stickslip.run.run_loop.FIRST_BUDGET", 4)
        changed.setattr("stickslip.run.run_loop.next_budget", lambda *_: 4)
        changed.setattr("stickslip.extensions.planar.run.NODES_OF_BUDGET", 32)
        assert not lost(lambda: ss.simulate(slab, 6.0, frames=1), heard)


@pytest.mark.slow
def test_the_budget_of_slow_steps_falls_to_a_single_one() -> None:
    """Under a contact of so many nodes that a step of all of them takes a call."""

    assert run_loop.next_budget(8, 8.0) == run_loop.SMALLEST_BUDGET
    slab = patch(nodes=30_000, length=2e7)
    run = PlanarRun(CallOptions(1.0), PlanarSolver(slab, 1e-3), (slice(None),), 0.0, Frames(slab, slab.steps_per_round_trip))
    run.advance(run_loop.SMALLEST_BUDGET)
    assert run.length == 1
