"""Leap over creep: at ends of round trips, from the exact engine into it, with a check where the leap lands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stickslip.engine.creep.averaged import AveragedCreep, Strength
from stickslip.engine.creep.creep_landing import CreepLanding
from stickslip.engine.creep.landing import SHORTEST_LEAP, Landing, LookedFor, seen
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.pattern import Pattern, monotone_parts
from stickslip.engine.creep.planner import Planner
from stickslip.engine.creep.slow_landing import SlowLanding
from stickslip.engine.creep.slow_leaps import SlowLeaps
from stickslip.engine.creep.steady import STEADY_LEAPS, stable_states
from stickslip.engine.creep.swing_landing import SwingLanding
from stickslip.engine.creep.swing_leaps import SwingLeaps
from stickslip.engine.state.layout import NEVER, Counts, Floats
from stickslip.problem import Problem, Stop, leaps_over

LONGEST_WAIT, LONGEST_FIRST_WAIT = 16, 1024
"""Largest number of round trips between two attempts that found no leap: an attempt takes some milliseconds, as much as thousands
of pieces.

A run that leaps automatically may slide for ever and never creep, so attempts must not take most of its time until there is a
first leap. After that they are frequent again: if 128 round trips of the creep after a pulse are computed exactly, the run ends
in an event storm.
"""
LONGEST_SPENT = 4096
"""Largest number of round trips that are waited for because a search for a leap took as long as they do."""
FAST = 1000.0
"""A leap is attempted up to this slip rate, as a multiple of the pull rate: no tolerance would accept a faster creep."""
TRIPS_CHECKED = 1
"""Number of exact round trips after the landing; the last of them has to slip as the continued leap predicts."""
STEPS_OF_CALL = 10_000
"""Number of steps in one call of the engine."""


@dataclass
class LeapStepper:
    """The leaps of one run from the ends of its round trips, which `schedule.CreepLeaps` hands on when the engine has paused."""

    problem: Problem
    tolerance: float
    patient: bool
    taken: list[tuple[float, ...]]
    """The rows of `History.creep`, one for each leap: those of `CreepLeaps`, which also restores and shows them."""

    def __post_init__(self) -> None:
        self.impedance, self.speed = self.problem.body.impedance, abs(self.problem.first_pull_rate)
        self.direction = 1 if self.problem.first_pull_rate > 0.0 else -1
        self.over = leaps_over(self.problem)

    def at_row_end(self, run: LeapingRun) -> None:
        """Leap if there is creep, and set when to try again.

        The run is at the end of a round trip; round trip `pause_at` comes next.
        """
        count = run.count
        if self.over != "creep":
            self._leap_while_sliding(run)
            return
        if not self._creeps(run):
            count.pause_at, count.pause_for = count.trip + 1, 1
            return
        planner = self._planner(run, run.last[0] - TRIPS_CHECKED - 2 - int(count.trip))
        plan = planner.plan()
        if planner.at_end and count.to_the_end == 0:
            run.cut_at_end()
        while plan is not None and plan.trips >= SHORTEST_LEAP:
            if self._lands(run, CreepLanding(self.problem, planner.averaged, plan, float(run.state.slip_now))):
                count.pause_for = 1
                return  # the next leap may follow at once
            planner = self._planner(run, plan.trips // 2)
            plan = planner.plan()
        count.pause_at = count.trip + count.pause_for
        unproven = self.patient and count.creep_leaps == 0
        count.pause_for = min(2 * count.pause_for, LONGEST_FIRST_WAIT if unproven else LONGEST_WAIT)

    def _leap_while_sliding(self, run: LeapingRun) -> None:
        """Leap if the contact slides steadily or slowly, and set after how many round trips with slip to look again.

        The engine does not pause meanwhile, so that it may pass over echoes under which nothing slips.
        """
        count = run.count
        found, at_end, cost = self._look(run, int(run.last[0] - TRIPS_CHECKED - 2 - count.trip))
        if at_end and count.to_the_end == 0:
            run.cut_at_end()
        lands = found is not None and self._lands(run, found)
        count.pause_at, count.creep_in = NEVER, count.pause_for
        spent = min(cost, LONGEST_SPENT) - (found.trips if found is not None and lands else 0)
        again = LONGEST_WAIT if self.over == "swinging creep" and count.creep_leaps else LONGEST_FIRST_WAIT
        count.pause_for = max(1 if lands else min(2 * count.pause_for, again), spent)

    def _look(self, run: LeapingRun, most: int) -> LookedFor:
        """Look for a leap over at most so many round trips of what may be leaped over."""
        if self.over == "swinging creep":
            swings = SwingLeaps(self.problem, self.tolerance)
            swing = swings.leap(run, most)
            return LookedFor(None if swing is None else SwingLanding(swing), swings.at_end)
        stable = stable_states(self.problem) if self.over == "slow sliding" else None
        settles = most >= SHORTEST_LEAP and (self.over == "steady sliding" or stable is not None)
        steady = STEADY_LEAPS[self.problem.driver_kind].look(run, most, self.tolerance) if settles else LookedFor(None)
        if steady.landing is not None or self.over == "steady sliding":
            return steady
        leaps = SlowLeaps(self.problem, self.tolerance, stable)
        slow = leaps.leap(run, most)
        return LookedFor(None if slow is None else SlowLanding(slow), leaps.at_end, leaps.cost)

    def _lands(self, run: LeapingRun, found: Landing) -> bool:
        """Leap, compute exact round trips after the landing, and return True if they continue as the leap predicts."""
        count = run.count
        before, begun = run.snapshot(), int(count.trip)
        found.write(run)
        self.taken[count.creep_leaps :] = [(begun, found.trips, *found.errors)]
        count.creep_leaps += 1
        landed, slip = int(count.trip), float(run.state.slip_now)
        count.pause_at = landed + TRIPS_CHECKED
        if self._goes_on(run, landed + TRIPS_CHECKED, may_rest=found.may_rest):
            expected, allowed = found.expected(run, slip, int(count.trip) - landed, self.tolerance)
            if abs(float(run.state.slip_now) - expected) <= allowed:
                return True
        run.restore(before)
        return False

    def _goes_on(self, run: LeapingRun, row: int, *, may_rest: bool) -> bool:
        """Compute exact round trips up to a row; return False if a failure comes first, or a rest that is leaped over."""
        while (code := run.step(STEPS_OF_CALL)) in (Stop.NONE, Stop.FULL):
            if code == Stop.FULL:
                run.reserve(2 * len(run.store.pieces))
        return code == Stop.PAUSED and (run.count.trip == row or may_rest)

    # ---- before -------------------------------------------------------------------------------------------------------------

    def _previous(self, count: Counts) -> slice:
        return slice(int(count.previous_from), int(count.previous_to))

    def _creeps(self, run: LeapingRun) -> bool:
        """Return True if the last round trip came just before this one and slipped slowly, in the direction of the driver only."""
        rows = self._previous(run.count)
        modes, rate = run.store.mode[rows], run.store.rate[rows]
        slow = np.abs([rate[:, 0], rate.sum(axis=1)]).max() <= FAST * self.speed
        return bool(
            slow
            and run.store.trip[rows][-1] == run.count.trip - 1
            and (modes == self.direction).any()
            and not (modes == -self.direction).any()
        )

    def _planner(self, run: LeapingRun, most: int) -> Planner:
        """Return the planner of a leap of at most the given number of round trips from the coming one on."""
        averaged = self._averaged(run)
        fastest = max((float(averaged.pattern.ends[1].max()) - averaged.strength(0.0)) / self.impedance, 0.0)
        return Planner(averaged, abs(float(run.state.slip_now)), self.tolerance, fastest, self._before(run), most)

    def _before(self, run: LeapingRun) -> Floats:
        """Return the last round trip in the form that `AveragedCreep.swing` takes."""
        rows, store = self._previous(run.count), run.store
        slip = np.append(store.slip[rows], run.state.slip_now)
        return np.stack([store.phase_to[rows], self.direction * (slip[1:] - slip[0])])

    def _averaged(self, run: LeapingRun) -> AveragedCreep:
        """Return the averaged creep from the coming round trip on."""
        rows, store = run.standing(), run.store
        load = seen(store.load[rows] - 2.0 * self.impedance * store.rate[rows], self.problem.strength, self.direction)
        load[:, 0] += 2.0 * self.impedance * self.speed * (int(run.count.trip) - store.trip[rows])
        pattern = Pattern(monotone_parts(load, store.phase_from[rows], store.speed[rows], store.bend[rows]))
        sign = self.direction if self.problem.friction.counts == "net" else 1.0
        strength = Strength(self.problem, float(run.state.law_slip), sign, self.speed * self.problem.round_trip_time)
        return AveragedCreep(pattern, strength, self.impedance, self.speed)
