"""Take up a run where it stopped: nobody can tell from the result that it did."""

from __future__ import annotations

from pathlib import Path

from stickslip.foundation.errors import InputError
from stickslip.io.netcdf import load
from stickslip.io.soundness import check_checkpoint
from stickslip.run.monitor import CHECKPOINT_EVERY, Orders
from stickslip.run.progress import Progress
from stickslip.run.session import RunInProgress
from stickslip.run.simulate import check_run, go_on
from stickslip.solution.solution import Solution
from stickslip.trajectory.checkpoint import engine
from stickslip.trajectory.event_stream import EventStream
from stickslip.trajectory.status import ENOUGH_EVENTS, STATUSES
from stickslip.trajectory.tables import default_event_rate


def resume(
    path: str | Path,
    duration: float | None = None,
    *,
    events: int | None = None,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
) -> Solution:
    """Go on with the run in a file that `simulate`, `save` or Ctrl-C left, up to `duration` (s from the start; default: as before).

    The result is the same, bit for bit, as if the run had never stopped, and as if it had had this duration from the start. The
    file stays the run's checkpoint, and holds the solution at the end; `checkpoint` names another one. For the other arguments
    see `simulate`; `events` count from the start of the run.
    Raises InputError for a file that is no solution, one that another version of the code has made, and a duration before the
    time to which the run has come.
    """
    path = Path(path)
    stopped = load(path)
    wanted = events_wanted(stopped, events)
    run = taken_up(stopped, path, duration)
    orders = Orders(
        stopped.duration if duration is None else duration,
        wanted,
        progress,
        path if checkpoint is None else Path(checkpoint),
        checkpoint_every,
        max_pieces,
    )
    check_run("resume", orders.duration, stopped.rtol, wanted, checkpoint_every)
    if wanted is not None:
        check_events(path, wanted, events_in(run))
    return go_on(run, orders)


def taken_up(stopped: Solution, path: Path, duration: float | None) -> RunInProgress:
    """The run in a file, ready to go on. Raises InputError where it could not go on as it was."""
    checkpoint = stopped.checkpoint
    if checkpoint is None:
        raise InputError(f"{path}: cannot be taken up: it does not hold where the engine stood; run it again from the start")
    if checkpoint.engine != engine():
        raise InputError(
            f"{path}: cannot be taken up: another version of stickslip's engine made it ({checkpoint.engine}, this is {engine()}),"
            " which would go on in other digits; run it again from the start"
        )
    check_checkpoint(stopped, path)
    run = RunInProgress.at_checkpoint(stopped.history, checkpoint, stopped.rtol, stopped.creep_rtol, stopped.shortest_event)
    reached = float(stopped.history.end[run.length - 1])
    if duration is not None and duration < reached:
        raise InputError(f"{path}: the run has come to {reached:.9g} s already: a duration of {duration:.9g} s lies before that")
    return run


def events_wanted(stopped: Solution, events: int | None) -> int | None:
    """Events after which to stop: as before if nothing is said, but if the run has had them it goes on without."""
    had_them = stopped.status == STATUSES[ENOUGH_EVENTS]
    return events if events is not None or had_them else stopped.events_wanted


def events_in(run: RunInProgress) -> int:
    """Events that are over in the history of a run."""
    stream = EventStream(run.problem, default_event_rate(run.problem), float(run.setup.par.ramp))
    return len(stream.look(run.store, run.length).known_by)


def check_events(path: Path, wanted: int, had: int) -> None:
    """Refuse to stop after events that are long over. Raises InputError."""
    if wanted <= had:
        raise InputError(f"{path}: the run has had {had} events already: it cannot stop after {wanted}")
