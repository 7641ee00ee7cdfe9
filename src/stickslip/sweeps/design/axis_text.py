"""The axes of a sweep as they are typed on the command line: "thickness=1km..50km:300:log" or "friction.alpha=0.1,0.5,2"."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.scenarios.parameter_paths import ParameterPath, find_parameter
from stickslip.scenarios.scenario import Scenario
from stickslip.sweeps.design.axis import Axis, check_size, read_values

FORM = '"KEY=LOW..HIGH:POINTS", followed by ":log" for equal ratios, or "KEY=VALUE,VALUE,..."'
_RANGE = re.compile(r"(?P<low>.+?)\.\.(?P<high>[^:]+)(?::(?P<points>\d{1,9}))?(?P<log>:log)?")


def typed_axes(scenario: Scenario, texts: Iterable[str], where: str) -> list[Axis]:
    """Return the axes that were typed, each in the FORM. Raises InputError, whose message begins with `where`."""
    return [_typed_axis(scenario, text, where) for text in texts]


def typed_value(parameter: ParameterPath, text: Any) -> Any:
    """Return a number that was typed as text as a number, and words, texts with a unit and anything else as they are."""
    try:
        return float(text) if isinstance(text, str) and parameter.unit else text
    except ValueError:
        return text


def _typed_axis(scenario: Scenario, text: str, where: str) -> Axis:
    name, equals, content = (part.strip() for part in text.partition("="))
    if not equals or not name or not content:
        raise InputError(f"{where} must be {FORM}, got {shown(text)}")
    parameter = find_parameter(scenario, name, where)
    found = _RANGE.fullmatch(content)
    texts = found.group("low", "high") if found else content.split(",")
    values = [typed_value(parameter, one) for one in texts]
    if not found:
        return Axis(parameter, read_values(parameter, values, where))
    axis = Axis.of_range(parameter, values, bool(found["log"]), where)
    return axis if found["points"] is None else _with_points(axis, int(found["points"]), where)


def _with_points(axis: Axis, points: int, where: str) -> Axis:
    """Return an axis with evenly spaced values, both ends included. Raises InputError for fewer than two, or too many."""
    check_size(axis.parameter, points, where)
    if points < 2:
        raise InputError(f"{where}: {axis.parameter.name} needs at least 2 points, got {points}")
    assert axis.ends
    spaced = np.geomspace if axis.log else np.linspace
    return replace(axis, values=np.asarray(spaced(*axis.ends, points)))
