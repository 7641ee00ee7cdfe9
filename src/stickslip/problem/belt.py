"""The belt under a rigid body whose spring hangs on a wall: its velocity is the pull rate, and it is ground that moves.

With x the place of a body of the mass m, w the velocity of the belt, K the spring, and F the force of friction on the body, which
points with the belt while that runs ahead, m x'' = F - K x. Slip is how far the belt has run ahead of the body: v = w - x', so that

    m dv/dt = K x + m w' - F

and the load K x + m w' grows by K (w - v) + m w'' per second: that of a spring pulled at the rate w, on ground with the velocity
w(0) - w. At the start the belt has had its velocity for a long time, so that nothing jumps there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.problem.ground import Ground
from stickslip.problem.loading import LoadingHistory, Segment, Tone


@dataclass(frozen=True)
class Backwards(LoadingHistory):
    """What the ground does against the direction of slip: minus the change of the belt's velocity since the start."""

    kind: ClassVar[str] = "backwards"
    belt: LoadingHistory

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        first = self.belt.segments[0].value
        swing = self.belt.first - first if self.belt.tone.amplitude != 0.0 else 0.0
        return tuple(Segment(one.start, swing - (one.value - first), 0.0 - one.slope) for one in self.belt.segments)

    @property
    @override
    def tone(self) -> Tone:
        amplitude, frequency, phase = self.belt.tone
        return Tone(-amplitude, frequency, phase)


def ground_of_belt(body: str, velocity: float | LoadingHistory, given: str) -> Ground | None:
    """Return the motion of the ground that is a belt with a velocity (m/s) or a history of it; None if it runs steadily.

    `body` is the name of its class, and `given` that of a field with another motion of the ground, "" for none. Raises InputError
    if there is one, and for a belt that moves as no body can follow it.
    """
    if given:
        why = f"the ground of a {body} is the belt, whose velocity is pull_rate"
        raise InputError(f"Problem: {given}: {why}: leave {given} out")
    if not isinstance(velocity, LoadingHistory) or (velocity.is_stepped and velocity.lowest == velocity.highest):
        return None
    belt = Ground.of(Backwards(velocity), None)
    if belt is not None and belt.velocity_jumps:
        why = "a belt whose velocity jumps makes the slip rate jump, which that of a mass does not here"
        raise InputError(f"Problem: pull_rate jumps: {why}: join the steps by short ramps (piecewise-linear)")
    return belt
