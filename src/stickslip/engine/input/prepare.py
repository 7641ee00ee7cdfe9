"""Preparation of a run: from a problem to the numbers that the compiled engine works on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

import numpy as np

from stickslip.contact import folds_not_followed, rule_of
from stickslip.engine.compiled_formula import CompiledFormula, compile_formula, keep_with
from stickslip.engine.contact_step.certificate import RATIOS
from stickslip.engine.input.branch_table import branch_of, is_algebraic, table_of_branches
from stickslip.engine.input.forcing import (
    Inflow,
    breaks_of,
    inflow_of,
    machine_at_first,
    pressing_of,
    pull_of,
    steady_inflow,
    steady_ramp,
    tone_of,
    wave_before,
)
from stickslip.engine.input.ladder import first_pieces, ladder_of, set_counts
from stickslip.engine.input.limits import set_length, set_lumping
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, FirstLoad, Integers, LawPiece, LoadingSegment, Params, Setup, State
from stickslip.engine.state.workspace import counts_in, lend_problem, memory_of, params_in
from stickslip.foundation.arrays import at_least
from stickslip.foundation.constants import RIGID
from stickslip.foundation.errors import InputError
from stickslip.problem import EVENT_SHARE, LoadingHistory, Problem, SelectionRule, automatic_length


def prepare(problem: Problem, rtol: float, shortest: float | None = 0.0) -> tuple[Setup, Integers]:
    """Return the engine's setup for a problem, and the memory of a run at t = 0; a history must still be lent to it.

    `Setup.params` are those in the memory, which holds the addresses of the setup's tables: the caller keeps both. Compiles the
    law's formulas if they are new. The result is cached for the next run.
    """
    setup, first = _prepared(problem, rule_of(problem), rtol, shortest)
    memory = first.copy()
    return Setup(params_in(memory), *setup[1:]), memory


def set_tolerance(params: Params, rtol: Any, shortest: float | None) -> None:
    """Set the numbers that depend on the tolerance, in `Setup.params` or in one with a column for each member."""
    set_length(params, shortest)
    params.tolerance, params.relative_jump = rtol * SAFETY, at_least(1e-10, 10.0 * rtol)
    params.first_disc = first_disc(rtol * SAFETY)


def first_disc(tolerance: Any) -> Any:
    """Return the disc on which runs with these local tolerances (1) try to prove their first step, an index of RATIOS.

    The last terms of a step are at the tolerance, and terms grow with the radius: near this one they are as large as the slip rate.
    """
    if isinstance(tolerance, float):
        return _one_disc(tolerance)
    reach = np.asarray(tolerance) ** (-1.0 / (at.TERMS - 1))
    return np.argmin(abs(np.log(RATIOS) - np.log(reach)[..., None]), axis=-1)


@lru_cache(maxsize=32)
def _one_disc(tolerance: float) -> int:
    return int(first_disc(np.array(tolerance)))


@lru_cache(maxsize=32)
def _prepared(problem: Problem, rule: SelectionRule, rtol: float, shortest: float | None) -> tuple[Setup, Integers]:
    setup, state, counts = _of_problem(problem, rule)
    memory = memory_of(setup.params, state, counts)
    set_tolerance(params_in(memory), rtol, shortest)
    set_lumping(counts_in(memory), problem, shortest)
    lend_problem(memory, setup)
    memory.flags.writeable = False
    return setup, memory


@lru_cache(maxsize=32)
def _of_problem(problem: Problem, _: SelectionRule) -> tuple[Setup, State, Counts]:  # keyed by the rule: its name may be reused
    if why := folds_not_followed(problem):
        raise InputError(why)
    check_machine(problem)
    params = parameters_of(problem)
    branches, params.stick_to = table_of_branches(problem, 0.0)
    first = first_load_varying(problem) if problem.varies else first_load(problem)
    setup = Setup(params, *law_tables(problem), branches, first, loading_of(problem), ladder_of(problem))
    for shared in (params.numbers, *setup[1:]):
        shared.flags.writeable = False
    state, counts = start_of(problem)
    if counts.is_algebraic and counts.mode != 0:
        counts.branch = branch_of(at.BranchRow.of(branches), abs(problem.rate))
    return setup, state, counts


def check_machine(problem: Problem) -> None:
    """Raise InputError for a driver that moves so quickly by itself that a round trip would need more than MOST_PARTS parts."""
    body = problem.body
    if not body.has_machine:
        return
    heavy, resists = body.driver_inertia > 0.0, body.driver_impedance + body.last_impedance
    changes = body.driver_integral_gain / resists
    if heavy:
        changes = resists / body.driver_inertia + math.sqrt(body.driver_integral_gain / body.driver_inertia)
    if changes * body.round_trip_time > MOST_PARTS:
        cure = "leave driver_inertia out" if heavy else "lower driver_integral_gain, or make the driver rigid"
        raise InputError(
            f"{type(body).__name__}: the driver answers within {1.0 / changes:.3g} s, too short to be followed: {cure}"
        )


def parameters_of(problem: Problem) -> Params:
    """Return `Setup.params` without the numbers that depend on the tolerance.

    If any of the problem's numbers is an array, the result has a column for each member of a batch.
    """
    body, law = problem.body, problem.contact_law
    params = SimpleNamespace(**dict.fromkeys(Params.places, 0.0))
    params.round_trip_time = problem.round_trip_time
    params.normal = problem.normal
    params.reference = problem.strength
    params.counts_net = 1.0 if law.counts == "net" else 0.0
    params.static_excess = law.static_excess
    params.state_scale = [state.scale for state in law.states] + [0.0] * (at.STATES - len(law.states))
    params.rate_floor = SMALLEST if law.sticks else SLOWEST * min(law.rate_scales, default=1.0)
    params.healed_piece = int(law.piece_at(problem.law_slip)) if law.memory == "since-arrest" else -1
    params.can_be_negative = 1.0 if law.can_be_negative else 0.0
    lowest, _ = law.range()
    params.largest_drop = at_least(0.0, problem.strength - problem.normal * lowest)
    params.damping, params.impedance, params.reflection = body.damping, body.impedance, body.reflection
    params.inertia, params.shortest = body.inertia, automatic_length(body)
    if body.has_waves:
        params.smallest_jump = 1e-14 * problem.normal / body.impedance
    else:
        params.stiffness, params.slow = body.stiffness, EVENT_SHARE * problem.normal * law.variation / body.impedance
    if problem.varies:
        params.tone_frequency = tone_of(problem).frequency
        params.inflow_from = 0.0 if problem.ground is not None and body.is_uniform else body.inflow_delay
    elif not body.has_waves:
        params.ramp = body.stiffness * problem.first_pull_rate * problem.round_trip_time
    else:
        params.inflow, params.inflow_rate = steady_inflow(problem)
        params.inflow_from = body.inflow_delay
        params.ramp = steady_ramp(problem)
    if body.has_machine:
        params.reflection = RIGID
        params.driver_inertia, params.driver_impedance = body.driver_inertia, body.driver_impedance
        params.driver_gain = body.driver_integral_gain
        params.driver_spring = 0.0 if body.is_uniform else body.stiffness
        pulled = isinstance(problem.pull_rate, LoadingHistory) and body.driver_impedance > 0.0
        params.pull_share = 1.0 / body.driver_impedance if pulled else 0.0
    if problem.normal_varies:
        params.pressing_tone, params.pressing_frequency, params.pressing_phase = pressing_of(problem).tone
        params.coupling = problem.friction.normal_coupling
    return Params(together(_in_order(vars(params))))


def _in_order(params: dict[str, Any]) -> list[Any]:
    """Return the numbers of `Setup.params` in the order of their places; some have several, as a list."""
    numbers: list[Any] = []
    for name in Params.places:
        number = params[name]
        numbers += number if type(number) is list else (number,)
    return numbers


def together(numbers: Sequence[Any]) -> at.Floats:
    """Return one table of numbers; it has a column for each member if any of them is an array."""
    if np.ndarray in set(map(type, numbers)) and any(map(np.ndim, numbers)):
        return np.stack([np.asarray(number, float) for number in np.broadcast_arrays(*numbers)])
    return np.array(numbers, float)


SMALLEST, SLOWEST = 1e-300, 1e-12
"""Slip rates that are resolved to the last digit: any (m/s) if slip begins from rest; down to this share of the law's own rate
scale if friction has no rest.
"""
SAFETY = 0.1
"""Local tolerance per step as a share of rtol: leaves the error of a whole run below rtol (see docs/numerics.md)."""


def first_load(problem: Problem) -> at.Floats:
    """Return the load of the first round trip (minus the reference), linear between its breaking points."""
    body, excess = problem.body, problem.excess
    if not body.is_uniform:
        return first_pieces(problem)
    if not body.has_waves:
        return _pieces([0.0, problem.round_trip_time], [excess], [body.stiffness * problem.first_pull_rate])
    slope = body.impedance * problem.initial_shear / (0.5 * body.round_trip_time)  # G (V - v0) / h
    if body.is_driven_rigidly:
        return _pieces([0.0, body.round_trip_time], [excess], [slope])
    r, half = body.reflection, 0.5 * body.round_trip_time
    steady, rate = steady_inflow(problem)
    # for h/c <= t < R the waves of the initial state come back: w(t - R) = G (V - v0) (R - t) / h - (load - 2 Z v0)
    reflected = steady + rate * half + r * (slope * half - wave_before(problem))
    before = excess + slope * half
    jump = abs(reflected - before) > 1e-12 * np.maximum(abs(problem.strength), abs(before))
    return _pieces([0.0, half, 2.0 * half], [excess, np.where(jump, reflected, before)], [slope, rate - r * slope], [0.0, jump])


def first_load_varying(problem: Problem) -> at.Floats:
    """Return the load of the first round trip without the inflow of a loading that varies.

    Its parts are so short that a tone in them is a polynomial to rounding.
    """
    body, excess = problem.body, problem.excess
    if not body.is_uniform:
        return _parts(problem, first_pieces(problem))
    if not body.has_waves:
        return _parts(problem, _pieces([0.0, problem.round_trip_time], [excess], [0.0]))
    r, half = RIGID if body.has_machine else body.reflection, 0.5 * body.round_trip_time
    slope = body.impedance * problem.initial_shear / half
    before, back = excess + slope * half, r * (slope * half - wave_before(problem))
    if body.has_machine:
        comes = 2.0 * body.impedance * machine_at_first(problem)[0]
    else:
        comes = float(inflow_of(problem).at(np.array(half)))
    jump = abs(back + comes - before) > 1e-12 * max(abs(problem.strength), abs(before))
    if problem.driver_changes:
        return _parts(problem, _first_through_changes(problem, slope, jump))
    return _parts(problem, _pieces([0.0, half, 2.0 * half], [excess, back], [slope, -r * slope], [0.0, jump]))


def _first_through_changes(problem: Problem, slope: float, jump: bool) -> at.Floats:
    """Return the same pieces where the driver changes, perhaps in the time when it sends the initial state back.

    `slope` (Pa/s) is that of the load until h/c; `jump` says whether the load jumps then. Other jumps are those of the loading.
    """
    trip, inflow = problem.round_trip_time, inflow_of(problem)
    half, start = 0.5 * trip, inflow.start
    phases = np.append(half, start[(start > half) & (start < trip)])
    share = inflow.reflection_at(phases)
    back = share * (slope * (trip - phases) - wave_before(problem))
    jumps = [0.0, float(jump), *np.zeros(len(phases) - 1)]
    return _pieces([0.0, *phases, trip], [problem.excess, *back], [slope, *(-share * slope)], jumps)


def _parts(problem: Problem, pieces: at.Floats) -> at.Floats:
    """Return the same load in shorter pieces; the phase of a tone changes by at most LARGEST_TURN in each."""
    known, tone = FirstLoad.of(pieces), tone_of(problem)
    phase = known.phase
    if tone.amplitude == 0.0:
        return pieces
    counts = np.ceil(np.diff(phase) * tone.frequency / LARGEST_TURN).astype(int).clip(1)
    if counts.sum() > MOST_PARTS:
        period = 2.0 * math.pi / tone.frequency
        least = 2.0 * math.pi * phase[-1] / (MOST_PARTS * LARGEST_TURN)
        raise InputError(f"the loading's period of {period:g} s is too short: at least about {least:.3g} s is needed")
    edges = [np.linspace(low, high, n, endpoint=False) for low, high, n in zip(phase[:-1], phase[1:], counts, strict=True)]
    of = np.repeat(np.arange(len(counts)), counts)
    begin = np.concatenate(edges)
    load = known.load[of] + known.slope[of] * (begin - phase[of])
    jump = np.where(begin == phase[of], known.jump[of], 0.0)
    return _pieces([*begin, phase[-1]], [*load], [*known.slope[of]], [*jump])


NOT_VARYING = LoadingSegment.table(1)
"""Table `Setup.loading` of a loading that does not vary."""
LARGEST_TURN, MOST_PARTS = 1.0, 100_000
"""A sine's Taylor series is right to rounding up to this phase (rad); largest number of parts of a round trip."""


def loading_of(problem: Problem) -> at.Floats:
    """Return the segments of inflow and normal load, and where they arrive; an empty one if both are steady."""
    if not problem.varies:
        return NOT_VARYING
    from stickslip.engine.input import shaking  # of moving ground

    inflow, pressing = inflow_of(problem), pressing_of(problem)
    ground, body = problem.ground, problem.body
    shaken = shaking.shaking_of(problem) if ground is not None and body.has_waves and body.is_uniform else None
    start = np.union1d(inflow.start if shaken is None else shaken.start, pressing.start)
    if ground is not None and not body.is_uniform:
        start = np.union1d(start, ground.start)
    table = LoadingSegment.table(len(start))
    segments = LoadingSegment.of(table)
    segments.trip, segments.offset = zip(*breaks_of(start, problem.round_trip_time, ground is not None), strict=True)
    segments.tone, segments.tone_phase = inflow.tone.amplitude, inflow.tone.phase
    _set_driver(segments, inflow, start, problem)
    straight: list[tuple[Any, str, str]] = [(pressing, "pressing", "pressing_rate")]
    if body.has_machine:
        straight.append((pull_of(problem), "pull", "pull_slope"))
    if shaken is None:
        straight.append((inflow, "value", "slope"))
    else:
        shaken.put(segments, start)
    if ground is not None and not body.has_waves:
        segments.step = shaking.force_steps(problem, start)
        segments.jump[1:] = segments.step[1:] != 0.0
    elif ground is not None and not body.is_uniform:
        shaking.put_ground(segments, ground, start)
    for one, value, slope in straight:
        of = np.searchsorted(one.start, start, side="right") - 1
        begins, grows = one.value[of] + one.slope[of] * (start - one.start[of]), one.slope[of]
        ends = begins[:-1] + grows[:-1] * np.diff(start)
        jumps = abs(begins[1:] - ends) > 1e-14 * np.maximum(abs(ends), abs(begins[1:]))
        segments.jump[1:] = np.maximum(segments.jump[1:], jumps)
        setattr(segments, value, begins)
        setattr(segments, slope, grows)
    return table


def _set_driver(segments: Any, inflow: Inflow, start: at.Floats, problem: Problem) -> None:
    """Write what a driver does to waves and to a tone into segments (`LoadingSegment.of` a table) that begin at times (s)."""
    segments.reflection = RIGID if problem.body.has_machine else problem.body.reflection
    if not problem.driver_changes:
        return
    middle = start + 0.5 * np.diff(np.append(start, start[-1] + problem.round_trip_time))  # whatever the rounding of the starts
    of = inflow.segment(middle)
    segments.reflection, segments.tone = inflow.reflection[of], inflow.gain[of] * inflow.tone.amplitude
    segments.jump[1:] = np.diff(segments.reflection) != 0.0


def _pieces(phase: list[Any], load: list[Any], slope: list[Any], jump: list[Any] | None = None) -> at.Floats:
    """Return a table of `FirstLoad`, or one for each member of a batch, from the edges of the pieces and from their numbers."""
    numbers = together([*phase, *load, 0.0, *slope, 0.0, *(jump or [0.0] * len(load)), 0.0])
    fields = numbers.reshape(FirstLoad.total, len(phase), *numbers.shape[1:])
    return np.ascontiguousarray(fields.transpose(*range(2, fields.ndim), 1, 0))


def law_tables(problem: Problem) -> tuple[at.Integers, at.Floats]:
    """Return the pieces of the law as a table of `LawPiece`, and the constants of their formulas."""
    law, start = problem.contact_law, problem.law_slip
    formulas = [compile_formula(tree, law.parameters(), law.state_trees()) for tree in law.trees()]
    home, static = int(law.piece_at(start)), float(law.static_coefficient(start)) if len(formulas) > 1 else 0.0
    references, numbers = references_of(problem, home, static, lambda i, slip: float(law.piece_coefficient(i, slip, 0.0)))
    constants = np.zeros((len(formulas), max(formula.size for formula in formulas)))
    for i, (row, formula) in enumerate(zip(constants, formulas, strict=True)):
        formula.fill(np.array(law.piece_values(i)), references[i], row)
    table = functions_of(formulas, problem)
    set_references(table, numbers)
    return table, constants


def references_of(problem: Problem, home: int, static: Any, friction: Callable[[int, Any], Any]) -> tuple[list[Any], at.Floats]:
    """Return the reference slip of each piece of the law, and the numbers for `set_references`.

    Each piece's friction is a difference from its value at the piece's own reference slip: the start in the piece `home`, which
    holds there, and the near knot in any other. `static` is the static friction coefficient at the start, and `friction` returns mu
    of a piece at a slip and v = 0. If any number is an array, the numbers have a column for each member of a batch.
    """
    law, start, pieces = problem.contact_law, problem.law_slip, range(len(problem.friction.pieces))
    in_slip = law.knot_variable == "slip"
    references = [start if i == home or not in_slip else law.knots[i - 1 if i > home else i] for i in pieces]
    offsets = [-law.static_excess if i == home else friction(i, references[i]) - static for i in pieces]
    knots = [*(knot - start if in_slip else knot for knot in law.knots), math.inf]
    return references, together([*(start - reference for reference in references), *offsets, *knots])


def set_references(table: at.Integers, numbers: at.Floats) -> None:
    """Write the numbers of `references_of` into a table of `LawPiece`, or into one for each member of a batch."""
    pieces, columns = LawPiece.of(table), numbers.reshape(3, -1, *numbers.shape[1:])
    pieces.slip_shift, pieces.offset, pieces.knot = columns.transpose(0, *range(2, columns.ndim), 1)


def functions_of(formulas: Sequence[CompiledFormula], problem: Problem) -> at.Integers:
    """Return a table of `LawPiece` with only the functions set, those that the engine needs.

    A law with a state of its own is always stepped implicitly.
    """
    table = LawPiece.table(len(formulas))
    keep_with(table, formulas)
    for place, formula in zip(table, formulas, strict=True):
        piece = LawPiece(place)
        if not is_algebraic(problem):
            piece.balls_at = formula.address("balls")
        if problem.contact_law.states:
            piece.state_at = formula.address("state_value")
        else:
            piece.value_at = formula.address("value")
        if not problem.friction.states:
            piece.radii_at = formula.address("radii")
            piece.jet_at = formula.address("motion_jet" if problem.body.has_inertia else "rate_jet")
    return table


def start_of(problem: Problem) -> tuple[State, Counts]:
    """Return the state and counts at t = 0, before the first piece of load: the contact is at rest, or has an initial rate.

    Under a law that never sticks there is no rest: without an initial rate the contact slips in the direction of the load.
    """
    state, count = State(np.zeros(State.total)), Counts(np.zeros(Counts.total, np.int64))
    state.last_step = math.inf
    count.piece = int(problem.friction.piece_at(problem.law_slip))
    count.varies, count.driven = problem.varies, problem.body.has_machine
    if count.driven:
        state.driver_rate, state.driver_push = machine_at_first(problem)
    count.is_block = not problem.body.has_waves
    count.has_inertia = problem.body.has_inertia
    count.is_algebraic = is_algebraic(problem)
    count.states, count.sticks = len(problem.contact_law.states), problem.friction.sticks
    count.given = problem.contact_law.given
    count.one_way = problem.one_way
    set_counts(count, problem)
    count.reverses = sum(2**n for n in problem.friction.reverses)
    if problem.has_initial_rate or not problem.friction.sticks:
        state.rate_now = problem.rate
        count.mode = 1 if (problem.rate or problem.load) >= 0.0 else -1
    for n, value in enumerate(problem.contact_states):
        state.state_now[n] = -value if count.mode < 0 and n in problem.friction.reverses else value
    count.pause_at = count.lumped_since = count.lump_above = at.NEVER
    count.folds_move = count.folds_follow_slip = problem.folds_move
    count.disc = at.NO_DISC
    count.knots_in_rate = len(problem.friction.pieces) > 1 and problem.friction.knot_variable == "rate"
    return state, count
