"""What must hold of every run: laws of the registry, bodies, drivers, loads and selection rules drawn at random."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import stickslip as ss
from stickslip.friction import LAWS
from stickslip.friction.contract import one_argument
from stickslip.run.reference.slab import StuckSlab
from tests.core.engine.drawn import NORMAL, few, problems, ran

TIMES = 301
COMPILED_ANEW = ("table", "expression", "product", "sum")
"""Laws of which every example is a new formula, compiled for seconds: other tests run them."""


@pytest.mark.sampled(every=22)
@pytest.mark.parametrize("kind", [kind for kind in LAWS if kind not in COMPILED_ANEW])
@given(data=st.data())
@few
def test_every_run_obeys_the_law_and_the_contact(kind: str, data: st.DataObject) -> None:
    """Friction while slipping is the law's (1e-8 S), and at rest below the static strength (1e-12). Only bristles do work.

    Energy balances (1e-8 of the energies, and rounding of what is stored). On a slab without contact mass Z v + tau is the load
    (1e-14).
    """
    obeys(ran(data.draw(problems(kind))))


def test_rest_that_echoes_a_slipping_piece_is_rest() -> None:
    """Over this rest nothing is recorded, and its load is an echo of pieces that slip: the test above met it once."""
    law = ss.friction.PiecewiseLinearRate((0.005415, 0.545184, 1.04, 1.21202), (1.294992, 1.258041, 1.486899, 1.145905))
    slab = ss.ElasticSlab(2800.0, 3500.0, 5011.872336272725, NORMAL, contact_mass=1e5)
    problem = ss.Problem(slab, law, pull_rate=1e-9, initial_load=134511158.33285493, selection="maxwell")
    obeys(ss.simulate(problem, 3.3 * slab.two_way_time, rtol=1e-9))


def obeys(run: ss.Solution) -> None:
    """Check what must hold of every run."""
    problem = run.problem
    law, body, history = problem.friction, problem.body, run.history
    times = np.linspace(0.0, history.duration, TIMES)[1:]
    at = history.find(times, "right")
    rate, traction, mode = run.slip_rate(times), run.traction(times), history.mode(at)
    kept = at.recorded()  # at rest slip and state are those at its begin
    walked = np.where(law.counts == "path", history.mode(kept), 1) * history.grown(kept)
    slip = problem.law_slip + history.store.law_slip[kept.piece] + walked
    reverses = bool(law.reverses)
    turned = np.where(mode < 0, -1.0, 1.0)
    state = one_argument([one * (turned if n in law.reverses else 1.0) for n, one in enumerate(history.states(kept))])
    by_law = mode * NORMAL * law.coefficient(slip, np.abs(rate), state)
    slips = mode != 0
    assert traction[slips] == pytest.approx(by_law[slips], rel=0.0, abs=1e-8 * NORMAL)
    held = np.abs(NORMAL * (law.coefficient(slip, 0.0, state) + law.static_excess))
    assert (np.abs(traction[~slips]) <= held[~slips] + 1e-12 * NORMAL).all()
    assert reverses or (traction * rate >= -1e-14 * NORMAL * np.abs(rate)).all()
    if isinstance(body, ss.ElasticSlab) and body.contact_mass == 0.0:
        assert body.impedance * rate + traction == pytest.approx(run.load(times), rel=0.0, abs=1e-14 * NORMAL)
    energy = run.energy(times[::30])
    assert reverses or (np.diff(energy.heat) >= 0.0).all()
    size = max(float(np.abs(energy[name]).max()) for name in ("heat", "work", "stored", "kinetic"))
    loads = np.abs([*run.load(times), *traction, problem.strength, problem.initial_load or 0.0])
    largest = max(NORMAL, float(loads.max()))
    rounding = 1e-15 * largest**2 / (2.0 * body.stiffness)  # of what is stored, of which all these are differences
    assert float(np.abs(energy.balance).max()) <= 1e-8 * size + rounding


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("kind", ["coulomb", "hyperbolic-rate", "exponential-stribeck", "piecewise-linear-rate", "power-stribeck"])
@given(data=st.data())
@few
def test_the_chosen_rate_is_admissible_and_stable(kind: str, data: st.DataObject) -> None:
    """Relative 1e-6, or 1e-9 m/s, between the folds; at a fold itself two rates are one."""
    problem = data.draw(problems(kind))
    assume(isinstance(problem.body, ss.ElasticSlab) and problem.body.contact_mass == 0.0)
    found = ss.uniqueness(problem)
    assume(found.regime != "continuum")
    run = ran(problem)
    for time in np.linspace(0.0, run.history.duration, 40)[1:]:
        load, rate = float(run.load(time)), float(run.slip_rate(time))
        edges = [fold.load for fold in found.folds] + [found.resistance.strength]
        if min(abs(abs(load) - edge) for edge in edges) < 1e-7 * NORMAL:
            continue
        rates, stable = found.admissible(load), found.stability(load)
        nearest = int(np.argmin(np.abs(rates - rate)))
        assert rates[nearest] == pytest.approx(rate, rel=1e-6, abs=1e-9)
        assert stable[nearest]


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("rate", [0.0, 2e4])
@pytest.mark.parametrize("driver", [math.inf, 0.0, 9.8e6, 9.7e6, 3e6, 1e9])
def test_rest_is_that_of_the_closed_form(driver: float, rate: float) -> None:
    """The load on a contact that stays stuck for 300 round trips, leaps over rest included: 1e-11 of it."""
    far = {} if math.isinf(driver) else {"far_stress": 5e7, "far_stress_rate": rate}
    slab = ss.ElasticSlab(2800, 3500, 1e4, 1e8, driver)
    problem = ss.Problem(slab, ss.friction.Coulomb(100.0, 0.5), pull_rate=0.1, initial_load=4e7, **far)
    run = ss.simulate(problem, 300.3 * slab.two_way_time)
    exact = StuckSlab(slab, 4e7, 0.1, far.get("far_stress", 0.0), far.get("far_stress_rate", 0.0))
    times = (
        np.concatenate((np.linspace(0.0, 6.0, 200), np.linspace(6.0, 300.0, 997))) * slab.two_way_time + 1e-3
    )  # off the breaking points
    assert float(np.ptp(run.slip(times))) == 0.0
    assert run.load(times) == pytest.approx(exact.load(times), rel=1e-11)
