"""What is asked of each kind of body: the cycles it refuses, one near a run, the path of a branch, and how disturbances grow."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS, LoadingHistory, Problem
from stickslip.run.study import MAX_PIECES

if TYPE_CHECKING:
    from stickslip.engine import History
    from stickslip.extensions.cycles.exponent import MeasuredGrowth
    from stickslip.extensions.cycles.found import FoundCycle
    from stickslip.problem.scenarios import ParameterPath, Scenario
    from stickslip.run import TextProgress


class CycleKind(ABC):
    """The questions to a kind of body."""

    most_pieces: int = MAX_PIECES
    """Largest number of pieces of history (1) of the run at whose end a cycle is looked for."""
    may_be_cut: bool = False
    """True if that run may end when it has them."""
    may_be_held: bool = False
    """True if a body moves in cycles whose pull rate is 0, too."""

    @abstractmethod
    def refusal(self, problem: Problem) -> str:
        """Return why no cycle of a problem is looked for, in words; empty if there is no reason."""

    def settled(self, problem: Problem, times: tuple[float, float], rtol: float, tell: TextProgress) -> FoundCycle | None:
        """Return the cycle to which a run settles early; None if it takes long.

        `times` (s) are that before the motion begins, and that of the first part of the run behind it.
        """
        return None

    @abstractmethod
    def near_end(self, history: History, problem: Problem, rtol: float) -> FoundCycle:
        """Return the cycle near the end of a run. Raises InputError if there is none."""

    @abstractmethod
    def path(self, orbit: Any, scenario: Scenario, parameter: ParameterPath, span: float) -> Any:
        """Return the path of a cycle along a number of its scenario, over a span (SI) of it."""

    @abstractmethod
    def growth(self, problem: Problem, rtol: float) -> Callable[..., MeasuredGrowth]:
        """Return how disturbances of a run are followed: by an equation for them where there is one, else by two runs."""


def not_steady(problem: Problem) -> str:
    """Return in words what varies so that nothing repeats itself, or what is remembered for ever; empty if nothing does."""
    law = problem.friction
    if any(one is not None for one in (problem.ground_velocity, problem.ground_acceleration, problem.force, problem.normal_load)):
        return "what pulls and presses must be steady: there is moving ground, a force, or a normal load that varies"
    if isinstance(problem.pull_rate, LoadingHistory):
        return "the pull rate must be a number, and it varies in time"
    if law.depends_on_slip and (law.memory == "all" or law.states):
        return f"under {type(law).__name__} friction changes with slip, so that no motion with a net slip repeats itself"
    return ""


CYCLE_KINDS: ByKind[CycleKind] = ByKind("stickslip.extensions.cycles.kinds", BODY_KINDS)
"""What each kind of body answers."""
