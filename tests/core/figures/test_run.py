"""The default figure of a run shows what happens, on axes that are set by what happens."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.figures.runs.packed import PEAKS, RANGE
from stickslip.figures.runs.run import draw_run
from stickslip.problem.loading import HoldAndSlide, LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from tests.core.figures.legible import size_of

BLOCK = ss.SpringBlock(mass=2.8e12, stiffness=3.43e13, normal_force=1e14)
LAW = ss.friction.LinearSlipWeakening(0.6, 0.57, 0.02, memory="since-arrest")
HOUR = 3600.0
HISTORIES = {
    "ramps": PiecewiseLinear([2.0, 5.0, 7.0], [1e-3, 3e-3, -1e-3]),
    "steps": Steps([0.0, 4.0, 20.0], [1e-3, 0.0, 2e-3]),
    "holds": HoldAndSlide(1e-3, 3.0, [1.0, 2.0]),
    "tone": Sinusoidal(1e-3, 2e-3, period=3.0, phase=0.3),
}


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("history", HISTORIES.values(), ids=HISTORIES)
@pytest.mark.parametrize("edges", [(None, None), (3.5, 4.5)])
def test_the_panel_shows_the_history(history: LoadingHistory, edges: tuple[float | None, float | None]) -> None:
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=history, initial_excess=-1e11), 9.0)
    figure = draw_run(run, *edges)
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


def test_a_far_stress_is_drawn_in_its_unit() -> None:
    scenario = ss.load_scenario("stress-pulse-slab")
    figure = draw_run(ss.simulate(scenario))
    time, stress = figure.axes[3].lines[0].get_xydata().T
    assert figure.axes[3].get_ylabel() == "far stress\n(MPa)"
    assert dict(zip(time, stress, strict=True))[2.0] == pytest.approx(6.06, rel=1e-12)


def test_thousands_of_periods_are_a_band_and_a_window_shows_its_own() -> None:
    """Over years as wide as the tide swings; around an event the tide as it is then, in local time."""
    tide = Sinusoidal(1.1e-9, 2e-8, period=12.42 * HOUR)
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=tide, initial_excess=-1e10), 1000 * HOUR)
    figure = draw_run(run)
    corners = figure.axes[3].collections[0].get_paths()[0].vertices[:, 1]
    assert (corners.min(), corners.max()) == (pytest.approx(-18.9, rel=1e-12), pytest.approx(21.1, rel=1e-12))  # nm/s
    window = run.window(0, before=5 * HOUR, after=5 * HOUR)
    figure = draw_run(window)
    time, rate = figure.axes[3].lines[0].get_xydata().T
    begun = run.events.start[0]
    np.testing.assert_allclose(1e-9 * rate, tide.at(time + begun), rtol=0.0, atol=1e-12 * 2e-8)
    assert time[0] == pytest.approx(-5 * HOUR, rel=1e-12)
    assert len(figure.axes[3].collections) == 0


def test_a_steady_loading_has_no_panel() -> None:
    steady = ss.simulate(replace(ss.load_scenario("fig6-slab").problem), 7.0)
    figure = draw_run(steady)
    assert len(figure.axes) == 3
    assert figure.get_size_inches().tolist() == [6.4, 5.6]


RUN = ss.simulate(ss.load_scenario("cycles-block").problem, 40.0 * 1.5e8)


@pytest.mark.parametrize("points", [50, 200])
def test_extremes_of_every_quantity_are_kept_in_every_interval(points: int) -> None:
    """Against 200 times in each of so many intervals, to 2 % of the range of the whole run, which they may miss."""
    time, values = RUN.curves_together(RUN.curves, points=points)
    assert np.all(np.diff(time) >= 0.0)
    edges = np.linspace(time[0], time[-1], points + 1)
    for name, drawn in zip(RUN.curves, values, strict=True):
        seen = getattr(RUN, name)(np.linspace(edges[:-1], edges[1:], 200))
        ends = np.interp(edges, time, drawn)
        reach = 0.02 * float(np.ptp(drawn))
        for k in range(points):
            inside = drawn[(time >= edges[k]) & (time <= edges[k + 1])]
            line = np.concatenate([inside, ends[k : k + 2]])
            assert line.min() <= seen[:, k].min() + reach
            assert line.max() >= seen[:, k].max() - reach


LONG = ss.simulate("granite-slab", 100.0)
"""239 slip events, after each of which the load falls by 1 MPa within an instant."""


def test_a_curve_has_both_limits_where_a_rest_begins_although_times_are_rounded() -> None:
    time, (load,) = LONG.curves_together(("load",))
    for event in LONG.events[:-1].itertuples():
        assert load[(time >= event.end) & (time < event.end + 1e-3)].min() <= event.traction_after + 1.0
        assert LONG.load(event.end) == pytest.approx(event.traction_after, rel=1e-9)


@pytest.mark.parametrize("trips", [5.0, 500.0, 5e4])
def test_a_rest_of_any_length_shows_how_far_the_waves_in_the_body_swing_the_load(trips: float) -> None:
    """Against 2000 times of the first round trip and of one in the middle of the rest."""
    run = ss.simulate("fig5-slab-reconstructed", trips * ss.load_scenario("fig5-slab-reconstructed").problem.round_trip_time)
    trip, end = run.problem.round_trip_time, run.events.end.iloc[-1]
    time, (load,) = run.curves_together(("load",))
    for begin in (end, end + trip * (trips // 2 - 2)):
        seen = run.load(begin + trip * np.linspace(0.0, 1.0, 2000))
        near = (time >= begin) & (time <= begin + max(trip, 0.02 * run.history.duration))
        assert load[near].min() == pytest.approx(seen.min(), abs=1e-3 * np.ptp(seen))
        assert load[near].max() == pytest.approx(seen.max(), abs=1e-3 * np.ptp(seen))


@pytest.mark.slow
def test_swings_too_close_to_draw_are_a_range_between_their_extremes() -> None:
    run = ss.simulate("granite-slab", 200.0)
    figure = draw_run(run)
    (stress,) = figure.axes[2].collections
    lows, highs = (np.sort(stress.get_paths()[0].vertices[:, 1])[part] for part in (slice(400), slice(-400, None)))
    rests = 1e-6 * run.events.traction_after
    assert (rests.min(), rests.max()) == (pytest.approx(2.50005, abs=1e-5), pytest.approx(2.50016, abs=1e-5))
    assert (lows.min() > 2.4999, lows.max() < rests.max() + 1e-6) == (True, True)
    assert (highs.min(), highs.max()) == (pytest.approx(3.5, abs=2e-4), pytest.approx(3.5, abs=2e-4))
    assert [text.get_text() for text in figure.legends[0].get_texts()].count(RANGE) == 1


@pytest.mark.slow
def test_slip_rates_of_many_events_are_their_peaks_and_no_filled_band() -> None:
    """A band would say that the contact slips all the time: of 477 events each peak is a point, at its time and its rate."""
    run = ss.simulate("granite-slab", 200.0)
    figure = draw_run(run)
    rate = figure.axes[1]
    assert not rate.collections
    (peaks,) = (line for line in rate.lines if line.get_label() == PEAKS)
    time, height = peaks.get_xydata().T
    assert len(time) >= len(run.events) - 1 > 400
    assert 1e-3 * height == pytest.approx(np.interp(time, run.events.start, run.events.peak_rate), rel=1e-3)
    assert np.abs(time[:, None] - run.events.start.to_numpy()).min(axis=1).max() < 1e-3
    assert [text.get_text() for text in figure.legends[0].get_texts()].count(PEAKS) == 1


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("last", [19.0, 40.0, 100.0])
def test_the_slip_rate_of_tens_and_hundreds_of_events_is_a_curve(last: float) -> None:
    figure = draw_run(LONG, 0.0, last)
    assert [len(panel.collections) for panel in figure.axes] == [0, 0, 0]
    time, rate = figure.axes[1].lines[0].get_xydata().T
    events = LONG.events[LONG.events.start < last - 0.1]
    assert np.isfinite(rate).all()
    for event in events.itertuples():
        assert rate[(time >= event.start - 1e-3) & (time <= event.end + 1e-3)].max() == pytest.approx(
            1e3 * event.peak_rate, rel=1e-9
        )


def test_load_and_traction_are_both_seen_where_they_coincide() -> None:
    """A resting contact bears its load: the dashes of the load lie above the line of the traction."""
    figure = draw_run(ss.simulate("direct-shear-block"))
    above = {line.get_label().split()[0]: line.get_zorder() for line in figure.axes[2].lines}
    assert above["spring"] > above["friction"]


def test_slip_that_hardly_changes_is_drawn_as_its_change() -> None:
    run = ss.simulate("fig5-slab-printed")
    panel = draw_run(run).axes[0]
    assert panel.get_ylabel() == "change of slip $u$ (mm)"
    assert panel.lines[0].get_ydata()[[0, -1]] == pytest.approx([0.0, 1e3 * (run.slip(12.0) - run.slip(0.0))], rel=1e-12)


def test_the_traction_of_a_block_that_sticks_has_no_notches() -> None:
    """Friction of a resting block rises with the spring: it never falls but in the slips."""
    time, (traction, rate) = RUN.curves_together(("traction", "slip_rate"), points=100)
    falls = np.diff(traction) < -1e-9 * np.ptp(traction)
    slips = RUN.catalogue(0.0)
    near = [
        np.any((slips.start <= b + 1e-3) & (slips.end >= a - 1e-3)) for a, b in zip(time[:-1][falls], time[1:][falls], strict=True)
    ]
    assert len(slips) > 30
    assert all(near)
    assert rate.max() == pytest.approx(float(slips.peak_rate.max()), rel=1e-2)


NEVER_STICK = [
    *("velocity-steps-block", "slide-hold-slide-block", "rate-and-state-slab"),
    pytest.param("rate-and-state-block", marks=pytest.mark.slow),
]


@cache
def run(name: str) -> ss.Solution:
    return ss.simulate(name)


def panel(figure: Figure, text: str, across: str = "time") -> Axes:
    """Return the panel whose ordinate and abscissa have these names; panels in one column share the name of the abscissa."""
    return next(
        axes for axes in figure.axes if axes.get_ylabel().startswith(text) and (axes.get_xlabel() or "time").startswith(across)
    )


def drawn(axes: Axes) -> np.ndarray:
    """Return the finite points of the last curve of a panel, without the marks of shocks and of zero."""
    points = next(line for line in reversed(axes.lines) if len(line.get_xdata()) > 2).get_xydata()
    return np.asarray(points[np.isfinite(points).all(axis=1)], float)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", NEVER_STICK)
def test_the_response_fills_its_axes(name: str) -> None:
    """Slip rate, friction against time and against slip: what happens after a thousandth of the run takes over half the height."""
    solution = run(name)
    figure, late = draw_run(solution), 1e-3 * solution.duration
    time, (rate, traction) = solution.curves_together(("slip_rate", "traction"))
    friction = traction[time > late] / solution.problem.normal
    expected = {"slip rate": np.abs(rate[time > late]), "friction": friction, "friction coefficient": friction}
    for text, values in expected.items():
        axes = panel(figure, text, "slip" if text == "friction coefficient" else "time")
        low, high = axes.get_ylim()
        assert low < drawn(axes)[:, 1].min() < drawn(axes)[:, 1].max() < high
        if axes.get_yscale() == "log":
            low, high, values = np.log(low), np.log(high), np.log(values)
        assert np.ptp(values) > 0.5 * (high - low)


def test_friction_after_velocity_steps_is_that_of_steady_sliding() -> None:
    """mu0 + (a - b) ln(v/v0): at the end of 50 s at 10 µm/s relative 1e-6, in both panels, against slip at 0.7 mm."""
    figure = draw_run(run("velocity-steps-block"))
    steady = 0.6 + (0.010 - 0.013) * np.log(10.0)
    time, friction = drawn(panel(figure, "friction")).T
    assert np.interp(249.9, time, friction) == pytest.approx(steady, rel=1e-6, abs=0.0)
    axes = panel(figure, "friction", "slip")
    slip, friction = drawn(axes).T
    assert np.interp(0.69e-3 / size_of(axes.get_xlabel()), slip, friction) == pytest.approx(steady, rel=1e-6, abs=0.0)
    assert friction.max() > 0.63  # the peak after the step to 100 µm/s
    assert panel(figure, "pull rate").get_yscale() == "log"


@pytest.mark.parametrize("name", NEVER_STICK)
def test_friction_is_traction_over_normal_load_at_its_slip(name: str) -> None:
    solution = run(name)
    axes = panel(draw_run(solution), "friction", "slip")
    time, (_, traction) = solution.curves_together(("load", "traction"))
    points = np.stack([solution.slip(time) / size_of(axes.get_xlabel()), traction / solution.problem.normal], axis=1)
    shown = drawn(axes)
    first = len(points) - len(shown)
    np.testing.assert_array_equal(shown, points[first:])
    # Left out is the start from rest: a period of the block (milliseconds), of a slab the state at rest itself.
    body = solution.problem.body
    assert time[first - 1] <= (0.0 if body.has_waves else body.round_trip_time)


def test_traction_alone_leaves_out_the_start_from_rest_too() -> None:
    axes = run("velocity-steps-block").plot.traction().axes[0]
    assert axes.get_ylim()[0] > 25.0  # kN; friction is 0 at rest at t = 0


def test_a_figure_of_the_start_alone_shows_it() -> None:
    """Within one period a block that starts from rest still accelerates from 0: nothing is left out but 0 itself."""
    at_rest = {"initial.load": "30 kN", "initial.state": "10 s", "initial.rate": 0.0}
    solution = ss.simulate(ss.scenarios["velocity-steps-block"].with_values(at_rest))
    period = solution.problem.body.round_trip_time
    rates = drawn(panel(draw_run(solution, 0.0, period), "slip rate"))[:, 1]
    whole = drawn(panel(draw_run(solution), "slip rate"))[:, 1]
    assert rates.min() < 1e-3 * whole.min()


def test_loads_of_a_block_are_forces() -> None:
    """In names and units, also where friction is drawn as a coefficient."""
    figure = draw_run(run("fig6-block-reconstructed"))
    assert figure.axes[2].get_ylabel() == "friction and\nspring force (TN)"
    assert {text.get_text().split()[0] for text in figure.legends[0].get_texts()} == {"spring", "friction"}
    assert run("fig6-block-reconstructed").plot.load().axes[0].get_ylabel() == r"spring force $\beta$ (TN)"
    assert "spring force" in draw_run(run("velocity-steps-block")).legends[0].get_texts()[0].get_text()


def test_every_line_has_an_entry_in_the_legend() -> None:
    figure = draw_run(run("fig6-slab"))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        r"load $\beta$",
        r"traction $\tau$",
        "shock (jump of the slip rate)",
    ]
    tides = {text.get_text() for text in draw_run(run("tides-block")).legends[0].get_texts()}
    assert {"range of the tone", "pull rate without its tone"} <= tides
    assert "shock (jump of the slip rate)" not in tides


def test_stresses_far_from_zero_are_not_drawn_from_zero() -> None:
    axes = panel(draw_run(run("stress-pulse-slab")), "traction")
    low, high = axes.get_ylim()
    assert 5.0 < low < high < 7.0  # MPa


def test_panels_have_letters_in_their_order() -> None:
    assert [axes.get_title(loc="left") for axes in draw_run(run("velocity-steps-block")).axes] == [
        "(a)",
        "(b)",
        "(c)",
        "(d)",
        "(e)",
    ]


@pytest.mark.parametrize("name", ["granite-slab", "direct-shear-block"])
def test_friction_against_slip_goes_through_each_event(name: str) -> None:
    """In fast slip it is the dynamic coefficient all the way: a line from one event to the next would cut the corners."""
    run = ss.simulate(name)
    law = run.problem.friction
    axes = run.plot.friction().axes[0]
    slip, friction = axes.lines[0].get_xydata().T
    for event in run.events[:-1].itertuples():
        first, last = (run.slip(one) / size_of(axes.get_xlabel()) for one in (event.start, event.end))
        inside = (slip > first + 0.02 * (last - first)) & (slip < last - 0.02 * (last - first))
        assert inside.sum() >= 20
        assert friction[inside] == pytest.approx(np.full(inside.sum(), law.dynamic), rel=1e-9)
    assert (friction.max(), friction.min() < law.dynamic) == (pytest.approx(law.static), True)
