"""A record that begins in steady turning is followed from there, under a law of the slip rate too."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from benchmarks.own_files import floor

import stickslip as ss

TRUTH = {"friction.dynamic": 0.5, "body.inertia": 305.0}
"""The bit and the collars of `drill-string`, with which the log is made along characteristics, without the package."""


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of a drive that goes from 180 to 150 rpm while the bit turns."""
    file = tmp_path_factory.mktemp("floor") / "floor.csv"
    floor(file)
    return file


@pytest.mark.slow
def test_a_log_that_begins_in_steady_turning_gives_the_bit(log: Path) -> None:
    found = ss.studies.infer("drill-string", log, list(TRUTH), begin=92.0, end=112.0, starts=1)
    assert any("begins in steady turning, because the torque is level at first" in note for note in found.notes)
    for name, true in TRUTH.items():
        row = found.table.loc[name]
        assert abs(row["value"] - true) < 4.0 * row["uncertainty"], name
        assert row["uncertainty"] < 0.01 * true, name


def test_a_log_that_begins_otherwise_begins_as_the_problem_says(log: Path) -> None:
    found = ss.studies.infer("drill-string", log, ["dynamic"], begin=100.5, end=104.0, starts=1, max_time="1 ns")
    assert any("begins as the problem says" in note for note in found.notes)


def test_a_law_of_slip_has_no_steady_start() -> None:
    problem = ss.load_scenario("drill-string").problem
    weakening = replace(problem, friction=ss.friction.LinearSlipWeakening(0.8, 0.5, 1.0))
    data = {"time (s)": [0.0, 1.0, 2.0, 3.0], "STOR (kN.m)": [8.0, 8.1, 8.0, 8.05], "RPM": [180.0, 180.0, 180.0, 180.0]}
    with pytest.raises(ss.InputError, match="cannot begin: linear-slip-weakening does not slide steadily"):
        ss.studies.infer(weakening, data, ["dynamic"], start="steady")
