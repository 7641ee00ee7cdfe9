"""Slip, slip rate, traction and load of a run against time."""

from __future__ import annotations

from stickslip.explorer.model.answer import Motion
from stickslip.solution.solution import Solution

POINTS = 400
"""Number of evenly spaced times; the breaks of a run, and times between them, are added, so that there are some thousands."""


def motion(solution: Solution, name: str = "") -> Motion:
    """Return the motion of one body; `name` is what the legend calls it, by default "slab" or "block"."""
    has_waves = solution.problem.body.has_waves
    time, (slip, rate, traction, load) = solution.curves_together(("slip", "slip_rate", "traction", "load"), points=POINTS)
    return Motion(
        body="slab" if has_waves else "block",
        name=name or ("slab" if has_waves else "block"),
        time=time,
        slip=slip,
        slip_rate=rate,
        traction=traction,
        load=load,
        load_unit="Pa" if has_waves else "N",
        normal_load=solution.problem.normal,
    )
