"""Every option of `simulate` is obeyed, or refused by name."""

from __future__ import annotations

import inspect
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import stickslip as ss
from tests.core.run.long_runs.solvers import DURATION, OBEYED, check_checkpoint, check_option
from tests.problems import SLAB

CREEPS = ss.Problem(SLAB, ss.friction.SinusoidalSlip(1.0, 0.5, 5.0), pull_rate=0.01, initial_excess=1e6)


def test_every_option_has_a_value_that_shows() -> None:
    others = {"problem", "progress", "checkpoint", "checkpoint_every", "of_solver"}
    assert set(OBEYED) == set(inspect.signature(ss.simulate).parameters) - others


@pytest.mark.parametrize("option", OBEYED)
def test_an_option_is_obeyed_or_refused_by_name(option: str) -> None:
    check_option(CREEPS, option)


def test_progress_is_reported_and_a_checkpoint_kept(tmp_path: Path) -> None:
    check_checkpoint(CREEPS, tmp_path / "run.nc", lambda run: run.slip(DURATION))


@pytest.mark.parametrize("source", ["fig4-loop", ss.load_scenario("fig4-loop"), "problem"], ids=["name", "scenario", "problem"])
def test_a_rule_that_is_given_decides_as_that_of_the_problem_would(source: Any) -> None:
    """The loop tells the rules apart: the run under a given rule is, bit for bit, that of a problem with this rule."""
    scenario = ss.load_scenario("fig4-loop")
    source, duration = (scenario.problem, scenario.duration) if source == "problem" else (source, None)
    given = ss.simulate(source, duration, scenario.rtol, selection="maxwell")
    stated = ss.simulate(replace(scenario.problem, selection="maxwell"), scenario.duration, scenario.rtol)
    assert given.shocks.equals(stated.shocks)
    assert not given.shocks.equals(ss.simulate(scenario).shocks)
    with pytest.raises(ss.InputError, match="did you mean 'maxwell'"):
        ss.simulate(source, duration, selection="maxwel")
