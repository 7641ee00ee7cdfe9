"""The numbers of runs that step side by side: a place holds one number for every lane, so that the processor works on all at once.

A run's numbers are copied into its lane when it meets a piece of load, stay there from step to step, and are copied back when the
engine goes on with the run. The names are those of `engine.state.workspace.Run`.
"""

from __future__ import annotations

from typing import Any

from stickslip.engine.contact.contact_equation import constants_of
from stickslip.engine.contact_step.certificate import RATIOS, SHRUNK, SHRUNK_SLOPE
from stickslip.engine.series.polynomial import powers_of
from stickslip.engine.state.layout import TERMS, Ball, Floats, HistoryPiece, LawValue, SeriesInput, State
from stickslip.engine.state.workspace import Run
from stickslip.foundation.kernels.kernels import inlined
from stickslip.foundation.kernels.memory.pointers import all_lanes, one_lane
from stickslip.foundation.kernels.memory.records import MemoryRecord, floats_inside, inside
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH


class LaneBlock(MemoryRecord):
    """Hold the numbers of runs in lanes, and those of the step that they take."""

    state: State = inside(State)
    k: SeriesInput = inside(SeriesInput)  # input of the series
    load: Floats = floats_inside(TERMS)  # Pa or N: the present piece of load, as a polynomial in xi
    local: Floats = floats_inside(TERMS)
    load_along_slip: Floats = floats_inside(TERMS)
    jet: Floats = floats_inside(TERMS)  # the law's functions write `centres` right after it
    centres: Floats = floats_inside(TERMS)
    powers: Floats = floats_inside(TERMS)
    ball: Ball = inside(Ball)
    value: LawValue = inside(LawValue)
    row: HistoryPiece = inside(HistoryPiece)  # what the step leaves in the history, but for its whole numbers
    direction: float  # +1 or -1: as `Counts.mode`
    reference: float  # Pa or N: reference strength
    stiffness: float  # N/m: stiffness of a block's spring; 0 for a slab
    tolerance: float  # 1: local error allowed to the step
    slip_shift: float  # m: as in `LawPiece`
    ratio: float  # 1: radius of the disc on which a step is proven, in lengths of the step
    shrunk: float  # 1: ratio of the residual on the step to that on the disc
    disc: float  # 1: number of the disc that served the step before
    share: float  # 1: bound on the residual of the step, as a share (`contact_step.certificate`)
    rate: Floats = floats_inside(TERMS)  # m/s: magnitude of the slip rate over the step, as a polynomial on [0, 1]
    slope: Floats = floats_inside(TERMS)  # m/s: slope of that polynomial, with the sign that makes it start above zero
    unit: float  # length, in xi, in whose units the series is
    usable: float  # length that the error allows the step, in units
    length: float  # length of the step, in units
    limit: float  # length of the way to the target, in units
    last_step: float  # s: length that the error allows the step to have
    grown: float  # m: slip in the step
    in_piece: float  # m: the same with its sign, from what the step leaves in the history
    rate_end: float  # m/s: slip rate at its end
    at_end: Floats = floats_inside(2)  # m, m/s: slip of the law and slip rate there
    to: float  # 1: place xi at which it ends
    nowhere: Floats = floats_inside(HistoryPiece.total // SIMD_WIDTH + 1)  # room for the history of a lane that takes no step
    targets: float  # addresses of each lane's next free piece of the history
    constants: Floats = floats_inside(0)  # constants of the law, as many as it has


block_in_all_lanes: Any = all_lanes(LaneBlock)
"""Function for compiled code that sees the block at an address in all lanes at once."""
block_in_one_lane: Any = one_lane(LaneBlock)
"""Function for compiled code that sees the block at an address in lane 0."""


@inlined
def put_in(run: Run, own: LaneBlock) -> None:
    """Copy a run, which has met a piece of load, into its lane of the block."""
    state, to, piece = run.state, own.state, run.counts.piece
    to.xi, to.target, to.speed, to.bend = state.xi, state.target, state.speed, state.bend
    to.phase_from, to.phase_to = state.phase_from, state.phase_to
    to.slip_now, to.law_slip, to.rate_now, to.last_step = state.slip_now, state.law_slip, state.rate_now, state.last_step
    to.largest_residual = state.largest_residual
    for n in range(TERMS):
        own.load[n] = run.load[n]
    own.direction, own.reference, own.tolerance = run.counts.mode, run.params.reference, run.params.tolerance
    own.stiffness, own.slip_shift = run.params.stiffness, run.law[piece].slip_shift
    own.row.amplified = state.amplified
    edge, k = run.counts.leaving_rest != 0, own.k
    k.damping, k.normal, k.inertia, k.stiffness = run.k.damping, run.k.normal, run.k.inertia, run.k.stiffness
    k.chi, k.offset = run.counts.mode if run.params.counts_net == 1.0 else 1.0, run.law[piece].offset
    k.free, k.force = (0.0, run.params.normal * run.params.static_excess) if edge else (1.0, 0.0)
    constants = constants_of(run, piece)
    for n in range(run.size):
        own.constants[n] = constants[n]
    note_disc(run, own)


@inlined
def note_disc(run: Run, own: LaneBlock) -> None:
    """Copy what the number of a run's disc stands for into its lane of the block."""
    own.ratio = RATIOS[run.counts.disc]
    own.shrunk = SHRUNK_SLOPE[run.counts.disc] if run.counts.has_inertia == 1 else SHRUNK[run.counts.disc]


@inlined
def take_out(run: Run, own: LaneBlock) -> None:
    """Copy what steps in lanes have changed back into the run."""
    state, now = run.state, own.state
    state.xi, state.slip_now, state.law_slip, state.rate_now = now.xi, now.slip_now, now.law_slip, now.rate_now
    state.last_step, state.largest_residual, state.residual = now.last_step, now.largest_residual, 0.0
    run.load[0], run.k.chi = own.load[0], own.k.chi


@inlined
def lend_step(run: Run, own: LaneBlock) -> None:
    """Copy the input of the step at hand, and its series, into the scratch space of the run, where the engine looks for them."""
    run.k.chi, run.k.speed, run.k.bend, run.k.slip = own.k.chi, own.k.speed, own.k.bend, own.k.slip
    run.k.offset, run.k.rate, run.k.free, run.k.force = own.k.offset, own.k.rate, own.k.free, own.k.force
    run.state.law_slip, run.state.unbalanced = own.state.law_slip, own.state.unbalanced
    for n in range(TERMS):
        run.load_along_slip[n], run.jet[n], run.centres[n] = own.load_along_slip[n], own.jet[n], own.centres[n]


@inlined
def lend_rate(run: Run, own: LaneBlock) -> Floats:
    """Copy the slip rate over the step at hand, and the powers of its length, to the run; return where the rate is."""
    lend_step(run, own)
    for n in range(TERMS):
        run.trial[n] = own.rate[n]
    powers_of(own.length, run.powers)
    return run.trial
