"""What `check` says of a chain: frequencies against closed forms, the first event and steady sliding against runs."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.chains.before_run import MOST_DENSE, ChainBeforeRun
from stickslip.extensions.chains.examine import ChainExamination
from tests.command_line import Command

COULOMB = ss.friction.Coulomb(static=1.0, dynamic=0.8)
KC, KP, MASS = 7.0, 2.0, 3.0


def _uniform(count: Any, ends: str = "free", coupling: Any = KC, **given: Any) -> ss.Chain:
    return ss.Chain(COULOMB, count, MASS, coupling, KP, 1.0, 1e-3, ends=ends, **given)


@pytest.mark.parametrize("count", [5, 40, MOST_DENSE + 37])
@pytest.mark.parametrize("ends", ["free", "fixed"])
def test_frequencies_are_those_of_the_closed_form(count: int, ends: str) -> None:
    """To 1e-12 of the largest, whose square is what rounding of matrices is measured by."""
    waves = np.arange(count) * math.pi / count if ends == "free" else np.arange(1, count + 1) * math.pi / (count + 1)
    squares = (KP + 4.0 * KC * np.sin(0.5 * waves) ** 2) / MASS
    found = ChainBeforeRun(_uniform(count, ends)).frequencies
    assert not found.are_bounds
    assert (found.least**2, found.largest**2) == pytest.approx((squares.min(), squares.max()), abs=1e-12 * squares.max())


def test_a_ring_and_a_lattice_have_the_frequencies_of_their_waves() -> None:
    ring = ChainBeforeRun(_uniform(6, "periodic")).frequencies
    assert ring.largest**2 == pytest.approx((KP + 4.0 * KC) / MASS, rel=1e-12)  # waves of two blocks
    lattice = ChainBeforeRun(_uniform((4, 6), "periodic", (KC, 2.0 * KC))).frequencies
    assert lattice.largest**2 == pytest.approx((KP + 12.0 * KC) / MASS, rel=1e-12)
    assert lattice.least**2 == pytest.approx(KP / MASS, rel=1e-12)


def test_bounds_of_a_large_lattice_contain_its_frequencies() -> None:
    found = ChainBeforeRun(_uniform((30, 40), "periodic", (KC, 2.0 * KC))).frequencies
    assert found.are_bounds
    assert found.least**2 <= KP / MASS * (1.0 + 1e-15)
    assert found.largest**2 >= (KP + 12.0 * KC) / MASS * (1.0 - 1e-15)


def test_a_chain_that_no_spring_holds_has_a_frequency_of_0() -> None:
    free = ss.Chain(COULOMB, 9, MASS, KC, 0.0, 1.0, 1e-3)
    assert ChainBeforeRun(free).frequencies.least == 0.0


def test_the_speed_of_waves_is_that_of_the_longest_wave() -> None:
    """The lowest frequency of a long free chain without a driver is that of half a wave: c pi/n, to 2 %."""
    masses, springs = np.tile([1.0, 3.0], 50), np.tile([2.0, 10.0, 6.0], 33)
    chain = ss.Chain(COULOMB, 100, masses, springs, 0.0, 1.0, 1e-3)
    before = ChainBeforeRun(chain)
    eigenvalues = np.linalg.eigvalsh(before._scaled.toarray())
    assert before.wave_speed == pytest.approx(math.sqrt(eigenvalues[1]) * 100 / math.pi, rel=2e-2)
    assert ChainBeforeRun(_uniform(50)).wave_speed == math.sqrt(KC / MASS)


@pytest.mark.parametrize("seed", range(12))
def test_the_first_event_is_that_of_the_run(seed: int) -> None:
    """To 1e-12 of its time."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 9))
    numbers = [rng.uniform(*ends, count) for ends in ((0.5, 2.0), (0.5, 2.0), (0.8, 1.5))]
    memory = ("all", "since-arrest")[seed % 2]
    law = (COULOMB, ss.friction.LinearSlipWeakening(1.0, 0.7, 0.5, memory=memory))[seed // 2 % 2]
    slip, way = rng.uniform(-0.2, 0.2, count), ("both", "forward")[seed // 3 % 2]
    rate = -1e-2 if way == "both" and seed % 4 == 0 else 1e-2
    chain = ss.Chain(law, count, numbers[0], 2.0, numbers[1], numbers[2], rate, initial_slip=slip, direction=way)
    first = ChainBeforeRun(chain).first
    assert first is not None
    changes = ss.simulate(chain, first.time * 1.001 + 1.0, keep="changes").changes
    assert changes["kind"][0] == 0
    assert (changes["block"][0], changes["time"][0]) == (first.block, pytest.approx(first.time, rel=1e-12, abs=1e-15))
    early = ss.simulate(chain, first.time * 0.999 + 1e-9, keep="changes") if first.time > 0.0 else None
    assert early is None or early.count_of_changes == 0


def test_a_chain_that_is_never_loaded_has_no_first_event() -> None:
    assert ChainBeforeRun(replace(_uniform(3), pull_rate=0.0)).first is None


def _growth_by_hand(chain: ss.Chain, slope: float) -> float:
    """Return the growth of the mode that grows fastest, from the quadratic equation of each mode of a uniform chain."""
    waves = np.arange(chain.count) * math.pi / chain.count
    squares = (KP + 4.0 * KC * np.sin(0.5 * waves) ** 2) / MASS
    half = -0.5 * (slope + float(chain.damping)) / MASS
    return float((half + np.sqrt(half**2 - squares + 0j)).real.max())


@pytest.mark.parametrize("damping", [0.0, 0.3, 40.0])
def test_steady_sliding_is_judged_by_the_roots_of_its_modes(damping: float) -> None:
    law = ss.friction.HyperbolicRate(static=1.0, dynamic=0.5, alpha=1e2)
    chain = ss.Chain(law, 7, MASS, KC, KP, 1.0, 1e-3, damping=damping)
    before, slope = ChainBeforeRun(chain), float(law.slopes(0.0, 1e-3)[1])
    assert slope < 0.0
    assert before.growth == pytest.approx(_growth_by_hand(chain, slope), rel=1e-9)
    assert before.is_stable is (slope + damping >= 0.0)


def test_check_says_what_is_known_before_a_run(command: Command) -> None:
    out = command("check", "chain").out
    for text in (
        "[chain]",
        "uniform (9 N, 11 N), seed 1",
        "frequencies",
        "waves",
        "first event",
        "steady sliding",
        "block 9 slips",
    ):
        assert text in out
    assert "[body]" not in out
    assert "nearly one block" in command("check", "chain", "--set", "coupling=1 MN/m").out
    assert "nearly 50 blocks of their own" in command("check", "chain", "--set", "coupling=0.001 N/m").out


@pytest.mark.parametrize(("duration", "wanted"), [(1e4, "at most some 44000 onsets"), (1e9, "at most some 4.4e+09 onsets, a few")])
def test_frequencies_are_in_one_unit_and_onsets_written_out(duration: float, wanted: str) -> None:
    """The driver goes 10 m or 1000 km; blocks that slip alone slip 2 times 0.2 N or 0.26 N over 1001 N/m."""
    changes = {"run.duration": duration, "chain.coupling": 1e3}
    found = dict(ChainExamination(ss.scenarios["two-blocks"].with_values(changes)).findings())
    assert re.match(r"1 to 44\.73 rad/s where all blocks move", found["frequencies"])
    assert wanted in found["size"]


@pytest.mark.parametrize(
    ("changes", "wanted"),
    [
        ({"pull_rate": 0.0}, "none: no block is ever loaded"),
        ({"run.duration": 10.0}, "after the run has ended"),
        ({"normal_force[1]": 1.0}, "with 1 others at the same time"),
        ({"chain.initial_slip": -1.0}, "at once"),
    ],
)
def test_the_first_event_is_told_in_words(changes: dict[str, float], wanted: str) -> None:
    found = dict(ChainExamination(ss.scenarios["two-blocks"].with_values(changes)).findings())
    assert wanted in found["first event"]
