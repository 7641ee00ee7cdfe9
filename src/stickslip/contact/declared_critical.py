"""Compare the critical value that a user's law states with the proven slope of its formula."""

from __future__ import annotations

import math
from typing import Any

from stickslip.foundation.errors import InputError
from stickslip.friction.statements import is_known
from stickslip.problem.problem import Problem

_SLACK = 1e-6
"""Relative difference between the statement and the proof that counts as rounding."""


def check_critical(problem: Problem, impedance: float, between: tuple[float, float] | None) -> None:
    """Raise InputError if `critical_value` of a user's class returns no name and number, or contradicts a proof.

    `between` is the interval (Pa) in which the critical normal stress has been proven to lie, Z / max(-dmu/dv). At that stress the
    present value of the parameter must be the critical one.
    """
    law = problem.friction
    if is_known(law):
        return
    who, given = type(law).__name__, law.critical_value(impedance, problem.normal)
    if given is None:
        return
    name, _ = _read(who, given)
    _check_name(who, name, problem)
    if between is None or law.depends_on_slip:
        return
    present = problem.parameters[name].value
    stated = sorted(_read(who, law.critical_value(impedance, stress))[1] for stress in between)
    low, high = between if name == "normal_stress" else (present, present)
    if not (stated[0] <= high + _SLACK * abs(high) and stated[1] >= low - _SLACK * abs(low)):
        raise InputError(
            f"{who}: critical_value contradicts the proof: friction falls so steeply that the critical normal stress is"
            f" {between[0]:.6g} Pa at {name} = {present:.6g}, where critical_value gives {name} = {stated[0]:.6g}"
        )


def _check_name(who: str, name: str, problem: Problem) -> None:
    try:
        problem.parameters[name]
    except InputError as error:
        raise InputError(f"{who}: critical_value: {error}") from None


def _read(who: str, given: Any) -> tuple[str, float]:
    """Return a critical value as a name and a finite number. Raises InputError for anything else."""
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[0], str):
        try:
            value = float(given[1])
        except (TypeError, ValueError):
            value = math.nan
        if math.isfinite(value):
            return given[0], value
    raise InputError(f"{who}: critical_value must return a name and a number, or None, got {str(given)[:60]}")
