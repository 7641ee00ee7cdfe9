"""`run.plot` draws every figure of a run, and of a window on it, with its axes named in units."""

from __future__ import annotations

from functools import cache

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot

import stickslip as ss
from stickslip.figures.studies import schemes as figure
from tests.figures.labels import has_unit, labels
from tests.figures.problems import BLOCK_PROBLEM, SLAB_PROBLEM

NAMES = ["characteristics", "theta", "backward-euler", "newmark", "hht"]


def test_the_figure_has_errors_of_all_schemes_and_curves_of_four() -> None:
    study = ss.studies.schemes("fig4-loop", scheme=NAMES, cells=[20, 40])
    dataset = figure.data(study)
    drawn = figure.draw(dataset)
    errors, slip, rate = drawn.axes
    assert [len(line.get_xdata()) for line in errors.lines] == [2] * 5
    assert dataset.attrs["runs"] == [f"{name}, 40 cells" for name in NAMES[:4]]
    assert len(dataset.attrs["rules"]) == len(study.paths.groups()) == 4
    assert [len(panel.lines) for panel in (slip, rate)] == [9, 9]  # four schemes, four rules, zero
    assert dataset.scheme0_error.values.tolist() == study.table.slip_error[:2].tolist()


mpl.use("Agg")


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
        pyplot.close(figure)


def test_only_the_interval_that_is_asked_for_is_drawn() -> None:
    figure = run().plot.slip(1.0, 3.0)
    time, slip = figure.axes[0].lines[0].get_data()
    assert (time[0], time[-1]) == (1.0, 3.0)
    np.testing.assert_array_equal(slip, run().slip(time))
    pyplot.close(figure)


def test_the_state_of_a_law_is_drawn_in_its_unit() -> None:
    scenario = ss.load_scenario("rate-and-state-block")
    law = scenario.problem.friction
    figure = ss.simulate(scenario.problem, 1e-3 * scenario.duration).plot.state()
    (state,) = law.states
    assert figure.axes[0].get_ylabel() == f"state ({state.unit})"
    pyplot.close(figure)


def test_a_law_without_a_state_has_none_to_draw() -> None:
    with pytest.raises(ss.InputError, match="curve: unknown quantity 'state'"):
        run().plot.state()


def test_the_default_figure_is_that_of_the_run() -> None:
    for shown in (run(), run().window(0), ss.simulate(BLOCK_PROBLEM, 2.0)):
        figure = shown.plot()
        assert len(figure.axes) == 3
        pyplot.close(figure)


def test_catalogue_and_path_belong_to_whole_runs() -> None:
    assert run().plot.catalogue().axes
    assert run().plot.path().axes
    assert not hasattr(run().window(0).plot, "catalogue")
