"""Run a problem from t = 0 with its whole history."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import Parameter, signature
from pathlib import Path
from typing import Any, TypeVar, overload

from stickslip.foundation.arguments import as_path, check_names, for_users
from stickslip.foundation.atomic_write import check_replaceable
from stickslip.foundation.conversion import WithUnit
from stickslip.problem import Problem, SelectionRule
from stickslip.problem.scenarios import Scenario, read_source, under_rule
from stickslip.run.kinds import ALL_TAKE, SolverKind, Special, special_solver_of, special_solvers
from stickslip.run.options import CHECKPOINT_EVERY, RunOptions, options_of
from stickslip.run.progress import Progress, reporting
from stickslip.run.run_loop import WholeHistory, run_to_end
from stickslip.solution import Solution

Run = TypeVar("Run")


@overload
def simulate(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    rtol: float | None = None,
    *,
    creep_rtol: float | None = None,
    shortest_event: float | str | WithUnit | None = None,
    max_events: int | None = None,
    selection: str | SelectionRule | None = None,
    progress: Progress | bool | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float | str | WithUnit = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
    title: str = "",
    **of_solver: Any,
) -> Solution: ...


@overload
def simulate(
    problem: Special[Run],
    duration: float | str | WithUnit,
    *,
    progress: Callable[[Any], object] | bool | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float | str | WithUnit = CHECKPOINT_EVERY,
    **of_solver: Any,
) -> Run: ...


@for_users
def simulate(
    problem: Any,
    duration: float | str | WithUnit | None = None,
    rtol: float | None = None,
    *,
    creep_rtol: float | None = None,
    shortest_event: float | str | WithUnit | None = None,
    max_events: int | None = None,
    selection: str | SelectionRule | None = None,
    progress: Any = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float | str | WithUnit = CHECKPOINT_EVERY,
    max_pieces: int | None = None,
    title: str = "",
    **of_solver: Any,
) -> Any:
    """Run a problem, or a scenario, from t = 0: `simulate(problem, 10.0)`, `simulate("fig6-slab")`, `simulate("mine.toml")`.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path, or a problem of an extension such as PlanarSlab
        The problem itself, a scenario, the name of a bundled scenario (`stickslip.scenarios` lists them), or a scenario file.
        Options that you leave out come from the scenario. A `PlanarSlab` and a scenario with a contact of many nodes take
        `duration`, `progress`, `checkpoint` and `checkpoint_every`, and `frames`.
    duration : float or str
        Latest end of the run: a number in s, or a text with a unit such as "480 years". A scenario has one; a problem has none.
        Other times may be given as texts, too, and as quantities of the library pint.
    rtol : float, optional
        Relative tolerance of the run, between 1e-15 and 1e-2; 1e-10 by default.
    creep_rtol : float, optional
        Error of slip that leaps over creep may cause, as a share of the slip since the start: up to 1e-2, and 0 for no leaps.
        Automatic by default (see Notes).
    shortest_event : float or str, optional
        Slip events shorter than this (s) are lumped: up to 1 % of the two-way travel time, and 0 for no lumping. Automatic by
        default (see Notes).
    max_events : int, optional
        Number of slip events after which the run stops.
    selection : str or callable, optional
        The selection rule, which decides where the contact equation has several solutions: "perfect-delay", "maxwell", "minimal",
        "maximal", or one of your own (see `stickslip.selection`). By default that of the problem.
    progress : bool or callable, optional
        True shows the progress in one line, on a terminal or in a notebook. A function is called with a
        `stickslip.run.progress.Report` while the run continues.
    checkpoint : str or Path, optional
        File (.nc) that lets `stickslip.resume` continue the run, even after it has been killed. At the end it holds the solution.
        For a `PlanarSlab` a new folder (NAME.zarr); all frames are written to it.
    checkpoint_every : float or str
        Interval between two checkpoints, s of wall clock.
    max_pieces : int, optional
        Largest number of pieces of history, which are intervals with one polynomial each for load and slip rate. The default is
        two million, some 0.8 GB in memory and in a file. Whatever the number, a history takes at most a sixth of the free memory.
    title : str
        Title of the run, for figures; by default the scenario's title.
    **of_solver
        Options of the solver of an extension. For a `PlanarSlab`, `frames` is the number of frames to keep in each two-way travel
        time; 100 by default.

    Returns
    -------
    Solution or PlanarSolution
        The run; its `status` says what ended it. Ctrl-C ends the run with a valid solution up to that time.

    Raises
    ------
    InputError
        If a scenario cannot be read, an argument is out of range, the contact cannot start, or creep_rtol or shortest_event is
        positive for a problem without such leaps or lumping.

    Notes
    -----
    Under a law of slip a slab may creep for days between pulses, slipping a little in each round trip. After 200 round trips with
    slip the run leaps over creep, with an error of slip of at most 0.1 sqrt(rtol), but no less than 1e-6 and no more than 1e-3,
    times the slip since the start; before and after a leap it is exact. `solution.creep` lists the leaps. A positive creep_rtol
    sets another error and allows leaps from the start. A block that creeps swings about its moving equilibrium; runs pass over that
    in the same way.

    A slab under rate weakening may end in ever shorter events. As soon as a round trip has more than 4096 pieces, the run lumps
    events that are shorter than 1/1024 of the two-way travel time (see `stickslip.engine.input.limits`). The run up to
    there does not change; after it only the statistics of longer events are meaningful, and `solution.lumping_note` says so. A
    positive shortest_event sets another length and lumps from the start.

    A run that needs more pieces than it may have, or more memory, ends with the status "too many pieces". Its checkpoint file holds
    what it has computed, and `resume` goes on from there with a larger max_pieces.

    See Also
    --------
    stickslip.catalogue : keep slip events only, for runs of many cycles.
    stickslip.sweep : run with many values of some parameters.
    stickslip.resume : continue a run from its checkpoint.

    Examples
    --------
    >>> import stickslip as ss
    >>> solution = ss.simulate("fig6-slab")
    >>> event = solution.events.iloc[0]
    >>> print(f"{event.slip:.6f} m of slip in {event.duration:.6f} s, at up to {event.peak_rate:.6f} m/s")
    23.440233 m of slip in 5.714286 s, at up to 4.102041 m/s
    """
    with reporting(progress, "simulate") as report:
        solver = special_solver_of(problem)
        if solver is None:
            problem = read_source("simulate", problem, any_kind=True)
            solver = special_solver_of(problem) or EXACT
        given = {
            "duration": duration,
            "rtol": rtol,
            "creep_rtol": creep_rtol,
            "shortest_event": shortest_event,
            "max_events": max_events,
            "max_pieces": max_pieces,
            "title": title or None,
        }
        check_option_names(of_solver)
        solver.check("simulate", given | of_solver | {"selection": selection, "checkpoint": checkpoint})
        problem = problem if selection is None else under_rule(problem, selection)
        file = None if checkpoint is None else as_path("simulate: checkpoint", checkpoint)
        others = {"progress": report, "checkpoint": file, "checkpoint_every": checkpoint_every, "of_solver": of_solver}
        return solver.run(problem, options_of(problem, **given, **others))


def check_option_names(of_solver: Mapping[str, object]) -> None:
    """Refuse options that no solver has. Raises ArgumentError with the nearest name."""
    if of_solver:
        known = {name: None for solver in special_solvers() for name in sorted(solver.takes)}
        parameters = [one for one in signature(simulate).parameters.values() if one.kind is not one.VAR_KEYWORD]
        others = [name for name in known if name not in signature(simulate).parameters]
        more = [Parameter(name, Parameter.KEYWORD_ONLY, default=None) for name in others]
        check_names("simulate", [*parameters, *more], (None,), of_solver)


def simulate_exactly(source: Problem | Scenario, options: RunOptions) -> Solution:
    """Run a contact that slips as a whole (one node) from t = 0: see `simulate`."""
    if options.checkpoint is not None:
        check_replaceable(options.checkpoint, f"simulate: {options.checkpoint}")
    from stickslip.run.exact_run import ExactRun  # which loads the engine, as no other solver does

    problem = source if isinstance(source, Problem) else source.problem
    with options.alone():
        run = ExactRun.begin(problem, options.check("simulate", problem))
        return run_to_end(run, WholeHistory(run))


EXACT = SolverKind(
    lambda _: True,
    simulate_exactly,
    ALL_TAKE | {"rtol", "creep_rtol", "shortest_event", "max_events", "max_pieces", "selection", "title", "description"},
    "{} is for {}, and this is a single contact: leave it out",
)
"""The exact solver of a contact that slips as a whole: of every problem of the core."""
