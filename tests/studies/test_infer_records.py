"""Velocity steps and slide-hold-slide of an older program: the engine makes the same friction, and its law comes back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.loading import Steps
from stickslip.studies.inference.record import Record

RECORDS = Path(__file__).parent / "records"
PRINTED = 1e-9
"""Last digit of the friction coefficients in the files; the times have nine decimals, too, and friction changes by 0.01 in 1 s."""
LAW = ss.friction.RateAndState(reference=0.6, a=0.005, b=0.01, distance="10 um", rate="1 um/s", evolution="ageing")
BLOCK = ss.SpringBlock(mass="1 kg", stiffness=1e-3 / 1e-6 * 1e6, normal_force="1 MN")  # 0.001 of the normal force per um
PULLED = {"velocity_step": 1e-5, "slide_hold_slide": Steps([0.0, 100.0], [0.0, 1e-6])}


def problem_of(name: str) -> ss.Problem:
    return ss.Problem(BLOCK, LAW, pull_rate=PULLED[name], initial_load="600 kN", initial_state="10 s", initial_rate="1 um/s")


@pytest.mark.parametrize("name", PULLED)
def test_friction_is_that_of_an_older_program(name: str) -> None:
    record = Record.read(RECORDS / f"{name}.csv")
    run = ss.simulate(problem_of(name), record.clock[-1])
    np.testing.assert_allclose(run.traction(record.clock) / 1e6, record.measured["friction"], rtol=0.0, atol=4 * PRINTED)


@pytest.mark.parametrize("name", PULLED)
def test_the_law_of_an_older_program_comes_back(name: str) -> None:
    problem = problem_of(name)
    begin = replace(problem, friction=replace(LAW, a=0.008, b=0.012, distance="20 um"), body=replace(BLOCK, stiffness=2e9))
    free = ["a", "b", "distance", "stiffness"]
    found = ss.studies.infer(begin, RECORDS / f"{name}.csv", free, start="problem", starts=1)
    np.testing.assert_allclose(list(found.values.values()), [0.005, 0.01, 1e-5, 1e9], rtol=1e-4, atol=0.0)
