"""Run a problem from t = 0 with its whole history."""

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
    max_events: int | None = None,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
) -> Solution:
    """Run a problem from t = 0.

    Parameters
    ----------
    problem : Problem
        The body, its friction law, its loading and its initial state.
    duration : float
        Latest end of the run, s.
    rtol : float
        Relative tolerance of the run, between 1e-15 and 1e-2.
    creep_rtol : float, optional
        Error of slip that leaps over creep may cause, as a share of the slip since the start: up to 1e-2, and 0 for no leaps.
        Automatic by default (see Notes).
    shortest_event : float, optional
        Duration (s) below which slip events are lumped: up to 1 % of the two-way travel time, and 0 for no lumping. Automatic by
        default (see Notes).
    max_events : int, optional
        Number of slip events after which the run stops.
    progress : callable, optional
        A function that is called with a `stickslip.run.progress.Report` while the run continues.
    checkpoint : str or Path, optional
        File (.nc) from which `stickslip.resume` can continue the run, even after it has been killed. At the end it holds the
        solution.
    checkpoint_every : float
        Interval between two checkpoints, s of wall clock.
    max_pieces : int, optional
        Largest number of pieces of history, which are intervals with one polynomial each for load and slip rate. The default is a
        million, some 0.4 GB in memory and in a file.

    Returns
    -------
    Solution
        The run; its `status` says what ended it. Ctrl-C ends the run with a valid solution up to that time.

    Raises
    ------
    InputError
        If an argument is out of range, if the contact cannot even start, or if creep_rtol or shortest_event is positive for a
        problem in which there are no such leaps or no lumping.

    Notes
    -----
    Under a law of slip a slab may creep for days between pulses, slipping a little in each round trip. After 200 round trips with
    slip the run leaps over creep, with an error of slip of at most 0.1 sqrt(rtol), but no less than 1e-6 and no more than 1e-3,
    times the slip since the start; before and after a leap it is exact. `solution.creep` lists the leaps. A positive creep_rtol
    sets another error and allows leaps from the start.

    A slab under rate weakening may end in ever shorter events. As soon as a round trip has more than 4096 pieces, the run lumps
    events that are shorter than 1/1024 of the two-way travel time (see `stickslip.engine_input.lumping_limits`). The run up to
    there does not change; after it only the statistics of longer events are meaningful, and `solution.lumping_note` says so. A
    positive shortest_event sets another length and lumps from the start.

    A run that needs more pieces than the default allows ends with the status "too many pieces", and its checkpoint file is left as
    it was. With max_pieces the file is written whatever ended the run.
    """
    check_run("simulate", duration, rtol, max_events, checkpoint_every)
    check_creep_rtol(problem, creep_rtol, "simulate")
    check_shortest_event(problem, shortest_event, "simulate")
    run = RunInProgress.begin(problem, rtol, creep_rtol, shortest_event)
    kept = None if checkpoint is None else Path(checkpoint)
    return go_on(run, Orders(duration, max_events, progress, kept, checkpoint_every, max_pieces))


def check_run(who: str, duration: float, rtol: float, max_events: int | None, checkpoint_every: float) -> None:
    """Refuse options with which nothing can be run. Raises InputError."""
    if not 0 < as_float(duration) <= LARGEST:
        raise InputError(f"{who}: duration must be a positive time in s up to {LARGEST:g}, got {as_float(duration)!r}")
    if not 1e-15 <= rtol <= 1e-2:
        raise InputError(f"{who}: rtol must lie between 1e-15 and 1e-2, got {rtol!r}")
    if max_events is not None and not (isinstance(max_events, int) and max_events > 0):
        raise InputError(f"{who}: max_events must be a whole number above 0, got {max_events!r}")
    if not checkpoint_every >= 0:
        raise InputError(f"{who}: checkpoint_every must be a time in s, got {checkpoint_every!r}")


def check_started(run: RunInProgress, code: int, who: str) -> None:
    """Refuse a run without a single piece. Raises KeyboardInterrupt if Ctrl-C stopped it, and InputError otherwise."""
    if run.length > 0:
        return
    if code == INTERRUPTED:
        raise KeyboardInterrupt
    raise InputError(f"{who}: the run ends where it starts: {STATUSES[code].message}")


def go_on(run: RunInProgress, orders: Orders) -> Solution:
    """Run to the end, and write the solution if a file for it was given. Raises InputError if the run ends where it starts."""
    code = drive(run, orders.duration, Keeper.of(run, orders))
    check_started(run, code, "simulate")
    solution = as_solution(run, orders, code)
    if orders.checkpoint is not None and orders.keeps(code):
        solution.to_netcdf(orders.checkpoint)
    return solution
