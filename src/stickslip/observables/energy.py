"""Energy of a run, as differences from its start.

Per unit area of the slab (J/m^2); for the block in J. The slab's elastic and kinetic energy is that of its two travelling parts,
[(Z v + sigma)^2 + (Z v - sigma)^2] / (4 G) integrated over the thickness. The heat is computed from the law at the slip and slip
rate of the run, not from the load: so the balance tests the run, and is not an identity.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from stickslip.bodies import ElasticSlab, SpringBlock
from stickslip.evolution.history import History, Moments
from stickslip.observables.quadrature import up_to
from stickslip.observables.waves import Waves

if TYPE_CHECKING:
    from stickslip.evolution.solution import Solution

Floats = NDArray[np.float64]

LONG_NAMES = {
    "work": "work of the driver",
    "stored": "elastic and kinetic energy",
    "heat": "friction heat, from the law",
    "damped": "dissipated by the block's damping",
    "balance": "work - stored - heat - damped: zero for an exact solution",
}


def energy(solution: Solution, t: ArrayLike) -> xr.Dataset:
    """Energies at times t (s) minus their values at the start: work, stored, heat, damped, balance (slab: J/m^2, block: J).

    Work is what the driver puts in (net of what radiates through a driver of finite impedance); balance is
    work - stored - heat - damped, zero for an exact solution. Raises InputError for times outside the run, and in
    a leap over creep or within a round trip behind it, where the waves in the slab are not known.
    """
    time = np.atleast_1d(np.asarray(t, float))
    solution.history.find(time, "right")
    slab = isinstance(solution.problem.body, ElasticSlab)
    parts = _slab(solution, time) if slab else _block(solution, time)
    parts["balance"] = parts["work"] - parts["stored"] - parts["heat"] - parts["damped"]
    unit = "J m-2" if slab else "J"
    variables = {name: ("time", values, {"units": unit, "long_name": LONG_NAMES[name]}) for name, values in parts.items()}
    return xr.Dataset(variables, coords={"time": ("time", time, {"units": "s"})})


def _slab(solution: Solution, time: Floats) -> dict[str, Floats]:
    body = solution.problem.body
    assert isinstance(body, ElasticSlab)
    waves = Waves(solution.history, body)
    start, _moving = waves.stored(0.0), 0.5 * body.contact_mass * solution.slip_rate(time) ** 2
    return {
        "work": np.array([waves.work(float(t)) for t in time]),
        "stored": np.array([waves.stored(float(t)) - start for t in time])
        + 0.5 * body.contact_mass * solution.slip_rate(time) ** 2,
        "heat": heat(solution.history, time),
        "damped": np.zeros_like(time),
    }


def _block(solution: Solution, time: Floats) -> dict[str, Floats]:
    problem, history = solution.problem, solution.history
    body = problem.body
    assert isinstance(body, SpringBlock)
    at = history.find(time, "right")
    force, rate = history.excess(at), history.rate(at)
    spring = (force - problem.excess) * (force + problem.excess + 2.0 * problem.strength) / (2.0 * body.stiffness)
    slipping = np.flatnonzero(history.store.mode)
    return {
        "work": problem.pull_rate * (problem.strength * time + _pulling_force(history, time)),
        "stored": spring + 0.5 * body.mass * rate**2,
        "heat": heat(history, time),
        "damped": up_to(history, time, lambda at: body.damping * history.rate(at) ** 2, slipping),
    }


def _pulling_force(history: History, time: Floats) -> Floats:
    """Integral of the spring's force minus the reference up to each time; rests that were leaped over are trapezoids."""
    total = up_to(history, time, history.excess)
    for n in np.flatnonzero(np.diff(history.store.row) > 1):
        begin, end = float(history.end[n]), float(history.start[n + 1])
        at_rest = Moments(np.array([n]), np.ones(1), np.zeros(1), np.zeros(1, bool))
        inside = np.clip(time, begin, end) - begin
        total += inside * (float(history.excess(at_rest)[0]) + 0.5 * history.ramp / history.row_time * inside)
    return total


def heat(history: History, time: Floats) -> Floats:
    """Friction heat up to each time (s): the integral of S mu(u, |v|) |v|, from the law. Slab: J/m^2, block: J."""
    problem, law = history.problem, history.problem.friction

    def power(at: Moments) -> Floats:
        mode, speed, grown = history.store.mode[at.piece], np.abs(history.rate(at)), history.grown(at)
        walked = mode * grown if law.counts == "path" else grown
        slip = problem.law_slip + history.store.law_slip[at.piece] + walked
        return problem.normal * law.coefficient(slip, speed, history.state(at)) * speed

    return up_to(history, time, power, np.flatnonzero(history.store.mode))
