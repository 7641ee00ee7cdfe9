"""Fits of laws to measured points: known parameters come back, uncertainties hold, and what is not determined is said."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.optimize import curve_fit
from scipy.stats import binom

import stickslip as ss
from stickslip.extensions.inference.determined import misses_trend
from stickslip.extensions.inference.points.fit import Fit
from stickslip.extensions.inference.points.fit_search import leaves, rebuilt, slopes, template
from stickslip.foundation.show import with_uncertainty
from stickslip.friction import LAWS, FromExpression, Points, fit, fit_each
from tests.messages import refused
from tests.problems import RATE_LAW, measured

F = ss.friction
SLIPS, RATES = np.linspace(0.0, 1.0, 80), np.linspace(0.0, 3.0, 80)
TRUE: dict[str, F.FrictionLaw] = {
    "sinusoidal-slip": F.SinusoidalSlip(0.6, 0.2, 17.0),
    "hyperbolic-rate": F.HyperbolicRate(0.8, 0.3, 1.7),
    "linear-slip-weakening": F.LinearSlipWeakening(0.7, 0.4, 0.37),
    "exponential-slip-weakening": F.ExponentialSlipWeakening(0.7, 0.4, 0.21),
    "power-slip-weakening": F.PowerSlipWeakening(0.7, 0.2, 0.13, 0.8),
    "parabolic-slip-weakening": F.ParabolicSlipWeakening(0.7, 0.4, 0.45, 0.13),
    "exponential-cohesive-zone": F.ExponentialCohesiveZone(0.7, 0.4, 0.23, 0.11),
    "exponential-stribeck": F.ExponentialStribeck(0.7, 0.4, 0.45, 2, 0.013),
    "power-stribeck": F.PowerStribeck(0.7, 0.4, 0.6, 3, 0.011),
    "velocity-strengthening": F.VelocityStrengthening(0.6, 0.02, 0.08, 0.005),
}
"""A law of each kind whose parameters all follow from points."""


def points_of(law: F.FrictionLaw, noise: float = 0.0, seed: int = 0) -> Points:
    return measured(law, SLIPS if law.depends_on_slip else None, None if law.depends_on_slip else RATES, noise, seed)


def test_every_law_with_parameters_and_without_a_state_is_tried() -> None:
    fitted = set()
    for kind in LAWS:
        try:
            template(kind)
            fitted.add(kind)
        except ss.InputError:
            continue
    assert fitted == {*TRUE, "coulomb", "carlson-langer"}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", TRUE)
def test_exact_points_give_the_parameters_back(kind: str) -> None:
    """Absolute and relative tolerance 1e-8; the residual is rounding."""
    law = TRUE[kind]
    found = fit(points_of(law), kind)
    for name, leaf in leaves(law).items():
        assert found.values[name] == pytest.approx(leaf.value, rel=1e-8, abs=1e-10), name
    assert found.residual < 1e-12
    assert found.law == rebuilt(law, found.values)
    assert found.notes == []


@pytest.mark.parametrize("kind", TRUE)
def test_slopes_are_those_of_central_differences(kind: str) -> None:
    """Away from knots, to 1e-6 of the largest slope."""
    law = TRUE[kind]
    names = [name for name, leaf in leaves(law).items() if not leaf.declared.whole]
    u, v = (SLIPS + 0.00123, np.zeros(80)) if law.depends_on_slip else (np.zeros(80), RATES + 0.00123)
    found = slopes(law, names, u, v)
    for i, name in enumerate(names):
        value = leaves(law)[name].value
        step = 1e-5 * value
        high, low = (rebuilt(law, {name: one}).coefficient(u, v) for one in (value + step, value - step))
        np.testing.assert_allclose(found[:, i], (high - low) / (2 * step), rtol=0, atol=1e-6 * np.abs(found[:, i]).max())


def _formulas() -> dict[str, Any]:
    """Return formulas written anew, with starts, for scipy's own fit."""
    return {
        "hyperbolic-rate": (lambda v, s, d, a: d + (s - d) / (1 + a * v), (0.9, 0.2, 1.0)),
        "exponential-slip-weakening": (lambda u, s, d, w: d + (s - d) * np.exp(-u / w), (0.9, 0.2, 0.3)),
        "velocity-strengthening": (lambda v, s, a, r, c: s + a * np.log(1 + v / r) + c * v, (0.6, 0.02, 0.1, 0.01)),
        "sinusoidal-slip": (lambda u, m, a, k: m + a * np.sin(k * u), (0.6, 0.2, 16.5)),
    }


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", _formulas())
@pytest.mark.parametrize("seed", range(3))
def test_parameters_and_uncertainties_are_those_of_scipys_curve_fit(kind: str, seed: int) -> None:
    """Values to 1e-4 of their uncertainty, uncertainties and correlations to 1e-3."""
    points = points_of(TRUE[kind], 0.002, seed)
    formula, start = _formulas()[kind]
    wanted, covariance = curve_fit(formula, points.places, points.friction, start, xtol=1e-14, ftol=1e-14)
    found, sizes = fit(points, kind), np.sqrt(np.diag(covariance))
    assert np.abs(np.array(list(found.values.values())) - wanted).max() < 1e-4 * sizes.max() or np.allclose(
        list(found.values.values()), wanted, rtol=1e-6
    )
    np.testing.assert_allclose(list(found.uncertainty.values()), sizes, rtol=1e-3)
    np.testing.assert_allclose(found.correlation, covariance / np.outer(sizes, sizes), rtol=0, atol=1e-3)


DRAWS = 60


@cache
def many_fits(kind: str) -> list[Fit]:
    """Fits of a law to points with noise, drawn many times; whole numbers are known."""
    fixed = {name: leaf.value for name, leaf in leaves(TRUE[kind]).items() if leaf.declared.whole}
    return [fit(points_of(TRUE[kind], 0.005, seed), kind, fixed=fixed) for seed in range(DRAWS)]


@pytest.mark.slow
@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("kind", ["hyperbolic-rate", "linear-slip-weakening", "exponential-stribeck", "sinusoidal-slip"])
def test_intervals_of_one_uncertainty_hold_the_truth_as_often_as_they_should(kind: str) -> None:
    """Nominal 0.683 of all draws; the count of 60 lies within what the binomial distribution gives in all but 1e-5 of cases."""
    true = {name: leaf.value for name, leaf in leaves(TRUE[kind]).items() if not leaf.declared.whole}
    low, high = binom.ppf([0.5e-5, 1 - 0.5e-5], DRAWS, 0.683)
    for name, value in true.items():
        inside = sum(abs(found.values[name] - value) < found.uncertainty[name] for found in many_fits(kind))
        assert low <= inside <= high, (name, inside)


@pytest.mark.slow
def test_the_band_is_the_spread_of_many_fits() -> None:
    """The standard error along the law agrees with the scatter of 60 fits to 40 % (its own error: 9 %)."""
    curves, errors = zip(*(found.band(v=RATES) for found in many_fits("hyperbolic-rate")), strict=True)
    np.testing.assert_allclose(np.mean(errors, axis=0), np.std(curves, axis=0), rtol=0.4)


def test_the_right_law_has_the_smallest_bic() -> None:
    for kind in ("velocity-strengthening",):
        found = fit_each(points_of(TRUE[kind], 0.003))
        assert found[0].law.kind == kind
        assert [one.bic for one in found] == sorted(one.bic for one in found)


def test_a_law_that_misses_a_trend_is_told_apart_from_the_right_one() -> None:
    points = measured(RATE_LAW, None, np.linspace(0.0, 10.0, 500), 0.01)
    assert any("misses a trend" in note for note in fit(points, "exponential-stribeck").notes)
    assert fit(points, "hyperbolic-rate").notes == []


def test_white_noise_has_no_trend() -> None:
    """Of 2000 draws none is taken for a trend, and a slow wave of the noise's own size always is."""
    rng = np.random.default_rng(0)
    wave = 2.0 * np.sin(np.linspace(0.0, 12.0, 200))
    noise = rng.standard_normal((2000, 200))
    assert not any(map(misses_trend, noise))
    assert all(misses_trend(one + wave) for one in noise[:200])


def test_a_parameter_without_effect_is_not_determined() -> None:
    found = fit(measured(F.Coulomb(0.7, 0.5), None, RATES, 0.01), "coulomb")
    assert found.uncertainty["static"] == np.inf
    assert "the points do not determine static: any value fits alike; choose it and fix it" in found.notes
    assert "(not determined)" in repr(found)
    known = fit(measured(F.Coulomb(0.7, 0.5), None, RATES, 0.01), "coulomb", fixed={"static": 0.7})
    assert known.notes == []
    assert known.law.static == 0.7  # type: ignore[attr-defined]
    assert known.uncertainty["dynamic"] == pytest.approx(0.01 / np.sqrt(80), rel=0.3)


def test_parameters_that_act_as_one_are_not_determined_separately() -> None:
    rng = np.random.default_rng(0)
    law = F.SlipPlusRate(F.ExponentialSlipWeakening(0.4, 0.2, 0.2), F.HyperbolicRate(0.3, 0.2, 5.0))
    points = measured(law, rng.uniform(0, 1, 300), rng.uniform(0, 2, 300), 0.002)
    found = fit(points, "hyperbolic-rate + exponential-slip-weakening")
    (note,) = (note for note in found.notes if "separately" in note)
    assert {"slip.static", "slip.dynamic", "rate.static", "rate.dynamic"} == {one for one in found.uncertainty if one in note}
    assert np.isfinite(found.uncertainty["rate.alpha"])
    fixed = fit(points, law, fixed={"rate.dynamic": 0.2})
    assert fixed.notes == []
    for name, size in fixed.uncertainty.items():
        assert abs(fixed.values[name] - leaves(law)[name].value) < 4.5 * size, name


def test_a_parameter_at_its_limit_is_there_exactly() -> None:
    found = fit(measured(replace(RATE_LAW, alpha=0.7), None, RATES, 0.01, 1), "exponential-stribeck", fixed={"exponent": 1})
    rising = fit(points_of(F.VelocityStrengthening(0.6, 0.02, 0.08, 0.0), 0.002, 3), "velocity-strengthening")
    for one in (found, rising):
        at_limit = [name for name, value in one.values.items() if value == 0.0]
        assert all(any(note.startswith(f"{name} is at its limit, 0") for note in one.notes) for name in at_limit)
        assert not set(at_limit) & set(one.uncertainty)


def test_an_expression_is_fitted_with_its_own_names_and_units() -> None:
    points = measured(F.ExponentialSlipWeakening(0.7, 0.4, 0.21), SLIPS, None, 0.003)
    wanted = fit(points, "exponential-slip-weakening")
    law = FromExpression("low + drop*exp(-u/d)", {"low": 0.1, "drop": 0.1, "d": "3 cm"}, counts="path")
    found = fit(points, law)
    assert found.values["d"] == pytest.approx(wanted.values["distance"], rel=1e-6)
    assert found.values["drop"] == pytest.approx(wanted.values["static"] - wanted.values["dynamic"], rel=1e-6)
    assert found.uncertainty["d"] == pytest.approx(wanted.uncertainty["distance"], rel=1e-5)
    assert found.law.coefficient(0.3) == pytest.approx(wanted.law.coefficient(0.3), rel=1e-7)


def test_a_start_at_which_the_formula_overflows_is_refused_in_one_line() -> None:
    law = FromExpression("low + drop * exp(u/d)", {"low": 0.1, "drop": 0.1, "d": "1 m"}, counts="path")
    with pytest.raises(ss.InputError, match="fit: expression is not a finite number where the search begins: give other values"):
        fit(points_of(TRUE["linear-slip-weakening"]), law, start={"d": 1e-9})


def test_a_law_uses_only_the_variable_it_depends_on() -> None:
    rng = np.random.default_rng(0)
    both = measured(RATE_LAW, rng.uniform(0, 1, 80), RATES, 0.01)
    alone = fit(both.along("slip_rate"), "hyperbolic-rate")
    assert fit(both, "hyperbolic-rate").values == alone.values
    assert fit(both, "hyperbolic-rate").points.has == ("slip_rate",)


def test_starts_and_fixed_values_have_units_and_order_does_not_matter() -> None:
    points = points_of(TRUE["hyperbolic-rate"], 0.003)
    order = np.random.default_rng(0).permutation(80)
    shuffled = Points(points.friction[order], None, points.places[order])
    one, other = fit(points, "hyperbolic-rate"), fit(shuffled, "hyperbolic-rate", start={"alpha": "0.002 s/mm"})
    assert list(one.values.values()) == pytest.approx(list(other.values.values()), rel=1e-8)
    held = fit(points, F.HyperbolicRate, fixed={"alpha": "1.7 s/m"})
    assert held.values["alpha"] == 1.7
    assert "alpha" not in held.uncertainty
    assert "1.7" in repr(held)
    assert "(fixed)" in repr(held)


def test_a_fit_is_shown_as_text_and_html() -> None:
    found = fit(measured(RATE_LAW, None, np.linspace(0.0, 10.0, 500), 0.01), "hyperbolic-rate")
    lines = repr(found).splitlines()
    assert lines[0] == "hyperbolic-rate fitted to 500 points along slip_rate"
    assert lines[1].split() == ["static", "0.7989", "±", "0.0033"]
    assert lines[3].split() == ["alpha", "0.985", "±", "0.020", "s/m"]
    assert "0.985 ± 0.020</td>" in found._repr_html_()


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (1.23456, 0.0123, "1.235 ± 0.012"),
        (0.000383, 1.8e-5, "0.000383 ± 0.000018"),
        (12345.6, 123.0, "12346 ± 123"),
        (3.2e-9, 4.1e-11, "3.200e-09 ± 4.1e-11"),
        (2.5e9, 1e7, "2.500e+09 ± 1.0e+07"),
        (0.8, 0.0, "0.8 ± 0"),
        (0.8, None, "0.8"),
        (0.8, float("inf"), "0.8"),
        (0.01, 5.0, "0.0 ± 5.0"),
    ],
)
def test_values_have_the_digits_that_their_uncertainty_leaves(value: float, uncertainty: float | None, text: str) -> None:
    assert with_uncertainty(value, uncertainty) == text


BAD: list[tuple[Any, dict[str, Any], str]] = [
    ("hyperbolic", {}, "law 'hyperbolic' is unknown; did you mean 'hyperbolic-rate'?"),
    (3, {}, "law must be a friction law or the name of one, got 3"),
    (ss.SpringBlock, {}, "law must be a friction law or the name of one"),
    ("rate-and-state", {}, "rate-and-state has a state, which points do not show"),
    ("lagged", {}, "lagged has a state"),
    ("table", {}, "table is given by points: use smooth, or FromTable"),
    (F.PiecewiseLinearRate((0, 1), (0.5, 0.4)), {}, "piecewise-linear-rate has no parameters to be fitted: use smooth"),
    ("expression", {}, "expression has parameters of your own: give the law itself"),
    ("sum", {}, "sum is made of laws: give it with its parts, or join two names by + or *"),
    ("coulomb + coulomb", {}, "slip must be a law of slip only"),
    ("linear-slip-weakening", {}, "linear-slip-weakening depends on slip, but the points have slip_rate only"),
    ("hyperbolic-rate", {"fixed": {"alfa": 1}}, "fixed 'alfa' is no parameter of this law; did you mean 'alpha'?"),
    ("hyperbolic-rate", {"fixed": {"alpha": -1}}, "alpha must be at least 0 s/m, got -1"),
    ("hyperbolic-rate", {"start": {"alpha": "1 kg"}}, "got '1 kg': 'kg' does not convert"),
    ("hyperbolic-rate", {"start": {"alpha": "fast"}}, "start alpha must be a number in s/m or a text with a unit such as"),
    ("hyperbolic-rate", {"fixed": 3}, "fixed must be a mapping of names to values, got 3"),
    ("coulomb", {"fixed": {"static": 0.1}}, "the points give no coulomb: static must be at least dynamic"),
    ("coulomb", {"fixed": {"static": 0.6, "dynamic": 0.5}}, "every parameter is fixed: there is nothing to fit"),
    ("power-stribeck", {}, "5 points cannot determine 5 parameters of power-stribeck"),
]


@pytest.mark.parametrize(("law", "arguments", "message"), BAD)
def test_what_cannot_be_fitted_is_refused_in_one_line(law: Any, arguments: dict[str, Any], message: str) -> None:
    few = Points(np.array([0.7, 0.6, 0.5, 0.45, 0.42]), None, np.arange(5.0))
    with refused(message):
        fit(few, law, **arguments)
