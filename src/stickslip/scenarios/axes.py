"""Read the axis of a map from the text that a user typed, such as "friction.alpha=0.01..10:200:log"."""

from __future__ import annotations

import re

from stickslip.contact.regime_map import Axis
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.scenarios.values import read_typed, show

_AXIS = re.compile(r"(?P<name>[^=]+)=(?P<low>.+?)\.\.(?P<high>[^:]+)(?::(?P<points>\d{1,6}))?(?P<log>:log)?")


def read_axis(problem: Problem, text: str, where: str) -> Axis:
    """Read an axis of the form NAME=LOW..HIGH[:POINTS][:log], with numbers in SI or with a unit.

    The axis has 40 points if no number is given. Raises InputError with a message that begins with `where`.
    """
    parts = _AXIS.fullmatch(text)
    if parts is None:
        raise InputError(f'{where} must be NAME=LOW..HIGH[:POINTS][:log], as "friction.alpha=0.01..10:50:log", got {show(text)}')
    try:
        found = problem.parameters[parts["name"].strip()]
        ends = [read_typed(parts[end], found.declared, where, found.name) for end in ("low", "high")]
        return Axis(found.name, ends[0], ends[1], int(parts["points"] or 40), bool(parts["log"]))
    except InputError as error:
        message = str(error)
        raise InputError(message if message.startswith(where) else f"{where}: {message}") from None
