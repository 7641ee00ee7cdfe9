"""Problems of every kind, and what their runs give: a script, with names of some, that a test runs without a compiler."""

from __future__ import annotations

import json
import sys

import stickslip as ss

F = ss.friction
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
FINITE = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=3e6)
HEAVY = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=1e6)
THIN = ss.ElasticSlab(2e3, 1e3, 1e3, 1e8)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
WEAKENING = F.SinusoidalSlip(mean=0.6, amplitude=0.1, wavenumber=20.0)
RATE = F.HyperbolicRate(static=0.8, dynamic=0.3, alpha=0.35)
STRIBECK = F.FromExpression("0.6 + 0.1*exp(-((v - 1)/0.3)**2)")
RUNS: dict[str, tuple[ss.Problem, float]] = {
    "slab, slip law, arrest": (ss.Problem(SLAB, WEAKENING, initial_excess=1e5), 12.0),
    "slab, rate law, echoes": (ss.Problem(SLAB, RATE, initial_excess=1e3), 30.0),
    "slab, finite driver": (ss.Problem(FINITE, WEAKENING, initial_excess=1e5, far_stress=7e7), 20.0),
    "slab, fold under a rising load": (
        ss.Problem(THIN, STRIBECK, pull_rate=2.0, initial_excess=0.0),
        6.0,
    ),
    "slab, contact with mass": (ss.Problem(HEAVY, F.LinearSlipWeakening(0.8, 0.3, 0.5), initial_excess=1e5), 12.0),
    "slab, knots in slip": (ss.Problem(SLAB, F.LinearSlipWeakening(0.8, 0.3, 0.5), initial_excess=1e5), 12.0),
    "slab, friction of slip and slip rate": (
        ss.Problem(SLAB, F.FromExpression("0.6 + 0.05*exp(-u/0.1) - 0.02*v/(1 + v)"), initial_excess=1e5),
        8.0,
    ),
    "slab, state, implicit steps": (
        ss.Problem(SLAB, F.RateAndState(0.6, 0.01, 0.015, 1e-2), pull_rate=0.5, initial_load=6.5e7, initial_state=1e6),
        6.0,
    ),
    "block, rate law": (ss.Problem(BLOCK, F.HyperbolicRate(0.8, 0.3, 0.05), initial_excess=1e11), 40.0),
    "block, tides": (
        ss.Problem(BLOCK, F.Coulomb(0.8, 0.3), pull_rate=ss.loading.Sinusoidal(1e-3, 5e-4, 7.0), initial_excess=-1e11),
        200.0,
    ),
    "block, velocity steps, state": (
        ss.Problem(
            ss.SpringBlock(1.0, 1e4, 10.0),
            F.RateAndState(0.6, 0.01, 0.015, 1e-3),
            pull_rate=ss.loading.Steps((0.0, 5.0), (1e-4, 1e-3)),
            initial_load=6.0,
            initial_state=10.0,
        ),
        10.0,
    ),
    "slab, 480 years, leaps over rest": (ss.Problem(SLAB, RATE, pull_rate=1e-9, initial_excess=0.0), 480 * ss.YEAR),
}


def results(name: str) -> dict[str, object]:
    """Return numbers that tell two runs apart: status, slips and loads at a few times, events."""
    problem, duration = RUNS[name]
    run = ss.simulate(problem, duration)
    times = [duration * share for share in (0.1, 0.3, 0.5, 0.7, 0.9, 1.0)]
    return {
        "status": run.status.name,
        "slip": run.slip(times).tolist(),
        "load": run.load(times).tolist(),
        "events": run.events[["start", "slip", "peak_rate"]].to_numpy(float).ravel().tolist(),
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps({name: results(name) for name in sys.argv[1:]}))
