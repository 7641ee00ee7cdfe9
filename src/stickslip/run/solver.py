"""What a run asks of its solver: the protocol that progress, Ctrl-C, checkpoints and counts of events are written for.

`Session` (`run/session.py`) is the exact solver of one contact. Another solver, of another body or by another method, implements
the same protocol and is run by `run_to_end` (`run/monitor.py`).
"""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

from stickslip.run.options import RunOptions

Result_co = TypeVar("Result_co", covariant=True)


class NewEvents(Protocol):
    """Slip events that have become final since the last ones were reported."""

    @property
    def known_by(self) -> Any:
        """For each event, the length of the history, less one, from which on it is final; rising."""

    def first_ones(self, count: int) -> NewEvents:
        """Return the first few of these events."""

    def tell(self) -> None:
        """Mark the events as reported."""


class Events(Protocol):
    """The slip events of a run, each reported once."""

    @property
    def threshold(self) -> float:
        """The slip rate above which the contact is in an event, m/s."""

    @property
    def told(self) -> int:
        """The number of events that have been reported."""

    def look(self, history: Any) -> NewEvents:
        """Return the events that are new in the history of a run (`Solver.history`)."""


class Solver(Protocol[Result_co]):
    """A run in progress. Its state is consistent between any two calls."""

    options: RunOptions

    @property
    def time(self) -> float:
        """The simulated time, s."""

    @property
    def length(self) -> int:
        """The number of pieces, or steps, that the history has."""

    @property
    def forgotten(self) -> int:
        """The number of pieces that have been discarded from the history."""

    @property
    def fastest(self) -> float:
        """The largest |slip rate| on the contact, m/s; exactly 0 while it sticks everywhere."""

    def advance(self, budget: int) -> int:
        """Advance by at most `budget` steps towards the end of the run, `options.duration`.

        Return a code: Stop.NONE if the steps are used up, Stop.END_AHEAD if the next call takes the run to its end, Stop.FULL if
        the history has no more room, or the code of what ended the run, a key of `trajectory.status.STATUSES`.
        """

    def grow(self, most: int) -> bool:
        """Make room for more history. Return False if it already has `most` pieces, or if memory is short."""

    def snapshot(self) -> Any:
        """Return a copy of the state, without the history."""

    def restore(self, snapshot: Any) -> None:
        """Go back to an earlier state, whose history is still held."""

    def history(self) -> Any:
        """Return the history so far, for `events`, with at least one piece."""

    def events(self, event_rate: float | None = None) -> Events:
        """Return the slip events from the start of the history, with the slip rate (m/s) that defines them, if it is given."""

    def solution(self, code: int) -> Result_co:
        """Return what has been computed so far, with the status that belongs to a code."""
