"""Why a run does not change smoothly with its numbers: what passes a sample there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.turns import changes_of, felt
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.problem import LoadingHistory

NEAR_BEND = 3.0
"""A bend belongs to what happens at most this many samples away."""


def rough_words(model: Model, x: Floats, labels: Sequence[str], rows: NDArray[np.bool_]) -> list[str]:
    """Return one sentence for all numbers with which the run does not change smoothly, with its cause; none if there are none.

    `rows` are the residuals that bend.
    """
    if not labels:
        return []
    causes, begin = dict.fromkeys(("a slip event", "a step of the drive", "a jump of the normal load"), 0), 0
    first: float | None = None
    for i, part in enumerate(model.parts):
        run = model.solve(x, i)
        for name, block in model.blocks(i):
            times = block.time[rows[begin + block.rows.start : begin + block.rows.stop]]
            first = float(times[0]) if first is None and len(times) else first
            if run is None or not len(times):
                continue
            step = NEAR_BEND * float(np.median(np.diff(block.time)))
            pull = run.problem.pull_rate
            drive = changes_of(pull, part.duration) if isinstance(pull, LoadingHistory) else np.zeros(0)
            loads = np.setdiff1d(felt(run.problem, part.duration, step / NEAR_BEND), drive)
            jumps = model.jumps(run, i, name).time
            for cause, at in zip(causes, (jumps, drive, loads), strict=True):
                causes[cause] += int((np.abs(times[:, None] - at).min(axis=1) <= step).sum()) if len(at) else 0
        begin += sum(block.rows.stop - block.rows.start for _, block in model.blocks(i))
    cause = max(causes, key=lambda one: causes[one])
    where = f", as where {cause} passes a sample" if causes[cause] else f" near {brief(first, 's', 4)}" if first is not None else ""
    listed = labels[0] if len(labels) == 1 else f"{', '.join(labels[:-1])} and {labels[-1]}"
    several = "their intervals, which are" if len(labels) > 1 else "its interval, which is"
    return [
        f"the run does not change smoothly with {listed}{where}; such samples are left out of {several} rough: a profile tells more"
    ]
