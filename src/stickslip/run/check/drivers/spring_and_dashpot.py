"""The pulled end of a spring with a dashpot beside it: it damps the swings on the spring, and takes part of the load."""

from __future__ import annotations

from stickslip.problem import Problem
from stickslip.problem.bodies import as_on_spring
from stickslip.run.check.asked import CheckOfDriver, Fact


class _CheckOfDashpot(CheckOfDriver):
    def facts(self, problem: Problem, way: str) -> list[Fact]:
        """Return the damping ratio of free swings, and what the dashpot bears of the load at the start."""
        body = as_on_spring(problem.body)
        force, first = body.driver_damping * problem.first_pull_rate, ", at first" if problem.loading_varies else ""
        ratio = 0.5 * body.total_damping / body.impedance
        return [
            *[Fact("damping ratio", ratio, "1", "(damping + driver_damping) / (2 sqrt(K m))")] * (not body.is_free),
            Fact("c V", force, problem.load_unit, f"part of the load that the dashpot of the driver bears while stuck{first}"),
        ]


ANSWERS = _CheckOfDashpot()
