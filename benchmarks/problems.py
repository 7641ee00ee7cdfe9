"""The benchmark's problems, and what is measured on them."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip.run.simulate import simulate

Floats = NDArray[np.float64]

PULL = 0.05 / ss.YEAR
SLAB = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
BLOCK = ss.SpringBlock(mass=2.8e12, stiffness=SLAB.shear_modulus * 1e3, normal_force=1e14)
ROUND = SLAB.two_way_time


@dataclass(frozen=True)
class Case:
    """A problem to run up to `duration` (s); errors are looked at between `start` (s) and there."""

    name: str
    title: str
    problem: ss.Problem
    duration: float
    start: float = 0.0
    arrests: bool = False

    @cached_property
    def times(self) -> Floats:
        """Where slip is compared, s."""
        return np.linspace(self.start, self.duration, 1001)

    @cached_property
    def reference(self) -> Floats:
        """Slip since the start (m) at `times`: a closed form, or stickslip at its tightest tolerance (checked by the peers)."""
        if isinstance(self.problem.friction, ss.friction.HyperbolicRate):
            return slip_under_rate_law(self.problem, self.times)
        return simulate(self.problem, self.duration, 1e-15).slip(self.times) - self.problem.initial_slip

    @cached_property
    def arrest(self) -> float:
        """Time (s) at which the slip ends, nan where that is no part of the task."""
        return arrest_of(simulate(self.problem, self.duration, 1e-15)) if self.arrests else math.nan

    @cached_property
    def conditioning(self) -> float:
        """Error that one rounding of the initial load makes, by the same measure: below it, digits mean nothing to anybody."""
        nudged = dataclasses.replace(self.problem, initial_load=math.nextafter(self.problem.load, math.inf), initial_excess=None)
        slip = simulate(nudged, self.duration, 1e-15).slip(self.times) - self.problem.initial_slip
        return float(np.abs(slip - self.reference).max() / np.ptp(self.reference))

    def error(self, slip: Floats, arrest: float = math.nan) -> float:
        """Largest error of the slip over time, relative to the total slip; or that of the arrest's time, if it is larger."""
        total = np.ptp(self.reference)
        errors = [float(np.abs(slip - self.reference).max() / total)]
        if self.arrests:
            errors.append(abs(arrest / self.arrest - 1.0))
        return max(errors)


def arrest_of(solution: ss.Solution) -> float:
    """Time (s) at which the first slip ends: v = 0, whatever rate counts as an event."""
    return float(solution.catalogue(event_rate=0.0).end.iloc[0])


def slip_under_rate_law(problem: ss.Problem, times: Floats) -> Floats:
    """Slip (m) of a rigid-driver slab released at its strength under eq. (15), alpha above critical: closed form, 50 digits.

    On the fast branch u(t) is the integral of v dg / beta' with g(v) = Z v + S mu(v); the first echo arrests it.
    """
    import mpmath as mp

    body, law = problem.body, problem.friction
    assert isinstance(body, ss.ElasticSlab)
    assert isinstance(law, ss.friction.HyperbolicRate)
    with mp.workdps(50):
        Z, drop, alpha = (
            mp.mpf(body.impedance),
            mp.mpf(body.normal_stress) * (mp.mpf(law.static) - mp.mpf(law.dynamic)),
            mp.mpf(law.alpha),
        )
        slope = Z * problem.pull_rate / (mp.mpf(body.two_way_time) / 2)

        def rate(t: float) -> mp.mpf:
            # Z v (1 + alpha v) + drop = (beta - S muD) (1 + alpha v), beta - S muD = drop + slope t
            excess = drop + slope * mp.mpf(t)
            b = Z - alpha * excess
            return (-b + mp.sqrt(b * b + 4 * Z * alpha * (excess - drop))) / (2 * Z * alpha)

        def work(v: mp.mpf) -> mp.mpf:  # antiderivative of v g'(v)
            return Z * v**2 / 2 - drop / alpha * (mp.log(1 + alpha * v) + 1 / (1 + alpha * v))

        start = work(rate(0.0))
        return np.array([float((work(rate(min(t, body.two_way_time))) - start) / slope) for t in times])


def _critical_slip(block: ss.SpringBlock, law: ss.friction.SinusoidalSlip) -> float:
    """Where friction falls with slip exactly as fast as the spring unloads: S mu'(u) + K = 0."""
    steepest = block.normal_force * law.amplitude * law.wavenumber
    return math.acos(-block.stiffness / steepest) / law.wavenumber


def _sinusoidal(wavenumber: float) -> ss.friction.SinusoidalSlip:
    return ss.friction.SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=wavenumber)


TRANSIT = Case(
    "transit",
    "slab, slip law, first transit (0 to 2h/c)",
    ss.Problem(SLAB, _sinusoidal(50.0), PULL, initial_slip=math.pi / 100 + 1e-3, initial_load=1.5e8 + 3430.0),
    ROUND,
)
EVENT = Case(
    "block",
    "block, slip law, one event with its arrest",
    ss.Problem(
        BLOCK,
        _sinusoidal(5.0),
        PULL,
        initial_slip=_critical_slip(BLOCK, _sinusoidal(5.0)),
        initial_excess=BLOCK.stiffness * 1e-3,
    ),
    4.0,
    arrests=True,
)
SHOCKS = Case(
    "alpha-1",
    "slab, rate law, alpha = 1, two round trips",
    ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.3, 1.0), PULL, initial_excess=0.0),
    2.0 * ROUND,
)
DRIVEN = Case(
    "driven",
    "slab, slip law, sliding on through three echoes",
    ss.Problem(
        ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=2e7),
        ss.friction.SinusoidalSlip(mean=0.6, amplitude=0.1, wavenumber=1.0),
        3.0,
        initial_excess=1e6,
    ),
    4.0 * ROUND,
    start=ROUND,
)
CASES = (TRANSIT, EVENT, SHOCKS, DRIVEN)
