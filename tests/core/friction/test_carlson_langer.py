"""Carlson and Langer's law in the literature's numbers, and a block and a slab under it as scipy has them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.foundation.arrays import Floats


def test_it_is_the_law_of_the_literature_in_its_numbers() -> None:
    """Friction over the static strength is (1 - sigma) / (1 + 2 alpha v / (1 - sigma)), and 1 at rest (Carlson et al. 1994)."""
    sigma, alpha = 0.01, 2.5
    law = ss.friction.CarlsonLanger(1.0, sigma, (1.0 - sigma) / (2.0 * alpha))
    v = np.array([0.0, 1e-9, 0.1, 1.0, 30.0])
    np.testing.assert_allclose(law.coefficient(0.0, v), (1 - sigma) / (1 + 2 * alpha * v / (1 - sigma)), rtol=1e-15)
    assert float(law.static_coefficient(0.0)) == 1.0
    assert law.range() == (0.0, 1.0)


def block_by_solve_ivp(given: ss.Problem, times: Floats) -> tuple[Floats, list[float]]:
    """Return slip and slip rate (rows) of a block that slips forwards from rest, and when slip begins (s)."""
    body: Any = given.body
    law: Any = given.friction
    rate: Any = given.pull_rate
    found, time, slip, begins = np.zeros((2, len(times))), 0.0, 0.0, []
    strength = law.static * body.normal_force
    pull = body.stiffness * rate
    while True:
        start = time + (strength - (given.load + pull * time - body.stiffness * slip)) / pull
        found[0, (times >= time) & (times < start)] = slip
        if start >= times[-1]:
            return found, begins
        begins.append(start)

        def moves(t: float, y: Floats) -> list[float]:
            friction = body.normal_force * law.static * (1.0 - law.drop) / (1.0 + max(y[1], 0.0) / law.rate)
            return [y[1], (given.load + pull * t - body.stiffness * y[0] - friction) / body.mass]

        first = strength * law.drop / body.mass
        kick = 1e-9

        def stops(_: float, y: Floats) -> float:
            return float(y[1])

        stops.terminal, stops.direction = True, -1  # type: ignore[attr-defined]
        y = [slip + 0.5 * first * kick**2, first * kick]
        options: dict[str, Any] = {"rtol": 1e-12, "atol": 1e-15, "events": stops, "dense_output": True}
        solved = solve_ivp(moves, (start + kick, times[-1] + 1.0), y, "DOP853", **options)
        inside = (times >= start + kick) & (times <= solved.t[-1])
        found[:, inside] = solved.sol(times[inside])
        time, slip = float(solved.t[-1]), float(solved.y[0, -1])


def test_a_block_sticks_and_slips_as_solve_ivp_says() -> None:
    law = ss.friction.CarlsonLanger(0.5, 0.1, 0.2)
    given = ss.Problem(ss.SpringBlock(1.0, 100.0, 10.0), law, pull_rate=0.05, initial_load=4.9)
    times = np.linspace(0.0, 6.0, 301)
    own, begins = block_by_solve_ivp(given, times)
    run = ss.simulate(given, 6.0, rtol=1e-12)
    assert len(begins) > 2
    np.testing.assert_allclose(run.events.start, begins, rtol=1e-9)
    np.testing.assert_allclose(run.slip(times), own[0], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(run.slip_rate(times), own[1], rtol=0.0, atol=1e-7)


def test_a_slab_jumps_to_the_root_of_its_contact_equation() -> None:
    """Before the first echo Z v + S mu(v) = load: the fastest root, by brentq, follows the load that grows."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 6e3, 1e8)
    law = ss.friction.CarlsonLanger(0.6, 0.05, 2.0)
    given = ss.Problem(slab, law, pull_rate=1.0, initial_excess=0.0)
    run = ss.simulate(given, 3.0, rtol=1e-12)
    impedance, normal = 2800.0 * 3500.0, 1e8
    for time in (0.0, 0.7, 2.9):
        load = 6e7 + 2800.0 * 3500.0**2 * time / 6e3
        rate = brentq(lambda v, load=load: impedance * v + normal * 0.57 / (1 + v / 2.0) - load, 3.0, 50.0, xtol=1e-15, rtol=1e-15)
        assert float(run.slip_rate(time)) == pytest.approx(rate, rel=1e-11)
    assert math.isclose(float(run.traction(0.0)), normal * 0.57 / (1 + float(run.slip_rate(0.0)) / 2.0), rel_tol=1e-12)


def test_a_drop_is_a_share() -> None:
    with pytest.raises(ss.InputError, match=r"CarlsonLanger: drop is a share of static friction, at most 1, got 1\.5"):
        ss.friction.CarlsonLanger(0.6, 1.5, 1.0)
