"""What is not of the right type is refused in one line that says where, what was given, and what is allowed."""

from __future__ import annotations

import copy
import inspect
import math
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.run.study import Study
from tests.messages import places_twice

SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
PROBLEM = ss.Problem(SLAB, LAW, pull_rate=1.0, initial_excess=0.0)
LINE = ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.7, 0.5, 0.4), initial_load=6e7)


def refused(call: Callable[[], Any], message: str) -> None:
    """Check that a call is refused with a message of one line that begins like this."""
    with pytest.raises(ss.InputError) as caught:
        call()
    text = str(caught.value)
    assert text.startswith(message), text
    assert not places_twice(text), text
    assert "\n" not in text
    assert len(text) < 300


NO_PROBLEM = [
    (SLAB, "got ElasticSlab"),
    (None, "got None"),
    (ss.Problem, "got the class Problem, not an instance of it: call it"),
]
NO_SCENARIO = [
    ("x", "got 'x'; a bundled scenario has one: ss.scenarios[name].problem"),
    (ss.load_scenario("cycles-block"), "got Scenario; take its .problem"),
]
TAKE_A_SCENARIO: dict[str, Callable[[Any], Any]] = {
    "simulate": lambda problem: ss.simulate(problem, 1.0),
    "catalogue": lambda problem: ss.catalogue(problem, 1.0),
    "uniqueness": lambda problem: ss.uniqueness(problem),
    "ensemble": lambda problem: ss.studies.ensemble(problem, 1.0),
    "schemes": lambda problem: ss.studies.schemes(problem, 1.0),
    "infer": lambda problem: ss.studies.infer(problem, {}, ["alpha"]),
    "analogy": lambda problem: ss.studies.analogy(problem, 1.0, None, None),  # type: ignore[arg-type] # refused before
}
TAKE_A_PROBLEM: dict[str, Callable[[Any], Any]] = {
    "critical_value": lambda problem: ss.studies.critical_value(problem, "alpha"),
}


@pytest.mark.parametrize("name", [*TAKE_A_PROBLEM, *TAKE_A_SCENARIO])
@pytest.mark.parametrize(("given", "shown"), NO_PROBLEM, ids=lambda one: getattr(one, "__name__", None))
def test_other_types_than_problems_are_refused(name: str, given: Any, shown: str) -> None:
    take = TAKE_A_PROBLEM | TAKE_A_SCENARIO
    wanted = "a Problem, a scenario, or the name of one" if name in TAKE_A_SCENARIO else "a Problem"
    refused(lambda: take[name](given), f"{name}: problem must be {wanted}, {shown}")


@pytest.mark.parametrize("name", TAKE_A_PROBLEM)
@pytest.mark.parametrize(("given", "shown"), NO_SCENARIO, ids=("name", "scenario"))
def test_scenarios_are_refused_where_they_mean_nothing(name: str, given: Any, shown: str) -> None:
    refused(lambda: TAKE_A_PROBLEM[name](given), f"{name}: problem must be a Problem, {shown}")


@pytest.mark.parametrize("name", TAKE_A_SCENARIO)
def test_names_of_no_scenario_are_refused_with_the_nearest(name: str) -> None:
    refused(
        lambda: TAKE_A_SCENARIO[name]("fig6-slap"), "fig6-slap: no such file, and no bundled scenario of that name; did you mean"
    )
    refused(
        lambda: TAKE_A_SCENARIO[name](Path("lost.toml")), "lost.toml: no such file, and no bundled scenario of that name; `stick"
    )


def test_a_problem_needs_a_duration_and_a_scenario_has_one() -> None:
    for run in (ss.simulate, ss.catalogue):
        refused(lambda run=run: run(PROBLEM), f"{run.__name__}: duration {A_TIME}None")  # type: ignore[misc]
    assert ss.simulate("cycles-block").duration == ss.scenarios["cycles-block"].duration


NO_NUMBER = [
    ("10", "'10': write a number without quotes"),
    (True, "True"),
    (float, "the class float"),
    ([1.0], "[1.0]"),
    (1j, "complex"),
]
"""What is no number, and how messages show it."""
A_TIME = 'must be a number in s or a text with a unit such as "10 s", got '
OPTIONS: list[tuple[str, Any, str]] = [
    *(
        ("duration", given, A_TIME + shown)
        for given, shown in [*NO_NUMBER, (None, "None"), ("10 m", "'10 m': 'm' does not convert to s")]
    ),
    ("duration", math.nan, "must be finite, got nan"),
    ("duration", 0, "must be greater than 0 s, got 0"),
    ("duration", "-1 year", "must be greater than 0 s, got -3.15576e+07 (from '-1 year')"),
    ("duration", 1e51, "must lie within 1e+50 s, got 1e+51"),
    *(("rtol", given, f"must be a number, got {shown}") for given, shown in NO_NUMBER),
    ("rtol", math.nan, "must be finite, got nan"),
    ("rtol", 0, "must be at least 1e-15 (a pure number), got 0"),
    ("rtol", 0.1, "must be at most 0.01 (a pure number), got 0.1"),
    *(("creep_rtol", given, f"must be a number, got {shown}") for given, shown in NO_NUMBER),
    ("creep_rtol", math.nan, "must be finite, got nan"),
    ("creep_rtol", 0.1, "must be 0 (no leaps over creep, every round trip is run) or at most 0.01, got 0.1"),
    *(("shortest_event", given, A_TIME + shown) for given, shown in NO_NUMBER),
    ("shortest_event", math.nan, "must be finite, got nan"),
    ("shortest_event", "1 min", "must be 0 or at most 0.0571429 s (1 % of the two-way travel time), got 60 s"),
    *(("max_events", given, f"must be a whole number above 0, got {given!r}") for given in ("3", True, 0, -1, 2.0, math.nan)),
    *(("max_pieces", given, f"must be a whole number above 0, got {given!r}") for given in ("3", True, 0, 1e6)),
    ("max_pieces", 10**10, "must be below 1e+09, got 10000000000"),
    ("checkpoint_every", "often", 'must be a number in s or a text with a unit such as "10 s" (or "inf"), got \'often\''),
    ("checkpoint_every", -1, "must be at least 0 s, got -1"),
    ("checkpoint_every", math.nan, "must be finite, got nan"),
    ("progress", "loud", "must be True or a function, got 'loud'"),
]


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("run", [ss.simulate, ss.catalogue])
@pytest.mark.parametrize(("name", "given", "message"), OPTIONS)
def test_options_of_a_run_are_checked(run: Callable[..., Any], name: str, given: Any, message: str) -> None:
    options = {"duration": 1.0} | {name: given}
    refused(lambda: run(PROBLEM, **options), f"{run.__name__}: {name} {message}")


def test_whole_numbers_of_numpy_are_whole_numbers() -> None:
    run = ss.simulate(PROBLEM, 1e3, max_events=np.int64(1))
    assert run.status.name == "enough events"
    assert type(run.max_events) is int


def test_files_are_named_by_texts_or_paths(tmp_path: Path) -> None:
    run = ss.simulate(PROBLEM, 1.0)
    refused(lambda: ss.load_scenario(3), "load_scenario: path_or_name must be the name of a file or of a bundled scenario, got 3")  # type: ignore[arg-type]
    refused(lambda: ss.load_scenario(PROBLEM), "load_scenario: path_or_name must be")  # type: ignore[arg-type]
    refused(lambda: ss.open_solution(3), "open_solution: path must be the name of a file, got 3")  # type: ignore[arg-type]
    refused(lambda: ss.resume(None), "resume: path must be the name of a file, got None")  # type: ignore[arg-type]
    refused(lambda: run.to_netcdf(3), "to_netcdf: path must be the name of a file, got 3")  # type: ignore[arg-type]
    refused(lambda: ss.simulate(PROBLEM, 1.0, checkpoint=3), "simulate: checkpoint must be the name of a file, got 3")  # type: ignore[arg-type]
    refused(lambda: ss.catalogue(PROBLEM, 1.0, 3), "catalogue: path must be the name of a file, got 3")  # type: ignore[arg-type]
    run.to_netcdf(tmp_path / "run.nc")
    refused(lambda: ss.resume(tmp_path / "run.nc", "10"), f"resume: duration {A_TIME}'10'")
    refused(lambda: ss.resume(tmp_path / "run.nc", checkpoint=3), "resume: checkpoint must be the name of a file, got 3")  # type: ignore[arg-type]


NO_BODY = (
    "Problem: body must be SpringBlock or ElasticSlab or SoilColumn or LayeredSlab or TwoSlabs or RotatingBlock or BlockOnBelt or"
    " BlockOnDisc or PositionLoop or RotaryLoop or TorsionalString or SectionedString, got "
)
NO_LAW = 'Problem: friction must be a friction law, a function of u and v, or a text such as "0.3 + 0.5/(1 + v)", got '
EXCESS = "Problem: initial_excess must be "
A_STRESS = 'a number in Pa or a text with a unit such as "10 Pa", got '
PULL = 'Problem: pull_rate must be a number in m/s or a text with a unit such as "10 m/s", got '
HISTORY = "; what varies in time is one of stickslip.loading, such as Steps("
PROBLEMS: list[tuple[tuple[Any, ...], dict[str, Any], str]] = [
    ((LAW, SLAB), {}, "Problem: body comes first, then friction: got HyperbolicRate as body and ElasticSlab as friction"),
    ((ss.ElasticSlab, LAW), {}, NO_BODY + "the class ElasticSlab, not an instance of it: call it"),
    ((None, LAW), {}, NO_BODY + "None"),
    ((SLAB, ss.friction.Coulomb), {}, NO_LAW + "the class Coulomb, not an instance of it: call it with its parameters, Coulomb("),
    ((SLAB, None), {}, NO_LAW + "None"),
    ((SLAB, 3), {}, NO_LAW + "3"),
    ((SLAB, [0.6, 0.5]), {}, NO_LAW + "[0.6, 0.5]"),
    ((SLAB, "coulomb"), {}, "Problem: friction: 'coulomb' is not a formula; the laws of the package are classes"),
    ((SLAB, LAW), {"initial_excess": "0"}, f"{EXCESS}{A_STRESS}'0'"),
    ((SLAB, LAW), {"initial_excess": True}, f"{EXCESS}{A_STRESS}True"),
    ((SLAB, LAW), {"initial_excess": math.nan}, EXCESS + "finite, got nan"),
    ((SLAB, LAW), {"initial_excess": None}, "Problem: needs either initial_load or initial_excess"),
    ((SLAB, LAW), {"initial_excess": 0.0, "pull_rate": "fast"}, f"{PULL}'fast'{HISTORY}"),
    ((SLAB, LAW), {"initial_excess": 0.0, "pull_rate": None}, f"{PULL}None{HISTORY}"),
    ((SLAB, LAW), {"initial_excess": 0.0, "pull_rate": [1.0]}, f"{PULL}[1.0]{HISTORY}"),
    ((SLAB, LAW), {"initial_excess": 0.0, "pull_rate": "1 m"}, f"{PULL}'1 m': 'm' does not convert to m/s{HISTORY}"),
    ((SLAB, LAW), {"initial_excess": 0.0, "pull_rate": math.nan}, "Problem: pull_rate must be finite, got nan"),
    (
        (SLAB, LAW),
        {"initial_excess": 0.0, "initial_slip": None},
        'Problem: initial_slip must be a number in m or a text with a unit such as "10 m", got None',
    ),
    ((SLAB, LAW), {"initial_excess": 0.0, "selection": 3}, "Problem: selection must be a name or a function (g, stable), got int"),
]


@pytest.mark.parametrize(("arguments", "named", "message"), PROBLEMS)
def test_problems_are_checked(arguments: tuple[Any, ...], named: dict[str, Any], message: str) -> None:
    refused(lambda: ss.Problem(*arguments, **named), message)


@pytest.mark.parametrize(("given", "shown"), [*NO_NUMBER, (None, "None")])
def test_numbers_of_bodies_and_laws_are_checked(given: Any, shown: str) -> None:
    where = "Coulomb: static must be a number, got"
    refused(lambda: ss.friction.Coulomb(static=given, dynamic=0.3), f"{where} {shown}")
    where = 'ElasticSlab: density must be a number in kg/m^3 or a text with a unit such as "10 kg/m^3", got'
    refused(lambda: ss.ElasticSlab(given, wave_speed=3500, thickness=1e4, normal_stress=1e8), f"{where} {shown}")


def test_studies_of_one_run_are_checked() -> None:
    refused(lambda: ss.studies.predictability("run.nc"), "predictability: needs a Solution, got 'run.nc'")  # type: ignore[arg-type]
    refused(lambda: ss.studies.catalogue_statistics(PROBLEM), "catalogue_statistics: table must be a table of slip events")  # type: ignore[arg-type]
    refused(lambda: ss.studies.compare("fig6-slab", 3), "compare: problem must be a Problem, a scenario, or the name of one, got 3")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: ss.ElasticSlab(2800, wavespeed=3500, thickness=1e4, normal_stress=1e8),  # type: ignore[call-arg]
            "ElasticSlab: unknown argument 'wavespeed'; did you mean 'wave_speed'?",
        ),
        (lambda: ss.ElasticSlab(2800, 3500), "ElasticSlab: thickness, normal_stress must be given"),  # type: ignore[call-arg]
        (lambda: ss.SpringBlock(*range(1, 12)), "SpringBlock: takes at most"),  # type: ignore[arg-type]
        (
            lambda: ss.friction.Coulomb(statik=0.8, dynamic=0.3),  # type: ignore[call-arg]
            "Coulomb: unknown argument 'statik'; did you mean 'static'?",
        ),
        (lambda: ss.Problem(SLAB, LAW, pullrate=1.0), "Problem: unknown argument 'pullrate'; did you mean"),  # type: ignore[call-arg]
        (lambda: ss.loading.Steps(time=(0.0,)), "Steps: unknown argument 'time'; did you mean 'times'?"),  # type: ignore[call-arg]
        (lambda: ss.friction.Coulomb("80%", 0.3), "Coulomb: static must be a number, got '80%'; write 0.8"),  # type: ignore[arg-type]
    ],
)
def test_arguments_that_a_class_does_not_have_are_refused(call: Callable[[], Any], message: str) -> None:
    refused(call, message)


PUBLIC = {
    f"{module.__name__}.{name}": getattr(module, name)
    for module in (ss, ss.friction, ss.studies, ss.loading, ss.figures)
    for name in module.__all__
    if callable(getattr(module, name))
}
"""What users call, by name."""
MADE_BY_RUNS = (ss.Solution, ss.friction.Fit, ss.friction.Smooth, Study)
"""Results, which nobody makes by hand."""


def takes_arguments(one: Any) -> bool:
    if not isinstance(one, type):
        return True
    return not issubclass(one, (tuple, Exception, *MADE_BY_RUNS)) and not inspect.isabstract(one)


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("name", [name for name, one in PUBLIC.items() if takes_arguments(one)])
def test_everything_public_refuses_wrong_and_missing_arguments_in_one_line(name: str) -> None:
    call, who = PUBLIC[name], PUBLIC[name].__name__
    taken = inspect.signature(call).parameters.values()
    if not any(one.kind is one.VAR_KEYWORD for one in taken):
        refused(lambda: call(nonsense=1), f"{who}: unknown argument 'nonsense'; ")
        with pytest.raises(TypeError):  # Python's own error, too
            call(nonsense=1)
    several = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    needed = [one.name for one in taken if one.default is one.empty and one.kind not in several]
    if needed:
        refused(lambda: call(), f"{who}: {', '.join(needed)} must be given")


def test_copies_and_pickles_of_checked_objects_are_equal() -> None:
    for one in (PROBLEM, SLAB, LAW, ss.scenarios["fig6-slab"], ss.loading.Steps([0.0, 1.0], [1.0, 2.0])):
        assert copy.copy(one) == copy.deepcopy(one) == pickle.loads(pickle.dumps(one)) == one


@pytest.mark.parametrize(
    ("owner", "attribute", "hint"),
    [
        (PROBLEM, "pullrate", "Problem has no attribute 'pullrate'; did you mean 'pull_rate'?"),
        (LAW, "alfa", "HyperbolicRate has no attribute 'alfa'; did you mean 'alpha'?"),
        (ss.simulate(PROBLEM, 1.0), "plott", "Solution has no attribute 'plott'; did you mean 'plot'?"),
        (ss.simulate(PROBLEM, 1.0), "velocity", "Solution has no attribute 'velocity'; did you mean 'slip_rate'?"),
        (ss.simulate(PROBLEM, 1.0), "zzz", "Solution has no attribute 'zzz'; it has "),
        (ss.PlanarSlab(LINE, nodes=8, length=1e4), "node", "PlanarSlab has no attribute 'node'; did you mean 'nodes'?"),
    ],
)
def test_an_attribute_that_is_not_there_is_answered_with_those_that_are(owner: Any, attribute: str, hint: str) -> None:
    with pytest.raises(AttributeError) as caught:
        getattr(owner, attribute)
    assert str(caught.value).startswith(hint)
    assert not hasattr(owner, attribute)


@pytest.mark.parametrize("name", ["initial_load", "inital_load"])
def test_a_problem_refuses_to_be_changed(name: str) -> None:
    problem = ss.scenarios["fig6-slab"].problem
    with pytest.raises(FrozenInstanceError, match=f"cannot assign to field '{name}'"):
        setattr(problem, name, 1.0)


def test_an_error_in_a_property_is_not_hidden_by_the_hint() -> None:
    class Odd(type(SLAB)):  # type: ignore[misc]
        @property
        def broken(self) -> float:
            return self.density.missing  # type: ignore[no-any-return]

    odd = Odd(2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
    with pytest.raises(AttributeError, match="'float' object has no attribute 'missing'"):
        _ = odd.broken


TWO_STATES = ss.friction.FromExpression("0.6 + z + y", {"d": 1e-5}, evolution="dz/dt = -v*z/d; dy/dt = -y*v/d")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ss.studies.ranking(), "ranking: needs inferences, as in ranking(infer(..., held_out=0.3),"),
        (lambda: ss.studies.ranking([3]), "ranking: needs inferences"),
        (lambda: ss.studies.Record([0.0], [1.0]), "Record: measured must be a mapping of arrays by name (friction, "),
        (lambda: ss.studies.schemes("fig6-slab", cells="20"), "schemes: cells must be a whole number from 12 to 100000, got '20'"),
        (
            lambda: ss.Problem(ss.SpringBlock(1, 1, 1), TWO_STATES, initial_load=0, initial_state=(1, 2)),
            "Problem: initial_state must be one number, got (1, 2): each state has its own, initial_state and initial_second_state",
        ),
        (
            lambda: ss.PlanarSlab(LINE, nodes=8, length=1e4, along={"initial.load": ["60 m"] * 8}).values,
            "PlanarSlab: along initial.load must be a number in Pa or a text with a unit",
        ),
    ],
)
def test_clumsy_calls_are_told_what_is_wanted(call: Callable[[], Any], message: str) -> None:
    refused(call, message)


def test_values_along_a_contact_may_have_units() -> None:
    given = ["60 MPa"] * 7 + [7e7]
    for along in (given, lambda y: given):
        slab = ss.PlanarSlab(LINE, nodes=8, length=1e4, along={"load": along})
        assert slab.values.load.tolist() == [6e7] * 7 + [7e7]


def test_times_may_have_units() -> None:
    run = ss.simulate(PROBLEM, 1.0)
    assert float(run.slip("500 ms")) == float(run.slip(0.5))
    assert run.slip(["0.1 s", 0.2]).tolist() == run.slip([0.1, 0.2]).tolist()
    refused(lambda: run.slip("three"), "solution: time must be a number in s or a text with a unit such as \"10 s\", got 'three'")
    refused(lambda: run.slip([1, [2, 3]]), "solution: times must be numbers in s")  # type: ignore[list-item]
