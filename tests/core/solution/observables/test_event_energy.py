"""Energies of single slip events, late in a run too, and the waves that an event leaves behind."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from tests.core.solution.observables.runs import LOSSY, F, run_of
from tests.problems import IMPEDANCE, ROUND, SLAB, rate_law_slab


def test_energies_of_events_are_those_of_the_run() -> None:
    run = run_of("slab, contact mass")
    table = run.catalogue(0.0, energy=True)
    ends, starts = run.energy(table.end), run.energy(table.start)
    for name, sign in (("stored", -1.0), ("work", 1.0), ("heat", 1.0)):
        ours = table["released" if name == "stored" else name]
        theirs = sign * (ends[name].values - starts[name].values)
        assert ours.to_numpy() == pytest.approx(theirs, rel=1e-9, abs=1e-9 * table.released.max()), name
    assert table.trapped.to_numpy() == pytest.approx(ends.trapped.values, rel=1e-6, abs=0.0)


def test_energy_balances_late_in_a_run_in_seconds_and_in_local_time() -> None:
    run = ss.simulate(rate_law_slab(), 480 * ss.YEAR)
    window, event = run.window(1), run.events.iloc[1]
    local = np.linspace(-1.0, 7.0, 33)
    parts = window.energy(local)
    released = 9.3292128e8
    assert float(parts.heat[-1]) == pytest.approx(released, rel=1e-8, abs=0.0)
    assert float(np.abs(parts.balance).max()) < 1e-12 * released
    assert float(window.energy(0.0).heat[0]) == 0.0
    assert float(np.abs(run.energy(event.start + local).balance).max()) < 1e-12 * released


def test_trapped_energy_agrees_with_the_load_that_comes_back() -> None:
    """At rest the waves inside are the load that is still to come and what went before: read from the contact, added up by hand."""
    run = run_of("slab, slip law")
    now, half = 7.0, ROUND / 2
    away = (np.arange(200_000) + 0.5) * half / 200_000
    down, up = run.load(now + away), 2.0 * IMPEDANCE * run.slip_rate(now - away) - run.load(now - away)
    stress, rate = (down - up) / 2, (down + up) / (2 * IMPEDANCE)
    drift = rate - run.problem.pull_rate * away / half
    density = (stress - stress.mean()) ** 2 / (2 * SLAB.shear_modulus) + SLAB.density * drift**2 / 2
    by_hand = density.mean() * SLAB.thickness
    assert by_hand > 1e7
    assert float(run.energy(now).trapped[0]) == pytest.approx(by_hand, rel=1e-5, abs=0.0)
    # it stays: a rigid driver lets nothing out
    assert run.energy([6.0, 12.0, 19.0]).trapped.values == pytest.approx(np.full(3, by_hand), rel=1e-5, abs=0.0)


def test_steady_pull_is_no_wave() -> None:
    """Rest under a fast rigid driver: the shear that it forces on the slab is not trapped energy. A dead load traps nothing new."""
    problem = ss.Problem(SLAB, F.Coulomb(0.8, 0.3), pull_rate=1.0, initial_load=0.0)
    run = ss.simulate(problem, 20.0)
    energy = run.energy([0.0, 1.0, ROUND, 19.0])
    assert (energy.stored[1:] > 1e6).all()
    assert energy.trapped.values == pytest.approx(np.zeros(4), rel=0.0, abs=1e-6)


def test_waves_leave_through_a_driver_that_lets_them_out() -> None:
    run = run_of("slab, lossy")
    energy = run.energy(run.events.end[0] + np.arange(1, 6) * ROUND).trapped.values
    assert energy[0] > 1e4
    assert energy[1:] / energy[:-1] == pytest.approx(np.full(4, LOSSY.reflection**2), rel=1e-3, abs=0.0)


def test_the_report_says_how_much_is_trapped() -> None:
    slab = run_of("slab, slip law")
    assert f"{float(slab.energy(20.0).trapped[0]):.6g} J/m2 in waves at the end" in repr(slab)
    assert "in waves" not in repr(run_of("block, damped"))
