"""When to leap over creep: at ends of round trips, from the exact engine into it, with a check where the leap lands."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.evolution import layout as at
from stickslip.evolution.creep.averaged import AveragedCreep, Strength
from stickslip.evolution.creep.landing import landing
from stickslip.evolution.creep.pattern import Pattern, monotone_parts
from stickslip.evolution.creep.plan import Plan, Planner
from stickslip.evolution.creep.scribe import Scribe, seen
from stickslip.evolution.layout import Floats, Integers, Store
from stickslip.problem import Problem

SHORTEST_LEAP = 16
LONGEST_WAIT = 16
FAST = 1000.0
"""Slip rates beyond so many pull rates are no creep that the tolerance would let pass: not worth a closer look."""
CHECKED = 2
"""Exact round trips after the landing, whose slip has to be that of the leap's continuation."""
FOREVER = 2**62


def refusal(problem: Problem) -> str | None:
    """Why there are no leaps over creep in a problem; None if there may be."""
    body, law = problem.body, problem.friction
    if not isinstance(body, ElasticSlab) or body.reflection != -1.0 or body.contact_mass > 0.0:
        return "a slab with a rigid driver and without contact mass"
    if law.state is not None or law.depends_on_rate or law.memory != "all":
        return "a law of slip alone that remembers all of it"
    return None if problem.pull_rate != 0.0 else "a pull rate that is not 0"


@dataclass(frozen=True)
class Landed:
    """A leap that waits for its check: what to go back to, and what is expected."""

    state: Floats
    count: Integers
    slip: float  # where the leap began, minus the initial slip, m
    expected: float  # mean slip of the last checked round trip, m
    tolerance: float
    summary: tuple[float, float, float, float]
    most: int


@dataclass
class CreepLeaps:
    """Leaps of one run, with an error of slip of at most `tolerance` times the slip since the start."""

    problem: Problem
    row_time: float
    tolerance: float
    taken: list[tuple[float, float, float, float]] = field(default_factory=list)
    """Start and end (s), round trips, bound of the error of slip (m)."""
    landed: Landed | None = None
    wait: int = 1

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance <= 1e-2:
            raise InputError(f"simulate: creep_rtol must be 0 (no leaps over creep) or between 0 and 1e-2, got {self.tolerance!r}")
        if (needed := refusal(self.problem)) is not None:
            raise InputError(f"simulate: creep_rtol: leaps over creep need {needed}")
        body = self.problem.body
        assert isinstance(body, ElasticSlab)
        self.impedance, self.direction = body.impedance, 1 if self.problem.pull_rate > 0.0 else -1

    @property
    def table(self) -> Floats:
        """The leaps, (n, 4): start and end (s), round trips, bound of the error of slip (m)."""
        unchecked = [self.landed.summary] if self.landed is not None else []
        return np.array(self.taken + unchecked).reshape(-1, 4)

    def at_row_end(self, store: Store, state: Floats, count: Integers, last_row: int) -> Store:
        """A round trip has ended: check the last leap, or leap if one is due. Returns the history, which may have grown."""
        most = last_row - CHECKED - 1 - int(count[at.ROW])
        if self.landed is not None:
            most = min(most, self._check(store, state, count))
        count[at.PAUSE_AT] = count[at.ROW] + 1
        if most < SHORTEST_LEAP or not self._creeps(store, count):
            self.wait = 1
            return store
        count[at.PAUSE_AT] = count[at.ROW] + self.wait
        self.wait = min(2 * self.wait, LONGEST_WAIT)
        averaged = self._averaged(store, state, count)
        rate = max((float(averaged.pattern.ends[1].max()) - averaged.strength(0.0)) / self.impedance, 0.0)
        planner = Planner(averaged, abs(float(state[at.SLIP_NOW])), self.tolerance, rate)
        plan = planner.plan(most)
        if plan is None or plan.trips < SHORTEST_LEAP:
            return store
        return self._leap(store, state, count, averaged, plan)

    # ---- before -------------------------------------------------------------------------------------------------------------

    def _previous(self, count: Integers) -> slice:
        return slice(int(count[at.PREVIOUS_FROM]), int(count[at.PREVIOUS_TO]))

    def _creeps(self, store: Store, count: Integers) -> bool:
        """Whether the last round trip slipped, in the direction of the driver and slowly, just before this one."""
        rows = self._previous(count)
        modes, ends = store.mode[rows], np.stack([store.rate[rows, 0], store.rate[rows].sum(axis=1)])
        slow = np.abs(ends).max() <= FAST * abs(self.problem.pull_rate)
        return bool(slow and count[at.LEAP] == 0 and (modes == self.direction).any() and not (modes == -self.direction).any())

    def _averaged(self, store: Store, state: Floats, count: Integers) -> AveragedCreep:
        """Creep from the coming round trip on."""
        rows = self._previous(count)
        load = seen(store.load[rows] - 2.0 * self.impedance * store.rate[rows], self.problem.strength, self.direction)
        speed = abs(self.problem.pull_rate)
        load[:, 0] += 2.0 * self.impedance * speed
        pattern = Pattern(monotone_parts(load, store.theta_from[rows], store.speed[rows], store.bend[rows]))
        sign = self.direction if self.problem.friction.counts == "net" else 1.0
        strength = Strength(self.problem, float(state[at.LAW_SLIP]), sign, speed * self.row_time)
        return AveragedCreep(pattern, strength, self.impedance, speed)

    # ---- the leap -----------------------------------------------------------------------------------------------------------

    def _leap(self, store: Store, state: Floats, count: Integers, averaged: AveragedCreep, plan: Plan) -> Store:
        begin, before = int(count[at.ROW]), (state.copy(), count.copy())
        pieces = landing(averaged, plan.states[-1])
        length, added = int(count[at.LENGTH]), len(plan.states) + len(pieces)
        if length + added > len(store.whole):
            store = at.resized(store, length, 2 * (length + added))
        row, end, sign = begin + plan.trips, pieces[-1], averaged.strength.sign
        scribe = Scribe(store, self.problem, self.row_time, self.direction, sign, *before)
        landed_from = scribe.write_way(length, begin, averaged, plan, pieces[0].slip)
        scribe.write_landing(landed_from, row, pieces)
        beyond = averaged.reaching(plan.trips + CHECKED - 1.0, *self._lifts(averaged, plan))
        slip = float(state[at.SLIP_NOW])
        summary = begin * self.row_time, row * self.row_time, float(plan.trips), plan.error
        tolerance = max(self.tolerance * (abs(slip) + beyond.slip), plan.error)
        self.landed = Landed(*before, slip, beyond.slip, tolerance, summary, plan.trips // 2)
        grown = end.slip + end.grown
        state[at.SLIP_NOW] += self.direction * grown
        state[at.LAW_SLIP] += sign * grown
        state[at.RATE_NOW] = self.direction * end.rate.sum()
        count[at.MODE], count[at.LENGTH] = self.direction if end.slips else 0, landed_from + len(pieces)
        count[at.PREVIOUS_FROM], count[[at.PREVIOUS_TO, at.ROW_FROM]] = landed_from, count[at.LENGTH]
        count[at.ROW], count[at.PAUSE_AT] = row + 1, row + CHECKED
        count[[at.SOURCE, at.MOVED, at.LEAP, at.STUCK_ROWS, at.EDGE, at.JUMP, at.CAUSE, at.STALLED]] = 0
        return store

    def _lifts(self, averaged: AveragedCreep, plan: Plan) -> tuple[float, float]:
        """Lifts between which the checked round trips lie."""
        low = plan.states[-1].lift
        high = low + CHECKED * averaged.gain
        while averaged.at(high).room > 0.0 and averaged.at(high).trips < plan.trips + CHECKED - 1.0:
            high += averaged.gain
        return low, high

    # ---- behind -------------------------------------------------------------------------------------------------------------

    def _check(self, store: Store, state: Floats, count: Integers) -> int:
        """Whether exact round trips go on as the leap did; if not, take it back. Returns the longest leap allowed next."""
        landed, self.landed = self.landed, None
        assert landed is not None
        first, last = float(store.slip[count[at.PREVIOUS_FROM]]), float(state[at.SLIP_NOW])
        mean = self.direction * (0.5 * (first + last) - landed.slip)
        if abs(mean - landed.expected) <= landed.tolerance:
            self.taken.append(landed.summary)
            self.wait = 1
            return FOREVER
        state[:], count[:] = landed.state, landed.count
        return landed.most
