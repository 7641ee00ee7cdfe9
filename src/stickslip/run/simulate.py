"""Run a problem."""

from __future__ import annotations

from pathlib import Path

from stickslip.engine_input.creep_limits import check_creep_rtol
from stickslip.engine_input.lumping_limits import check_shortest_event
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import LARGEST, as_float
from stickslip.problem.problem import Problem
from stickslip.run.monitor import CHECKPOINT_EVERY, Keeper, Orders, as_solution
from stickslip.run.progress import Progress
from stickslip.run.run_loop import drive
from stickslip.run.session import RunInProgress
from stickslip.solution.solution import Solution
from stickslip.trajectory.status import INTERRUPTED, STATUSES


def simulate(
    problem: Problem,
    duration: float,
    rtol: float = 1e-10,
    *,
    creep_rtol: float | None = None,
    shortest_event: float | None = None,
    events: int | None = None,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
) -> Solution:
    """Run a problem from t = 0 to `duration` (s), or until so many slip `events` are over, with relative tolerance `rtol`.

    Returns a Solution; what ended the run is its `status`. Ctrl-C ends the run with a valid solution up to that time. A run of
    which a `checkpoint` file (.nc) is kept, renewed every `checkpoint_every` seconds of wall clock, can be taken up again by
    `stickslip.resume`, also after it has been killed; at the end the file holds the solution. rtol lies between 1e-15 and 1e-2.

    Under a law of slip a slab may creep for days between pulses, slipping a little in each round trip. The run leaps over creep
    after it has had 200 round trips with slip, with an error of slip of at most 0.1 sqrt(rtol) (1e-6 to 1e-3) times the slip since
    the start, and is exact before and after; `solution.creep` lists the leaps. creep_rtol (up to 1e-2) is another error, and
    leaps from the start; with 0 every round trip is run.

    A slab under rate weakening may end in ever shorter events. From the round trip on that has more than 4096 pieces, the run lumps
    events that are shorter than 1/1024 of the two-way travel time (see `stickslip.engine_input.lumping_limits`): what comes before
    stays as it is, and of the rest the statistics of what is longer; `solution.lumping_note` says so. shortest_event (s) is another
    length, and lumps from the start; with 0 nothing is lumped.

    A history has at most a million pieces, 0.44 GB in memory and in a file. A run that needs more ends with the status "too many
    pieces", and its file is left as it was; with max_pieces it may have so many, and is written whatever ended it.

    Raises InputError for an argument out of range, a contact that cannot even start, or creep_rtol in a problem that has no
    such leaps.
    """
    check_run("simulate", duration, rtol, events, checkpoint_every)
    check_creep_rtol(problem, creep_rtol, "simulate")
    check_shortest_event(problem, shortest_event, "simulate")
    run = RunInProgress.begin(problem, rtol, creep_rtol, shortest_event)
    kept = None if checkpoint is None else Path(checkpoint)
    return go_on(run, Orders(duration, events, progress, kept, checkpoint_every, max_pieces))


def check_run(who: str, duration: float, rtol: float, events: int | None, checkpoint_every: float) -> None:
    """Refuse what cannot be run. Raises InputError."""
    if not 0 < as_float(duration) <= LARGEST:
        raise InputError(f"{who}: duration must be a positive time in s up to {LARGEST:g}, got {as_float(duration)!r}")
    if not 1e-15 <= rtol <= 1e-2:
        raise InputError(f"{who}: rtol must lie between 1e-15 and 1e-2, got {rtol!r}")
    if events is not None and not (isinstance(events, int) and events > 0):
        raise InputError(f"{who}: events must be a whole number above 0, got {events!r}")
    if not checkpoint_every >= 0:
        raise InputError(f"{who}: checkpoint_every must be a time in s, got {checkpoint_every!r}")


def check_started(run: RunInProgress, code: int, who: str) -> None:
    """Refuse a run of no length: KeyboardInterrupt where Ctrl-C came before its first piece, else InputError."""
    if run.length > 0:
        return
    if code == INTERRUPTED:
        raise KeyboardInterrupt
    raise InputError(f"{who}: the run ends where it starts: {STATUSES[code].message}")


def go_on(run: RunInProgress, orders: Orders) -> Solution:
    """Follow a run to its end, and write its file if there is to be one. Raises InputError where it ends where it starts."""
    code = drive(run, orders.duration, Keeper.of(run, orders))
    check_started(run, code, "simulate")
    solution = as_solution(run, orders, code)
    if orders.checkpoint is not None and orders.keeps(code):
        solution.save(orders.checkpoint)
    return solution
