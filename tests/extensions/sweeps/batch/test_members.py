"""Members of a batch are what `simulate` makes of them, whoever runs beside them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from stickslip.engine.lanes.workspace import Workspace, new_workspace
from stickslip.extensions.sweeps.batch import QUANTITIES, long_member, run, run_members
from stickslip.foundation.errors import InputError
from stickslip.problem.run_codes import BAD_PARAMETERS, FULL_HISTORY, INTERRUPTED, Stop
from stickslip.problem.run_status import STATUSES
from stickslip.problem.scenarios.scenario import load_scenario
from stickslip.run.simulate import simulate

from .cases import CASES, SLAB, Case, by_solution, one

ROUNDING = {"rel": 2e-14, "abs": 1e-300}
"""Of numbers that a history is folded into in another order, or with fused products; the history itself is the same bit for bit."""
WHOLE = ("events", "pulses", "shocks", "arrested", "irregular", "branches", "end_time", "peak_rate")
"""Numbers that are the same bit for bit."""


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("name", CASES)
def test_members_equal_the_runs_of_simulate(name: str) -> None:
    case = CASES[name]
    values = case.values()
    members = run_members(case.scenario, values, QUANTITIES)
    assert members.reason == {}
    for n in range(len(members.status)):
        solution = simulate(one(case, values, n))
        assert STATUSES[members.status[n]] == solution.status
        expected = by_solution(solution)
        found = {name: column[n] for name, column in members.results.items()}
        assert {name: found[name] for name in WHOLE} == pytest.approx(
            {name: expected[name] for name in WHOLE}, rel=0, abs=0, nan_ok=True
        )
        strength = {"rel": 0.0, "abs": 4e-15 * solution.problem.strength}
        assert found.pop("first_traction_drop") == pytest.approx(expected.pop("first_traction_drop"), nan_ok=True, **strength)
        assert found.pop("sticking") == pytest.approx(expected.pop("sticking"), rel=0, abs=1e-14, nan_ok=True)  # 1 less slip
        assert found.pop("recurrence_cv") == pytest.approx(expected.pop("recurrence_cv"), rel=1e-12, abs=1e-14, nan_ok=True)
        assert found == pytest.approx(expected, nan_ok=True, **ROUNDING)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", ["rate", "slip", "driver", "linear block", "gauss"])
def test_results_do_not_depend_on_threads_order_or_other_members(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    case = CASES[name]
    values = case.values(203)
    alone = run_members(case.scenario, values, QUANTITIES)
    order = np.random.default_rng(5).permutation(203)
    monkeypatch.setattr(run, "CHUNK", 29)
    monkeypatch.setattr(run, "SMALLEST_CHUNK", 3)
    shuffled = run_members(case.scenario, {key: value[order] for key, value in values.items()}, QUANTITIES, threads=3)
    assert (alone.status[order] == shuffled.status).all()
    for quantity in QUANTITIES:
        assert alone.results[quantity][order].tobytes() == shuffled.results[quantity].tobytes(), quantity


@pytest.mark.sampled(every=13)
@pytest.mark.parametrize("name", CASES)
def test_results_do_not_depend_on_what_a_workspace_held_before(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    case = CASES[name]
    values = case.values()
    expected = run_members(case.scenario, values, QUANTITIES)

    def soiled() -> Workspace:
        work = new_workspace()
        for table in (work.table, work.store.pieces, work.echoes, work.turns, work.events):
            table.view(np.float64)[:] = math.nan
        work.known[:] = 1
        return work

    monkeypatch.setattr(run, "new_workspace", soiled)
    found = run_members(case.scenario, values, QUANTITIES)
    assert found.status.tolist() == expected.status.tolist()
    for quantity in QUANTITIES:
        assert found.results[quantity].tobytes() == expected.results[quantity].tobytes(), quantity


def test_each_quantity_comes_out_the_same_when_it_is_asked_for_alone() -> None:
    case = CASES["rate"]
    values = case.values()
    together = run_members(case.scenario, values, QUANTITIES)
    for quantity in QUANTITIES:
        (found,) = run_members(case.scenario, values, [quantity]).results.values()
        assert found.tobytes() == together.results[quantity].tobytes(), quantity


def test_bad_members_do_not_stop_others() -> None:
    case = CASES["coulomb"]
    static = np.array([0.6, 0.4, math.nan, 0.7, -1.0])
    members = run_members(case.scenario, {"friction.static": static}, ("slip", "events"), threads=2)
    assert members.status.tolist() == [Stop.FINISHED, BAD_PARAMETERS, BAD_PARAMETERS, Stop.FINISHED, BAD_PARAMETERS]
    assert np.isnan(members.results["slip"]).tolist() == [False, True, True, False, True]
    assert list(members.reason) == [1, 2, 4]
    assert members.reason[1] == "Coulomb: static must be at least dynamic, got static 0.4 < dynamic 0.5"
    assert members.reason[2] == "Coulomb: static must be finite, got nan"


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("friction.alpha", -1.0),
        ("body.thickness", 0.0),
        ("body.normal_stress", math.inf),
        ("initial.slip", math.nan),
        ("run.duration", 0.0),
        ("run.rtol", 0.1),
        ("run.rtol", 1e-16),
        ("friction.dynamic", -0.1),
    ],
)
def test_the_batch_refuses_what_a_member_refuses(key: str, value: float) -> None:
    case = Case(CASES["rate"].scenario, {key: (value, value)})
    with pytest.raises(InputError) as error:
        one(case, {key: np.array([value])}, 0)
    members = run_members(case.scenario, {key: np.array([value])}, ("slip",))
    assert members.status.tolist() == [BAD_PARAMETERS]
    assert members.reason == {0: str(error.value)}


def test_far_stress_needs_a_driver_that_gives_way() -> None:
    values = {"body.driver_impedance": np.array([math.inf, 5e6]), "loading.far_stress_rate": np.full(2, 1e5)}
    members = run_members(CASES["far stress"].scenario, values, ("slip",))
    assert members.status.tolist() == [BAD_PARAMETERS, Stop.FINISHED]
    assert "finite driver_impedance" in members.reason[0]
    values = {"body.driver_impedance": np.full(2, math.inf), "loading.far_stress_rate": np.array([0.0, 1e5])}
    beside = run_members(CASES["far stress"].scenario, values, ("slip",))
    assert beside.status.tolist() == [Stop.FINISHED, BAD_PARAMETERS]


def test_one_batch_mixes_drivers_and_contacts_of_every_kind() -> None:
    case = CASES["driver"]
    values = {
        "body.driver_impedance": np.array([math.inf, 5e6, 1e300, 0.0, math.inf]),
        "body.contact_mass": np.array([0.0, 0.0, 1e6, 1e6, 1e7]),
    }
    members = run_members(case.scenario, values, ("slip", "events"))
    for n in range(5):
        expected = by_solution(simulate(one(case, values, n)))
        assert members.results["events"][n] == expected["events"]
        assert members.results["slip"][n] == pytest.approx(expected["slip"], **ROUNDING)


def test_a_history_that_outgrows_the_store_is_reduced_along_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    case = Case(replace(CASES["coulomb block"].scenario, duration=2e5), {"friction.static": (0.55, 0.6)})
    values = case.values(2)
    whole = run_members(case.scenario, values, QUANTITIES)
    assert whole.results["events"].min() > 100
    calls = []
    original = long_member.run_alone
    monkeypatch.setattr(run, "LARGEST_CAPACITY", 512)
    monkeypatch.setattr(run, "run_alone", lambda *given: calls.append(given) or original(*given))
    folded = run_members(case.scenario, values, QUANTITIES)
    assert len(calls) == 2
    for quantity in QUANTITIES:
        assert folded.results[quantity] == pytest.approx(whole.results[quantity], nan_ok=True, rel=1e-12, abs=1e-12), quantity


def test_a_long_member_does_not_change_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = CASES["coulomb block"].scenario
    values = {"run.duration": np.array([1e3, 2e5, 1e3])}
    monkeypatch.setattr(run, "LARGEST_CAPACITY", 512)
    members = run_members(scenario, values, QUANTITIES)
    for quantity in QUANTITIES:
        first, _, last = members.results[quantity]
        assert np.float64(first).tobytes() == np.float64(last).tobytes()


def test_a_member_is_irregular_only_above_the_critical_value() -> None:
    alpha = SLAB.impedance / (SLAB.normal_stress * 0.5) * np.array([0.0, 1.0 - 1e-9, 1.0 + 1e-9])
    members = run_members(CASES["rate"].scenario, {"friction.alpha": alpha}, ("branches", "irregular"))
    assert members.results["branches"].tolist() == [1.0, 1.0, 1.0]
    assert members.results["irregular"].tolist() == [0.0, 0.0, 1.0]


def test_values_must_fit_together() -> None:
    scenario = CASES["rate"].scenario
    with pytest.raises(InputError, match="one-dimensional arrays of one length"):
        run_members(scenario, {"friction.alpha": np.ones(2), "friction.static": np.ones(3)}, ("slip",))
    with pytest.raises(InputError, match="not a plain number"):
        run_members(scenario, {"friction.beta": np.ones(2)}, ("slip",))
    with pytest.raises(InputError, match="did you mean 'slip'"):
        run_members(scenario, {"friction.alpha": np.ones(2)}, ("slipp",))


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("threads", [1, 2])
def test_long_members_run_after_all_others_or_are_left_for_later_with_the_same_bits(
    threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario, values = CASES["coulomb block"].scenario, {"run.duration": np.array([1e3, 2e5, 2e3, 1e5, 1e3])}
    done: list[str] = []
    chunk, alone = run._Batch.chunk, run.run_alone
    monkeypatch.setattr(run, "LARGEST_CAPACITY", 512)
    monkeypatch.setattr(run, "CHUNK", 2)
    monkeypatch.setattr(run, "SMALLEST_CHUNK", 1)
    monkeypatch.setattr(run._Batch, "chunk", lambda *given: (chunk(*given), done.append("chunk"))[0])
    monkeypatch.setattr(run, "run_alone", lambda *given: done.append("alone") or alone(*given))
    members = run_members(scenario, values, QUANTITIES, threads)
    assert done == ["chunk"] * (len(done) - 2) + ["alone", "alone"]
    assert (sorted(members.alone), members.later) == ([1, 3], [])
    assert sum(members.alone.values()) <= members.seconds
    others = run_members(scenario, values, QUANTITIES, threads, defer=True)
    assert (others.alone, others.later) == ({}, [1, 3])
    assert others.status.tolist() == [Stop.FINISHED, INTERRUPTED, Stop.FINISHED, INTERRUPTED, Stop.FINISHED]
    late = run_members(scenario, {"run.duration": values["run.duration"][others.later]}, QUANTITIES, threads)
    for quantity, column in others.results.items():
        assert np.isnan(column[others.later]).all() or quantity in ("irregular", "branches")
        column[others.later] = late.results[quantity]
        assert column.tobytes() == members.results[quantity].tobytes(), quantity


def test_a_storm_ends_before_nearly_every_piece_costs_a_clearing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each clearing frees half of what the one before freed: room for 3000 pieces would be cleared some 20 times."""
    cleared: list[int] = []
    clear = long_member.Folding.make_room

    def make_room(watch: long_member.Folding) -> bool:
        cleared.append(watch.run.length)
        return clear(watch)

    monkeypatch.setattr(run, "LARGEST_CAPACITY", 512)
    monkeypatch.setattr(long_member, "LARGEST_HISTORY", 3000)
    monkeypatch.setattr(long_member.Folding, "make_room", make_room)
    members = run_members(replace(load_scenario("fig6-slab"), duration=3e9), {"friction.alpha": np.array([0.2])}, ["events"])
    assert members.status.tolist() == [FULL_HISTORY]
    assert len(cleared) < 10
