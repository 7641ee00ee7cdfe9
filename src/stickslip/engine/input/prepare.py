"""Preparation of a run: from a problem to the numbers that the compiled engine works on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from stickslip.contact import folds_not_followed, rule_of
from stickslip.engine.compiled_formula import CompiledFormula, compile_formula, keep_with
from stickslip.engine.contact_step.certificate import RATIOS
from stickslip.engine.input.asked import INPUTS, AtRest, Shaken
from stickslip.engine.input.branch_table import branch_of, branches_both_ways, is_algebraic
from stickslip.engine.input.first_pieces import pieces_of, together
from stickslip.engine.input.limits import set_length, set_lumping
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, FirstLoad, Integers, LawPiece, LoadingSegment, Params, Setup, State
from stickslip.engine.state.workspace import counts_in, lend_problem, memory_of, params_in
from stickslip.foundation.arrays import at_least
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem, SelectionRule, automatic_length, breaks_of, driver_of, inflow_of, pressing_of, tone_of


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
    params.tolerance, params.relative_jump = rtol * SHARE_OF_TOLERANCE, at_least(1e-10, 10.0 * rtol)
    params.first_disc = first_disc(rtol * SHARE_OF_TOLERANCE)


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
    check_driver(problem)
    params = parameters_of(problem)
    branches, found = branches_both_ways(problem)
    for name, value in found.items():
        setattr(params, name, value)
    own = INPUTS[problem.body.structure]
    first = _parts(problem, own.first_load_varying(problem)) if problem.varies else own.first_load(problem)
    setup = Setup(params, *law_tables(problem), branches, first, loading_of(problem), own.ladder(problem))
    for shared in (params.numbers, *setup[1:]):
        shared.flags.writeable = False
    state, counts = start_of(problem)
    counts.side = int(np.sign(params.first_lag)) if params.play > 0.0 else 0
    if counts.is_algebraic and counts.mode != 0:
        turn = int(params.backward_branch) or len(branches)
        begin, end = (turn, len(branches)) if counts.mode < 0 and turn < len(branches) else (0, turn)
        counts.branch = begin + branch_of(at.BranchRow.of(branches[begin:end]), abs(problem.rate))
    return setup, state, counts


def check_driver(problem: Problem) -> None:
    """Raise InputError for a driver that moves so quickly by itself that a round trip would need more than MOST_PARTS parts."""
    body, within = problem.body, driver_of(problem).changes_within(problem)
    if body.round_trip_time > MOST_PARTS * within:
        cure = "leave driver_inertia out" if body.driver_inertia > 0.0 else "lower driver_integral_gain, or make the driver rigid"
        raise InputError(f"{type(body).__name__}: the driver answers within {within:.3g} s, too short to be followed: {cure}")


def parameters_of(problem: Problem) -> Params:
    """Return `Setup.params` without the numbers that depend on the tolerance.

    If any of the problem's numbers is an array, the result has a column for each member of a batch.
    """
    body, law, own, driver = problem.body, problem.contact_law, INPUTS[problem.body.structure], driver_of(problem)
    lowest, _ = law.range()
    numbers = dict.fromkeys(Params.places, 0.0) | {
        "round_trip_time": problem.round_trip_time,
        "normal": problem.normal,
        "reference": problem.strength,
        "counts_net": 1.0 if law.counts == "net" else 0.0,
        "static_excess": law.static_excess,
        "backward_piece": float(law.backward_from),
        "backward_excess": law.ways[1].static_excess if law.backward_from else 0.0,
        "state_scale": [state.scale for state in law.states] + [0.0] * (at.STATES - len(law.states)),
        "rate_floor": SMALLEST if law.sticks else SLOWEST * min(law.rate_scales, default=1.0),
        "healed_piece": int(law.piece_at(problem.law_slip)) if law.memory == "since-arrest" else -1,
        "can_be_negative": 1.0 if law.can_be_negative else 0.0,
        "largest_drop": at_least(0.0, problem.strength - problem.normal * lowest),
        "damping": body.total_damping,
        "impedance": body.impedance,
        "reflection": body.reflection,
        "inertia": body.inertia,
        "shortest": automatic_length(body),
        "stop_ahead": math.inf,
        "stop_behind": -math.inf,
    }
    numbers |= own.numbers(problem) | driver.numbers(problem)
    numbers |= {"tone_frequency": tone_of(problem).frequency} if problem.varies else own.steady_numbers(problem)
    if problem.normal_varies:
        pressing = zip(("pressing_tone", "pressing_frequency", "pressing_phase"), pressing_of(problem).tone, strict=True)
        numbers |= {**dict(pressing), "coupling": problem.friction.normal_coupling}
    return Params(together(_in_order(numbers)))


def _in_order(params: dict[str, Any]) -> list[Any]:
    """Return the numbers of `Setup.params` in the order of their places; some have several, as a list."""
    numbers: list[Any] = []
    for name in Params.places:
        number = params[name]
        numbers += number if type(number) is list else (number,)
    return numbers


SMALLEST, SLOWEST = 1e-300, 1e-12
"""Slip rates that are resolved to the last digit: any (m/s) if slip begins from rest; down to this share of the law's own rate
scale if friction has no rest.
"""
SHARE_OF_TOLERANCE = 0.1
"""Local tolerance per step as a share of rtol: leaves the error of a whole run below rtol (see docs/numerics.md)."""


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
    return pieces_of([*begin, phase[-1]], [*load], [*known.slope[of]], [*jump])


class Straight(Protocol):
    """What grows in straight segments."""

    @property
    def start(self) -> at.Floats:
        """When each begins, s."""
        ...

    @property
    def value(self) -> at.Floats:
        """What it begins with."""
        ...

    @property
    def slope(self) -> at.Floats:
        """Its growth per second."""
        ...


NOT_VARYING = LoadingSegment.table(1)
"""Table `Setup.loading` of a loading that does not vary."""
LARGEST_TURN, MOST_PARTS = 1.0, 100_000
"""A sine's Taylor series is right to rounding up to this phase (rad); largest number of parts of a round trip."""


def loading_of(problem: Problem) -> at.Floats:
    """Return the segments of inflow and normal load, and where they arrive; an empty one if both are steady."""
    if not problem.varies:
        return NOT_VARYING
    inflow, pressing = inflow_of(problem), pressing_of(problem)
    ground: Shaken = INPUTS[problem.body.structure].on_ground(problem) if problem.ground is not None else AtRest()
    brought: list[Straight] = [] if ground.brings_inflow else [inflow]
    parts = [pressing, *brought]
    start = np.unique(np.concatenate([ground.start, *(one.start for one in parts)]))
    table = LoadingSegment.table(len(start))
    segments = LoadingSegment.of(table)
    joined = problem.ground is not None or problem.force is not None
    segments.trip, segments.offset = zip(*breaks_of(start, problem.round_trip_time, joined), strict=True)
    middle = start + 0.5 * np.diff(np.append(start, start[-1] + problem.round_trip_time))  # whatever the rounding of the starts
    of = inflow.segment(middle)
    driver_of(problem).put(problem, segments, start, middle)
    segments.tone, segments.tone_phase = inflow.gain[of] * inflow.tone.amplitude, inflow.tone.phase
    segments.jump[1:] = np.diff(segments.reflection) != 0.0
    ground.put(segments, start)
    for time, step in driver_of(problem).steps(problem):
        segments.step[start == time] += step
        segments.jump[start == time] = 1.0
    pulls = driver_of(problem).pulls(problem)
    columns = [("pressing", "pressing_rate"), *[("value", "slope")] * len(brought), *[("pull", "pull_slope")] * len(pulls)]
    for one, (value, slope) in zip((*parts, *pulls), columns, strict=True):
        of = np.searchsorted(one.start, start, side="right") - 1
        begins, grows = one.value[of] + one.slope[of] * (start - one.start[of]), one.slope[of]
        ends = begins[:-1] + grows[:-1] * np.diff(start)
        jumps = abs(begins[1:] - ends) > 1e-14 * np.maximum(abs(ends), abs(begins[1:]))
        segments.jump[1:] = np.maximum(segments.jump[1:], jumps)
        setattr(segments, value, begins)
        setattr(segments, slope, grows)
    return table


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
    in_slip, first = law.knot_variable == "slip", law.backward_from
    turned = first + int(law.ways[1].piece_at(start)) if first else home
    homes = [turned if i >= first else home for i in pieces]
    references = [start if i == homes[i] or not in_slip else law.knots[i - 1 if i > homes[i] else i] for i in pieces]
    offsets = [-law.static_excess if i == home else friction(i, references[i]) - static for i in pieces]
    if first:  # the step to static friction is added last, so that the same law both ways has the same numbers
        offsets[turned] = float(law.ways[1].static_coefficient(start)) - static - law.ways[1].static_excess
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
    driver = driver_of(problem)
    count.varies, count.driven = problem.varies, driver.moves
    state.driver_rate, state.driver_push = driver.at_first(problem)
    count.is_block = not problem.body.has_waves
    count.has_inertia = problem.body.has_inertia
    count.is_algebraic = is_algebraic(problem)
    count.states, count.sticks = len(problem.contact_law.states), problem.friction.sticks
    count.given = problem.contact_law.given
    count.one_way = problem.one_way
    count.cells, count.first_side, count.joined, count.slots = INPUTS[problem.body.structure].cells(problem)
    count.reverses = sum(2**n for n in problem.friction.reverses)
    if problem.has_initial_rate or not problem.friction.sticks:
        state.rate_now = problem.rate
        count.mode = 1 if (problem.rate or problem.load) >= 0.0 else -1
        if count.mode < 0 and problem.friction.backward_from:
            count.piece = problem.friction.backward_from + int(problem.friction.ways[1].piece_at(problem.law_slip))
    for n, value in enumerate(problem.contact_states):
        state.state_now[n] = -value if count.mode < 0 and n in problem.friction.reverses else value
    count.pause_at = count.lumped_since = count.lump_above = at.NEVER
    count.folds_move = count.folds_follow_slip = problem.folds_move
    count.disc = at.NO_DISC
    count.knots_in_rate = len(problem.friction.pieces) > 1 and problem.friction.knot_variable == "rate"
    return state, count
