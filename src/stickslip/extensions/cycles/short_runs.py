"""Exact runs for the search: without reports, files and counts of events, and rough ones that only lead to the next place."""

from __future__ import annotations

from stickslip.foundation.errors import InputError
from stickslip.problem import FULL_HISTORY, STATUSES, Problem, Stop
from stickslip.run import CallOptions, ExactRun
from stickslip.solution import Solution

PASSES_AT_ONCE = 20_000
"""Number of passes of the engine's loop in one call (1), between which Ctrl-C is heard."""
ROUGH_RTOL = 1e-7
"""Relative tolerance of runs that only lead to the next place (1): a cycle that is returned comes from runs as exact as wished."""


def begun(problem: Problem, lasts: float, rtol: float, max_pieces: int | None = None) -> ExactRun:
    """Return the run of a problem that lasts so long (s), at its start. Raises InputError if it cannot be run."""
    return ExactRun.begin(problem, CallOptions(duration=lasts, rtol=rtol, max_pieces=max_pieces).check("cycle", problem))


def advanced(run: ExactRun, passes: int) -> int | None:
    """Advance a run by some passes of the engine's loop, and return the code of its end; None if it goes on."""
    code = run.advance(passes)
    if code in (Stop.NONE, Stop.END_AHEAD) or (code == Stop.FULL and run.grow()):
        return None
    return FULL_HISTORY if code == Stop.FULL else code


def short_run(problem: Problem, lasts: float, rtol: float) -> Solution:
    """Return the run of a problem that lasts so long (s). Raises InputError if it ends where it starts."""
    run = begun(problem, lasts, rtol)
    while (code := advanced(run, PASSES_AT_ONCE)) is None:
        pass
    if not run.length:
        raise InputError(f"cycle: a run ends where it starts: {STATUSES[code].message}")
    return run.solution(code)
