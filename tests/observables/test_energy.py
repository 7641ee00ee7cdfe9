"""The energy balance closes, and does not close for nonsense."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.evolution.history import History
from tests.evolution import problems
from tests.evolution.test_against_method_of_steps import KINDS
from tests.evolution.test_verified_numbers import (
    IMPEDANCE,
    MODULUS,
    RATE_LAW,
    ROUND,
    SLAB,
    THICKNESS,
    rate_law_slab,
    slip_law_block,
    slip_law_slab,
)

RUNS = {
    "slab, slip law": (slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0),
    "slab, slip law, printed": (slip_law_slab(5.0, 1e-3), 20.0),
    "slab, rate law": (rate_law_slab(), 20.0),
    "slab, just above critical": (rate_law_slab(alpha=IMPEDANCE / 5e7 + 1e-6), 20.0),
    "block, slip law": (slip_law_block(5.0, MODULUS * 1e3), 5.0),
    "dead load, through both folds": (
        ss.Problem(replace(SLAB, driver_impedance=0.0), RATE_LAW, pull_rate=2.6, initial_load=60e6),
        12.0,
    ),
}


def worst(run: ss.Solution) -> float:
    """Largest imbalance as a share of the energy released (heat at the end)."""
    energy = run.energy(np.linspace(0.0, run.duration, 41))
    return float(np.abs(energy.balance).max() / energy.heat[-1])


@pytest.mark.parametrize("name", RUNS)
def test_balance_closes(name: str) -> None:
    assert worst(ss.simulate(*RUNS[name], rtol=1e-12)) < 1e-9


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", KINDS)
def test_balance_closes_on_random_problems(kind: str, seed: int) -> None:
    rng = np.random.default_rng([seed, 77, *kind.encode()])
    body, law = KINDS[kind](rng)
    run = ss.simulate(problems.problem(rng, body, law), problems.duration(body, 3.3), rtol=1e-12)
    assert worst(run) < 1e-9


@pytest.mark.parametrize("name", ["slab, slip law", "slab, rate law", "block, slip law"])
def test_balance_notices_a_wrong_slip_rate(name: str) -> None:
    run = ss.simulate(*RUNS[name], rtol=1e-12)
    store = run.history.store
    wrong = store._replace(rate=store.rate * 1.001)
    history = History(wrong, run.problem, run.history.row_time, run.history.ramp, run.duration)
    assert worst(replace(run, history=history)) > 1e-6


def test_energy_against_its_definition() -> None:
    """At rest and uniformly stressed, a slab stores tau^2 h / (2 G); the first slip of the rate law sheds what the table says."""
    run = ss.simulate(rate_law_slab(), 20.0)
    # Coulomb-like round trip: after arrest the stress is uniform again but for the law's curvature
    end = run.energy(20.0)
    stress_before, stress_after = 8e7, float(run.traction(19.9))
    stored = (stress_after**2 - stress_before**2) * THICKNESS / (2 * MODULUS)
    assert float(end.stored[0]) == pytest.approx(stored, rel=1e-6, abs=0.0)


def test_matched_driver_swallows_what_comes() -> None:
    """r = 0: the load is the far stress for ever, slip is radiation-damped, Z v = tau0 - S mu."""
    matched = replace(SLAB, driver_impedance=SLAB.impedance)
    law = ss.friction.Coulomb(0.8, 0.3)
    run = ss.simulate(ss.Problem(matched, law, initial_load=8.5e7), 40.0)
    times = np.linspace(0.0, 40.0, 100)
    assert run.slip_rate(times) == pytest.approx(np.full(100, (8.5e7 - 3e7) / SLAB.impedance), rel=1e-14, abs=0.0)
    energy = run.energy(times)
    assert float(np.abs(energy.balance).max() / energy.heat[-1]) < 1e-12


def test_energies_start_at_zero_and_have_units() -> None:
    run = ss.simulate(rate_law_slab(), 2 * ROUND)
    energy = run.energy([0.0, ROUND])
    assert [float(energy[name][0]) for name in ("work", "stored", "heat", "damped", "balance")] == [0.0] * 5
    assert energy.heat.attrs["units"] == "J m-2"
    with pytest.raises(ss.InputError):
        run.energy(100.0)
