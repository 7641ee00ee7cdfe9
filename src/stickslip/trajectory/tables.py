"""Tables of a run: slip events, shocks and leaps over creep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.contact.uniqueness import uniqueness_of
from stickslip.engine.state.layout import Floats
from stickslip.engine_input.branch_table import folds_move, is_algebraic
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import History, Positions
from stickslip.trajectory.slip_events import NOT_YET, SlipEvents

if TYPE_CHECKING:
    import pandas as pd

Columns = dict[str, Any]
"""Arrays or lists of one length, by name: a table that needs no pandas, which takes a fifth of a second to import."""

EVENT_COLUMNS = {
    "start": ("s", "when |v| rises above the threshold"),
    "end": ("s", "when |v| falls to the threshold; NaN if the run ends first"),
    "duration": ("s", "end - start, without the rounding of either"),
    "recurrence": ("s", "start - start of the previous event, without the rounding of either"),
    "slip": ("m", "slip within the event, positive in either direction"),
    "peak_rate": ("m s-1", "largest |v|"),
    "peak_time": ("s", "time of the largest |v|"),
    "peak_after": ("s", "peak_time - start, without the rounding of either"),
    "traction_before": ("load", "friction just before the event begins; at rest: the load that friction carried"),
    "traction_after": ("load", "friction at rest after"),
    "traction_drop": ("load", "traction_before - traction_after"),
    "static_drop": ("load", "stiffness (G/h, or K) times slip"),
    "pulses": ("1", "maxima of |v| separated by minima below half the lower one"),
    "phase": ("1", "part of the row (round trip of a slab, period of a block) that has passed at the start"),
    "amplification": ("1", "what has become, at most, of an error of 1 in the load at the start of the run; NaN if not known"),
    "start_row": ("1", "whole rows before the start"),
    "start_offset": ("s", "the rest: start = start_row * length of a row + start_offset, without rounding"),
}
"""Columns of the catalogue: unit ("load" is Pa or N, "energy" J m-2 or J) and meaning."""

ENERGY_COLUMNS = {
    "released": ("energy", "elastic and kinetic energy that the event takes from the body"),
    "work": ("energy", "work of the driver during the event, net of what radiates through it"),
    "damped": ("energy", "dissipated by the block's damping"),
    "trapped": ("energy", "energy of waves travelling in the slab at the end, beyond that of the same mean stress at rest"),
    "heat": ("energy", "friction heat, from the law"),
    "balance": ("energy", "released + work - heat - damped: zero for an exact solution"),
}
"""Columns that energies add to the catalogue: unit and meaning, as in EVENT_COLUMNS."""

CAUSES = ("", "start", "fold", "echo", "loading", "healing")
"""Names of the causes of shocks, by their code in the history; code 0 is no shock."""


def event_columns(history: History, events: SlipEvents) -> Columns:
    """Return the columns of EVENT_COLUMNS, with one row per event."""
    begin, peak, end = events.begin, events.peak, events.end
    row, offset = history.placed(begin)
    lasts, slip = history.lasting(begin, end), np.abs(history.slipped_within(begin, end))
    before, after = friction_before(history, events), friction_after(history, events)
    since = np.full(len(row), np.nan)
    since[1:] = np.diff(row) * history.round_trip_time + np.diff(offset)
    return {
        "start": history.seconds(row, offset),
        "end": np.where(events.is_over, history.seconds(*history.placed(end)), np.nan),
        "duration": np.where(events.is_over, lasts, np.nan),
        "recurrence": since,
        "slip": slip,
        "peak_rate": events.peak_rate,
        "peak_time": history.seconds(*history.placed(peak)),
        "peak_after": history.lasting(begin, peak),
        "traction_before": history.problem.strength + before,
        "traction_after": history.problem.strength + after,
        "traction_drop": before - after,
        "static_drop": history.problem.body.stiffness * slip,
        "pulses": events.pulses,
        "phase": offset / history.round_trip_time,
        "amplification": events.largest(history.store.amplified),
        "start_row": row,
        "start_offset": offset,
    }


def friction_before(history: History, events: SlipEvents) -> Floats:
    """Return the traction minus the reference strength just before events begin.

    Where slip turns round or begins again in the instant in which it ends, the contact rests for that instant, under the load,
    unless friction resists the new slip more: an echo may turn the slip of a massless contact round at once.
    """
    begin, store = events.begin, history.store
    at_once = begin.xi == 0.0
    before = np.empty(len(at_once))
    before[~at_once] = history.friction(Positions.inside(begin.piece[~at_once], begin.xi[~at_once]))
    piece = begin.piece[at_once]
    last = history.just_before(piece)
    sliding, at_rest, mode = history.friction(last), history.excess(last), store.mode[piece]
    rests = (mode != store.mode[last.last]) | (store.rate[piece, 0] == 0.0)
    gave_way = rests & history.problem.friction.sticks & (mode * (at_rest - sliding) > 0.0)
    before[at_once] = np.where(gave_way, at_rest, sliding)
    return before


def friction_after(history: History, events: SlipEvents) -> Floats:
    """Return the traction minus the reference strength after events.

    If the slip rate falls from the end of the event to zero, this is the traction at rest. The traction of a law that strengthens
    as the rate vanishes is different an instant before rest, and would not describe what the event left behind.
    """
    by, end, mode = events.known_by(history), events.end, history.store.mode
    rests = (by != NOT_YET) & (mode[by] != mode[end.piece])
    steps = ~rests & (end.xi == 1.0) & (end.piece + 1 < len(history))
    piece = np.where(rests, by, np.where(steps, end.piece + 1, end.piece))
    return history.friction(Positions.inside(piece, np.where(rests | steps, 0.0, end.xi)))


def shocks_table(history: History, first: float = -np.inf, last: float = np.inf) -> pd.DataFrame:
    """Return a table with one row per jump of the slip rate between two times (s)."""
    import pandas as pd

    columns = shock_columns(history, first, last)
    return pd.DataFrame(columns).assign(rule=rule_in_force(history.problem) if columns["cause"] else "")


def shock_columns(history: History, first: float = -np.inf, last: float = np.inf) -> Columns:
    """Return the columns of `shocks_table` but the last one."""
    piece = np.flatnonzero((history.store.cause > 0) & (history.start >= first) & (history.start <= last))
    before, after = history.just_before(piece), Positions.inside(piece, 0.0)
    reference = history.problem.strength
    return {
        "time": history.start[piece],
        "cause": [CAUSES[cause] for cause in history.store.cause[piece]],
        "rate_before": history.rate(before),
        "rate_after": history.rate(after),
        "traction_before": reference + history.friction(before),
        "traction_after": reference + history.friction(after),
    }


def creep_table(history: History) -> pd.DataFrame:
    """Return a table with one row per leap over creep; for the columns see `Solution.creep`."""
    import pandas as pd

    row, trips, error, delay = history.creep.T
    start, end = history.seconds(row, np.zeros(len(row))), history.seconds(row + trips, np.zeros(len(row)))
    columns = {"start": start, "end": end, "start_row": row, "round_trips": trips, "error": error, "time_error": delay}
    return pd.DataFrame(columns).astype({"start_row": int, "round_trips": int})


def creep_note(creep: Floats) -> str:
    """Return one line on the leaps over creep in `History.creep`; empty if there are none."""
    if not len(creep):
        return ""
    leaps, (_, trips, error, delay) = len(creep), creep.T
    over = f"{leaps} leap{'s' * (leaps > 1)} over {int(trips.sum())} round trips"
    return f"{over}, error at most {error.max():.1e} m of slip, {delay.max():.3g} s of time"


def rule_in_force(problem: Problem) -> str:
    """Return the selection rule if the contact equation has several solutions at some load (and slip), else an empty string."""
    if not is_algebraic(problem):
        return ""
    several = folds_move(problem) or uniqueness_of(problem).regime != "regular"
    return problem.rule if several else ""
