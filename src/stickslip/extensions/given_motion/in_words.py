"""What is said of friction along a given motion, in sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.foundation.show import brief, number

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.along import FrictionAlongMotion


def lines_of(run: FrictionAlongMotion) -> list[str]:
    """Return what is to be said of a run, a sentence each."""
    law, unit, table = run.moved.friction, run.moved.load_unit, run.at(run.times)
    low, high = float(np.nanmin(table.lowest_traction)), float(np.nanmax(table.highest_traction))
    begun = f"{type(law).__name__} along a given motion of {number(run.duration)} s, in {len(run.begun)} intervals"
    found = [begun if run.steps is None else f"{begun} and {len(run.steps.length)} steps"]
    end = brief(float(run.slip(run.duration)), run.units["slip"])
    found.append(f"slip rate {_span(table.slip_rate, run.moved.rate_unit)}, slip at the end {end}")
    found.append(
        f"traction {brief(low, unit)} to {brief(high, unit)}, with an error of at most {float(table.error.max()):.2g} {unit}"
    )
    lasting = np.diff(np.append(run.begun, run.duration))
    rest = float(lasting[run.motion.direction[: len(lasting)] == 0.0].sum())
    if rest and law.sticks:
        found.append(f"at rest for {number(rest, 4)} s, where any traction up to static friction is possible")
    if not run.status.ok:
        found.append(f"{run.status}; it was to end at {number(run.asked_duration)} s")
    return found


def _span(values: Any, unit: str) -> str:
    low, high = float(values.min()), float(values.max())
    return brief(low, unit) if low == high else f"{brief(low, unit)} to {brief(high, unit)}"
