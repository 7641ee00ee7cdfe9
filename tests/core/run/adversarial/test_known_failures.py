"""Failures that were met once, by name: features of a law that steps went over without a word.

The numbers were computed with scipy before these tests were written, and are computed again here.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.core.run.adversarial.cases import Case
from tests.core.run.adversarial.checks import CLAIM, errors, off_the_law
from tests.core.run.adversarial.features import Feature, Recipe
from tests.core.run.adversarial.truth import truth_of

F = ss.friction
SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
HEAVY = replace(SLAB, contact_mass=1e3)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
STRIBECK = F.ExponentialStribeck(static=0.8, dynamic=0.3, rate=0.01, exponent=1)


def bump(amplitude: float, width: float) -> tuple[Any, Recipe]:
    """A bump of friction at a slip of 1 m, for the package and for the truth."""
    recipe = Recipe(0.6, (Feature("bump", "u", amplitude, 1.0, width),))
    return F.FromExpression(recipe.text, recipe.parameters), recipe


def bump_case(body: Any, amplitude: float, width: float, excess: float, duration: float) -> Case:
    """Slip from 0 over the bump."""
    law, recipe = bump(amplitude, width)
    problem = ss.Problem(body, law, initial_excess=excess)
    return Case("bump", problem, recipe.value, recipe, duration, slip=1.0, rate=1.0)


def tail_case(problem: ss.Problem, duration: float, slip: float, rate: float) -> Case:
    """Slip under STRIBECK, whose tail begins at rest."""
    recipe = Recipe(0.3, (Feature("tail", "v", 0.5, 0.0, 0.01),))
    return Case("tail", problem, recipe.value, recipe, duration, slip, rate)


BELT = ss.Problem(ss.SpringBlock(1.0, 100.0, 10.0), STRIBECK, pull_rate=0.01, initial_excess=0.0)
UNLOADED = ss.Problem(SLAB, STRIBECK, pull_rate=-20.0, initial_excess=2e7)
MET: dict[str, tuple[Case, str, float]] = {
    "tail while a mass on a belt slows down": (tail_case(BELT, 0.5, 0.1, 1.0), "end", 0.33240),  # the first engine: 0.33378 s
    "tail while a slab is unloaded": (tail_case(UNLOADED, 0.99 * SLAB.two_way_time, 20.0, 8.0), "law", 1e-9),  # 1.7e-4
    "bump in the way of a slab": (bump_case(SLAB, 0.05, 0.1, 1e7, 4.0), "law", 1e-9),  # 5 % off
    "bump in the way of a block": (bump_case(BLOCK, 0.3, 0.1, 3e13, 2.5), "total", 1.54913),  # 1.70768 m
    "narrow bump in the way of a mass": (
        bump_case(replace(SLAB, contact_mass=1e3), 0.05, 0.01, 1e7, 4.0),
        "total",
        4.0672,
    ),  # 4.0815 m
}
"""A case; the end of its first event (s) or its slip (m), known beforehand, or how far traction may be off the law (of S)."""


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", MET)
def test_steps_meet_a_feature_on_their_way(name: str) -> None:
    case, what, known = MET[name]
    run = ss.simulate(case.problem, case.duration)
    if what == "law":
        assert run.status.ok
        assert off_the_law(run) < known
        return
    truth = truth_of(case)
    assert errors(run, truth).largest < CLAIM
    assert getattr(truth, what) == pytest.approx(known, rel=2e-5)


@pytest.mark.parametrize("start", [0.0, 0.2, 0.5, 0.8])
def test_tanh_far_from_where_slip_begins_keeps_its_digits(start: float) -> None:
    """The difference from the start was 0/0 from some 19 widths on, and lost digits before: 1e-14 of the step is left."""
    law = F.FromExpression("0.6 + 0.1*tanh((u - 1)/w)", {"w": 0.02})
    case = ss.Problem(SLAB, law, initial_slip=start, initial_excess=2e7)
    run = ss.simulate(case, 0.05)
    assert run.status.ok
    slip = np.linspace(start, 2.0, 301)
    plain = 0.1 * (np.tanh((slip - 1.0) / 0.02) - np.tanh((start - 1.0) / 0.02))
    from stickslip.friction.formula.differences import difference

    found, _ = difference(law.trees()[0], law.numbers(), start, slip - start, 0.0)
    assert found == pytest.approx(plain, rel=0.0, abs=3e-16)


def test_expression_with_parameters_can_be_a_part_of_another_law() -> None:
    """A lagged law, a sum and a product of expressions see their own parameters (they raised KeyError)."""
    text, values = "d + a/(1 + v/w)", {"d": 0.3, "a": 0.5, "w": 1.0}
    rate, known = F.FromExpression(text, values), F.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    slip = F.SinusoidalSlip(0.1, 0.05, 3.0)
    for one, other in (
        (F.LaggedFriction(rate, 0.1), F.LaggedFriction(known, 0.1)),
        (F.SlipPlusRate(slip, rate), F.SlipPlusRate(slip, known)),
        (F.SlipTimesRate(slip, rate), F.SlipTimesRate(slip, known)),
    ):
        mine, theirs = (ss.simulate(ss.Problem(BLOCK, law, initial_excess=1e12), 2.0) for law in (one, other))
        assert float(mine.slip(2.0)) == pytest.approx(float(theirs.slip(2.0)), rel=1e-9)
