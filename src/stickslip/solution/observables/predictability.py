"""Predictability of a run: how the echoes of a slab under rate weakening amplify a rounding error.

A disturbance of the load returns after each round trip. At rest it returns multiplied by r, the driver's reflection coefficient.
On a slipping branch of a law of slip rate it returns multiplied by r (1 - 2 Z / g'(v)). Where friction falls with slip rate the
bracket is larger than 1 in size: 1.49 at alpha = 1, 4e5 at alpha_c + 1e-6, at the rates to which the slab of the paper's Figs 6
and 7 jumps (Campillo et al. 1996). These factors multiply from event to event, separately at each phase of the round trip. Beyond
a horizon single events mean nothing; only their statistics do.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from stickslip.engine import History
from stickslip.engine.input import SHARE_OF_TOLERANCE, is_algebraic
from stickslip.foundation.arguments import NamesAttributes, for_users, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import YEAR
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief_repr
from stickslip.problem import Problem

if TYPE_CHECKING:
    import pandas as pd

LOST = 0.1
"""A disturbance of this share of the waves that slip sends out changes an event into another one: it ends the horizon."""

TELLING = 10.0
"""A run whose errors have grown more than so many times (1) tells their rate."""


@dataclass(frozen=True)
class Predictability(NamesAttributes):
    """The result of `predictability`, at the start times (s) of pieces of the history, or of slip events.

    `amplification` is the size there of a disturbance of the load that is 1 at the start of the run; NaN if it is not known.
    `error` is the first disturbance that tolerance and rounding make, as a share of the waves 2 Z v that slip sends out.
    """

    time: Floats
    amplification: Floats
    error: float

    __repr__ = brief_repr

    @property
    def horizon(self) -> float:
        """The time (s) when single events cease to mean anything; inf if there is none in this run.

        The disturbance then exceeds a tenth of the waves that slip sends out for the first time.
        """
        lost = np.flatnonzero(self.amplification * self.error > LOST)
        return float(self.time[lost[0]]) if lost.size else math.inf

    @property
    def largest(self) -> float:
        """The largest amplification in the run."""
        return float(np.nanmax(self.amplification, initial=1.0))

    @property
    def exponent(self) -> float:
        """An estimate of the largest Lyapunov exponent, 1/s: ln(largest) divided by the time of the largest amplification."""
        if not self.largest > 1.0:
            return 0.0
        reached = float(self.time[int(np.nanargmax(self.amplification))])
        return math.log(self.largest) / reached if reached > 0.0 else math.inf

    @property
    def expected_horizon(self) -> float:
        """About when (s) the horizon ends; beyond the run by the mean rate in it if errors have grown ten times, else inf."""
        if not math.isinf(self.horizon) or not self.largest > TELLING or not 0.0 < self.error < LOST:
            return self.horizon
        return float(self.time[-1]) * math.log(LOST / self.error) / math.log(self.largest)

    @property
    def short(self) -> str:
        """How long single events are predictable, in a few words."""
        if math.isinf(self.horizon):
            return "throughout"
        return f"up to {_shown(self.horizon, 6)}"

    @property
    def text(self) -> str:
        """The result as one line of text."""
        grown = f"echoes multiply an error of the load by up to {self.largest:.3g}"
        if math.isinf(self.horizon):
            beyond = self.expected_horizon
            more = "" if math.isinf(beyond) else f", and up to about {_shown(beyond, 3)} if errors go on to grow as in this run"
            return f"{grown}; single events are predictable throughout{more}"
        return f"{grown}; predictable {self.short}, beyond it only statistics are"


def _shown(time: float, digits: int) -> str:
    return f"{time / YEAR:.{digits}g} years" if time > 0.5 * YEAR else f"{time:.{digits}g} s"


def in_short(proven: str, trapped: str, predictable: str) -> str:
    """Return what is proven of a run, trapped in its waves and predictable, each in a few words, as one line.

    Each is a few words; an empty one is left out. `trapped` may be a longer note; the first part of it is taken.
    """
    parts = {"proven": proven, "trapped energy": trapped.partition(" in waves")[0], "predictability": predictable}
    return "; ".join(f"{what}: {words}" for what, words in parts.items() if words)


class PredictedRun(Protocol):
    """A run, as far as its predictability is concerned: its history and its relative tolerance."""

    @property
    def history(self) -> History:
        """The history of the run."""
        ...

    @property
    def rtol(self) -> float:
        """The relative tolerance."""
        ...


@for_users
def predictability(run: PredictedRun) -> Predictability:
    """Return how far disturbances have grown along a run of a slab without contact mass, under a law of slip rate only.

    Raises InputError for any other problem: there, slip, inertia or a state variable decide how a disturbance grows.
    """
    if not isinstance(getattr(run, "history", None), History):
        raise InputError(f"predictability: needs a Solution, got {shown(run)}")
    history, problem, body, store = run.history, run.history.problem, run.history.problem.body, run.history.store
    if not is_followed(problem):
        lone = "without masses or an integral gain, whose driver does not change"
        raise InputError(f"predictability: needs a slab {lone}, under a law of slip rate only")
    waves = 2.0 * body.impedance * float(np.abs(store.rate[:, 0]).max())
    # the load is stored as a difference from the strength, so only this difference is rounded
    rounding = float(np.finfo(float).eps * np.abs(store.load[:, 0]).max())
    error = max(run.rtol * SHARE_OF_TOLERANCE, rounding / waves if waves > 0.0 else 0.0)
    return Predictability(history.start, store.amplified, error)


def predictability_of_events(events: pd.DataFrame, rtol: float) -> Predictability:
    """Return the predictability from the column "amplification" of a catalogue and from the tolerance `rtol` of its run."""
    error = max(rtol * SHARE_OF_TOLERANCE, float(np.finfo(float).eps))
    return Predictability(events.start.to_numpy(float), events.amplification.to_numpy(float), error)


def attributes_of(prediction: Predictability | None) -> dict[str, str | float]:
    """Return what files store of it: the line of text, the horizon (s) and the exponent (1/s)."""
    if prediction is None:
        return {}
    return {"predictability": prediction.text, "horizon": prediction.horizon, "lyapunov_exponent": prediction.exponent}


def is_followed(problem: Problem) -> bool:
    """Return True if the growth of a disturbance is known for this problem."""
    lone = problem.body.is_uniform and not (problem.body.has_machine or problem.body.is_damped or problem.driver_changes)
    return is_algebraic(problem) and lone and not problem.folds_move
