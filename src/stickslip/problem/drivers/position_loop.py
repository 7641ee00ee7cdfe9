"""A controller of a rigid body's position: its proportional and derivative gains are a spring and a dashpot, its integral winds up.

The load of the engine is kp e + kd V + q, with the lag e = r - u behind the reference r, V = dr/dt and dq/dt = ki e. What does not
depend on slip is sent as by a spring with a dashpot; the engine adds the integral from the numbers given here (`contact.winding`).
"""

from __future__ import annotations

from typing import Any

from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import as_on_spring
from stickslip.problem.drivers.segments import put_way, scaled
from stickslip.problem.drivers.spring_and_dashpot import SpringAndDashpot
from stickslip.problem.fields import ProblemFields
from stickslip.problem.problem import Problem


class OfPositionLoop(SpringAndDashpot):
    """What a position loop answers."""

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the integral gain, the first lag, and the sinusoid of the reference's rate."""
        body, (_, tone) = as_on_spring(problem.body), scaled(problem.pull_rate, 1.0)
        tones = {"pull_tone": tone.amplitude, "pull_phase": tone.phase}
        return {"winding": body.integral_gain, "first_lag": body.reference_step, **tones}

    def put(self, problem: Problem, segments: Any, start: Floats, middle: Floats) -> None:
        """Write the way and the rate of the reference, but for its sinusoid."""
        super().put(problem, segments, start, middle)
        put_way(problem.pull_rate, segments, start)

    def loading_rate(self, problem: ProblemFields) -> float:
        """Return K V + c dV/dt + ki e at the start (N/s)."""
        body = as_on_spring(problem.body)
        return super().loading_rate(problem) + body.integral_gain * body.reference_step


ANSWERS = OfPositionLoop()
