"""Every kind of record is fitted with the default options: four starts, and what follows from them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.extensions.inference.laboratory import CoulombBlock, CoulombSlab, correlated

ROCK = ss.Problem(
    ss.SpringBlock(20.0, 6e7, 5e4),
    ss.friction.RateAndState(0.62, 0.008, 0.0125, 15e-6),
    pull_rate=ss.loading.Steps([0.0, 20.0], [1e-6, 1e-5]),
)
HOLD = replace(ROCK, pull_rate=ss.loading.HoldAndSlide(1e-5, "5 s", ["20 s"]))
BLOCK, SLAB = CoulombBlock(), CoulombSlab()
STICKING = ss.Problem(
    ss.SpringBlock(BLOCK.mass, BLOCK.stiffness, BLOCK.normal),
    ss.friction.Coulomb(0.66, 0.49),
    pull_rate=BLOCK.pull,
    initial_load=300.0,
)
PLATE = ss.Problem(
    ss.ElasticSlab(SLAB.density, SLAB.wave_speed, SLAB.thickness, SLAB.normal),
    ss.friction.Coulomb(0.61, 0.49),
    pull_rate=SLAB.pull,
    initial_load=2.999e6,
)


def of_rock(problem: ss.Problem, observe: str = "mu") -> dict[str, Any]:
    time = np.linspace(0.0, 40.0, 801)
    run = ss.simulate(problem, 40.0)
    if observe == "slip":
        return {"time (s)": time, "slip (m)": run.slip(time) + 2e-8 * correlated(801, 0.0, 1)}
    return {"time (s)": time, "mu": run.traction(time) / problem.normal + 2e-4 * correlated(801, 0.0, 1)}


def of_block(lasts: float = 0.4, scatter: float = 0.0) -> dict[str, Any]:
    time = np.arange(0.0, lasts, 2e-4)  # 2000 samples at least: more than starts are compared with
    force, _ = BLOCK.sampled(time, 300.0, scatter)
    return {"time (s)": time, "shear force (N)": force + correlated(len(time), 0.0, 2), "load rate (m/s)": BLOCK.pull + 0.0 * time}


def of_slab() -> dict[str, Any]:
    onset = SLAB.onset(2.999e6)
    time = np.linspace(0.0, onset + 1.9 * SLAB.trip, 600)
    shear, _ = SLAB.sampled(time, 2.999e6)
    return {"time (s)": time, "tau (Pa)": shear + 1e3 * correlated(600, 0.0, 3)}


SPRING = {"sensor": "spring"}
KINDS: dict[str, tuple[ss.Problem, dict[str, Any], dict[str, float], dict[str, Any]]] = {
    "velocity steps": (ROCK, of_rock(ROCK), {"friction.a": 0.008, "friction.b": 0.0125}, {}),
    "slide, hold, slide": (HOLD, of_rock(HOLD), {"friction.b": 0.0125, "friction.distance": 15e-6}, {}),
    "slip alone": (ROCK, of_rock(ROCK, "slip"), {"friction.a": 0.008}, {}),
    "a law that sticks": (STICKING, of_block(), {"friction.static": 0.65, "friction.dynamic": 0.5}, SPRING),
    "event by event": (STICKING, of_block(), {"friction.static": 0.65, "friction.dynamic": 0.5}, SPRING | {"parts": "rests"}),
    "features": (STICKING, of_block(0.8, 0.01), {"friction.static": 0.65, "friction.dynamic": 0.5}, SPRING | {"by": "features"}),
    "an event of a slab": (PLATE, of_slab(), {"friction.static": 0.6, "friction.dynamic": 0.5}, {}),
}


LONG = {"event by event", "features", "slide, hold, slide", "an event of a slab", "a law that sticks"}
"""Kinds that take several seconds; other tests of this folder fit shorter records with one start."""


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("kind", [pytest.param(one, marks=pytest.mark.slow) if one in LONG else one for one in KINDS])
def test_a_record_of_each_kind_gives_its_numbers_back_with_the_default_options(kind: str) -> None:
    problem, data, truth, options = KINDS[kind]
    study = ss.studies.infer(problem, data, list(truth), **options)
    assert study.estimate.finished
    for name, value in truth.items():
        row = study.table.loc[name]
        assert row.value == pytest.approx(value, rel=0.02)
        assert abs(row.value - value) < 2.0 * 0.5 * (row.high - row.low), name
    assert not any("misses" in note for note in study.notes)
