"""Clumsy planar slabs: one line that says what is wrong and what is allowed."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.contact import Contact
from stickslip.extensions.planar.run import memory_here
from stickslip.problem.scenarios.entries import Source
from stickslip.problem.scenarios.scenario import scenario_of
from tests.extensions.planar.patches import LAW, SLAB, patch

PROBLEM = ss.Problem(SLAB, LAW, initial_load=60e6)
GRID = {"nodes": 32, "length": 2e4}


def problem_with(**changes: Any) -> ss.Problem:
    return ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, **changes), LAW, initial_load=60e6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"nodes": 33}, "nodes must be an even whole number, at least 8, got 33"),
        ({"nodes": 32.0}, "nodes must be an even whole number"),
        ({"length": -1.0}, "length must be"),
        ({"length": "3 s"}, "length must be"),
        ({"width": 1e4}, "width and width_nodes belong together"),
        ({"courant": 0.9}, "courant must be at most 0.796"),
        ({"along": {"static": np.ones(7)}}, r"static must give \(32,\) values"),
        ({"along": {"static": lambda y: 0.0 * y + np.nan}}, "static must be finite at every node"),
        ({"along": {"statc": 0.7}}, "did you mean"),
        ({"along": {"body.thickness": 0.7}}, "is not a number that can vary"),
        ({"along": {"static": lambda y: 0.0 * y - 0.1}}, "static"),
        ({"along": [0.7]}, "along must be a mapping"),
        ({"barrier": np.ones((3, 3), bool)}, r"barrier must give \(32,\) values"),
        ({"problem": SLAB}, "problem must be a Problem"),
        ({"problem": problem_with(contact_mass=10.0)}, "contact_mass must be 0"),
        ({"problem": ss.scenarios["fig6-slab"].problem}, "no selection rule is known to"),
        ({"problem": ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), initial_excess=1.0)}, "no selection rule is known to"),
        ({"problem": ss.scenarios["fig5-block-printed"].problem}, "body must be an ElasticSlab"),
    ],
)
def test_a_clumsy_slab_is_refused_in_one_line(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError, match=message) as error:
        ss.PlanarSlab(**({"problem": PROBLEM} | GRID | change))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "needs a duration"),
        ({"duration": "3 km"}, "duration must be"),
        ({"duration": 3.0, "rtol": 1e-8}, "a PlanarSlab has no rtol"),
        ({"duration": 3.0, "frames": 0}, "frames must be a whole number above 0"),
        ({"duration": 3.0, "frames": True}, "frames must be a whole number above 0"),
        ({"duration": 1e6}, "GB"),
        ({"duration": 3.0, "progress": 3}, "progress must be"),
    ],
)
def test_a_clumsy_run_is_refused_in_one_line(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        ss.simulate(patch(**GRID), **arguments)


def test_a_law_that_slip_makes_ill_posed_is_refused() -> None:
    """At the initial slip it has one slip rate at every load; after some slip it has several."""
    law = ss.friction.FromFunction(lambda u, v: 0.6 - 0.1 * np.tanh(u / 0.5) - 0.2 * np.tanh(u / 0.5) * v / (v + 0.2))
    contact = ss.PlanarSlab(ss.Problem(SLAB, law, initial_excess=1e6), nodes=16, length=2e4)
    with pytest.raises(ss.InputError, match="no selection rule is known to help"):
        ss.simulate(contact, 5.0, frames=20)


def test_frames_are_refused_for_a_slab_in_1d() -> None:
    with pytest.raises(ss.InputError, match="frames is for a PlanarSlab"):
        ss.simulate(PROBLEM, 3.0, frames=10)  # type: ignore[call-overload]


def test_a_missing_library_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "stickslip.extensions.planar.solver", None)
    with pytest.raises(ss.InputError, match=r"pip install 'stickslip\[planar\]'"):
        ss.simulate(patch(**GRID), 3.0)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("call", [ss.uniqueness, ss.catalogue, ss.explore, ss.resume])
def test_what_is_for_problems_refuses_a_planar_slab(call: Any) -> None:
    with pytest.raises(ss.InputError) as error:
        call(patch(**GRID), *(["catalogue.csv", 3.0] if call is ss.catalogue else []))
    assert "\n" not in str(error.value)


ROUGH = np.random.default_rng(1)
PLACES = (32, 16)
STATES = ss.Problem(
    SLAB, ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=1e-2), initial_load=60e6, initial_state=1.0
)
OF_RATE = ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.7, 0.1), initial_excess=-1e6)


def rough(low: float, high: float) -> np.ndarray:
    return low + (high - low) * ROUGH.random(PLACES)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(
    ("problem", "along"),
    [
        (PROBLEM, {"load": rough(60e6, 61e6)}),
        (PROBLEM, {"static": rough(0.65, 0.66), "load": rough(60e6, 61e6), "initial.slip": rough(-0.1, 0.5)}),
        (STATES, {"a": rough(0.01, 0.011), "initial.state": rough(1.0, 2.0)}),
        (STATES, {"initial.state": rough(1.0, 2.0), "normal_stress": rough(1e8, 1.1e8)}),
        (OF_RATE, {"alpha": rough(0.1, 0.11), "excess": rough(-1e6, 0.0)}),
    ],
    ids=lambda one: " ".join(one) if isinstance(one, dict) else "",
)
def test_many_different_nodes_have_the_numbers_of_a_problem_each(problem: Any, along: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    grid = {"nodes": 32, "length": 2e4, "width": 1e4, "width_nodes": 16}
    few = ss.PlanarSlab(problem, along=along, **grid)
    monkeypatch.setattr("stickslip.extensions.planar.nodes.NODES_ALL_CHECKED", 1000)
    each = ss.PlanarSlab(problem, along=along, **grid)
    assert (len(few.values.problems) <= 256, len(each.values.problems)) == (True, 512)
    for name in ("normal", "load", "excess", "slip", "law_slip", "states", "static_excess", "knots"):
        assert np.array_equal(getattr(few.values, name), getattr(each.values, name)), name
    for one, other in zip(few.values.numbers, each.values.numbers, strict=True):
        assert one.keys() == other.keys()
        assert all(np.array_equal(one[name], other[name]) for name in one)
    assert few.steps_per_round_trip == each.steps_per_round_trip


@pytest.mark.parametrize(
    ("name", "wrong", "message"),
    [
        ("static", -0.1, "LinearSlipWeakening: static must be at least 0 "),
        ("normal_stress", -1.0, "ElasticSlab: normal_stress must be greater than 0 Pa, got -1"),
        ("initial.slip", 1e300, "initial_slip must lie within"),
    ],
)
def test_one_wrong_node_among_many_is_found(name: str, wrong: float, message: str) -> None:
    values = rough(0.6, 0.7) * (1e8 if name == "normal_stress" else 1.0)
    values[5, 7] = wrong
    with pytest.raises(ss.InputError, match=message):
        ss.PlanarSlab(PROBLEM, along={name: values}, nodes=32, length=2e4, width=1e4, width_nodes=16)


def test_a_contact_of_more_nodes_than_can_be_used_is_refused_before_it_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    document = tomllib.loads(ss.scenarios["planar-patch"].to_toml())
    monkeypatch.setattr(Contact, "slab", lambda *_: pytest.fail("it was made"))
    with pytest.raises(ss.InputError, match=r"x: \[contact\] has 256 nodes, 100 are the most that can be used here"):
        scenario_of(document, Source("x", most_nodes=100))


def test_a_contact_of_as_many_nodes_as_can_be_used_is_read() -> None:
    found = scenario_of(tomllib.loads(ss.scenarios["planar-patch"].to_toml()), Source("x", most_nodes=256))
    assert found.table("contact") is not None
    assert found.table("contact").nodes == 256


def test_the_memory_of_the_machine_bounds_a_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    limit = tmp_path / "memory.max"
    monkeypatch.setattr("stickslip.extensions.planar.run.LIMITS_OF_CONTAINER", (str(limit),))
    limit.write_text("max\n")
    machine = memory_here()
    assert machine > 1e9
    limit.write_text("70000000\n")
    assert memory_here() == 7e7
    with pytest.raises(ss.InputError, match=r"needs [\d.]+ GB for 3 s, and there are 0.07 GB here: take fewer nodes"):
        ss.simulate(patch(nodes=1024, length=2e4), 3.0)
    monkeypatch.delattr("os.sysconf")
    limit.unlink()
    assert memory_here() == 16e9
