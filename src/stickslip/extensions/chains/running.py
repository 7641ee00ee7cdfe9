"""Run a chain from t = 0, or go on from a folder, with progress, checkpoints and Ctrl-C as all runs have them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.rows import ChainRows, Snapshots
from stickslip.extensions.chains.run import ChainRun
from stickslip.extensions.chains.solver import ChainSolver
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.show import number
from stickslip.problem import ENOUGH_EVENTS, STATUSES, Stop
from stickslip.problem.scenarios import Scenario
from stickslip.run import CallOptions, Pace, WholeHistory, how_far, how_fast, run_to_end

if TYPE_CHECKING:
    from stickslip.extensions.chains.state import ChainState

KEEP_CATALOGUE, KEEP_CHANGES = "catalogue", "changes"
WORDS_OF_KEEP = (KEEP_CATALOGUE, KEEP_CHANGES)
"""What is kept of a run: its events, or the changes of blocks, too."""
STEPS_IN_BUDGET = 20
"""So many steps of blocks count as one in the budget of a call: the first call then takes a tenth of a second."""


class ChainReport(NamedTuple):
    """The progress of the run of a chain; as a text it is one line for people.

    Times are in s. `events` are over; `max_events` ends the run, if it is not None. `pace` is the simulated time per wall-clock
    time since the first report, and `left` the wall-clock time left at this pace (s); both are NaN while they are not known.
    """

    time: float
    duration: float
    events: int
    max_events: int | None
    changes: int
    moving: int
    pace: float
    left: float

    def __str__(self) -> str:
        wanted = f" of {self.max_events}" if self.max_events else ""
        plural = "" if self.events == 1 and not wanted else "s"
        doing = f"{self.moving} blocks slip" if self.moving > 1 else "1 block slips" if self.moving else "at rest"
        changes = f"{number(self.changes / 1e6, 3)} million changes" if self.changes >= 1e6 else f"{self.changes} changes"
        parts = [how_far(self.time, self.duration), f"{self.events}{wanted} event{plural}", changes, doing]
        return ", ".join(parts + how_fast(self.pace, self.left))


def kept_of(options: CallOptions) -> str:
    """Return what is kept of a run. Raises InputError for a word that is none of `WORDS_OF_KEEP`."""
    kept = options.of_solver.get("keep") or KEEP_CATALOGUE
    if not isinstance(kept, str) or kept not in WORDS_OF_KEEP:
        raise InputError(f"simulate: keep {shown(kept)} is unknown; {nearest(str(kept), WORDS_OF_KEEP)}")
    return kept


def simulate_chain(source: Chain | Scenario, options: CallOptions) -> ChainRun:
    """Run a chain from t = 0: see `stickslip.simulate`.

    With `options.checkpoint`, a folder (NAME.zarr), rows are written there while the run continues, and `resume_chain` continues
    it. Raises InputError if an option is out of range, or if the folder cannot be made.
    """
    if options.duration is None:
        raise InputError("simulate: a Chain needs a duration, in s or with a unit")
    chain: Chain = source if isinstance(source, Chain) else source.to_solve
    keeps, options = kept_of(options), options.checked("simulate")
    path = options.checkpoint
    if path is None:
        return followed(
            ChainSolver(chain, None, keeps == KEEP_CHANGES), options, ChainRows(chain, options.title, keeps == KEEP_CHANGES)
        )
    if path.suffix != ".zarr":
        raise InputError(f"simulate: the checkpoint of a Chain is a folder NAME.zarr, got {shown(str(path))}")
    from stickslip.extensions.chains.store import ChainStore  # with zarr, which takes half a second to load
    from stickslip.extensions.chains.store_layout import scenario_of_chain

    about = source if isinstance(source, Scenario) else scenario_of_chain(chain, options)
    with ChainStore.new(path, chain, replace(about, duration=options.duration), keeps == KEEP_CHANGES, options.title) as store:
        solver = ChainSolver(chain, None, keeps == KEEP_CHANGES)
        store.save(solver.state)
        return followed(solver, options, store)


def resume_chain(path: Path, duration: float | str | WithUnit | None = None, **given: Any) -> ChainRun:
    """Continue the run of a chain in its folder, up to its own duration if none is given: see `stickslip.resume`.

    Raises InputError if the folder holds no run of a chain, or one that has passed the duration or the number of events.
    """
    from stickslip.extensions.chains.store import ChainStore

    with ChainStore.at(path) as store:
        asked: Any = store.duration if duration is None else duration
        options = CallOptions(asked, checkpoint=path, **given).checked("resume")
        if duration is not None and options.duration < store.reached:
            wanted = f"a duration of {options.duration:.9g} s lies before that"
            raise InputError(f"{path}: the run has already reached {store.reached:.9g} s: {wanted}")
        if options.max_events is not None and options.max_events <= store.count_of_events:
            raise InputError(f"resume: {path}: the run already has {store.count_of_events} events: take more of them")
        store.duration = float(options.duration)
        return followed(ChainSolver(store.chain, store.state, store.keeps_changes), options, store)


def followed(solver: ChainSolver, options: CallOptions, rows: ChainRows) -> ChainRun:
    """Run a solver to the end of its run, with rows that go where they are kept."""
    run = ChainInProgress(options, solver, rows)
    return run_to_end(run, WholeHistory(run))


@dataclass(eq=False)
class ChainInProgress:
    """A chain in progress, an implementation of `run.solver.Solver`."""

    options: CallOptions
    solver: ChainSolver
    rows: ChainRows
    length: int = 0
    """The number of calls of compiled code."""
    can_be_saved = True
    has_enough: bool = False
    taken: int = 0
    """The number of changes whose rows are taken."""
    snapshots: Snapshots = field(init=False)

    def __post_init__(self) -> None:
        self.snapshots, self.taken = self.rows.snapshots, self.rows.count_of_changes
        self.snapshots.add(self.solver.state)

    def advance(self, budget: int) -> int:
        """Advance by at most so much work: see `Solver.advance`."""
        most = self.options.max_events
        before = None if most is None else self.solver.state.copy()
        done, events, changes = self.solver.go_on(self.options.duration, STEPS_IN_BUDGET * budget)
        self.length += 1
        if most is not None and before is not None and (missing := most - self.rows.count_of_events) <= len(events):
            events = events[:missing]
            changes = changes[: self._back_to(before, events, self.taken)]
            self.has_enough = True
        self.rows.take(events, changes)
        self.taken = int(self.solver.state.now[at.COUNT_OF_CHANGES])
        self.snapshots.add(self.solver.state)
        return ENOUGH_EVENTS if self.has_enough else Stop.FINISHED if done else Stop.NONE

    def _back_to(self, before: ChainState, events: Floats, taken: int) -> int:
        """Go back to the end of the last of these events, and return how many changes lie up to there since so many were taken."""
        last = float(events[-1, at.EVENT_TIME] + events[-1, at.EVENT_DURATION])
        wanted = self.rows.count_of_events + len(events)
        self.solver = ChainSolver(self.solver.chain, before, self.rows.keeps_changes)
        while self.solver.state.now[at.EVENTS] < wanted:
            done, _, _ = self.solver.go_on(last)
            last = math.nextafter(last, math.inf) if done else last
        return int(self.solver.state.now[at.COUNT_OF_CHANGES]) - taken

    def grow(self) -> bool:
        """Return True: rows are taken after each call."""
        return True

    def new_events(self) -> None:
        """Return None: rows are counted where they are taken."""

    def report(self, pace: Pace) -> ChainReport:
        """Return the progress of the run: see `Solver.report`."""
        state, duration = self.solver.state, float(self.options.duration)
        now = min(state.time, duration)
        moving, changes = int(np.count_nonzero(state.blocks[at.RATE_NOW])), int(state.now[at.COUNT_OF_CHANGES])
        events = self.rows.count_of_events
        return ChainReport(now, duration, events, self.options.max_events, changes, moving, *pace.at(now, now / duration))

    def save(self) -> None:
        """Renew the checkpoint, if a folder for it was given."""
        self.rows.save(self.solver.state)

    def finish(self, code: int) -> ChainRun:
        """Return the run with the status that belongs to a code."""
        state = self.solver.state
        reached = float(self.options.duration) if code == Stop.FINISHED else min(state.time, float(self.options.duration))
        return self.rows.run(self.solver, reached, STATUSES[code])
