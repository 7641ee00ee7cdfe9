"""Uniqueness where friction differs with the direction of slip: what holds forwards and what holds backwards, as one answer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, get_args

from stickslip.contact.folds import Verdict
from stickslip.contact.regime import Regime
from stickslip.problem import Problem, normal_name


def of_both_ways(problem: Problem, ahead: Any, behind: Any) -> Any:
    """Return the `Uniqueness` for forward slip with that for backward slip beside it.

    Regime and critical value are those of the direction with the less certain regime, forwards if they are alike.
    """
    said = problem.friction.said_of_uniqueness
    if ahead.resistance is None:  # a mass makes the slip rate unique, whatever the law
        return replace(ahead, summary=ahead.summary + said, problem=problem)
    order = get_args(Regime).index
    way, worse = ("backward", behind) if order(behind.regime) > order(ahead.regime) else ("forward", ahead)
    name = worse.critical_parameter
    return replace(
        ahead,
        regime=worse.regime,
        certificate=max(ahead.certificate, behind.certificate, key=get_args(Verdict).index),
        summary=f"Forward slip: {ahead.summary} Backward slip: {behind.summary}{said}",
        critical_parameter=name if name in (None, normal_name(problem)) else f"{way}.{name}",
        critical_value=worse.critical_value,
        critical_unit=worse.critical_unit,
        critical_stress_between=worse.critical_stress_between,
        problem=problem,
    )
