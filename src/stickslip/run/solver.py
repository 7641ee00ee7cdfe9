"""The protocol of a solver, as progress, Ctrl-C, checkpoints and counts of events need it.

`ExactRun` (`run/exact_run.py`) is the exact solver of one contact, `PlanarRun` (`extensions/planar/run.py`) that of a contact of
many nodes. `run_to_end` (`run/run_loop.py`) runs either, and whatever else implements the protocol.
"""

from __future__ import annotations

from typing import Protocol, TypeVar

from stickslip.run.options import CallOptions
from stickslip.run.progress import Pace


class NewEvents(Protocol):
    """Slip events that have become final since the last ones were reported."""

    def tell(self) -> None:
        """Mark the events as reported."""


New_co = TypeVar("New_co", bound=NewEvents, covariant=True)
Result_co = TypeVar("Result_co", covariant=True)


class Solver(Protocol[New_co, Result_co]):
    """A run in progress. Its state is consistent between any two calls."""

    options: CallOptions

    @property
    def length(self) -> int:
        """The number of pieces, or steps, since the start of the history."""

    @property
    def can_be_saved(self) -> bool:
        """True if `save` may be called now."""

    @property
    def has_enough(self) -> bool:
        """True if as many events have been reported as the options ask for."""

    def advance(self, budget: int) -> int:
        """Advance by at most `budget` steps, or by work that takes as long, towards the end of the run, `options.duration`.

        Return a code: Stop.NONE if the steps are used up, Stop.END_AHEAD if the next call takes the run to its end, Stop.FULL if
        the history has no more room, or the code of the run's end, a key of `problem.run_status.STATUSES`.
        """

    def grow(self) -> bool:
        """Make room for more history. Return False if it has as many pieces as the options allow, or if memory is short."""

    def new_events(self) -> New_co | None:
        """Return the events that are new, or None if this solver counts none.

        If this completes the number of events that the options ask for, the run goes back to the step that makes the last of them
        final.
        """

    def report(self, pace: Pace) -> object:
        """Return the progress of the run, whose text is one line for people."""

    def save(self) -> None:
        """Write a checkpoint, if a file for it was given."""

    def finish(self, code: int) -> Result_co:
        """Return what has been computed, with the status that belongs to a code, and write it if a file for it was given."""
