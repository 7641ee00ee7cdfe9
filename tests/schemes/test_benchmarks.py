"""Problems for other programs: the exact series are exact, files have their checksums, and wrong series are told."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import read
from stickslip.schemes.registry import SCHEMES
from stickslip.schemes.run import run_scheme
from stickslip.studies.benchmarks import BENCHMARKS, benchmark_of, exact_series, judge_benchmark, write_benchmark
from stickslip.studies.schemes import judge_series

TELL_RULES_APART = {"loop", "dwell"}


def test_there_are_twelve_that_any_scheme_can_run() -> None:
    assert len(BENCHMARKS) == 12
    for name in BENCHMARKS:
        scenario = benchmark_of(name).scenario
        series = run_scheme(scenario.problem, 0.2, SCHEMES["sbp4"], 20)
        assert np.isfinite(series.slip).all()


@pytest.mark.parametrize("name", BENCHMARKS)
def test_only_those_that_say_so_tell_rules_apart(name: str) -> None:
    scenario = benchmark_of(name).scenario
    series = run_scheme(scenario.problem, scenario.duration, SCHEMES["characteristics"], 20)
    groups = judge_series(series, scenario).paths.groups()
    assert (len(groups) > 1) == (name in TELL_RULES_APART)


def test_the_series_of_coulomb_friction_is_the_closed_form() -> None:
    found = exact_series("coulomb")
    rate = 0.5 * 1e8 / 9.8e6
    assert found.shock_time.values == pytest.approx([0.0, 20.0 / 3.5], rel=1e-12, abs=1e-12)
    assert float(found.slip_rate[1]) == pytest.approx(rate, rel=1e-6, abs=0.0)
    assert float(found.slip[-1]) == pytest.approx(rate * 20.0 / 3.5, rel=1e-6, abs=0.0)


def test_files_have_their_checksums_and_the_scenario_comes_back(tmp_path: Path) -> None:
    scenario, series, sums = write_benchmark("loop", tmp_path)
    for line in sums.read_text().splitlines():
        digest, name = line.split("  ")
        assert hashlib.sha256((tmp_path / name).read_bytes()).hexdigest() == digest
    assert ss.load_scenario(scenario).problem == benchmark_of("loop").scenario.problem
    assert read(series).sizes["sample"] > 4000


def test_a_right_series_is_judged_right_and_a_wrong_one_wrong(tmp_path: Path) -> None:
    found = exact_series("loop")
    rows = np.column_stack([found[name].values for name in ("time", "slip", "slip_rate", "traction")])
    for file, rate in (("loop.csv", 1.0), ("wrong.csv", 0.5)):
        np.savetxt(
            tmp_path / file, rows * [1.0, rate, rate, 1.0], delimiter=",", header="time,slip,slip_rate,traction", comments=""
        )
    right, wrong = (judge_benchmark(tmp_path / file, "loop").table.iloc[0] for file in ("loop.csv", "wrong.csv"))
    assert (right.rule, wrong.rule) == ("perfect-delay", "none")
    assert right.slip_error < 1e-10 < 1.0 < wrong.slip_error
    assert abs(right.heat_error) < 1e-9
    assert wrong.heat_error < -0.4
    assert np.isnan(right.energy_drift)
    assert (right.shocks, right.own_shocks) == (2, 0)
    assert abs(right.shock_delay) < right.step
    assert judge_benchmark(tmp_path / "loop.csv").table.rule.iloc[0] == "perfect-delay"


def test_rest_is_judged_where_nothing_slips() -> None:
    scenario = benchmark_of("dwell").scenario
    series = run_scheme(scenario.problem, scenario.duration, SCHEMES["characteristics"], 20)
    study = judge_series(series, scenario)
    assert study.table.rule.iloc[0] == "perfect-delay or minimal"
    assert study.table.slip_error.iloc[0] == 0.0


def test_unknown_names_and_folders_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="did you mean 'loop'"):
        benchmark_of("lop")
    with pytest.raises(InputError, match="there is no folder"):
        write_benchmark("loop", tmp_path / "none")
