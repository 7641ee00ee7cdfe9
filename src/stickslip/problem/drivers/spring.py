"""The far end of a rigid body's spring, pulled as given: its load grows by K V(t), less the mass times the jerk of the ground.

A force on the body is added to its load, whatever ends the spring.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import BodyOnCharacteristics, as_on_spring
from stickslip.problem.drivers.driver import Driver
from stickslip.problem.drivers.impedance import DriverImpedance
from stickslip.problem.drivers.segments import arriving, put_way, scaled
from stickslip.problem.force import jumps_of_force, pushed
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading import Tone
from stickslip.problem.problem import Problem

if TYPE_CHECKING:
    from stickslip.problem.ground import Ground


@dataclass(frozen=True, eq=False)
class InflowOfSpring(Inflow):
    """The growth of a block's load (N/s)."""

    def gathered(self, trip: Floats, offset: Floats, trips: Floats) -> Floats:
        """Return the growth of a load at rest over the given number of whole periods."""
        time = trip * self.round_trip_time + offset
        return self.total(time, time + trips * self.round_trip_time)


class Spring(Driver):
    """What the far end of a spring answers."""

    def impedance(self, body: BodyOnCharacteristics) -> DriverImpedance:
        """Return 1/0: it does not give way."""
        return DriverImpedance(np.ones(1), np.zeros(1))

    def sent_steadily(self, problem: Problem) -> tuple[float, float]:
        """Return the growth of the load (N/s), K V, which does not grow."""
        return problem.body.stiffness * problem.first_pull_rate, 0.0

    def varying_inflow(self, problem: Problem) -> Inflow:
        """Return the growth of the load under a pull that varies."""
        return arriving(*scaled(problem.pull_rate, problem.body.stiffness), 0.0, problem, InflowOfSpring)

    def ramp(self, problem: Problem) -> float:
        """Return the growth of the load at rest in one period, or in what is called a round trip of a block that never rests."""
        return problem.body.stiffness * problem.first_pull_rate * problem.round_trip_time

    def inflow(self, problem: Problem) -> Inflow:
        """Return the growth of the load, whether the pull varies or not."""
        pulled, force = self.varying_inflow(problem), problem.force_in_time
        found = pulled if problem.ground is None else _on_ground(pulled, problem.ground, problem.body.inertia)
        return found if force is None else pushed(found, force)

    def jump_at_start(self, problem: Problem) -> float:
        """Return what the step of a reference makes of the load (N); 0 without one."""
        return problem.body.stiffness * as_on_spring(problem.body).reference_step

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return half the play, if there is one, the lag of the start, and the sinusoid of the pull rate.

        The force of the start has taken up the play; without a force the body is in the middle of it.
        """
        body, stiffness = as_on_spring(problem.body), problem.body.stiffness
        if not problem.body.has_play:
            return {}
        force = problem.load + self.jump_at_start(problem) - body.driver_damping * problem.first_pull_rate
        tone, half = scaled(problem.pull_rate, 1.0)[1], 0.5 * body.backlash
        tones = {"pull_tone": tone.amplitude, "pull_phase": tone.phase}
        return {"play": half, "spring": stiffness, "first_lag": force / stiffness + half * float(np.sign(force)), **tones}

    def put(self, problem: Problem, segments: Any, start: Floats, middle: Floats) -> None:
        """Write how far its end has been pulled, if there is a play."""
        super().put(problem, segments, start, middle)
        if problem.body.has_play:
            put_way(problem.pull_rate, segments, start)

    def steps(self, problem: Problem) -> list[tuple[float, float]]:
        """Return the times (s) when a force on the body jumps, and by how much (N)."""
        return [] if problem.force_in_time is None else jumps_of_force(problem.force_in_time)


def _on_ground(pulled: Inflow, ground: Ground, mass: float) -> Inflow:
    """Return the growth of a block's load where the ground moves: K V - m a', with a the acceleration of the ground."""
    start = np.union1d(pulled.start, ground.start)
    of_pull, of_ground = pulled.segment(start), np.searchsorted(ground.start, start, side="right") - 1
    value = pulled.value[of_pull] + pulled.slope[of_pull] * (start - pulled.start[of_pull]) - mass * ground.jerk[of_ground]
    tone = _together(pulled.tone, ground.tone, mass) if ground.tone.amplitude != 0.0 else pulled.tone
    slope, share, gain = pulled.slope[of_pull], pulled.reflection[of_pull], pulled.gain[of_pull]
    return replace(pulled, start=start, value=value, slope=slope, tone=tone, reflection=share, gain=gain)


def _together(pull: Tone, ground: Tone, mass: float) -> Tone:
    """Return the sinusoid of a pull and of -m a'; that of a pull beside it is the belt's: of one frequency."""
    size, frequency, phase = mass * ground.amplitude * ground.frequency**2, ground.frequency, ground.phase
    if pull.amplitude == 0.0 or pull.phase == phase:
        return Tone(pull.amplitude + size, frequency, phase)
    both = size + pull.amplitude * cmath.exp(1j * (pull.phase - phase))  # a dashpot beside the spring turns its phase
    return Tone(abs(both), frequency, phase + cmath.phase(both))


ANSWERS = Spring()
