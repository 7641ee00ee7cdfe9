"""Intervals of 95 % hold the truth in 92 to 98 % of 200 records, with white and with correlated noise."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from tests.studies.laboratory import RateAndStateBlock, correlated, load_point

TIMES, RATES = [0.0, 60.0, 100.0], [1e-6, 1e-5, 1e-6]
TRUE = RateAndStateBlock()
NAMES = ("friction.a", "friction.b", "friction.distance", "body.stiffness", "friction.reference")
DRAWS = 200


def covered(per_sample: float, draws: int, first_seed: int = 0) -> dict[str, float]:
    """Share of records whose interval holds the truth, by number; the noise forgets itself within so many samples."""
    clock = np.linspace(0.0, 200.0, 1501)
    clean, moved = TRUE.friction(clock, TIMES, RATES), load_point(clock, TIMES, RATES)
    truth = dict(zip(NAMES, (TRUE.a, TRUE.b, TRUE.distance, TRUE.stiffness, TRUE.reference), strict=True))
    law = ss.friction.RateAndState(TRUE.reference, TRUE.a, TRUE.b, TRUE.distance)
    guess = ss.Problem(ss.SpringBlock(TRUE.mass, TRUE.stiffness, TRUE.normal), law, pull_rate=1e-6)
    held = dict.fromkeys(NAMES, 0)
    for seed in range(first_seed, first_seed + draws):
        friction = clean + 2e-4 * correlated(len(clock), per_sample, seed)
        data = {"time (s)": clock, "load point (m)": moved, "mu": friction}
        table = ss.studies.infer(guess, data, NAMES, starts=1).table
        for name in NAMES:
            held[name] += table.low[name] <= truth[name] <= table.high[name]
    return {name: count / draws for name, count in held.items()}


@pytest.mark.slow
@pytest.mark.parametrize("per_sample", [0.0, 10.0], ids=["white", "correlated"])
def test_intervals_of_95_percent_hold_the_truth_as_often_as_they_say(per_sample: float) -> None:
    shares = covered(per_sample, DRAWS)
    assert 0.92 <= np.mean(list(shares.values())) <= 0.98, shares
    assert min(shares.values()) >= 0.90, shares  # each of five shares of 200 draws: three standard errors of 1.5 %
