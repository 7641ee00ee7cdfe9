"""The checks for rare problems: ground that moves, a driver that changes, a force, a body without a spring."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stickslip.foundation.constants import RIGID
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import si_unit
from stickslip.problem.bodies.rigid.on_spring import as_on_spring
from stickslip.problem.features import DRIVEN_BY_MACHINE, refuse
from stickslip.problem.ground import Ground
from stickslip.problem.loading_history import LoadingHistory

MOST_PERIODS = 1e8
"""Number of periods (1) of a force that a run of a body without a spring may have; so many take an hour or more."""


def check_ground(problem: Any, ground: Ground, pulls: list[LoadingHistory]) -> None:
    """Raise InputError for ground that moves as it may not under a body, with pulls or far stresses that vary."""
    body = problem.body
    if not body.has_ground:
        why, cure = "each is the ground of the other", 'set sides = "joined", or leave the ground at rest'
        raise InputError(f"Problem: ground that moves is not followed under sides that are apart, as {why}: {cure}")
    if body.time_to_driver:
        refuse("Problem", problem, {DRIVEN_BY_MACHINE: "is not followed on ground that moves (leave it at rest)"})
    if body.has_inertia and ground.velocity_jumps:
        unit = si_unit("slip_rate", body.load_unit)
        why = f"an infinite force on a mass: join the points (piecewise-linear), beginning with 0 {unit}"
        raise InputError(f"Problem: ground_velocity jumps, which is {why}, or give ground_acceleration")
    if ground.tone.amplitude != 0.0 and any(map(_swings, pulls)):
        raise InputError("Problem: only one of the ground and the pull may have a sinusoid: give the other as straight lines")


def check_reflection(problem: Any, history: LoadingHistory, rounding: float) -> None:
    """Raise InputError for a driver that changes as it may not behind a body; `rounding` is that of coefficients (1)."""
    body, name = problem.body, "Problem: driver_reflection"
    if not body.driver_may_change:
        why = "whose top stays free" if body.time_to_driver else "which sends no waves to its driver"
        why += ": give a slab or a string"
        raise InputError(f"{name} is not followed behind a {type(body).__name__}, {why}")
    refuse(name, problem, {DRIVEN_BY_MACHINE: "is not followed where it changes (leave driver_reflection out)"})
    if not history.is_stepped:
        raise InputError(f"{name} must change by steps, got {history.kind}: give kind steps")
    if history.lowest < RIGID or history.highest > 1.0:
        beyond = history.lowest if history.lowest < RIGID else history.highest
        raise InputError(f"{name} must lie between -1 (rigid) and 1 (set free), got {beyond:g}")
    if abs(history.first - body.reflection) > rounding:
        own = f"but that of the body's driver_impedance is {body.reflection:.9g}: make them equal"
        raise InputError(f"{name} begins with {history.first:.9g}, {own}")


def check_force(problem: Any) -> None:
    """Check the fields of a problem with a force, or with a body without a spring, whose load at the start is 0 by default.

    Raises InputError for a body that is not rigid, for a second sinusoid, and for a pull without a spring.
    """
    body, force, pull, ground = problem.body, problem.force, problem.pull_rate, problem.ground
    name = type(body).__name__
    if force is not None and not body.takes_force:
        end = "far_stress acts on it through a driver of finite driver_impedance"
        raise InputError(f"Problem: force acts on a rigid body, which {name} is not: {end}")
    if _swings(force) and (_swings(pull) or (ground is not None and ground.tone.amplitude != 0.0)):
        other = "pull_rate" if _swings(pull) else "the ground"
        raise InputError(f"Problem: only one of force and {other} may have a sinusoid: give the other as straight lines")
    if not body.is_free:
        return
    rigid = as_on_spring(body)
    if not rigid.driver_damping and body.kind != rigid.belted and pull != 0.0:
        cure = "leave it out, give body.stiffness, push with force, or set the body on a belt (.on_belt())"
        raise InputError(f"Problem: pull_rate has nothing to pull: a {name} of stiffness 0 has no spring: {cure}")
    if problem.initial_load is None and problem.initial_excess is None and not isinstance(problem.initial_rate, str):
        object.__setattr__(problem, "initial_load", 0.0)  # no spring holds a load before the force acts


def check_period_of_force(problem: Any, duration: float, who: str) -> None:
    """Refuse a force that swings a body without a spring too often in a run (s): its period bounds no round trip of a spring."""
    tone = problem.force.tone if _swings(problem.force) else None
    if tone is None or 2.0 * math.pi * MOST_PERIODS >= tone.frequency * duration:
        return
    largest = abs(problem.load) + float(np.abs(problem.force.parts[1]).max()) + abs(tone.amplitude)
    if len(problem.force.parts[0]) == 1 and largest < min(problem.strength, problem.backward_strength):
        return  # it rests for ever, which is one step
    period, least = 2.0 * math.pi / tone.frequency, duration / MOST_PERIODS
    why = f"the force's period of {period:g} s is too short for a run of {duration:g} s"
    raise InputError(f"{who}: {why}: at least about {least:.3g} s is needed, or a shorter duration")


def check_thrown(body: Any, rate: float) -> None:
    """Refuse a rate of the start (m/s) towards a stop at which the body already is."""
    name = "stop_ahead" if rate > 0.0 else "stop_behind"
    if rate != 0.0 and getattr(body, name) == 0.0:
        way = "forwards" if rate > 0.0 else "backwards"
        cure = f"give a larger {name}, or a rate the other way, with which it leaves the stop"
        raise InputError(f"Problem: initial_rate: {name} is 0, so that the body cannot move {way} from the start: {cure}")


def _swings(given: Any) -> bool:
    return isinstance(given, LoadingHistory) and given.tone.amplitude != 0.0
