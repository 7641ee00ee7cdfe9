"""Cold answers are cold, bars are bars, and what is missing is said."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from benchmarks.cold_answers import COMMANDS, Times
from benchmarks.first_answers import PEERS, Peer

from benchmarks import cold_answers, fresh
from stickslip.problem.scenarios.scenario import load_scenario


class Machine:
    """Stands for the machine: keeps what each process finds in its cache, and answers in a given time."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.caches: list[tuple[str, bool]] = []
        self.asked: list[str] = []

    def run(self, command: Sequence[str], folder: str, variables: Mapping[str, str]) -> fresh.Done:
        self.asked.append(command[-1])
        if "stickslip" in command:
            cache = Path(variables["STICKSLIP_CACHE_DIR"])
            self.caches.append((str(cache), not any(cache.iterdir())))
            (cache / "code").touch()
        return fresh.Done("", "", 0, 1.0, self.seconds)


def machine_of(monkeypatch: pytest.MonkeyPatch, seconds: float) -> Machine:
    machine = Machine(seconds)
    monkeypatch.setattr(fresh, "run", machine.run)
    monkeypatch.setattr(cold_answers, "kernel", lambda: 0.1)
    monkeypatch.setattr(cold_answers.compileall, "compile_dir", lambda *_, **__: True)
    return machine


def test_every_first_answer_has_an_empty_cache_of_its_own_and_the_second_one_has_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = machine_of(monkeypatch, 0.5)
    assert cold_answers.main(["--only", "run fig6-slab --figure", "--repeats", "2"]) == 0
    (first, cold), (again, warm), (second, as_cold), _ = machine.caches
    assert cold
    assert as_cold
    assert not warm
    assert first == again != second


def test_a_bar_that_is_missed_is_said_and_ends_with_status_1(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """2.5 s are too long for all commands but rate and state, which may take 3 s."""
    machine_of(monkeypatch, 2.5)
    assert cold_answers.main(["--repeats", "1"]) == 1
    said = [line for line in capsys.readouterr().out.splitlines() if line.endswith(" s allowed")]
    assert said == [f"bar missed: {one.typed}: 2.50 s, 2 s allowed" for one in COMMANDS if one.typed != "run rate-and-state-block"]


def test_bars_that_are_kept_end_with_status_0(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    machine = machine_of(monkeypatch, 1.9)
    assert cold_answers.main(["--repeats", "1"]) == 0
    assert "all bars are kept" in capsys.readouterr().out
    assert len(machine.caches) == 2 * len(COMMANDS)


def test_the_least_first_answer_counts_and_not_the_second() -> None:
    slow = COMMANDS[:1]
    assert cold_answers.missed(slow, [Times(first=[9.0, 2.0, 3.0], again=[9.0])]) == []
    assert cold_answers.missed(slow, [Times(first=[9.0, 2.01, 3.0], again=[0.1])]) == ["check fig6-slab: 2.01 s, 2 s allowed"]


def test_another_tree_is_asked_in_turn_and_has_no_bars(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    machine_of(monkeypatch, 1.0)

    def run(command: Sequence[str], folder: str, variables: Mapping[str, str]) -> fresh.Done:
        return fresh.Done("", "", 0, 1.0, 9.0 if variables.get("PYTHONPATH") == str(tmp_path) else 1.0)

    monkeypatch.setattr(fresh, "run", run)
    assert cold_answers.main(["--only", "check", "--repeats", "1", "--beside", str(tmp_path)]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if "check fig6-slab" in line)
    assert [cell.strip() for cell in row.strip("| ").split("|")][1:] == ["1.00 1.00", "1.00 1.00", "9.00 9.00", "9.00 9.00", "2"]


def test_a_peer_that_is_missing_is_said_and_not_asked(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    machine = machine_of(monkeypatch, 1.0)
    monkeypatch.setattr(cold_answers, "PEERS", (Peer("Nobody", "no_such_peer", "anything", "print(1)", 1.0),))
    assert cold_answers.main(["--only", "Nobody"]) == 0
    assert "not installed: Nobody" in capsys.readouterr().out
    assert "print(1)" not in machine.asked


@pytest.mark.parametrize(
    ("given", "said"),
    [(["--only", "walk"], "no command and no peer contains 'walk'"), (["--repeats", "0"], "--repeats must be 1 or more")],
)
def test_what_cannot_be_measured_is_refused_in_one_line(given: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        cold_answers.main(given)
    assert end.value.code == 2
    assert capsys.readouterr().err.splitlines()[-1].endswith(said)


def test_a_command_that_fails_is_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    machine_of(monkeypatch, 1.0)
    monkeypatch.setattr(fresh, "run", lambda *_: fresh.Done("", "a trace\nstickslip: no such scenario\n", 2, 1.0, 0.1))
    with pytest.raises(SystemExit, match=r"^-m stickslip check fig6-slab: stickslip: no such scenario$"):
        cold_answers.ask(COMMANDS[0], Path(), Times())


def test_the_commands_name_scenarios_that_there_are() -> None:
    for one in COMMANDS:
        assert load_scenario(one.typed.split()[1]).problem is not None


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_a_peer_gives_its_answer(peer: Peer, tmp_path: Path) -> None:
    pytest.importorskip(peer.module)
    done = fresh.run([sys.executable, "-W", "ignore", "-c", peer.program], tmp_path, os.environ)
    assert done.code == 0, done.err
    assert float(done.out) == pytest.approx(peer.answer, rel=1e-3)


def test_a_fresh_process_is_measured_with_its_own_children(tmp_path: Path) -> None:
    """A child that works for half a second of processor time, in a process that only waits for it."""
    work = "import time\nwhile time.process_time() < 0.5: pass"
    done = fresh.run(
        [sys.executable, "-c", f"import subprocess, sys\nsubprocess.run([sys.executable, '-c', {work!r}])"], tmp_path, os.environ
    )
    assert done.spent >= 0.5
    assert done.code == 0, done.err
