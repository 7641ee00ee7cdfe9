"""Steps of the drive and of the normal load between two samples: what is fitted there, and how sure the numbers then are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.inference.fit.model import Model
from stickslip.inference.fit.part import Part
from stickslip.inference.fit.turns import changes_of, felt, moving
from stickslip.inference.record.record import Record
from stickslip.inference.record.resample import Jumps
from stickslip.loading import PiecewiseLinear, Steps

BODY = ss.SpringBlock(20.0, 1.5e8, 5e4)
LAW = ss.friction.RateAndState(0.62, 0.009, 0.0125, 15e-6)
STEPS = Steps([0.0, 40.03, 80.07], [1e-5, 3e-5, 1e-5])


def test_what_a_step_of_the_drive_does_is_at_a_known_time_and_is_not_spread_over_samples() -> None:
    """Friction after a step is steep between samples 0.2 s apart; as a jump that may move it was spread, by up to 0.003."""
    clock = np.arange(0.0, 120.0, 0.2)
    problem = ss.Problem(BODY, LAW, pull_rate=STEPS)
    record = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock)})
    model = Model(problem, (Part(record, STEPS, ("friction",), start="steady"),), (), sizes={"friction": 3e-4})
    run: Any = model.solve(np.zeros(0), 0)
    assert model.curves(run, np.zeros(0), 0)["friction"] == pytest.approx(run.traction(clock) / 5e4, abs=1e-12)
    assert not model.with_jumps(np.zeros(0)).unsure


def test_changes_of_loading_are_felt_when_they_come_to_the_contact() -> None:
    pressed = PiecewiseLinear([0.0, 10.0, 10.1, 20.0, 25.0], [5e4, 5e4, 6e4, 6e4, 6.01e4])
    problem = ss.Problem(BODY, LAW, pull_rate=STEPS, normal_load=pressed)
    assert felt(problem, 70.0, 0.1) == pytest.approx([10.0, 40.03])
    slab = ss.Problem(ss.ElasticSlab(2700.0, 3000.0, 30.0, 5e6), ss.friction.Coulomb(0.6, 0.5), pull_rate=STEPS, initial_load=1e6)
    assert felt(slab, 120.0, 0.1) == pytest.approx([40.04, 80.08])
    assert changes_of(STEPS, 70.0) == pytest.approx([40.03])


def test_only_jumps_soon_after_a_change_of_loading_belong_to_it() -> None:
    jumps = Jumps(np.array([3.9, 4.0, 4.3, 4.5, 9.0]), np.arange(5.0))
    kept = moving(jumps, np.array([4.0]), 0.1)
    assert kept.time.tolist() == [3.9, 4.5, 9.0]
    assert kept.height.tolist() == [0.0, 3.0, 4.0]
