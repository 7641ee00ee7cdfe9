"""Automatic choices of a run: it leaps over creep and lumps short events if it would be hopeless to follow each of them.

The engine counts what these choices depend on, so that a single run, a run that is resumed and a member of a batch make the same
choice. Until then a run is bit for bit the same as one that never leaps or lumps.
"""

from __future__ import annotations

from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, Params
from stickslip.engine_input.creep_limits import PATIENCE, missing_but_pull
from stickslip.engine_input.lumping_limits import AUTOMATIC_SHARE, MOST_PIECES, lumps_by_itself
from stickslip.problem.problem import Problem


def wait_for_creep(count: Counts, problem: Problem, creep_rtol: float | None) -> None:
    """Have the engine pause when a run that leaps automatically has had PATIENCE round trips with slip."""
    if creep_rtol is None and not missing_but_pull(problem):
        count.creep_in = PATIENCE


def set_lumping(count: Counts, problem: Problem, shortest: float | None) -> None:
    """Set the counts at t = 0 that say when short pieces are lumped: from the start, later, or never."""
    lumps = shortest is not None and shortest > 0.0
    count.lumps, count.lumped_since = lumps, 0 if lumps else at.NEVER
    count.lump_above = MOST_PIECES if shortest is None and lumps_by_itself(problem) else at.NEVER


def set_length(params: Params, shortest: float | None) -> None:
    """Set the length of the pieces that are lumped, in `Setup.params` or in one with a column for each member."""
    params.shortest = AUTOMATIC_SHARE * params.round_trip_time if shortest is None else shortest


def lumping_note(count: Counts, params: Params, shortest: float | None) -> str:
    """Return one line on automatic lumping in a run; empty if it did not begin."""
    if shortest is not None or count.lumps == 0:
        return ""
    since = count.lumped_since * params.round_trip_time
    return (
        f"events shorter than {params.shortest:.3g} s are lumped from {since:.6g} s on, where a round trip had more than"
        f" {MOST_PIECES} pieces: what follows is right only on average (shortest_event = 0 resolves every event)"
    )
