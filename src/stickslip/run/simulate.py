"""Run a problem from t = 0 with its whole history."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from inspect import Parameter, signature
from pathlib import Path
from typing import Any, TypeVar, Unpack, overload

from stickslip.foundation.arguments import as_path, check_names
from stickslip.foundation.atomic_write import check_replaceable
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.takes import takes
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario, read_source
from stickslip.run.kinds import ALL_TAKE, SolverKind, Special, special_solver_of, special_solvers
from stickslip.run.options import CallOptions
from stickslip.run.progress import reporting
from stickslip.run.run_loop import WholeHistory, run_to_end
from stickslip.run.words import WORDS, GivenToRun
from stickslip.solution import Solution

Run = TypeVar("Run")


@overload
def simulate(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    rtol: float | None = None,
    **options: Unpack[GivenToRun],
) -> Solution: ...


@overload
def simulate(problem: Special[Run], duration: float | str | WithUnit, **options: Any) -> Run: ...


@takes(WORDS, GivenToRun, "duration", "rtol", others="of_solver")
def simulate(problem: Any, duration: float | str | WithUnit | None = None, rtol: float | None = None, **options: Any) -> Any:
    """Run a problem, or a scenario, from t = 0: `simulate(problem, 10.0)`, `simulate("fig6-slab")`, `simulate("mine.toml")`.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path, or a problem of an extension such as PlanarSlab
        The problem itself, a scenario, the name of a bundled scenario (`stickslip.scenarios` lists them), or a scenario file.
        Options that you leave out come from the scenario. A `PlanarSlab` and a scenario with a contact of many nodes take
        `duration`, `progress`, `checkpoint` and `checkpoint_every`, and `frames`.
    {options}
    **of_solver
        Options of the solver of an extension. For a `PlanarSlab`, `frames` is the number of frames to keep in each two-way travel
        time; 100 by default. For a `Chain`, `keep="changes"` keeps each onset, arrest and turn of a block, too.

    Returns
    -------
    Solution, PlanarSolution or ChainRun
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
    progress, rule, checkpoint = (options.pop(name, None) for name in ("progress", "selection", "checkpoint"))
    of_solver = {name: options.pop(name) for name in [*options] if name not in WORDS}
    check_option_names(of_solver)
    with reporting(progress, "simulate") as report:
        solver = special_solver_of(problem)
        if solver is None:
            problem = read_source("simulate", problem, duration, any_kind=True)
            solver = special_solver_of(problem) or EXACT
        given = {"duration": duration, "rtol": rtol} | options | {"title": options.get("title") or None}
        solver.check("simulate", given | of_solver | {"selection": rule, "checkpoint": checkpoint})
        if rule is not None:
            problem = replace(problem, problem=replace(problem.problem, selection=rule))
        file = None if checkpoint is None else as_path("simulate: checkpoint", checkpoint)
        return solver.run(problem, CallOptions.of(problem, **given, progress=report, checkpoint=file, of_solver=of_solver))


def check_option_names(of_solver: Mapping[str, object]) -> None:
    """Refuse options that no solver has. Raises ArgumentError with the nearest name."""
    if of_solver:
        taken = [one for one in signature(simulate).parameters.values() if one.kind is not one.VAR_KEYWORD]
        others = dict.fromkeys(name for solver in special_solvers() for name in sorted(solver.takes))
        more = [Parameter(name, Parameter.KEYWORD_ONLY, default=None) for name in others if name not in WORDS]
        check_names("simulate", [*taken, *more], (None,), of_solver)


def simulate_exactly(scenario: Scenario, options: CallOptions) -> Solution:
    """Run a contact that slips as a whole (one node) from t = 0: see `simulate`."""
    if options.checkpoint is not None:
        check_replaceable(options.checkpoint, f"simulate: {options.checkpoint}")
    from stickslip.run.exact_run import ExactRun  # which loads the engine, as no other solver does

    with options.alone():
        run = ExactRun.begin(scenario.problem, options.check("simulate", scenario.problem))
        return run_to_end(run, WholeHistory(run))


EXACT = SolverKind(
    lambda _: True,
    simulate_exactly,
    ALL_TAKE | {"rtol", "creep_rtol", "shortest_event", "max_events", "max_pieces", "selection", "title", "description"},
    "{} is for {}, and this is a single contact: leave it out",
)
"""The exact solver of a contact that slips as a whole: of every problem of the core."""
