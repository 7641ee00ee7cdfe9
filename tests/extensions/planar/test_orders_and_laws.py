"""The planar solver: orders of its error, and laws drawn at random or strongly strengthening against the slab as a volume."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.solver import PlanarSolver
from tests.extensions.planar.patches import SLAB
from tests.extensions.planar.planar_methods import LawAtNodes, PlanarCase, volume

LENGTH, DURATION = 4e4, 1.5 * SLAB.two_way_time
SMOOTH = ss.friction.FromExpression("0.6 - 0.1*tanh(u/2) + 0.1*v/(v + 2)")


def load(y: np.ndarray) -> np.ndarray:
    """Load above the strength at every node, with a peak."""
    return np.asarray(61e6 + 2e6 * np.exp(-((y / 4e3) ** 2)) + 3e5 * np.sin(2.0 * np.pi * y / LENGTH))


def slip(law: ss.friction.FrictionLaw, nodes: int, steps: int | None = None, barrier: Any = None) -> np.ndarray:
    problem = ss.Problem(SLAB, law, initial_load=61e6, pull_rate=0.5)
    slab = ss.PlanarSlab(problem, nodes=nodes, length=LENGTH, along={"initial.load": load}, barrier=barrier)
    run = PlanarSolver(slab, DURATION, steps_per_round_trip=steps)
    while run.advance(10_000):
        pass
    return np.asarray(run.now().slip)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("barrier", "low", "high"),
    [(None, 3.7, 4.1), (lambda y: np.abs(y) > 9.9e3, 1.7, 2.1)],
    ids=["smooth", "barriers"],
)
def test_halving_steps_and_distances_quarters_smooth_errors_and_halves_those_at_barriers(
    barrier: Any, low: float, high: float
) -> None:
    """Slip next to a barrier falls as the root of the distance, which is why."""
    found = [slip(SMOOTH, nodes, barrier=barrier)[:: nodes // 32] for nodes in (32, 64, 128)]
    if barrier is not None:
        found = [*found[1:], slip(SMOOTH, 256, barrier=barrier)[::8]]
    coarse, fine = (np.abs(one - other).max() for one, other in pairwise(found))
    assert low < coarse / fine < high


def drawn(seed: int) -> str:
    """Return a formula of slip, which may weaken and strengthen several times, and of slip rate."""
    draw = np.random.default_rng(seed)
    waves = [f"{draw.normal(0.0, 0.03):+.4f}*sin({draw.uniform(0.5, 2.0):.3f}*u)" for _ in range(3)]
    decay = f"{draw.normal(0.0, 0.05):+.4f}*exp(-((u/{draw.uniform(0.5, 3.0):.3f})**2))"
    return f"0.5 {' '.join(waves)} {decay} {draw.uniform(-0.05, 0.1):+.4f}*v/(v + 2)"


LAWS = {str(seed): drawn(seed) for seed in (1, 2, 3, 4)} | {"strengthens": "0.6 + 0.1*log(1 + v/1e-4)"}


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_a_law_slips_as_in_the_volume(name: str) -> None:
    """To 1e-3 of the largest slip: laws drawn at random, and one whose S mu' is up to 1e4 Z, so that explicit steps blow up."""
    law = ss.friction.FromExpression(LAWS[name])
    y = (np.arange(32) / 32 - 0.5) * LENGTH
    case = PlanarCase(2800.0, 3500.0, 1e4, (LENGTH,), load(y), LawAtNodes(law, np.full(32, 1e8)), pull_rate=0.5)
    truth = volume(case, DURATION, 256).slip[-1]
    assert truth.min() > 0.0
    errors = [np.abs(slip(law, 32, steps) - truth).max() / truth.max() for steps in (64, 128)]
    assert errors[1] < 1e-3
    assert errors[1] < 0.5 * errors[0]
