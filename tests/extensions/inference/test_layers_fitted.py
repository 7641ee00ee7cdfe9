"""Numbers of a layer from the traction of the fault in front of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss

TRUTH = ss.load_scenario("low-velocity-zone").problem
TIME = np.linspace(0.0, 34.9, 700)


def fitted(free: list[str], seed: int, **numbers: Any) -> ss.studies.Inference:
    """Fit a record with noise of 0.5 MPa, from a body with other numbers."""
    noise = np.random.default_rng(seed).normal(0.0, 5e5, len(TIME))
    record = {"time (s)": TIME, "shear stress (Pa)": ss.simulate(TRUTH, "35 s").traction(TIME) + noise}
    guess = replace(TRUTH, body=replace(TRUTH.body, **numbers))
    return ss.studies.infer(guess, record, free, start="problem", starts=1)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("free", "numbers", "exact"),
    [
        ("body.density[0]", {"density": [2300.0, 2800.0]}, 2800.0),
        ("body.density[1]", {"density": [2800.0, 3100.0]}, 2800.0),
        ("body.thickness[0]", {"thickness": [1.05e3, 8e3]}, 1000.0),
    ],
)
def test_a_layer_is_found_within_its_interval(free: str, numbers: dict[str, Any], exact: float) -> None:
    """The interval of 95 % holds the truth, and is narrower than 1 %."""
    found = fitted([free], 1, **numbers)
    low, high = found.table[["low", "high"]].iloc[0]
    assert low <= exact <= high
    assert high - low < 0.01 * exact
    assert ("rounded to cells" in str(found)) is ("thickness" in free)


def test_two_travel_times_are_refused() -> None:
    with pytest.raises(ss.InputError, match=r"thickness\[0\] and body\.wave_speed\[1\] change travel times, which are rounded"):
        fitted(["body.thickness[0]", "body.wave_speed[1]"], 1)
