"""A rigid block on shaken ground, by hand."""

from __future__ import annotations

import numpy as np

from stickslip.problem.loading import PiecewiseLinear


def by_hand(
    history: PiecewiseLinear,
    pull: float,
    end: float,
    *,
    one_way: bool,
    mass: float,
    limits: tuple[float, float],
) -> float:
    """Return the slip (m) of a rigid block by the cubics between the points of the record, and the events on them.

    `limits` are the strength at rest and the friction of sliding (N).
    """
    strength, sliding = limits
    times, values = [*history.times, end], [*history.values, history.values[-1]]
    v = u = 0.0
    for begin, until, first, last in zip(times, times[1:], values, values[1:], strict=False):
        slope = (last - first) / (until - begin)
        now, left = 0.0, until - begin
        while now < left:
            load = pull - mass * (first + slope * now)
            if v == 0.0:
                way = 1 if load > strength else -1 if load < -strength and not one_way else 0
                if way == 0:  # when a straight load reaches one of its limits
                    ends = (strength,) if one_way else (strength, -strength)
                    reached = [(pull - limit) / mass / slope - first / slope for limit in ends] if slope else []
                    later = [t for t in reached if t > now + 1e-15]
                    now = min([*later, left])
                    if now == left:
                        break
                    load = pull - mass * (first + slope * now)
                    way = 1 if load > 0.0 else -1
            else:
                way = 1 if v > 0.0 else -1
            a = (load - way * sliding) / mass
            roots = np.roots([-0.5 * slope, a, v]) if slope else np.array([-v / a])
            real = [t.real for t in roots if abs(t.imag) < 1e-12 and 1e-13 < t.real < left - now]
            lasting = min([*real, left - now])
            u += lasting * (v + lasting * (0.5 * a - slope * lasting / 6.0))
            v = 0.0 if real else v + lasting * (a - 0.5 * slope * lasting)
            now += lasting
    assert v == 0.0
    return u
