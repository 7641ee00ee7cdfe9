"""What the engine is told of a rigid body on a spring: its load grows steadily, and its slip rate is a state."""

from __future__ import annotations

from typing import Any

from stickslip.engine.input.asked import InputOfBody, Shaken
from stickslip.engine.input.first_pieces import pieces_of
from stickslip.engine.state import layout as at
from stickslip.problem import EVENT_SHARE, Problem, driver_of
from stickslip.problem.bodies import as_on_spring

LEAST_BOUNCE = 1e-9
"""A body stays at a hard stop that it would leave at no more than this share (1) of the rate that the normal load gives it in a
period."""
LEAST_HOP = 300.0 * 2.0**-52
"""It stays there, too, if the load presses it back before it is away by this share (1) of the way from the start to that stop."""


class InputOfRigid(InputOfBody):
    """Answers of a rigid body."""

    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return its stiffness, and the slip rate (m/s) below which it is slow."""
        body = problem.body
        slow = EVENT_SHARE * problem.normal * problem.contact_law.variation / body.impedance
        numbers = {"stiffness": body.stiffness, "slow": slow}
        if body.has_stops:
            stops = as_on_spring(body)
            least = LEAST_BOUNCE * problem.normal * body.longest_way / body.inertia
            numbers |= {"stop_ahead": stops.stop_ahead, "stop_behind": -stops.stop_behind}
            numbers |= {"restitution": stops.restitution, "least_bounce": least, "least_hop": 2.0 * LEAST_HOP / body.inertia}
        return numbers

    def steady_numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the growth of the load in a period."""
        return {"ramp": driver_of(problem).ramp(problem)}

    def first_load(self, problem: Problem) -> at.Floats:
        """Return one straight piece."""
        growth = problem.body.stiffness * problem.first_pull_rate
        return pieces_of([0.0, problem.round_trip_time], [_first(problem)], [growth])

    def first_load_varying(self, problem: Problem) -> at.Floats:
        """Return one piece that does not grow: all growth is inflow."""
        return pieces_of([0.0, problem.round_trip_time], [_first(problem)], [0.0])

    def on_ground(self, problem: Problem) -> Shaken:
        """Return the jumps of the force of inertia; its growth is in the inflow."""
        from stickslip.engine.input.shaking import StepsOfForce  # here, because few runs move the ground

        return StepsOfForce.of(problem)


def _first(problem: Problem) -> float:
    """Return the load minus the reference strength (N) of the start, after the reference has jumped."""
    return problem.excess + driver_of(problem).jump_at_start(problem)


ANSWERS = InputOfRigid()
