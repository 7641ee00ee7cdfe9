"""What `check` says of ground that moves: when it makes a mass slip, how far it goes, and whether a record drifts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.show import brief
from stickslip.problem import Accelerogram, Ground, Problem
from stickslip.problem.scenarios import Scenario
from stickslip.run.check.asked import CHECK_KINDS, Fact

DRIFT = 0.1
"""Ground that ends at more than this share of its largest velocity (1) is worth a question: records end at rest."""


def ground_given(problem: Problem) -> Ground | None:
    """Return the motion of the ground that a problem was given; a belt is none."""
    return None if problem.ground_acceleration is None and problem.ground_velocity is None else problem.ground


def facts_of_ground(problem: Problem) -> list[Fact]:
    """Return the yield acceleration, the peak of the ground, how often it passes the yield, and where the ground ends."""
    ground = ground_given(problem)
    if ground is None:
        return []
    facts = [*_yields(problem, ground)]
    if ground.tone.amplitude == 0.0:
        end = float(ground.start[-1])
        fastest, last, moved = (float(one) for one in (np.abs(ground.velocity).max(), ground.velocity[-1], ground.moved[-1]))
        facts += [
            Fact("PGV", fastest, "m/s", "largest velocity of the ground where its acceleration breaks"),
            Fact("last velocity", last, "m/s", f"of the ground at {brief(end, 's')}, when its history ends"),
            Fact("last displacement", moved, "m", "of the ground then"),
        ]
    return facts


def _yields(problem: Problem, ground: Ground) -> Iterator[Fact]:
    """Yield what the ground must accelerate by to make the mass slip, and how often it does, for each way that may be slipped."""
    largest = float(np.abs(ground.acceleration).max() + abs(ground.tone.amplitude) * ground.tone.frequency)
    ends = float(np.abs(ground.acceleration[:-1] + ground.jerk[:-1] * np.diff(ground.start)).max(initial=0.0))
    mass = CHECK_KINDS[problem.body.structure].mass_on_ground(problem.body)
    if mass is not None and problem.friction.sticks:
        ways = [("", -1.0, problem.strength - problem.load, "forwards, by an acceleration of the ground backwards")]
        if not problem.one_way:
            ways.append((" back", 1.0, problem.backward_strength + problem.load, "backwards, by an acceleration forwards"))
        for name, sign, left, way in ways:
            passed = _passed(ground, sign, left / mass) if ground.tone.amplitude == 0.0 else None
            often = "" if passed is None else f": passed {passed} time{'s' * (passed != 1)}"
            yield Fact(f"yield{name}", left / mass / GRAVITY, "1", f"yield acceleration in g to slip {way}{often}")
    yield Fact("PGA", max(largest, ends) / GRAVITY, "1", "peak acceleration of the ground in g")


def _passed(ground: Ground, sign: float, least: float) -> int:
    """Return how often the acceleration times a sign rises above a value (m/s^2)."""
    lasting = np.append(np.diff(ground.start), 0.0)
    both = sign * np.array([ground.acceleration, ground.acceleration + ground.jerk * lasting])
    above = np.append(False, both.T.ravel() > least)
    return int((above[1:] & ~above[:-1]).sum())


def chosen_of_ground(problem: Problem) -> Iterator[str]:
    """Yield what is taken for granted of the ground before and after its history."""
    ground = ground_given(problem)
    if ground is None:
        return
    yield "before the start the ground is at rest"
    if isinstance(problem.ground_acceleration, Accelerogram):
        end, kept = problem.ground_acceleration.duration, float(ground.velocity[-1])
        yield f"after the record, {brief(end, 's')}, the acceleration is 0, and the ground keeps {brief(kept, 'm/s', 3)}"


def warnings_of_ground(scenario: Scenario) -> list[str]:
    """Return warnings for a record that is longer than the run, and for ground that does not end at rest.

    The latter is what the offset of an instrument does.
    """
    ground, record = ground_given(scenario.problem), scenario.problem.ground_acceleration
    if ground is None or record is None or ground.tone.amplitude != 0.0:
        return []
    found = list[str]()
    if isinstance(record, Accelerogram) and record.duration > scenario.duration:
        lasts = f"the record lasts {brief(record.duration, 's')}, and the run {brief(scenario.duration, 's')}"
        found.append(f"{lasts}: what comes after is left out")
    end, fastest, last = float(ground.start[-1]), float(np.abs(ground.velocity).max()), float(ground.velocity[-1])
    if not abs(last) > DRIFT * fastest:
        return found
    ends = f"the ground ends at {brief(last, 'm/s', 3)}, {brief(float(ground.displacement_at(end)), 'm', 3)} away from where it was"
    offset = f"an offset of {brief(last / end, 'm/s^2', 3)} in its acceleration does that"
    return [*found, f'{ends}: {offset}; baseline = "mean" takes it off a record, if it is the instrument\'s; records end at rest']
