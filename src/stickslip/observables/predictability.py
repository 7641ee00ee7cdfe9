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
    grown = history.store.amplified
    error = _first_error(solution, body)
    scale = _scale(problem)
    lost = np.flatnonzero(grown * error > LOST * scale)
    horizon = float(history.start[lost[0]]) if lost.size else math.inf
    return Predictability(history.start, grown, error, scale, horizon)


def _first_error(solution: Solution, body: ElasticSlab) -> float:
    """What rounding makes of the load (kept as a difference from the strength), or the tolerance of the waves 2 Z v, in Pa."""
    store = solution.history.store
    waves = 2.0 * body.impedance * float(np.abs(store.rate[:, 0]).max())
    return max(waves * solution.rtol * SAFETY, float(np.finfo(float).eps * np.abs(store.load[:, 0]).max()))


def _scale(problem: Problem) -> float:
    """The change of the load (Pa) that makes other events."""
    window = uniqueness(problem).window
    return window[1] - window[0] if window and window[1] > window[0] else problem.normal * problem.friction.variation
