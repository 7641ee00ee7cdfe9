"""The paper's rate law along a fault, where a lag regularises it: crack or pulse, several pulses, what is left of the shocks.

The rate law alone is ill-posed along a contact. Here friction follows the slip rate with a lag, mu(w) with lag dw/dt = v - w. The
slab is that of the paper's Fig. 6; a nucleus in the middle is loaded above its strength, and all else to a lower background.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip.extensions.paper.cases import problem, typed
from stickslip.extensions.paper.planar import peaks
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem
from stickslip.problem.bodies import as_slab

if TYPE_CHECKING:
    from stickslip.extensions.planar import PlanarSolution

LAG = 0.2
"""The lag of most runs (s): slip travels 700 m in it."""
OVERLOAD = 81e6
"""Load of the nucleus (Pa); the static strength is 80 MPa."""
SLIPS = 0.01
"""Slip rate (m/s) above which slip has arrived at a node."""
STATIONS = (0.0, 8e3, 16e3, 24e3)
"""Places (m) where pulses are counted."""
SLOWER_THAN_UNIFORM = {"line": 0.5 * math.pi, "plane": 2.0}
"""A crack whose ends run at c slips in its middle as if the impedance were larger by this factor, in 2D and, if it is round, in 3D.

Both follow from slip of the form A sqrt(c^2 t^2 - r^2), whose traction is uniform: pi/2 Z A c in 2D, and 2 Z A c in 3D.
"""
STORED = Path(__file__).with_name("rate-law-faults.csv")
"""The study of faults under the rate law, made by docs/rate_law_faults.py."""
SHOWN_LOADS = (60.0, 70.0, 75.0)
"""Background loads (MPa) of the stored slip rates."""
CURVES = STORED.with_name("rate-law-curves.csv")
"""Slip rates 16 km from the middle, of the runs with these loads."""


def largest_load_of_pulses(factor: float = 1.0) -> float:
    """Return the largest load (Pa) that allows no steady slip rate behind a front.

    Parameters
    ----------
    factor
        The impedance over that of uniform slip. With 1 this is the lower fold of the paper's set K, where Zheng & Rice 1998 end the
        loads for which no crack exists (their tau_pulse); with `SLOWER_THAN_UNIFORM` it is that for the middle of a crack at c.
    """
    case = problem("fig6-slab")
    law, impedance = typed(case.friction, ss.friction.HyperbolicRate), factor * case.body.impedance
    root = math.sqrt(law.alpha * case.normal * (law.static - law.dynamic) / impedance)
    return law.dynamic * case.normal + impedance / law.alpha * (2.0 * root - 1.0)


def lag_of_time(lag: float) -> ss.friction.FrictionLaw:
    """Return the rate law with a lag (s): friction mu(w) with lag dw/dt = v - w."""
    return ss.friction.LaggedFriction(problem("fig6-slab").friction, time=lag)


def lag_of_slip(distance: float) -> ss.friction.FrictionLaw:
    """Return the rate law with a state that slip renews within a distance (m): friction mu(w) with distance dw/dt = v (v - w)."""
    law = typed(problem("fig6-slab").friction, ss.friction.HyperbolicRate)
    steady = f"{law.dynamic} + {law.static - law.dynamic}/(1 + alpha*w)"
    units = {"alpha": f"{law.alpha} s/m", "distance": f"{distance} m"}
    return ss.friction.FromExpression(steady, units, evolution="dw/dt = v*(v - w)/distance", state_unit="m/s")


def flash(distance: float) -> ss.friction.FrictionLaw:
    """Return flash heating of the range of the rate law, whose state slip renews within a distance (m)."""
    law = typed(problem("fig6-slab").friction, ss.friction.HyperbolicRate)
    fast = {"weakened": law.dynamic, "weakening_rate": 1.0 / law.alpha}
    return ss.friction.FlashHeating(law.static, 0.01, b=0.014, distance=distance, **fast)


LAWS: dict[str, tuple[Callable[[float], ss.friction.FrictionLaw], float]] = {
    "lag": (lag_of_time, 0.0),
    "distance": (lag_of_slip, 0.0),
    "flash-heating": (flash, 0.8),
}
"""For each law of `LaggedFault` the function that makes it from its time (s) or distance (m), and the state at the start."""


@dataclass(frozen=True)
class LaggedFault:
    """A fault under the rate law with a lag.

    Parameters
    ----------
    background
        Load outside of the nucleus, Pa.
    lag
        Lag of friction behind the slip rate, s; of other laws the distance of their state, m.
    nodes
        Nodes along y, and on a plane as many along z.
    length
        Length of the fault, m, after which it repeats.
    nucleus
        Half the length of the nucleus, or its radius, m.
    shape
        "line" (2D) or "plane" (3D).
    reflects
        True if a rigid driver sends waves back from 10 km, False if waves leave for ever.
    ends
        Half the length of a fault (m) that is alone and locked beyond; infinite for one that repeats after `length`.
    law
        A name of `LAWS`.
    overload
        Load of the nucleus, Pa.
    """

    background: float
    lag: float = LAG
    nodes: int = 1024
    length: float = 120e3
    nucleus: float = 5e3
    shape: str = "line"
    reflects: bool = False
    ends: float = math.inf
    law: str = "lag"
    overload: float = OVERLOAD

    @property
    def problem(self) -> Problem:
        """The problem of each node."""
        made, state = LAWS[self.law]
        slab = as_slab(problem("fig6-slab").body)
        if not self.reflects:
            slab = replace(slab, driver_impedance=slab.impedance)
        return ss.Problem(slab, made(self.lag), initial_load=self.background, initial_state=state)

    @property
    def slab(self) -> ss.PlanarSlab:
        """The contact on a grid."""
        spacing = self.length / self.nodes

        def load(y: Floats, z: Floats | float = 0.0) -> Floats:
            """Return the load; a node at the edge of the nucleus has the mean of its cell, or slip would converge unevenly."""
            inside = np.clip(0.5 + (self.nucleus - np.hypot(y, z)) / spacing, 0.0, 1.0)
            return np.asarray(self.background + inside * (self.overload - self.background), float)

        def outside(y: Floats, z: Floats | float = 0.0) -> NDArray[np.bool_]:
            return np.hypot(y, z) > self.ends

        more: dict[str, Any] = {"width": self.length, "width_nodes": self.nodes} if self.shape == "plane" else {}
        if math.isfinite(self.ends):
            more |= {"barrier": outside, "replicas": False}
        return ss.PlanarSlab(self.problem, self.nodes, self.length, along={"initial.load": load}, **more)


def at(run: PlanarSolution, place: float, values: Any) -> Floats:
    """Return values of a run, time first, at the node next to a place along y (m), in the middle of a plane."""
    return np.asarray(run.middle_line(values)[:, int(np.argmin(np.abs(run.slab.y - place)))])


def slips_between(times: Floats, rate: Floats, resting: float = 0.0) -> tuple[float, float]:
    """Return when slip arrives (s), at SLIPS, and when it is first not above a rate of rest (m/s) thereafter; NaN for never."""
    fast = np.flatnonzero(rate > SLIPS)
    if not len(fast):
        return math.nan, math.nan
    rests = np.flatnonzero((rate <= resting) & (np.arange(len(rate)) > fast[0]))
    return float(times[fast[0]]), float(times[rests[0]]) if len(rests) else math.nan


def rate_of_rest(run: PlanarSolution) -> float:
    """Return the slip rate (m/s) of nodes at rest: 0 under a lag, and SLIPS under other states, which creep."""
    return 0.0 if isinstance(run.slab.problem.friction, ss.friction.LaggedFriction) else SLIPS


def mode_of(run: PlanarSolution) -> str:
    """Return how slip spreads: "crack" (the middle never rests), "pulse", or "several pulses" (of one station)."""
    counts = [len(peaks(run.times, at(run, place, run.slip_rate))) for place in STATIONS]
    if math.isnan(slips_between(run.times, at(run, 0.0, run.slip_rate), rate_of_rest(run))[1]):
        return "crack"
    return "several pulses" if max(counts) > 1 else "pulse"


def fall_at_front(times: Floats, traction: Floats) -> tuple[float, float]:
    """Return when friction has fallen by half behind a front (s), and how long (s) it takes from 90 to 10 % of its fall."""
    start, end = int(np.argmax(traction)), int(np.argmin(traction))
    share = (traction[start : end + 1] - traction[end]) / (traction[start] - traction[end])
    passed = [float(np.interp(-level, -np.minimum.accumulate(share), times[start : end + 1])) for level in (0.9, 0.5, 0.1)]
    return passed[1], passed[2] - passed[0]


def stored() -> list[dict[str, str]]:
    """Return the rows of the stored study."""
    with STORED.open(newline="") as file:
        return list(csv.DictReader(file))


def numbers(rows: list[dict[str, str]], column: str) -> NDArray[np.float64]:
    """Return a column as numbers; NaN where a row has none."""
    return np.array([row[column] or "nan" for row in rows], float)
