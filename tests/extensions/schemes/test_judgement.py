"""Whether the series of another program passes, which convention explains one that does not, and how its file may be written."""

from __future__ import annotations

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
