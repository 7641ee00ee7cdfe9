"""Keep a step of slip: unload the spring, append the step to the history, and move the state to its end."""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import friction_at
from stickslip.engine.contact.pieces import record
from stickslip.engine.contact.winding import unwind
from stickslip.engine.contact_step.step_events import growth
from stickslip.engine.series.polynomial import RECIPROCAL, evaluate, multiply, total
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Floats
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import inlined, kernel


@kernel
def keep_step(run: Run, rate: Floats, length: float, to: float) -> None:
    """Record the step, which is `length` units long and ends at xi = to, and move the state there."""
    multiply(run.local, run.powers, run.history[run.counts.length].load)
    move(run, length, growth(run, rate, length, 1.0), total(rate), to)


@inlined
def move(run: Run, length: float, grown: float, rate_end: float, to: float) -> None:
    """Record the step and move the state to its end, at xi = to.

    Load and rate (m/s, as a magnitude) are in the next free piece of the history. `grown` is the slip (m) in the step and
    `rate_end` the rate at its end (m/s), both unsigned.
    """
    direction = run.counts.mode
    load, rate = run.history[run.counts.length].load, run.history[run.counts.length].rate
    speed, bend = run.k.speed * length, run.k.bend * length * length
    if run.counts.is_block == 1:
        unload_spring(direction * run.params.stiffness * speed, direction * run.params.stiffness * bend, rate, load)
        run.load[0] -= run.params.stiffness * direction * grown
        if run.params.winding != 0.0:
            unwind(run, rate, speed, grown, to)
    if direction < 0:
        for k in range(at.TERMS):
            rate[k] = -rate[k]
    note_gain(run, rate)
    record(run, to)
    run.counts.moved, run.counts.leaving_rest = 1, 0
    run.state.slip_now += direction * grown
    run.state.law_slip += run.k.chi * grown
    run.state.rate_now = direction * max(rate_end, 0.0)


@kernel
def note_gain(run: Run, rate: Floats) -> None:
    """Note that slip multiplies an error of the load by the factor |2 Z / g'(v) - 1|.

    It follows from Z v + S mu(v) = load, and from the wave 2 Z v - load that goes back to the driver. The gain is NaN if friction
    or motion also depends on slip, inertia or a state, or the normal load varies, because the fate of an error then depends on more
    than its phase.
    """
    if run.counts.is_algebraic == 1 and run.counts.folds_move == 0 and run.counts.given == 0:
        friction_at(run, run.state.law_slip, abs(evaluate(rate, 0.5)))
        run.state.gain = abs(2.0 * run.params.impedance / (run.params.damping + run.friction.by_rate) - 1.0)
    else:
        run.state.gain = math.nan


@kernel
def unload_spring(straight: float, bent: float, rate: Floats, load: Floats) -> None:
    """Take stiffness times slip from the outer load, in place, because a block unloads its spring as it slips.

    `straight` and `bent` are the stiffness times A and times B of dphase = (A + B eta) d eta (N s/m, signed).
    """
    unload_straight(straight, rate, load)
    if bent != 0.0:
        unload_bent(bent, rate, load)


@inlined
def unload_straight(straight: float, rate: Floats, load: Floats) -> None:
    """Do the part of `unload_spring` with A."""
    for k in range(1, at.TERMS):
        load[k] = load[k] - straight * RECIPROCAL[k] * rate[k - 1]


@inlined
def unload_bent(bent: float, rate: Floats, load: Floats) -> None:
    """Do the part of `unload_spring` with B."""
    for k in range(2, at.TERMS):
        load[k] = load[k] - bent * RECIPROCAL[k] * rate[k - 2]
