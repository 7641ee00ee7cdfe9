"""Examine a scenario with a given motion without solving it: its start, its range of slip rates, its rests, its stiffness."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.extensions.given_motion.along import in_intervals
from stickslip.extensions.given_motion.moved import MovedContact
from stickslip.foundation.quantities import Quantity, fields_of
from stickslip.foundation.show import brief, number, with_unit

if TYPE_CHECKING:
    from stickslip.problem.scenarios import Scenario

SAME_STATE = 1e-9
"""A state that differs from that of steady sliding by less than this share (1) is steady."""
STIFF = 1e3
"""A state that settles within less than this share of the run, as a number of times in it, makes its equation stiff."""
MOST_NAMED = 5
"""Name at most so many times when slip turns back."""


class MotionExamination:
    """The findings about a given motion: `numbers` and `findings`, as `stickslip check` shows them."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario, self.moved = scenario, scenario.to_solve
        self.motion = in_intervals(self.moved, scenario.duration)

    def numbers(self) -> Iterator[tuple[str, ...]]:
        """Yield name, value and meaning of each number below the name of its table alone."""
        moved: MovedContact = self.moved
        yield ("[friction]",)
        yield "kind", moved.friction.kind, ""
        for name, (declared, _) in fields_of(type(moved.friction)).items():
            value = getattr(moved.friction, name)
            if isinstance(declared, Quantity) and value is not None:
                yield name, with_unit(value, declared.unit), declared.meaning
        yield ("[motion]",)
        rate, load = moved.slip_rate, moved.normal_load
        yield "slip_rate", _range(rate.lowest, rate.highest, moved.rate_unit), "slip rate, lowest to highest"
        yield "normal_load", _range(load.lowest, load.highest, moved.load_unit), "normal load, lowest to highest"
        yield "initial_slip", with_unit(moved.initial_slip, "rad" if moved.turns else "m"), "slip at the start"
        names = ("initial_state", "initial_second_state")
        for name, value, one in zip(names, moved.given_states, moved.friction.states, strict=False):
            yield name, with_unit(value, one.unit), one.meaning
        yield ("[run]",)
        yield "duration", with_unit(self.scenario.duration, "s"), "how long to follow the motion"
        yield "rtol", number(self.scenario.rtol), "relative tolerance of the states"

    def findings(self) -> Iterator[tuple[str, str]]:
        """Yield the name and the text of each finding."""
        moved, motion = self.moved, self.motion
        yield "start", self._start()
        rests = motion.direction == 0.0
        yield "motion", f"{len(motion.start)} intervals where it is smooth and goes one way, {int(rests.sum())} of them at rest"
        turns = motion.start[1:][motion.facing[1:] != motion.facing[:-1]]
        if len(turns):
            times = ", ".join(brief(float(one), "s") for one in turns[:MOST_NAMED])
            yield "turns", f"slip turns back {len(turns)} times: at {times}{', ...' if len(turns) > MOST_NAMED else ''}"
        if rests.any():
            what = (
                "any traction up to static friction is possible then" if moved.friction.sticks else "the state changes at rest, too"
            )
            yield "rest", f"{number(float(motion.lasting[rests].sum()), 4)} s at rest: {what}"
        if moved.friction.states:
            yield "states", self._stiffness()

    def _start(self) -> str:
        moved, rate = self.moved, self.moved.slip_rate.first
        if not moved.friction.states:
            return "the law has no state: friction follows the motion at every moment"
        steady = moved.friction.steady_state(abs(rate)) if rate else None
        if steady is None:
            return "from the state that is given"
        way = [np.sign(rate) if one.reverses else 1.0 for one in moved.friction.states]
        apart = abs(np.atleast_1d(steady).ravel() * way - moved.given_states) / np.maximum(
            abs(np.atleast_1d(steady).ravel()), 1e-300
        )
        is_steady = bool((apart < SAME_STATE).all())
        return f"{'in' if is_steady else 'not in'} the state of steady sliding at {brief(abs(rate), moved.rate_unit)}"

    def _stiffness(self) -> str:
        """Say how fast the states settle, from their equation at the start and at the fastest slip rate."""
        moved = self.moved
        fastest = max(abs(moved.slip_rate.lowest), abs(moved.slip_rate.highest), 1e-300)
        settles = settling_rate(moved, min(fastest, 1e300))
        if not settles > 0.0:
            return "they do not settle by themselves at the fastest slip rate"
        word = "stiff" if settles * self.scenario.duration > STIFF else "not stiff"
        return f"they settle within about {brief(1.0 / settles, 's')} at the fastest slip rate: the equation is {word}"


def settling_rate(moved: MovedContact, rate: float) -> float:
    """Return how fast (1/s) a disturbance of the first state fades at a slip rate (m/s), in the state of steady sliding there."""
    law: Any = moved.friction
    steady = law.steady_state(rate)
    given = moved.given_states if steady is None else tuple(np.atleast_1d(steady).ravel())
    w = np.asarray(law.inner_states(given))
    step = 1e-6 * np.maximum(abs(w), 1e-12)
    first = law.state_rate[0] if isinstance(law.state_rate, tuple) else law.state_rate
    numbers = type("Numbers", (), law.numbers() | law.literals())
    nudged = [first(numbers, moved.initial_slip, rate, *(w + sign * step * (np.arange(len(w)) == 0))) for sign in (1.0, -1.0)]
    return float((nudged[1] - nudged[0]) / (2.0 * step[0]))


def _range(low: float, high: float, unit: str) -> str:
    return with_unit(low, unit) if low == high else f"{with_unit(low, unit)} to {with_unit(high, unit)}"
