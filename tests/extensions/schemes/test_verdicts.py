"""Verdicts on the rule that a series follows, and shocks and ringing beside the exact ones."""

from __future__ import annotations

import re
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.schemes.benchmarks import judge_series
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.schemes import SETTLES, Schemes, schemes
from stickslip.extensions.schemes.verdict import NONE, STRICT, UNTOLD

LOOP = ss.load_scenario("fig4-loop")
TIME = np.linspace(0.0, 5.7, 2001)
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
SMOOTH = ss.Problem(SLAB, ss.friction.SinusoidalSlip(1.0, 0.5, 2.0), pull_rate=0.3, initial_slip=np.pi / 4, initial_excess=0.0)


def exact(rule: str, problem: ss.Problem = LOOP.problem, time: np.ndarray = TIME, name: str = "series") -> Series:  # type: ignore[type-arg]
    run = ss.simulate(replace(problem, selection=rule), float(time[-1]))
    return Series(time, run.slip(time) - problem.initial_slip, run.slip_rate(time), run.traction(time), name)


def judged(*series: Series) -> Schemes:
    return judge_series(series, LOOP)


@pytest.mark.parametrize("rule", ["perfect-delay", "minimal", "maxwell", "maximal"])
def test_the_exact_path_of_each_rule_follows_that_rule(rule: str) -> None:
    study = judged(exact(rule))
    assert study.verdicts == {"series": rule}
    assert study.table[f"miss_{rule}"].iloc[0] < 0.01


@pytest.mark.parametrize("share", [0.2, 0.4, 0.5, 0.6, 0.8])
def test_a_path_between_two_rules_follows_none(share: float) -> None:
    """Closed form: of a path at a share of the way from one rule to the next, the miss of the first is that share."""
    one, other = exact("perfect-delay"), exact("minimal")
    mixed = replace(one, slip=one.slip + share * (other.slip - one.slip), rate=one.rate + share * (other.rate - one.rate))
    study = judged(mixed)
    assert study.table.rule.iloc[0] == NONE
    assert study.table["miss_perfect-delay"].iloc[0] == pytest.approx(share, rel=1e-2, abs=0.0)
    assert study.table["miss_minimal"].iloc[0] == pytest.approx(1.0 - share, rel=1e-2, abs=0.0)


def test_garbage_follows_no_rule() -> None:
    random = np.random.default_rng(3)
    rate = random.uniform(0.0, 5.0, TIME.size)
    noise = Series(TIME, np.cumsum(rate) * TIME[1], rate, np.full(TIME.size, 5e7), "noise")
    rest = Series(TIME, 0.0 * TIME, 0.0 * TIME, np.full(TIME.size, 6e7), "rest")
    assert judged(noise, rest).verdicts == {"noise": NONE, "rest": NONE}


def test_a_right_series_a_step_late_passes_where_rules_are_nearer_than_its_step() -> None:
    """In a torsion bar the rules differ by 1e-3 of the slip rate, less than eight times what a step late makes."""
    bar = ss.load_scenario("kolsky-slab")
    time = np.linspace(0.0, bar.duration, 6001)
    right, other = exact("perfect-delay", bar.problem, time), exact("maxwell", bar.problem, time, "other")
    late = {name: np.append(getattr(right, name)[0], getattr(right, name)[:-1]) for name in ("slip", "rate", "traction")}
    more = {name: np.append(np.full(8, values[0]), values[:-8]) for name, values in late.items()}
    study = judge_series([replace(right, **late), replace(right, name="later", **more), other], bar)
    assert study.verdicts == {"series": "perfect-delay or minimal", "later": NONE, "other": "maxwell or maximal"}
    assert [found.passed for found in study.judgements] == [True, False, False]


def test_the_right_slip_with_a_slip_rate_that_stops_and_starts_follows_none() -> None:
    right = exact("perfect-delay")
    chopped = replace(right, rate=np.where(np.arange(TIME.size) // 20 % 2, 2.0 * right.rate, 0.0))
    assert judged(chopped).table.rule.iloc[0] == NONE


def test_where_all_rules_have_one_path_a_right_series_cannot_tell_and_garbage_still_follows_none() -> None:
    time = np.linspace(0.0, 4.0, 2001)
    right = exact("perfect-delay", SMOOTH, time)
    wrong = replace(right, slip=1.3 * right.slip, rate=1.3 * right.rate, name="wrong")
    study = judge_series([right, wrong], SMOOTH)
    assert study.verdicts == {"series": UNTOLD, "wrong": NONE}
    assert study.table["miss_minimal"].iloc[1] == pytest.approx(0.3, rel=1e-3, abs=0.0)
    assert "all selection rules have the same solution" in repr(study)


def test_a_series_too_coarse_for_two_rules_does_not_choose_between_them() -> None:
    """A shift by one step of the peak, 5 m/s times 0.28 s, is more than Maxwell's and the maximal rule lie apart."""
    coarse = exact("maxwell", time=np.linspace(0.0, 5.7, 21))
    assert judged(coarse).table.rule.iloc[0] == "maxwell or maximal"


def test_verdicts_on_several_meshes() -> None:
    right = replace(exact("perfect-delay"), name="scheme")
    other = replace(exact("minimal"), name="scheme")
    half = replace(right, slip=0.8 * right.slip, rate=0.8 * right.rate)

    def verdict(*runs: Series) -> str:
        times = [replace(run, time=run.time * (1.0 - 1e-9 * k), cells=20 * 2**k) for k, run in enumerate(runs)]
        return judged(*times).verdicts["scheme"]

    assert verdict(right, right) == "perfect-delay"
    assert verdict(half, right) == "perfect-delay, from 40 cells on"
    assert verdict(other, right) == "depends on the mesh (minimal; perfect-delay)"
    assert verdict(right, half) == f"depends on the mesh (perfect-delay; {NONE})"
    off = replace(right, slip=0.97 * right.slip, rate=0.97 * right.rate)
    assert STRICT > judged(off).table["miss_perfect-delay"].iloc[0] > 0.02
    assert verdict(off, off, off).startswith("none: near perfect-delay, without coming closer")


def settling(*left: float, by: str = "both") -> str:
    """Return the verdict on meshes that are so far from a path halfway between two rules; what `by` leaves out is at the first."""
    one, other = exact("perfect-delay"), exact("minimal")
    runs = []
    for k, share in enumerate(left):
        slip, rate = (share + 0.5 * (by in ("both", name)) for name in ("slip", "rate"))
        moved = replace(one, slip=one.slip + slip * (other.slip - one.slip), rate=one.rate + rate * (other.rate - one.rate))
        runs.append(replace(moved, time=moved.time * (1.0 - 1e-9 * k), cells=20 * 2**k, name="scheme"))
    return judged(*runs).verdicts["scheme"]


@pytest.mark.parametrize("by", ["both", "slip", "rate"])
def test_finer_meshes_that_come_together_between_two_rules_have_an_answer_of_their_own(by: str) -> None:
    assert settling(0.16, 0.08, 0.04, by=by) == SETTLES


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("left", [(0.1, -0.1, 0.1), (0.3, 0.2, 0.1), (0.1, 0.05), (0.1, 0.05, 0.05, 0.0)])
def test_meshes_that_do_not_come_together_or_too_slowly_or_too_few_of_them_have_none(left: tuple[float, ...]) -> None:
    """Swings; equal changes; two meshes only; a last change that is larger than the one before."""
    assert settling(*left) == NONE


def test_a_distance_that_the_changes_can_still_cover_is_no_answer_of_its_own() -> None:
    """At shares 0.5 + 0.35, + 0.18 and + 0.06 the changes left may sum up to 3 times 0.12: less than 3/4 of 0.44, not of 0.56."""
    assert settling(-0.35, -0.18, -0.06) == NONE


def test_changes_between_meshes_have_their_closed_form() -> None:
    """Both slide at (beta - muD S)/Z for one round trip R, then rest: |difference of slip| = dv t up to R, then dv R."""
    time = np.linspace(0.0, 8.0, 80_001)
    problems = [ss.Problem(SLAB, ss.friction.Coulomb(0.8, dynamic), initial_load=80e6 * (1 + 8e-15)) for dynamic in (0.3, 0.5)]
    study = judge_series([exact("minimal", problem, time, "one") for problem in problems], problems[0])
    gap, trip = 0.2 * SLAB.normal_stress / SLAB.impedance, SLAB.two_way_time
    assert study.table.slip_change.iloc[1] == pytest.approx(gap * trip * (8.0 - trip / 2) / 8.0, rel=1e-8, abs=0.0)
    assert study.table.rate_change.iloc[1] == pytest.approx(gap * trip / 8.0, rel=1e-4, abs=0.0)
    assert np.isnan(study.table.slip_change.iloc[0])


def test_each_shock_stands_beside_the_exact_one_and_others_are_the_schemes_own() -> None:
    """Shocks at 2.2427 s and 5.2128 s (closed forms of the folds: tests of the engine); a series late by 0.1 s, with a gap."""
    late = exact("perfect-delay", time=TIME)
    rate = np.interp(TIME - 0.1, TIME, late.rate, left=0.0)
    rate[(TIME > 4.0) & (TIME < 4.3)] = 0.0
    shocks = judged(replace(late, rate=rate)).shocks
    both, own = shocks[shocks.exact_time.notna()], shocks[shocks.exact_time.isna()]
    assert both.exact_time.to_numpy() == pytest.approx([2.242655, 5.212841], abs=1e-6, rel=0.0)
    assert both.delay.to_numpy() == pytest.approx([0.1, 0.1], abs=TIME[1], rel=0.0)
    assert both["size"].to_numpy() == pytest.approx([1.0, 1.0], abs=0.02, rel=0.0)
    assert own.time.to_numpy() == pytest.approx([4.0, 4.3], abs=2.0 * TIME[1], rel=0.0)
    assert own.before.iloc[0] > 3.0 > 1e-9 > own.after.iloc[0]


def test_a_shock_that_is_not_made_has_no_time() -> None:
    run = exact("perfect-delay")
    smooth = replace(run, rate=np.convolve(run.rate, np.full(401, 1.0 / 401.0), "same"))
    study = judged(smooth)
    assert study.table.shocks.iloc[0] == 0
    assert np.isnan(study.shocks.time).all()


def test_ringing_is_measured_as_the_variation_that_was_added() -> None:
    """Added: 20 saw teeth of 0.1 m/s up and down, 4 m/s; the exact slip rate varies by V = its total variation on the samples."""
    run = exact("perfect-delay")
    rate = run.rate.copy()
    while_slipping = np.flatnonzero((TIME > 2.4) & (TIME < 3.0))[:40]
    flat = np.full(40, rate[while_slipping[0] - 1])
    rate[while_slipping] = flat
    plain = judged(replace(run, rate=rate)).table.oscillation.iloc[0]
    rate[while_slipping[::2]] += 0.1
    found = judged(replace(run, rate=rate)).table.oscillation.iloc[0]
    whole = np.abs(np.diff(run.rate)).sum()
    assert found - plain == pytest.approx(4.0 / whole, rel=0.06, abs=0.0)


def test_of_the_schemes_only_those_without_numerical_waves_do_not_ring() -> None:
    names = ["characteristics", "central-differences-cfl1", "backward-euler", "central-differences", "newmark"]
    ringing = schemes(LOOP, None, names, [100], search="continue").table.set_index("scheme").oscillation
    assert (ringing[names[:3]] < 0.05).all()
    assert (ringing[names[3:]] > 5.0).all()


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("search", "expected"), [("stick-first", "minimal"), ("continue", "perfect-delay")])
def test_verdicts_by_scheme_on_the_loop(search: str, expected: str) -> None:
    found = schemes(LOOP, None, ["sbp4", "newmark", "backward-euler"], [50, 100], search=search).verdicts
    assert found == {"sbp4": expected, "newmark": NONE, "backward-euler": NONE if search == "stick-first" else expected}


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("search", ["stick-first", "continue"])
def test_the_table_of_the_page_is_what_its_script_measures(search: str) -> None:
    """On the two coarsest meshes here; the script measures all six."""
    docs = Path(__file__).parents[3] / "docs"
    column = {"stick-first": 1, "continue": 2}[search]
    text = (docs / "theory" / "schemes-at-a-jump.md").read_text(encoding="utf-8")
    page = re.findall(r"^\| (.*?) \| `([-DmMx?]{6})` \| `([-DmMx?]{6})` \|$", text, re.MULTILINE)
    found = runpy.run_path(str(docs / "scheme_verdicts.py"))["verdicts"](search, (25, 50))
    assert {row[0]: row[column][:2] for row in page} == found
