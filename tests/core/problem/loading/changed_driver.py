"""A slab whose driver changes, by the recursion for its load alone, at one moment after another."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stickslip.foundation.arrays import Floats


def by_recursion(
    time: Floats,
    trip: int,
    impedance: float,
    *,
    start: tuple[float, float],
    driver: Callable[[float], float],
    pull: Callable[[float], float],
    far: Callable[[float], float],
    strengths: tuple[float, float],
) -> tuple[Floats, Floats]:
    """Return load (Pa) and slip rate (m/s) at evenly spaced times (s), `trip` of which are a round trip, under Coulomb friction.

    `start` is the load at first and its growth for h/c (Pa/s); `strengths` are static and dynamic (Pa).
    """
    load, rate = np.zeros((2, len(time)))
    round_trip = trip * (time[1] - time[0])
    half, (tau, slope) = 0.5 * round_trip, start
    static, dynamic = strengths
    mode = 0
    for n, t in enumerate(time):
        if t < half:
            load[n] = tau + slope * t
        else:
            sent = t - half
            left = 2.0 * impedance * rate[n - trip] - load[n - trip] if n >= trip else slope * (round_trip - t) - tau
            r = driver(sent)
            load[n] = r * left + impedance * (1.0 - r) * pull(sent) + (1.0 + r) * far(sent)
        if mode != 0 and mode * load[n] <= dynamic:
            mode = 0
        if mode == 0 and abs(load[n]) > static:
            mode = 1 if load[n] > 0.0 else -1
        rate[n] = (load[n] - mode * dynamic) / impedance if mode else 0.0
    return load, rate
