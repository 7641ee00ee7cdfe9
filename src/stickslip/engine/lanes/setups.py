"""The input of the engine for many members at once: the counterpart of `engine.input.prepare` with one row for each member."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from stickslip.contact import FASTEST_BOUNDED, Pieces, find_turns, folds_of, levels
from stickslip.engine.compiled_formula import compile_formula, keep_with
from stickslip.engine.input.asked import INPUTS
from stickslip.engine.input.branch_table import is_algebraic, table_of_branches
from stickslip.engine.input.first_pieces import together
from stickslip.engine.input.limits import set_lumping, wait_for_creep
from stickslip.engine.input.prepare import (
    functions_of,
    parameters_of,
    references_of,
    set_references,
    set_tolerance,
    start_of,
)
from stickslip.engine.lanes.branch_search import MOST_BRANCHES, NEVER_RISES, TOO_MANY, FoundBranches, Resistances, search_branches
from stickslip.engine.lanes.runs import fill_constants
from stickslip.engine.lanes.vectorised_problem import Values, member, vectorised_problem
from stickslip.engine.lanes.workspace import Setups
from stickslip.engine.state.layout import BranchRow, Counts, Floats, Integers, LawPiece, Params, State
from stickslip.foundation.arrays import shared
from stickslip.foundation.quantities import quantities_of
from stickslip.friction import FrictionLaw
from stickslip.friction.formula import bends_one_way
from stickslip.problem import Problem, default_event_rate
from stickslip.problem.scenarios import Scenario

PARTS_OF_FOLD = 4
"""Parts into which the interval of a fold is cut: few, because many folds are found together."""
MOST_TURNS = 64
"""Largest number of turns of g, or of undecided intervals, that are distinguished."""
FAST_FOLD = 1e9
"""Slip rates beyond this multiple of the contact's own scale S (variation of mu)/Z do not matter, as in `contact.equation`."""


class Alike(NamedTuple):
    """The properties that the members of a group share, whatever their numbers."""

    problem: Problem  # the problem of one of the members
    functions: Integers  # table of LawPiece with only the functions set
    jets: Integers  # as in `Setups`
    prepare: Integers  # (pieces,): addresses of the functions that fill the constants of each piece
    size: int  # room for constants in each piece
    state: State  # at t = 0
    counts: Counts


def alike(scenario: Scenario, values: Values) -> Alike:
    """Return what the members of one group (`vectorised_problem.groups`) share. Compiles the law's formulas if they are new."""
    problem = member(scenario, {key: float(value[0]) for key, value in values.items()}).problem
    law = problem.friction
    compiled = [compile_formula(tree, law.parameters(), law.state_trees()) for tree in law.trees()]
    functions = functions_of(compiled, problem)
    in_lanes = [] if steps_alone(problem) else compiled
    parts = "motion_jets" if problem.body.has_inertia else "rate_jets", "radii_in_lanes", "values_in_lanes"
    jets = np.array([formula.address(part) for formula in in_lanes for part in parts], np.int64)
    prepare = np.array([formula.address("prepare") for formula in compiled], np.int64)
    state, counts = start_of(problem)
    set_lumping(counts, problem, scenario.shortest_event)
    wait_for_creep(counts, problem, scenario.creep_rtol)
    return Alike(problem, functions, jets, prepare, max(formula.size for formula in compiled), state, counts)


def set_up(scenario: Scenario, values: Values, group: Alike | None = None) -> Setups:
    """Return the input of the engine for the members of one group (`vectorised_problem.groups`).

    `group` is what the members share, if that is known already.
    """
    count, group = len(next(iter(values.values()))), group or alike(scenario, values)
    problem = vectorised_problem(scenario, values)
    duration, params = spread(values.get("run.duration", scenario.duration), count), parameters_of(problem)
    last_trip, last_phase = split_times(duration, spread(params.round_trip_time, count))
    constants, law = formulas(problem, group)
    branch_table, branches, irregular, stick_to = branches_of(problem, group, constants, count)
    rtol = values.get("run.rtol", scenario.rtol)
    if params.numbers.ndim == 1 and (np.ndim(rtol) or stick_to.any()):
        params = Params(spread(params.numbers[:, None], count))
    set_tolerance(params, rtol, scenario.shortest_event)
    if params.numbers.ndim > 1:
        params.numbers[Params.places["stick_to"].first] = stick_to
    return Setups(
        params=rows(params.numbers),
        jets=group.jets,
        constants=constants,
        law=law,
        branch_table=branch_table,
        first_load=for_each(INPUTS[problem.body.structure].first_load(problem), 2),
        branches=branches,
        irregular=irregular,
        state=group.state.numbers,
        counts=group.counts.numbers,
        last_trip=last_trip,
        last_phase=last_phase,
        duration=duration,
        threshold=spread(default_event_rate(problem), count),
        stiffness=spread(problem.body.stiffness, count),
        excess=spread(problem.excess, count),
    )


def rows(numbers: Floats) -> Floats:
    """Return numbers, which have a column for each member if these differ, with a row for each; or with a single row."""
    return for_each(numbers.T, 1)


def for_each(table: Floats, axes: int) -> Floats:
    """Return a table with a first axis of members; it has only the given number of other axes if the members do not differ."""
    return np.ascontiguousarray(table if table.ndim > axes else table[None])


def spread(numbers: Any, count: int) -> Floats:
    """Return numbers with one value for each member along the last axis, repeated if all members have the same."""
    found = np.asarray(numbers, float)
    return np.array(np.broadcast_to(found, (*found.shape[: max(found.ndim - 1, 0)], count)), order="C")


def split_times(time: Floats, round_trip: Floats) -> tuple[Integers, Floats]:
    """Split times (s) into whole round trips and an offset in (0, round_trip], as `limits.split_time` does for one time."""
    whole = np.floor(time / round_trip)
    offset = time - whole * round_trip
    back = (offset <= 0.0) & (whole > 0)
    return (whole - back).astype(np.int64), np.where(back, round_trip, np.minimum(offset, round_trip))


# ---- the law ----------------------------------------------------------------------------------------------------------------


def formulas(problem: Problem, group: Alike) -> tuple[Floats, Integers]:
    """Return the constants of the law's functions and the pieces of the law, as `engine.input.prepare.law_tables` does.

    Both have a first axis of members, of length 1 if these do not differ.
    """
    law, home, pieces = problem.friction, int(group.counts.piece), len(group.prepare)
    static = shared(law.pieces[home](law, problem.law_slip, 0.0) + law.static_excess)
    references, own = references_of(problem, home, static, lambda i, slip: shared(law.pieces[i](law, slip, 0.0)))
    law_pieces = np.array(np.broadcast_to(group.functions, (len(rows(own)), *group.functions.shape)), order="C")
    keep_with(law_pieces, [group.functions])
    set_references(law_pieces, own)
    numbers = rows(together([*(getattr(law, name) for name in law.parameters()), *references]))
    constants = np.zeros((len(numbers), pieces, group.size))
    fill_constants(group.prepare, numbers, constants)
    return constants, law_pieces


def steps_alone(problem: Problem) -> bool:
    """Return True if steps cannot be taken in lanes: the rate is a root of the contact equation, or the law has knots in it."""
    return is_algebraic(problem) or (len(problem.friction.knots) > 0 and problem.friction.knot_variable == "rate")


# ---- the contact equation ---------------------------------------------------------------------------------------------------


def branches_of(problem: Problem, group: Alike, constants: Floats, count: int) -> tuple[Floats, Integers, Floats, Floats]:
    """Return the branches of each member's resistance g(v) = Z v + S mu(v), and what follows from them.

    The results are `Setups.branch_table`, the number of branches, 1 for members for which some load has several solutions,
    and the load minus strength (Pa) at which stick ends.
    """
    branches, one = np.ones(count, np.int64), group.problem
    if group.counts.is_algebraic == 0:
        return table_of_branches(one, 0.0)[0][None], branches, np.zeros(count), np.zeros(count)
    law, body = problem.friction, problem.body
    own = problem.normal * law.variation / body.damping
    slowest, fastest = scales(law, spread(own, count), count)
    damping, normal, start = (spread(x, count) for x in (body.damping, problem.normal, -problem.normal * law.static_excess))
    tree, values = one.friction.trees()[0], [getattr(law, name) for name in law.parameters()]
    *ends, slips = [(np.min(value), np.max(value)) for value in (*values, problem.law_slip)]
    one_way = not law.knots and bends_one_way(tree, dict(zip(law.parameters(), ends, strict=True)), slips)
    edges = np.empty((0, 0))
    if not one_way:
        numbers = {name: spread(value, count) for name, value in zip(law.parameters(), values, strict=True)}
        members, slip = np.arange(count), spread(problem.law_slip, count)
        ends_of_search = np.zeros(count), np.full(count, FASTEST_BOUNDED)
        of = Pieces((tree,), 0 * members, members, numbers, slip, damping, normal, slowest, fastest, *ends_of_search)
        branches, edges = ends_of_branches(of)
    found = FoundBranches(BranchRow.table(count, 1 if one_way else MOST_BRANCHES), branches, np.empty(count))
    address = int(LawPiece(group.functions[0]).value_at)
    search_branches(Resistances(address, constants, damping, normal, start, slowest, fastest), edges, np.empty(4), found)
    table = BranchRow.of(found.table)
    exists = np.arange(found.table.shape[1]) < branches[:, None]
    start, end = np.where(exists, table.excess_from, np.inf), np.where(exists, table.excess_to, -np.inf)
    stick_to, table.keep_from[...], table.keep_to[...] = levels(one.rule, start, end)
    return *found, stick_to


def ends_of_branches(of: Pieces) -> tuple[Integers, Floats]:
    """Return the number of branches of each member, NEVER_RISES or TOO_MANY, and the slip rates (m/s) of their ends."""
    found = find_turns(of, most=MOST_TURNS)
    rates, member = folds_of(of, found, PARTS_OF_FOLD)
    count = np.bincount(member, minlength=len(of.slip))
    rises = count % 2 == 0
    branches = (count + rises + 1) // 2
    branches[(branches > MOST_BRANCHES) | (np.bincount(found.cells.piece, minlength=len(count)) > MOST_TURNS)] = TOO_MANY
    branches[(branches != TOO_MANY) & (found.at_end < 0)] = NEVER_RISES
    ends = np.full((len(count), 2 * MOST_BRANCHES), np.inf)
    ends[rises, 0] = 0.0
    place = np.arange(len(member)) - np.searchsorted(member, member) + rises[member]
    fits = place < ends.shape[1]
    ends[member[fits], place[fits]] = rates[fits]
    return branches, ends


def scales(law: FrictionLaw, own: Floats, count: int) -> tuple[Floats, Floats]:
    """Return the slowest and the fastest of the slip rates `Resistance.scales` (m/s) of each member.

    `own` is the contact's own scale S (variation of mu)/Z, m/s.
    """
    rates = {name: declared.unit for name, declared in quantities_of(type(law)).items() if declared.unit in ("m/s", "s/m")}
    with np.errstate(divide="ignore", invalid="ignore"):  # friction of a member that does not vary has no scale
        sizes = [np.abs(getattr(law, name)) if unit == "m/s" else 1.0 / np.abs(getattr(law, name)) for name, unit in rates.items()]
        found = np.stack([own, *(spread(size, count) for size in sizes)])
        counts = (
            (found > 0.0) & np.isfinite(found) & (found <= np.where(np.arange(len(found)) == 0, np.inf, FAST_FOLD)[:, None] * own)
        )
    none = ~counts.any(axis=0)
    lowest, highest = (np.where(counts, found, fill) for fill in (np.inf, -np.inf))
    return np.where(none, 1.0, lowest.min(axis=0)), np.where(none, 1.0, highest.max(axis=0))
