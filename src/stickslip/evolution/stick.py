"""The contact at rest: what a new piece of load finds, how long rest lasts, and how slip comes to rest."""

from __future__ import annotations

from stickslip.evolution import layout as at
from stickslip.evolution.branch import TIE, choose_branch, friction_at, leave_branch, rest_limit, towards
from stickslip.evolution.compiled import ahead, inlined
from stickslip.evolution.polynomial import NONE, evaluate, fill, first_descent, restrict, scale
from stickslip.evolution.record import note_jump, record
from stickslip.evolution.workspace import Run


@inlined
def arrive(run: Run) -> None:
    """A new piece of load begins: does the contact stick or slip under it, which way, on which branch?"""
    load = run.load[0]
    limit = rest_limit(run)
    mode = run.counts[at.MODE]
    if mode != 0 and run.counts[at.FOLDS_MOVE] == 1 and run.counts[at.ARRIVING] == at.NO_CAUSE:
        pass  # the load goes on as it was, and so does the slip rate
    elif mode != 0 and run.counts[at.IS_ALGEBRAIC] == 1:
        seen, branch = towards(run, load, mode), run.counts[at.BRANCH]
        if not run.keep_from[branch] <= seen <= run.keep_to[branch]:
            leave_branch(run, seen)
    elif mode != 0 and run.counts[at.HAS_INERTIA] == 0:
        friction_at(run, run.state[at.LAW_SLIP], 0.0, run.value)
        if towards(run, load, mode) < run.value[0]:
            run.counts[at.MODE] = 0
    if run.counts[at.MODE] == 0 and run.counts[at.EDGE] == 0:
        for direction in (1, -1):
            if towards(run, load, direction) > limit:
                run.counts[at.MODE] = direction
                choose_branch(run, towards(run, load, direction))
    if run.counts[at.MODE] == 0:
        note_jump(run, 0.0, run.counts[at.ARRIVING])
        run.state[at.RATE_NOW] = 0.0


@inlined
def stick(run: Run, xi_to: float) -> None:
    """Stay at rest until the load leaves what friction can hold."""
    width, part = xi_to - run.state[at.XI], run.part
    limit = rest_limit(run)
    load = ahead(run.stored_load, at.TERMS * run.counts[at.LENGTH])
    restrict(run.load, run.state[at.XI], width, load)
    onset, direction = NONE, 0
    for way in (1, -1):
        for k in range(at.TERMS):
            part[k] = -way * load[k]
        part[0] = 0.0 if run.counts[at.EDGE] == way else limit - towards(run, load[0], way)
        first = first_descent(part, run.spare)
        if first < onset:
            onset, direction = first, way
    slips = onset <= 1.0 - TIE
    if slips:
        scale(load, onset)
    fill(ahead(run.stored_rate, at.TERMS * run.counts[at.LENGTH]), 0.0)
    record(run, run.state[at.XI] + onset * width if slips else xi_to)
    run.counts[at.EDGE] = 0
    if slips:
        run.counts[at.MODE], run.counts[at.EDGE] = direction, direction
        choose_branch(run, limit)


@inlined
def come_to_rest(run: Run) -> None:
    """The slip rate has reached zero: rest, or slip the other way where the load is beyond the strength there."""
    before = run.counts[at.MODE]
    run.state[at.RATE_NOW] = 0.0
    run.counts[at.MODE] = 0
    if run.counts[at.HAS_INERTIA] == 0:
        run.counts[at.EDGE] = before if run.par[at.STATIC_EXCESS] == 0.0 else 0
        return
    load = evaluate(run.load, run.state[at.XI])
    limit = rest_limit(run)
    for direction in (1, -1):
        if towards(run, load, direction) > limit:
            run.counts[at.MODE] = direction
