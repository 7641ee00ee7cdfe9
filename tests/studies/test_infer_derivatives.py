"""The derivatives with which infer searches, beside central differences of runs that are made by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

import stickslip as ss
from tests.studies.laboratory import load_point

SIZE = 1e-4
CLOCK = np.linspace(0.0, 60.0, 241)
STEPS = ([0.0, 20.0], [1e-6, 1e-5])
GUESS = ss.Problem(ss.SpringBlock(20.0, 6e7, 5e4), ss.friction.RateAndState(0.62, 0.008, 0.0125, 15e-6), pull_rate=1e-6)
FREE = ["friction.a", "friction.b", "friction.distance", "body.stiffness"]


def record() -> dict[str, Any]:
    noise = SIZE * np.random.default_rng(3).standard_normal(len(CLOCK))
    moved = load_point(CLOCK, *STEPS)
    run = ss.simulate(replace(GUESS, pull_rate=ss.loading.Steps(*STEPS)), CLOCK[-1])
    shear = run.traction(CLOCK) / run.problem.normal + noise
    return {"time (s)": CLOCK, "load point (m)": moved, "friction": shear, "standard deviation": np.full(len(CLOCK), SIZE)}


def with_number(problem: ss.Problem, name: str, factor: float) -> ss.Problem:
    place, _, last = name.partition(".")
    owner: Any = getattr(problem, place)
    changed: Any = {place: replace(owner, **{last: factor * getattr(owner, last)})}
    return replace(problem, **changed)


def test_derivatives_of_residuals_are_central_differences_of_runs_made_by_hand() -> None:
    """To 1e-6 of the largest of a column: 1e-7 is what the square of the step and the tolerance of runs leave."""
    study = ss.studies.infer(GUESS, record(), FREE, starts=1)
    model, x = study.model, study.estimate.searched
    found = model.fine(x).jacobian(x, white=False)
    size = study.model.sizes["friction"] * SIZE

    def residual(problem: ss.Problem) -> Any:
        return ss.simulate(problem, CLOCK[-1], rtol=1e-11).traction(CLOCK) / problem.normal / size

    for column, name in enumerate(FREE):
        by = [
            (residual(with_number(study.best, name, np.exp(h))) - residual(with_number(study.best, name, np.exp(-h)))) / (2.0 * h)
            for h in (1e-3, 5e-4)
        ]
        hand = (4.0 * by[1] - by[0]) / 3.0
        assert np.abs(found[:, column] - hand).max() < 1e-6 * np.abs(hand).max(), name
