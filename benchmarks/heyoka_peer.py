"""heyoka: adaptive Taylor series compiled by LLVM, with a terminal event for the block's arrest. No delays: first transit only."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.problems import ROUND, Case, Floats
from benchmarks.runner import Runner, UnavailableError
from stickslip.friction import SinusoidalSlip
from stickslip.problem.bodies import ElasticSlab

try:
    import heyoka
except ImportError:
    heyoka = None


def runner(case: Case, tolerance: float) -> Runner:
    """The problem in heyoka. Its slip is evaluated in a second run, which is not timed."""
    if heyoka is None:
        raise UnavailableError("heyoka is not installed: pip install 'stickslip[bench]' (Linux only)")
    law = case.problem.friction
    if not isinstance(law, SinusoidalSlip):
        raise UnavailableError("slip laws only, here")
    friction = lambda u: law.mean + law.amplitude * heyoka.sin(law.wavenumber * u)  # noqa: E731 - heyoka's symbols, or numbers
    if isinstance(case.problem.body, ElasticSlab):
        return _slab(case, friction, tolerance)
    return _block(case, friction, tolerance)


def _slab(case: Case, friction, tolerance: float) -> Runner:  # type: ignore[no-untyped-def]
    problem, body = case.problem, case.problem.body
    if case.duration > ROUND or body.reflection != -1.0:
        raise UnavailableError("heyoka has no delays")
    u = heyoka.make_vars("u")
    load = problem.load + body.impedance * problem.pull_rate / (0.5 * body.two_way_time) * heyoka.time
    motion = [(u, (load - body.normal_stress * friction(u)) / body.impedance)]
    taylor = heyoka.taylor_adaptive(motion, [problem.initial_slip], tol=tolerance)
    steps = [0]

    def run() -> None:
        taylor.time = 0.0
        taylor.state[0] = problem.initial_slip
        steps[0] = taylor.propagate_until(case.duration)[3]

    def slip(times: Floats) -> Floats:
        taylor.time = 0.0
        taylor.state[0] = problem.initial_slip
        return np.array(taylor.propagate_grid(times)[-1][:, 0] - problem.initial_slip)

    return Runner(case, tolerance, run, slip, lambda: steps[0])


def _block(case: Case, friction, tolerance: float) -> Runner:  # type: ignore[no-untyped-def]
    problem, body = case.problem, case.problem.body
    u0, K = problem.initial_slip, body.stiffness
    u, v = heyoka.make_vars("u", "v")
    force = problem.load + K * (problem.pull_rate * heyoka.time - (u - u0)) - body.normal_force * friction(u)
    arrest = heyoka.t_event(v, direction=heyoka.event_direction.negative)
    taylor = heyoka.taylor_adaptive([(u, v), (v, force / body.mass)], [u0, 0.0], tol=tolerance, t_events=[arrest])
    steps, end = [0], [math.nan]

    def start() -> None:
        taylor.time = 0.0
        taylor.state[:] = u0, 0.0
        taylor.reset_cooldowns()

    def run() -> None:
        start()
        steps[0] = taylor.propagate_until(case.duration)[3]
        end[0] = taylor.time

    def slip(times: Floats) -> Floats:
        start()
        output = taylor.propagate_until(case.duration, c_output=True)[4]
        return np.array([output(min(t, end[0]))[0] for t in times]) - u0

    return Runner(case, tolerance, run, slip, lambda: steps[0], lambda: end[0])
