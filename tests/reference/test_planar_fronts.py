"""Fronts along a slab, by the volume method. Units: rho = c = h = 1, stress drop 1, so that G0 = 1/2 and final slip is 1."""

from __future__ import annotations

import math

import numpy as np
import pytest

from stickslip.reference.planar import PlanarCase, Volume
from stickslip.reference.planar.closed_forms import SteadyFront
from stickslip.reference.planar.setting import Array

FRONT = SteadyFront(1.0, 1.0, 1.0, 1.0)
NODES_PER_THICKNESS = 32
DROP = 1.5
"""Static minus dynamic strength of the faults on which fronts run by themselves."""


class MovedFront:
    """Strength that rises by 5 per unit of distance ahead of |y| = tip, up to a strength that falls linearly with slip.

    Behind the tip strength is `dynamic`. The tip is moved from outside.
    """

    def __init__(self, y: Array, dynamic: float, distance: float = math.inf) -> None:
        self.y, self.dynamic, self.distance, self.tip = np.abs(y), dynamic, distance, 0.0

    def __call__(self, slip: Array, rate: Array, nodes: np.ndarray) -> tuple[Array, Array, Array]:
        moved, none = 5.0 * np.maximum(self.y[nodes] - self.tip, 0.0), np.zeros(len(nodes))
        if self.distance == math.inf:
            return self.dynamic + moved, none, none
        own = DROP * np.maximum(1.0 - np.abs(slip) / self.distance, 0.0)
        by_slip = np.where((own < moved) & (own > 0.0), -DROP / self.distance * np.sign(slip), 0.0)
        return self.dynamic + np.minimum(own, moved), by_slip, none


def _nodes(length: float) -> Array:
    return np.arange(length * NODES_PER_THICKNESS) / NODES_PER_THICKNESS - 0.5 * length


@pytest.mark.parametrize("speed", [0.5, 0.9])
def test_a_steady_front_releases_g0_at_any_speed(speed: float) -> None:
    """Released energy per area within 1e-3, and slip behind as in closed form within 1 %, from 2 h behind the front on."""
    y = _nodes(48.0)
    friction = MovedFront(y, 0.0)
    case = PlanarCase(1.0, 1.0, 1.0, (48.0,), np.ones(len(y)), friction)
    end = 20.0 / speed + 5.0
    run = Volume(case, 2 * NODES_PER_THICKNESS, end)
    tips, energies = [], []
    while run.time < end:
        middle = run.time + 0.5 * run.step_of_time
        friction.tip = speed * (middle - 5.0 * math.tanh(middle / 5.0))
        run.advance()
        tips.append(friction.tip)
        energies.append(run.energy())
    late = np.array(tips) > 14.0
    released = -0.5 * np.polyfit(np.array(tips)[late], np.array(energies)[late], 1)[0]  # there are two fronts
    assert released == pytest.approx(FRONT.released_energy, rel=1e-3)
    behind = friction.tip - y
    compared = (behind > 2.0) & (behind < 4.0)
    assert run.slip[compared] == pytest.approx(FRONT.slip(behind[compared], speed), abs=1e-2)


def _run_free(ratio: float, duration: float) -> tuple[Array, Array, Volume]:
    """Start two fronts at half the wave speed, let them go at |y| = 4, and return y > 0 and when it has lost its strength.

    Fracture energy is `ratio` times G0.
    """
    y = _nodes(32.0)
    friction = MovedFront(y, 1.0, ratio / DROP)
    run = Volume(PlanarCase(1.0, 1.0, 1.0, (32.0,), np.full(len(y), 2.0), friction), 2 * NODES_PER_THICKNESS, duration)
    weak = np.full(len(y), np.nan)
    while run.time < duration:
        middle = run.time + 0.5 * run.step_of_time
        friction.tip = min(0.5 * (middle - 2.0 + 2.0 * math.exp(-0.5 * middle)), 4.0)
        run.advance()
        weak[np.isnan(weak) & (run.slip >= friction.distance)] = run.time
    return y[y > 0.0], weak[y > 0.0], run


def _speed(y: Array, weak: Array, low: float, high: float) -> float:
    chosen = (y >= low) & (y <= high)
    return float(1.0 / np.polyfit(y[chosen], weak[chosen], 1)[0])


def test_a_front_stops_if_fracture_energy_exceeds_g0() -> None:
    y, weak, run = _run_free(1.05, 20.0)
    assert 4.0 < y[np.isfinite(weak)].max() < 6.0
    assert not run.slip_rate[np.abs(run.case.nodes()[0]) > 7.0].any()


def test_a_front_runs_steadily_if_fracture_energy_is_g0() -> None:
    """Its speed stays within 1 %. Slip behind ends within 1.5 % of drop h / G."""
    y, weak, run = _run_free(1.0, 20.0)
    first, second = _speed(y, weak, 4.5, 6.5), _speed(y, weak, 7.5, 9.5)
    assert first == pytest.approx(0.555, abs=0.01)
    assert second == pytest.approx(first, rel=1e-2)
    slip = run.slip[len(run.slip) // 2 + 1 :]
    assert slip[(y > 4.0) & (y < 7.0)] == pytest.approx(FRONT.final_slip, rel=1.5e-2)


def test_a_front_speeds_up_towards_c_if_g0_exceeds_fracture_energy() -> None:
    y, weak, _ = _run_free(0.8, 18.0)
    speeds = [_speed(y, weak, low, low + 2.0) for low in (4.5, 6.5, 9.0, 12.0)]
    assert np.all(np.diff(speeds) > 0.0)
    assert 0.98 < speeds[-1] < 1.0
