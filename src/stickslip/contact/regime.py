"""Regime of a contact: whether its load fixes its slip rate, without the jumps of the rule, which `uniqueness` finds.

Source: Campillo et al. 1996, section 3, the terms regular and irregular.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Literal, get_args

import numpy as np

from stickslip.contact.branches import branches_of, resistance
from stickslip.contact.folds import Certificate, certificate
from stickslip.foundation.show import brief
from stickslip.problem import PERFECT_DELAY, Branch, Problem, Resistance

Regime = Literal["regular", "irregular", "continuum"]
"""Possible values of `Uniqueness.regime`, from one solution to many."""


def regime_of(problem: Problem) -> Regime:
    """Return the `regime` of `uniqueness_of` without the jumps and loop of the rule: a sweep asks for it in each of its runs."""
    if problem.body.has_inertia or problem.friction.states:
        return "regular"
    found = [regime_at(resistance(problem.facing(way), None)) for way in ((1, -1) if problem.friction.backward_from else (1,))]
    return max(found, key=get_args(Regime).index)


def regime_at(g: Resistance) -> Regime:
    """Return the regime of a contact without mass at one slip of its law, proven where the law has formulas."""
    return named_regime(g, window_of(branches_of(g, proof_of(g))))


@lru_cache(maxsize=16)
def regime_when_pressed(problem: Problem) -> Regime:
    """Return the regime of a contact without mass, at the first slip of its law, under the largest normal load that it ever bears.

    A contact that is regular then is regular under every smaller normal load, because Z + S dmu/dv grows as S falls.
    """
    most = None if problem.normal_load is None else problem.normal_load.highest
    return regime_at(resistance(problem, normal=most))


def folds_not_followed(problem: Problem) -> str:
    """Return why a problem whose folds move with its normal load cannot be run under its selection rule; empty if it can."""
    law, history = problem.friction, problem.normal_load
    if history is None or history.is_stepped or problem.rule == PERFECT_DELAY:
        return ""
    if problem.body.has_inertia or law.states or not law.depends_on_rate or regime_when_pressed(problem) == "regular":
        return ""
    most = brief(history.highest, problem.load_unit)
    return (
        f"selection {problem.rule!a}: under {most} several slip rates solve the contact equation, and the folds between them move "
        f"with the normal load: only {PERFECT_DELAY} is followed there; where the normal load changes by steps alone every rule is"
    )


def named_regime(g: Resistance, window: tuple[float, float] | None) -> Regime:
    """Return the regime of a contact without mass; `window` is that of `window_of`."""
    return "continuum" if g.plateaus else "irregular" if window else "regular"


def proof_of(g: Resistance) -> Certificate:
    """Return what is proven of the folds of a contact; under friction that does not depend on the slip rate there are none."""
    return certificate(g) if g.law.depends_on_rate else Certificate("proven")


def window_of(stable: tuple[Branch, ...]) -> tuple[float, float] | None:
    """Return the range of loads with several solutions, as excess (Pa), from the lowest fold to the highest.

    The end of stick (excess 0) counts as a fold. The result is None if there is one solution at every load, and has no width if
    only a plateau has several.
    """
    lower = [b.excess_from for b in stable if b.rate_from > 0.0 or b.excess_from < 0.0]
    upper = [b.excess_to for b in stable if b.rate_to < np.inf]
    if stable[0].rate_from > 0.0 or stable[0].excess_from < 0.0:
        upper.append(0.0)
    return (min(lower), max(upper)) if lower else None
