"""A member of a sweep is the run of its own scenario, to the last digit; what fails is recorded and stops nobody."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.sweeps.design.quantities import QUANTITIES, quantities_named
from stickslip.extensions.sweeps.execution.chunk import (
    BAD_PARAMETERS,
    ERROR,
    MEANINGS,
    NOT_RUN,
    ChunkResult,
    Work,
    one_by_one,
    run_chunk,
)
from stickslip.extensions.sweeps.execution.plan import make_plan
from stickslip.extensions.sweeps.results.store import ResultStore
from stickslip.extensions.sweeps.sweep import SweepProgress, Tally
from stickslip.problem.scenarios.scenario import load_scenario, read_scenario
from stickslip.solution.observables.energy.balance import energy
from stickslip.solution.observables.severity import severity
from tests.extensions.sweeps.batch.cases import sticking
from tests.messages import refused

PULSES = load_scenario("fig5-slab-reconstructed")
RATE = load_scenario("fig6-slab")


def test_a_member_is_its_own_scenario() -> None:
    dataset = ss.sweep(
        PULSES,
        {"body.thickness": np.linspace(5e3, 20e3, 3), "initial.excess": [0.0, 1e4]},
        quantities=["slip", "pulses", "peak_rate"],
    )
    for thickness in (5e3, 20e3):
        body, at = replace(PULSES.problem.body, thickness=thickness), {"body.thickness": thickness, "initial.excess": 1e4}  # type: ignore[type-var]
        problem = replace(PULSES.problem, body=body, initial_excess=1e4, initial_load=None)
        alone = ss.simulate(problem, PULSES.duration, PULSES.rtol)
        found = dataset.sel(at)
        end = float(alone.slip(PULSES.duration))
        assert float(found.slip) == pytest.approx(end - problem.initial_slip, rel=0, abs=np.spacing(end))  # rounding of the sum
        assert float(found.pulses) == alone.events.pulses.sum() > 0
        assert float(found.peak_rate) == alone.events.peak_rate.max()


def test_a_problem_is_varied_as_its_scenario_is() -> None:
    vary = {"friction.alpha": np.array([0.1, 1.0]), "run.selection": ["minimal", "maxwell"]}
    mine, bundled = ss.sweep(RATE.problem, vary, duration=RATE.duration), ss.sweep(RATE, vary)
    for name in ("events", "slip", "peak_rate", "status"):
        assert mine[name].values.tobytes() == bundled[name].values.tobytes(), name


def rule(branches: object) -> object:
    return branches


@pytest.mark.parametrize(
    ("scenario", "duration", "said"),
    [
        (RATE.problem, None, "sweep: a Problem needs a duration (s)"),
        (RATE.problem, -1.0, "sweep: duration must be"),
        (RATE, 5.0, "sweep: duration belongs to a Problem"),
        (replace(RATE.problem, selection=rule), 5.0, "problem: [run] selection"),
    ],
)
def test_a_sweep_without_duration_or_scenario_is_refused_in_one_line(scenario: Any, duration: float | None, said: str) -> None:
    with refused(begins=said):
        ss.sweep(scenario, {"friction.alpha": [0.1, 1.0]}, duration=duration)


def test_keys_of_every_table_are_put_in_their_place() -> None:
    vary: dict[str, Any] = {
        "body.density": 2000.0,
        "loading.pull_rate": 1e-9,
        "initial.load": 7e7,
        "run.rtol": 1e-7,
        "run.duration": 3.0,
    }
    plan = make_plan(RATE, {key: [value] for key, value in vary.items()} | {"run.selection": ["maxwell"], "run.events": [4]})
    member = plan.work.member(vary | {"run.selection": "maxwell", "run.events": 4.0})
    problem = member.problem
    assert (problem.body.density, problem.pull_rate, problem.initial_load, problem.initial_excess) == (2000.0, 1e-9, 7e7, None)  # type: ignore[union-attr]
    assert (member.rtol, member.duration, member.max_events, problem.rule) == (1e-7, 3.0, 4, "maxwell")
    assert problem.friction == RATE.problem.friction


def test_a_parameter_of_an_expression_keeps_its_unit() -> None:
    scenario = load_scenario("block-or-slab")
    member = make_plan(scenario, {"wavelength": ["1 km", "3 m"]}).work.member({"friction.parameters.wavelength": 1e3})
    by_hand = read_scenario(scenario.to_toml().replace('"41.6 m"', '"1000.0 m"'), "by hand")
    assert member.problem.friction == by_hand.problem.friction != scenario.problem.friction


@pytest.mark.parametrize("name", ["cycles-block", "cycles-slab"])
def test_quantities_are_those_of_the_solution(name: str) -> None:
    scenario = load_scenario(name)
    solution = ss.simulate(scenario)
    events, between = solution.events, np.diff(solution.events.start)
    parts = energy(solution.history, scenario.duration)
    of_run = {
        "events": len(events),
        "pulses": events.pulses.sum(),
        "shocks": len(solution.shocks),
        "slip": float(solution.slip(scenario.duration)) - scenario.problem.initial_slip,
        "peak_rate": events.peak_rate.max(),
        "peak_time": events.peak_time[events.peak_rate.argmax()],
        "recurrence": between.mean(),
        "recurrence_cv": between.std(ddof=1) / between.mean(),
        "end_time": scenario.duration,
        "arrested": float(solution.slip_rate(scenario.duration) == 0.0),
        "sticking": sticking(solution),
        "severity": severity(solution),
        "irregular": 0.0,
        "branches": 1,
    }
    first = {f"first_{name}": events[name][0] for name in ("start", "end", "duration", "slip", "traction_drop", "static_drop")}
    energies = {name: parts[name].item() for name in ("work", "heat", "damped", "radiated", "trapped", "balance")}
    assert len(events) > 3
    assert 0.5 < of_run["sticking"] < 1.0
    assert set(of_run | first | energies) == set(QUANTITIES)
    for name, wanted in (of_run | first | energies).items():
        assert QUANTITIES[name].value(solution) == pytest.approx(wanted, rel=1e-9, abs=1e-12), name
    batch = ss.sweep(scenario, {"run.duration": [scenario.duration]}, quantities=["sticking"])
    assert batch.sticking.item() == pytest.approx(of_run["sticking"], rel=1e-9, abs=1e-12)


def test_two_times_between_events_have_a_scatter_and_one_has_none() -> None:
    scenario = load_scenario("cycles-block")
    for events, known in ((3, True), (2, False)):
        found = QUANTITIES["recurrence_cv"].value(ss.simulate(scenario, max_events=events))
        assert np.isfinite(found) == known


def test_what_a_run_does_not_have_is_missing() -> None:
    quiet = ss.sweep(RATE, {"friction.dynamic": [0.79]}, quantities=QUANTITIES)
    missing = {name for name in QUANTITIES if np.isnan(quiet[name].item())}
    assert quiet.events.item() == 0
    assert missing == {name for name in QUANTITIES if name.startswith(("first_", "peak_", "recurrence"))}


def test_units_follow_the_body() -> None:
    wanted = ["first_static_drop", "heat", "peak_rate", "events"]
    slab, block = (
        ss.sweep(one, {"run.duration": [1.0]}, quantities=wanted) for one in (PULSES, load_scenario("fig5-block-printed"))
    )
    assert [slab[name].units for name in wanted] == ["Pa", "J m-2", "m s-1", "1"]
    assert [block[name].units for name in wanted] == ["N", "J", "m s-1", "1"]
    assert slab["run.duration"].units == "s"


def pieces(solution: ss.Solution) -> int:
    return len(solution.history)


def test_users_may_define_a_quantity() -> None:
    dataset = ss.sweep(PULSES, {"thickness": ["5 km", "10 km"]}, quantities=["slip", ("pieces", "1", pieces)])
    assert dataset.pieces.values.tolist() == [
        pieces(ss.simulate(make_plan(PULSES, {"thickness": [1]}).work.member({"body.thickness": h}))) for h in (5e3, 10e3)
    ]
    assert dataset.pieces.attrs["units"] == "1"


def test_series_are_curves_at_the_same_times() -> None:
    dataset = ss.sweep(
        PULSES, {"run.duration": [2.0, 6.0]}, quantities="slip", series=["slip", "slip_rate", "traction"], samples=13
    )
    solution = ss.simulate(PULSES)
    time = dataset.time.values
    assert time.tolist() == np.linspace(0.0, 6.0, 13).tolist()
    assert dataset.series_slip.dims == ("run.duration", "time")
    assert dataset.series_slip_rate.values[1] == pytest.approx(solution.slip_rate(time), rel=1e-9, abs=1e-12)
    assert dataset.series_traction.values[1] == pytest.approx(solution.traction(time), rel=1e-9, abs=1e-3)
    assert np.isnan(dataset.series_slip.values[0]).tolist() == (time > 2.0).tolist()
    assert (dataset.series_slip.units, dataset.series_traction.units) == ("m", "Pa")


def failing(solution: ss.Solution) -> float:
    return 1.0 / math.floor(float(solution.problem.body.thickness) / 8e3)  # type: ignore[union-attr]


def test_failures_are_recorded_and_do_not_stop_others() -> None:
    """A far stress that grows needs another driver, though the number is fine by itself; the quantity of a thin slab fails."""
    vary = {"loading.far_stress_rate": [0.0, 1.0], "body.thickness": [5e3, 10e3]}
    dataset = ss.sweep(RATE, vary, quantities=["events", ("mine", "1", failing)])
    assert dataset.status.values.tolist() == [[ERROR, 0], [BAD_PARAMETERS, BAD_PARAMETERS]]
    assert dataset.reason.values[0, 0] == "ZeroDivisionError: float division by zero"
    assert dataset.reason.values[1, 1].endswith("far_stress and far_stress_rate need a slab with a finite driver_impedance")
    assert np.isfinite(dataset.mine.values).tolist() == [[False, True], [False, False]]
    assert np.isfinite(dataset.events.values).tolist() == [[False, True], [False, False]]
    assert dataset.reason.values[0, 1] == ""
    meanings = dict(zip(dataset.status.flag_values, dataset.status.flag_meanings.split(), strict=True))
    assert meanings == MEANINGS


def test_codes_in_stores_keep_their_meaning() -> None:
    """Stores and users' programs hold these numbers."""
    stopped = {10: "bad_parameters", 11: "event_storm", 12: "not_finite", 13: "too_many_pieces", 14: "error"}
    done = {-1: "not_run", 0: "finished", 1: "enough_events", 2: "locked_for_ever"}
    assert done | stopped | {15: "negative_friction", 16: "off_the_law"} == MEANINGS


def test_a_tally_counts_failures_and_names_the_slowest() -> None:
    told: list[SweepProgress] = []
    plan = make_plan(RATE, {"alpha": [0.5, 1.0, 2.0, 3.0]}, quantities="slip", chunk=2)
    tally = Tally(cast(ResultStore, SimpleNamespace(plan=plan, status=np.full(4, NOT_RUN))), told.append)
    tally.add(1, ChunkResult({}, np.array([BAD_PARAMETERS, 0], np.int8), seconds=3.0, alone={0: 1.0, 1: 2.0}))
    assert (told[-1].done, told[-1].failed, told[-1].seconds) == (2, 1, 3.0)
    assert list(tally.alone.items()) == [(3, 2.0), (2, 1.0)]


def test_a_run_that_does_not_reach_its_end_has_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.extensions.sweeps.execution.chunk.MAX_PIECES", 600)
    plan = make_plan(PULSES, {"thickness": [100, 10e3]}, quantities="slip")
    found = one_by_one(plan.work, plan.values(0))
    assert [MEANINGS[code] for code in found.status] == ["too_many_pieces", "finished"]
    assert found.reasons.keys() == {0}
    assert found.reasons[0].startswith("too many pieces at ")
    assert np.isfinite(found.results["slip"]).tolist() == [False, True]


def test_work_goes_to_other_processes() -> None:
    plan = make_plan(RATE, {"alpha": [0.1, 1]}, quantities=[*QUANTITIES, ("mine", "1", pieces)], series=["slip"], samples=3)
    there: Work = pickle.loads(pickle.dumps(plan.work))
    here, copied = run_chunk(plan.work, plan.values(0)), run_chunk(there, pickle.loads(pickle.dumps(plan.values(0))))
    assert there.names == plan.work.names
    assert pickle.loads(pickle.dumps(copied)).status.tolist() == [0, 0]
    for name in plan.work.names:
        assert here.results[name].tobytes() == copied.results[name].tobytes(), name


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ("event", "quantity 'event' is unknown; did you mean 'events'?"),
        (["events", "events"], "is given twice"),
        ([], "no quantity is given"),
        ([("mine", pieces)], "must be a name, or"),
        ([("mine", "1", 5)], "must be a name, or"),
    ],
)
def test_bad_quantities_are_refused_in_one_line(wanted: Any, said: str) -> None:
    with refused(said):
        quantities_named(wanted)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"series": ["slop"]}, "series 'slop' is unknown; did you mean 'slip'?"),
        ({"series": ["state"]}, "series 'state' is unknown"),
        ({"series": ["slip", "slip"]}, "given twice"),
        ({"series": ["slip"], "samples": 1}, "samples must be a whole number from 2"),
        ({"chunk": 0}, "chunk must be a whole number"),
        ({"threads": 0}, "threads must be a whole number"),
        ({"out": "map.nc"}, "the name must end in .zarr"),
        ({"out": "no/map.zarr"}, "there is no folder no"),
        ({"quantities": [("status", "1", pieces)]}, "quantity 'status': choose another name"),
        ({"quantities": [("slip", "m", pieces)]}, "quantity 'slip': choose another name"),
        ({"quantities": [("a/b", "m", pieces)]}, "quantity 'a/b': choose another name"),
    ],
)
def test_bad_arguments_are_refused_in_one_line(asked: dict[str, Any], said: str) -> None:
    with refused(said):
        ss.sweep(RATE, {"alpha": [0.1, 1]}, **asked)
