"""The ways through fail where a newcomer waits, is left without an answer, or gets a wrong one."""

import pytest
from benchmarks.own_files import newmark
from benchmarks.ways import WAYS, Number, Step
from benchmarks.ways_through import Done, faults

from stickslip.cli.app import COMMANDS

STEP = Step("run mine.toml", 2.0, (r"written: a\.png", Number(r"slip ([\d.]+) m", 0.59, 0.01)))
DONE = Done("slip 0.591 m\nwritten: a.png\n", "", 0, 9.0, 1.0)


def test_a_step_that_does_all_it_should_has_no_fault() -> None:
    assert faults(STEP, DONE, 1.0) == []


@pytest.mark.parametrize(
    ("done", "fault"),
    [
        (DONE._replace(spent=2.5), "took 2.5 s of the processor, 2.0 s allowed"),
        (
            DONE._replace(code=2, err="stickslip: mine.toml: no such file\n"),
            "exit status 2, not 0: stickslip: mine.toml: no such file",
        ),
        (DONE._replace(out="slip 0.591 m\n"), r"does not say written: a\.png"),
        (DONE._replace(out="slip 0.7 m\nwritten: a.png"), "says 'slip 0.7 m', where 0.59 is true within 0.01 of it"),
        (DONE._replace(out="slip nan m\nwritten: a.png"), r"does not say slip ([\d.]+) m"),
    ],
)
def test_each_fault_is_said(done: Done, fault: str) -> None:
    assert faults(STEP, done, 1.0) == [fault]


def test_a_slower_machine_and_compilation_have_their_time() -> None:
    assert faults(STEP, DONE._replace(spent=2.5), 1.5) == []
    assert faults(STEP, DONE._replace(spent=80.0, err="compiling the engine"), 1.0) == []


def test_every_way_types_commands_that_there_are() -> None:
    typed = [step.typed.split()[0] for steps in WAYS.values() for step in steps]
    assert len(WAYS) == 7
    assert {word for word in typed if not word.startswith(("-", "python:"))} <= set(COMMANDS)


def test_the_truth_of_the_slope_is_newmarks() -> None:
    """Newmark's block under whole sines slides while its rate is above 0: three slides, of which the package says 0.5905 m."""
    assert newmark() == pytest.approx(0.5905, rel=1e-4)
