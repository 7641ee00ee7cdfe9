"""A normal load that varies in time: it begins with that of the body, stays above 0, and may be given as the weight on a bit."""

from __future__ import annotations

from typing import NoReturn

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantities_of
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.loading import VARYING, LoadingHistory

SAME_NORMAL_LOAD = 1e-12
"""Relative difference (1) between two normal loads that is rounding by computers."""
BY_PEOPLE = 1e-5
"""Relative difference (1) that is rounding by people, to six digits: the history is then taken to begin with the body's own."""


def begun_with_body(history: LoadingHistory, body: BodyOnCharacteristics) -> LoadingHistory:
    """Return a history of the normal load in the unit of the body's loads, which begins with that of the body.

    Where the normal load is in proportion to the weight on a bit, a history in the unit of that is taken for the weight. Raises
    InputError if it begins with another value than the body has.
    """
    given, unit, weight = body.normal_load, body.load_unit, _unit_of_weight(body)
    if weight and history.unit == weight:
        given, unit = getattr(body, body.normal_field), weight
    elif history.unit not in (VARYING, unit):
        return history  # its unit is refused with those of all other fields
    apart = abs(history.first - given)
    if not apart <= BY_PEOPLE * given:
        _refuse(history, body, given, unit)
    is_same = unit == body.load_unit and apart <= SAME_NORMAL_LOAD * given
    return history if is_same else history.scaled(body.normal_load / history.first)


def _unit_of_weight(body: BodyOnCharacteristics) -> str:
    """Return the unit of the field to which the normal load is in proportion, if loads have another one, else ""."""
    unit = quantities_of(type(body))[body.normal_field].unit
    return "" if unit == body.load_unit else unit


def _refuse(history: LoadingHistory, body: BodyOnCharacteristics, given: float, unit: str) -> NoReturn:
    own, hint, weight = body.normal_field, "make them equal", _unit_of_weight(body)
    if weight and unit != weight:
        own, hint = f"normal load by its {own}", f"{hint}, or give the {own.replace('_', ' ')} in {weight}, with its unit"
    first = f"normal_load begins with {history.first:.12g} {unit}"
    raise InputError(f"Problem: {first}, but the body's {own} is {given:.12g} {unit}: {hint}")


def check_normal_load(history: LoadingHistory, body: BodyOnCharacteristics) -> None:
    """Raise InputError if a history of the normal load opens the contact, or cannot be followed."""
    if not history.lowest > 0.0:
        may = f"must stay above 0 {body.load_unit}, but may fall to {history.lowest:g}"
        raise InputError(f"Problem: normal_load {may}: the contact would open")
    if history.tone.amplitude != 0.0 and history.parts[2].any():
        raise InputError("Problem: normal_load: a sinusoid beside slopes is not followed: its straight parts must be constant")
