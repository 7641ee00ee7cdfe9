"""Continue a run or a catalogue where it stopped: the result is the same, bit for bit, as without the stop."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self, Unpack

from stickslip.engine import Reach, check_checkpoint, engine_key
from stickslip.foundation.arguments import as_path
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.memory import chosen_memory
from stickslip.foundation.takes import takes
from stickslip.run.catalogue import Catalogue, alone_with, checkpoint_of, follow
from stickslip.run.exact_run import ExactRun
from stickslip.run.kinds import no_results, reader_of
from stickslip.run.options import CallOptions
from stickslip.run.progress import reporting
from stickslip.run.run_loop import WholeHistory, run_to_end
from stickslip.run.words import WORDS, GivenToContinue
from stickslip.solution import Solution
from stickslip.solution.files import CATALOGUE, Rows, check_catalogue, check_place, is_catalogue, read, read_solution, to_solution
from stickslip.solution.observables import EventStream, HistoryPlace


@takes(WORDS, GivenToContinue, "checkpoint")
def resume(
    path: str | Path,
    duration: float | str | WithUnit | None = None,
    *,
    checkpoint: str | Path | None = None,
    **options: Unpack[GivenToContinue],
) -> Any:
    """Continue a run or a catalogue where its file left it.

    The result is the same, bit for bit, as if the run had never stopped, and as if it had had this duration from the start.

    Parameters
    ----------
    path : str or Path
        File of a run (.nc) that `simulate`, `Solution.to_netcdf` or Ctrl-C left, or a catalogue's NAME.checkpoint.nc, with the
        catalogue's rows in the same folder; the file of a run of a `MovedContact`; or the folder (.zarr) of that of a `PlanarSlab`
        or a `Chain`.
    duration : float or str, optional
        New end of the run, counted from its start: a number in s, or a text with a unit. The previous one by default.
    {options}

    Returns
    -------
    Solution, FrictionAlongMotion, PlanarSolution or pandas.DataFrame
        The whole run from t = 0, or the whole table of a catalogue.

    Raises
    ------
    InputError
        If the file holds no run or no state of the engine, if another version of the engine's code has made it, if `duration` lies
        before the time that the run has reached, or if the run has already had the wanted number of events. For a catalogue also if
        rows are missing, have been changed, or are behind a symbolic link, or if `checkpoint` is given. For a `PlanarSlab` also if
        `max_events`, `checkpoint` or `max_pieces` is given, or if `duration` is more than the run is prepared for: up to the next
        power of two of two-way travel times, and none but its own without replicas.

    Notes
    -----
    `checkpoint` is `path` by default; a catalogue, and a folder, keep their own name. Slip events are counted from the start of the
    run, up to the previous number by default unless the run has reached it. A run that ended with "too many pieces" goes on only
    with a larger max_pieces, or where memory was short, with more memory.

    Rows of a catalogue that were written after its checkpoint are cut off and computed again.
    """
    file = as_path("resume: path", path)
    progress = options.pop("progress", None)
    if (reader := reader_of(file)) is not None:
        with reporting(progress, "resume") as report:
            return reader.resume(file, duration, progress=report, checkpoint=checkpoint, **options)
    if file.is_dir():
        raise no_results(file)
    paused = PausedCatalogue.read(file) if is_catalogue(file) else None
    if paused is not None and checkpoint is not None:
        raise InputError(f"resume: {file}: a catalogue is resumed in its own file: leave out checkpoint")
    stopped = read_solution(file) if paused is None else paused.stopped
    kept = file if checkpoint is None else as_path("resume: checkpoint", checkpoint)
    with reporting(progress, "resume") as report:
        to_go_on = CallOptions.to_continue(stopped, duration, checkpoint=kept, progress=report, **options)
        return resume_run(stopped, file, to_go_on) if paused is None else paused.resume(to_go_on).read()


def resume_run(stopped: Solution, path: Path, options: CallOptions) -> Solution:
    """Continue a run that was read from a file. Raises InputError as `resume` does."""
    with options.alone():
        run = taken_up(stopped, path, options)
        if run.options.max_events is not None:
            check_events(path, run.options.max_events, events_in(run))
        return run_to_end(run, WholeHistory(run))


@dataclass(frozen=True)
class PausedCatalogue:
    """The state of a catalogue's run, as read from its checkpoint."""

    path: Path
    stopped: Solution
    about: Mapping[str, Any]

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a checkpoint. Raises InputError for a file that is not the checkpoint of a catalogue."""
        tables = read(path, CATALOGUE)
        stopped = to_solution(tables, path)
        try:
            return cls(path, stopped, check_place(tables.attrs, path))
        except (KeyError, TypeError) as error:
            raise InputError(f"{path}: not a file that stickslip has written: {error} is missing or wrong") from None

    @property
    def rows(self) -> Rows:
        """The rows, in a file beside the checkpoint and named after it.

        Raises InputError if that is another file, or a symbolic link.
        """
        found = Rows(self.path.parent / self.about["catalogue"])
        if checkpoint_of(found).name != self.path.name:
            raise InputError(f"{self.path}: not the checkpoint of {found.path.name}, whose name is {checkpoint_of(found).name}")
        for path in {found.path, found.growing}:
            if path.is_symlink():
                raise InputError(f"{path}: is a link: a catalogue is resumed in the file itself")
        return found

    def resume(self, options: CallOptions) -> Catalogue:
        """Continue the run to its end. Raises InputError as `stickslip.resume` does."""
        about, rows = self.about, self.rows
        run = taken_up(self.stopped, self.path, options)
        if run.options.max_events is not None:
            check_events(self.path, run.options.max_events, int(about["told"]))
        check_catalogue(rows.path)
        run.forgotten = about["forgotten"]
        start = HistoryPlace(about["last_piece"], about["last_xi"])
        run.stream = EventStream(about["event_rate"], about["first"], start, about["told"], bool(about["energies"]))
        with alone_with(rows):
            rows.take_up(about["told"], about["bytes"], about["digest"])
            return follow(run, rows, Reach(0.0, about["displaced"], about["displaced_at"]))


def taken_up(stopped: Solution, path: Path, options: CallOptions) -> ExactRun:
    """Return the run in a file, ready to continue. Raises InputError if it could not continue bit for bit with these options."""
    chosen_memory()  # refused now, and not when the history has grown further
    options = options.check("resume", stopped.problem)
    checkpoint = stopped.checkpoint
    if checkpoint is None:
        raise InputError(f"{path}: cannot be resumed: it does not hold the state of the engine; run it again from the start")
    if checkpoint.engine != engine_key():
        raise InputError(
            f"{path}: cannot be resumed: another version of stickslip's engine made it ({checkpoint.engine}, this is"
            f" {engine_key()}), which would go on in other digits; run it again from the start"
        )
    check_checkpoint(checkpoint, stopped.history, path, rtol=stopped.rtol, shortest_event=stopped.shortest_event)
    run = ExactRun.at_checkpoint(stopped.history, checkpoint, options)
    reached = float(stopped.history.end[run.length - 1])
    if options.duration != stopped.asked_duration and options.duration < reached:
        wanted = f"a duration of {options.duration:.9g} s lies before that"
        raise InputError(f"{path}: the run has already reached {reached:.9g} s: {wanted}")
    return run


def events_in(run: ExactRun) -> int:
    """Return the number of events that are over in the history of a run."""
    return len(run.stream.look(run.history()).known_by)


def check_events(path: Path, wanted: int, had: int) -> None:
    """Refuse to stop after a number of events that the run has already had. Raises InputError."""
    if wanted <= had:
        raise InputError(f"{path}: the run has had {had} events already: it cannot stop after {wanted}")
