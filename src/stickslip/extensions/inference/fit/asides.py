"""Numbers of a record's loading that nobody asks for and that are not known exactly: when steps and jumps come, and their servo."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from stickslip.extensions.inference.fit.free import SERVO, Free, Prior
from stickslip.extensions.inference.fit.part import Part, approached
from stickslip.extensions.inference.record.corners import EVENLY, corners_of, jumps_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.problem import PiecewiseLinear, Steps

STEP, JUMP, RAMP = "record.step_", "record.jump_", "record.ramp"
"""Names: by how much a step of the drive, or a jump of the normal load, comes later than it seems, and how long jumps take (s)."""
FARTHEST_TIME = 3.0
"""A time may lie this many standard deviations from where it seems to be."""
NARROWEST = 1e-3
"""A jump of the normal load takes at least this share of the time between its samples."""


def with_asides(part: Part, number: int) -> Part:
    """Return a part of a record, given its number, with what is not known of its loading."""
    corners = None if part.loading is None else corners_of(part.record, part.loading)
    jumps = () if part.pressing is None else jumps_of(part.pressing, part.record.clock)
    part = replace(part, loading=part.loading if corners is None else corners.rate, corners=corners, jumps=jumps)
    return replace(part, asides=(*_of_drive(part, number), *_of_pressing(part, number)))


def rounded(part: Part) -> Iterable[str]:
    """Yield a sentence on the servo that a load point shows."""
    if part.corners is not None and part.corners.seen:
        servo, spread = brief(part.corners.servo, "s", 3), brief(part.corners.spread, "s", 2)
        yield (
            f"the load point shows a servo: after each of {len(part.corners.unsure)} steps its rate approaches the new one as "
            f"exp(-t/servo), with a servo of {servo} ± {spread}"
        )


def _of_drive(part: Part, number: int) -> Iterable[Free]:
    if part.corners is None:
        return
    corners, time = part.corners, Quantity("s", "time of a servo")
    prior = Prior("normal", corners.servo, corners.spread)
    yield Free(
        SERVO, time, corners.servo, 0.0, corners.servo + 10.0 * corners.spread, False, prior, number, corners.spread, aside=True
    )
    for k, unsure in enumerate(corners.unsure):
        if unsure > 0.0:
            yield _later(f"{STEP}{k + 1}", unsure, FARTHEST_TIME * unsure, number)


def _of_pressing(part: Part, number: int) -> Iterable[Free]:
    if part.pressing is None or not part.jumps:
        return
    lasts = np.diff(part.pressing.times)[list(part.jumps)].tolist()
    for k, wide in zip(part.jumps, lasts, strict=True):
        yield _later(f"{JUMP}{k}", EVENLY * wide, 0.5 * wide, number)
    wide = float(np.median(lasts))
    prior = Prior("normal", 0.0, 0.5 * wide)
    yield Free(RAMP, Quantity("s", "time that jumps take"), 0.1 * wide, 0.0, wide, False, prior, number, 0.5 * wide, aside=True)


def _later(name: str, unsure: float, most: float, number: int) -> Free:
    return Free(
        name,
        Quantity("s", "time by which it comes later"),
        0.0,
        -most,
        most,
        False,
        Prior("normal", 0.0, unsure),
        number,
        unsure,
        aside=True,
    )


def moved(part: Part, own: Mapping[str, float], *, asked: bool = False) -> Part:
    """Return a part with the steps and jumps of its loading at given times, by name; those that are not given stay.

    A servo leaves the lines through the load point where they are, unless it was `asked` for beside a load point that is too sharp
    for it: the machine was told that motion, and comes later.
    """
    values = {one.name: one.start for one in part.asides} | dict(own)
    loading, pressing, servo = part.loading, part.pressing, values.get(SERVO, 0.0)
    if part.corners is not None and isinstance(loading, Steps):
        late = [values.get(f"{STEP}{k + 1}", 0.0) for k in range(len(loading.times) - 1)]
        early = 0.0 if asked and not part.corners.keeps else servo
        loading = _with_times(loading, np.array(loading.times[1:]) + late - early)
    if servo > 0.0 and loading is not None:
        loading = approached(loading, servo)
    if part.jumps and pressing is not None:
        pressing = _jumping(part, pressing, values)
    return part if loading is part.loading and pressing is part.pressing else replace(part, loading=loading, pressing=pressing)


def _with_times(loading: Steps, times: Floats) -> Steps:
    """Return steps that come at other times, each a little later than the one before."""
    least = 1e-9 * max(loading.times[-1], 1e-300)
    ascending = [0.0]
    for time in times.tolist():
        ascending.append(max(time, ascending[-1] + least))
    return Steps(ascending, loading.values)


def _jumping(part: Part, pressing: PiecewiseLinear, values: Mapping[str, float]) -> PiecewiseLinear:
    """Return a normal load whose jumps come at their own times between two samples, and take no longer than given."""
    times, heights = [], []
    knots = list(zip(pressing.times, pressing.values, strict=True))
    for k, ((begin, first), (end, last)) in enumerate(pairwise(knots)):
        times.append(begin)
        heights.append(first)
        if k in part.jumps:
            half = 0.5 * max(min(values.get(RAMP, 0.0), end - begin), 2.0 * NARROWEST * (end - begin))
            middle = 0.5 * (begin + end) + values.get(f"{JUMP}{k}", 0.0)
            middle = min(max(middle, begin + 2.0 * NARROWEST * (end - begin)), end - 2.0 * NARROWEST * (end - begin))
            inner = max(middle - half, begin + NARROWEST * (end - begin)), min(middle + half, end - NARROWEST * (end - begin))
            times += inner
            heights += [first, last]
    return PiecewiseLinear([*times, pressing.times[-1]], [*heights, pressing.values[-1]])


def with_servo(free: Iterable[Free], parts: Iterable[Part]) -> tuple[Free, ...]:
    """Return free numbers, a free time of the servo beginning with what the load point shows, which is known before."""
    corners = next((part.corners for part in parts if part.corners is not None and part.corners.keeps), None)
    found = []
    for one in free:
        if one.name == SERVO and corners is not None and one.part is None and not math.isnan(corners.servo):
            known = Prior("normal", corners.servo, corners.spread) if one.prior is None and not one.bounded else one.prior
            one = replace(one, start=max(corners.servo, one.low), prior=known, scale=corners.spread, log=False)
        found.append(one)
    return tuple(found)
