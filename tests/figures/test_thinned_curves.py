"""Curves of runs with more pieces than points: what is drawn covers what happened, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss

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
