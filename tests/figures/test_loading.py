"""The panel of a loading that varies: what is drawn there is what the driver does at these times."""

from __future__ import annotations

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot

import stickslip as ss
from stickslip.figures.runs.run import draw
from stickslip.loading import HoldAndSlide, LoadingHistory, PiecewiseLinear, Sinusoidal, Steps

mpl.use("Agg")

BLOCK = ss.SpringBlock(mass=2.8e12, stiffness=3.43e13, normal_force=1e14)
LAW = ss.friction.LinearSlipWeakening(0.6, 0.57, 0.02, memory="since-arrest")
HOUR = 3600.0
HISTORIES = {
    "ramps": PiecewiseLinear([2.0, 5.0, 7.0], [1e-3, 3e-3, -1e-3]),
    "steps": Steps([0.0, 4.0, 20.0], [1e-3, 0.0, 2e-3]),
    "holds": HoldAndSlide(1e-3, 3.0, [1.0, 2.0]),
    "tone": Sinusoidal(1e-3, 2e-3, period=3.0, phase=0.3),
}


@pytest.mark.parametrize("history", HISTORIES.values(), ids=HISTORIES)
@pytest.mark.parametrize("edges", [(None, None), (3.5, 4.5)])
def test_the_panel_shows_the_history(history: LoadingHistory, edges: tuple[float | None, float | None]) -> None:
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=history, initial_excess=-1e11), 9.0)
    figure = draw(run, *edges)
    panel = figure.axes[3]
    time, rate = panel.lines[0].get_xydata().T
    assert (time[0], time[-1]) == (edges[0] or 0.0, edges[1] or 9.0)
    limits = history.at(time), history.at(np.nextafter(time, -1.0))  # at a jump both
    assert (np.minimum(*(abs(1e-3 * rate - one) for one in limits)) < 1e-15).all()
    breaks = [one.start for one in history.segments[1:] if time[0] < one.start < time[-1]]
    assert {*breaks} <= {*time.tolist()}
    assert panel.get_ylabel() == "pull rate\n(mm/s)"
    assert panel.get_xlabel() == "time $t$ (s)"
    assert figure.axes[2].get_xlabel() == ""
    pyplot.close(figure)


def test_a_far_stress_is_drawn_in_its_unit() -> None:
    scenario = ss.load_scenario("stress-pulse-slab")
    figure = draw(ss.simulate(scenario))
    time, stress = figure.axes[3].lines[0].get_xydata().T
    assert figure.axes[3].get_ylabel() == "far stress\n(MPa)"
    assert dict(zip(time, stress, strict=True))[2.0] == pytest.approx(6.06, rel=1e-12)
    pyplot.close(figure)


def test_thousands_of_periods_are_a_band_and_a_window_shows_its_own() -> None:
    """Over years as wide as the tide swings; around an event the tide as it is then, in local time."""
    tide = Sinusoidal(1.1e-9, 2e-8, period=12.42 * HOUR)
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=tide, initial_excess=-1e10), 1000 * HOUR)
    figure = draw(run)
    corners = figure.axes[3].collections[0].get_paths()[0].vertices[:, 1]
    assert (corners.min(), corners.max()) == (pytest.approx(-18.9, rel=1e-12), pytest.approx(21.1, rel=1e-12))  # nm/s
    pyplot.close(figure)
    window = run.window(0, before=5 * HOUR, after=5 * HOUR)
    figure = draw(window)
    time, rate = figure.axes[3].lines[0].get_xydata().T
    begun = run.events.start[0]
    np.testing.assert_allclose(1e-9 * rate, tide.at(time + begun), rtol=0.0, atol=1e-12 * 2e-8)
    assert time[0] == pytest.approx(-5 * HOUR, rel=1e-12)
    assert len(figure.axes[3].collections) == 0
    pyplot.close(figure)


def test_a_steady_loading_has_no_panel() -> None:
    steady = ss.simulate(replace(ss.load_scenario("fig6-slab").problem), 7.0)
    figure = draw(steady)
    assert len(figure.axes) == 3
    assert figure.get_size_inches().tolist() == [6.4, 5.6]
    pyplot.close(figure)
