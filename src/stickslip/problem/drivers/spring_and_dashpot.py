"""A spring and a dashpot side by side (Kelvin-Voigt), whose far end is pulled: a rigid body feels K (D - u) + c (V - v).

Here D is how far the end has been pulled, V = dD/dt, and u and v are slip and slip rate. The load of the engine is K (D - u) + c V,
and c resists slip with the damping against the ground (`Body.total_damping`). So the load grows by K V + c dV/dt, and jumps by c
times the jump where V jumps. At the start it is given with c V in it: it is what the contact feels while it rests.
"""

from __future__ import annotations

import math

import numpy as np

from stickslip.problem.bodies.rigid.on_spring import as_on_spring
from stickslip.problem.drivers.segments import arriving, scaled
from stickslip.problem.drivers.spring import InflowOfSpring, Spring
from stickslip.problem.fields import ProblemFields
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading_history import SILENT, LoadingHistory, Tone
from stickslip.problem.problem import Problem

NO_JUMP_OF_PULL = 1e-14
"""A change of the pull rate below this share of the largest one (1) is rounding and no jump."""


class SpringAndDashpot(Spring):
    """What the far end of a spring with a dashpot beside it answers."""

    def varying_inflow(self, problem: Problem) -> Inflow:
        """Return the growth of the load (N/s), K V + c dV/dt; the jumps of V are `steps`."""
        stiffness, damping = problem.body.stiffness, as_on_spring(problem.body).driver_damping
        (start, value, slope), tone = scaled(problem.pull_rate, 1.0)
        grows = np.array([start, stiffness * value + damping * slope, stiffness * slope])
        if tone is not SILENT:
            amplitude, frequency, phase = tone
            by_rate = damping * frequency
            tone = Tone(amplitude * math.hypot(stiffness, by_rate), frequency, phase + math.atan2(by_rate, stiffness))
        return arriving(grows, tone, 0.0, problem, InflowOfSpring)

    def loading_rate(self, problem: ProblemFields) -> float:
        """Return K V + c dV/dt at the start (N/s)."""
        found, pull = super().loading_rate(problem), problem.pull_rate
        if not isinstance(pull, LoadingHistory):
            return found
        amplitude, frequency, phase = pull.tone
        grows = float(pull.parts[2, 0]) + amplitude * frequency * math.cos(phase)
        return found + as_on_spring(problem.body).driver_damping * grows

    def jump_at_start(self, problem: Problem) -> float:
        """Return it with c V(0), where the pulled end was at rest before and the load is given."""
        found, pull = super().jump_at_start(problem), problem.pull_rate
        if isinstance(pull, LoadingHistory) and pull.rests_before and not problem.begins_in_balance:
            found += as_on_spring(problem.body).driver_damping * problem.first_pull_rate
        return found

    def steps(self, problem: Problem) -> list[tuple[float, float]]:
        """Return the times (s) when V or a force jumps, and c times the jumps of V, or those of the force (N)."""
        found = super().steps(problem)
        if not isinstance(problem.pull_rate, LoadingHistory):
            return found
        start, value, slope = problem.pull_rate.parts
        jump = value[1:] - (value[:-1] + slope[:-1] * np.diff(start))
        jump[np.abs(jump) <= NO_JUMP_OF_PULL * np.abs(value).max()] = 0.0
        force = as_on_spring(problem.body).driver_damping * jump
        return found + [(time, step) for time, step in zip(start[1:].tolist(), force.tolist(), strict=True) if step != 0.0]


ANSWERS = SpringAndDashpot()
