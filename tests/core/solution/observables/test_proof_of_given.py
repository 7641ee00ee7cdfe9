"""What is given is put into a proof from the problem: an engine that worked with another normal load is noticed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from benchmarks.wrong_series import BLOCK, SLAB

import stickslip as ss
from stickslip.engine.input import prepare
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from stickslip.problem.pressing import pressing_of
from stickslip.solution.observables import proof
from stickslip.solution.observables.given_on_discs import NormalLoads
from stickslip.solution.observables.proof import proven

LAW = ss.friction.FromExpression("0.55 + 0.03*sin(3*u)*exp(-u*u) + 0.01/(1 + u*u)")
LOADS = [Sinusoidal(1e8, 1e6, 3.0), PiecewiseLinear([0.0, 1.0, 2.0], [1e8, 1.02e8, 0.99e8]), Steps([0.0, 1.5], [1e8, 1.01e8])]


def slab(load: LoadingHistory) -> ss.Problem:
    return ss.Problem(SLAB, LAW, pull_rate=0.3, initial_excess=1.5e7, normal_load=load)


@pytest.fixture
def wrong_by(monkeypatch: pytest.MonkeyPatch) -> Iterator[float]:
    """Let the engine take a normal load whose changes are larger by a share of 1e-3."""

    def forget() -> None:
        for cached in (prepare._of_problem, prepare._prepared):
            cached.cache_clear()

    right, by = pressing_of, 1e-3

    def wrong(problem: ss.Problem) -> object:
        found = right(problem)
        tone = found.tone._replace(amplitude=found.tone.amplitude * (1.0 + by))
        return found._replace(value=found.value * (1.0 + by), slope=found.slope * (1.0 + by), tone=tone)

    with monkeypatch.context() as patched:
        patched.setattr(prepare, "pressing_of", wrong)
        forget()
        yield by
    forget()


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("load", LOADS, ids=lambda one: one.kind)
def test_a_normal_load_that_the_engine_got_wrong_is_missed_by_what_the_proof_says(load: LoadingHistory, wrong_by: float) -> None:
    """The contact equation is missed by 1e-3 of how far the normal load has changed, times the friction coefficient."""
    run = ss.simulate(slab(load), 4.0)
    store = run.history.store
    n = np.flatnonzero(store.mode != 0)
    times = (store.trip[n] * run.history.round_trip_time + store.phase_from[n])[:, None] + store.speed[n, None] * 0.5
    grown = np.abs(load.at(times) / load.first - 1.0).max()
    assert wrong_by * grown * 0.9 < run.proven.residual / (0.55 * load.first) < wrong_by * 0.03
    block = ss.Problem(BLOCK, LAW, pull_rate=0.1, initial_excess=4.0, normal_load=Sinusoidal(10.0, 0.5, 0.7))
    assert 1e-4 < ss.simulate(block, 1.5).proven.residual < 1e-3


def test_steps_that_are_not_proven_anew_are_compared_with_the_normal_load(wrong_by: float, monkeypatch: pytest.MonkeyPatch) -> None:
    run = ss.simulate(slab(LOADS[0]), 4.0)
    for name in ("SHARE", "FIRST", "LARGEST"):
        monkeypatch.setattr(proof, name, 1)
    found = proven(run.history)
    assert found.anew < found.steps / 2
    assert found.residual > 0.5 * run.proven.residual > 100.0


@pytest.mark.parametrize("load", LOADS, ids=lambda one: one.kind)
def test_the_right_normal_load_misses_nothing_beyond_rounding(load: LoadingHistory) -> None:
    assert ss.simulate(slab(load), 4.0).proven.residual < 2e-5


@pytest.mark.parametrize("load", LOADS, ids=lambda one: one.kind)
def test_values_on_discs_contain_the_normal_load_in_the_complex_plane(load: LoadingHistory) -> None:
    history = ss.simulate(slab(load), 4.0).history
    n = np.flatnonzero(history.store.mode != 0)
    found, radii = NormalLoads.of(history, n), np.array([0.5, 1.0, 2.0])
    y = radii * np.exp(1j * np.linspace(0.0, 6.0, 25))[:, None]
    places = 0.5 + y[..., None]
    begins, speed, bend, since, value, slope = (one[:, 0] for one in found[:6])
    time = begins + places * (speed + places * bend)
    amplitude, frequency, phase = found.tone
    p = value + slope * (time - since) + amplitude * np.sin(frequency * time + phase)
    rate = slope + amplitude * frequency * np.cos(frequency * time + phase)
    for real, disc in zip((p, rate), found.around_middle(radii), strict=True):
        away, radius = np.abs(real - disc.centre.T), disc.radius.T
        assert (away <= radius).all()
        assert away.max() > 0.3 * radius.max() or away.max() == 0.0
