"""Run a problem without keeping its whole history, and write one row for each slip event as soon as it is known."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from stickslip.engine import Reach, creep_note, reach_of
from stickslip.foundation.arguments import as_path
from stickslip.foundation.atomic_write import check_replaceable
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.locks import held
from stickslip.foundation.takes import takes
from stickslip.problem import ENOUGH_EVENTS, UNDER_WAY, Problem, check_event_rate
from stickslip.problem.scenarios import read_source
from stickslip.run.exact_run import ExactRun
from stickslip.run.options import CallOptions
from stickslip.run.progress import reporting
from stickslip.run.run_loop import run_to_end
from stickslip.run.words import WORDS, GivenToCatalogue
from stickslip.solution import Account
from stickslip.solution.files import CATALOGUE, FILE_FORMAT, Rows, RowsInMemory, check_catalogue, origin, save_checkpoint
from stickslip.solution.observables import (
    EventStream,
    Look,
    Proven,
    attributes_of,
    in_short,
    is_followed,
    predictability_of_events,
    proven,
    trapped_note,
)

if TYPE_CHECKING:
    import pandas as pd

    from stickslip.problem.scenarios import Scenario
    from stickslip.solution import Solution

CAPACITY = 16_384
"""Initial room of a catalogue in pieces of history, about 7 MB; it grows only if the pieces to keep fill half of it."""


@takes(WORDS, GivenToCatalogue, "rtol")
def catalogue(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    path: str | Path | None = None,
    *,
    rtol: float | None = None,
    event_rate: float | str | WithUnit | None = None,
    energy: bool = False,
    **options: Unpack[GivenToCatalogue],
) -> pd.DataFrame:
    """Run a problem, or a scenario, in bounded memory and return the table of its slip events.

    History before the previous event is discarded, except waves that are still travelling in the slab.

    Parameters
    ----------
    problem, duration
        See `stickslip.simulate`: a problem and its duration, or a scenario, which has one.
    path : str or Path, optional
        File for the table (.csv, .parquet or .nc). NAME.checkpoint.nc beside it is renewed while the run continues, and
        `stickslip.resume` resumes from it. Without a path the rows are kept in memory.
    event_rate : float or str, optional
        Slip above this rate (m/s, or a text with a unit) is an event. The default is 1e-6 S (range of mu)/Z; for a block sqrt(K m)
        replaces Z.
    energy : bool
        Add the energies of each event (slab: J/m^2, block: J). Automatic leaps over creep are then switched off.
    {options}

    Returns
    -------
    pandas.DataFrame
        The table of `Solution.catalogue(event_rate, energy=energy)`, with a last row for an event that the end of the run
        leaves open. Its `attrs` hold the reason for the end of the run, and notes.

    Raises
    ------
    InputError
        If an argument is out of range (see `stickslip.simulate`), the suffix of `path` is unknown, Parquet is wanted without
        pyarrow, the file exists and was not written by this package, another run writes to the same files, or `energy` is combined
        with a positive creep_rtol.

    See Also
    --------
    stickslip.simulate : keep the whole motion.
    stickslip.studies.catalogue_statistics : recurrence and slip of a catalogue, with their scatter.

    Examples
    --------
    >>> import stickslip as ss
    >>> events = ss.catalogue("cycles-block", max_events=3)
    >>> print((events.recurrence / ss.YEAR).round(4).to_list(), events.slip.round(6).to_list())
    [nan, 4.6937, 4.6937] [0.164279, 0.164279, 0.164279]
    """
    rate = check_event_rate(event_rate, "catalogue")
    file = None if path is None else as_path("catalogue: path", path)
    if file is not None:
        check_catalogue(file)
    with reporting(options.pop("progress", None), "catalogue") as report:
        scenario = read_source("catalogue", problem, duration)
        checked = CallOptions.of(scenario, rtol=rtol, progress=report, **options).check("catalogue", scenario.problem)
        check_energy(checked.creep_rtol, energy, "catalogue")
        return catalogue_of(scenario.problem, checked, file, rate, energy=energy).read()


def catalogue_of(
    problem: Problem, options: CallOptions, path: Path | None, event_rate: float | None = None, *, energy: bool = False
) -> Catalogue:
    """Run from the start; with a path, an earlier table and checkpoint of the same names are deleted first.

    Raises InputError if a file of such a name was not written by this package.
    """
    for file in () if path is None else (path, Rows(path).growing, checkpoint_of(Rows(path))):
        check_replaceable(file, f"catalogue: {file}")
    run = ExactRun.begin(problem, replace(options, creep_rtol=leaps_with(energy, options.creep_rtol)))
    run.stream = EventStream(run.stream.threshold if event_rate is None else event_rate, energies=energy)
    if path is None:
        return follow(run, RowsInMemory())
    rows = Rows(path)
    with alone_with(rows):
        checkpoint_of(rows).unlink(missing_ok=True)
        rows.clear()
        return follow(run, rows)


def leaps_with(energy: bool, creep_rtol: float | None) -> float | None:
    """Return the tolerance of leaps over creep, which is 0 (no leaps) if energies are wanted and no tolerance is given."""
    return 0.0 if energy and creep_rtol is None else creep_rtol


def check_energy(creep_rtol: float | None, energy: bool, where: str, options: str = "energy and creep_rtol") -> None:
    """Refuse energies for a run that leaps over creep. Raises InputError."""
    if energy and creep_rtol is not None and creep_rtol > 0.0:
        raise InputError(f"{where}: {options} exclude each other: what leaps over creep send into the slab is not known")


def alone_with(rows: Rows) -> AbstractContextManager[None]:
    """Lock the files of a catalogue against other processes.

    Raises InputError if another run is writing to them, or if there is a folder in place of one of them.
    """
    folder = next((path for path in (rows.path, rows.growing, checkpoint_of(rows)) if path.is_dir()), None)
    if folder is not None:
        raise InputError(f"{folder}: is a folder, where the catalogue needs a file: choose another name")
    return held(checkpoint_of(rows), f"{rows.path}: another run is writing its catalogue there: choose another name")


@dataclass(frozen=True)
class Catalogue:
    """The result of a run without a history: its rows, the number of events that are over, and what is said of the run.

    What is said leaves out what the selection rule decided.
    """

    rows: Rows | RowsInMemory
    events: int
    account: Account

    @property
    def files(self) -> list[Path]:
        """The paths of the table and the checkpoint, or an empty list if the rows are in memory."""
        return [self.rows.path, checkpoint_of(self.rows)] if isinstance(self.rows, Rows) else []

    def read(self) -> pd.DataFrame:
        """Return the table, whose `attrs` hold the status and the notes."""
        table = self.rows.read()
        status = self.account.status
        table.attrs = {"status": status.name, "status_message": status.message, "duration": self.account.reached}
        table.attrs.update(self.account.notes)
        return table


def follow(run: ExactRun, rows: Rows | RowsInMemory, reach: Reach | None = None) -> Catalogue:
    """Run to the end and write the table in its final format; `reach` is how far the contact has gone in earlier runs.

    Raises InputError if the run ends where it starts.
    """
    run.keeps_events_only = True
    run.reserve(CAPACITY)
    return run_to_end(run, EventRows(run, rows, reach=reach))


@dataclass(frozen=True)
class OutputSoFar:
    """The output of a run at some moment: the size (bytes) of its growing file, and its stream of events."""

    size: int
    stream: EventStream


@dataclass
class EventRows:
    """The sink (`run_loop.Sink`) that writes rows as events become known, and discards the history that they no longer need.

    `so_far` is the output at the point where this run, or a longer one, would continue. `residual` (Pa or N) is the largest bound
    of the steps that were proven anew: some of the first ones, and some of those still in memory at the end.
    """

    run: ExactRun
    rows: Rows | RowsInMemory
    so_far: OutputSoFar | None = None
    residual: float | None = None
    reach: Reach | None = None
    """How far the contact had gone in the history that was discarded."""
    who = "catalogue"
    wants_events = True

    def record(self, new: Look) -> None:
        """Write the rows of new events and report the events."""
        if len(new.known_by):
            self.rows.append(new.table())
        new.tell()
        self._remember()

    def make_room(self) -> bool:
        """Discard history that neither events nor the engine need, and enlarge the store if at least half of it remains full.

        Returns False if the store may not grow.
        """
        run = self.run
        if self.residual is None:
            self.residual = _residual(run)
        self.reach = reach_of(run.history()).beyond(self.reach)
        if run.forget_reported() > 0:
            self._remember()
        return run.length < len(run.store.pieces) // 2 or run.grow()

    def save(self, code: int = UNDER_WAY) -> None:
        """Renew the checkpoint once the rows that it relies on are on the disk."""
        if isinstance(self.rows, RowsInMemory) or self.so_far is None:
            return
        self.rows.sync()
        solution = self.run.solution(code)
        about = self._about(self.so_far, self.rows) | {"reach": self._reach_note(solution)}
        save_checkpoint(solution, checkpoint_of(self.rows), about)

    def finish(self, code: int) -> Catalogue:
        """Write the remaining rows, with one for an event that the end leaves open, and give the table its final format."""
        run, stream = self.run, self.run.stream
        if code != ENOUGH_EVENTS:
            self.rows.append(stream.look(run.history()).table(unknown=True))
        solution = run.solution(code)
        known = is_followed(run.problem)
        prediction = predictability_of_events(self.rows.columns("start", "amplification"), run.options.rtol) if known else None
        residual = max(float(run.state.largest_residual), self.residual or 0.0, _residual(run))
        share = float(run.state.slid_unproven / run.state.slid) if run.count.unproven else 0.0
        proof = Proven(residual, 0, 0, int(run.count.unproven), share, float(run.state.missed)).proof(run.problem)
        reach = self._reach_note(solution)
        about = {"proven": proof.text, "reach": reach} | attributes_of(prediction)
        self.rows.publish(origin(solution) | about, run.problem.load_unit)
        self.save(code)
        self.rows.tidy()
        trapped = trapped_note(solution.history)
        notes = {
            "reach": reach,
            "short": in_short(proof.short, trapped, prediction.short if prediction else ""),
            "predictability": prediction.text if prediction else "",
            "trapped": trapped,
            "creep": creep_note(solution.history),
            "lumping": run.lumping_note,
            "rounding": run.rounding_note,
            "proven": proof.text,
        }
        said = {name: note for name, note in notes.items() if note}
        return Catalogue(self.rows, stream.reported, Account(solution.scenario(), solution.status, solution.duration, said))

    def _reach_note(self, solution: Solution) -> str:
        return solution.reach.beyond(self.reach).text(solution.problem)

    def _remember(self) -> None:
        if self.run.before_end is None:
            self.so_far = OutputSoFar(self.rows.size, replace(self.run.stream))

    def _about(self, so_far: OutputSoFar, rows: Rows) -> dict[str, Any]:
        stream = so_far.stream
        return {
            CATALOGUE: FILE_FORMAT,
            "catalogue": rows.path.name,
            "bytes": so_far.size,
            "digest": rows.digest(so_far.size),
            "told": stream.reported,
            "first": stream.first,
            "last_piece": stream.last_start.piece,
            "last_xi": stream.last_start.xi,
            "event_rate": stream.threshold,
            "energies": int(stream.energies),
            "forgotten": self.run.forgotten,
            "displaced": 0.0 if self.reach is None else self.reach.largest,
            "displaced_at": 0.0 if self.reach is None else self.reach.time,
        }


def _residual(run: ExactRun) -> float:
    """Return the largest bound (Pa or N) of the steps in memory that are proven anew; leaps over creep are no steps."""
    return proven(replace(run.history(), creep=run.creep)).residual


def checkpoint_of(rows: Rows) -> Path:
    """Return the path of the checkpoint beside a catalogue."""
    return rows.path.with_name(f"{rows.path.stem}.checkpoint.nc")
