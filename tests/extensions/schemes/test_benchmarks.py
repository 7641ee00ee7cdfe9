"""Problems for other programs: the exact series are exact, files have their checksums, and wrong series are told."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.schemes.benchmark_kinds import Benchmark
from stickslip.extensions.schemes.benchmarks import (
    BENCHMARKS,
    benchmark_of,
    exact_series,
    judge_benchmark,
    judge_series,
    write_benchmark,
)
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.problems import OF_ONE_CONTACT
from stickslip.extensions.schemes.run import SCHEMES, run_scheme
from stickslip.extensions.schemes.schemes import schemes
from stickslip.extensions.schemes.series import read_series
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import read


def test_a_column_that_is_missing_is_named_beside_those_that_are_there(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    np.savetxt(file, np.eye(3), delimiter=",", header="time,slip,slip_rat", comments="")
    with pytest.raises(InputError, match=r"a\.csv: no column for the slip rate: call it slip_rate_m_per_s or .*slip, slip_rat$"):
        read_series(file)


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"cells": [0]}, "schemes: cells must be a whole number from 12 to 100000, got 0"),
        ({"cells": [50, 100_001]}, "schemes: cells must be a whole number from 12 to 100000, got 100001"),
        ({"search": "conitnue"}, "schemes: there is no search 'conitnue'; did you mean 'continue'?"),
        ({"courant": float("nan")}, "schemes: newmark: the Courant number must lie in (0, inf], got nan"),
    ],
)
def test_numbers_are_checked_before_the_exact_runs(
    numbers: dict[str, object], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        pytest.fail("an exact run began")

    monkeypatch.setitem(schemes.__globals__, "exact_runs", fail)
    with pytest.raises(InputError) as error:
        schemes("fig4-loop", None, "newmark", **numbers)  # type: ignore[arg-type]
    assert str(error.value) == message


@cache
def right() -> Series:
    run, time = ss.simulate("fig4-loop"), np.linspace(0.0, 5.7, 1141)
    return Series(time, run.slip(time), run.slip_rate(time), run.traction(time), "mine")


def cut(run: Series, kept: slice) -> Series:
    return replace(run, **{name: getattr(run, name)[kept] for name in ("time", "slip", "rate", "traction")})


MISTAKES: dict[str, tuple[Callable[[Series], Series], str]] = {
    "milliseconds": (lambda run: replace(run, time=1e3 * run.time), r"ends at 5700 s, the run at 5\.7 s: is its time in ms\?"),
    "short": (lambda run: cut(run, slice(0, 400)), r"ends at 1\.995 s, the run at 5\.7 s: write more"),
    "late": (lambda run: cut(run, slice(300, None)), r"begins at 1\.5 s: it must begin at t = 0"),
    "mm": (lambda run: replace(run, slip=1e3 * run.slip), r"largest slip is 10650\.2 m, exact 10\.6502 m: is it in mm\?"),
    "mm/s": (lambda run: replace(run, rate=1e3 * run.rate), r"largest slip rate is .* is it in mm/s\?"),
    "MPa": (lambda run: replace(run, traction=1e-6 * run.traction), r"is 79\.9763 Pa, exact 7\.99763e\+07 Pa: is it in MPa\?"),
    "offset": (lambda run: replace(run, slip=run.slip + 5.0), r"slip is 5 m at the start: slip must count from t = 0"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_a_series_is_told_in_one_line(mistake: str) -> None:
    change, message = MISTAKES[mistake]
    with pytest.raises(InputError, match=f"mine: .*{message}") as error:
        judge_series(change(right()), "fig4-loop")
    assert "\n" not in str(error.value)


def test_times_that_go_back_are_told_with_their_place() -> None:
    time = right().time.copy()
    time[[500, 501]] = time[[501, 500]]
    with pytest.raises(InputError, match=r"mine: times must ascend, but 2\.5 s \(sample 502\) follows 2\.505 s"):
        replace(right(), time=time)


def test_a_series_that_is_wrong_without_a_wrong_unit_is_judged() -> None:
    wrong = replace(right(), slip=100.0 * right().slip, rate=0.01 * right().rate)
    assert judge_series(wrong, "fig4-loop").verdicts == {"mine": "none"}


OF_A_SLAB = tuple(BENCHMARKS)[:12]
"""Problems that have a grid."""


def test_there_are_twelve_that_any_scheme_can_run() -> None:
    for name in OF_A_SLAB:
        scenario = benchmark_of(name).scenario
        series = run_scheme(scenario.problem, 0.2, SCHEMES["sbp4"], 20)
        assert np.isfinite(series.slip).all()


@pytest.mark.parametrize("name", [one.name for one in OF_ONE_CONTACT if one.name not in OF_A_SLAB])
def test_schemes_refuse_the_others(name: str) -> None:
    with pytest.raises(InputError, match=r"schemes: .*(has no grid|not in the schemes)"):
        schemes(benchmark_of(name).scenario)


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("one", OF_ONE_CONTACT, ids=lambda one: one.name)
def test_only_those_that_say_so_tell_rules_apart(one: Benchmark) -> None:
    """The exact series of each is judged right, and no file is needed for that."""
    scenario = one.scenario
    run, time = ss.simulate(scenario), np.linspace(0.0, scenario.duration, 2001)
    slip = run.slip(time) - scenario.problem.initial_slip
    study = judge_series(Series(time, slip, run.slip_rate(time), run.traction(time), one.name))
    assert study.passed, study
    assert (len(study.paths.groups()) > 1) == one.tells_rules


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
            tmp_path / file,
            rows * [1.0, rate, rate, 1.0],
            delimiter=",",
            header="time_s,slip_m,slip_rate_m_per_s,traction_Pa",
            comments="",
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
