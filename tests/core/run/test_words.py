"""Each option of a run is declared, said and given under one name, in Python and on the command line."""

from __future__ import annotations

from dataclasses import fields
from inspect import signature

import pytest

import stickslip as ss
from stickslip.cli.typed_options import TypedOptions
from stickslip.foundation.quantities import fields_of
from stickslip.problem import BoundedOptions, RunOptions
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
