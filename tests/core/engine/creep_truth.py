"""Truth for the tests of leaps over creep: the printed slab of Fig. 5, pulled `faster` times faster, every round trip run.

    python -m tests.core.engine.creep_truth 1 64000

prints the time at which slip has grown by 1 cm, in the middle of the first dynamic pulse. The method shares nothing with the
package: the load at so many offsets of the round trip, friction and slip by the implicit midpoint rule. With 64000 of them its
error is below 1e-6 s for 10 and 100, where the engine itself runs every round trip (134 million pieces for 10).
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numba
import numpy as np

import stickslip as ss

GROWN = 0.01
ROUND, IMPEDANCE = 2 * 1e4 / 3500.0, 2800.0 * 3500.0


def printed(faster: float) -> ss.Problem:
    """The printed slab, pulled so many times faster."""
    problem = ss.load_scenario("fig5-slab-printed").problem
    return replace(problem, pull_rate=faster * problem.pull_rate)


@numba.njit  # type: ignore[untyped-decorator]
def by_grid(points: int, pull_rate: float, first_slip: float, excess: float) -> float:
    """Time (s) at which slip has grown by GROWN, with the load at `points` offsets of the round trip."""
    normal, amplitude, wavenumber = 1e8, 0.5, 5.0
    step, load, slip = ROUND / points, np.empty(points), 0.0
    for i in range(points):
        load[i] = excess + 2.0 * IMPEDANCE * pull_rate / ROUND * (i + 0.5) * step
    sine, cosine = normal * amplitude * np.sin(wavenumber * first_slip), normal * amplitude * np.cos(wavenumber * first_slip)
    row = 0
    while True:
        for i in range(points):
            s, half = np.sin(wavenumber * slip), np.sin(0.5 * wavenumber * slip)
            friction = cosine * s - 2.0 * sine * half * half
            rate = 0.0
            if load[i] > friction:
                falling = wavenumber * (sine * s - cosine * np.cos(wavenumber * slip))
                rate = (load[i] - friction) / (IMPEDANCE - 0.5 * step * falling)
            if slip + rate * step > GROWN:
                return row * ROUND + i * step + (GROWN - slip) / rate
            slip += rate * step
            load[i] += 2.0 * IMPEDANCE * (pull_rate - rate)
        row += 1


if __name__ == "__main__":
    problem = printed(float(sys.argv[1]))
    sys.stdout.write(f"{by_grid(int(sys.argv[2]), problem.pull_rate, problem.initial_slip, problem.excess)!r}\n")
