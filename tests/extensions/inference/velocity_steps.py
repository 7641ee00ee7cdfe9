"""A record of velocity steps that scipy's integrator has made, and fits of its numbers."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pandas as pd

import stickslip as ss
from stickslip.extensions.inference.inference import Inference
from tests.extensions.inference.laboratory import RateAndStateBlock, correlated, load_point
from tests.problems import Floats

TIMES, RATES = [0.0, 60.0, 100.0], [1e-6, 1e-5, 1e-6]
TRUE = RateAndStateBlock()
TRUTH = {
    "friction.a": TRUE.a,
    "friction.b": TRUE.b,
    "friction.distance": TRUE.distance,
    "body.stiffness": TRUE.stiffness,
    "friction.reference": TRUE.reference,
}
GUESS = ss.Problem(ss.SpringBlock(20.0, 9e7, 5e4), ss.friction.RateAndState(0.6, 0.01, 0.013, 1e-5), pull_rate=1e-6)
NEAR = replace(
    GUESS,
    body=replace(GUESS.body, stiffness=TRUE.stiffness),
    friction=replace(GUESS.friction, b=TRUE.b, distance=TRUE.distance),
)
"""A problem of which only a and the reference are to be found."""
TWO = ("friction.a", "friction.reference")
CLOCK = np.linspace(0.0, 200.0, 1501)
STEPS = ss.loading.Steps(TIMES, RATES)


@cache
def clean() -> Floats:
    """Return friction at the samples of the record, without noise."""
    return TRUE.friction(CLOCK, TIMES, RATES)


def record(noise: float = 2e-4, per_sample: float = 0.0, seed: int = 1) -> pd.DataFrame:
    moved = load_point(CLOCK, TIMES, RATES)
    friction = clean() + noise * correlated(len(CLOCK), per_sample, seed)
    return pd.DataFrame({"time (min)": CLOCK / 60.0, "load point (um)": 1e6 * moved, "mu": friction})


def inferred(data: Any = None, free: Any = tuple(TRUTH), **options: Any) -> Inference:
    return ss.studies.infer(NEAR if free == TWO else GUESS, record() if data is None else data, free, **({"starts": 1} | options))


@cache
def plain() -> Inference:
    """Return the fit of the record with white noise, with which several tests compare theirs."""
    return inferred()
