"""Stick and slip of a block on a belt by scipy, in the frame of the wall."""

from __future__ import annotations

import math

from scipy.integrate import solve_ivp

from stickslip.problem.loading import LoadingHistory

MASS, STIFFNESS = 2.0, 150.0
"""kg, N/m."""


def by_scipy(belt: LoadingHistory, lasting: float, damping: float, strength: float, sliding: float) -> list[float]:
    """Return the times (s) at which rest begins or ends, from the place and velocity of the block in the frame of the wall.

    Steps end at breaks of the belt's velocity; tolerances are 1e-13 (relative) and 1e-15. A turn without rest is no time.
    """
    amplitude, frequency, phase = belt.tone
    starts = [one.start for one in belt.segments]

    def grows(t: float) -> float:
        return belt.segments[part].slope + amplitude * frequency * math.cos(frequency * t + phase)

    def stuck(t: float, y: list[float]) -> list[float]:
        return [float(belt.at(t)), grows(t)]

    def slides(t: float, y: list[float]) -> list[float]:
        friction = way * sliding + damping * (float(belt.at(t)) - y[1])
        return [y[1], (friction - STIFFNESS * y[0]) / MASS]

    def needed(t: float, y: list[float]) -> float:
        return STIFFNESS * y[0] + MASS * grows(t)

    def yields(t: float, y: list[float]) -> float:
        return abs(needed(t, y)) - strength

    def catches(t: float, y: list[float]) -> float:
        return way * (float(belt.at(t)) - y[1])

    yields.terminal = catches.terminal = True  # type: ignore[attr-defined]
    yields.direction, catches.direction = 1.0, -1.0  # type: ignore[attr-defined]
    t, y, way, part, found = 0.0, [0.0, float(belt.at(0.0))], 0.0, 0, list[float]()
    while t < lasting:
        part = sum(start <= t for start in starts) - 1
        until = min([lasting, *(start for start in starts if start > t)])
        if way == 0.0 and yields(t, y) > 0.0:
            found.append(t)
            way = math.copysign(1.0, needed(t, y))
        change, event = (stuck, yields) if way == 0.0 else (slides, catches)
        run = solve_ivp(change, (t, until), y, "DOP853", rtol=1e-13, atol=1e-15, events=event, max_step=0.02)
        t, y = float(run.t[-1]), run.y[:, -1].tolist()
        if run.status != 1:
            continue
        y[1] = float(belt.at(t))
        if way == 0.0 or yields(t, y) <= 0.0:
            found.append(t)
        way = 0.0 if way != 0.0 and yields(t, y) <= 0.0 else math.copysign(1.0, needed(t, y))
    return found
