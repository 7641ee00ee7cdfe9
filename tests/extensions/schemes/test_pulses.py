"""Pulses of coarse grids: where a massive contact rolls on, and which schemes do so beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.schemes.run import SCHEMES, run_scheme

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
CRITICAL = 1.193
"""Critical damping of the pendulum whose torque is the largest at which it could rest: p dp/dphi = 1 - sin(phi) - damping p."""


@pytest.mark.parametrize(("gamma", "rolls"), [(1.38, False), (1.43, True)])
def test_a_massive_contact_rolls_over_the_next_barrier_below_the_critical_damping(gamma: float, rolls: bool) -> None:
    assert (gamma > 2.0 / CRITICAL**2) == rolls
    mass = 0.5 * 2800.0 * gamma * SLAB.shear_modulus / (1e8 * 0.5 * 50.0)
    law = ss.friction.SinusoidalSlip(1.0, 0.5, 50.0)
    problem = ss.Problem(
        replace(SLAB, contact_mass=mass), law, initial_slip=np.pi / 100 + 1e-3, initial_excess=5e7 * (1.0 - np.cos(0.05))
    )
    slip = float(ss.simulate(problem, 5.7).slip(5.7)) - problem.initial_slip
    assert (slip > 2.5 * np.pi / 50.0) == rolls


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(
    ("name", "gamma", "several"),
    [
        ("central-differences", 1.0, True),
        ("central-differences", 0.5, False),
        ("newmark", 0.85, True),
        ("newmark", 0.5, False),
        ("mass-redistribution", 1.35, True),
        ("mass-redistribution", 0.85, False),
        ("backward-euler", 3.0, False),
        ("sbp4", 2.0, False),
    ],
)
def test_coarse_grids_pass_the_next_maximum_and_fine_ones_do_not(name: str, gamma: float, several: bool) -> None:
    """One pulse is exact; cells by Gamma = S a omega dx / G, omega = 5 /m, Courant number 0.5; see docs/scheme_pulses.py."""
    omega, beyond = 5.0, 1e-2
    law = ss.friction.SinusoidalSlip(1.0, 0.5, omega)
    excess = 5e7 * (1.0 - np.cos(omega * beyond))
    problem = ss.Problem(SLAB, law, initial_slip=0.5 * np.pi / omega + beyond, initial_excess=excess)
    cells = round(1e4 * 1e8 * 0.5 * omega / (SLAB.shear_modulus * gamma))
    slip = run_scheme(problem, SLAB.two_way_time, SCHEMES[name], cells, courant=0.5).slip[-1]
    assert (slip + beyond > 1.01 * 2.0 * np.pi / omega) == several
