"""The catalogue of a run whose history is too long to be kept: one row an event, told as they become known."""

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
"""Pieces of history that are kept at a time, if no single event needs more."""


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
    """The slip events of a run up to `duration` (s), or until so many `events` are over, in bounded memory.

    The table is that of `Solution.catalogue(event_rate, energies=energies)`, with a last row for an event that the end leaves
    open; its `attrs` say what ended the run. With a `path` (.csv, .parquet, .nc) the rows go to this file, and beside it
    NAME.checkpoint.nc is renewed every `checkpoint_every` seconds of wall clock: `stickslip.resume_catalogue` takes it up. The
    history is forgotten up to the last event but one, but for what stands in the body; an event, with what precedes it, of more
    than `max_pieces` pieces ends the run with a status.
    For the other arguments, and errors, see `stickslip.simulate`; InputError also for a path that says no format.
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
    """Return the tolerance of leaps over creep: automatic ones are left out where energies are wanted."""
    return 0.0 if energies and creep_rtol is None else creep_rtol


def check_energies(creep_rtol: float | None, energies: bool, where: str, options: str = "energies and creep_rtol") -> None:
    """Refuse energies of a run that leaps over creep. Raises InputError."""
    if energies and creep_rtol is not None and creep_rtol > 0.0:
        raise InputError(f"{where}: {options} exclude each other: what leaps over creep send into the slab is not known")


def stream_of(run: RunInProgress, event_rate: float, energies: bool) -> EventStream:
    """The events of a run from its start."""
    return EventStream(run.problem, event_rate, float(run.setup.par.ramp), energies=energies)


def begin(run: RunInProgress, orders: Orders, path: Path, event_rate: float | None = None, energies: bool = False) -> Catalogue:
    """Follow a run from its start, into a file; what was there under these names is gone."""
    rows = Rows(path)
    rate = default_event_rate(run.problem) if event_rate is None else event_rate
    with alone_with(rows):
        checkpoint_of(rows).unlink(missing_ok=True)
        rows.clear()
        return follow(run, orders, stream_of(run, rate, energies), rows)


def alone_with(rows: Rows) -> AbstractContextManager[None]:
    """Hold the files of a catalogue against other processes. Raises InputError where another catalogue is written into them."""
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
    """Go on with a `catalogue` from its checkpoint, up to `duration` (s from the start; default: as before).

    Rows that were written after the checkpoint are cut off and made again: the table is the same, bit for bit, as if the run had
    never stopped. Raises InputError as `stickslip.resume` does, and where rows are missing.
    """
    paused = Paused.read(Path(checkpoint))
    return paused.go_on(duration, events, progress, checkpoint_every, max_pieces).read()


@dataclass(frozen=True)
class Paused:
    """A catalogue in the making, read from its checkpoint."""

    path: Path
    stopped: Solution
    about: Mapping[str, Any]

    @classmethod
    def read(cls, path: Path) -> Self:
        """Raises InputError for a file that is no such checkpoint."""
        dataset = read(path, CATALOGUE)
        stopped = to_solution(dataset, path)
        try:
            return cls(path, stopped, check_place(dataset.attrs, path))
        except (KeyError, TypeError) as error:
            raise InputError(f"{path}: not a file that stickslip has written: {error} is missing or wrong") from None

    @property
    def rows(self) -> Rows:
        """Where the rows are: beside the checkpoint. Raises InputError where there is a link."""
        found = Rows(self.path.parent / self.about["catalogue"])
        for path in {found.path, found.growing}:
            if path.is_symlink():
                raise InputError(f"{path}: is a link: a catalogue is taken up in the file itself")
        return found

    def go_on(
        self,
        duration: float | None = None,
        events: int | None = None,
        progress: Progress | None = None,
        checkpoint_every: float = CHECKPOINT_EVERY,
        max_pieces: int | None = None,
    ) -> Catalogue:
        """Follow the run to its end."""
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
    """What came of a run: its rows, how many events are over, what ended it; and `notes`, lines on what is predictable, on the
    energy that is trapped in waves, and on leaps over creep and lumped events, where there is something to say.
    """

    rows: Rows | RowsInMemory
    events: int
    status: Status
    notes: Mapping[str, str]

    @property
    def files(self) -> list[Path]:
        """Table and checkpoint."""
        return [self.rows.path, checkpoint_of(self.rows)] if isinstance(self.rows, Rows) else []

    def read(self) -> pd.DataFrame:
        """The table."""
        table = self.rows.read()
        table.attrs = {"status": self.status.name, "status_message": self.status.message}
        table.attrs.update(self.notes)
        return table


def follow(run: RunInProgress, orders: Orders, stream: EventStream, rows: Rows | RowsInMemory) -> Catalogue:
    """Follow a run to its end, and give its table its form. Raises InputError where it ends where it starts."""
    run.reserve(CAPACITY)
    keeper = CatalogueKeeper.of(run, orders, stream)
    keeper.rows = rows
    code = drive(run, orders.duration, keeper)
    check_started(run, code, "catalogue")
    return Catalogue(rows, stream.told, STATUSES[code], keeper.finish(run, code))


@dataclass(frozen=True)
class Told:
    """What has been told at a moment: rows on the disk, and the stream."""

    size: int
    stream: EventStream


@dataclass(kw_only=True)
class CatalogueKeeper(Keeper):
    """Writes rows as events become known, and forgets the history behind them.

    `told` is what had been told where the run, or a longer one, would go on.
    """

    rows: Rows | RowsInMemory = field(default_factory=lambda: RowsInMemory())
    told: Told | None = None

    @property
    def counts(self) -> bool:
        """Always."""
        return True

    def note(self, run: RunInProgress, look: Look) -> None:
        """Their rows are written."""
        if len(look.known_by):
            self.rows.append(look.table())
        super().note(run, look)
        self._remember(run)

    def make_room(self, run: RunInProgress) -> bool:
        """Forget what neither events nor the engine need; more room only if that is most of what there is."""
        dropped = run.forget_before(self.stream.needed(run.store)) if run.before_end is None else 0
        if dropped > 0:
            self.stream.forget(dropped)
            self._remember(run)
            self.looked = self.stands(run)
        return run.length < len(run.store.whole) // 2 or run.grow(self.orders.most_pieces)

    def save(self, run: RunInProgress, code: int = UNDER_WAY) -> None:
        """Renew the checkpoint, whose rows are on the disk before."""
        if isinstance(self.rows, RowsInMemory) or self.told is None:
            return
        self.rows.sync()
        solution = as_solution(run, self.orders, code)
        about = self._about(run, self.told, self.rows)
        try:
            write(history_dataset(solution).assign_attrs(origin(solution) | about), checkpoint_of(self.rows))
        except FullDiskError as error:  # the checkpoint before is still there
            warnings.warn(f"{error}; the run goes on, and what was in the file before is still there", RuntimeWarning, stacklevel=2)

    def finish(self, run: RunInProgress, code: int) -> dict[str, str]:
        """Tell the rest, the event that the end leaves open too; the rows get their form. Returns the notes of a `Catalogue`."""
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
            "trapped": trapped_note(solution),
            "creep": creep_note(run.creep),
            "lumping": run.lumping_note,
            "rounding": run.rounding_note,
        }
        return {name: note for name, note in notes.items() if note}

    def _remember(self, run: RunInProgress) -> None:
        if run.before_end is None:
            self.told = Told(self.rows.size, replace(self.stream))

    def _about(self, run: RunInProgress, told: Told, rows: Rows) -> dict[str, Any]:
        """Attributes of the checkpoint."""
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
    """The checkpoint beside a catalogue."""
    return rows.path.with_name(f"{rows.path.stem}.checkpoint.nc")
