"""Branches that go on: at period doublings, after Ctrl-C, and where steady sliding is stable beside them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.cycles import following
from tests.command_line import Command
from tests.extensions.cycles.problems import BRAKE, coulomb, stribeck

CRITICAL = 802.799465
"""The critical stiffness (N/m) of `two_states`."""


def two_states(share: float) -> ss.Problem:
    """Return a block under two states and the slip law whose period doubles at 0.866 of the critical stiffness."""
    law = ss.friction.TwoStateRateAndState(
        reference=0.6, a=0.01, b=0.01, distance=1e-5, second_b=0.0084, second_distance=1e-5 / 0.048, evolution="slip"
    )
    return ss.Problem(ss.SpringBlock(100.0, share * CRITICAL, 10.0), law, pull_rate=1e-6)


def test_cycles_of_twice_the_period_are_followed_from_the_edge() -> None:
    """At its end the doubled branch is the cycle to which a long run comes: to 1e-9."""
    start = ss.studies.cycle(two_states(0.87))
    branch = ss.studies.follow(start, "body.stiffness", to=0.86 * CRITICAL, steps=2, double=True)
    [edge] = branch.edges
    assert edge.name == "period doubling"
    doubled = [one for one in branch.points if one.doubled]
    alone = ss.studies.cycle(two_states(0.86))
    assert doubled[-1].value == pytest.approx(0.86 * CRITICAL, rel=1e-12)
    assert doubled[-1].measures.period == pytest.approx(alone.period, rel=1e-9)
    assert doubled[-1].multipliers[0] == pytest.approx(alone.multipliers[0], rel=1e-6)
    assert {one.part for one in doubled} == {1}
    assert all(1.9 < one.measures.period / edge.orbit.period < 2.1 for one in doubled)
    assert [one.stable for one in branch.points if not one.doubled and not one.edge][-1] is False


@pytest.mark.slow
def test_cycles_of_twice_the_period_are_followed_back_to_the_edge() -> None:
    """The edge is the same from both sides: its value to 1e-9."""
    [edge] = ss.studies.follow(ss.studies.cycle(two_states(0.87)), "body.stiffness", to=0.86 * CRITICAL, steps=2).edges
    back = ss.studies.follow(ss.studies.cycle(two_states(0.86)), "body.stiffness", to=0.87 * CRITICAL, steps=3)
    assert [one.name for one in back.edges] == ["end of doubling"]
    assert back.edges[0].value == pytest.approx(edge.value, rel=1e-9)
    assert back.edges[0].orbit.period == pytest.approx(edge.orbit.period, rel=1e-8)


class Stop:
    """A function that presses Ctrl-C when it is called for the given time, such as with a line of progress."""

    def __init__(self, after: int) -> None:
        self.left = after

    def __call__(self, *_: Any) -> tuple[()]:
        self.left -= 1
        if self.left == 0:
            raise KeyboardInterrupt
        return ()


@pytest.mark.parametrize("after", [3, *(pytest.param(one, marks=pytest.mark.slow) for one in (1, 9, 12))])
def test_a_branch_that_was_interrupted_goes_on_as_if_it_had_not_been(after: int, tmp_path: Path) -> None:
    """While the contact rests, and while it does not: the same cycles, not one more, from its table; and the same edges: to 1e-9.

    Next to an edge, where the share of rest grows as a root, its rounding is one of 1e-6.
    """
    start = ss.studies.cycle(stribeck(0.1, initial_load=0.0))
    given: Any = {"along": "pull_rate", "to": 0.5, "steps": 3}
    whole = ss.studies.follow(start, **given)
    part = ss.studies.follow(start, **given, progress=Stop(after))
    assert part.interrupted
    assert len(part.points) == after
    assert "interrupted at loading.pull_rate" in repr(part)
    again = ss.studies.follow(start, **given, resume=part.to_csv(tmp_path / "branch.csv"))
    assert not again.interrupted
    pd.testing.assert_frame_equal(again.table.drop(columns="stick_share"), whole.table.drop(columns="stick_share"), rtol=1e-9)
    assert again.table["stick_share"].tolist() == pytest.approx(whole.table["stick_share"].tolist(), abs=1e-6)
    assert [edge.name for edge in again.edges] == [edge.name for edge in whole.edges]
    assert [edge.value for edge in again.edges] == pytest.approx([edge.value for edge in whole.edges], rel=1e-9)


def test_a_branch_that_was_interrupted_at_its_last_cycle_goes_on_to_the_edge_behind_it() -> None:
    """The amplitude is next to 0 there: no further cycle is looked for, as in the whole branch."""
    start = ss.studies.cycle(stribeck(0.151, initial_rate=0.151, initial_load=5.75), near=0.7)
    given: Any = {"along": "pull_rate", "to": 0.14, "steps": 3}
    whole = ss.studies.follow(start, **given)
    part = ss.studies.follow(start, **given, progress=Stop(len(whole.points) - 1))
    assert [edge.name for edge in whole.edges] == ["steady sliding"]
    assert part.interrupted
    again = ss.studies.follow(start, **given, resume=part)
    assert [one.value for one in again.points] == [one.value for one in whole.points]


def test_a_branch_of_too_many_cycles_ends_with_those_it_has_and_goes_on_from_its_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With no more than two at once, twice, it is the branch without that limit, bit for bit."""
    start = ss.studies.cycle(coulomb())
    given: Any = {"along": "pull_rate", "to": 0.2, "steps": 4}
    whole = ss.studies.follow(start, **given)
    monkeypatch.setattr(following, "MOST_POINTS", 2)
    part = ss.studies.follow(start, **given)
    assert part.is_full
    assert not part.interrupted
    assert part.table["loading.pull_rate"].tolist() == whole.table["loading.pull_rate"].tolist()[:2]
    said = "with as many cycles as are followed at once: give fewer steps or a nearer end (to), or the branch can go on there"
    assert said in repr(part)
    for _ in range(2):
        part = ss.studies.follow(start, **given, resume=part.to_csv(tmp_path / "branch.csv"))
    assert not part.is_full
    pd.testing.assert_frame_equal(part.table, whole.table, check_exact=True)


def test_the_command_writes_a_branch_of_too_many_cycles(tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(following, "MOST_POINTS", 3)
    (tmp_path / "brake.toml").write_text(BRAKE, encoding="utf-8")
    table = tmp_path / "a.csv"
    given = "cycle", str(tmp_path / "brake.toml"), "--along", "pull_rate", "--to", "0.3", "--out", str(table)
    done = command(*given, "--steps", "8")
    assert done.code == 0
    assert "Ended at loading.pull_rate" in done.out
    assert len(pd.read_csv(table, comment="#")) == 3


def test_ctrl_c_leaves_what_there_is_of_a_branch_in_the_table_and_resume_ends_it(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The table is then that of the branch that was never interrupted, to the last digit."""
    (tmp_path / "brake.toml").write_text(BRAKE, encoding="utf-8")
    whole, table = tmp_path / "whole.csv", tmp_path / "a.csv"
    given = "cycle", str(tmp_path / "brake.toml"), "--along", "pull_rate", "--to", "0.3", "--steps", "3", "--out"
    assert command(*given, str(whole)).code == 0
    with monkeypatch.context() as patched:
        patched.setattr(following, "edges_between", Stop(2))
        done = command(*given, str(table))
    assert (done.code, done.err) == (130, "stickslip: interrupted\n")
    assert "Interrupted at loading.pull_rate" in done.out
    assert 1 <= len(pd.read_csv(table, comment="#")) < len(pd.read_csv(whole, comment="#"))
    assert command(*given, str(table), "--resume").code == 0
    pd.testing.assert_frame_equal(pd.read_csv(table, comment="#"), pd.read_csv(whole, comment="#"), check_exact=True)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("pull", "to"), [(0.28, 0.35), (0.28, 0.3), (0.14, 0.4)])
def test_a_finished_branch_that_goes_on_stays_as_it_is(pull: float, to: float, tmp_path: Path) -> None:
    """Back to where it began, at the end of its range and at the Hopf point, from its table and from itself: not one row more."""
    start = ss.studies.cycle(stribeck(pull, initial_load=0.0))
    branch = ss.studies.follow(start, to=to, steps=4)
    for n in range(2):
        again = ss.studies.follow(start, to=to, steps=4, resume=branch.to_csv(tmp_path / f"{n}.csv") if n else branch)
        pd.testing.assert_frame_equal(again.table, branch.table, check_exact=True)
        assert [edge.name for edge in again.edges] == [edge.name for edge in branch.edges]
        assert [edge.value for edge in again.edges] == [edge.value for edge in branch.edges]


def test_the_stability_of_a_cycle_at_an_edge_is_not_told_where_a_multiplier_is_on_the_unit_circle() -> None:
    """Rounding decides nothing there: a multiplier a little inside of the circle is neutral at its edge, and stable elsewhere."""
    start = ss.studies.cycle(coulomb())
    branch = ss.studies.follow(start, "pull_rate", to=0.2, steps=2)
    inside = branch.points[0]._replace(multipliers=np.array([-1.0 + 2e-8]))
    names = "", "period doubling", "fold of cycles", "Neimark-Sacker", "end of doubling"
    points = tuple(inside._replace(edge=name) for name in names)
    assert [one.stable for one in points] == [True, None, None, None, None]
    assert replace(branch, points=points).table["stable"].tolist() == ["yes", *["not known"] * 4]


def test_hysteresis_is_where_steady_sliding_and_stick_slip_are_both_stable() -> None:
    """From the Hopf point to the loss of stick; inside, runs from both starts stay apart, and outside they do not."""
    branch = ss.studies.follow(ss.studies.cycle(stribeck(0.1, initial_load=0.0)), "pull_rate", to=0.5, steps=10)
    [both] = branch.hysteresis
    lost, steady = branch.edges
    assert both == pytest.approx((steady.value, lost.value), rel=1e-9)
    assert "hysteresis between loading.pull_rate = 0.1497866137 m/s and 0.3022214759 m/s" in repr(branch)
    for pull, apart in ((0.8 * both.low, False), (1.2 * both.low, True), (0.97 * both.high, True), (1.03 * both.high, False)):
        load = 2.0 * pull + 10.0 * (0.3 + 0.2 * np.exp(-pull / 0.05))
        sliding = ss.simulate(stribeck(pull, initial_rate=pull, initial_load=load * (1.0 - 1e-3)), 40.0)
        sticking = ss.simulate(stribeck(pull, initial_load=0.0), 40.0)
        rests = [bool((run.history.store.mode[-len(run.history) // 10 :] == 0).any()) for run in (sliding, sticking)]
        assert (rests == [False, True]) is apart, pull
    alone = ss.studies.follow(ss.studies.cycle(coulomb()), "pull_rate", to=0.2, steps=2)
    assert alone.hysteresis == ()
    assert alone.hysteresis_text == ""


def test_resume_refuses_what_is_no_table_of_this_branch(tmp_path: Path) -> None:
    start = ss.studies.cycle(coulomb())
    branch = ss.studies.follow(start, "pull_rate", to=0.2, steps=2)
    table = branch.to_csv(tmp_path / "a.csv")
    other = ss.studies.cycle(coulomb(0.11))
    (tmp_path / "b.csv").write_text("a,b\n1,2\n", encoding="utf-8")
    damaged = tmp_path / "c.csv"
    damaged.write_text(table.read_text(encoding="utf-8").replace(",0,0", ",x,0"), encoding="utf-8")
    no_step = tmp_path / "d.csv"
    pd.read_csv(table, comment="#").assign(ahead=0.0).to_csv(no_step, index=False)
    for file, cycle, along, said in (
        (table, other, "pull_rate", r"a.csv: begins at loading.pull_rate = 0.1 m/s with a period of .* it is another branch"),
        (table, start, "body.mass", "a.csv: holds a branch along loading.pull_rate, not along body.mass"),
        (tmp_path / "b.csv", start, "pull_rate", "b.csv: is no table of a branch that can go on: it has no column 'period'"),
        (tmp_path / "none.csv", start, "pull_rate", "none.csv: cannot be read"),
        (damaged, start, "pull_rate", "c.csv: a row of it is damaged"),
        (no_step, start, "pull_rate", "d.csv: a row of it is damaged"),
    ):
        with pytest.raises(ss.InputError, match=said):
            ss.studies.follow(cycle, along, to=0.3, resume=file)
    with pytest.raises(ss.InputError, match=r"a.csv: has come to loading.pull_rate = 0.2 m/s, beyond to = 0.15 m/s: give one that"):
        ss.studies.follow(start, "pull_rate", to=0.15, resume=table)


def test_the_command_goes_on_with_the_table_that_it_left(tmp_path: Path, command: Command) -> None:
    file, table = tmp_path / "brake.toml", tmp_path / "a.csv"
    file.write_text(BRAKE, encoding="utf-8")
    along = "cycle", str(file), "--along", "pull_rate", "--steps", "4", "--out", str(table)
    assert command(*along, "--to", "0.3 m/s").code == 0
    before = pd.read_csv(table, comment="#")
    done = command(*along, "--to", "0.35 m/s", "--resume")
    assert done.code == 0
    assert "Loss of stick at loading.pull_rate = 0.3022214759 m/s" in done.out
    assert "Hysteresis between loading.pull_rate = 0.28 m/s and 0.3022214759 m/s" in done.out
    after = pd.read_csv(table, comment="#")
    assert after["loading.pull_rate"][: len(before)].tolist() == before["loading.pull_rate"].tolist()
    assert command("cycle", str(file), "--resume").refusal.startswith("cycle: --resume is for branches")
    gone = "cycle", str(file), "--along", "pull_rate", "--to", "1", "--resume", "--out", str(tmp_path / "b.csv")
    assert command(*gone).refusal.startswith("cycle: --resume goes on with the branch in the table --out")
