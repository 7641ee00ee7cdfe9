"""Resume a run where it stopped: the result is the same, bit for bit, as without the stop."""

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
    """Continue the run in a file that `simulate`, `save` or Ctrl-C left.

    The result is the same, bit for bit, as if the run had never stopped, and as if it had had this duration from the start.

    Parameters
    ----------
    path : str or Path
        File of the run (.nc).
    duration : float, optional
        New end of the run, s from its start; the previous one by default.
    events : int, optional
        Number of slip events, counted from the start of the run, after which it stops. By default the previous number, unless the
        run has already reached it.
    progress, checkpoint_every, max_pieces
        See `simulate`.
    checkpoint : str or Path, optional
        File for checkpoints and, at the end, the solution; `path` by default.

    Returns
    -------
    Solution
        The whole run, from t = 0.

    Raises
    ------
    InputError
        If the file holds no solution or no state of the engine, if another version of the engine's code has made it, if
        `duration` lies before the time that the run has reached, or if the run has already had the wanted number of events.
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
    """Return the run in a file, ready to continue. Raises InputError if it could not continue bit for bit up to `duration` (s)."""
    checkpoint = stopped.checkpoint
    if checkpoint is None:
        raise InputError(f"{path}: cannot be resumed: it does not hold where the engine stood; run it again from the start")
    if checkpoint.engine != engine():
        raise InputError(
            f"{path}: cannot be resumed: another version of stickslip's engine made it ({checkpoint.engine}, this is {engine()}),"
            " which would go on in other digits; run it again from the start"
        )
    check_checkpoint(stopped, path)
    run = RunInProgress.at_checkpoint(stopped.history, checkpoint, stopped.rtol, stopped.creep_rtol, stopped.shortest_event)
    reached = float(stopped.history.end[run.length - 1])
    if duration is not None and duration < reached:
        raise InputError(f"{path}: the run has already reached {reached:.9g} s: a duration of {duration:.9g} s lies before that")
    return run


def events_wanted(stopped: Solution, events: int | None) -> int | None:
    """Return the number of events after which to stop: if none is given, the previous one, unless the run has reached it."""
    had_them = stopped.status == STATUSES[ENOUGH_EVENTS]
    return events if events is not None or had_them else stopped.events_wanted


def events_in(run: RunInProgress) -> int:
    """Return the number of events that are over in the history of a run."""
    stream = EventStream(run.problem, default_event_rate(run.problem), float(run.setup.par.ramp))
    return len(stream.look(run.store, run.length).known_by)


def check_events(path: Path, wanted: int, had: int) -> None:
    """Refuse to stop after a number of events that the run has already had. Raises InputError."""
    if wanted <= had:
        raise InputError(f"{path}: the run has had {had} events already: it cannot stop after {wanted}")
