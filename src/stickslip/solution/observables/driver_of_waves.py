"""What a driver does to the waves that come to it, behind a uniform body or behind layers, and to their energy.

A passive driver sends back a share of each wave and adds what it is loaded with, so that the waves know its work. One that is a
machine has a motion of its own, which knows more.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np

from stickslip.engine import Epoch, Floats, History, Integers
from stickslip.foundation.by_kind import ByKind
from stickslip.foundation.constants import RIGID
from stickslip.problem import DRIVERS_OF_WAVES, Inflow, Problem, inflow_of
from stickslip.problem.bodies import BodyWithWaves, OfLayers
from stickslip.solution.observables.given_load import sent_at, share_at

SumOfPower = Callable[[Epoch | None, Epoch], float]
"""The sum of a power of waves at the driver between two moments, or since the start (J/m^2)."""


def fronts_at_driver(history: History) -> Floats:
    """Return the times (s since the epoch) when the ends of recorded pieces are at the driver, in the run, and the run's ends.

    In layers these are the fronts that come straight from the contact.
    """
    begin, end = history.span
    fronts = history.breaks + history.problem.body.time_to_driver
    return np.concatenate([[begin], fronts[(fronts > begin) & (fronts < end)], [end]])


class FromMachine:
    """What a driver that is a machine adds to the echo, 2 Z Vd, as it arrives at the contact (Pa): in the form of an `Inflow`."""

    def __init__(self, history: History) -> None:
        problem = history.problem
        self.motion, self.doubled, self.delay = history.machine, 2.0 * problem.body.impedance, 0.5 * problem.round_trip_time
        self.breaks = inflow_of(problem).breaks

    def at(self, time: Floats, _: Floats | None = None) -> Floats:
        """Return it at times (s since the start of the run)."""
        return np.asarray(self.doubled * self.motion.at(time - self.delay))

    def total(self, low: Floats, high: Floats) -> Floats:
        """Return its integral between times (s)."""
        return np.asarray(self.doubled * self.motion.way(low - self.delay, high - self.delay))

    def many_edges(self, low: float, high: float) -> float:
        """Return the number of times that `edges` returns, at most."""
        return float(len(self.motion.start))

    def edges(self, low: float, high: float) -> Floats:
        """Return the times (s) between two others when parts of its motion arrive."""
        start = self.motion.start + self.delay
        return np.asarray(start[(start > low) & (start < high)])


class BehindSlab:
    """A driver behind a uniform body; here a passive one of finite impedance. Times are in s since the start of the run."""

    by_storing = False
    """True if its work over round trips at rest is found from what the slab stores."""
    adds: Inflow | FromMachine
    """What it adds to the echo."""

    def __init__(self, history: History, body: BodyWithWaves) -> None:
        self.history, self.problem, self.body = history, history.problem, body
        self.adds = inflow_of(self.problem)

    @property
    def steps(self) -> tuple[tuple[float, float], ...]:
        """The times from which it sends back a share of the waves that come to it, the first 0, and these shares."""
        return self.problem.driver_steps

    def share_at(self, time: Floats) -> Floats:
        """Return the share (1) of a wave that it has sent back of what arrives at the contact at times."""
        return inflow_of(self.problem).reflection_at(time)

    def impedance_at(self, time: Floats) -> Floats | float:
        """Return its impedance (Pa s/m) when it sent what arrives at the contact at times; 0 for one that is rigid."""
        return self.body.driver_impedance

    def shears_at(self, time: float) -> float:
        """Return the rate (m/s) at which it shears the slab in the state without waves: its pull rate while it is rigid, else 0."""
        trip = self.body.two_way_time
        rigid = self.share_at(np.array(time - 0.5 * trip) + trip) == RIGID
        return float(self.problem.pull_rate_at(time)) if rigid else 0.0

    def kinetic(self, time: float) -> float:
        """Return its kinetic energy (J/m^2)."""
        return 0.0

    def work(self, passed: SumOfPower, first: Epoch | None, last: Epoch) -> float:
        """Return its work between two moments, or since the start (J/m^2), net of what is radiated: the sum of its power."""
        return passed(first, last)

    def radiated(self, passed: SumOfPower, first: Epoch | None, last: Epoch) -> float:
        """Return what is radiated through it between two moments, or since the start (J/m^2): the sum of that power."""
        return passed(first, last)

    def load_at(self, leaving: Floats, time: Floats, inside: Floats) -> Floats:
        """Return the load minus the reference strength (Pa) of waves that left one round trip before times, found again.

        What holds at a time is what holds at one `inside` its piece.
        """
        delay = 0.5 * self.problem.round_trip_time
        return share_at(self.problem, inside - delay) * leaving + sent_at(self.problem, time - delay, inside - delay)


class BehindLayers:
    """The first driver behind a body of layers; here one that is passive. Times are in s since the start of the run."""

    gain = 0.0
    """The proportional gain of a machine (Pa s/m)."""

    def __init__(self, history: History, body: OfLayers) -> None:
        self.history, self.problem, self.body, self.round = history, history.problem, body, body.round_trip_time

    def share_at(self, time: Floats) -> Floats:
        """Return the share (1) of a wave that it sends back at times, counted where waves are followed."""
        return inflow_of(self.problem).reflection_at(time)

    @cached_property
    def turned(self) -> tuple[Integers, Floats, Floats]:
        """Its changes in order: round trips and phases (s) of its new waves, and the share before less that after."""
        inflow = inflow_of(self.problem)
        trips, phases = np.array(inflow.breaks()).reshape(-1, 2).T
        by = -np.diff(inflow.reflection, prepend=inflow.reflection[0])
        changes = by != 0.0
        return trips[changes].astype(np.int64), phases[changes], by[changes]

    def sent(self, trip: Integers, phase: Floats, loaded: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
        """Return what it sends beside the echo (Pa), and the integral of that in the round trip (Pa s): what it is loaded with."""
        return loaded

    def ramp(self, trip: Integers) -> Floats:
        """Return the growth of the load (Pa) in a round trip of a settled rest, under the loading of round trips."""
        return np.full(len(trip), self.history.ramp)

    def shears_at(self, time: float) -> float:
        """Return the rate (m/s) at which it shears the body in the state without waves: 0 unless all drivers are rigid."""
        rigid = self.body.is_driven_rigidly & (self.share_at(np.array(time + self.body.inflow_delay)) == RIGID)
        return float(self.problem.pull_rate_at(time)) if rigid else 0.0

    def kinetic(self, now: Epoch) -> float:
        """Return its kinetic energy (J/m^2)."""
        return 0.0

    def missed(self, last: Floats, trip: Integers, phase: Floats) -> Floats:
        """Return by how much (Pa) it misses an equation of motion, `last` being the wave in the last cell: there is none."""
        return np.zeros(len(last))


class DriverBehind(NamedTuple):
    """What a kind of driver is behind each kind of body with waves."""

    a_slab: type[BehindSlab]
    layers: type[BehindLayers]
    """The first driver behind layers."""


BEHIND: ByKind[DriverBehind] = ByKind("stickslip.solution.observables.drivers", DRIVERS_OF_WAVES)


def driver_behind(problem: Problem) -> DriverBehind:
    """Return the answers of the kind of driver of a problem."""
    return BEHIND[problem.driver_kind]
