"""Whether the series of another program passes, which convention explains one that does not, and how its file may be written."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.cli.main import main
from stickslip.extensions.schemes.benchmarks import benchmark_of, judge_series
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.judgement import Judgement
from stickslip.extensions.schemes.series import read_series

NAME = "linear-weakening"
"""A problem with shocks, slip and rest, whose solution has a closed form."""


@cache
def right() -> Series:
    scenario = benchmark_of(NAME).scenario
    run, time = ss.simulate(scenario), np.linspace(0.0, scenario.duration, 2001)
    return Series(time, run.slip(time) - scenario.problem.initial_slip, run.slip_rate(time), run.traction(time), "mine")


def judged(series: Series, **options: Any) -> Judgement:
    (found,) = judge_series(series, benchmark_of(NAME).scenario, **options).judgements
    return found


def test_the_exact_series_passes_at_any_tolerance() -> None:
    found = judged(right(), tolerance=1e-9)
    assert found.passed
    assert max(found.shares.values()) < 1e-12
    assert found.text == "passed, with a tolerance of 1e-09: mine"
    assert found.reasons.startswith("slip is off by ")
    assert found.hints == ()


def test_each_share_is_the_mean_distance_over_its_scale() -> None:
    """Of slip 2 % of the largest, of the slip rate 3 % of the mean, of traction 4 % of its range; at rest the same."""
    base = right()
    shifted = {"slip": 0.02 * base.slip.max(), "rate": 0.03 * np.abs(base.rate).mean(), "traction": 0.04 * np.ptp(base.traction)}
    found = judged(replace(base, **{name: getattr(base, name) + by for name, by in shifted.items()}), tolerance=0.1)
    assert found.shares == pytest.approx({"slip": 0.02, "slip rate": 0.03, "traction": 0.04, "traction at rest": 0.04}, rel=1e-3)
    assert found.passed
    assert not judged(replace(base, traction=base.traction + shifted["traction"]), tolerance=0.03).passed


def test_traction_at_rest_must_be_right_too() -> None:
    base = right()
    found = judged(replace(base, traction=np.where(base.rate == 0.0, 0.0, base.traction)))
    assert found.shares["slip rate"] < 1e-9
    assert found.shares["traction at rest"] > 1.0
    assert [fault.partition(" is off")[0] for fault in found.faults] == ["traction", "traction at rest"]


SIDES = "of two elastic sides each slips by half, and the jump between them counts"
CONVENTIONS: dict[str, tuple[Callable[[Series], Series], tuple[str, ...]]] = {
    "signs": (
        lambda one: replace(one, slip=-one.slip, rate=-one.rate, traction=-one.traction),
        ("mine has the opposite sign of the exact slip, slip rate and traction: multiply by -1",),
    ),
    "sign of traction": (
        lambda one: replace(one, traction=-one.traction),
        ("mine has the opposite sign of the exact traction: multiply by -1",),
    ),
    "half": (
        lambda one: replace(one, slip=0.5 * one.slip, rate=0.5 * one.rate),
        (f"mine has half of the exact slip and slip rate: {SIDES}",),
    ),
    "twice": (
        lambda one: replace(one, slip=2.0 * one.slip, rate=2.0 * one.rate),
        ("mine has twice the exact slip and slip rate: divide by 2",),
    ),
    "zero": (
        lambda one: replace(one, slip=one.slip + 0.6, traction=one.traction - 81.6e6),
        ("mine has another zero than the exact slip and traction: subtract 0.6 m and -81.6 MPa",),
    ),
    "sign and zero": (
        lambda one: replace(one, traction=81.6e6 - one.traction),
        ("mine has the opposite sign and another zero than the exact traction: multiply by -1 and then subtract -81.6 MPa",),
    ),
    "size": (lambda one: replace(one, slip=1.2 * one.slip, rate=1.2 * one.rate, traction=1.2 * one.traction), ()),
    "noise": (lambda one: replace(one, rate=one.rate + 0.3 * np.sin(9.0 * one.time)), ()),
}


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_a_right_series_in_another_convention_does_not_pass_and_is_explained(convention: str) -> None:
    change, hints = CONVENTIONS[convention]
    found = judged(change(right()))
    assert not found.passed
    assert found.hints == hints


@pytest.mark.parametrize("what", ["slip", "traction"])
def test_a_wrong_size_is_not_called_another_zero(what: str) -> None:
    """Slip of one short pulse is the same most of the time, and traction changes by less than its mean."""
    scenario = benchmark_of("one-pulse").scenario
    run, time = ss.simulate(scenario), np.linspace(0.0, scenario.duration, 2001)
    one = Series(time, run.slip(time) - scenario.problem.initial_slip, run.slip_rate(time), run.traction(time), "mine")
    (found,) = judge_series(replace(one, **{what: 1.1 * getattr(one, what)}), scenario).judgements
    assert not found.passed
    assert found.hints == ()


def test_a_series_too_coarse_for_its_shocks_is_told_so() -> None:
    """Two shocks 30 us apart in steps of 10 us are not told apart; in steps of 2 us they are."""
    scenario = benchmark_of("two-slabs").scenario
    run, found = ss.simulate(scenario), []
    for steps in (20, 100):
        time = np.linspace(0.0, 2e-4, steps + 1)
        series = Series(time, run.slip(time), run.slip_rate(time), run.traction(time), "mine")
        found.append(judge_series(series, scenario).judgements[0])
    coarse, fine = found
    assert not coarse.passed
    shocks = "its step is 1e-05 s, and exact shocks are as near as 3e-05 s"
    assert coarse.hints[-1] == f"mine is too coarse for its shocks: {shocks}: write more times"
    assert fine.passed
    assert fine.hints == ()


def test_a_series_too_coarse_for_a_slip_rate_that_turns_back_is_told_so() -> None:
    """A light machine answers the echoes of its slab within a tenth of a second."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=3e6, driver_inertia=2e6)
    law = ss.friction.FromExpression("0.6 - 0.1*u/(1 + u)")
    problem = ss.Problem(slab, law, pull_rate=0.3, initial_excess=1e6)
    run, found = ss.simulate(problem, 25.0), []
    for steps in (1200, 30_000):
        time = np.linspace(0.0, 25.0, steps + 1)
        series = Series(time, run.slip(time), run.slip_rate(time), run.traction(time), "mine")
        found.append(judge_series(series, problem).judgements[0])
    coarse, fine = found
    assert [hint.partition(" soon after ")[0] for hint in coarse.hints] == [
        "mine is too coarse for its shocks: its step is 20.8333 ms, and the exact slip rate turns back"
    ]
    assert fine.passed


def of_benchmark(name: str, rows: int) -> Series:
    """Return the exact series of a benchmark at evenly spaced times."""
    scenario = benchmark_of(name).scenario
    run, time = ss.simulate(scenario), np.linspace(0.0, scenario.duration, rows)
    return Series(time, run.slip(time) - scenario.problem.initial_slip, run.slip_rate(time), run.traction(time), "mine")


FEW_ROWS: dict[str, tuple[str, int, Callable[[Series], Series]]] = {
    "constant traction": ("loop", 9, lambda one: replace(one, traction=np.full(9, 1e6))),
    "traction": ("coulomb", 9, lambda one: replace(one, traction=1.4 * one.traction)),
    "slip rate": ("one-pulse", 20, lambda one: replace(one, rate=1.4 * one.rate)),
    "of many shocks": ("bow-at-a-tenth", 9, lambda one: replace(one, traction=1.4 * one.traction)),
}


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("case", FEW_ROWS)
def test_a_series_that_lies_beside_shocks_for_the_most_part_is_refused_with_the_rows_that_are_enough(case: str) -> None:
    name, rows, change = FEW_ROWS[case]
    (found,) = judge_series(change(of_benchmark(name, rows)), benchmark_of(name).scenario).judgements
    assert not found.passed
    said = re.search(rf"it is too coarse: \d+ of its {rows} rows lie beside shocks, .*; (\d+) rows in equal steps", found.reasons)
    assert said
    (right_one,) = judge_series(of_benchmark(name, int(said[1])), benchmark_of(name).scenario).judgements
    assert "too coarse" not in right_one.reasons
    again = right_one.measured.series
    wrong = replace(again, rate=1.4 * again.rate, traction=1.4 * again.traction)
    (wrong_one,) = judge_series(wrong, benchmark_of(name).scenario).judgements
    assert "traction" in {fault.partition(" is off")[0] for fault in wrong_one.faults}


def test_a_series_whose_cells_are_too_few_is_told_how_many_are_enough() -> None:
    """Shadows of 4 cells: R/2 = 2.857 s, two shocks, 5.7 s: half of the time takes 16 R / 5.7 s = 16.04 cells."""
    one = replace(of_benchmark("loop", 2001), cells=4)
    (found,) = judge_series(one, benchmark_of("loop").scenario).judgements
    assert "; 18 cells are enough" in found.reasons
    assert judge_series(replace(one, cells=18), benchmark_of("loop").scenario).judgements[0].measured.compared > 0.5


@pytest.mark.parametrize(("factor", "passes"), [(1.0, True), (1.04, True), (1.06, False)])
def test_traction_that_stays_constant_is_compared_with_itself(factor: float, passes: bool) -> None:
    """Dynamic friction is constant, 5.67e7 Pa; computed from slip rate and load, its range is 7e-9 Pa."""
    slab = ss.ElasticSlab(2000.0, 2465.0, 739.5, 1e8, driver_impedance=3e6)
    problem = ss.Problem(slab, ss.friction.Coulomb(0.8, 0.567), initial_load=8.02e7)
    run, time = ss.simulate(problem, 5.0), np.linspace(0.0, 5.0, 501)
    one = Series(time, run.slip(time), run.slip_rate(time), np.full(501, factor * 5.67e7), "mine")
    (found,) = judge_series(one, problem).judgements
    assert found.passed == passes
    assert found.shares["traction"] == pytest.approx(factor - 1.0, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("tolerance", "passes"), [(0.05, True), (4e-4, False)])
def test_a_shock_smaller_than_the_tolerance_allows_need_not_be_made(tolerance: float, passes: bool) -> None:
    """The layers send back 1 %: the slip rate falls from 20.5 to 20.4901 m/s, a jump of 0.0005 of it, where it is off by 0.001."""
    layers = ss.LayeredSlab(thickness=[400, 500], density=[2000, 2000], wave_speed=[1000, 1020], normal_stress=1e8)
    problem = ss.Problem(layers, ss.friction.LinearSlipWeakening(0.8, 0.4, 2.0), initial_load=8.1e7)
    run, time = ss.simulate(problem, 1.5), np.linspace(0.0, 1.5, 2001)
    one = Series(time, 0.999 * run.slip(time), 0.999 * run.slip_rate(time), run.traction(time), "mine")
    (found,) = judge_series(one, problem, tolerance=tolerance).judgements
    assert found.passed == passes
    assert ("it makes 1 of 2 shocks" in found.faults) != passes


def test_the_small_shock_of_a_slow_problem_must_be_made() -> None:
    """The first shock of `weak-shock`, of 2.6e-5 m/s, is a fifth of its largest slip rate: spread over 1 s it is not made."""
    one = of_benchmark("weak-shock", 2001)
    smooth = replace(one, rate=one.rate * np.minimum(one.time / 1.0, 1.0))
    (found,) = judge_series(smooth, benchmark_of("weak-shock").scenario).judgements
    assert "it makes 1 of 2 shocks" in found.faults


UNEQUAL: dict[str, tuple[str, tuple[tuple[float, float, int], ...]]] = {
    "long steps up to a shock": ("coulomb", ((0.0, 6.5, 201), (6.5, 9.0, 2010))),
    "many rows at rest": ("loop", ((0.0, 1.0, 60_001), (1.0, 5.7, 2001))),
    "few rows at rest": ("coulomb", ((0.0, 5.71, 801), (5.71, 9.0, 12))),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("steps", UNEQUAL)
def test_a_right_series_of_unequal_steps_passes_and_a_wrong_one_does_not(steps: str) -> None:
    name, parts = UNEQUAL[steps]
    scenario = benchmark_of(name).scenario
    run, time = ss.simulate(scenario), np.unique(np.concatenate([np.linspace(start, end, rows) for start, end, rows in parts]))
    one = Series(time, run.slip(time) - scenario.problem.initial_slip, run.slip_rate(time), run.traction(time), "mine")
    assert judge_series(one, scenario).judgements[0].faults == ()
    wrong = replace(one, traction=np.where(one.rate > 0.0, 0.8 * one.traction, one.traction))  # off by more than 0.05 in time
    assert "traction is off by" in judge_series(wrong, scenario).judgements[0].reasons


@pytest.mark.parametrize(("samples", "passes"), [(1, True), (20, False)])
def test_a_sample_on_a_jump_of_traction_at_rest_may_have_either_side(samples: int, passes: bool) -> None:
    """The first echo of `dwell` comes at R = 20/7 s to a contact at rest, row 1000 of 2801 rows up to 8 s."""
    one = of_benchmark("dwell", 2801)
    rows = np.arange(2801)
    late = np.where((rows >= 1000) & (rows < 1000 + samples), one.traction[999], one.traction)
    assert abs(late[1000] - one.traction[1001]) > 0.1 * np.ptp(one.traction)
    (found,) = judge_series(replace(one, traction=late), benchmark_of("dwell").scenario, tolerance=1e-4).judgements
    assert found.passed == passes


def columns() -> Any:
    one = right()
    return np.column_stack([one.time, one.slip, one.rate, one.traction])


FILES: dict[str, tuple[str, str, tuple[float, ...]]] = {
    "semicolons and units": ("time (ms);slip (mm);v (mm/s);tau (MPa)", ";", (1e3, 1e3, 1e3, 1e-6)),
    "units in names": ("time_s,slip_m,slip_rate_m_per_s,traction_Pa", ",", (1.0, 1.0, 1.0, 1.0)),
    "blanks, as in the SCEC benchmarks": ("t h-slip h-slip-rate h-shear-stress", " ", (1.0, 1.0, 1.0, 1e-6)),
    "notes before the headings": (
        "code 7, version 2\nrun 5\nt (s),slip (m),slip rate (m/s),shear stress (kPa)",
        ",",
        (1.0, 1.0, 1.0, 1e-3),
    ),
}


@pytest.mark.parametrize("form", FILES)
def test_series_are_read_as_records_are(tmp_path: Path, form: str) -> None:
    header, separator, factors = FILES[form]
    file = tmp_path / f"{NAME}.csv"
    np.savetxt(file, columns() * factors, delimiter=separator, header=header, comments="", fmt="%.17g", encoding="utf-8-sig")
    read = read_series(file)
    assert (read.name, read.cells) == (NAME, 0)
    for name, exact in (("time", right().time), ("slip", right().slip), ("rate", right().rate), ("traction", right().traction)):
        np.testing.assert_allclose(getattr(read, name), exact, rtol=1e-13, atol=1e-300)


def test_a_file_alone_is_judged_by_its_name(tmp_path: Path) -> None:
    header = "time_s,slip_m,slip_rate_m_per_s,traction_Pa"
    for name in (NAME, "mine"):
        np.savetxt(tmp_path / f"{name}.csv", columns(), delimiter=",", header=header, comments="", fmt="%.17g")
    assert judge_series(tmp_path / f"{NAME}.csv").passed
    assert judge_series([str(tmp_path / "mine.csv")], benchmark_of(NAME).scenario).passed
    with pytest.raises(ss.InputError, match="judge_series: of which problem is 'mine'"):
        judge_series(tmp_path / "mine.csv")
    with pytest.raises(ss.InputError, match="tolerance must lie between 0 and 1, got 5"):
        judge_series(tmp_path / f"{NAME}.csv", tolerance=5)
    (tmp_path / "nan.csv").write_text("t,slip,v,tau\n0,0,0,0\n1,nan,0,0\n2,0,0,0\n")
    with pytest.raises(ss.InputError, match=r"nan\.csv, line 3: slip is not a finite number"):
        read_series(tmp_path / "nan.csv")


@pytest.mark.parametrize(("factor", "code", "verdict"), [(1.0, 0, "Passed"), (0.9, 1, "Not passed")])
def test_the_exit_code_says_whether_a_series_passes(
    factor: float, code: int, verdict: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, header = tmp_path / "mine.csv", "time_s,slip_m,slip_rate_m_per_s,traction_Pa"
    np.savetxt(file, columns() * [1.0, factor, factor, 1.0], delimiter=",", header=header, comments="", fmt="%.17g")
    with pytest.raises(SystemExit) as ended:
        main(("benchmark", "judge", str(file), "--name", NAME, "--tolerance", "0.05"))
    assert ended.value.code == code
    assert f"\n{verdict}, with a tolerance of 0.05: mine.\nSlip is off by " in capsys.readouterr().out


TURNS, RPM = 180.0 / np.pi, 30.0 / np.pi
OTHER_UNITS: dict[str, tuple[str, str, tuple[float, ...]]] = {
    "in SI": ("drill-string", "time_s,slip_rad,slip_rate_rad_per_s,traction_N_m", (1.0, 1.0, 1.0, 1.0)),
    "as drillers write": ("drill-string", "time (s),bit angle (deg),bit rpm (rpm),TOB (kN m)", (1.0, TURNS, RPM, 1e-3)),
    "of a block": ("fig6-block-reconstructed", "time_s,slip_m,slip_rate_m_per_s,traction_N", (1.0, 1.0, 1.0, 1.0)),
    "force with its unit": ("fig6-block-reconstructed", "t (s),slip (mm),v (mm/s),force (kN)", (1.0, 1e3, 1e3, 1e-3)),
}


@pytest.mark.parametrize("units", OTHER_UNITS)
def test_series_of_strings_and_blocks_have_angles_torques_and_forces(units: str, tmp_path: Path) -> None:
    name, header, factors = OTHER_UNITS[units]
    scenario = replace(ss.load_scenario(name), duration=5.0)
    run, time = ss.simulate(scenario), np.linspace(0.0, 5.0, 1001)
    rows = np.column_stack([time, run.slip(time) - scenario.problem.initial_slip, run.slip_rate(time), run.traction(time)])
    np.savetxt(tmp_path / "mine.csv", rows * factors, delimiter=",", header=header, comments="", fmt="%.17g")
    study = judge_series(tmp_path / "mine.csv", scenario, tolerance=1e-6)
    assert study.passed, study
    assert study.columns["slip_error"][0] == scenario.problem.unit_of("slip")
    wrong = [*factors[:3], 1e-3 * factors[3]]
    np.savetxt(tmp_path / "small.csv", rows * wrong, delimiter=",", header=header, comments="", fmt="%.17g")
    unit = scenario.problem.load_unit
    with pytest.raises(ss.InputError, match=f"small: largest traction is .* {unit}, exact .* {unit}: is it in k{unit}\\?"):
        judge_series(tmp_path / "small.csv", scenario)
