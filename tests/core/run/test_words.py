"""Each option of a run is declared, said and given under one name, in Python and on the command line."""

from __future__ import annotations

import re
from dataclasses import fields
from inspect import signature

import pytest

import stickslip as ss
from stickslip.cli.typed_options import TypedOptions
from stickslip.foundation.quantities import fields_of
from stickslip.problem import LARGEST_SHARE, MAX_PIECES, MOST_PIECES, BoundedOptions, RunOptions, creep_tolerance
from stickslip.problem.limits import EXACT_TRIPS, LARGEST_RTOL
from stickslip.problem.run_options import RUN_RTOL
from stickslip.problem.scenarios import Scenario
from stickslip.run.words import WORDS, GivenToRun

DECLARED = set(fields_of(BoundedOptions))


def test_every_option_is_said_and_given() -> None:
    assert set(WORDS) >= DECLARED
    assert set(WORDS) == set(GivenToRun.__annotations__) | {"duration", "rtol"}
    assert {one.name for one in fields(TypedOptions)} == DECLARED | {"selection"}


def test_a_scenario_and_a_run_have_the_options_of_a_run() -> None:
    scenario = ss.scenarios["fig6-slab"]
    run = ss.simulate(scenario)
    assert {one.name for one in fields(RunOptions)} <= {one.name for one in fields(Scenario)}
    assert (scenario.options, run.options) == (RunOptions(12.0, title=scenario.title, description=scenario.description),) * 2
    assert run.scenario("fig6-slab") == scenario
    for name in vars(run.options):
        assert getattr(run, "asked_duration" if name == "duration" else name) == getattr(scenario, name), name


@pytest.mark.parametrize("call", [ss.simulate, ss.catalogue, ss.resume])
def test_help_lists_each_option_once(call: object) -> None:
    taken = [name for name in signature(call).parameters if name in WORDS]  # type: ignore[arg-type]
    said = [line.partition(" : ")[0].strip() for line in (call.__doc__ or "").splitlines() if line[:4].isspace() and " : " in line]
    assert "{options}" not in (call.__doc__ or "")
    assert [one for one in taken if said.count(one) != 1] == ["duration"] * (call is ss.catalogue)


def numbers_in(name: str) -> list[float]:
    """Return the numbers that are said of an option, in their order."""
    return [float(one) for one in re.findall(r"\d+(?:\.\d+)?(?:e-?\d+)?", WORDS[name].meaning)]


def test_numbers_that_are_said_are_those_that_hold() -> None:
    usual = RunOptions(1.0).rtol
    automatic = creep_tolerance(ss.scenarios["fig5-slab-printed"].problem, None, usual)
    assert numbers_in("rtol") == [RUN_RTOL.at_least, RUN_RTOL.at_most, usual]
    assert numbers_in("creep_rtol") == pytest.approx([LARGEST_RTOL, 0.0, EXACT_TRIPS, automatic], rel=1e-12, abs=0.0)
    assert numbers_in("shortest_event") == [1.0, 100.0 * LARGEST_SHARE, 0.0, MOST_PIECES]
    assert (MAX_PIECES, "two million by default" in WORDS["max_pieces"].meaning) == (2_000_000, True)
