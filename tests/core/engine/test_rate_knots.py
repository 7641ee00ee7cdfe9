"""Laws with kinks in slip rate: closed forms on each straight stretch, scipy for the block, every root for the massless slab."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import stickslip as ss

Z, S = 9.8e6, 1e8
SLAB = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=S)
HALF = SLAB.two_way_time / 2
LAW = ss.friction.PiecewiseLinearRate(rates=(0.0, 0.5, 1.5, 2.0, 3.0), coefficients=(0.6, 0.45, 0.52, 0.4, 0.38))
"""g falls, rises, falls and rises: Z = 0.098 S, against slopes of -0.3, 0.07, -0.24 and -0.02 S."""


def test_a_contact_with_mass_passes_knots_when_the_closed_form_says_so() -> None:
    """m dv/dt = F - b (v - v0) on each stretch, b = Z + S mu': from v0 to v1 in -(m/b) ln(1 - b (v1 - v0) / F)."""
    mass, excess = 1e6, 3e7
    problem = ss.Problem(replace(SLAB, driver_impedance=Z, contact_mass=mass), LAW, initial_excess=excess)
    run = ss.simulate(problem, HALF)
    pieces = run.history.store.law_piece
    passed = [float(run.history.start[np.flatnonzero(pieces == piece)[0]]) for piece in range(1, 5)]
    time, expected = 0.0, []
    for v0, v1 in zip(LAW.rates[:-1], LAW.rates[1:], strict=True):
        mu0, mu1 = (float(LAW.coefficient(0.0, v)) for v in (v0, v1))
        b, force = Z + S * (mu1 - mu0) / (v1 - v0), excess + S * LAW.coefficients[0] - Z * v0 - S * mu0
        time -= mass / b * math.log1p(-b * (v1 - v0) / force)
        expected.append(time)
    assert passed == pytest.approx(expected, rel=1e-10, abs=0.0)
    assert run.slip_rate(np.array(passed)) == pytest.approx(LAW.rates[1:], rel=1e-10, abs=0.0)


def stable_rates(load: float) -> list[float]:
    """Every stable solution of Z v + S mu(v) = load with v >= 0, exact on each straight stretch; stick included."""
    places = [*LAW.rates, 1e3]
    values = [Z * v + S * float(LAW.coefficient(0.0, v)) for v in places]
    found = [0.0] if load <= values[0] else []
    for (v0, g0), (v1, g1) in pairwise(zip(places, values, strict=True)):
        if g0 < load < g1:
            found.append(v0 + (load - g0) / (g1 - g0) * (v1 - v0))
    return found


def ramp_run(selection: str) -> ss.Solution:
    """The load rises linearly for h/c from below every fold to beyond all of them, and falls back as it rose."""
    slab = replace(SLAB, driver_impedance=0.0)
    return ss.simulate(ss.Problem(slab, LAW, pull_rate=2.5, initial_load=48e6, selection=selection), 2 * HALF - 1e-9)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("selection", "pick"), [("minimal", min), ("maximal", max)])
def test_minimal_and_maximal_rules_take_the_smallest_and_largest_root_of_a_polyline(
    selection: str, pick: Callable[[list[float]], float]
) -> None:
    run = ramp_run(selection)
    times = np.linspace(0.0, 2 * HALF - 1e-9, 1201)[1:-1]
    expected = [pick(stable_rates(load)) for load in run.load(times).tolist()]
    assert run.slip_rate(times) == pytest.approx(expected, rel=1e-12, abs=1e-12)
    assert len(run.shocks) >= 4


def test_perfect_delay_leaves_a_branch_only_where_it_ends() -> None:
    run = ramp_run("perfect-delay")
    g = {v: Z * v + S * float(LAW.coefficient(0.0, v)) for v in LAW.rates}
    slope = Z * 2.5 / HALF
    levels_up, levels_down = [g[0.0], g[1.5]], [g[2.0], g[0.5]]
    top = 48e6 + slope * HALF
    expected = [(level - 48e6) / slope for level in levels_up] + [HALF + (top - level) / slope for level in levels_down]
    assert list(run.shocks.cause) == ["fold"] * 4
    assert run.shocks.time.to_numpy() == pytest.approx(expected, rel=1e-11, abs=0.0)
    assert run.shocks.rate_before.to_numpy() == pytest.approx([0.0, 1.5, 2.0, 0.5], rel=1e-11, abs=0.0)
