"""Every kind of body and of driver answers every question that any part of the program asks of kinds."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.disturbance import Response
from stickslip.engine import Positions
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS, DRIVER_KINDS
from stickslip.problem.bodies import BODIES
from stickslip.problem.drivers.driver import Driver
from stickslip.problem.loading import PiecewiseLinear, Steps
from stickslip.problem.scenarios import Scenario

PACKAGE = Path(ss.__file__).parent
LAW = ss.friction.FromExpression("0.6 - 0.1*u/(1 + u)")
SLAB: dict[str, Any] = {"density": 2800.0, "wave_speed": 3500.0, "thickness": 1e4, "normal_stress": 1e8}
RUN: dict[str, Any] = {"pull_rate": 0.3, "initial_excess": 1e6}
SLABS = {
    "rigid": ss.ElasticSlab(**SLAB),
    "lossy": ss.ElasticSlab(**SLAB, driver_impedance=3e6),
    "machine": ss.ElasticSlab(**SLAB, driver_impedance=3e6, driver_inertia=2e6),
}
COLUMN = ss.SoilColumn(**SLAB, damping_ratio=0.05)
PULLED = ss.Problem(ss.SpringBlock(1.0, 20.0, 10.0), LAW, pull_rate=0.3, initial_excess=0.1)
SHAKEN = PiecewiseLinear([0.0, 1.0, 2.0], [0.0, 0.1, 0.0])
FREED = Steps([0.0, 5.0], [-1.0, 0.5])
DRIVEN = {
    "spring": PULLED,
    "free": ss.Problem(ss.SpringBlock(1.0, 0.0, 10.0), LAW, force=7.0),
    "spring_and_dashpot": replace(PULLED, body=ss.SpringBlock(1.0, 20.0, 10.0, driver_damping=2.0)),
    "position_loop": replace(PULLED, body=ss.PositionLoop(1.0, 20.0, 10.0, integral_gain=5.0, derivative_gain=2.0)),
    **{kind: ss.Problem(slab, LAW, **RUN) for kind, slab in SLABS.items()},
    "damper": ss.Problem(COLUMN, LAW, **RUN),
    "changing": ss.Problem(SLABS["rigid"], LAW, **RUN, far_stress=6e7, driver_reflection=FREED),
}
"""A problem with each kind of driver."""
MADE = {
    "rigid": PULLED,
    "belt": replace(PULLED, body=ss.SpringBlock(1.0, 20.0, 10.0).on_belt()),
    "loop": DRIVEN["position_loop"],
    "uniform": DRIVEN["rigid"],
    "layered": ss.Problem(ss.LayeredSlab([4e3, 6e3], [2600.0, 2800.0], [3000.0, 3500.0], 1e8), LAW, **RUN),
}
"""A problem with each kind of body."""
ELSEWHERE = {
    "tried",
    "run",
    "modes_at",
    "shown",
    "record",
    "part",
    "cycles",
    "own",
    "waves",
    "sliding",
    "rate",
    "fall",
    "high",
    "rtol",
    "orbit",
}
"""What answers are asked about that only a search, a fit or a page makes: those questions are asked in tests of their rooms."""


TABLE = re.compile(r"^(\w+): [^\n]*= ByKind\(", re.MULTILINE)


def tables() -> Iterator[tuple[str, ByKind[Any]]]:
    """Yield each table of answers, wherever it stands in the package, with the place of its questions."""
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE).as_posix()
        for name in TABLE.findall(path.read_text(encoding="utf-8")):
            module: ModuleType = import_module("stickslip." + file.removesuffix(".py").replace("/", "."))
            yield f"{file} {name}", getattr(module, name)


TABLES = dict(tables())
KINDS = [pytest.param(table, kind, id=f"{name} {kind}") for name, table in TABLES.items() for kind in table.kinds]


@cache
def about(problem: ss.Problem) -> dict[str, Any]:
    """Return what questions are about, by the names of their parameters."""
    history, body, turn = ss.simulate(problem, 3.0 * problem.round_trip_time).history, problem.body, problem.round_trip_time
    positions = Positions.inside(np.array([0, len(history) - 1]), 0.5)
    return {
        "problem": problem,
        "body": body,
        "scenario": Scenario(problem, 1.0),
        "contact": ss.uniqueness(problem),
        "normal": problem.normal,
        "response": Response(np.array([0.1]), np.ones(1)),
        "many": 0,
        "by_slip": -0.01,
        "by_rate": 0.0,
        "way": "h/c",
        "names": [],
        "kind": "spring-block",
        "name": "test",
        "sensor": "spring",
        "time": np.array([0.1, 0.2]) * turn,
        "first": positions,
        "last": positions,
        "at": positions,
        "nodes": 4,
        "history": history,
        "side": "right",
        "place": np.zeros(2),
        "at_contact": lambda: np.zeros(2),
        "sent": np.zeros(2),
        "fronts": np.array([0.1]),
        "trip": np.zeros(1),
        "offset": np.zeros(1),
        "trips": np.ones(1),
        "phases": np.array([0.5 * turn]),
        "segments": SimpleNamespace(),
        "start": np.zeros(1),
        "middle": np.array([0.5 * turn]),
    }


@pytest.mark.parametrize(("table", "kind"), KINDS)
def test_every_kind_answers_every_question(table: ByKind[Any], kind: str) -> None:
    """A refusal in one line is an answer. A question about something new has to be taught to this test, or named in ELSEWHERE."""
    answers = table[kind]
    given = about((MADE if table.kinds is BODY_KINDS else DRIVEN)[kind])
    if isinstance(answers, Driver):  # which is asked about one moment
        given = given | dict.fromkeys(("first", "time"), 0.5 * given["problem"].round_trip_time)
    asked = 0
    for name, member in inspect.getmembers(answers):
        if name.startswith("_") or inspect.isclass(member) or isinstance(answers, tuple):
            continue
        if not callable(member):
            assert member is not None, name
            continue
        needed = [one.name for one in inspect.signature(member).parameters.values() if one.default is one.empty]
        if set(needed) & ELSEWHERE:
            continue
        asked += 1
        assert set(needed) <= set(given), f"{name} asks about {sorted(set(needed) - set(given))}"
        if name == "on_ground":
            shakes = "pull_rate" if kind == "belt" else "ground_velocity"
            given = given | {"problem": replace(given["problem"], **{shakes: SHAKEN})}
        try:
            said = member(**{one: given[one] for one in needed})
        except ss.InputError:
            continue
        said = list(said) if inspect.isgenerator(said) else said
        assert said is not NotImplemented
        may_be_none = "None" in str(inspect.signature(member).return_annotation)
        assert said is not None or may_be_none, name
    assert asked or isinstance(answers, tuple) or table.home.endswith("creep.drivers")


def test_each_body_and_each_driver_is_of_a_kind_that_is_known() -> None:
    assert {body.structure for body in BODIES.values()} == set(BODY_KINDS)
    assert [problem.body.structure for problem in MADE.values()] == list(MADE) == list(BODY_KINDS)
    assert [problem.driver_kind for problem in DRIVEN.values()] == list(DRIVEN) == list(DRIVER_KINDS)


def test_a_kind_that_does_not_answer_is_refused_when_it_is_first_asked() -> None:
    """The questions are abstract: a class that leaves one out cannot be made."""
    for name, table in TABLES.items():
        asked = next(one for one in type(table[next(iter(table.kinds))]).__mro__[::-1] if one.__module__.startswith("stickslip"))
        if getattr(asked, "__abstractmethods__", None):
            with pytest.raises(TypeError, match="abstract"):
                type("Silent", (asked,), {})()
        else:
            assert name.endswith(("CHECK_DRIVERS", "DRAWN_KINDS", "BEHIND")), name


def test_a_kind_without_answers_of_its_own_gives_those_that_it_is_like() -> None:
    table: ByKind[Any] = ByKind("stickslip.problem.leaps", {**BODY_KINDS, "beam": "uniform", "string-of-pearls": "beam"})
    assert table["string-of-pearls"] is table["uniform"]
    table["beam"] = "answers of beams"
    assert table["beam"] == "answers of beams"
    with pytest.raises(KeyError):
        table["cloud"]
