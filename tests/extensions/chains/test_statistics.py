"""The Gutenberg-Richter slope is the most likely one, and its interval holds the truth as often as it says."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize_scalar

import stickslip as ss
from stickslip.extensions.chains.statistics_likelihood import completeness_of, mean_cut, slope

LN_10 = math.log(10.0)


def drawn(count: int, b: float = 1.0, seed: int = 1) -> Any:
    """Return exact magnitudes above 0 with a known slope."""
    return np.random.default_rng(seed).exponential(1.0 / (b * LN_10), count)


def in_bins(count: int, b: float = 1.0, width: float = 0.1, seed: int = 1) -> Any:
    """Return magnitudes above 4 in bins whose lower edge is 4 - width/2: 4, 4.1, ..."""
    return np.round(4.0 + width * np.floor(drawn(count, b, seed) / width), 9)


def likelihood(beta: float, magnitudes: Any, width: float, span: float) -> float:
    """Return minus the mean logarithm of the probability of magnitudes above 0, by integrals over each bin written out."""
    if not width:
        norm = (1.0 - math.exp(-beta * span)) / beta if math.isfinite(span) else 1.0 / beta
        return float(np.mean(beta * magnitudes) + math.log(norm))
    bins = np.arange(0.0, (span if math.isfinite(span) else 60.0) + 0.5 * width, width)
    weights = (np.exp(-beta * bins) - np.exp(-beta * (bins + width))) / beta
    shares = weights / weights.sum()
    return -float(np.mean(np.log(shares[np.round(magnitudes / width).astype(int)])))


@pytest.mark.parametrize(("width", "span"), [(0.0, math.inf), (0.0, 1.0), (0.1, math.inf), (0.1, 0.8), (0.5, 2.0), (0.7, math.inf)])
@pytest.mark.parametrize("b", [0.4, 1.0, 1.7])
def test_the_slope_is_where_the_likelihood_is_largest(width: float, span: float, b: float) -> None:
    magnitudes = drawn(500, b, seed=7)
    if width:
        magnitudes = np.round(magnitudes / width - 0.5) * width
    magnitudes = magnitudes[magnitudes <= span + 0.5 * width]
    best = minimize_scalar(likelihood, (0.5 * b, 4.0 * b), args=(magnitudes, width, span), options={"xtol": 1e-12})
    # the minimum of a parabola is known to the root of rounding
    assert slope(float(magnitudes.mean()), width, span) == pytest.approx(best.x, rel=1e-6, abs=0.0)


def test_closed_forms() -> None:
    assert slope(0.5) == 2.0
    assert slope(0.5, 0.1) == pytest.approx(math.log(1.2) / 0.1, rel=1e-15, abs=0.0)
    assert slope(0.5, 1e-9) == pytest.approx(2.0, rel=1e-8, abs=0.0)
    assert slope(0.5, 0.0, 1.0) == pytest.approx(0.0, abs=1e-12)  # the mean of a flat law
    # two bins: the share of the upper one is q / (1 + q) with q = exp(-beta d)
    assert slope(0.1 * 0.2, 0.1, 0.1) == pytest.approx(math.log(4.0) / 0.1, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("z", [-300.0, -3.0, -0.0500001, -0.0499999, -1e-9, 1e-9, 0.0499999, 0.0500001, 0.7, 40.0, 300.0])
def test_the_mean_of_a_law_that_is_cut_off_is_right_to_rounding(z: float) -> None:
    from mpmath import expm1, mp, mpf

    with mp.workdps(50):
        exact = float(1 / mpf(z) - 1 / expm1(mpf(z)))
    assert mean_cut(z) == pytest.approx(exact, rel=1e-13, abs=0.0)


def test_a_cut_far_away_changes_nothing() -> None:
    assert slope(0.4, 0.1, 1000.0) == slope(0.4, 0.1)
    assert slope(0.4, 0.0, 12.0) == pytest.approx(slope(0.4), rel=1e-10, abs=0.0)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("b", [0.6, 1.0, 1.5])
@pytest.mark.parametrize("width", [0.0, 0.1, 0.5])
def test_the_slope_of_drawn_magnitudes_is_that_of_their_law(b: float, width: float) -> None:
    magnitudes = in_bins(100_000, b, width) if width else drawn(100_000, b)
    found = ss.studies.gutenberg_richter(magnitudes, 4.0 if width else 0.0, width, confidence=0.9999, resamples=400)
    assert found.b == pytest.approx(b, rel=4.0 / math.sqrt(100_000), abs=0.0)
    assert found.beta == pytest.approx(found.b * LN_10, rel=1e-15, abs=0.0)
    assert found.low < b < found.high


def test_the_slope_is_that_of_a_peer_that_is_exact_for_bins() -> None:
    """SeismoStats 1.0.1, findings/seismostats-b-value-is-exact-for-bins.sh, says 1.0040396525586752 for the same magnitudes."""
    found = ss.studies.gutenberg_richter(in_bins(100_000), 4.0, 0.1)
    assert found.b == pytest.approx(1.0040396525586752, rel=1e-12, abs=0.0)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("given", [None, 4.0])
def test_one_small_event_among_100_000_changes_nothing(given: float | None) -> None:
    magnitudes = in_bins(100_000)
    for small in (2.4, -40.0):
        alone, beside = (ss.studies.gutenberg_richter(one, given, 0.1) for one in (magnitudes, np.append(magnitudes, small)))
        assert beside.events == alone.events
        of_both = [[one.b, one.low, one.high, one.completeness] for one in (alone, beside)]
        assert of_both[1] == pytest.approx(of_both[0], rel=1e-12, abs=0.0)
    exact = drawn(100_000)
    alone, beside = (ss.studies.gutenberg_richter(one) for one in (exact, np.append(exact, -7.3)))
    assert beside.b == pytest.approx(alone.b, rel=1e-4, abs=0.0)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("width", "largest"), [(0.0, None), (0.3, None), (0.0, 1.0)])
def test_the_interval_holds_the_truth_as_often_as_it_says(width: float, largest: float | None) -> None:
    held = 0
    for seed in range(200):
        magnitudes = in_bins(400, 1.0, width, seed) - 4.0 if width else drawn(400, 1.0, seed)
        found = ss.studies.gutenberg_richter(magnitudes, 0.0, width, largest=largest, confidence=0.8, resamples=100, seed=seed)
        held += found.low <= 1.0 <= found.high
    # 160 of 200, and three standard deviations of their number
    assert held == pytest.approx(160, rel=0.0, abs=17)


def test_the_same_seed_gives_the_same_interval() -> None:
    magnitudes = drawn(500)
    one, same, other = (ss.studies.gutenberg_richter(magnitudes, 0.0, seed=seed) for seed in (3, 3, 4))
    assert (one.low, one.high, one.p_value) == (same.low, same.high, same.p_value)
    assert (one.low, one.high) != (other.low, other.high)


def test_completeness_is_found_where_events_begin_to_lack() -> None:
    rng, magnitudes = np.random.default_rng(2), drawn(200_000) - 2.0
    seen = magnitudes[rng.uniform(size=len(magnitudes)) < 1.0 / (1.0 + np.exp(-(magnitudes + 0.5) / 0.08))]
    for width, given in ((0.0, seen), (0.1, np.round(seen, 1))):
        found = ss.studies.gutenberg_richter(given, bin=width)
        assert found.told
        assert -0.5 < found.completeness < 0.0
        assert found.b == pytest.approx(1.0, rel=0.03, abs=0.0)
        assert found.p_value > 0.05
        assert ss.studies.gutenberg_richter(given, -1.0, width).b < 0.8


def test_completeness_does_not_depend_on_the_order_or_on_a_shift() -> None:
    magnitudes = np.sort(drawn(5_000))
    assert completeness_of(magnitudes + 3.0, 0.0) == pytest.approx(3.0 + completeness_of(magnitudes, 0.0), rel=1e-9, abs=0.0)
    shuffled = np.random.default_rng(5).permutation(magnitudes)
    assert ss.studies.gutenberg_richter(shuffled).b == ss.studies.gutenberg_richter(magnitudes).b


def test_a_law_that_does_not_fit_is_said() -> None:
    two = np.concatenate([drawn(3_000), np.random.default_rng(3).normal(3.0, 0.1, 600)])
    found = ss.studies.gutenberg_richter(two, 0.0)
    assert found.p_value < 0.01
    assert "the law does not fit" in str(found)
    small = ss.studies.gutenberg_richter(two, 0.0, largest=1.5)
    assert small.p_value > 0.05
    assert small.b == pytest.approx(1.0, rel=0.1, abs=0.0)


def test_few_rounded_and_large_events_are_said_in_words() -> None:
    assert "12 events are few" in str(ss.studies.gutenberg_richter(drawn(12), 0.0))
    rounded = ss.studies.gutenberg_richter(in_bins(1_000))
    assert "bin=0.1" in str(rounded)
    assert "bin=" not in str(ss.studies.gutenberg_richter(in_bins(1_000), bin=0.1))
    assert "above the largest magnitude 1" in str(ss.studies.gutenberg_richter(drawn(1_000), 0.0, largest=1.0))


def test_the_table_counts_all_events_and_shows_the_law_where_it_is() -> None:
    magnitudes = in_bins(10_000)
    found = ss.studies.gutenberg_richter(magnitudes, 4.2, 0.1, largest=5.0)
    table = found.table
    assert table.events.sum() == len(magnitudes)
    assert table.at_least.tolist() == [int((magnitudes > one - 0.05).sum()) for one in table.magnitude]
    inside = (table.magnitude > 4.15) & (table.magnitude < 5.15)
    assert table.expected[inside].notna().all()
    assert table.expected[~inside].isna().all()
    assert table.expected[inside].iloc[0] == pytest.approx(table.at_least[inside].iloc[0], rel=1e-12, abs=0.0)
    assert table.expected[inside].to_numpy() == pytest.approx(table.at_least[inside].to_numpy(), rel=0.05, abs=0.0)
    assert 10.0 ** (found.a - found.b * 4.15) == pytest.approx(found.events, rel=1e-12, abs=0.0)


def test_magnitudes_of_moments_and_of_a_run() -> None:
    moments = np.array([0.01, 1.0, -100.0])
    assert ss.studies.magnitudes(moments) == pytest.approx([math.log(0.01), 0.0, math.log(100.0)], rel=1e-15, abs=0.0)
    assert ss.studies.magnitudes(moments, "moment") == pytest.approx([-4.0 / 3.0, 0.0, 4.0 / 3.0], rel=1e-15, abs=0.0)
    run = SimpleNamespace(events={"moment": np.append(np.exp(drawn(1_000)), 0.0)})
    assert len(ss.studies.magnitudes(run)) == 1_000
    found = ss.studies.gutenberg_richter(run, 0.0)
    assert found.b == pytest.approx(ss.studies.gutenberg_richter(drawn(1_000), 0.0).b, rel=1e-12, abs=0.0)


REFUSED = [
    (([],), {}, "magnitudes must be the run of a chain or a list of numbers, got an array of shape (0,)"),
    (("4.0",), {}, "magnitudes must be the run of a chain or a list of numbers, got '4.0'"),
    ((None,), {}, "magnitudes must be the run of a chain or a list of numbers, got None"),
    ((np.zeros(3, [("time", float), ("moment", float)]),), {}, "got a table: give the run itself, or magnitudes"),
    ((pd.DataFrame({"moment": [1.0, 2.0]}),), {}, "got a table: give the run itself, or magnitudes"),
    (([1.0 + n * 3e-16 for n in range(10)],), {}, "all 10 events from magnitude 1 on have one magnitude"),
    (([1.0, 2.0, 2.0 + 4e-16, 2.0], 2.0), {}, "events from magnitude 2 on have one magnitude"),
    (([1.0, 2.0], 1.0, 1e-320), {}, "bin must be 0, for magnitudes that were not rounded, or 2e-09 or more, got 9.9"),
    (([[1.0, 2.0]],), {}, "got an array of shape (1, 2)"),
    (([1.0, math.nan],), {}, "magnitudes must be finite, and number 2 of 2 is nan"),
    (([1.0, 2.0], 3.0), {}, "needs two events, and there are none from magnitude 3 on (as given: give a smaller completeness)"),
    (([1.0, 2.0], 2.0), {}, "needs two events, and there is one from magnitude 2 on"),
    (([1.0, 2.0, 2.0], 2.0), {}, "all 2 events from magnitude 2 on have one magnitude"),
    (([1.0, 2.0], 1.0, -0.1), {}, "bin must be 0 or more, got -0.1"),
    (([1.0, 1.15, 2.0], 1.0, 0.1), {}, "magnitudes must lie 0.1 or multiples of it apart"),
    (([1.0, 2.0], 1.0), {"largest": 0.5}, "largest must be above completeness 1, got 0.5"),
    (([1.0, 2.0], 1.0), {"confidence": 95}, "confidence must lie between 0 and 1, such as 0.95, got 95"),
    (([1.0, 2.0], "low"), {}, "completeness must be a number, got 'low'"),
    (([1.0, 2.0], 1.0), {"seed": -1}, "seed must be a whole number"),
    (([1.0, 2.0], 1.0), {"resamples": 1}, "resamples must be a whole number from 20"),
]


@pytest.mark.parametrize(("given", "named", "message"), REFUSED)
def test_what_cannot_be_used_is_refused_in_one_line(given: Any, named: Any, message: str) -> None:
    with pytest.raises(ss.InputError) as error:
        ss.studies.gutenberg_richter(*given, **named)
    text = str(error.value)
    assert text.startswith("gutenberg_richter: ")
    assert message in text
    assert "\n" not in text


def test_moments_of_zero_and_unknown_scales_are_refused() -> None:
    with pytest.raises(ss.InputError, match="moments must not be 0, and that of event 2 of 2 is"):
        ss.studies.magnitudes([1.0, 0.0])
    with pytest.raises(ss.InputError, match="scale must be 'ln' or 'moment', got 'log10'"):
        ss.studies.magnitudes([1.0], "log10")  # type: ignore[arg-type]


@pytest.mark.parametrize(("scale", "got"), [(5, "5"), ([1], "[1]"), ("log", "'log'"), (None, "None")])
def test_scales_of_any_type_are_refused_in_one_line(scale: Any, got: str) -> None:
    with pytest.raises(ss.InputError) as error:
        ss.studies.magnitudes([1.0], scale)
    assert str(error.value) == f"magnitudes: scale must be 'ln' or 'moment', got {got}"


@pytest.mark.parametrize(("magnitudes", "completeness"), [([1, 2, 3.0], None), ([0, 1.0], 0.0), (drawn(9), 0.0)])
def test_the_law_is_not_said_to_fit_too_few_events(magnitudes: Any, completeness: float | None) -> None:
    found = ss.studies.gutenberg_richter(magnitudes, completeness)
    assert found.fit_text == f"{found.events} events are too few to judge whether the law fits"
    assert "the law fits" in ss.studies.gutenberg_richter(drawn(10), 0.0).fit_text


def test_equal_blocks_whose_events_differ_by_rounding_have_no_slope() -> None:
    chain = ss.Chain(ss.friction.Coulomb(1, 0.8), 3, 1.0, 1.0, 1.0, 1.0, 1e-3)
    with pytest.raises(ss.InputError, match=r"all 10 events from magnitude 0\.19017 on have one magnitude"):
        ss.studies.gutenberg_richter(ss.simulate(chain, 5000.0))
