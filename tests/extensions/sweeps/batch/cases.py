"""Scenarios with what is varied in them, and what a batch folds, worked out from one Solution at a time."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

import stickslip as ss
from stickslip.engine.lanes.vectorised_problem import Values, member
from stickslip.problem.scenarios.scenario import Scenario
from stickslip.solution.solution import Solution

MEMBERS = 8
PULL = 0.05 / ss.YEAR
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
HYPERBOLIC = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
COLUMNS_OF_FIRST = ("start", "end", "duration", "slip", "traction_drop", "static_drop")


@dataclass(frozen=True)
class Case:
    """A scenario, and between which numbers each key is drawn; a negative low end stands for powers of ten."""

    scenario: Scenario
    keys: dict[str, tuple[float, float]]

    def values(self, members: int = MEMBERS, seed: int = 1) -> Values:
        """Numbers of random members."""
        random = np.random.default_rng(seed)
        return {key: random.uniform(*ends, members) for key, ends in self.keys.items()}


def case(body: object, law: object, duration: float, keys: dict[str, tuple[float, float]], **start: object) -> Case:
    """A case; it starts at the static strength if nothing else is said."""
    start = {"pull_rate": PULL, **start}
    if "initial_load" not in start:
        start.setdefault("initial_excess", 0.0)
    return Case(Scenario(ss.Problem(body, law, **start), duration), keys)  # type: ignore[arg-type]


_f = ss.friction
CASES = {
    "rate": case(SLAB, HYPERBOLIC, 30.0, {"friction.alpha": (0.05, 2.0), "body.thickness": (1e3, 2e4)}),
    "rate minimal": case(
        SLAB, HYPERBOLIC, 30.0, {"friction.alpha": (0.05, 2.0), "body.density": (2e3, 3e3)}, selection="minimal", initial_load=8.1e7
    ),
    "rate maximal": case(SLAB, HYPERBOLIC, 12.0, {"friction.alpha": (0.05, 2.0)}, selection="maximal"),
    "years": case(SLAB, HYPERBOLIC, 1000 * ss.YEAR, {"friction.alpha": (0.5, 2.0)}),
    "driver": case(
        SLAB,
        HYPERBOLIC,
        30.0,
        {"body.driver_impedance": (0.0, 2e7), "friction.static": (0.5, 0.9)},
        pull_rate=2.6,
        initial_load=6e7,
    ),
    "far stress": case(
        replace(SLAB, driver_impedance=5e6),
        HYPERBOLIC,
        60.0,
        {"loading.far_stress_rate": (-1e5, 1e6), "friction.dynamic": (0.2, 0.5)},
        pull_rate=0.1,
        initial_load=7e7,
    ),
    "slip": case(
        SLAB,
        _f.SinusoidalSlip(1.0, 0.5, 50.0),
        6.0,
        {"friction.wavenumber": (40.0, 60.0), "initial.slip": (math.pi / 100, math.pi / 100 + 2e-3)},
        initial_load=1.5e8 + 3430.0,
    ),
    "slip block": case(
        BLOCK,
        _f.SinusoidalSlip(1.0, 0.5, 5.0),
        40.0,
        {"friction.wavenumber": (4.5, 6.0), "initial.excess": (-1e10, 1e11)},
        initial_slip=0.3416860906,
        initial_excess=3.43e10,
    ),
    "linear": case(
        SLAB, _f.LinearSlipWeakening(0.677, 0.525, 0.4), 30.0, {"friction.distance": (1e-3, 0.4), "initial.slip": (0.0, 0.2)}
    ),
    "linear block": case(
        BLOCK,
        _f.LinearSlipWeakening(0.677, 0.525, 0.4),
        60.0,
        {"friction.distance": (0.01, 1.4), "initial.slip": (-0.2, 0.2)},
        pull_rate=1e-3,
    ),
    "power of slip": case(
        SLAB,
        _f.PowerSlipWeakening(0.6, 0.4, 0.2, 0.4),
        60.0,
        {"friction.distance": (0.05, 1.0), "friction.exponent": (0.3, 2.5)},
        pull_rate=0.01,
    ),
    "parabolic": case(
        SLAB,
        _f.ParabolicSlipWeakening(0.6, 0.4, 0.4),
        60.0,
        {"friction.onset": (0.0, 0.1), "friction.distance": (0.2, 1.4)},
        pull_rate=0.01,
    ),
    "cohesive zone": case(
        SLAB,
        _f.ExponentialCohesiveZone(0.6, 0.4, 0.2),
        60.0,
        {"friction.offset": (0.1, 0.3), "friction.distance": (0.01, 0.4)},
        pull_rate=0.01,
    ),
    "exponential": case(BLOCK, _f.ExponentialSlipWeakening(0.7, 0.2, 0.5), 60.0, {"friction.static": (0.3, 0.8)}, pull_rate=0.01),
    "carlson-langer": case(
        BLOCK, _f.CarlsonLanger(0.6, 0.05, 0.5), 60.0, {"friction.drop": (0.0, 0.2), "friction.rate": (0.1, 2.0)}, pull_rate=0.01
    ),
    "coulomb": case(
        SLAB, _f.Coulomb(0.6, 0.5), 60.0, {"friction.static": (0.5, 0.8), "body.wave_speed": (2e3, 4e3)}, pull_rate=0.01
    ),
    "coulomb block": case(
        BLOCK,
        _f.Coulomb(0.6, 0.5),
        2e3,
        {"friction.static": (0.5, 0.8), "body.mass": (1e12, 3e12), "body.damping": (0.0, 1e11)},
        pull_rate=0.01,
    ),
    "stribeck": case(SLAB, _f.ExponentialStribeck(0.6, 0.4, 0.1), 30.0, {"friction.rate": (1e-3, 1.0)}, initial_load=6.1e7),
    "gauss": case(SLAB, _f.ExponentialStribeck(0.6, 0.4, 0.1, 2.0), 30.0, {"friction.rate": (1e-3, 5.0)}, initial_load=6.1e7),
    "power": case(SLAB, _f.PowerStribeck(0.6, 0.4, 0.1, 2.0), 30.0, {"friction.rate": (1e-3, 5.0)}, initial_load=6.1e7),
    "mass": case(replace(SLAB, contact_mass=1e6), HYPERBOLIC, 30.0, {"body.contact_mass": (1e3, 1e8)}),
    "string": case(
        ss.TorsionalString(1770.0, 7850.0, 61e9, outer_diameter=0.147, inner_diameter=0.123, weight_on_bit=1e5, bit_radius=0.15),
        HYPERBOLIC,
        20.0,
        {"body.weight_on_bit": (1e4, 1e5), "body.outer_diameter": (0.13, 0.16), "friction.alpha": (0.01, 0.1)},
        pull_rate=6.0,
    ),
    "string with collars": case(
        ss.TorsionalString(1770.0, 7850.0, 61e9, polar_moment=2.28e-5, normal_torque=15e3, inertia=305.0),
        _f.ExponentialStribeck(0.8, 0.5, 1.1),
        20.0,
        {"body.normal_torque": (1e4, 2e4), "body.inertia": (100.0, 500.0)},
        pull_rate=6.0,
        initial_load=0.0,
    ),
    "disc": case(
        ss.RotatingBlock(305.0, 800.0, 15e3, damping=5.0),
        _f.ExponentialStribeck(0.8, 0.5, 1.1),
        20.0,
        {"body.stiffness": (400.0, 900.0), "loading.pull_rate": (1.0, 12.0)},
        pull_rate=6.0,
        initial_load=0.0,
    ),
    "rate block": case(
        BLOCK,
        HYPERBOLIC,
        1e3,
        {"friction.alpha": (0.05, 2.0), "run.duration": (0.1, 1e3), "run.rtol": (1e-12, 1e-6)},
        pull_rate=0.01,
    ),
}


def one(case: Case, values: Values, n: int) -> Scenario:
    """A member by itself."""
    return member(case.scenario, {key: float(value[n]) for key, value in values.items()})


def sticking(solution: Solution) -> float:
    """The share of the last third of a run in which the slip rate is 0, from the mode between neighbouring breaks."""
    history, end = solution.history, solution.history.duration
    edges = np.union1d([2.0 / 3.0 * end, end], history.breaks)
    edges = edges[(edges >= 2.0 / 3.0 * end) & (edges <= end)]
    rests = history.mode(history.find(0.5 * (edges[:-1] + edges[1:]), "right")) == 0
    return float(np.sum(np.diff(edges)[rests]) / (end - 2.0 / 3.0 * end))


def by_solution(solution: Solution) -> dict[str, float]:
    """What a batch folds, from the tables of a solution."""
    events, history = solution.events, solution.history
    end = history.find(np.array([history.duration]), "right")
    found = {
        "events": len(events),
        "pulses": events.pulses.sum(),
        "shocks": len(solution.shocks),
        "slip": history.slipped(end)[0],
        "recurrence": events.recurrence.mean(),
        "recurrence_cv": events.recurrence.std() / events.recurrence.mean(),
        "end_time": history.duration,
        "arrested": history.mode(end)[0] == 0,
        "sticking": sticking(solution) if solution.status.ok else math.nan,
    }
    first = {f"first_{name}": events[name].iloc[0] if len(events) else math.nan for name in COLUMNS_OF_FIRST}
    fastest = events.loc[events.peak_rate.idxmax()] if len(events) else {"peak_rate": math.nan, "peak_time": math.nan}
    contact = ss.uniqueness(solution.problem)
    of_contact = {"irregular": contact.regime == "irregular", "branches": max(len(contact.branches), 1)}
    peak = {name: fastest[name] for name in ("peak_rate", "peak_time")}
    return {name: float(value) for name, value in (found | first | peak | of_contact).items()}
