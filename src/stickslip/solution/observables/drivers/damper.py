"""The damper of a column: what it adds to the echo, and what it takes of the energy of its waves."""

from __future__ import annotations

import numpy as np

from stickslip.engine import Epoch, Floats, History
from stickslip.problem import inflow_of
from stickslip.problem.bodies import BodyWithWaves
from stickslip.solution.observables.driver_of_waves import BehindLayers, BehindSlab, DriverBehind, FromMachine, SumOfPower
from stickslip.solution.observables.drivers.machine import MachineBehindSlab


class FromDamper(FromMachine):
    """What a damper adds to the share that it sends back of a front, as it arrives at the contact (Pa): like an `Inflow`."""

    def __init__(self, history: History) -> None:
        problem = history.problem
        self.motion, self.delay, self.inflow = history.machine, 0.5 * problem.round_trip_time, inflow_of(problem)
        self.doubled, self.breaks = (1.0 - problem.body.reflection) * problem.body.impedance, self.inflow.breaks

    def passed(self, time: Floats) -> Floats:
        """Return what has passed the filter (Pa), as it arrives at the contact at times (s since the start of the run)."""
        return super().at(time)

    def at(self, time: Floats, seen: Floats | None = None) -> Floats:
        """Return what is added at times (s since the start of the run), with the inflow of the segments at the times `seen`."""
        return self.inflow.at(time, seen) + self.passed(time)

    def total(self, low: Floats, high: Floats) -> Floats:
        """Return its integral between times (s)."""
        return self.inflow.total(low, high) + super().total(low, high)

    def many_edges(self, low: float, high: float) -> float:
        """Return the number of times that `edges` returns, at most."""
        return super().many_edges(low, high) + self.inflow.many_edges(low, high)

    def edges(self, low: float, high: float) -> Floats:
        """Return the times (s) between two others when parts of its motion, or segments of the inflow, arrive."""
        return np.union1d(super().edges(low, high), self.inflow.edges(low, high))


class DamperBehindColumn(MachineBehindSlab):
    """A damper at the top of a column: its mass has a kinetic energy, and its dashpot turns energy into heat."""

    def __init__(self, history: History, body: BodyWithWaves) -> None:
        super().__init__(history, body)
        self.sent = FromDamper(history)
        self.adds = self.sent

    @property
    def steps(self) -> tuple[tuple[float, float], ...]:
        """The share of fronts that it sends back at all times."""
        return ((0.0, self.body.reflection),)

    def work(self, passed: SumOfPower, first: Epoch | None, last: Epoch) -> float:
        """Return the work of the far stress, net of the heat of the dashpot: that on the column, and that on the mass."""
        return passed(first, last) + super().work(passed, first, last)

    def load_at(self, leaving: Floats, time: Floats, inside: Floats) -> Floats:
        """Return the load from the share sent back, the far stress, and the motion of the mass."""
        return BehindSlab.load_at(self, leaving, time, inside) + self.sent.passed(time)


ANSWERS = DriverBehind(DamperBehindColumn, BehindLayers)
