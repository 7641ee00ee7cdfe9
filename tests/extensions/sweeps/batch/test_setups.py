"""Members set up together have the setups of each by itself."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.regime import regime_of
from stickslip.contact.rules.selection import OF_LEVELS
from stickslip.engine.input.limits import split_time, wait_for_creep
from stickslip.engine.input.prepare import prepare
from stickslip.engine.lanes.setups import set_up
from stickslip.engine.lanes.vectorised_problem import groups
from stickslip.engine.lanes.workspace import Setups
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Params
from stickslip.engine.state.workspace import counts_in, state_in
from stickslip.extensions.sweeps.batch import why_not
from stickslip.friction import LAWS
from stickslip.friction.formula.bounds import bends_one_way
from stickslip.problem.event_rate import default_event_rate
from stickslip.problem.scenarios.scenario import Scenario

from .cases import CASES, PULL, SLAB, Case, one

CODE = """
from dataclasses import replace
import numpy as np
from pathlib import Path
from stickslip.extensions.sweeps.batch import run_members
from tests.extensions.sweeps.batch.cases import CASES

def resident():
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

def run(members):
    scenario = replace(CASES["rate"].scenario, duration=11.4)
    run_members(scenario, {"friction.alpha": np.linspace(0.9, 1.1, members)}, ("slip", "events"), threads=2)
    return resident()

run(10_000), run(50_000)
print(run(50_000), run(200_000))
"""
BYTES_OF_A_MEMBER = 8 * (1 + 2 + 1)
"""What varies, two quantities, status."""


@pytest.mark.slow
def test_memory_grows_only_by_the_results_of_each_member() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    before, after = (int(word) for word in done.stdout.split())
    assert after - before < 150_000 * BYTES_OF_A_MEMBER + 12e6  # a history would take thousands of bytes a member


LEVEL = 4e-16
"""Of the strength: rounding of loads at the ends of branches."""


def row_of(table: at.Floats, n: int) -> at.Floats:
    """The row of a member; all have the same one where they do not differ."""
    return table[n if len(table) > 1 else 0]


def branch_of(setups: Setups, n: int) -> at.Floats:
    """The table of a member."""
    count = int(setups.branches[n])
    return row_of(setups.branch_table, n)[:count].T


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("name", CASES)
def test_setups_of_a_batch_equal_those_of_single_runs(name: str) -> None:
    case = CASES[name]
    drawn = case.values(12, seed=7)
    for _, places, values in groups(case.scenario, drawn):
        setups = set_up(case.scenario, values)
        for n, place in enumerate(places.tolist()):
            alone = one(case, drawn, place)
            problem = alone.problem
            setup, memory = prepare(problem, alone.rtol, alone.shortest_event)
            state, count = state_in(memory), counts_in(memory)
            wait_for_creep(count, problem, alone.creep_rtol)
            assert Params(row_of(setups.params, n)).stick_to == pytest.approx(
                setup.params.stick_to, rel=0, abs=LEVEL * problem.strength
            )
            others = [place for place in range(Params.total) if place != Params.places["stick_to"].first]
            assert np.array_equal(row_of(setups.params, n)[others], setup.params.numbers[others])
            assert np.array_equal(row_of(setups.constants, n), setup.constants)
            assert np.array_equal(row_of(setups.law, n), setup.law)
            assert np.array_equal(row_of(setups.first_load, n), setup.first_load)
            assert np.array_equal(setups.state, state.numbers)
            assert np.array_equal(setups.counts, count.numbers)
            assert setups.threshold[n] == default_event_rate(problem)
            assert setups.excess[n] == problem.excess
            assert (setups.last_trip[n], setups.last_phase[n]) == split_time(alone.duration, problem.round_trip_time)
            found = branch_of(setups, n)
            assert found[:2] == pytest.approx(setup.branches.T[:2], rel=1e-14, abs=0)
            assert found[2:] == pytest.approx(setup.branches.T[2:], rel=0, abs=LEVEL * problem.strength)


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("rule", OF_LEVELS)
@pytest.mark.parametrize("name", ["rate", "stribeck", "gauss", "power"])
def test_branches_of_a_batch_equal_those_of_the_contact_equation(name: str, rule: str) -> None:
    """Over many decades of what makes the contact irregular, and next to where it becomes so."""
    scenario = CASES[name].scenario
    scenario = replace(scenario, problem=replace(scenario.problem, selection=rule))
    key = "friction.alpha" if name == "rate" else "friction.rate"
    critical = ss.uniqueness(scenario.problem).critical_value
    assert critical is not None
    shares = np.concatenate((10.0 ** np.random.default_rng(2).uniform(-3, 3, 8), 1.0 + np.array([-1e-3, 1e-3, 1e-6, -1e-6])))
    case, values = Case(scenario, {}), {key: critical * shares}
    setups = set_up(scenario, values)
    assert {0.0, 1.0} == set(setups.irregular)
    for n in range(len(shares)):
        problem = one(case, values, n).problem
        setup = prepare(problem, scenario.rtol)[0]
        assert setups.irregular[n] == (regime_of(problem) == "irregular")
        assert branch_of(setups, n)[:2] == pytest.approx(setup.branches.T[:2], rel=1e-9, abs=0)
        assert branch_of(setups, n)[2:] == pytest.approx(setup.branches.T[2:], rel=0, abs=LEVEL * problem.strength)
        assert Params(row_of(setups.params, n)).stick_to == pytest.approx(
            setup.params.stick_to, rel=0, abs=LEVEL * problem.strength
        )


@pytest.mark.parametrize("kind", [kind for kind, law in LAWS.items() if law.many])
def test_laws_that_are_proven_to_bend_one_way_do(kind: str) -> None:
    law = CASES_OF_KIND[kind]
    rates = np.geomspace(1e-6, 1e3, 4001)
    mu = law.coefficient(0.1, rates)
    slope = np.diff(mu) / np.diff(rates)
    bends = np.diff(slope)
    slack = 1e-15 / np.diff(rates)[1:]
    one_way = bool((bends >= -4 * slack).all() or (bends <= 4 * slack).all())
    assert proven_to_bend_one_way(law) == one_way
    if kind in ("exponential-stribeck", "power-stribeck"):
        assert not proven_to_bend_one_way(replace(law, exponent=2.0))


def proven_to_bend_one_way(law: ss.friction.FrictionLaw, **ends: tuple[float, float]) -> bool:
    return all(bends_one_way(tree, law.numbers(i) | ends, (0.1, 0.1)) for i, tree in enumerate(law.trees()))


def test_members_of_a_batch_are_proven_to_bend_one_way_all_at_once() -> None:
    """Friction may fall with the slip rate, or rise, but not fall for some of the numbers and rise for others."""
    law = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
    assert proven_to_bend_one_way(law, static=(0.5, 0.9), dynamic=(0.1, 0.5), alpha=(1e-9, 1e9))
    assert proven_to_bend_one_way(law, static=(0.1, 0.5), dynamic=(0.5, 0.9), alpha=(1e-9, 1e9))
    assert not proven_to_bend_one_way(law, static=(0.2, 0.6))


CASES_OF_KIND = {case.scenario.problem.friction.kind: case.scenario.problem.friction for case in reversed(CASES.values())}


def test_every_vectorised_law_has_a_case() -> None:
    assert {kind for kind, law in LAWS.items() if law.many} == set(CASES_OF_KIND)


def test_why_not_names_what_a_batch_cannot_do() -> None:
    scenario = CASES["rate"].scenario
    assert why_not(scenario, ("friction.alpha", "body.thickness", "run.duration"), ("events",)) == ""
    assert "not one that a batch can keep" in why_not(scenario, ("friction.alpha",), ("horizon",))
    assert "not a plain number" in why_not(scenario, ("friction.alfa",), ("slip",))
    assert "exclude each other" in why_not(scenario, ("initial.load", "initial.excess"), ("slip",))
    assert "not until a number of events" in why_not(replace(scenario, max_events=3), ("friction.alpha",), ("slip",))
    assert "leap over creep" in why_not(replace(scenario, creep_rtol=1e-3), ("friction.alpha",), ("slip",))
    maxwell = replace(scenario, problem=replace(scenario.problem, selection="maxwell"))
    assert "maxwell" in why_not(maxwell, ("friction.alpha",), ("slip",))
    stribeck = CASES["stribeck"].scenario
    assert "without bound" in why_not(stribeck, ("friction.viscosity",), ("slip",))
    assert "not a plain number" in why_not(stribeck, ("friction.exponent",), ("slip",))


def test_why_not_names_laws_that_a_batch_cannot_run() -> None:
    law = ss.friction.VelocityStrengthening(0.6, 0.01)
    scenario = Scenario(ss.Problem(SLAB, law, PULL, initial_excess=0.0), 1.0)
    assert why_not(scenario, ("friction.a",), ("slip",)) == "VelocityStrengthening is not made of plain numbers alone"
    heals = ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1, memory="since-arrest")
    scenario = Scenario(ss.Problem(SLAB, heals, PULL, initial_excess=0.0), 1.0)
    assert "memory 'since-arrest'" in why_not(scenario, ("friction.static",), ("slip",))


def test_loads_within_rounding_of_the_strength_become_the_strength() -> None:
    scenario = CASES["rate"].scenario
    strength = scenario.problem.strength
    ulp = float(np.spacing(strength))
    load = np.array([sign * strength + n * ulp for sign in (1, -1) for n in (-5, -4, -1, 0, 1, 4, 5)] + [0.0, 8.5e7])
    setups = set_up(scenario, {"initial.load": load})
    alone = [one(Case(scenario, {}), {"initial.load": load}, n).problem.excess for n in range(len(load))]
    assert setups.excess.tolist() == alone
    assert {0.0, -2.0 * strength} < set(alone)
    assert len(set(alone)) == 8
