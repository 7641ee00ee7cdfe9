"""How long a run can be predicted: what the echoes of a slab under rate weakening make of a rounding error.

A disturbance of the load returns after each round trip. At rest it is passed on as it is, times r. On a slipping branch of a law
of slip rate it returns multiplied by r (1 - 2 Z / g'(v)), which is larger than 1 where friction falls: 1.49 at alpha = 1, 4e5 at
alpha_c + 1e-6 at the rates to which the slab of the paper's Figs 6 and 7 jumps (Campillo et al. 1996). Event after event that
multiplies, phase of the round trip by phase: beyond a horizon single events mean nothing, and only their statistics do.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip import YEAR
from stickslip.bodies import ElasticSlab
from stickslip.contact.resistance import Resistance, resistance
from stickslip.contact.uniqueness import uniqueness
from stickslip.errors import InputError
from stickslip.evolution.moving_branches import folds_move, is_algebraic
from stickslip.evolution.setup import SAFETY
from stickslip.problem import Problem

if TYPE_CHECKING:
    from stickslip.evolution.solution import Solution

Floats = NDArray[np.float64]

LOST = 0.1
"""Of what makes an event another one: a disturbance this large ends the horizon."""


@dataclass(frozen=True)
class Predictability:
    """What `predictability` found.

    `time` (s) and `amplification` (times): for each piece of the history where it starts, and what has become there of a
    disturbance of the load, 1 at the start of the run. `error` is the size of the first disturbance (Pa) that tolerance and
    rounding make, `scale` (Pa) the change of the load that makes other events: the width of the window of several slip rates, or
    where there is none what friction changes. `horizon` (s): from when on the one has grown to a tenth of the other; inf if it
    does not in this run.
    """

    time: Floats
    amplification: Floats
    error: float
    scale: float
    horizon: float

    @property
    def largest(self) -> float:
        """The largest amplification anywhere in the run."""
        return float(self.amplification.max(initial=1.0))

    @property
    def exponent(self) -> float:
        """ln(largest) over the time (s) at which it was reached: an estimate of the largest Lyapunov exponent, in 1/s."""
        reached = float(self.time[int(np.argmax(self.amplification))]) if len(self.time) else 0.0
        return math.log(self.largest) / reached if reached > 0.0 else 0.0

    @property
    def text(self) -> str:
        """One line for people."""
        grown = f"echoes multiply an error of the load by up to {self.largest:.3g}"
        if math.isinf(self.horizon):
            return f"{grown}; single events are predictable throughout"
        when = f"{self.horizon / YEAR:.6g} years" if self.horizon > 0.5 * YEAR else f"{self.horizon:.6g} s"
        return f"{grown}; predictable up to {when}, beyond it only statistics are"


def predictability(solution: Solution) -> Predictability:
    """How far disturbances have grown along a run of a slab without contact mass under a law of slip rate.

    Raises InputError for any other problem: there slip, inertia or a state decide what becomes of a disturbance.
    """
    problem, body = solution.problem, solution.problem.body
    if not isinstance(body, ElasticSlab) or not is_algebraic(problem) or folds_move(problem):
        raise InputError("predictability: needs a slab without contact mass under a law of slip rate only")
    history = solution.history
    row, theta, factors = history.store.row, history.store.theta_from, _factors(solution, resistance(problem))
    back = theta >= 0.5 * history.row_time  # in the first round trip the start itself comes back from the driver there
    grown = np.abs(_along(row, theta, factors, np.where((row == 0) & back, abs(body.reflection), 1.0)))
    error = _first_error(solution, body)
    scale = _scale(problem)
    lost = np.flatnonzero(grown * error > LOST * scale)
    horizon = float(history.start[lost[0]]) if lost.size else math.inf
    return Predictability(history.start, grown, error, scale, horizon)


def _factors(solution: Solution, g: Resistance) -> Floats:
    """What a disturbance in the middle of each piece is multiplied by when it returns."""
    store, body = solution.history.store, solution.problem.body
    assert isinstance(body, ElasticSlab)
    half = 0.5 ** np.arange(store.rate.shape[1])
    slips = store.mode != 0
    factors = np.full(len(store.whole), body.reflection)
    factors[slips] *= 2.0 * body.impedance / g.slope(np.abs(store.rate[slips] @ half)) - 1.0
    factors[~slips] *= -1.0
    return factors


def _along(row: NDArray[np.int64], theta: Floats, factors: Floats, first: Floats) -> Floats:
    """Products of the factors from round trip to round trip: each piece lies within one piece of the row before."""
    grown = first
    starts = np.append(np.flatnonzero(np.diff(row, prepend=-1)), len(row))
    for before, begin, end in zip(starts[:-2], starts[1:-1], starts[2:], strict=True):
        source = before + np.searchsorted(theta[before:begin], theta[begin:end], side="right") - 1
        grown[begin:end] = grown[source] * factors[source]
    return grown


def _first_error(solution: Solution, body: ElasticSlab) -> float:
    """What rounding makes of the load (kept as a difference from the strength), or the tolerance of the waves 2 Z v, in Pa."""
    store = solution.history.store
    waves = 2.0 * body.impedance * float(np.abs(store.rate[:, 0]).max())
    return max(waves * solution.rtol * SAFETY, float(np.finfo(float).eps * np.abs(store.load[:, 0]).max()))


def _scale(problem: Problem) -> float:
    """The change of the load (Pa) that makes other events."""
    window = uniqueness(problem).window
    return window[1] - window[0] if window and window[1] > window[0] else problem.normal * problem.friction.variation
