"""Runs that several tests of observables share, and what is measured on them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

import stickslip as ss
from tests.problems import CRITICAL, SLAB, rate_law_slab, slip_law_slab

F = ss.friction
HEAVY = replace(SLAB, contact_mass=1e6)
LOSSY = replace(SLAB, driver_impedance=3.0 * SLAB.impedance)
MAXIMAL = (rate_law_slab(selection="maximal"), 380 * ss.YEAR)
RUNS = {
    "slab, rate law, 468 years": (rate_law_slab(), 480 * ss.YEAR),
    "slab, rate law, maximal": MAXIMAL,
    "slab, just above critical": (rate_law_slab(alpha=CRITICAL + 1e-6), 93_910.0),
    "slab, slip law": (slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0),
    "slab, contact mass": (
        ss.Problem(HEAVY, F.Coulomb(0.8, 0.3), pull_rate=1e-3, initial_excess=0.0),
        30.0,
    ),
    "slab, lossy": (ss.Problem(LOSSY, F.Coulomb(0.8, 0.3), initial_excess=1e5, far_stress=7e7, far_stress_rate=1.0), 60.0),
    "block, damped": (ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0, damping=1.0), F.Coulomb(0.4, 0.3), 1e-3, initial_excess=0.0), 1e3),
}


@cache
def run_of(name: str) -> ss.Solution:
    """Return one of these runs, computed once."""
    return ss.simulate(*RUNS[name], rtol=1e-12)


def worst_imbalance(run: ss.Solution) -> float:
    """Return the largest imbalance of the energies of a run as a share of the energy released (heat at the end)."""
    energy = run.energy(np.linspace(0.0, run.duration, 41))
    return float(np.abs(energy.balance).max() / energy.heat[-1])


def slab_of(run: ss.Solution) -> ss.ElasticSlab:
    """Return the slab of a run."""
    assert isinstance(run.problem.body, ss.ElasticSlab)
    return run.problem.body
