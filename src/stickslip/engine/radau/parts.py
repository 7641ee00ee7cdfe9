"""Prove an implicit step whole or, where no disc around the whole step has a bound, part by part.

A formula may over- or underflow on a disc around a long step, as exp(-(v / v_s)^2) does off the real axis, or may be singular at a
slip rate of zero, as v log v is, that lies in the disc and not in the step. The step is halved then, and the halves again, until
each part has a disc that is small enough. Beside a slip rate of zero the parts become ever shorter, down to the rounding of time.
"""

from __future__ import annotations

import math

from stickslip.engine.radau.proof import FAINT, SIZE, measure, moved_on_disc, share_of_part, step_proof
from stickslip.engine.radau.stages import larger
from stickslip.engine.series.radau_nodes import STAGES
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import kernel

MOST_PARTS = 400
"""Examine at most this many parts (1)."""
MISSED = 1e3
"""A step with a share (1) above this is made shorter: no other part of it is looked at."""
ROUNDING_OF_TIME, LEAST_WIDTH = 5e-16, 2.0**-50
"""A part is no shorter than this share (1) of the round trip, and of the step. What lasts less than the first is one moment."""
ZERO_DISC = 0.62
"""Radius (1) of the disc, in lengths of a part, on which a slip rate of zero counts as reached."""
NEAR_ZERO = 0.7
"""Zero counts as reached if the slip rate changes by this share (1) of its value in the middle of the part."""


@kernel
def share_of_step(run: Run) -> float:
    """Return the bound on the residuals of the step as a share of the allowed one; infinite if some part of it has no bound.

    `begin_proof` has begun the proof. Notes the bound, the place up to which the step is proven, and whether a part has no bound
    because the law is singular at the slip rate of zero there.
    """
    share = share_of_part(run, 0.0, 1.0)
    return share_of_parts(run) if share == math.inf else share


@kernel
def share_of_parts(run: Run) -> float:
    """Return the same for a step that must be proven part by part."""
    proof = step_proof(run)
    instant = ROUNDING_OF_TIME * run.params.round_trip_time / proof.duration
    least = max(LEAST_WIDTH, instant)
    start, width, worst = 0.0, 0.5, 0.0
    for _ in range(MOST_PARTS):
        share = share_of_part(run, start, width)
        if share == math.inf and run.counts.mode != 0 and abs(run.trial[0]) <= FAINT:
            proof.lacks_bound, share = 1.0, 0.0  # floats have no digits left for a proof
        if share == math.inf and width > least:
            width *= 0.5
            continue
        if share == math.inf:
            if width > instant and not reaches_zero(run):
                break
            measure(run)
            proof.bound = larger(proof.bound, proof.measured)
            if not math.isfinite(proof.measured):
                proof.lacks_bound = 1.0
            if turns(run):
                return worst
            share = 0.0
        worst = max(worst, share)
        start += width
        proof.proven_to = start
        if worst > MISSED:
            break
        if start >= 1.0:
            return worst
        if start + 2.0 * width <= 1.0 and math.floor(0.5 * start / width) * 2.0 * width == start:
            width *= 2.0
    return math.inf


@kernel
def reaches_zero(run: Run) -> bool:
    """Return True if the slip rate comes near zero on the part that was looked at last."""
    return run.counts.mode != 0 and moved_on_disc(run.trial, SIZE, 1, STAGES, ZERO_DISC) >= NEAR_ZERO * abs(run.trial[0])


@kernel
def turns(run: Run) -> bool:
    """Return True if the slip rate falls below zero on that part: the step is cut there, and nothing behind it needs a proof."""
    end = 0.0
    for k in range(STAGES, -1, -1):
        end = 0.5 * end + run.trial[k]
    return end < 0.0
