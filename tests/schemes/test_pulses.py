"""Pulses of coarse grids: where a massive contact rolls on, and which schemes do so beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.schemes.run import SCHEMES, run_scheme

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
CRITICAL = 1.193
"""Critical damping of the pendulum whose torque is the largest at which it could rest."""


def speed_at_the_next_maximum(damping: float) -> float:
    """Return p at phi = 5 pi/2 of p dp/dphi = 1 - sin(phi) - damping p, from the path that leaves pi/2 slowly; 0 if it stops."""
    start = 1e-3
    stops = lambda phi, p: p[0] - 1e-9  # noqa: E731 # an attribute is set on it
    stops.terminal = True  # type: ignore[attr-defined]
    path = solve_ivp(
        lambda phi, p: [(1.0 - np.sin(phi)) / p[0] - damping],
        (0.5 * np.pi + start, 2.5 * np.pi),
        [start**2 / (2.0 * damping)],
        events=stops,
        rtol=1e-12,
        atol=1e-14,
        method="LSODA",
    )
    return float(path.y[0, -1]) if path.t[-1] >= 2.5 * np.pi - 1e-9 else 0.0


def test_the_critical_damping_is_1_193() -> None:
    assert speed_at_the_next_maximum(CRITICAL) > 0.0
    assert speed_at_the_next_maximum(CRITICAL + 2e-4) == 0.0


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


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_the_end_of_a_chain_with_half_a_mass_resists_without_inertia_below_the_cut_off(share: float) -> None:
    """Closed form Z sqrt(1 - (frequency / cut-off)^2), against 50 masses, beyond which the chain goes on."""
    mass, stiffness = 1.0, 1.0
    frequency = share * 2.0 * np.sqrt(stiffness / mass)
    wave = 2.0 * np.arcsin(0.5 * frequency)
    count = 50
    matrix = np.zeros((count, count), complex)
    for k in range(count - 1):
        matrix[k : k + 2, k : k + 2] += stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
    matrix -= frequency**2 * np.diag([0.5 * mass, *[mass] * (count - 1)])
    matrix[-1, -1] += stiffness * (1.0 - np.exp(-1j * wave))  # the rest of the chain carries the wave away
    moved = np.linalg.solve(matrix, np.eye(count)[0])
    resistance = 1.0 / (1j * frequency * moved[0])
    assert resistance == pytest.approx(np.sqrt(stiffness * mass) * np.sqrt(1.0 - share**2), rel=1e-9, abs=1e-9)
