"""A run is judged by the numbers of its problem: an engine that solved another problem, or solved it wrongly, is noticed.

The right value of each measure is rounding; a wrong number by a permille shows in one of them at least.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.given_kinds import cases
from benchmarks.missed import missed_by_states, worst_of_states
from benchmarks.wrong_numbers import Place, measures, places_in, wrong_setup
from benchmarks.wrong_series import bent

import stickslip as ss
from stickslip.engine.input import prepare
from stickslip.foundation.errors import InputError
from stickslip.solution.observables.proof_of_load import load_compared
from stickslip.solution.observables.proof_of_rest import exceeded_at_rest
from stickslip.solution.observables.proof_of_run import ProofOfRun, proof_of_run
from stickslip.solution.observables.proof_of_slip import slip_joined
from stickslip.solution.observables.proof_of_states import states_proven

QUICK = ("block, normal load steps", "ageing, normal load swings", "driver changes", "shaken block", "rotating block", "machine")
CASES = cases()
KINDS = [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in CASES if name != "pipe-and-collar"]
NUMERICS = ("body.travel_time_error", "body.drag_step")
"""Numbers that decide how a problem is solved."""
AS_TIME = ("body.thickness", "body.length")
"""Numbers of a uniform body that are felt as its round trip alone, which is the unit of a history's times."""
UNFELT = {"lagged": ["friction.direct_rate"], "slab rests, normal load climbs": ["loading.normal_load.times[0]"]}
"""Numbers without effect: of a direct effect of 0, and of the first moment of a rest far below the strength."""


def shares(found: ProofOfRun, problem: ss.Problem) -> np.ndarray:
    """The measures as shares (1) of the normal load, or as they are."""
    loads = np.array([found.residual, found.load, found.rest]) / problem.normal
    return np.array([*loads, found.states, found.slip, found.rate])


@pytest.mark.parametrize("kind", KINDS)
def test_the_history_of_another_problem_is_noticed_whatever_the_number(kind: str) -> None:
    """Each number of a problem is made wrong by a permille, or 0 becomes 1e-3, and the run is judged as one of that problem."""
    problem, duration = CASES[kind]
    run = ss.simulate(problem, duration)
    right, unseen = shares(run.proven, problem), []
    for name, number in problem.parameters.items():
        if name in NUMERICS or (name in AS_TIME and problem.body.is_uniform) or not np.isfinite(number.value):
            continue
        if name == "initial.slip" and not problem.friction.depends_on_slip:
            continue
        if name == "body.backlash" and not problem.body.has_play:
            continue  # these springs stay taut on one side, and would not feel a play
        try:
            other = number.put(number.value * 1.001 if number.value else 1e-3)
        except InputError:  # the problem refuses it
            continue
        if other.body.has_machine != problem.body.has_machine:
            continue
        found = shares(proof_of_run(replace(run.history, problem=other)), problem)
        if not (found > 10.0 * np.maximum(right, 1e-13)).any():
            unseen.append(name)
    assert unseen == UNFELT.get(kind, [])


@pytest.mark.parametrize("backlash", [1.001e-2, 0.0])
def test_the_history_of_another_play_is_noticed(backlash: float) -> None:
    block = ss.SpringBlock(1.0, 100.0, 10.0, backlash=1e-2)
    problem = ss.Problem(block, ss.friction.Coulomb(0.5, 0.3), 0.01, initial_load=0.0)
    run = ss.simulate(problem, 20.0)
    right = shares(run.proven, problem)
    other = replace(problem, body=replace(block, backlash=backlash))
    assert (right < 1e-12).all()
    assert (shares(proof_of_run(replace(run.history, problem=other)), problem) > 1e-6).any()


@pytest.mark.parametrize("kind", KINDS)
def test_the_right_engine_misses_no_more_than_rounding(kind: str) -> None:
    """Loads are right to 1e-12 of the normal load, slip and its rate to 1e-13 of a metre; states to 1e-6 of themselves."""
    problem, duration = CASES[kind]
    found = ss.simulate(problem, duration).proven
    assert found.load < 1e-12 * problem.normal
    assert found.rest < 1e-14 * problem.normal
    assert max(found.slip, found.rate) < 1e-13
    assert found.states < 1e-6
    assert found.compared >= found.pieces - 1
    assert found.states_unproven == 0


WRONG = {
    "ageing, normal load steps": ("params.coupling", "states"),
    "machine": ("params.driver_inertia", "load"),
    "driver changes": ("loading.reflection", "load"),
    "shaken block": ("loading.tone", "load"),
}


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("kind", WRONG)
def test_an_engine_with_a_wrong_number_is_noticed_by_what_it_concerns(kind: str) -> None:
    """The number is wrong by a permille; the measure is a thousand times that of the right engine, and no other one is needed."""
    (problem, duration), (name, measure) = CASES[kind], WRONG[kind]
    with wrong_setup() as make_wrong:
        make_wrong(None, 0.0)
        right = measures(ss.simulate(problem, duration))[measure]
        places = [one for one in places_in(prepare.prepare(problem, 1e-10)[0]) if f"{one.table}.{one.field}" == name]
        make_wrong(places[-1], 1e-3)
        assert measures(ss.simulate(problem, duration))[measure] > 1e3 * right


def test_a_machine_behind_layers_is_noticed_though_the_energy_balances() -> None:
    """The motion of the machine is kept by the run, so that its energies balance whatever moves it."""
    problem, duration = CASES["machine behind layers"]
    with wrong_setup() as make_wrong:
        make_wrong(Place("params", "driver_gain", (list(type(prepare.parameters_of(problem)).places).index("driver_gain"),)), 1e-3)
        found = measures(ss.simulate(problem, duration))
    assert found["load"] > 1e-8
    assert found["energy"] < 1e-11


def test_no_state_misses_its_equation_by_more_than_is_said() -> None:
    """In 40 digits; of one of the laws at least more than a third of the bound is really missed."""
    missed = []
    for kind in ("ageing, normal load swings", "two states", "lagged"):
        run = ss.simulate(*CASES[kind])
        missed.append(worst_of_states(run) / run.proven.states)
    assert max(missed) <= 1.0
    assert max(missed) > 1.0 / 3.0


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("k", [0, 1, 6])
def test_a_state_that_evolves_wrongly_in_one_step_is_noticed(k: int) -> None:
    run = ss.simulate(*CASES["two states"])
    n = len(run.history) // 2
    wrong = bent(run.history, n, k, 1e-6, "state")
    size = np.abs(wrong.store.state[n, 0]).max() + 1.0
    assert states_proven(wrong).missed >= missed_by_states(wrong, n)[0] / (2.0 * size)
    assert states_proven(wrong).missed > 1e3 * run.proven.states


def test_a_load_that_is_bent_in_one_step_is_noticed_in_it() -> None:
    for kind in ("shaken block", "driver changes"):
        problem, duration = CASES[kind]
        run = ss.simulate(problem, duration)
        wrong = bent(run.history, len(run.history) // 2, 1, 1e-6, "load")
        assert load_compared(wrong).missed > 1e3 * run.proven.load


def test_rest_above_the_strength_and_slip_below_it_are_noticed() -> None:
    """The strength of Coulomb friction is taken to be 1e-6 higher, or lower, than that of the run."""
    problem = ss.Problem(ss.SpringBlock(1.0, 20.0, 10.0), ss.friction.Coulomb(0.6, 0.5), pull_rate=0.1, initial_load=5.0)
    run = ss.simulate(problem, 60.0)
    assert exceeded_at_rest(run.history) < 1e-13
    for static in (0.6 - 1e-6, 0.6 + 1e-6):
        other = replace(problem, friction=ss.friction.Coulomb(static, 0.5))
        store = run.history.store._replace(pieces=run.history.store.pieces.copy())
        store.load[:, 0] += problem.strength - other.strength
        assert exceeded_at_rest(replace(run.history, problem=other, store=store)) == pytest.approx(1e-5, rel=1e-3, abs=0.0)


def test_slips_that_do_not_join_are_noticed() -> None:
    history = ss.simulate(*CASES["shaken block"]).history
    n = int(np.flatnonzero(history.store.mode != 0)[2])
    for field, measure, by in (("slip", "slip", 1e-9), ("law_slip", "slip", 1e-9), ("rate", "rate", 1e-9)):
        store = history.store._replace(pieces=history.store.pieces.copy())
        where = getattr(store, field)
        where[n : n + 1].reshape(1, -1)[:, 0] += by
        found = slip_joined(replace(history, store=store))
        assert getattr(found, measure) == pytest.approx(by, rel=1e-3, abs=0.0)


def test_the_sentence_says_what_is_proven_and_what_is_compared() -> None:
    run = ss.simulate(*CASES["ageing, normal load swings"])
    text = run.proven.text
    assert "states obey their equations to" in text
    assert "loads follow from slip and loading to" in text
    assert "compared in all pieces" in text
    assert "only the energy balance covers" not in text
    assert "only the energy balance covers loads in the other pieces" in replace(run.proven, compared=3).text
