"""Resume a run where it stopped: the result is the same, bit for bit, as without the stop."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.foundation.errors import InputError
from stickslip.io.netcdf import is_catalogue, open_solution
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

if TYPE_CHECKING:
    import pandas as pd


def resume(
    path: str | Path,
    duration: float | None = None,
    *,
    max_events: int | None = None,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
) -> Solution | pd.DataFrame:
    """Continue a run or a catalogue where its file left it.

    The result is the same, bit for bit, as if the run had never stopped, and as if it had had this duration from the start.

    Parameters
    ----------
    path : str or Path
        File of a run (.nc) that `simulate`, `Solution.to_netcdf` or Ctrl-C left, or a catalogue's NAME.checkpoint.nc, with the
        catalogue's rows in the same folder.
    duration : float, optional
        New end of the run, s from its start; the previous one by default.
    max_events : int, optional
        Number of slip events, counted from the start of the run, after which it stops. By default the previous number, unless the
        run has already reached it.
    progress, checkpoint_every, max_pieces
        See `simulate`, for a catalogue `catalogue`.
    checkpoint : str or Path, optional
        File for checkpoints and, at the end, the solution; `path` by default. A catalogue keeps its own file.

    Returns
    -------
    Solution or pandas.DataFrame
        The whole run from t = 0, or the whole table of a catalogue.

    Raises
    ------
    InputError
        If the file holds no run or no state of the engine, if another version of the engine's code has made it, if `duration` lies
        before the time that the run has reached, or if the run has already had the wanted number of events. For a catalogue also if
        rows are missing, have been changed, or are behind a symbolic link, or if `checkpoint` is given.

    Notes
    -----
    Rows of a catalogue that were written after its checkpoint are cut off and computed again.
    """
    path = Path(path)
    if not is_catalogue(path):
        kept = path if checkpoint is None else Path(checkpoint)
        return resume_run(path, duration, max_events, progress, kept, checkpoint_every, max_pieces)
    from stickslip.run.catalogue import Paused

    if checkpoint is not None:
        raise InputError(f"resume: {path}: a catalogue is resumed in its own file: leave checkpoint away")
    return Paused.read(path).go_on(duration, max_events, progress, checkpoint_every, max_pieces).read()


def resume_run(
    path: Path,
    duration: float | None,
    max_events: int | None,
    progress: Progress | None,
    checkpoint: Path,
    checkpoint_every: float = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
) -> Solution:
    """Continue the run in a file: see `resume`."""
    stopped = open_solution(path)
    wanted = events_wanted(stopped, max_events)
    run = taken_up(stopped, path, duration)
    orders = Orders(
        stopped.duration if duration is None else duration,
        wanted,
        progress,
        checkpoint,
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


def events_wanted(stopped: Solution, max_events: int | None) -> int | None:
    """Return the number of events after which to stop: if none is given, the previous one, unless the run has reached it."""
    had_them = stopped.status == STATUSES[ENOUGH_EVENTS]
    return max_events if max_events is not None or had_them else stopped.max_events


def events_in(run: RunInProgress) -> int:
    """Return the number of events that are over in the history of a run."""
    stream = EventStream(run.problem, default_event_rate(run.problem), float(run.setup.par.ramp))
    return len(stream.look(run.store, run.length).known_by)


def check_events(path: Path, wanted: int, had: int) -> None:
    """Refuse to stop after a number of events that the run has already had. Raises InputError."""
    if wanted <= had:
        raise InputError(f"{path}: the run has had {had} events already: it cannot stop after {wanted}")
