"""A block that creeps is followed for ages: where computing each period of its swings leads to, and with the same events."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss

BODY = ss.SpringBlock(mass=2.8e12, stiffness=3.43e14, normal_force=1e14)
LAW = ss.friction.SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=50.0)
TOP = 2.0 * math.pi / 50.0
"""Slip (m) at which friction of this law rises most steeply."""


def problem(slip: float, rate: float, damping: float = 0.0, **changes: object) -> ss.Problem:
    """Return a block that begins to creep at rest in equilibrium; `damping` is a share of the critical one."""
    body = replace(BODY, damping=damping * 2.0 * math.sqrt(BODY.stiffness * BODY.mass))
    return ss.Problem(body, LAW, pull_rate=rate, initial_slip=slip, initial_excess=0.0, **changes)


AT_STRENGTH = -1e14 * (1.0 + 0.5 * math.sin(50.0 * 0.08))
"""Load (N) at which this block begins to slip backwards from a slip of 0.08 m."""
CASES = {
    "each cycle touches rest": problem(0.105, 1e-6),
    "from touching rest to swinging freely": problem(TOP - 6e-4, 2e-6),
    "swings freely": problem(TOP + 1e-3, 2e-6),
    "backwards": replace(problem(0.08, -1e-6), initial_excess=None, initial_load=AT_STRENGTH),
    "damped lightly": problem(0.105, 1e-6, 1e-4),
    "damped beyond swinging": problem(0.105, 1e-6, 3.0),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("case", CASES)
def test_a_leap_over_swings_lands_where_computing_each_period_does(case: str) -> None:
    """Slip and slip rate in the periods after the landing: within the stated error, and 1e-12 of the slip by rounding."""
    stated = CASES[case]
    end = 3000.0 * stated.round_trip_time
    exact, leaping = ss.simulate(stated, end, creep_rtol=0.0, rtol=1e-12), ss.simulate(stated, end, creep_rtol=1e-5, rtol=1e-12)
    assert len(leaping.history) < 150 < len(exact.history)
    (leap,) = leaping.creep.itertuples()
    assert leap.round_trips > 2900
    times = leap.end + np.linspace(0.01, 2.9, 30) * stated.round_trip_time
    rounding = 1e-12 * abs(float(exact.slip(end)))
    assert np.abs(leaping.slip(times) - exact.slip(times)).max() <= leap.error + rounding
    fastest = math.sqrt((BODY.stiffness + 2.5e15) / BODY.mass)
    assert np.abs(leaping.slip_rate(times) - exact.slip_rate(times)).max() <= fastest * (leap.error + rounding)
    assert leap.error < 1e-9 * abs(float(exact.slip(end))) + 1e-12


def test_the_stated_error_is_far_below_the_swing() -> None:
    """The swing of the first case is 1e-8 m: an error that only said so would prove nothing."""
    stated = CASES["each cycle touches rest"]
    leaping = ss.simulate(stated, 3000.0 * stated.round_trip_time, creep_rtol=1e-5)
    assert leaping.creep.error.max() < 1e-12


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("name", "starts", "pieces"),
    [
        ("fig5-block-printed", [0.0], 3000),
        ("fig5-block-reconstructed-k", [0.0, 36.689, 68.267, 125.643], 4000),
        ("fig5-block-reconstructed-omega", [0.0, 3.491, 7.224, 12.488, 16.662], 4000),
    ],
)
def test_the_blocks_of_figure_5_go_on_at_the_plate_rate(name: str, starts: list[float], pieces: int) -> None:
    """Events up to 130 years (the last: 30) by their years, to 1e-3 years: the first ones are known without any leap."""
    run = ss.simulate(ss.load_scenario(name).problem, "30 years" if name.endswith("omega") else "130 years", max_pieces=20_000)
    assert run.status.ok
    assert len(run.history) < pieces
    assert run.creep.round_trips.sum() > 1e8
    years = (run.events.start / ss.YEAR).to_numpy()
    np.testing.assert_allclose(years[: len(starts)], starts, atol=1e-3, rtol=0.0)


def test_an_event_that_follows_a_leap_is_that_of_computing_each_period() -> None:
    """Start within 1e-3 s, slip within 1e-6: behind the slip at which friction is largest, creep turns dynamic."""
    stated = problem(TOP + 0.03, 3e-7)
    exact, leaping = (ss.simulate(stated, "11000 s", creep_rtol=rtol) for rtol in (0.0, 1e-5))
    assert len(leaping.creep)
    assert len(exact.events) == len(leaping.events) > 0
    times = leaping.creep.end.iloc[0] + np.linspace(0.01, 2.9, 30) * stated.round_trip_time
    assert np.abs(leaping.slip(times) - exact.slip(times)).max() <= leaping.creep.error.max() < 1e-10
    theirs, ours = (run.events[run.events.slip > 0.1].iloc[0] for run in (exact, leaping))
    np.testing.assert_allclose(ours.start, theirs.start, atol=1e-3, rtol=0.0)
    np.testing.assert_allclose(ours.slip, theirs.slip, atol=0.0, rtol=1e-6)


WEAKENING = ss.load_scenario("fig6-block-printed").problem


@pytest.mark.parametrize(("rate", "load"), [(WEAKENING.pull_rate, 0.8e14), (-5e-9, -0.8e14)])
def test_cycles_that_touch_rest_are_all_the_same(rate: float, load: float) -> None:
    """Slip after the landing within the stated error and 1e-12 of itself: under a law of slip rate only roundings add up."""
    stated = replace(WEAKENING, pull_rate=rate, initial_load=load, initial_excess=None)
    end = 6000.3 * stated.round_trip_time
    exact, leaping = ss.simulate(stated, end, creep_rtol=0.0), ss.simulate(stated, end, creep_rtol=1e-3)
    (leap,) = leaping.creep.itertuples()
    assert leap.round_trips > 5000
    times = leap.end + np.linspace(0.01, 40.0, 300) * stated.round_trip_time
    assert np.abs(leaping.slip(times) - exact.slip(times)).max() <= leap.error + 1e-12 * abs(float(exact.slip(end)))
    assert leap.error < 1e-3 * np.ptp(exact.slip(times) - stated.pull_rate * times)
    assert "cycles that touch rest" in leaping.creep_note
    assert "round trip" not in leaping.creep_note


def test_events_of_stick_and_slip_are_never_leaped_over() -> None:
    """A block with the same law that slips in events keeps them all."""
    name = "fig6-block-reconstructed"
    stated = ss.load_scenario(name).problem
    exact, leaping = (ss.simulate(stated, "400 years", creep_rtol=rtol) for rtol in (0.0, 1e-4))
    assert len(leaping.creep) == 0
    assert exact.events.equals(leaping.events)


def test_the_advice_to_a_block_speaks_of_periods() -> None:
    """A block has no round trips."""
    run = ss.simulate(CASES["swings freely"], "1000 years", creep_rtol=0.0, max_pieces=5000)
    assert run.status.name == "too many pieces"
    assert "round trip" not in run.status.message
