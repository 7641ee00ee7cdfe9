"""The ends of sliders: they follow from the declared range of a quantity, and from its first value in the scenario."""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.foundation.quantities import LARGEST_WHOLE, Quantity
from stickslip.problem import Problem

SLIDER_FACTOR = 30.0
"""A logarithmic slider reaches from the value over this factor to the value times it."""
SLIDER_REACH = 3.0
"""A linear slider that begins at 0 reaches to this many times the value."""
SPECIAL_WIDE = {"loading.pull_rate": 1000.0, "run.duration": 10.0}
"""Other factors of logarithmic sliders."""
LARGE_COEFFICIENT = 0.2
"""Pure numbers from here on are friction coefficients, whose sliders reach to `COEFFICIENTS` at least; others are small shares."""
INVERSE_RATES = ("s/m", "m^-1 s")
"""Units of numbers that may be 0, but whose size is to be seen on a logarithmic slider."""
NEARLY = 1e-3
"""A slider of a pure number that must be greater than 0 begins at this share of its end."""
COUNTS = {"contact.nodes": (8.0, 1024.0), "contact.frames": (1.0, 400.0), "contact.courant": (0.05, 0.79)}
"""Ends of the sliders of numbers of a grid."""
COEFFICIENTS = 1.5
"""Smallest end of the slider of a friction coefficient."""


class SliderRange(NamedTuple):
    """The ends of a slider (SI), and whether it is logarithmic."""

    low: float
    high: float
    log: bool = False

    def holding(self, value: float | None) -> SliderRange:
        """Return the range with ends of two digits, widened to hold a value."""
        low, high = (float(f"{end:.2g}") for end in (self.low, self.high))
        if value is not None and math.isfinite(value) and (value > 0.0 or not self.log):
            low = low if value > low or math.isclose(value, low) else value
            high = high if value < high or math.isclose(value, high) else value
        return SliderRange(low, high, self.log)


def range_of(path: str, declared: Quantity, anchor: float | None, problem: Problem) -> SliderRange | None:
    """Return the range of a slider for the number at a path such as "body.density", or None if a slider makes no sense.

    It follows from `anchor`, the first value (SI) in the scenario, and not from the slider.
    """
    if path in ("run.rtol", "run.creep_rtol", "run.shortest_event", "body.p_wave_speed") or anchor is None:
        return None
    if declared.whole:
        return SliderRange(1.0, float(LARGEST_WHOLE))
    if path in COUNTS:
        return SliderRange(*COUNTS[path])
    if path.endswith(("y[0]", "y[1]")):
        return SliderRange(-2.0 * abs(anchor), 2.0 * abs(anchor))
    special = _special(path.rpartition("].")[2], anchor, problem)  # of a patch: as that of all nodes
    if special is not None:
        return special
    if not math.isfinite(anchor):
        return None
    if declared.unit == "1":
        high = max(COEFFICIENTS, 1.5 * anchor) if anchor >= LARGE_COEFFICIENT else SLIDER_REACH * anchor or LARGE_COEFFICIENT
        return SliderRange(0.0 if declared.above is None else NEARLY * high, high)
    if anchor > 0.0 and (declared.at_least != 0.0 or declared.unit in INVERSE_RATES or path == "body.stiffness"):
        factor = SPECIAL_WIDE.get(path, SLIDER_FACTOR)
        return SliderRange(anchor / factor, anchor * factor, log=True)
    if anchor == 0.0:
        return None
    return SliderRange(min(0.0, SLIDER_REACH * anchor), max(0.0, SLIDER_REACH * anchor))


def _special(path: str, anchor: float, problem: Problem) -> SliderRange | None:
    """Return the range of a number that may be zero or infinite, and whose size follows from others of the problem."""
    body = problem.body
    size = problem.strength or 0.8 * problem.normal
    if path == "initial.load":
        return SliderRange(min(0.0, 1.5 * anchor), max(1.3 * size, 1.2 * anchor))
    if path == "initial.excess":
        reach = 5.0 * abs(anchor) or 0.2 * size
        return SliderRange(-reach, reach)
    if path == "initial.slip":
        reach = max(2.0 * abs(anchor), slip_scale(problem))
        return SliderRange(-reach if anchor < 0.0 else 0.0, reach)
    if path == "body.driver_impedance":
        return SliderRange(0.0, max(5.0 * body.impedance, 1.5 * anchor if math.isfinite(anchor) else 0.0))
    if path == "body.contact_mass":
        return SliderRange(0.0, max(0.1 * body.impedance * body.round_trip_time, SLIDER_REACH * anchor))
    if path == "body.driver_inertia":
        return SliderRange(0.0, max(body.impedance * body.round_trip_time, SLIDER_REACH * anchor if math.isfinite(anchor) else 0.0))
    if path == "body.driver_integral_gain":
        return SliderRange(0.0, max(body.stiffness, SLIDER_REACH * anchor))
    if path in ("body.damping", "body.driver_damping", "body.contact_damping"):
        return SliderRange(0.0, max(2.0 * body.impedance, SLIDER_REACH * anchor))
    if path == "body.backlash" and body.stiffness > 0.0:
        return SliderRange(0.0, max(2.0 * size / body.stiffness, SLIDER_REACH * anchor))
    if path == "loading.pull_rate" and anchor <= 0.0:
        return (
            SliderRange(SLIDER_REACH * anchor, -SLIDER_REACH * anchor)
            if anchor < 0.0
            else SliderRange(0.0, 1e-3 * problem.normal / body.impedance)
        )
    return None


def slip_scale(problem: Problem) -> float:
    """Return a slip scale (m) of friction: the longest length among the numbers of the law, or 1 m if there is none."""
    lengths = [one.value for one in problem.parameters.values() if one.name.startswith("friction.") and one.unit == "m"]
    numbers = [one.value for one in problem.parameters.values() if one.unit in ("1/m", "m^-1") and one.value]
    return max([*lengths, *(2.0 * math.pi / abs(number) for number in numbers)], default=1.0) or 1.0
