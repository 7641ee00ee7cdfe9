"""Figures of points and of the law that follows them, with their axes named in units."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.extensions.inference.figures import measured as figure_of
from stickslip.figures import plot_fit
from tests.problems import RATE_LAW, Floats, measured

pytestmark = pytest.mark.usefixtures("closed_figures")

RESULTS = ("rate", "slip", "smooth", "monotone")


FITS = RESULTS[:2]


@cache
def result_of(name: str) -> Any:
    """Return a fit, or a smoothed law."""
    if name == "slip":
        small = measured(ss.friction.ExponentialSlipWeakening(0.6, 0.4, 4e-4), np.linspace(0.0, 2e-3, 90), None, 0.01)
        return ss.friction.fit(small, "exponential-slip-weakening")
    if name == "smooth":
        rates = np.append(0.0, np.geomspace(1e-6, 1e-2, 60))
        return ss.friction.smooth(measured(ss.friction.VelocityStrengthening(0.6, 0.01, 1e-5), None, rates, 0.005))
    linear = measured(RATE_LAW, None, np.linspace(0.0, 10.0, 300), 0.01)
    return ss.friction.fit(linear, "hyperbolic-rate") if name == "rate" else ss.friction.smooth(linear, monotone=True)


def line(figure: Figure, panel: int, text: str) -> Floats:
    """Return the points of a line, shape (2, n), by the beginning of its name in the legend."""
    (found,) = (one for one in figure.axes[panel].lines if str(one.get_label()).startswith(text))
    return np.array(found.get_data())


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", RESULTS)
def test_points_and_law_are_those_of_the_result_in_the_unit_of_the_axis(name: str) -> None:
    result, figure = result_of(name), plot_fit(result_of(name))
    size = {"m/s": 1.0, "mm/s": 1e-3, "mm": 1e-3}[figure.axes[1].get_xlabel().rpartition("(")[2][:-1]]
    place, friction = line(figure, 0, "measured")
    np.testing.assert_allclose(place * size, result.points.places, rtol=1e-12)
    np.testing.assert_array_equal(friction, result.points.friction)
    along, law = line(figure, 0, "smoothed" if name in ("smooth", "monotone") else result.law.kind)
    mu = result.law.coefficient(*((along * size, 0.0) if name == "slip" else (0.0, along * size)))
    np.testing.assert_allclose(law, mu, rtol=1e-9)
    assert along.min() * size == pytest.approx(result.points.places.min())
    assert along.max() * size == pytest.approx(result.points.places.max())


@pytest.mark.parametrize("name", RESULTS)
def test_the_lower_panel_shows_the_differences_and_the_residual(name: str) -> None:
    result, figure = result_of(name), plot_fit(result_of(name))
    points, *_ = figure.axes[1].lines
    expected = result.points.friction - result.law.coefficient(*result.points.variables)
    np.testing.assert_allclose(points.get_ydata(), expected, rtol=0, atol=1e-12)
    levels = {float(one.get_ydata()[0]) for one in figure.axes[1].lines if one.get_linestyle() == "--"}  # type: ignore[index]
    assert levels == {-result.residual, result.residual}


@pytest.mark.parametrize("name", FITS)
def test_bands_are_one_and_two_standard_errors(name: str) -> None:
    result, dataset = result_of(name), figure_of.measured_data(result_of(name))
    along = dataset["along"].values
    mu, error = result.band(*((along, 0.0) if name == "slip" else (0.0, along)))
    figure = figure_of.draw_measured(dataset)
    heights = []
    for band in figure.axes[0].collections:
        ends = band.get_paths()[0].vertices
        heights.append(float(np.ptp(ends[np.isclose(ends[:, 0], ends[:, 0].min(), rtol=1e-6, atol=1e-12), 1])))
    np.testing.assert_allclose(sorted(heights), [2.0 * error[0], 4.0 * error[0]], rtol=1e-3)
    np.testing.assert_allclose(dataset["law"].values, mu)


@pytest.mark.parametrize("name", RESULTS)
def test_the_legend_explains_every_element(name: str) -> None:
    legend = plot_fit(result_of(name)).axes[0].get_legend()
    assert legend is not None
    texts = [text.get_text() for text in legend.get_texts()]
    for part in (
        "measured, ",
        "law" if name in ("rate", "slip") else "smoothed",
        *(("± 1 standard error", "± 2 standard errors") if name in FITS else ()),
        "± residual",
    ):
        assert sum(part in text for text in texts) >= 1, part


def test_decades_are_drawn_by_factors_with_zero_in_view() -> None:
    axes = plot_fit(result_of("smooth")).axes[1]
    assert axes.get_xscale() == "symlog"
    assert -1e-3 < axes.get_xlim()[0] < 0.0
    assert plot_fit(result_of("rate")).axes[1].get_xscale() == "linear"


def test_a_law_of_both_is_drawn_against_measured_friction() -> None:
    rng = np.random.default_rng(0)
    law = ss.friction.SlipPlusRate(ss.friction.ExponentialSlipWeakening(0.4, 0.2, 0.2), ss.friction.HyperbolicRate(0.3, 0.2, 5.0))
    points = measured(law, rng.uniform(0, 1, 200), rng.uniform(0, 2, 200), 0.002)
    figure = plot_fit(ss.friction.fit(points, law, fixed={"rate.dynamic": 0.2}))
    assert figure.axes[1].get_xlabel() == "friction coefficient of the law"
    low, high = line(figure, 0, "line of equality")
    np.testing.assert_array_equal(low, high)
    assert not figure.axes[0].collections


def test_a_figure_is_saved_whole(tmp_path: Path) -> None:
    plot_fit(result_of("rate"), tmp_path / "fit.svg")
    assert (tmp_path / "fit.svg").stat().st_size > 5000


def test_what_is_no_fit_is_refused_in_one_line() -> None:
    with pytest.raises(ss.InputError, match="plot_fit: result must come from fit or smooth, got HyperbolicRate"):
        plot_fit(RATE_LAW)  # type: ignore[arg-type]
