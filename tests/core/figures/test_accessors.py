"""`run.plot` draws every figure of a run, and of a window on it, with its axes named in units; energies; measured points."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.figures.runs import energy
from tests.core.figures.legible import BLOCK_PROBLEM, SLAB_PROBLEM, has_unit, labels
from tests.core.solution.observables.runs import RUNS, worst_imbalance
from tests.problems import Floats


def line(figure: Figure, panel: int, text: str) -> Floats:
    """Return the points of a line, shape (2, n), by the beginning of its name in the legend."""
    (found,) = (one for one in figure.axes[panel].lines if str(one.get_label()).startswith(text))
    return np.array(found.get_data())


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
    return run, energy.energy_data(run)


@pytest.mark.usefixtures("coarse")
@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", DRAWN)
def test_areas_stack_up_to_the_total(name: str) -> None:
    """What is drawn, to 1e-9 of the total; no part is negative, none is hidden."""
    (run, dataset), parts = drawn(name), DRAWN[name][2]
    axes = energy.draw_energy(dataset).axes[0]
    (line,) = axes.lines
    time, total = (np.asarray(values, float) for values in (line.get_xdata(), line.get_ydata()))
    x, y = np.asarray(axes.collections[-1].get_paths()[0].vertices).T
    places, place = np.unique(x, return_inverse=True)
    highest = np.full(len(places), -np.inf)
    np.maximum.at(highest, place, y)
    assert np.isin(time, places).all()
    top = highest[np.searchsorted(places, time)]
    assert top == pytest.approx(total, rel=0.0, abs=1e-9 * total.max())
    assert [
        name
        for name in energy.PARTS_OF_ENERGY
        if energy.PARTS_OF_ENERGY[name][0] in [area.get_label() for area in axes.collections]
    ] == parts
    assert all((dataset[part] >= -1e-12 * dataset.total.max()).all() for part in parts)
    assert worst_imbalance(run) < 1e-9


@pytest.mark.slow
@pytest.mark.usefixtures("coarse")
def test_the_parts_miss_the_total_if_one_is_left_out() -> None:
    _, dataset = drawn("slab, lossy")
    without = sum(dataset[part] for part in energy.PARTS_OF_ENERGY if part != "radiated")
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
    (axes,) = energy.draw_energy(energy.energy_data(rest)).axes
    assert not axes.collections
    assert not axes.lines[0].get_ydata().any()


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
