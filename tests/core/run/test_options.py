"""The options of a run come from a scenario, or from whoever asks for it."""

from __future__ import annotations

from dataclasses import dataclass

from stickslip.problem.scenarios import load_scenario
from stickslip.run import CallOptions


@dataclass(frozen=True)
class Swing:
    """A problem of an extension with a number that a scenario has, too."""

    duration: float


def test_a_problem_of_an_extension_may_have_a_number_of_the_name_of_an_option() -> None:
    assert CallOptions.of(Swing(7.0), duration=3.0).duration == 3.0
    assert CallOptions.of(Swing(7.0)).duration is None


def test_options_that_are_not_given_are_those_of_the_scenario() -> None:
    scenario = load_scenario("fig6-slab")
    found = CallOptions.of(scenario, rtol=1e-6)
    assert (found.duration, found.rtol, found.title) == (scenario.duration, 1e-6, scenario.heading)
