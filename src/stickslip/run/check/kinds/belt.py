"""What `check` says of rigid bodies on a belt, beside what it says of those on a spring."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem import Ground, Problem
from stickslip.run.check.asked import Fact
from stickslip.run.check.kinds.rigid import CheckOfRigid


class _CheckOfBelt(CheckOfRigid):
    def numbers(self, problem: Problem) -> list[Fact]:
        """Return those of a body on a spring, and the largest force of inertia while the belt drags the body with it."""
        found = super().numbers(problem)
        if problem.ground is not None:
            most = problem.body.inertia * _most_acceleration(problem.ground)
            found.append(
                Fact("m w'", most, problem.load_unit, "largest force of inertia of the block while it moves with the belt")
            )
        return found

    def chosen(self, problem: Problem) -> Iterator[str]:
        """Yield what the belt does, and what slip is."""
        noun = problem.body.noun
        yield f"the pull rate is the velocity of the belt: forwards it drags the {noun} away from the wall"
        yield f"slip is how far the belt has run ahead of the {noun}, whose own velocity is the pull rate less the slip rate"
        if not problem.has_initial_rate:
            yield f"before the start the {noun} moves with the belt"


def _most_acceleration(ground: Ground) -> float:
    """Return the largest acceleration (m/s^2) of the straight parts, plus that of the sinusoid: an upper bound."""
    straight: Floats = np.abs(ground.acceleration)
    return float(straight.max() + abs(ground.tone.amplitude) * ground.tone.frequency)


ANSWERS = _CheckOfBelt()
