"""Plan a step of slip: how far it may go before the branch of the contact equation ends, and how to approach folds."""

from __future__ import annotations

import math
from typing import NamedTuple

from stickslip.engine.contact.contact_equation import TIE, branch_exit
from stickslip.engine.folds.fold import SHORTEST_FOLD, ends_at_fold, load_outruns_fold, reach_end, starts_at_fold
from stickslip.engine.state.layout import EnginePart, NearFold, Task
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import call_part


class StepPlan(NamedTuple):
    """Say how far a step of slip may go."""

    target: float  # slip up to this xi
    ends_branch: bool  # True if the branch ends there
    is_over: bool  # True if no step follows: the branch has ended, a side piece is the piece of load now, or a part is missing


@kernel
def plan_step(run: Run, xi_to: float) -> StepPlan:
    """Plan a step of slip up to the place xi_to, or up to the end of the branch; at the start of a branch, depart from its fold."""
    if run.counts.is_algebraic == 0 or (run.counts.at_fold != NearFold.NONE and run.counts.folds_move == 0):
        return StepPlan(xi_to, False, False)
    plan = plan_to_end_of_branch(run, xi_to)
    if plan.is_over or not starts_at_fold(run):
        return plan
    if run.folds == 0:
        return ask_for_folds(run)
    if run.counts.folds_move == 0 or load_outruns_fold(run):
        call_part(run.folds, run, Task.DEPART_FROM_FOLD, plan.target - run.state.xi)
    else:
        run.counts.stalled += 1  # Slip would end where it starts, again and again.
    return StepPlan(plan.target, plan.ends_branch, True)


@kernel
def plan_to_end_of_branch(run: Run, xi_to: float) -> StepPlan:
    """Find where an algebraic contact leaves its branch, and prepare the way to a smooth fold."""
    moves = run.counts.folds_move == 1
    if math.isnan(run.state.exit) and not moves:
        run.state.exit = branch_exit(run)
    way = run.state.exit - run.state.xi
    if not run.state.exit < xi_to:
        return StepPlan(xi_to, False, False)
    if way <= 0.0:
        reach_end(run)
        return StepPlan(xi_to, False, True)
    if not moves and run.state.bend == 0.0 and way > SHORTEST_FOLD and ends_at_fold(run, way):
        return lead_to_fold(run, way)
    return StepPlan(run.state.exit, True, False)


@kernel
def ask_for_folds(run: Run) -> StepPlan:
    """Ask for the part of the engine that leads slip to folds and away from them; until it is there, no step follows."""
    run.missing = EnginePart.FOLDS
    return StepPlan(run.state.xi, False, True)


@kernel
def lead_to_fold(run: Run, way: float) -> StepPlan:
    """Put a side piece that ends at the fold `way` (in xi) ahead in place of the piece of load, or plan a step towards it."""
    if run.folds == 0:
        return ask_for_folds(run)
    first = call_part(run.folds, run, Task.APPROACH_FOLD, way)
    return StepPlan(run.state.xi + first, False, first == 0.0)


@kernel
def plan_to_moving_fold(run: Run, unit: float, plan: StepPlan) -> StepPlan:
    """Find where the series runs into a fold that moves with slip; return the plan as it was if that is not before its target."""
    way = call_part(run.moving_folds, run, Task.LOOK_FOR_FOLD, unit)
    if not way < plan.target - run.state.xi:
        return plan
    if way <= TIE:
        run.state.rate_now = run.counts.mode * run.state.fold_rate
        reach_end(run)
        return StepPlan(plan.target, False, True)
    if run.state.bend == 0.0 and way > SHORTEST_FOLD:
        return lead_to_fold(run, way)
    return StepPlan(run.state.xi + way, False, False)
