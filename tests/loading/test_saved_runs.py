"""Runs under every kind of loading history: saved, loaded, described."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.loading import HoldAndSlide, LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from tests.long_runs.problems import differences

LAW = ss.friction.LinearSlipWeakening(0.6, 0.57, 0.02)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
LOSSY = ss.ElasticSlab(2800, 3500, 1e4, 1e8, driver_impedance=2e7)
PULLS = (
    PiecewiseLinear([1.0, 4.0, 6.0], [0.0, 0.3, -0.1]),
    Steps([0.0, 2.0, 7.0], [0.0, 0.3, 0.0]),
    Sinusoidal(0.05, 0.2, period=5.0, phase=-0.25),
    HoldAndSlide(0.1, 3.0, [1.0, 2.0]),
)
STRESSES = (
    PiecewiseLinear([1.0, 4.0, 6.0], [5.9e7, 6.4e7, 5.5e7]),
    Steps([0.0, 2.0, 7.0], [5.9e7, 6.3e7, 5.5e7]),
    Sinusoidal(5.9e7, 4e6, period=5.0),
    HoldAndSlide(6.3e7, 3.0, [1.0, 2.0], hold=5.7e7),
)
CASES = [
    *(
        ss.Problem(body, LAW, pull_rate=pull, initial_load=load)
        for body, load in ((BLOCK, 5.9e13), (SLAB, 5.9e7))
        for pull in PULLS
    ),
    *(ss.Problem(LOSSY, LAW, far_stress=stress, initial_load=5.9e7) for stress in STRESSES),
]


def kind_of(problem: ss.Problem) -> str:
    body = type(problem.body).kind
    history = problem.pull_rate if isinstance(problem.pull_rate, LoadingHistory) else problem.far_stress
    assert isinstance(history, LoadingHistory)
    return f"{body}, {history.kind}"


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("problem", CASES, ids=kind_of)
def test_a_saved_run_gives_the_same_values(problem: ss.Problem, tmp_path: Path) -> None:
    run = ss.simulate(problem, 20.0)
    assert run.status.ok
    assert len(run.catalogue(event_rate=0.0)) > 0
    loaded = ss.open_solution(run.to_netcdf(tmp_path / "run.nc"))
    assert loaded.problem == problem
    assert differences(loaded, run) == []
    times = np.linspace(0.0, run.history.span[1], 301)
    for name in ("slip", "slip_rate", "traction", "load"):
        assert getattr(loaded, name)(times).tobytes() == getattr(run, name)(times).tobytes()
    assert loaded.energy(times).equals(run.energy(times))


def test_a_run_says_how_it_is_loaded() -> None:
    said = repr(ss.simulate("stress-pulse-slab"))
    assert "loading   pull rate 0 m/s, far stress piecewise-linear, 5.9 MPa at first, initial load 5.9 MPa" in said
    said = repr(ss.simulate("tides-block"))
    assert "loading   pull rate sinusoidal, 0.035 m/year at first, initial load 59 TN" in said
    assert "loading   pull rate 0.05 m/year, initial load 80 MPa" in repr(ss.simulate("fig6-slab"))


def test_an_export_says_how_it_is_loaded(tmp_path: Path) -> None:
    run = ss.simulate("stress-pulse-slab")
    head = run.to_scec(tmp_path / "wave.txt", 10.0).read_text(encoding="utf-8").splitlines()
    assert "# pull_rate=0 m/s" in head
    assert "# far_stress=piecewise-linear, 5.9 MPa at first" in head
