"""The machine code for disturbances along a run, against NumPy, differences of runs, and closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine import Positions
from stickslip.extensions.cycles.compiled.radau import COEFFICIENTS, RADAU_PLACES, STAGES
from stickslip.extensions.cycles.section import passages
from stickslip.extensions.cycles.tangent import Tangent, pace_at, values_at
from tests.extensions.cycles import by_numpy
from tests.extensions.cycles.problems import DISTANCE, DYNAMIC, MASS, NORMAL, PULL, STIFFNESS, A, B, coulomb

F = ss.friction
BLOCK = ss.SpringBlock(MASS, STIFFNESS, NORMAL)


def law_of(number: int, random: np.random.Generator) -> tuple[Any, dict[str, Any]]:
    """Return a law with random numbers, of each kind in turn, and how a run under it starts."""
    a, b, scale = random.uniform(0.1, 0.4), random.uniform(0.05, 0.4), 10.0 ** random.uniform(-2.0, 0.0)
    slow = {"initial_rate": 0.05, "initial_load": 4.0}
    made: list[tuple[Any, dict[str, Any]]] = [
        (F.FromExpression("p + q*exp(-v/r) + 0.05*v", {"p": a, "q": b, "r": scale}), {}),
        (F.BothWays(F.Coulomb(a + b, a), F.HyperbolicRate(0.5, 0.2, 1.0 / scale)), {}),
        (F.LaggedFriction(rate=F.HyperbolicRate(a + b, a, 1.0 / scale), time=0.02), {"initial_state": 0.0}),
        (F.LuGre(static=a + b, dynamic=a, rate=scale, stiffness="1e4 1/m", damping="3 s/m"), {"initial_state": 0.0}),
        (F.RateAndState(0.5, 0.01, 0.005 + 0.02 * b, distance=scale, evolution="slip"), slow | {"initial_state": 0.1 * scale}),
        (
            F.TwoStateRateAndState(0.5, A, B, DISTANCE, second_b=0.01 * a, second_distance=scale),
            slow | {"initial_state": DISTANCE, "initial_second_state": scale},
        ),
    ]
    return made[number % len(made)]


@pytest.mark.sampled(every=22)
@pytest.mark.parametrize("number", range(60))
def test_disturbances_grow_as_numpy_says(number: int) -> None:
    """Random laws without states, with one and with two, in slip, at rest and backwards: to 1e-9 of the largest entry."""
    random = np.random.default_rng(number)
    law, start = law_of(number, random)
    body = ss.SpringBlock(1.0, 10.0 ** random.uniform(2.0, 3.5), 10.0, damping=random.uniform(0.0, 3.0))
    problem = ss.Problem(body, law, pull_rate=random.uniform(0.02, 0.3), **({"initial_load": 0.0} | start))
    history = ss.simulate(problem, random.uniform(0.05, 0.4), 1e-12).history
    last, place = len(history) - 1, random.uniform(0.2, 1.0)
    found, own = Tangent(history, last, place).grown(), by_numpy.grown(history, last, place)
    scale = np.abs(values_at(history, Positions.inside(np.arange(last + 1), 0.5))).max(axis=1) + 1e-6
    shares = found * scale / scale[:, None]
    assert shares == pytest.approx(own * scale / scale[:, None], rel=0.0, abs=1e-9 * np.abs(own * scale / scale[:, None]).max())
    rough = Tangent(history, last, place).grown(exactly=False) * scale / scale[:, None]
    assert rough == pytest.approx(shares, rel=0.0, abs=1e-4 * np.abs(shares).max())
    for piece in {0, last // 2, last}:
        paces = by_numpy.pace(history, piece, 0.3)
        assert pace_at(history, piece, 0.3) == pytest.approx(paces, rel=1e-6, abs=1e-6 * np.abs(paces).max())


def swinging() -> ss.Problem:
    """Return a block that passes the pull rate under Coulomb friction, with so little swing that it never rests."""
    return replace(coulomb(), initial_load=DYNAMIC * NORMAL + 1.0, initial_rate=PULL)


def test_a_free_oscillation_turns_disturbances_by_its_phase_and_a_rest_ends_that_of_the_slip_rate() -> None:
    """Under Coulomb friction slip is a sinusoid: after a time t the matrix is a rotation by omega t, to 1e-12."""
    history = ss.simulate(swinging(), 0.01, 1e-13).history
    phase, impedance = math.sqrt(1e3) * 0.01, math.sqrt(1e3)
    turned = [
        [math.cos(phase), -impedance * math.sin(phase)],
        [math.sin(phase) / impedance, math.cos(phase)],
    ]
    assert Tangent(history, len(history) - 1, 1.0).grown() == pytest.approx(np.array(turned), rel=1e-12, abs=1e-14)
    history = ss.simulate(coulomb(), 0.3, 1e-13).history
    rest = int(np.flatnonzero(history.store.mode == 0)[1])
    grown = Tangent(history, rest, 0.5).grown()
    assert grown[1] == pytest.approx(np.zeros(2), abs=1e-14)


def test_two_tables_of_radau_integrate_polynomials_exactly() -> None:
    """Coefficients give the integrals of powers up to the number of points, to 1e-14; weights up to twice as many."""
    for method, stages in enumerate(STAGES):
        places, coefficients = RADAU_PLACES[method, :stages], COEFFICIENTS[method, :stages, :stages]
        for power in range(stages):
            assert coefficients @ places**power == pytest.approx(places ** (power + 1) / (power + 1), rel=0.0, abs=1e-14)
        for power in range(2 * stages - 1):
            assert coefficients[-1] @ places**power == pytest.approx(1.0 / (power + 1), rel=0.0, abs=1e-14)


def test_passages_are_one_period_of_a_free_oscillation_apart() -> None:
    """Without rest each passage of the pull rate upwards is 2 pi / omega after the one before it, to 1e-12 of the time."""
    run = ss.simulate(swinging(), 1.0, 1e-13)
    met = passages(run.history)
    period = 2.0 * math.pi / math.sqrt(1e3)
    assert met.time == pytest.approx(period * np.arange(1, len(met.time) + 1), rel=1e-12)
    assert len(met.time) == int(1.0 / period)
    assert values_at(run.history, Positions.inside(met.piece, met.place))[1] == pytest.approx(PULL, rel=1e-13)


@pytest.mark.parametrize("body", [BLOCK, BLOCK.on_belt(), ss.SpringBlock(MASS, STIFFNESS, NORMAL, damping=1.0, driver_damping=2.0)])
def test_the_largest_slip_rate_and_traction_of_a_cycle_are_those_on_a_fine_grid_of_times(body: Any) -> None:
    """On 100 001 times, with the law's own friction: no time has more (1e-12), and one comes to 1e-4 of the largest of an event."""
    law = F.BothWays(F.Coulomb(0.9, 0.1), F.HyperbolicRate(0.3, 0.05, 10.0))
    found = ss.studies.cycle(ss.Problem(body, law, pull_rate=0.1, initial_load=0.0))
    times = np.linspace(0.0, found.period, 100_001)
    for values, most, least in (
        (found.run.slip_rate(times), found.greatest_rate, found.least_rate),
        (found.run.traction(times), found.greatest_traction, found.least_traction),
    ):
        size = np.abs(values).max()
        assert (most, least) == pytest.approx((values.max(), values.min()), rel=0.0, abs=1e-4 * size)
        assert values.max() <= most + 1e-12 * size
        assert values.min() >= least - 1e-12 * size
