"""A driver of finite impedance, behind which waves leave: a half-space under a far stress, or a dead load."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.drivers.driver import Driver, far_at_first
from stickslip.problem.drivers.impedance import DriverImpedance
from stickslip.problem.drivers.segments import arriving, scaled
from stickslip.problem.fields import ProblemFields
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading_history import LoadingHistory
from stickslip.problem.problem import Problem


class LossyDriver(Driver):
    """What a driver of finite impedance Zd answers: it sends (1 + r) (Zd V + far stress)."""

    unfelt: ClassVar[tuple[str, ...]] = ()
    missing_for_creep: ClassVar[str] = "a rigid driver (no driver_impedance)"

    def impedance(self, body: BodyOnCharacteristics) -> DriverImpedance:
        """Return Zd."""
        return DriverImpedance(np.array([body.driver_impedance]), np.ones(1))

    def gain(self, body: BodyOnCharacteristics) -> Any:
        """Return the share (1) of its stress that it sends to the contact."""
        return 1.0 + body.reflection

    def sent_steadily(self, problem: Problem) -> tuple[float, float]:
        """Return the inflow at 0 s and its growth, that of the far stress."""
        body, far = problem.body, problem.far_stress
        gain = self.gain(body)
        assert not isinstance(far, LoadingHistory)
        excess = far_at_first(problem) if far is None else far - problem.strength
        growth, delay = problem.far_stress_rate, body.inflow_delay
        return gain * body.driver_impedance * problem.first_pull_rate + gain * (excess - growth * delay), gain * growth

    def varying_inflow(self, problem: Problem) -> Inflow:
        """Return the inflow of far stress and pull rate together; one of them varies."""
        body, far = problem.body, problem.far_stress
        gain = self.gain(body)
        if isinstance(far, LoadingHistory):
            (start, value, slope), tone = scaled(far, gain)
            steady = gain * (body.driver_impedance * problem.first_pull_rate - problem.strength)
        else:
            (start, value, slope), tone = scaled(problem.pull_rate, gain * body.driver_impedance)
            steady = gain * (far_at_first(problem) if far is None else far - problem.strength)
        growth = gain * problem.far_stress_rate
        sent = np.array([start, value + steady + growth * start, slope + growth])
        return arriving(sent, tone, body.inflow_delay, problem)

    def loading_rate(self, problem: ProblemFields) -> float:
        """Return the growth of the far stress: nothing else holds a contact at rest."""
        return problem.far_stress_rate

    def ramp(self, problem: Problem) -> float:
        """Return what the far stress gains in one round trip."""
        return problem.far_stress_rate * problem.body.round_trip_time


ANSWERS = LossyDriver()
