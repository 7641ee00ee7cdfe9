"""How much work a cycle takes, counted in steps, and the mathematics that saves it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.near import limit_of
from stickslip.extensions.cycles.newton import Miss, curved_step, next_steps
from stickslip.run import ExactRun
from tests.extensions.cycles.problems import rate_and_state, stribeck

TEN_RUNS = 10.0


def lagged() -> ss.Problem:
    law = ss.friction.LaggedFriction(rate=ss.friction.HyperbolicRate(0.8, 0.3, 10.0), time=0.05)
    return ss.Problem(ss.SpringBlock(1.0, 1e3, 10.0, damping=2.0), law, pull_rate=0.1, initial_load=0.0, initial_state=0.0)


def two_states() -> ss.Problem:
    """Return a block under two states and the slip law, at 0.9 of its critical stiffness."""
    law = ss.friction.TwoStateRateAndState(
        reference=0.6, a=0.01, b=0.01, distance=1e-5, second_b=0.0084, second_distance=1e-5 / 0.048, evolution="slip"
    )
    return ss.Problem(ss.SpringBlock(100.0, 722.5195185, 10.0), law, pull_rate=1e-6)


@pytest.mark.parametrize(
    ("problem", "near"),
    [
        (stribeck(0.1, initial_load=0.0), None),
        (stribeck(0.2, initial_rate=0.2, initial_load=8.5), 0.7),
        (lagged(), None),
        (rate_and_state(), None),
        (rate_and_state("slip"), None),
        (two_states(), None),
    ],
)
def test_a_cycle_takes_no_more_steps_than_ten_runs_of_one_period(
    problem: ss.Problem, near: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Steps of all runs, the one that settles among them, over those of the run of one period (rtol 1e-12)."""
    runs: dict[int, Any] = {}
    begin = ExactRun.begin.__func__

    def counted(cls: Any, *given: Any) -> Any:
        run = begin(cls, *given)
        runs[len(runs)] = run
        return run

    monkeypatch.setattr(ExactRun, "begin", classmethod(counted))
    found = ss.studies.cycle(problem, near=near)
    steps = sum(run.length for run in runs.values())
    assert np.isfinite(found.multipliers).all()
    assert steps <= TEN_RUNS * (found.orbit.closed.piece + 1)


@pytest.mark.parametrize("factors", [(0.9, -0.3, 0.01), (1.4, 0.2, 0.1), (-0.95, 0.5, 0.3)])
def test_the_limit_of_a_linear_map_is_found_from_five_places(factors: tuple[float, float, float]) -> None:
    """Stable or not, to 1e-9; with extents of the coordinates that differ by nine orders."""
    rng = np.random.default_rng(3)
    extent, vectors = np.array([1.0, 1e-6, 1e3]), rng.normal(size=(3, 3))
    matrix = vectors @ np.diag(factors) @ np.linalg.inv(vectors)
    places, goal = [1e-3 * rng.normal(size=3)], rng.normal(size=3)
    for _ in range(4):
        places.append(matrix @ places[-1])
    found = limit_of(extent[:, None] * (goal[:, None] + np.array(places).T), extent)
    assert found is not None
    assert found / extent == pytest.approx(goal, abs=1e-9)


def test_no_limit_is_taken_where_it_is_far_or_where_the_steps_are_too_long_for_a_line() -> None:
    one = np.ones(1)
    assert limit_of(np.array([[0.0, 0.01, 0.0199]]), one) is None  # at 1
    assert limit_of(np.array([[0.0, 0.5, 0.6]]), one) is None  # the square of the first step is above the second
    assert limit_of(np.array([[0.0, 0.01]]), one) is None
    assert limit_of(np.array([[0.0, 0.01, 0.015]]), one) == pytest.approx([0.02], abs=1e-15)


def test_a_step_with_curvature_solves_a_map_that_bends_in_one_direction() -> None:
    """F(d) = F + J d + a (s d)^2 / 2, known at 0 with J and at s: to 1e-14; Newton's own step misses by a tenth."""
    rng = np.random.default_rng(5)
    derivative, bend, way = np.eye(3) + 0.1 * rng.normal(size=(3, 3)), rng.normal(size=3), 0.3 * rng.normal(size=3)

    def map_at(step: Any) -> Any:
        return missed + derivative @ step + 0.5 * bend * (way @ step) ** 2

    missed = np.zeros(3)
    missed = -map_at(0.8 * way)  # so that 0.8 of the way is the root
    straight = -np.linalg.solve(derivative, missed)
    found = curved_step(derivative, straight, way, map_at(way) - missed)
    assert found == pytest.approx(0.8 * way, abs=1e-14)
    assert np.abs(map_at(straight)).max() > 1e-3


def test_a_step_of_a_cycle_whose_extent_is_next_to_nothing_is_that_of_newton() -> None:
    """Next to steady sliding the ways to earlier returns overflow: they show no curvature, and nothing warns of it."""
    now: Any = SimpleNamespace(start=np.array([5.0]), missed=np.array([1e-13]), about=np.array([[0.5]]))
    steps = next_steps(now, [Miss(np.array([4.0]), np.array([-0.1]))], np.array([1e-300]))
    assert steps.curved == pytest.approx(steps.straight, rel=1e-12)
    assert steps.curved == pytest.approx([2e-13], rel=1e-12)
