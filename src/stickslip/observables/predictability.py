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
from stickslip.engine_input.branch_table import folds_move, is_algebraic
from stickslip.engine_input.prepare import SAFETY
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem

if TYPE_CHECKING:
    import pandas as pd

    from stickslip.solution.solution import Solution

Floats = NDArray[np.float64]

LOST = 0.1
"""A disturbance of so large a share of the waves that an event sends out makes it another one: it ends the horizon."""


@dataclass(frozen=True)
class Predictability:
    """What `predictability` found.

    `time` (s) and `amplification` (times): where pieces of the history, or slip events, start, and what has become there of a
    disturbance of the load, 1 at the start of the run. `error` is the first disturbance that tolerance and rounding make, as a
    share of the waves 2 Z v that slip sends out. `horizon` (s): from when on it has grown to a tenth of them; inf if it does not.
    """

    time: Floats
    amplification: Floats
    error: float

    @property
    def horizon(self) -> float:
        """When single events stop to mean anything, s; inf if they do not in this run."""
        lost = np.flatnonzero(self.amplification * self.error > LOST)
        return float(self.time[lost[0]]) if lost.size else math.inf

    @property
    def largest(self) -> float:
        """The largest amplification anywhere in the run."""
        return float(np.nanmax(self.amplification, initial=1.0))

    @property
    def exponent(self) -> float:
        """ln(largest) over the time (s) at which it was reached: an estimate of the largest Lyapunov exponent, in 1/s."""
        if not self.largest > 1.0:
            return 0.0
        reached = float(self.time[int(np.nanargmax(self.amplification))])
        return math.log(self.largest) / reached if reached > 0.0 else math.inf

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
    problem, body, store = solution.problem, solution.problem.body, solution.history.store
    if not is_followed(problem):
        raise InputError("predictability: needs a slab without contact mass under a law of slip rate only")
    assert isinstance(body, ElasticSlab)
    waves = 2.0 * body.impedance * float(np.abs(store.rate[:, 0]).max())
    rounding = float(np.finfo(float).eps * np.abs(store.load[:, 0]).max())  # of the load, kept as a difference from the strength
    error = max(solution.rtol * SAFETY, rounding / waves if waves > 0.0 else 0.0)
    return Predictability(solution.history.start, store.amplified, error)


def predictability_of_events(events: pd.DataFrame, rtol: float) -> Predictability:
    """The same of a catalogue, from its column "amplification", and of the tolerance `rtol` of the run that gave it."""
    error = max(rtol * SAFETY, float(np.finfo(float).eps))
    return Predictability(events.start.to_numpy(float), events.amplification.to_numpy(float), error)


def attributes_of(prediction: Predictability | None) -> dict[str, str | float]:
    """What files say of it: the line for people, the horizon (s) and the exponent (1/s)."""
    if prediction is None:
        return {}
    return {"predictability": prediction.text, "horizon": prediction.horizon, "lyapunov_exponent": prediction.exponent}


def is_followed(problem: Problem) -> bool:
    """Whether it is known what becomes of a disturbance."""
    return isinstance(problem.body, ElasticSlab) and is_algebraic(problem) and not folds_move(problem)
