"""What every kind of driver answers: how it reflects waves, what it adds to the load, and how the load grows at rest."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.drivers.impedance import DriverImpedance
from stickslip.problem.drivers.segments import arriving
from stickslip.problem.fields import ProblemFields
from stickslip.problem.inflow import Inflow
from stickslip.problem.kinds import DRIVER_KINDS
from stickslip.problem.loading_history import SILENT, Tone
from stickslip.problem.problem import Problem


def wave_before(problem: Problem) -> Any:
    """Return the wave beta - 2 Z v, minus the reference strength (Pa), that leaves the contact of a slab just before the start."""
    return problem.excess - 2.0 * problem.body.impedance * problem.rate


def far_excess(problem: Problem) -> Any:
    """Return the default far stress, that in the slab at the start, minus the reference strength (Pa)."""
    return problem.excess - problem.body.impedance * problem.rate


def far_at_first(problem: Problem) -> Any:
    """Return the stress behind the last layer, or behind a slab, at the start, minus the reference strength (Pa)."""
    body = problem.body
    return body.first_share * far_excess(problem) + body.held_at_start(problem.rate, problem.initial_shear)[0]


class Driver(ABC):
    """The questions to a driver, whose numbers are those of a problem and of its body. Units are those of `Body`."""

    moves: ClassVar[bool] = False
    """True if it has a motion of its own, which the engine follows."""
    unfelt: ClassVar[tuple[str, ...]] = ("far_stress", "far_stress_rate", "driver_inertia", "driver_integral_gain")
    """The fields, of a problem and of its body, that it does not feel: only a driver of finite impedance feels these."""
    missing_for_creep: ClassVar[str] = ""
    """What a body with waves lacks for creep that is alike from round trip to round trip: echoes that come back whole."""
    missing_for_leaps: ClassVar[str] = ""
    """What a run behind it lacks for leaps, in words; empty if it lacks nothing."""

    def reflection(self, body: BodyOnCharacteristics) -> float:
        """Return the share (1) of a wave that comes back before the driver itself has moved."""
        return body.reflection

    @abstractmethod
    def impedance(self, body: BodyOnCharacteristics) -> DriverImpedance:
        """Return how it resists a motion exp(s t) of its end, which decides how disturbances of steady sliding grow."""

    @abstractmethod
    def sent_steadily(self, problem: Problem) -> tuple[float, float]:
        """Return what it sends under a loading that does not vary: its value at 0 s and its growth per second (Pa, or N/s)."""

    def steady_inflow(self, problem: Problem) -> tuple[float, float]:
        """Return what of this is added at the contact."""
        return problem.body.added_at_contact(self.sent_steadily(problem))

    @abstractmethod
    def varying_inflow(self, problem: Problem) -> Inflow:
        """Return the inflow of a loading that varies."""

    @abstractmethod
    def ramp(self, problem: Problem) -> float:
        """Return the growth of the load in one round trip at rest (Pa), under a loading that does not vary."""

    def loading_rate(self, problem: ProblemFields) -> float:
        """Return the initial growth rate of the load on a stuck contact (Pa/s, N/s or N m/s), a mean over round trips."""
        return problem.body.stiffness * problem.first_pull_rate

    def inflow(self, problem: Problem) -> Inflow:
        """Return the inflow of a problem, whether its loading varies or not."""
        if problem.loading_varies:
            return self.varying_inflow(problem)
        value, slope = steady_inflow(problem)
        return arriving(np.array([[0.0], [value], [slope]]), SILENT, 0.0, problem)

    def jump_at_start(self, problem: Problem) -> float:
        """Return by how much (N) the load on a rigid body jumps from the initial load as the run begins."""
        return 0.0

    def at_first(self, problem: Problem) -> tuple[float, float]:
        """Return the rate (m/s) of a driver that moves when the first wave of the run leaves it, and the force of its gain (Pa)."""
        return 0.0, 0.0

    def first_sent(self, problem: Problem, time: float) -> float:
        """Return what comes from the driver (Pa) at the time (s) when it is first heard at the contact."""
        return float(inflow_of(problem).at(np.array(time)))

    def first_phases(self, problem: Problem, first: float) -> Floats:
        """Return the phases (s) of the first round trip, from `first` on, at which the driver begins to send back another share."""
        return np.array([first])

    def first_share(self, problem: Problem, phases: Floats) -> Floats:
        """Return the share (1) of waves of the start that it sends back, as they arrive at phases (s) of the first round trip."""
        return inflow_of(problem).reflection_at(phases)

    def put(self, problem: Problem, segments: Any, start: Floats, middle: Floats) -> None:
        """Write the share of waves that it sends back into segments of the loading, which begin at times (s) and hold at others."""
        inflow = inflow_of(problem)
        segments.reflection = inflow.reflection[inflow.segment(middle)]

    def pulled_shares(self, problem: Problem) -> list[float]:
        """Return the share (1) in a varying inflow, that of the first driver, of each driver: 0 if it is loaded steadily."""
        return problem.body.pulled_shares if problem.loading_varies else [0.0] * problem.body.drivers

    def pulls(self, problem: Problem) -> list[Inflow]:
        """Return the pull rate (m/s) of a driver that moves, as it arrives at the contact; nothing for any other."""
        return []

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the numbers of `engine.state.layout.Params` of a driver that moves, by name."""
        return {}

    def gathered(self, problem: Problem, trip: Floats, offset: Floats, trips: Floats) -> Floats:
        """Return the growth of a load (Pa) at rest over the given number of whole round trips, while only a tone changes.

        It is that since the time `offset` (s) in the round trip `trip`.
        """
        return inflow_of(problem).gathered(trip, offset, trips)

    def steps(self, problem: Problem) -> list[tuple[float, float]]:
        """Return the times (s) after the start at which the load of a rigid body jumps with the pull, and by how much (N)."""
        return []

    def changes_within(self, problem: Problem) -> float:
        """Return the shortest time (s) in which a driver that moves changes by itself; inf for any other."""
        return math.inf


DRIVERS: ByKind[Driver] = ByKind("stickslip.problem.drivers", DRIVER_KINDS)
"""What each kind of driver answers, by `Problem.driver_kind`."""


def driver_of(problem: Problem) -> Driver:
    """Return what the driver of a problem answers."""
    return DRIVERS[problem.driver_kind]


def driver_impedance(body: BodyOnCharacteristics) -> DriverImpedance:
    """Return how the driver of a uniform body resists a motion exp(s t) of its end."""
    return DRIVERS[body.driver_kind].impedance(body)


def loading_rate(problem: ProblemFields) -> float:
    """Return the initial growth rate of the load on a stuck contact (Pa/s, N/s or N m/s).

    It is exact for a block, and a mean over round trips for a slab.
    """
    return DRIVERS[problem.body.driver_kind].loading_rate(problem)


@lru_cache(maxsize=64)
def inflow_of(problem: Problem) -> Inflow:
    """Return the inflow of a problem."""
    return driver_of(problem).inflow(problem)


def tone_of(problem: Problem) -> Tone:
    """Return the sinusoid of the loading: that of the pull or, if it has none, that of the ground (of its velocity, m/s)."""
    inflow = inflow_of(problem).tone
    return inflow if problem.ground is None or inflow.amplitude != 0.0 else problem.ground.tone


def steady_inflow(problem: Problem) -> tuple[float, float]:
    """Return the inflow of a loading that does not vary: its value at 0 s and its growth per second (Pa, or N/s)."""
    return driver_of(problem).steady_inflow(problem)
