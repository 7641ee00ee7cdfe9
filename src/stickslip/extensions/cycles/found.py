"""What every kind of body answers of a cycle that has been found, and of the run that closes it."""

from __future__ import annotations

from typing import Any, Protocol

from numpy.typing import NDArray

from stickslip.engine import History
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem
from stickslip.solution import Solution


class ClosedRun(Protocol):
    """A run from a section to its return there."""

    @property
    def history(self) -> History:
        """The history."""

    @property
    def first(self) -> int:
        """The first piece of it that belongs to the cycle."""

    @property
    def begin(self) -> float:
        """When the cycle begins in it (s)."""

    @property
    def piece(self) -> int:
        """The piece where the cycle ends."""

    @property
    def place(self) -> float:
        """The place (1) in that piece."""


class FoundCycle(Protocol):
    """A cycle: a run from a section that comes back to where it started."""

    @property
    def closed(self) -> Any:
        """The run, a `ClosedRun` with what else a kind of body keeps of it."""

    @property
    def section(self) -> Any:
        """The section, with its problem and tolerance."""

    @property
    def place(self) -> Floats:
        """Where it meets the section."""

    @property
    def extent(self) -> Floats:
        """How far what may vary on the section goes in a period."""

    @property
    def period(self) -> float:
        """The period (s)."""

    @property
    def sticks(self) -> bool:
        """True if the contact rests once in a period."""

    @property
    def grazes(self) -> bool:
        """True if the contact rests for an instant only, and what follows depends on the sign of a disturbance."""

    @property
    def forgets_all(self) -> bool:
        """True if each rest ends all disturbances."""

    @property
    def is_kept(self) -> bool:
        """True if tables keep where it starts, so that branches go on from there, and to cycles of twice the period."""

    @property
    def is_of_half(self) -> bool:
        """True if it is back where it began after half of its period already."""

    @property
    def multipliers(self) -> NDArray[Any]:
        """What a period multiplies disturbances by (1), the largest first."""

    @property
    def certainty(self) -> str:
        """What is known of the error of the period, in one sentence."""

    def problem_on_it(self, problem: Problem) -> Problem:
        """Return the problem that starts on the cycle, if the numbers of a problem can say so."""

    def run_of_it(self) -> Solution:
        """Return the run of one period."""


def kind_of(motion: Any) -> tuple[bool, int, tuple[int, ...], int]:
    """Return what cycles, or returns, have in common that change smoothly.

    That is whether they rest, and how often they meet a hard stop, begin to slip and to rest, and go round before they end.
    """
    counts = getattr(motion, "slips", ())
    return motion.sticks, getattr(motion, "impacts", 0), tuple(counts), getattr(motion, "rounds", 1)


def is_of_kind(new: FoundCycle, now: FoundCycle, *, exactly: bool) -> bool:
    """Return True if a cycle may be next to another one on a branch.

    A wave that passes the pull rate is no edge, but over a longer step it may be another cycle; `exactly` forbids it. The cycle
    of twice a period ends in one that goes round twice.
    """
    same_passages = getattr(new.closed, "passed", 1) == getattr(now.closed, "passed", 1)
    (*kind, rounds), (*kind_now, rounds_now) = kind_of(new), kind_of(now)
    halved = rounds == 2 and rounds_now == 1 and same_passages
    return kind == kind_now and (rounds == rounds_now or halved) and (same_passages or not exactly)
