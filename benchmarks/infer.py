"""Time inferences: 5 numbers from 10 000 samples of velocity steps, profiles, and 10 000 posterior samples.

    python benchmarks/infer.py [--samples 10000]

Wanted on a machine of 2020: 1 s for the best fit and its covariance, 10 s for profiles, 2 min for 10 000 samples. The coverage
of intervals is measured by tests/extensions/inference/test_infer_records.py.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import stickslip as ss

FREE = ("a", "b", "distance", "stiffness", "reference")


def record(count: int) -> tuple[ss.Problem, dict[str, Any]]:
    """Return the problem with which a search begins, and a record of velocity steps made with other numbers."""
    problem = ss.load_scenario("velocity-steps-block").problem
    law = replace(problem.friction, reference=0.62, a=0.008, b=0.0125, distance=15e-6)
    truth = replace(problem, friction=law, body=replace(problem.body, stiffness=6e7))
    run, clock, pull = ss.simulate(truth, 1000.0), np.linspace(0.0, 1000.0, count), problem.pull_rate
    moved = np.zeros(count)
    for before, after, at in zip([0.0, *pull.values[:-1]], pull.values, pull.times, strict=True):
        moved += (after - before) * np.maximum(clock - at, 0.0)
    random = np.random.default_rng(1)
    friction = run.traction(clock) / problem.normal + 3e-4 * random.standard_normal(count)
    return problem, {"time (s)": clock, "load point (m)": moved + 1e-8 * random.standard_normal(count), "mu": friction}


def timed(what: str, call: Callable[[], Any]) -> None:
    begin = time.perf_counter()
    found = call()
    print(f"{what:<46} {time.perf_counter() - begin:8.2f} s   {found.table.value['friction.a']:.6f}", flush=True)  # noqa: T201


def main() -> None:
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("--samples", type=int, default=10_000, help="posterior samples to draw")
    samples = reader.parse_args().samples
    problem, data = record(10_000)
    ss.studies.infer(problem, record(500)[1], FREE, starts=1)  # compiles
    timed("5 numbers, 10 000 samples, 1 start", lambda: ss.studies.infer(problem, data, FREE, starts=1))
    timed("5 numbers, 10 000 samples, 4 starts", lambda: ss.studies.infer(problem, data, FREE))
    timed("with profiles, 1 start", lambda: ss.studies.infer(problem, data, FREE, starts=1, profiles=True))
    if samples:
        timed(f"with {samples} posterior samples", lambda: ss.studies.infer(problem, data, FREE, starts=1, samples=samples))


if __name__ == "__main__":
    main()
