"""The truth of a case, from scipy: a path that meets every feature, and whether double precision decides it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from tests.core.run.adversarial.cases import Case
from tests.core.run.adversarial.walk import Floats, Path, Place, walk

SAMPLES = 9
DISTURBANCE, DECIDED = 1e-12, 1e-8
"""A case is left out where a load changed by DISTURBANCE of the normal load moves slip or end by more than DECIDED of itself."""


@dataclass(frozen=True)
class Truth:
    """Slips (m) and slip rates (m/s) at times (s) up to the first arrest, and when that comes (None: not before the end)."""

    times: NDArray[np.float64]
    slips: NDArray[np.float64]
    rates: NDArray[np.float64]
    end: float | None

    @property
    def total(self) -> float:
        """Slip up to the last time, m."""
        return float(self.slips[-1])


def load_of(case: Case) -> Callable[[float], float]:
    """Load on a slab's contact minus the static strength: right within a round trip, or for ever under a matched driver."""
    problem, slab = case.problem, case.problem.body
    assert isinstance(slab, ss.ElasticSlab)
    ramp, excess = slab.stiffness * float(problem.first_pull_rate), problem.excess
    flat = 0.5 * slab.two_way_time if math.isfinite(slab.driver_impedance) else math.inf
    return lambda t: excess + ramp * min(t, flat)


def truth_of(case: Case) -> Truth:
    """The truth of a case."""
    body = case.problem.body
    massless = isinstance(body, ss.ElasticSlab) and body.contact_mass == 0.0
    if massless:
        return _sampled(case, *(_lagged_slab(case) if case.lag else _slip_slab(case)))
    return _sampled(case, *_with_mass(case))


def is_decided(case: Case, truth: Truth) -> bool:
    """Return False where rounding decides: see DISTURBANCE."""
    other = truth_of(case.with_excess(DISTURBANCE))
    if (truth.end is None) != (other.end is None):
        return False
    if truth.end is not None and other.end is not None and abs(other.end / truth.end - 1.0) > DECIDED:
        return False
    return abs(other.total / truth.total - 1.0) <= DECIDED


def _sampled(case: Case, path: Path, rate: Callable[[float, Floats], float]) -> Truth:
    end = path.end if path.stopped else None
    times = np.linspace(0.0, path.end, SAMPLES + 1)[1:]
    states = [path(t) for t in times.tolist()]
    rates = [rate(t, y) for t, y in zip(times.tolist(), states, strict=True)]
    return Truth(times, np.array([y[0] for y in states]), np.array(rates), end)


def _places(case: Case, slip: Callable[[float, Floats], float], rate: Callable[[float, Floats], float]) -> list[Place]:
    """Features of the law, and the beginnings of tails."""
    return [
        Place(slip if f.variable == "u" else rate, 0.0 if f.shape == "tail" else f.centre, f.detail) for f in case.recipe.features
    ]


def _slip(t: float, y: Floats) -> float:
    return float(y[0])


def _second(t: float, y: Floats) -> float:
    return float(y[1])


def _slip_slab(case: Case) -> tuple[Path, Callable[[float, Floats], float]]:
    """Z v = load - S mu(u)."""
    load, normal, mu, body = load_of(case), case.problem.normal, case.mu, case.problem.body
    assert isinstance(body, ss.ElasticSlab)
    impedance, rest = body.impedance, mu(0.0, 0.0)

    def rate(t: float, y: Floats) -> float:
        return (load(t) - normal * (mu(float(y[0]), 0.0) - rest)) / impedance

    path = _through_breaks(case, lambda t, y: [rate(t, y)], [0.0], _places(case, _slip, rate), [case.slip], rate)
    return path, rate


def _lagged_slab(case: Case) -> tuple[Path, Callable[[float, Floats], float]]:
    """Z v = load - S mu(w), lag dw/dt = v - w."""
    load, normal, mu, body = load_of(case), case.problem.normal, case.mu, case.problem.body
    assert isinstance(body, ss.ElasticSlab)
    impedance, rest = body.impedance, mu(0.0, 0.0)

    def rate(t: float, y: Floats) -> float:
        return (load(t) - normal * (mu(0.0, float(y[1])) - rest)) / impedance

    def right(t: float, y: Floats) -> Sequence[float]:
        v = rate(t, y)
        return [v, (v - y[1]) / case.lag]

    path = _through_breaks(case, right, [0.0, 0.0], _places(case, _slip, _second), [case.slip, case.rate], rate)
    return path, rate


def _with_mass(case: Case) -> tuple[Path, Callable[[float, Floats], float]]:
    """m dv/dt = load - damping v - S mu(u, v); with a lag mu(w)."""
    problem, body, normal, mu = case.problem, case.problem.body, case.problem.normal, case.mu
    rest, lag = mu(0.0, 0.0), case.lag
    pull = float(problem.first_pull_rate)
    if isinstance(body, ss.ElasticSlab):
        slab_load, mass, damping = load_of(case), body.contact_mass, body.impedance

        def load(t: float, u: float) -> float:
            return slab_load(t)
    else:
        mass, damping, stiffness, excess = body.mass, body.damping, body.stiffness, problem.excess

        def load(t: float, u: float) -> float:
            return excess + stiffness * (pull * t - u)

    def right(t: float, y: Floats) -> Sequence[float]:
        u, v, w = float(y[0]), float(y[1]), float(y[-1])
        force = load(t, u) - damping * v - normal * (mu(u, w) - rest)
        return [v, force / mass, (v - w) / lag] if lag else [v, force / mass]

    state, scale = [0.0] * (3 if lag else 2), [case.slip, case.rate, case.rate][: 3 if lag else 2]
    seen = (lambda t, y: float(y[2])) if lag else _second
    return _through_breaks(case, right, state, _places(case, _slip, seen), scale, _second), _second


def _through_breaks(
    case: Case,
    right: Callable[[float, Floats], Sequence[float]],
    state: list[float],
    places: list[Place],
    scale: list[float],
    rate: Callable[[float, Floats], float],
) -> Path:
    """Walk to the first arrest or the end, stopping where the load of a matched slab bends."""
    body, whole = case.problem.body, Path()
    breaks = [case.duration]
    if isinstance(body, ss.ElasticSlab) and math.isfinite(body.driver_impedance):
        breaks = [0.5 * body.two_way_time, case.duration]
    start = 0.0
    for end in breaks:
        part = walk(right, start, state, end, places, scale, rate)
        whole.ends += part.ends
        whole.pieces += part.pieces
        whole.stopped = part.stopped
        if part.stopped:
            break
        start, state = end, part(end).tolist()
    return whole
