"""Smoothing of measured points: against scipy's smoothing spline, against known curves, and as a law."""

from __future__ import annotations

import re
from functools import cache
from typing import Any, Literal

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline

import stickslip as ss
from stickslip.extensions.inference.points.penalised_spline import PenalisedSpline
from stickslip.friction import Points, smooth
from stickslip.problem.scenarios.scenario import Scenario, read_scenario
from tests.messages import refused
from tests.problems import RATE_LAW, SLAB, measured

RATES = np.linspace(0.0, 10.0, 500)
NOISY = measured(RATE_LAW, None, RATES, 0.01)


def drawn(count: int, seed: int) -> tuple[Any, Any]:
    """Return places in [0, 1], ascending, with both ends and unevenly spaced, and noisy values of a curve.

    Up to 40 places are so far from each other that none of them share a place of the spline.
    """
    rng = np.random.default_rng(seed)
    x = (np.arange(count) + 0.8 * rng.uniform(size=count)) / count
    x = (x - x[0]) / (x[-1] - x[0])
    return x, 0.5 + 0.2 * np.sin(4 * x) + 0.02 * rng.standard_normal(len(x))


@pytest.mark.parametrize("strength", [1e-9, 1e-4, 1.0])
@pytest.mark.parametrize("seed", range(2))
def test_the_spline_is_the_smoothing_spline_of_scipy(strength: float, seed: int) -> None:
    """scipy minimises the sum of squares plus lam times the integral: lam = n strength."""
    x, y = drawn(40, seed)
    fine = np.linspace(0.0, 1.0, 301)
    wanted = make_smoothing_spline(x, y, lam=len(x) * strength)(fine)
    np.testing.assert_allclose(PenalisedSpline.of(x, y).curve(strength)(fine), wanted, rtol=0, atol=1e-7)


def test_repeated_places_have_the_weight_of_their_number() -> None:
    x, y = drawn(30, 1)
    weight = np.random.default_rng(1).integers(1, 6, len(x))
    wanted = make_smoothing_spline(x, y, weight, lam=np.sum(weight) * 1e-5)(x)
    found = PenalisedSpline.of(np.repeat(x, weight), np.repeat(y, weight))
    np.testing.assert_allclose(found.curve(1e-5)(x), wanted, rtol=0, atol=1e-9)


def hat(x: Any, strength: float) -> Any:
    """Return the matrix that makes smoothed values of measured ones: its columns are scipy's splines through unit vectors."""
    return np.column_stack([make_smoothing_spline(x, unit, lam=len(x) * strength)(x) for unit in np.eye(len(x))])


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("seed", range(2))
def test_cross_validation_finds_the_smallest_score_of_scipys_splines(seed: int) -> None:
    x, y = drawn(40, seed)
    n, spline, smoothed = len(x), PenalisedSpline.of(x, y), cache(lambda strength: hat(x, strength))

    def score(strength: float, inflation: float) -> float:
        smoothing = smoothed(strength)
        return float(np.mean((y - smoothing @ y) ** 2) / (1.0 - inflation * np.trace(smoothing) / n) ** 2)

    for inflation in (1.0, 1.4):
        chosen = spline.cross_validated(inflation)
        assert spline.score(chosen, inflation) == pytest.approx(score(chosen, inflation), rel=1e-5)
        others = np.geomspace(1e-8, 1.0, 9).tolist()
        smallest = min(score(one, inflation) for one in others if n > inflation * spline.freedom(one))
        assert spline.score(chosen, inflation) <= smallest * (1.0 + 1e-6)


@pytest.mark.parametrize("strength", [1e-8, 1e-5, 1e-2])
def test_freedom_is_that_of_scipys_splines(strength: float) -> None:
    """The trace of the matrix that smooths."""
    x, y = drawn(40, 4)
    assert PenalisedSpline.of(x, y).freedom(strength) == pytest.approx(np.trace(hat(x, strength)), rel=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_means_in_place_of_many_points_lose_little(seed: int) -> None:
    """The spline through all 1000 points lies within 3e-4 of it, a tenth of the standard error in the middle."""
    x, y = drawn(1000, seed)
    spline = PenalisedSpline.of(x, y)
    assert len(spline.places) <= 256
    difference = spline.curve(1e-6)(x) - make_smoothing_spline(x, y, lam=len(x) * 1e-6)(x)
    assert np.abs(difference).max() < 3e-4


def test_the_trend_of_points_that_share_a_place_is_no_noise() -> None:
    """With it they would differ from their mean by 0.014. At the ends the curve misses the points most: it is straight there."""
    x = np.linspace(0.0, 1.0, 3000)
    spline = PenalisedSpline.of(x, 3.0 * np.sin(4.0 * x))
    assert np.sqrt(spline.within) < 2e-5
    np.testing.assert_allclose(spline.curve(spline.cross_validated())(x), 3.0 * np.sin(4.0 * x), rtol=0, atol=2e-4)


def test_places_that_all_but_coincide_are_one() -> None:
    """Also where they lie on both sides of the end of a part of the axis."""
    x = np.array([0.0, 0.2, 0.25 - 1e-12, 0.25, 0.5, 0.5 + 1e-12, 1.0])
    spline = PenalisedSpline.of(x, np.cos(x))
    np.testing.assert_allclose(spline.places, [0.0, 0.2, 0.25, 0.5, 1.0], rtol=0, atol=1e-11)
    np.testing.assert_allclose(spline.curve(1e-14)(x), np.cos(x), rtol=0, atol=1e-9)


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("strength", [1e-10, 1e-7])
@pytest.mark.parametrize("seed", range(2))
def test_a_monotone_curve_lies_no_farther_from_a_falling_truth(strength: float, seed: int) -> None:
    """It is the closest one that only falls, so that this holds exactly, but for 0.01 residual in each law."""
    points = measured(RATE_LAW, None, RATES, 0.01, seed)
    plain, falling = (smooth(points, strength, scale="linear", monotone=monotone) for monotone in (False, True))
    even = np.linspace(0.0, 10.0, 4097)
    truth = RATE_LAW.coefficient(0.0, even)
    before, after = (np.sqrt(np.mean((one.law.coefficient(0.0, even) - truth) ** 2)) for one in (plain, falling))
    assert plain.reversals[1] > 0
    assert falling.reversals[1] == 0
    assert (np.diff(falling.law.friction) <= 0.0).all()
    assert after < before + 0.02 * plain.residual


def test_the_curve_lies_closer_to_the_truth_than_the_points() -> None:
    truth, errors, residuals = RATE_LAW.coefficient(0.0, RATES), [], []
    for seed in range(8):
        found = smooth(measured(RATE_LAW, None, RATES, 0.01, seed))
        errors.append(np.sqrt(np.mean((found.law.coefficient(0.0, RATES) - truth) ** 2)))
        residuals.append(found.residual)
    assert np.median(errors) < 0.002
    assert np.mean(residuals) == pytest.approx(0.01, rel=5 / np.sqrt(2 * 8 * 490))


def test_smoothing_removes_the_folds_that_noise_made() -> None:
    found = smooth(NOISY)
    (fold,) = ss.uniqueness(ss.Problem(SLAB, found.law, initial_excess=0.0)).folds
    (true,) = ss.uniqueness(ss.Problem(SLAB, RATE_LAW, initial_excess=0.0)).folds
    assert fold.rate == pytest.approx(true.rate, rel=0.05)
    assert found.reversals[0] > 300
    assert found.reversals[1] == 0


@pytest.mark.parametrize("waves", [0.0, 2.0, 4.0])
def test_the_law_follows_the_curve_within_a_hundredth_of_the_residual(waves: float) -> None:
    found = smooth(Points(NOISY.friction + 0.05 * np.sin(waves * RATES), None, RATES), scale="linear")
    fine = np.linspace(0.0, 10.0, 5000)
    curve = found._spline.curve(found.strength)(found._axis.forward(fine))
    np.testing.assert_allclose(found.law.coefficient(0.0, fine), curve, rtol=0, atol=0.011 * found.residual)
    assert len(found.law.friction) <= 1025


def test_exact_points_stay_where_they_are() -> None:
    exact = measured(RATE_LAW, None, np.linspace(0.0, 10.0, 100), 0.0)
    np.testing.assert_allclose(smooth(exact).law.coefficient(0.0, exact.places), exact.friction, rtol=0, atol=2e-5)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_the_scale_is_chosen_that_predicts_better(scale: Literal["linear", "log"]) -> None:
    law, places = ss.friction.VelocityStrengthening(0.6, 0.01, 1e-5), np.geomspace(1e-6, 1.0, 200)
    logarithmic = measured(law, None, places, 0.001)
    linear = measured(ss.friction.SinusoidalSlip(0.6, 0.1, 20.0), np.linspace(0.005, 1.0, 200), None, 0.001)
    assert smooth(linear if scale == "linear" else logarithmic).scale == scale


def test_order_and_repetition_of_points_do_not_matter() -> None:
    points = measured(RATE_LAW, None, np.repeat(np.linspace(0.0, 5.0, 40), 3), 0.01)
    order = np.random.default_rng(0).permutation(len(points))
    shuffled = Points(points.friction[order], None, points.places[order])
    wanted, found = smooth(points), smooth(shuffled)
    np.testing.assert_allclose(found.law.friction, wanted.law.friction, rtol=0, atol=1e-6)
    assert found.residual == pytest.approx(wanted.residual, rel=1e-4)


def test_points_along_negative_slip_make_a_law_of_net_slip() -> None:
    slips = np.linspace(-1.0, 1.0, 80)
    law = smooth(measured(ss.friction.SinusoidalSlip(0.6, 0.1, 3.0), slips, None, 0.005)).law
    assert law.counts == "net"
    assert (law.slip or ())[0] == -1.0


def test_smoothed_friction_is_never_negative() -> None:
    low = Points(np.abs(0.02 * np.random.default_rng(0).standard_normal(60)), None, np.linspace(0.0, 1.0, 60))
    assert min(smooth(low).law.friction) >= 0.0


def test_a_smoothed_law_is_written_to_a_scenario_and_read_back() -> None:
    scenario = Scenario(ss.Problem(SLAB, smooth(NOISY).law, initial_excess=0.0), 12.0)
    assert read_scenario(scenario.to_toml(), "again").problem == scenario.problem


def test_the_result_says_what_it_did_as_text_and_html() -> None:
    found = smooth(NOISY, strength=1e-12)
    text = repr(found)
    for part in (
        "Smoothed curve through 500 points along slip_rate",
        "residual",
        "1e-12",
        f"{found.reversals[0]} -> {found.reversals[1]}",
    ):
        assert part in text
    assert re.search(r"^  note +a reversal that survives depends on the strength", text, re.MULTILINE)
    html = found._repr_html_()
    assert "residual</th>" in html
    assert "-&gt;" in html


BAD: list[tuple[Any, dict[str, Any], str]] = [
    (NOISY, {"strength": 0.0}, "strength must be 'auto' or a number above 0, up to 1e6, got 0.0"),
    (NOISY, {"strength": "much"}, "strength must be 'auto' or a number above 0, up to 1e6, got 'much'"),
    (NOISY, {"strength": True}, "strength must be 'auto'"),
    (NOISY, {"scale": "logarithmic"}, "scale 'logarithmic' is unknown; allowed: auto, linear, log"),
    (NOISY, {"along": "slip"}, "the points have no 'slip'"),
    ({"v": [0, 1, 1, 2], "mu": [1, 1, 1, 1]}, {}, "at least 4 different values of slip_rate are needed, got 3"),
    ({"u": [-1, 1, 2, 3], "mu": [1, 1, 1, 1]}, {"scale": "log"}, "scale 'log' needs slips that are not negative"),
    ({"u": [1, 1, 2, 3], "v": [1, 1, 2, 3], "mu": [1, 1, 1, 1]}, {}, "have slip and slip_rate: choose one with along"),
]


@pytest.mark.parametrize(("points", "arguments", "message"), BAD)
def test_wrong_arguments_are_refused_in_one_line(points: Any, arguments: dict[str, Any], message: str) -> None:
    with refused(message):
        smooth(points, **arguments)
