"""A force on a rigid body that is given in time: what it adds to the load, and where it may not act.

The load of the engine grows by F' per second, and jumps where F jumps: at the start, too, because no force acts before it.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from stickslip.foundation.errors import InputError
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.ground import Ground
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading_history import LoadingHistory, Tone

Given = float | LoadingHistory | None
"""What may be a number, a history, or nothing."""
NO_JUMP_OF_FORCE = 1e-14
"""A change of the force below this share of the largest one (1) is rounding and no jump."""


def check_force(body: BodyOnCharacteristics, force: Given, pull: Given, ground: Ground | None) -> None:
    """Raise InputError for a force on a body that is not rigid, one with a second sinusoid, or a pull of what has no spring."""
    name = type(body).__name__
    if force is not None and not body.takes_force:
        end = "far_stress acts on it through a driver of finite driver_impedance"
        raise InputError(f"Problem: force acts on a rigid body, and a {name} is none: {end}")
    if _swings(force) and (_swings(pull) or (ground is not None and ground.tone.amplitude != 0.0)):
        other = "pull_rate" if _swings(pull) else "the ground"
        raise InputError(f"Problem: only one of force and {other} may have a sinusoid: give the other as straight lines")
    if body.has_nothing_to_pull and pull != 0.0:
        cure = "leave it out, give body.stiffness, push with force, or set the body on a belt (.on_belt())"
        raise InputError(f"Problem: pull_rate has nothing to pull: a {name} of stiffness 0 has no spring: {cure}")


def pushed(inflow: Inflow, force: LoadingHistory) -> Inflow:
    """Return the growth of the load of a rigid body (N/s) that a force acts on, too."""
    begin, _, slope = force.parts
    start = np.union1d(inflow.start, begin)
    of = inflow.segment(start)
    value = inflow.value[of] + inflow.slope[of] * (start - inflow.start[of])
    value += slope[np.searchsorted(begin, start, side="right") - 1]
    amplitude, frequency, phase = force.tone
    tone = Tone(amplitude * frequency, frequency, phase + 0.5 * math.pi) if amplitude != 0.0 else inflow.tone
    return replace(
        inflow, start=start, value=value, slope=inflow.slope[of], tone=tone, reflection=inflow.reflection[of], gain=inflow.gain[of]
    )


def jumps_of_force(force: LoadingHistory) -> list[tuple[float, float]]:
    """Return the times (s) at which a force jumps, the start among them, and by how much (N)."""
    start, value, slope = force.parts
    jump = np.append(force.first, value[1:] - (value[:-1] + slope[:-1] * np.diff(start)))
    jump[1:][np.abs(jump[1:]) <= NO_JUMP_OF_FORCE * np.abs(value).max()] = 0.0
    return [(time, step) for time, step in zip(start.tolist(), jump.tolist(), strict=True) if step != 0.0]


def _swings(given: Given) -> bool:
    return isinstance(given, LoadingHistory) and given.tone.amplitude != 0.0
