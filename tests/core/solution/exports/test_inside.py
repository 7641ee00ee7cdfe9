"""Series inside the slab: the field at that place; at a rigid driver nothing moves but the driver."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.solution.files.sampling import sample

RUN = ss.simulate("fig6-slab")
HEIGHT = 1e4


def test_a_series_inside_the_slab_is_the_field_there() -> None:
    series = sample(RUN, 40.0, x=3500.0)
    found = RUN.field(3500.0, series.time)
    np.testing.assert_array_equal(series.slip_rate, found.velocity)
    np.testing.assert_array_equal(series.traction, found.stress)
    assert series.slip[0] == 0.0
    assert series.slip_rate[39] == pytest.approx(0.35 * RUN.problem.pull_rate, rel=1e-9, abs=0.0)  # the wave comes after 1 s
    assert series.slip_rate[40] == pytest.approx(4.10204081633, rel=1e-8, abs=0.0)


def test_the_driver_does_not_feel_the_slip() -> None:
    series = sample(RUN, 40.0, x=HEIGHT)
    np.testing.assert_allclose(series.slip_rate, RUN.problem.pull_rate, rtol=0.0, atol=1e-14)


def test_a_filtered_series_holds_the_same_displacement() -> None:
    pytest.importorskip("scipy")
    series = sample(RUN, 10.0, end=10.0, x=5000.0, antialias=True)
    assert series.slip_rate.sum() / 10.0 == pytest.approx(series.slip[-1], rel=2e-3, abs=0.0)


def test_a_place_outside_is_refused() -> None:
    with pytest.raises(ss.InputError, match="x must lie between 0"):
        sample(RUN, 10.0, x=2e4)
