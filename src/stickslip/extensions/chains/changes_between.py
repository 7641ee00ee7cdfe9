"""The changes of blocks in a part of a run, and how long each block slipped, for figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stickslip.extensions.chains.compiled.memory import ARREST, ONSET
from stickslip.foundation.arguments import check_whole
from stickslip.foundation.arrays import Floats, Integers1
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun


class Slips(NamedTuple):
    """Blocks that slipped: which, from when to when (s), and by how much (m); ends are NaN where slip goes on."""

    block: Integers1
    onset: Floats
    arrest: Floats
    slip: Floats


def changes_between(run: ChainRun, start: float, end: float) -> Any:
    """Return the changes from `start` to `end` (s); if the run did not keep them, that part is solved again."""
    if run.change_rows is not None:
        found = run.changes
    else:
        from stickslip.extensions.chains.solver import solve_chain

        before = [one for one in run.snapshots if one.time <= start] or run.snapshots[:1]
        known = before[-1] if before[-1].time > 0.0 else None  # the start has changes of its own
        found = solve_chain(run.chain, end, known, keep="changes").changes
    return found[(found["time"] >= start) & (found["time"] <= end)]


def slips_of(changes: Any, end_slip: Floats) -> Slips:
    """Return the slips of blocks between their changes; of one that goes on, up to the slip at the end (m)."""
    counts = (changes["kind"] == ONSET) | (changes["kind"] == ARREST)
    kept = changes[counts][np.argsort(changes["block"][counts], kind="stable")]
    begins = kept["kind"] == ONSET
    block, following = kept["block"], np.append(kept[1:], kept[:1])
    ends = (following["block"] == block) & (following["kind"] == ARREST)
    ends[-1:] = False
    arrest = np.where(ends, following["time"], np.nan)
    slip = np.where(ends, following["slip"], end_slip[block]) - kept["slip"]
    return Slips(block[begins], kept["time"][begins], arrest[begins], slip[begins])


def window_of(
    run: ChainRun, event: int | None, start: float | str | None, end: float | str | None, *, where: str = "plot.rupture"
) -> tuple[float, float, int | None]:
    """Return the times (s) to draw, and the event that they hold, if it is one. Raises InputError, which begins with `where`.

    Without times and event that is the event with the largest moment.
    """
    if start is not None or end is not None:
        if event is not None:
            raise InputError(f"{where}: give an event, or start and end, not both")
        first, last = _time(where, "start", start, 0.0), _time(where, "end", end, run.duration)
        if not 0.0 <= first < last <= run.duration:
            raise InputError(f"{where}: start and end must ascend from 0 to {run.duration:g} s, got {first:g} and {last:g}")
        return first, last, None
    if not len(run.events):
        raise InputError(f"{where}: the run has no finished event; give start and end")
    n = int(np.abs(run.events["moment"]).argmax()) if event is None else event
    check_whole(f"{where}: event", n, 0, len(run.events) - 1)
    begins, lasts = float(run.events["time"][n]), float(run.events["duration"][n])
    return begins, min(begins + lasts * (1.0 + 1e-9), run.duration), n


def _time(where: str, name: str, given: float | str | None, default: float) -> float:
    """Return a time (s) as it was given, by itself or with a unit, or the default."""
    from stickslip.extensions.chains.run import TIME

    return default if given is None else float(TIME.check(where, name, given))
