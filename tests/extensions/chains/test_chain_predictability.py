"""How far a chain can be foretold agrees with how fast the slips of two runs part, and a single block never does."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.chains.parting import shared_events_of
from stickslip.extensions.chains.run import EVENT_TYPE, ChainRun
from stickslip.extensions.chains.solver import solve_chain


@cache
def run(count: int = 10, duration: float = 3000.0) -> ChainRun:
    """Return the run of a chain from a rough start."""
    law = ss.friction.Coulomb(static=1.0, dynamic=0.7)
    start = -np.random.default_rng(1).uniform(0.0, 0.5, count)
    return solve_chain(ss.Chain(law, count, 1.0, 10.0, 1.0, 1.0, 1e-3, initial_slip=start), duration)


def test_the_exponent_is_that_of_direct_differences() -> None:
    """The differences of slip of two runs after each event, of a disturbance of one block, grow at the same rate."""
    known, rates = run(), []
    after = (known.events["time"] + known.events["duration"])[:-1] + 1e-3
    for block in range(known.chain.count):
        start = known.chain.values("initial_slip")
        start[block] += 1e-12
        other = solve_chain(replace(known.chain, initial_slip=start), known.duration)
        apart = np.abs(known.at(after).slip - other.at(after).slip).max(axis=1)
        small = apart < 1e-6
        rates.append(np.polyfit(after[small], np.log(apart[small]), 1)[0])
    found = known.predictability()
    # an exponent of a finite time depends on how it is measured: both are within a quarter, and errors of a factor are seen
    assert found.exponent == pytest.approx(float(np.mean(rates)), rel=0.25, abs=0.0)
    assert 0.0 < found.exponent_error < 0.25 * found.exponent


def test_horizons_are_those_of_events_of_disturbed_runs() -> None:
    """Compared here event by event, in a loop."""
    known = run()
    times, sizes = (known.events[name].tolist() for name in ("time", "size"))
    found = known.predictability(1e-8, runs=2, seed=5)
    assert found.sizes == pytest.approx([1e-8, 1e-7, 1e-6, 1e-5, 1e-4], rel=1e-12, abs=0.0)
    start, slip = known.chain.values("initial_slip"), float((known.events["moment"] / known.events["size"]).max())
    assert found.slip == pytest.approx(slip, rel=1e-12, abs=0.0)
    for row in range(2):
        way = np.random.default_rng((5, row)).uniform(-1.0, 1.0, 10)
        other = solve_chain(replace(known.chain, initial_slip=start + 1e-5 * slip * way), known.duration)
        n = 0
        while sizes[n] == other.events[n]["size"]:
            near = min(times[n] - times[n - 1] if n else math.inf, times[n + 1] - times[n])
            if abs(other.events[n]["time"] - times[n]) > 0.1 * near:
                break
            n += 1
        assert 0 < n < len(times) - 1
        assert found.shared[row, 3] == n
        assert found.horizons[row, 3] == known.events["time"][n]


def test_a_block_alone_never_parts() -> None:
    found = run(1, 9000.0).predictability(runs=2)
    assert math.isinf(found.horizon)
    assert np.isinf(found.horizons).all()
    assert math.isnan(found.exponent)
    assert f"all {len(run(1, 9000.0).events)} events are predictable" in str(found)
    assert "no run parts up to a disturbance of 0.0001" in str(found)


def test_it_is_repeated_by_its_seed() -> None:
    first, again, other = (run().predictability(1e-9, runs=2, seed=seed) for seed in (3, 3, 4))
    assert first.horizons.tolist() == again.horizons.tolist()
    assert first.horizons.tolist() != other.horizons.tolist()


def test_it_says_what_it_found() -> None:
    found = run().predictability()
    first = int(found.shared[:, 0].min())
    assert found.horizon == run().events["time"][first]
    assert f"the first {first} of " in found.text
    assert f"costs {found.per_decade:.3g} s" in str(found)
    assert found.per_decade * found.exponent == pytest.approx(math.log(10.0), rel=1e-12, abs=0.0)
    assert "beyond that only statistics" in str(found)


@pytest.mark.parametrize(
    ("change", "shared"),
    [
        ({}, 3),
        ({"first_block": [0, 1, 1]}, 2),
        ({"size": [1, 3, 2]}, 1),
        ({"time": [1.0, 2.2, 3.0]}, 1),
        ({"time": [1.05, 2.05, 3.05]}, 3),
    ],
)
def test_events_are_shared_up_to_the_first_other_one(change: dict[str, Any], shared: int) -> None:
    events = np.zeros(3, EVENT_TYPE)
    events["time"], events["first_block"], events["size"] = [1.0, 2.0, 3.0], [0, 1, 2], [1, 2, 2]
    others = events.copy()
    for name, values in change.items():
        others[name] = values
    assert shared_events_of(events, others, np.full(3, 0.1)) == shared
    assert shared_events_of(events, others[:2], np.full(3, 0.1)) == min(shared, 2)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"size": 0.0}, "ChainRun.predictability: size must be a share of the slip from 1e-14 to 1e-06, got 0.0"),
        ({"size": "1 mm"}, "size must be a share of the slip"),
        ({"size": math.nan}, "size must be a share of the slip"),
        ({"runs": 0}, "ChainRun.predictability: runs"),
        ({"seed": -1}, "ChainRun.predictability: seed"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_one_line(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError) as error:
        run().predictability(**given)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_a_run_without_events_is_refused() -> None:
    with pytest.raises(ss.InputError, match="no event is over early enough before the end of the run at 1 s: run it longer"):
        run(3, 1.0).predictability()
