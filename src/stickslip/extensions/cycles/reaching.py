"""The end of the range of a branch: which values cycles are followed to, and the cycle at the last one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from stickslip.extensions.cycles.asked import CYCLE_KINDS
from stickslip.extensions.cycles.find_cycle import check_can_be_followed
from stickslip.extensions.cycles.found import kind_of
from stickslip.extensions.cycles.lag import is_wound
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.path import NoCycleError, Path, PlaceOnBranch
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import ParameterPath, find_parameter

STRAIGHT = 0.8
"""A step is too long if the branch turns by more than this cosine (1)."""


def range_of(cycle: LimitCycle, along: str, to: float | str | WithUnit) -> tuple[ParameterPath, float, float]:
    """Return a parameter of the problem of a cycle, its value (SI) there, and the value to go to.

    Raises InputError if it is none on which a cycle depends, or if cycles are not found of the problem at the end.
    """
    parameter = find_parameter(cycle.scenario, along, "follow")
    if not isinstance(parameter.declared, Quantity) or parameter.name.startswith(("initial.", "run.")):
        raise InputError(f"follow: {parameter.name} is no number on which a cycle depends: give one of the body, law or loading")
    begin = float(cycle.scenario.problem.parameters[parameter.name].value)
    end = float(parameter.declared.check("follow", "to", to))
    if end == begin:
        raise InputError(f"follow: to: {parameter.name} is {brief(begin, parameter.unit)} already: give another value")
    for value, where in ((begin, "begins"), (end, "ends")):
        if not np.isfinite(value):
            raise InputError(f"follow: no branch {where} at {parameter.name} = {brief(value, parameter.unit)}: give a finite one")
    try:
        at_end = cycle.scenario.problem.parameters[parameter.name].put(end)
    except InputError as error:
        raise InputError(f"follow: to: {error}") from None
    check_can_be_followed(at_end, "follow: to")
    if is_wound(at_end) != is_wound(cycle.scenario.problem):
        why = "without an integral gain the lag of an axis is no number of its cycles"
        raise InputError(f"follow: {why}: begin and end with {parameter.name} above 0, however little")
    return parameter, begin, end


def first_place(cycle: LimitCycle, parameter: ParameterPath, ends: Sequence[float]) -> tuple[Path, PlaceOnBranch]:
    """Return the path of a cycle along a range, and its place there, with the way that leads to the end. Raises NoCycleError."""
    orbit, length = cycle.orbit, ends[1] - ends[0]
    path: Path = CYCLE_KINDS[cycle.problem.body.structure].path(orbit, cycle.scenario, parameter, abs(length))
    start = path.at_value(ends[0], orbit.place, orbit.period)
    return path, start if start.way[-1] * length >= 0.0 else replace(start, way=-start.way)


def past_end(value: float, ends: Sequence[float]) -> float | None:
    """Return the end of a range that a value (SI) lies beyond; None if it lies inside."""
    inside = min(max(value, min(ends)), max(ends))
    return None if inside == value else inside


def at_end_of_range(path: Path, now: PlaceOnBranch, step: float, ends: Sequence[float]) -> PlaceOnBranch | None:
    """Return the cycle at the end of the range if a step leads beyond it, where a problem may refuse its values; None: no cycle."""
    length = step * now.way[-1] * path.range
    end = past_end(now.value + length, ends)
    if end is None or end == now.value:
        return None
    share = (end - now.value) / length
    guess = now.orbit.place + share * step * now.way[:-1] * path.scales[:-1]
    try:
        last = path.at_value(end, guess, now.orbit.period, now.way)
    except NoCycleError:
        return None
    return last if kind_of(last.orbit) == kind_of(now.orbit) and last.way @ now.way >= STRAIGHT else None


def between(path: Path, now: PlaceOnBranch, new: PlaceOnBranch, ends: Sequence[float]) -> PlaceOnBranch | None:
    """Return the cycle at the end of the range that a step has passed; None if none is found."""
    value = min(max(new.value, min(ends)), max(ends))
    share = (value - now.value) / (new.value - now.value)
    guess = now.orbit.place + share * (new.orbit.place - now.orbit.place)
    try:
        return path.at_value(value, guess, now.orbit.period, now.way)
    except NoCycleError:
        return None
