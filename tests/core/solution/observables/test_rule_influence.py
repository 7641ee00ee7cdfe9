"""What a run owes to its selection rule: counted by hand, and by running it under the other rules."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.selection_rule import SELECTION_RULES
from stickslip.solution.observables.rule_influence import RuleInfluence

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
FIG6 = ss.load_scenario("fig6-slab").problem
LOOP = ss.load_scenario("fig4-loop")


def test_the_first_event_depends_on_no_choice_and_every_rule_agrees() -> None:
    runs = {rule: ss.simulate(replace(FIG6, selection=rule), 12.0) for rule in SELECTION_RULES}
    for solution in runs.values():
        found = solution.rule_influence
        assert (found.regime, found.shocks.tolist(), found.since) == ("irregular", [False, False], None)
        assert "this run depends on the rule; it decided none of the 2 shocks" in solution.selection_note
        assert float(solution.slip(12.0)) == pytest.approx(23.4402332474, rel=1e-10, abs=0)


@pytest.mark.parametrize("rule", SELECTION_RULES)
def test_the_loop_depends_on_the_rule(rule: str) -> None:
    """The load grows from 60 MPa by G V/h: it is between the folds once it has passed 64.47 MPa."""
    solution = ss.simulate(replace(LOOP.problem, selection=rule), LOOP.duration)
    found = solution.rule_influence
    assert found.rule == rule
    assert found.shocks.tolist() == [True, True]
    growth = SLAB.stiffness * LOOP.problem.pull_rate
    assert found.since == pytest.approx((64_471_887.242 - 60e6) / growth, rel=1e-9, abs=0)


def test_the_first_choice_is_found_within_a_leap_of_centuries() -> None:
    """maximal leaves stick as soon as it may: that is when the load first is between the folds."""
    runs = {rule: ss.simulate(replace(FIG6, selection=rule), 480 * ss.YEAR) for rule in ("perfect-delay", "maximal")}
    second = float(runs["maximal"].events.start[1])
    for solution in runs.values():
        assert solution.rule_influence.since == pytest.approx(second, rel=1e-9, abs=0)
    shocks = runs["perfect-delay"].rule_influence.shocks
    assert shocks.tolist()[:3] == [False, False, True]
    assert "between the folds first at 378.262 years" in runs["maximal"].selection_note


def test_a_window_of_a_third_of_a_millipascal_is_not_overlooked() -> None:
    critical = ss.load_scenario("fig7-slab-critical").problem
    solution = ss.simulate(critical, 93_886.0)
    found = solution.rule_influence
    assert found.since is not None
    (low, high), excess = ss.uniqueness(critical).window, float(solution.load(found.since)) - critical.strength
    assert low - 3e-8 <= excess <= high + 3e-8
    before = solution.load(np.linspace(6.0, found.since - 1e-6, 1001)) - critical.strength
    assert not np.any((before > low + 3e-8) & (before < high - 3e-8))


def test_a_unique_rate_leaves_no_choice() -> None:
    for problem in (
        replace(FIG6, body=replace(SLAB, contact_mass=1e6)),
        replace(FIG6, friction=replace(FIG6.friction, alpha=0.1)),
        ss.load_scenario("fig5-slab-reconstructed").problem,
    ):
        solution = ss.simulate(problem, 3.0)
        found = solution.rule_influence
        assert (found.regime, found.since, found.shocks.any()) == ("regular", None, np.False_)
        assert solution.selection_note.endswith("without effect, the solution is unique")


def test_a_run_without_shocks_has_decided_none() -> None:
    note = RuleInfluence("maxwell", "irregular", np.zeros(0, bool)).note
    assert note.endswith("no shock occurred: the load was never between the folds")
    assert "0" not in note
