"""ResidualLook at what the runs of a model leave of a record."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.fit.free import DELAY, DRIFT, SERVO, TREND
from stickslip.extensions.inference.fit.memory import ResidualBlock
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.what_is_left import ResidualLook, Residuals, near_changes, what_is_left
from stickslip.extensions.inference.record.record import SHEAR
from stickslip.foundation.arrays import Floats


def looks_of(model: Model, searched: Floats, name: str, slopes: Floats | None = None) -> list[ResidualLook]:
    """Return what is left of a quantity at searched numbers looks like; an empty list for noise, and if a run fails.

    `slopes` are the derivatives of the residuals of this quantity: beside a look the free numbers may still move.
    """
    with np.errstate(all="ignore"):
        found = residuals_of(model, searched, name, slopes)
        try:
            return [] if found is None else what_is_left(found)
        except np.linalg.LinAlgError:  # residuals so odd that no regression says anything
            return []


def residuals_of(model: Model, searched: Floats, name: str, slopes: Floats | None = None) -> Residuals | None:
    """Return data minus run of a quantity in all parts (SI), with what they may follow; None if a run fails."""
    quiet = model.with_(ran=_nothing, tried=_nothing, smooth=0.0)
    columns, blocks, count = list[tuple[Floats, ...]](), list[ResidualBlock](), 0
    marks, changes = list[tuple[NDArray[np.bool_], ...]](), 0
    for i, part in enumerate(model.parts):
        if name not in part.observed:
            continue
        run = quiet.solve(searched, i)
        if run is None:
            return None
        clock, data = part.record.clock[:: model.every], quiet.data(i, name)[:: model.every]
        curve = quiet.curves(run, searched, i, model.every)[name]
        times = part.changes(model.problem)
        times = times[times > 0.0]
        changes += len(times)
        time = np.clip(clock, 0.0, run.history.span[1])
        slope = np.nan_to_num(np.gradient(curve, clock), posinf=0.0, neginf=0.0)
        known = np.isfinite(data) & np.isfinite(curve)
        weight = quiet.weights(i)
        slip = run.slip(time) - run.problem.initial_slip
        columns.append(tuple(one[known] for one in ((data - curve) * weight, slip, slope * weight)))
        marks.append(tuple(one[known] for one in near_changes(clock, times)))
        blocks.append(ResidualBlock(slice(count, count + int(known.sum())), clock[known]))
        count += int(known.sum())
    values, slip, change = (np.concatenate(one) for one in zip(*columns, strict=True))
    near, after = (np.concatenate(one) for one in zip(*marks, strict=True))
    by = np.zeros((count, 0)) if slopes is None else slopes
    return Residuals(values, blocks, slip, change, near, after, changes, by)


def _nothing(*_: object) -> None:
    """Take no notice."""


CURES = {
    "drift with slip": TREND,
    "drift with time": DRIFT,
    "drift": f"{TREND} or {DRIFT}",
    "lag": f"{SERVO} or {DELAY}",
}
"""What can be free against a look."""


def cure_of(look: ResidualLook, name: str, free: set[str]) -> str:
    """Return what to do about a look of a quantity, as text; empty if there is nothing simple."""
    cures = {
        "steps": "sample faster, or leave the samples beside the steps out",
        "transients": "law, machine or loading do not follow there",
        "oscillation": "the machine, or its normal load, swings: normal='record' takes a measured one",
        "offset": "free a level, as friction.reference",
    }
    if look.kind in cures:
        return cures[look.kind]
    named = CURES[look.kind]
    usable = (name in SHEAR or look.kind == "lag") and not set(named.split(" or ")) & free
    return f"free {named}" if usable else "another law may follow"
