"""`run.plot` draws every figure of a run, and of a window on it, with its axes named in units; energies; measured points."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.extensions.inference.figures import measured as figure_of
from stickslip.extensions.schemes import figure
from stickslip.figures import plot_fit
from stickslip.figures.runs import energy
from tests.core.figures.legible import BLOCK_PROBLEM, SLAB_PROBLEM, has_unit, labels
from tests.core.solution.observables.runs import RUNS, worst_imbalance
from tests.problems import RATE_LAW, Floats, measured

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
    result, dataset = result_of(name), figure_of.data(result_of(name))
    along = dataset["along"].values
    mu, error = result.band(*((along, 0.0) if name == "slip" else (0.0, along)))
    figure = figure_of.draw(dataset)
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


DRAWN = {
    "slab": (SLAB_PROBLEM, 12.0, ["elastic", "kinetic", "heat"]),
    "slab, pulses": (*RUNS["slab, slip law"], ["elastic", "kinetic", "heat"]),
    "slab, lossy": (*RUNS["slab, lossy"], ["elastic", "kinetic", "radiated", "heat"]),
    "block": (BLOCK_PROBLEM, 5.0, ["elastic", "kinetic", "heat"]),
    "block, damped": (RUNS["block, damped"][0], 3.0, ["elastic", "kinetic", "damped", "heat"]),
}


@cache
def drawn(name: str) -> tuple[ss.Solution, xr.Dataset]:
    """Return a run and the numbers that its figure shows."""
    problem, duration, _ = DRAWN[name]
    run = ss.simulate(problem, duration, rtol=1e-12)
    return run, energy.data(run)


@pytest.mark.usefixtures("coarse")
@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", DRAWN)
def test_areas_stack_up_to_the_total(name: str) -> None:
    """What is drawn, to 1e-9 of the total; no part is negative, none is hidden."""
    (run, dataset), parts = drawn(name), DRAWN[name][2]
    axes = energy.draw(dataset).axes[0]
    (line,) = axes.lines
    time, total = (np.asarray(values, float) for values in (line.get_xdata(), line.get_ydata()))
    x, y = np.asarray(axes.collections[-1].get_paths()[0].vertices).T
    places, place = np.unique(x, return_inverse=True)
    highest = np.full(len(places), -np.inf)
    np.maximum.at(highest, place, y)
    assert np.isin(time, places).all()
    top = highest[np.searchsorted(places, time)]
    assert top == pytest.approx(total, rel=0.0, abs=1e-9 * total.max())
    assert [name for name in energy.PARTS if energy.PARTS[name][0] in [area.get_label() for area in axes.collections]] == parts
    assert all((dataset[part] >= -1e-12 * dataset.total.max()).all() for part in parts)
    assert worst_imbalance(run) < 1e-9


@pytest.mark.slow
@pytest.mark.usefixtures("coarse")
def test_the_parts_miss_the_total_if_one_is_left_out() -> None:
    _, dataset = drawn("slab, lossy")
    without = sum(dataset[part] for part in energy.PARTS if part != "radiated")
    assert float(abs(without - dataset.total).max() / dataset.total.max()) > 0.1


@pytest.mark.usefixtures("coarse")
def test_a_long_run_is_shown_around_its_event_with_units() -> None:
    run = ss.simulate(SLAB_PROBLEM, 480 * ss.YEAR)
    axes = run.plot.energy().axes[0]
    assert axes.get_ylabel() == "energy (MJ/m²)"
    assert axes.get_xlabel() == "time since the event began (s)"
    assert axes.get_xlim()[0] < 0.0 < axes.get_xlim()[1] < 20.0
    block = ss.simulate(BLOCK_PROBLEM, 5.0).plot.energy(0.0, 3.0).axes[0]
    assert block.get_ylabel().endswith("J)")
    assert block.get_xlim() == (0.0, 3.0)
    with pytest.raises(ss.InputError, match="must end after"):
        run.plot.energy(3.0, 3.0)


def test_a_block_at_rest_can_be_drawn() -> None:
    """All its energies are zero: there is nothing to stack."""
    rest = ss.simulate(ss.Problem(BLOCK_PROBLEM.body, BLOCK_PROBLEM.friction, pull_rate=0.0, initial_excess=-1e6), 10.0)
    (axes,) = energy.draw(energy.data(rest)).axes
    assert not axes.collections
    assert not axes.lines[0].get_ydata().any()


NAMES = ["characteristics", "theta", "backward-euler", "newmark", "hht"]


def test_the_figure_has_errors_of_all_schemes_and_curves_of_four() -> None:
    study = ss.studies.schemes("fig4-loop", scheme=NAMES, cells=[20, 40])
    drawn = study.plot()
    errors, slip, rate = drawn.axes
    assert [len(line.get_xdata()) for line in errors.lines] == [2] * 5
    texts = [one.text for one in figure.curves(study)]
    assert texts[:4] == [f"{name}, 40 cells" for name in NAMES[:4]]
    assert len(texts) - 4 == len(study.paths.groups()) == 4
    assert texts[-1].startswith(f"exact, {study.problem.rule}")
    assert [len(panel.lines) for panel in (slip, rate)] == [9, 9]  # four schemes, four rules, zero
    factor = study.table.slip_error[0] / errors.lines[0].get_ydata()[0]
    assert (factor * errors.lines[0].get_ydata()).tolist() == pytest.approx(study.table.slip_error[:2].tolist(), rel=1e-12, abs=0.0)


@cache
def run() -> ss.Solution:
    return ss.simulate(SLAB_PROBLEM, 7.0)


@pytest.mark.parametrize("name", ["slip", "slip_rate", "traction", "load"])
def test_one_quantity_is_drawn_in_one_panel(name: str) -> None:
    for shown, first in ((run(), "t"), (run().window(0), "event began")):
        figure = getattr(shown.plot, name)()
        (axes,) = figure.axes
        assert all(has_unit(text) for text in labels(figure))
        assert first in axes.get_xlabel()
        assert np.isfinite(axes.lines[0].get_ydata()).all()


def test_only_the_interval_that_is_asked_for_is_drawn() -> None:
    figure = run().plot.slip(1.0, 3.0)
    time, slip = figure.axes[0].lines[0].get_data()
    assert (time[0], time[-1]) == (1.0, 3.0)
    np.testing.assert_array_equal(slip, run().slip(time))


def test_the_state_of_a_law_is_drawn_in_its_unit() -> None:
    scenario = ss.load_scenario("rate-and-state-block")
    law = scenario.problem.friction
    figure = ss.simulate(scenario.problem, 1e-3 * scenario.duration).plot.state()
    (state,) = law.states
    assert figure.axes[0].get_ylabel() == f"state ({state.unit})"


def test_a_law_without_a_state_has_none_to_draw() -> None:
    with pytest.raises(ss.InputError, match="curve: unknown quantity 'state'"):
        run().plot.state()


def test_the_default_figure_is_that_of_the_run() -> None:
    for shown in (run(), run().window(0), ss.simulate(BLOCK_PROBLEM, 2.0)):
        figure = shown.plot()
        assert len(figure.axes) == 3


def test_catalogue_and_path_belong_to_whole_runs() -> None:
    assert run().plot.catalogue().axes
    assert run().plot.path().axes
    assert not hasattr(run().window(0).plot, "catalogue")
