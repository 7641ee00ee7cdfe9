"""Noise in points that are joined exactly: found where it is, not where a law is smooth, and told to users."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.errors import InputWarning
from stickslip.friction import LAWS, FromTable, PiecewiseLinearRate, PiecewiseLinearSlip
from stickslip.friction.noise import noise_in, reversals
from stickslip.scenarios.examine import examine
from stickslip.scenarios.scenario import Scenario, read_scenario
from stickslip.scenarios.templates import template
from tests.problems import RATE_LAW, SLAB, measured

SMOOTH = [kind for kind, law in LAWS.items() if law.state is None and kind != "table"]


@pytest.mark.parametrize("kind", SMOOTH)
@pytest.mark.parametrize("count", [9, 30, 300, 3000])
@pytest.mark.parametrize("decades", [False, True])
def test_no_smooth_law_looks_noisy(kind: str, count: int, decades: bool) -> None:
    law = read_scenario(template("slab", kind), "starter").problem.friction
    places = np.append(0.0, np.geomspace(1e-6, 2.0, count)) if decades else np.linspace(0.0, 2.0, count)
    for values in (law.coefficient(places, 0.0), law.coefficient(0.1, places), law.coefficient(places, places)):
        assert noise_in(places, values) is None
        assert noise_in(places, np.round(values, 4)) is None  # the digits of a file


@pytest.mark.parametrize("points_per_wave", [5.3, 6, 9, 20])
def test_a_wave_with_five_points_or_more_is_not_noise(points_per_wave: float) -> None:
    x = np.arange(400.0)
    assert noise_in(x, 0.5 + 0.1 * np.sin(2 * np.pi * x / points_per_wave)) is None


@pytest.mark.parametrize("size", [1e-4, 1e-2])
def test_noise_is_found_and_its_size_is_right(size: float) -> None:
    """Of 300 draws of 50 points none is missed; the sizes are right on average, to 5 standard errors of this experiment."""
    sizes = []
    for seed in range(300):
        points = measured(RATE_LAW, None, np.linspace(1.0, 1.0 + 20.0 * size, 50), size, seed)
        found = noise_in(points.places.tolist(), points.friction.tolist())
        assert found is not None
        sizes.append(found.size)
    assert np.sqrt(np.mean(np.square(sizes))) == pytest.approx(size, rel=5 * 0.13 / np.sqrt(300) + 0.01)


def test_reversals_are_those_of_the_sequence_without_plateaus() -> None:
    assert reversals([1.0, 2.0, 2.0, 1.0, 1.0, 3.0]) == 2
    assert reversals([1.0, 2.0, 2.0, 3.0]) == 0


NOISY: dict[str, Any] = {"friction": measured(RATE_LAW, None, np.linspace(0.0, 2.0, 500), 0.01).friction.tolist()}


@pytest.mark.parametrize(
    ("law", "fields"),
    [
        (FromTable, {"rate": np.linspace(0, 2, 500), "friction": NOISY["friction"]}),
        (FromTable, {"slip": np.linspace(0, 2, 500), "friction": NOISY["friction"]}),
        (PiecewiseLinearRate, {"rates": np.linspace(0, 2, 500), "coefficients": NOISY["friction"]}),
        (PiecewiseLinearSlip, {"slips": np.linspace(0, 2, 500), "coefficients": NOISY["friction"]}),
    ],
)
def test_a_law_through_noisy_points_warns_at_the_users_line(law: Any, fields: dict[str, Any]) -> None:
    with pytest.warns(InputWarning, match=r"the points look noisy \(about 0.01 in friction\): interpolated exactly") as caught:
        law(**fields)
    assert [one.filename for one in caught] == [__file__]


def test_an_examination_says_how_many_folds_noise_makes() -> None:
    with warnings.catch_warnings(action="ignore", category=InputWarning):
        law = FromTable(rate=np.linspace(0, 2, 500), **NOISY)
        problem = ss.Problem(SLAB, law, initial_excess=0.0)
        few = FromTable(rate=np.linspace(0, 0.4, 100), friction=NOISY["friction"][:100])  # the examination looks along all slips
        part = ss.friction.SlipPlusRate(ss.friction.ExponentialSlipWeakening(0.2, 0.1, 1.0), few)
        mixed = ss.Problem(SLAB, part, initial_excess=0.0)
    folds = len(ss.uniqueness(problem).folds)
    assert folds > 100
    said = examine(Scenario(problem, 12.0)).warnings[0]
    assert said.startswith("the points look noisy (about 0.01 in friction)")
    assert f"they make {folds} folds; smooth them or fit a law with `stickslip fit`" in said
    assert examine(Scenario(mixed, 12.0)).warnings[0].startswith("the points look noisy")
