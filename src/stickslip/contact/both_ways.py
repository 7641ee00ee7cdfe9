"""Uniqueness where friction differs with the direction of slip: what holds forwards and what holds backwards, as one answer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, get_args

from stickslip.contact.regime import Regime
from stickslip.problem import Problem, normal_name


def of_both_ways(problem: Problem, ahead: Any, behind: Any) -> Any:
    """Return the `Uniqueness` for forward slip with that for backward slip beside it, and the less certain of both regimes."""
    said = problem.friction.said_of_uniqueness
    if ahead.resistance is None:  # a mass makes the slip rate unique, whatever the law
        return replace(ahead, summary=ahead.summary + said, problem=problem)
    name = ahead.critical_parameter
    return replace(
        ahead,
        regime=max(ahead.regime, behind.regime, key=get_args(Regime).index),
        summary=f"Forward slip: {ahead.summary} Backward slip: {behind.summary}{said}",
        critical_parameter=name if name in (None, normal_name(problem)) else f"forward.{name}",
        problem=problem,
    )
