"""Random compositions against answers whose steps cannot jump; `python -m benchmarks.compositions` takes thousands."""

from __future__ import annotations

import math

import numpy as np
import pytest
from benchmarks.composed_laws import BLOCK_EXCESS, SLAB, SLAB_EXCESS, SLAB_TIME, Composed, draw
from benchmarks.composed_truth import truth_of
from benchmarks.compositions import compared
from benchmarks.enclosures import Interval

SEED = 4
SAMPLE = [(structure, numbers) for structure in (1, 7, 8, 10, 17, 24) for numbers in range(5)]
"""Short formulas, of all kinds of problems: those of depth 4 take up to half a minute to compile."""


@pytest.mark.sampled(every=13)
@pytest.mark.parametrize(("structure", "numbers"), SAMPLE)
def test_slip_is_that_of_an_answer_that_cannot_jump(structure: int, numbers: int) -> None:
    """Slip, and the time of the arrest, to 1e-7."""
    one = draw(SEED, structure, numbers)
    outcome = compared(one)
    if outcome.name == "undecided":
        pytest.skip(outcome.why)
    assert outcome.name == "right", f"{outcome}: {one}"


@pytest.mark.parametrize("steepness", [-0.03, 0.05, 5.0])
def test_the_truth_of_a_slab_is_the_closed_form(steepness: float) -> None:
    """Friction 0.6 + a u: slip is E / (S a) (1 - exp(-S a t / Z)). To 1e-11."""
    pace = SLAB.normal_stress * steepness / SLAB.impedance
    slip = SLAB_EXCESS / (SLAB.normal_stress * steepness) * -math.expm1(-pace * SLAB_TIME)
    found = truth_of(Composed("slab, u", f"0.6+{steepness}*u", {}, ()))
    assert found.slip == pytest.approx(slip, rel=1e-11, abs=0.0)
    assert found.arrest is None


def test_the_truth_of_a_block_is_the_closed_form() -> None:
    """Friction 0.6 + b v is a damper: m u'' = E - K u - N b u'. To 1e-9."""
    damping, stiffness = 0.5 * 10.0 * 0.1, 20.0
    frequency = math.sqrt(stiffness - damping * damping)
    end = math.pi / frequency
    slip = BLOCK_EXCESS / stiffness * (1.0 + math.exp(-damping * end))
    found = truth_of(Composed("block, v", "0.6+0.1*v", {}, ()))
    assert found.arrest == pytest.approx(end, rel=1e-9, abs=0.0)
    assert found.slip == pytest.approx(slip, rel=1e-9, abs=0.0)


def test_enclosures_contain_friction_and_shrink_with_the_box() -> None:
    """Composed laws of slip and slip rate at random places in random boxes."""
    rng, finite, boxes = np.random.default_rng(2), 0, 0
    for structure in range(20):
        law = draw(SEED, structure, 0).law
        for size in 10.0 ** rng.uniform(-8.0, 0.0, 6):
            low = rng.uniform(0.0, 1.2, 2)
            with np.errstate(all="ignore"):
                u, v = (Interval(np.array([x]), np.array([x + size])) for x in low)
                places = low + size * rng.uniform(0.0, 1.0, (200, 2))
                mu = np.broadcast_to(law(places[:, 0], places[:, 1]), 200)
                enclosure = law.over(u, v)
            spare = 1e-12 * np.abs(mu)
            assert ((mu >= enclosure.low - spare) & (mu <= enclosure.high + spare)).all()
            boxes, finite = boxes + 1, finite + bool(np.isfinite(enclosure.high - enclosure.low).all())
    assert finite > 0.9 * boxes
