"""Users may ask numpy to raise errors wherever a result underflows, overflows or is no number: no calculation depends on that."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import stickslip as ss
from stickslip.friction import LAWS
from stickslip.problem.scenarios.scenario import Scenario, read_scenario
from stickslip.problem.scenarios.templates import template
from stickslip.run.check.examine import examine


@pytest.fixture(autouse=True)
def strict() -> Iterator[None]:
    with np.errstate(all="raise"):
        yield


def scenario(body: str, law: str) -> Scenario:
    """Return the starter of a body with plausible values of a law."""
    return read_scenario(template(body, law), f"{body}-{law}.toml")


CASES = [("slab", law) for law in LAWS] + [("block", law) for law in list(LAWS)[::4]] + [("lab-slab", "hyperbolic-rate")]


@pytest.mark.sampled(every=12)
@pytest.mark.parametrize(("body", "law"), CASES)
def test_uniqueness_and_check_need_no_setting_of_numpy(body: str, law: str) -> None:
    given = scenario(body, law)
    with np.errstate(all="warn", under="ignore"):
        expected = str(ss.uniqueness(given)), str(examine(given))
    assert (str(ss.uniqueness(given)), str(examine(given))) == expected


@pytest.mark.sampled(every=17)
@pytest.mark.parametrize(("body", "law"), CASES)
def test_a_run_and_its_tables_need_no_setting_of_numpy(body: str, law: str) -> None:
    given = scenario(body, law)
    run = ss.simulate(given, max_pieces=1000)
    times = np.linspace(0.0, 0.999 * run.history.duration, 50)
    with np.errstate(all="warn", under="ignore"):
        expected = ss.simulate(given, max_pieces=1000)
        values = [np.asarray(function(times)) for function in (expected.slip, expected.slip_rate, expected.traction)]
        energy = expected.energy(times)
    assert len(run.history) == len(expected.history)
    for function, value in zip((run.slip, run.slip_rate, run.traction), values, strict=True):
        assert np.array_equal(np.asarray(function(times)), value)
    assert run.energy(times).identical(energy)
    assert len(run.events) == len(expected.events)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("law", "name", "values"),
    [
        ("hyperbolic-rate", "friction.alpha", [0.1, 1.0, 100.0]),
        ("linear-slip-weakening", "friction.distance", [0.01, 1.0]),
        ("exponential-stribeck", "friction.rate", [1e-4, 0.1]),
    ],
)
def test_sweeps_need_no_setting_of_numpy(law: str, name: str, values: list[float]) -> None:
    given = scenario("slab", law)
    with np.errstate(all="warn", under="ignore"):
        expected = ss.sweep(given, {name: values}, threads=1)
    found = ss.sweep(given, {name: values}, threads=1)
    assert found.sizes[name] == len(values)
    for column in expected.data_vars:
        np.testing.assert_array_equal(found[column], expected[column])
