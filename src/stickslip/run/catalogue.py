"""Run a problem without keeping its whole history, and write one row for each slip event as soon as it is known."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from stickslip.engine_input.creep_limits import check_creep_rtol
from stickslip.engine_input.lumping_limits import check_shortest_event
from stickslip.foundation.atomic_write import held
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import FullDiskError, write
from stickslip.io.catalogue_rows import Rows, RowsInMemory, check_catalogue
from stickslip.io.netcdf import CATALOGUE, FORMAT, history_dataset, origin, read, to_solution
from stickslip.io.soundness import check_place
from stickslip.observables.energy.balance import trapped_note
from stickslip.observables.predictability import attributes_of, is_followed, predictability_of_events
from stickslip.problem.problem import Problem
from stickslip.run.monitor import CHECKPOINT_EVERY, Keeper, Orders, as_solution
from stickslip.run.progress import Progress
from stickslip.run.resume import check_events, events_wanted, taken_up
from stickslip.run.run_loop import drive
from stickslip.run.session import RunInProgress
from stickslip.run.simulate import check_run, check_started
from stickslip.solution.solution import Solution
from stickslip.trajectory.event_stream import EventStream, Look, Place
from stickslip.trajectory.status import ENOUGH_EVENTS, STATUSES, UNDER_WAY, Status
from stickslip.trajectory.tables import creep_note, default_event_rate

if TYPE_CHECKING:
    import pandas as pd

CAPACITY = 16_384
"""Pieces of history for which a catalogue has room at first, about 7 MB; it grows only where what must be kept fills half of it."""


def catalogue(
    problem: Problem,
    duration: float,
    path: str | Path | None = None,
    *,
    rtol: float = 1e-10,
    creep_rtol: float | None = None,
    shortest_event: float | None = None,
    events: int | None = None,
    event_rate: float | None = None,
    energies: bool = False,
    progress: Progress | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
) -> pd.DataFrame:
    """Run a problem in bounded memory and return the table of its slip events.

    History before the previous event is discarded, except waves that are still travelling in the slab.

    Parameters
    ----------
    problem : Problem
        The body, its friction law, its loading and its initial state.
    duration : float
        Latest end of the run, s.
    path : str or Path, optional
        File for the table (.csv, .parquet or .nc). NAME.checkpoint.nc beside it is renewed while the run continues, and
        `stickslip.resume_catalogue` resumes from it. Without a path the rows are kept in memory.
    rtol, creep_rtol, shortest_event, progress
        See `stickslip.simulate`.
    events : int, optional
        Number of slip events after which the run stops.
    event_rate : float, optional
        Slip rate (m/s) above which the contact is in an event. The default is 1e-6 S (range of mu)/Z; for a block sqrt(K m)
        replaces Z.
    energies : bool
        Add the energies of each event (slab: J/m^2, block: J). Automatic leaps over creep are then switched off.
    checkpoint_every : float
        Interval between two checkpoints, s of wall clock.
    max_pieces : int, optional
        Largest number of pieces of history kept at a time, a million by default. An event that needs more, together with what
        precedes it, ends the run with the status "too many pieces".

    Returns
    -------
    pandas.DataFrame
        The table of `Solution.catalogue(event_rate, energies=energies)`, with a last row for an event that the end of the run
        leaves open. Its `attrs` hold what ended the run, and notes.

    Raises
    ------
    InputError
        If an argument is out of range (see `stickslip.simulate`), the suffix of `path` is unknown, Parquet is wanted without
        pyarrow, another run writes to the same files, or `energies` is combined with a positive creep_rtol.
    """
    check_run("catalogue", duration, rtol, events, checkpoint_every)
    check_creep_rtol(problem, creep_rtol, "catalogue")
    check_shortest_event(problem, shortest_event, "catalogue")
    rate = default_event_rate(problem) if event_rate is None else event_rate
    if not rate >= 0.0:
        raise InputError(f"catalogue: event_rate must be a slip rate in m/s, got {event_rate!r}")
    if path is not None:
        check_catalogue(Path(path))
    check_energies(creep_rtol, energies, "catalogue")
    run = RunInProgress.begin(problem, rtol, leaps_with(energies, creep_rtol), shortest_event)
    orders = Orders(duration, events, progress, None, checkpoint_every, max_pieces)
    if path is not None:
        return begin(run, orders, Path(path), rate, energies).read()
    return follow(run, orders, stream_of(run, rate, energies), RowsInMemory()).read()


def leaps_with(energies: bool, creep_rtol: float | None) -> float | None:
    """Return the tolerance of leaps over creep, which is 0 (no leaps) if energies are wanted and no tolerance is given."""
    return 0.0 if energies and creep_rtol is None else creep_rtol


def check_energies(creep_rtol: float | None, energies: bool, where: str, options: str = "energies and creep_rtol") -> None:
    """Refuse energies for a run that leaps over creep. Raises InputError."""
    if energies and creep_rtol is not None and creep_rtol > 0.0:
        raise InputError(f"{where}: {options} exclude each other: what leaps over creep send into the slab is not known")


def stream_of(run: RunInProgress, event_rate: float, energies: bool) -> EventStream:
    """Return a stream of all events of a run, from its start."""
    return EventStream(run.problem, event_rate, float(run.setup.par.ramp), energies=energies)


def begin(run: RunInProgress, orders: Orders, path: Path, event_rate: float | None = None, energies: bool = False) -> Catalogue:
    """Run from the start into a file. An earlier table and checkpoint of the same names are deleted first."""
    rows = Rows(path)
    rate = default_event_rate(run.problem) if event_rate is None else event_rate
    with alone_with(rows):
        checkpoint_of(rows).unlink(missing_ok=True)
        rows.clear()
        return follow(run, orders, stream_of(run, rate, energies), rows)


def alone_with(rows: Rows) -> AbstractContextManager[None]:
    """Lock the files of a catalogue against other processes. Raises InputError if another run is writing to them."""
    return held(checkpoint_of(rows), f"{rows.path}: another run is writing its catalogue there: choose another name")


def resume_catalogue(
    checkpoint: str | Path,
    duration: float | None = None,
    *,
    events: int | None = None,
    progress: Progress | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
) -> pd.DataFrame:
    """Continue a `catalogue` from its checkpoint.

    Rows that were written after the checkpoint are cut off and computed again: the table is the same, bit for bit, as if the run
    had never stopped.

    Parameters
    ----------
    checkpoint : str or Path
        The file NAME.checkpoint.nc, with the rows in the same folder.
    duration : float, optional
        New latest end of the run, s from its start; the previous one by default.
    events : int, optional
        Number of slip events, counted from the start of the run, after which it stops.
    progress, checkpoint_every, max_pieces
        See `catalogue`.

    Returns
    -------
    pandas.DataFrame
        The whole table, as from `catalogue`.

    Raises
    ------
    InputError
        As from `stickslip.resume`, and if rows are missing, have been changed, or are behind a symbolic link.
    """
    paused = Paused.read(Path(checkpoint))
    return paused.go_on(duration, events, progress, checkpoint_every, max_pieces).read()


@dataclass(frozen=True)
class Paused:
    """The state of a catalogue's run, as read from its checkpoint."""

    path: Path
    stopped: Solution
    about: Mapping[str, Any]

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a checkpoint. Raises InputError for a file that is not the checkpoint of a catalogue."""
        dataset = read(path, CATALOGUE)
        stopped = to_solution(dataset, path)
        try:
            return cls(path, stopped, check_place(dataset.attrs, path))
        except (KeyError, TypeError) as error:
            raise InputError(f"{path}: not a file that stickslip has written: {error} is missing or wrong") from None

    @property
    def rows(self) -> Rows:
        """Return the rows, which are in the folder of the checkpoint. Raises InputError if a file of theirs is a symbolic link."""
        found = Rows(self.path.parent / self.about["catalogue"])
        for path in {found.path, found.growing}:
            if path.is_symlink():
                raise InputError(f"{path}: is a link: a catalogue is resumed in the file itself")
        return found

    def go_on(
        self,
        duration: float | None = None,
        events: int | None = None,
        progress: Progress | None = None,
        checkpoint_every: float = CHECKPOINT_EVERY,
        max_pieces: int | None = None,
    ) -> Catalogue:
        """Continue the run to its end. Raises InputError as `resume_catalogue` does."""
        stopped, about = self.stopped, self.about
        wanted, rows = events_wanted(stopped, events), self.rows
        run = taken_up(stopped, self.path, duration)
        orders = Orders(stopped.duration if duration is None else duration, wanted, progress, None, checkpoint_every, max_pieces)
        check_run("resume_catalogue", orders.duration, stopped.rtol, wanted, checkpoint_every)
        if wanted is not None:
            check_events(self.path, wanted, int(about["told"]))
        check_catalogue(rows.path)
        start = Place(about["last_piece"], about["last_xi"])
        run.forgotten = about["forgotten"]
        fresh = stream_of(run, about["event_rate"], bool(about["energies"]))
        stream = replace(fresh, first=about["first"], last_start=start, told=about["told"])
        with alone_with(rows):
            rows.take_up(about["told"], about["bytes"], about["digest"])
            return follow(run, orders, stream, rows)


@dataclass(frozen=True)
class Catalogue:
    """The result of a run without a history: its rows, the number of events that are over, and what ended it.

    `notes` holds one line each on predictability, energy trapped in waves, leaps over creep, lumped events and rounding, where
    there is something to report.
    """

    rows: Rows | RowsInMemory
    events: int
    status: Status
    notes: Mapping[str, str]

    @property
    def files(self) -> list[Path]:
        """Return the paths of the table and the checkpoint, or an empty list if the rows are in memory."""
        return [self.rows.path, checkpoint_of(self.rows)] if isinstance(self.rows, Rows) else []

    def read(self) -> pd.DataFrame:
        """Return the table, whose `attrs` hold the status and the notes."""
        table = self.rows.read()
        table.attrs = {"status": self.status.name, "status_message": self.status.message}
        table.attrs.update(self.notes)
        return table


def follow(run: RunInProgress, orders: Orders, stream: EventStream, rows: Rows | RowsInMemory) -> Catalogue:
    """Run to the end and write the table in its final format. Raises InputError if the run ends where it starts."""
    run.reserve(CAPACITY)
    keeper = CatalogueKeeper.of(run, orders, stream)
    keeper.rows = rows
    code = drive(run, orders.duration, keeper)
    check_started(run, code, "catalogue")
    return Catalogue(rows, stream.told, STATUSES[code], keeper.finish(run, code))


@dataclass(frozen=True)
class Told:
    """The output of a run at some moment: the size (bytes) of its growing file, and its stream of events."""

    size: int
    stream: EventStream


@dataclass(kw_only=True)
class CatalogueKeeper(Keeper):
    """A monitor that writes rows as events become known, and discards the history that they no longer need.

    `told` is the output at the point from which this run, or a longer one, would continue.
    """

    rows: Rows | RowsInMemory = field(default_factory=lambda: RowsInMemory())
    told: Told | None = None

    @property
    def counts(self) -> bool:
        """Return True, because a catalogue always counts its events."""
        return True

    def note(self, run: RunInProgress, look: Look) -> None:
        """Write the rows of new events and count the events as reported."""
        if len(look.known_by):
            self.rows.append(look.table())
        super().note(run, look)
        self._remember(run)

    def make_room(self, run: RunInProgress) -> bool:
        """Discard history that neither events nor the engine need, and enlarge the store if at least half of it remains full.

        Returns False if the store may not grow. Nothing is discarded after the checkpoint for a longer run has been stored, which
        refers to pieces by their number.
        """
        dropped = run.forget_before(self.stream.needed(run.store)) if run.before_end is None else 0
        if dropped > 0:
            self.stream.forget(dropped)
            self._remember(run)
            self.looked = self.stands(run)
        return run.length < len(run.store.pieces) // 2 or run.grow(self.orders.most_pieces)

    def save(self, run: RunInProgress, code: int = UNDER_WAY) -> None:
        """Renew the checkpoint once the rows that it relies on are on the disk."""
        if isinstance(self.rows, RowsInMemory) or self.told is None:
            return
        self.rows.sync()
        solution = as_solution(run, self.orders, code)
        about = self._about(run, self.told, self.rows)
        try:
            write(history_dataset(solution).assign_attrs(origin(solution) | about), checkpoint_of(self.rows))
        except FullDiskError as error:  # the previous checkpoint is still in the file
            warnings.warn(f"{error}; the run continues, and the previous file is unchanged", RuntimeWarning, stacklevel=2)

    def finish(self, run: RunInProgress, code: int) -> dict[str, str]:
        """Write the remaining rows, with one for an event that the end leaves open, and give the table its final format.

        Returns the notes of a `Catalogue`.
        """
        if code != ENOUGH_EVENTS:
            self.count(run)
        self.rows.append(self.stream.look(run.store, run.length).table(unknown=True))
        solution = as_solution(run, self.orders, code)
        known = is_followed(run.problem)
        prediction = predictability_of_events(self.rows.columns("start", "amplification"), run.rtol) if known else None
        self.rows.publish(origin(solution) | attributes_of(prediction), run.problem.load_unit)
        self.save(run, code)
        self.rows.tidy()
        notes = {
            "predictability": prediction.text if prediction else "",
            "trapped": trapped_note(solution.history),
            "creep": creep_note(run.creep),
            "lumping": run.lumping_note,
            "rounding": run.rounding_note,
        }
        return {name: note for name, note in notes.items() if note}

    def _remember(self, run: RunInProgress) -> None:
        if run.before_end is None:
            self.told = Told(self.rows.size, replace(self.stream))

    def _about(self, run: RunInProgress, told: Told, rows: Rows) -> dict[str, Any]:
        """Return the attributes of the checkpoint."""
        stream = told.stream
        return {
            CATALOGUE: FORMAT,
            "catalogue": rows.path.name,
            "bytes": told.size,
            "digest": rows.digest(told.size),
            "told": stream.told,
            "first": stream.first,
            "last_piece": stream.last_start.piece,
            "last_xi": stream.last_start.xi,
            "event_rate": stream.threshold,
            "energies": int(stream.energies),
            "forgotten": run.forgotten,
        }


def checkpoint_of(rows: Rows) -> Path:
    """Return the path of the checkpoint beside a catalogue."""
    return rows.path.with_name(f"{rows.path.stem}.checkpoint.nc")
