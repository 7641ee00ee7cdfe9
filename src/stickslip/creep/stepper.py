"""When to leap over creep: at ends of round trips, from the exact engine into it, with a check where the leap lands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from stickslip.bodies import ElasticSlab
from stickslip.creep.averaged import AveragedCreep, Strength
from stickslip.creep.history_writer import Scribe, seen
from stickslip.creep.landing import Piece, landing
from stickslip.creep.pattern import Pattern, monotone_parts
from stickslip.creep.planner import Plan, Planner
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, Floats
from stickslip.engine_input.branch_table import OUT_OF_BUDGET
from stickslip.engine_input.creep_limits import PATIENCE
from stickslip.engine_input.forcing import row_time
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import NO_LEAPS

if TYPE_CHECKING:
    from stickslip.run.session import RunInProgress

SHORTEST_LEAP = 16
LONGEST_WAIT, LONGEST_FIRST_WAIT = 16, 1024
"""Round trips between two looks that found no leap: a look takes some milliseconds, as much as thousands of pieces.

A run that leaps automatically may be one that slides for ever and never creeps: until there is a first leap, looks must not take
most of its time. After it they are frequent again: where 128 round trips of the creep after a pulse are run, it ends in a storm.
"""
FAST = 1000.0
"""Slip rates beyond so many pull rates are no creep that the tolerance would let pass: not worth a closer look."""
CHECKED = 1
"""Exact round trips behind the landing, the last of which has to slip as the leap's continuation does."""
STEPS = 10_000
"""In a call of the engine."""


@dataclass
class CreepLeaps:
    """Leaps of one run, with an error of slip of at most `tolerance` times the slip since the start.

    What changes in a run stands in its counts, and is restored with them: when to look next, and how many leaps there were.
    """

    problem: Problem
    tolerance: float
    patient: bool = False
    """Leap only after PATIENCE round trips with slip, so that a run that never creeps for long stays exact."""
    taken: list[tuple[float, ...]] = field(default_factory=list)
    """What `History.creep` holds, of each leap."""

    def __post_init__(self) -> None:
        body = self.problem.body
        assert isinstance(body, ElasticSlab)
        self.impedance, self.speed = body.impedance, abs(self.problem.first_pull_rate)
        self.direction = 1 if self.problem.first_pull_rate > 0.0 else -1

    def begin(self, count: Counts) -> None:
        """Have the engine pause after the first round trip, or when creep has lasted."""
        if self.patient:
            count.creep_in, count.pause_for = PATIENCE, 1
            return
        count.pause_at = count.pause_for = 1

    def table(self, count: Counts) -> Floats:
        """The leaps so far, as in `History.creep`."""
        return np.array([*NO_LEAPS, *self.taken[: count.creep_leaps]]).reshape(-1, NO_LEAPS.shape[1])

    def take_up(self, table: Floats) -> None:
        """The leaps of a run that goes on."""
        self.taken = [tuple(leap) for leap in table.tolist()]

    def are_due(self, count: Counts, last_row: int) -> bool:
        """Whether the engine has paused for them."""
        return bool(count.ready == 0 and count.source == 0 and count.pause_at <= count.row <= last_row)

    def at_row_end(self, run: RunInProgress, last: tuple[int, float]) -> None:
        """Round trip PAUSE_AT comes next in a run up to `last`: leap if there is creep, and say when to look again."""
        count = run.count
        if not self._creeps(run):
            count.pause_at, count.pause_for = count.row + 1, 1
            return
        planner = self._planner(run, last[0] - CHECKED - 2 - int(count.row))
        plan = planner.plan()
        if planner.at_end and count.to_the_end == 0:
            run.cut_at_end()
        before = run.stands()
        while plan is not None and plan.trips >= SHORTEST_LEAP:
            if self._leap(run, planner.averaged, plan, last):
                count.pause_for = 1
                return  # and at once into the next one, if it can be
            run.restore(before)
            plan = self._planner(run, plan.trips // 2).plan()
        count.pause_at = count.row + count.pause_for
        unproven = self.patient and count.creep_leaps == 0
        count.pause_for = min(2 * count.pause_for, LONGEST_FIRST_WAIT if unproven else LONGEST_WAIT)

    # ---- before -------------------------------------------------------------------------------------------------------------

    def _previous(self, count: Counts) -> slice:
        return slice(int(count.previous_from), int(count.previous_to))

    def _creeps(self, run: RunInProgress) -> bool:
        """Whether the last round trip slipped, in the direction of the driver and slowly, just before this one."""
        rows = self._previous(run.count)
        modes, rate = run.store.mode[rows], run.store.rate[rows]
        slow = np.abs([rate[:, 0], rate.sum(axis=1)]).max() <= FAST * self.speed
        return bool(
            slow
            and run.store.row[rows][-1] == run.count.row - 1
            and (modes == self.direction).any()
            and not (modes == -self.direction).any()
        )

    def _planner(self, run: RunInProgress, most: int) -> Planner:
        """For a leap of at most so many round trips from the coming one on."""
        averaged = self._averaged(run)
        fastest = max((float(averaged.pattern.ends[1].max()) - averaged.strength(0.0)) / self.impedance, 0.0)
        return Planner(averaged, abs(float(run.state.slip_now)), self.tolerance, fastest, self._before(run), most)

    def _before(self, run: RunInProgress) -> Floats:
        """The last round trip as `AveragedCreep.swing` takes it."""
        rows, store = self._previous(run.count), run.store
        slip = np.append(store.slip[rows], run.state.slip_now)
        return np.stack([store.theta_to[rows], self.direction * (slip[1:] - slip[0])])

    def _averaged(self, run: RunInProgress) -> AveragedCreep:
        """Creep from the coming round trip on."""
        rows, store = self._previous(run.count), run.store
        load = seen(store.load[rows] - 2.0 * self.impedance * store.rate[rows], self.problem.strength, self.direction)
        load[:, 0] += 2.0 * self.impedance * self.speed
        pattern = Pattern(monotone_parts(load, store.theta_from[rows], store.speed[rows], store.bend[rows]))
        sign = self.direction if self.problem.friction.counts == "net" else 1.0
        strength = Strength(self.problem, float(run.state.law_slip), sign, self.speed * row_time(self.problem))
        return AveragedCreep(pattern, strength, self.impedance, self.speed)

    # ---- the leap -----------------------------------------------------------------------------------------------------------

    def _leap(self, run: RunInProgress, averaged: AveragedCreep, plan: Plan, last: tuple[int, float]) -> bool:
        """Leap, and run exact round trips behind it; whether they go on as the leap did."""
        begun, slip = int(run.count.row), float(run.state.slip_now)
        self._write(run, averaged, plan)
        delay = plan.error / plan.states[-1].rate * row_time(self.problem)
        self.taken[run.count.creep_leaps :] = [(begun, plan.trips, plan.error, delay)]
        run.count.creep_leaps += 1
        if not self._goes_on(run, begun + plan.trips + 1 + CHECKED, last):
            return False
        first, now = float(run.store.slip[run.count.previous_from]), float(run.state.slip_now)
        expected = averaged.reaching(plan.trips + CHECKED, *averaged.beyond(plan.states[-1], plan.trips + CHECKED)).slip
        tolerance = max(self.tolerance * (abs(slip) + expected), plan.error)
        return abs(self.direction * (0.5 * (first + now) - slip) - expected) <= tolerance

    def _write(self, run: RunInProgress, averaged: AveragedCreep, plan: Plan) -> None:
        """The leap as pieces of the history, and the engine behind it."""
        pieces = landing(averaged, plan.states[-1])
        run.reserve(run.length + len(plan.states) + len(pieces))
        count, landed_on, sign = run.count, int(run.count.row) + plan.trips, averaged.strength.sign
        scribe = Scribe(run.store, self.problem, row_time(self.problem), self.direction, sign, run.state, count)
        landed_from = scribe.write_way(run.length, landed_on - plan.trips, averaged, plan, pieces[0].slip)
        scribe.write_landing(landed_from, landed_on, pieces)
        self._move(run, pieces[-1], sign)
        count.length = landed_from + len(pieces)
        count.previous_from, count.previous_to, count.row_from = landed_from, count.length, count.length
        count.row, count.pause_at = landed_on + 1, landed_on + 1 + CHECKED

    def _move(self, run: RunInProgress, end: Piece, sign: float) -> None:
        """The contact at the end of the last piece of a landing."""
        state, count, grown = run.state, run.count, end.slip + end.grown
        state.slip_now += self.direction * grown
        state.law_slip += sign * grown
        state.rate_now = self.direction * end.rate.sum()
        count.mode = self.direction if end.slips else 0
        count.source = count.moved = count.stuck_rows = count.edge = count.jump = count.cause = count.stalled = 0

    def _goes_on(self, run: RunInProgress, row: int, last: tuple[int, float]) -> bool:
        """Run exact round trips up to this one; False where something else comes: rest that is leapt over, a failure."""
        while (code := run.step(last, STEPS)) in (OUT_OF_BUDGET, at.FULL):
            if code == at.FULL:
                run.reserve(2 * len(run.store.whole))
        return code == at.PAUSED and run.count.row == row
