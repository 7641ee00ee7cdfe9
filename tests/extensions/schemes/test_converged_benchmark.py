"""A benchmark whose series has converged and is not exact: a series passes if it leaves the error band by little."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.extensions.schemes import benchmarks
from stickslip.extensions.schemes.benchmark_kinds import ConvergedBenchmark
from stickslip.extensions.schemes.contract import Series
from stickslip.problem.scenarios import Scenario
from tests.command_line import Command

TIME = np.linspace(0.0, 2.0, 201)
BAND = 0.1


def converge(scenario: Scenario) -> xr.Dataset:
    """Slip t^2, slip rate 2 t, traction 5 - t, each right to 0.1."""
    assert scenario.name == "ramp"
    values = {"slip": TIME**2, "slip_rate": 2.0 * TIME, "traction": 5.0 - TIME}
    found = {"time": ("sample", TIME)} | {name: ("sample", value) for name, value in values.items()}
    return xr.Dataset(found | {f"{name}_band": ("sample", np.full(TIME.size, BAND)) for name in values})


@pytest.fixture
def ramp(monkeypatch: pytest.MonkeyPatch) -> ConvergedBenchmark:
    one = ConvergedBenchmark("ramp", "nothing but a ramp", lambda: ss.load_scenario("fig6-slab"), converge)
    monkeypatch.setitem(benchmarks.BENCHMARKS, "ramp", one)
    return one


def series(off: float = 0.0) -> Series:
    time = np.linspace(0.0, 2.0, 401)
    return Series(time, time**2 + off, 2.0 * time + off, 5.0 - time + off, "ramp")


@pytest.mark.parametrize(
    ("off", "share", "passes"), [(0.0, 0.0, True), (-0.1, 0.0, True), (0.18, 0.04, True), (0.25, 0.075, False)]
)
def test_only_what_leaves_the_band_counts(ramp: ConvergedBenchmark, off: float, share: float, passes: bool) -> None:
    """Slip rate and traction have scales of 2; slip of 4."""
    found = ss.studies.judge_series(series(off))
    assert found.table.share.to_numpy() == pytest.approx([0.5 * share, share, share], rel=1e-9, abs=1e-4)
    assert found.passed == passes
    assert np.array_equal(ramp.band.slip_rate, np.full(TIME.size, BAND))
    assert found.sentences[0].startswith("passed" if passes else "not passed")


WRONG: dict[str, tuple[tuple[float, float, float], str]] = {
    "half": ((0.5, 0.5, 1.0), "ramp has half of the converged slip and slip rate: of two elastic sides each slips by half"),
    "sign": ((1.0, 1.0, -1.0), "ramp has the opposite sign of the converged traction: multiply by -1"),
    "size": ((1.0, 1.2, 1.0), ""),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_another_convention_is_named_beside_what_is_off(ramp: ConvergedBenchmark, wrong: str) -> None:
    factors, words = WRONG[wrong]
    one = series()
    slip, rate, traction = (values * factor for values, factor in zip((one.slip, one.rate, one.traction), factors, strict=True))
    found = ss.studies.judge_series(replace(one, slip=slip, rate=rate, traction=traction), ramp.name)
    assert not found.passed
    assert [text.partition(", and the jump")[0] for text in found.sentences[2:]] == [words] * bool(words)


def test_another_unit_is_refused_in_one_line(ramp: ConvergedBenchmark) -> None:
    one = series()
    with pytest.raises(ss.InputError, match=r"^ramp: largest traction is 5e-06 Pa, converged 5 Pa: is it in MPa\?$"):
        ss.studies.judge_series(replace(one, traction=1e-6 * one.traction), ramp.name)
    with pytest.raises(ss.InputError, match=r"^ramp: largest slip is 4000 m, converged 4 m: is it in mm\?$"):
        ss.studies.judge_series(replace(one, slip=1e3 * one.slip), ramp.name)


def test_the_command_gives_and_judges_it(command: Command, ramp: ConvergedBenchmark, tmp_path: Path) -> None:
    listed = command("benchmark", "list").out
    assert "nothing but a ramp (converged, with an error band)" in listed
    assert f"{len(benchmarks.BENCHMARKS)} problems." in listed
    command("benchmark", "get", "ramp")
    rows = np.column_stack([getattr(series(1.0), name) for name in ("time", "slip", "rate", "traction")])
    np.savetxt("mine.csv", rows, delimiter=",", header="time_s,slip_m,slip_rate_m_per_s,traction_Pa", comments="")
    judged = command("benchmark", "judge", "mine.csv", "--name", "ramp", "--out", "table.csv", "--figure", "mine.png")
    assert judged.code == 1
    assert "Not passed, with a tolerance of 0.05 beyond the error band: mine." in judged.out
    assert {file.name for file in tmp_path.iterdir()} >= {"ramp.toml", "ramp.nc", "ramp.sha256", "table.csv", "mine.png"}
