"""scipy, used plainly: DOP853 by the method of steps, dense output as the history, terminal events; no max_step, no scans.

What is unknown is integrated: slip for a massless contact under a slip law; slip and slip rate under a rate law (the contact
equation differentiated) and for the block. Every round trip starts anew, and so does every change between slip and rest.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.problems import Case, Floats
from benchmarks.runner import Runner, UnavailableError
from stickslip.friction import HyperbolicRate, SinusoidalSlip
from stickslip.problem import steady_inflow
from stickslip.problem.bodies import ElasticSlab

Function = Callable[[float], float]
Piece = tuple[float, float, Function, Function, Function]
"""Start, end (s), and between them slip (m), slip rate (m/s) and load (Pa)."""


class Slab:
    """A slab under the sinusoidal slip law or the hyperbolic rate law, round trip after round trip."""

    def __init__(self, case: Case, tolerance: float) -> None:
        self.problem, self.body, self.law = case.problem, case.problem.body, case.problem.friction
        assert isinstance(self.body, ElasticSlab)
        self.Z, self.S, self.R, self.r = self.body.impedance, self.body.normal_stress, self.body.two_way_time, self.body.reflection
        self.tolerance, self.duration = tolerance, case.duration
        self.steady = steady_inflow(case.problem)[0] + (1.0 + self.r) * case.problem.strength
        self.pieces: list[Piece] = []
        self.evaluations = 0

    def run(self) -> None:
        self.pieces, self.evaluations = [], 0
        u, t = self.problem.initial_slip, 0.0
        apart = self.R if self.r == -1.0 else 0.5 * self.R  # a driver that gives way breaks the load at h/c, and echoes repeat that
        for end in (apart * n for n in range(1, round(self.duration / apart) + 1)):
            load = self.load_between(t, end)
            while t < end:
                t, u = self.stretch(t, end, u, load)

    def load_between(self, start: float, end: float) -> Function:
        """beta(t): known in the first round trip, and then from the pieces of the one before."""
        slope = self.body.impedance * self.problem.pull_rate / (0.5 * self.R)
        if end <= self.R and (self.r == -1.0 or end <= 0.5 * self.R):
            return lambda t: self.problem.load + slope * t
        if end <= self.R:
            return lambda t: self.r * (slope * (self.R - t) - self.problem.load) + self.steady
        tail = [piece for piece in self.pieces if piece[1] > start - self.R and piece[0] < end - self.R]
        ends = [piece[1] for piece in tail]

        def echo(t: float) -> float:
            _, _, _, rate, load = tail[min(int(np.searchsorted(ends, t - self.R)), len(tail) - 1)]
            return self.r * (2.0 * self.Z * rate(t - self.R) - load(t - self.R)) + self.steady

        return echo

    def stretch(self, start: float, end: float, u: float, load: Function) -> tuple[float, float]:
        """Slip or rest from `start` to `end` or to what ends it; returns time and slip there."""
        strength = self.S * float(self.law.static_coefficient(u))
        excess = load(start) - strength
        if abs(excess) <= 1e-12 * strength:  # released at the very edge: does the load rise?
            excess = load(end) - load(start)
        if excess <= 0.0:
            return self.rest(start, end, u, load, strength)
        if isinstance(self.law, HyperbolicRate):
            return self.slip_by_rate(start, end, u, load)
        return self.slip_by_slip(start, end, u, load)

    def rest(self, start: float, end: float, u: float, load: Function, strength: float) -> tuple[float, float]:
        def onset(t: float, _: Floats) -> float:
            return strength - load(t)

        end = self.solve(lambda t, y: np.zeros(1), start, end, [u], onset).t[-1]
        self.pieces.append((start, end, lambda t: u, lambda t: 0.0, load))
        return end, u

    def slip_by_slip(self, start: float, end: float, u: float, load: Function) -> tuple[float, float]:
        """Z v = beta - S mu(u)."""
        law, S, Z = self.law, self.S, self.Z
        assert isinstance(law, SinusoidalSlip)

        def rate(t: float, u: float) -> float:
            return (load(t) - S * (law.mean + law.amplitude * math.sin(law.wavenumber * u))) / Z

        run = self.solve(lambda t, y: [rate(t, y[0])], start, end, [u], lambda t, y: rate(t, y[0]))
        slip = run.sol
        self.pieces.append((start, run.t[-1], lambda t: slip(t)[0], lambda t: rate(t, slip(t)[0]), load))
        return run.t[-1], run.y[0, -1]

    def slip_by_rate(self, start: float, end: float, u: float, load: Function) -> tuple[float, float]:
        """Z v + S mu(v) = beta, differentiated: (Z + S mu') dv/dt = dbeta/dt, known in the first round trip."""
        law, S, Z = self.law, self.S, self.Z
        assert isinstance(law, HyperbolicRate)
        if start > 0.0:
            raise UnavailableError("scipy_peer: slip under a rate law after the first round trip")
        slope, drop = (load(end) - load(start)) / (end - start), S * (law.static - law.dynamic)
        # from rest at beta = S muS the fast root of the contact equation is v = (q^2 - 1) / alpha
        v = (law.alpha * drop / Z - 1.0) / law.alpha

        def motion(t: float, y: Floats) -> list[float]:
            return [y[1], slope / (Z - drop * law.alpha / (1.0 + law.alpha * y[1]) ** 2)]

        run = self.solve(motion, start, end, [u, v], lambda t, y: y[1])
        slip = run.sol
        self.pieces.append((start, run.t[-1], lambda t: slip(t)[0], lambda t: slip(t)[1], load))
        return run.t[-1], run.y[0, -1]

    def solve(self, motion, start: float, end: float, y: list[float], event):  # type: ignore[no-untyped-def]
        """One call of solve_ivp with a terminal event where a function falls through zero."""
        event.terminal, event.direction = True, -1.0
        run = solve_ivp(
            motion, (start, end), y, "DOP853", dense_output=True, events=event, rtol=self.tolerance, atol=1e-3 * self.tolerance
        )
        self.evaluations += len(run.t) - 1
        return run

    def slip(self, times: Floats) -> Floats:
        """Slip since the start, m."""
        ends = [piece[1] for piece in self.pieces]
        where = np.minimum(np.searchsorted(ends, times), len(ends) - 1)
        return np.array([self.pieces[n][2](t) for n, t in zip(where, times, strict=True)]) - self.problem.initial_slip


def block(case: Case, tolerance: float) -> Runner:
    """m dv/dt = K (D0 + V t - u) - S mu(u), up to the first v = 0."""
    body, law, problem = case.problem.body, case.problem.friction, case.problem
    assert isinstance(law, SinusoidalSlip)
    assert not isinstance(body, ElasticSlab)
    u0 = problem.initial_slip
    outcome = []

    def motion(t: float, y: Floats) -> list[float]:
        force = problem.load + body.stiffness * (problem.pull_rate * t - (y[0] - u0))
        return [y[1], (force - body.normal_force * (law.mean + law.amplitude * math.sin(law.wavenumber * y[0]))) / body.mass]

    def arrest(t: float, y: Floats) -> float:
        return float(y[1])

    arrest.terminal, arrest.direction = True, -1.0  # type: ignore[attr-defined]

    def run() -> None:
        span, start = (0.0, case.duration), [u0, 0.0]
        outcome[:] = [
            solve_ivp(motion, span, start, "DOP853", dense_output=True, events=arrest, rtol=tolerance, atol=1e-3 * tolerance)
        ]

    def slip(times: Floats) -> Floats:
        return np.array(outcome[0].sol(np.minimum(times, outcome[0].t[-1]))[0] - u0)

    return Runner(case, tolerance, run, slip, lambda: len(outcome[0].t) - 1, lambda: float(outcome[0].t[-1]))


def runner(case: Case, tolerance: float) -> Runner:
    """The problem in scipy."""
    if not isinstance(case.problem.body, ElasticSlab):
        return block(case, tolerance)
    slab = Slab(case, tolerance)
    return Runner(case, tolerance, slab.run, slab.slip, lambda: slab.evaluations)
