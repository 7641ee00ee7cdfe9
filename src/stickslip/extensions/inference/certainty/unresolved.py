"""Steps of the drive and jumps of the normal load that happen between two samples, in words."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from stickslip.extensions.inference.fit.asides import JUMP
from stickslip.extensions.inference.fit.free import SERVO
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.part import Part
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief

WITHIN = 1.5
"""A step happens between two samples if its servo takes less than this many times the time between them."""
LIKELY = 0.5
"""A load point that shows no servo, or a short one, may have one of this share of the time between two samples."""
SHOWN = 1.0
"""How a step turns matters if a sharp turn, or a wider one, changes a sample by more than this many standard deviations."""


def unresolved(model: Model, searched: Floats) -> list[str]:
    """Return a sentence on the steps, and one on the jumps, of each part whose shape between two samples matters."""
    if model.of_means:
        return []
    said = [text for i, part in enumerate(model.parts) for text in (*_steps(model, searched, i), *_jumps(model, i, part))]
    return list(dict.fromkeys(said))


def _steps(model: Model, searched: Floats, i: int) -> Iterator[str]:
    part = model.parts[i]
    if part.corners is None:
        return
    own = {one.name: value for one, value in zip(model.free, model.values(searched), strict=True) if one.part in (None, i)}
    servo, clock = own.get(SERVO, part.corners.servo), part.record.clock
    times = np.array(part.corners.rate.times[1:])
    k = np.clip(np.searchsorted(clock, times), 1, len(clock) - 1)
    spacing = clock[k] - clock[k - 1]
    within = (times < clock[-1]) & (servo < WITHIN * spacing)
    if not within.any():
        return
    apart = float(np.median(spacing[within]))
    wider = min(LIKELY * apart, part.corners.servo + 2.0 * part.corners.spread)
    found, *others = (_with_servo(model, i, one).part_residual(searched, i) for one in (servo, 0.0, max(servo, wider)))
    if max(float(np.max(np.abs(one - found), initial=0.0)) for one in others) > SHOWN:
        count = int(within.sum())
        happen = "1 step of the drive happens" if count == 1 else f"{count} steps of the drive happen"
        yield (
            f"{happen} between two samples, {brief(apart, 's', 3)} apart, and {'is' if count == 1 else 'are'} not resolved: how "
            "the load point turned there is known from the samples beside it alone, and the intervals allow for that"
        )


def _with_servo(model: Model, i: int, servo: float) -> Model:
    """Return the model with a servo of its own in one part, whatever else is said about it."""
    free = tuple(replace(one, low=servo, high=servo) if one.name == SERVO and one.part in (None, i) else one for one in model.free)
    asides = tuple(replace(one, start=servo) if one.name == SERVO else one for one in model.parts[i].asides)
    return model.with_(free=free, parts=(*model.parts[:i], replace(model.parts[i], asides=asides), *model.parts[i + 1 :]))


def _jumps(model: Model, i: int, part: Part) -> Iterator[str]:
    count = sum(one.aside and one.part == i and one.name.startswith(JUMP) for one in model.free)
    if count:
        happen = "1 jump of the normal load happens" if count == 1 else f"{count} jumps of the normal load happen"
        name = part.record.normal_name.replace("_", " ") or "normal load"
        yield (
            f"{happen} between two samples and {'is' if count == 1 else 'are'} not resolved: when the {name} jumped is free "
            "between them, and the intervals allow for that"
        )
