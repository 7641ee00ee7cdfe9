"""The table of slip events. A column is declared once, in EVENT_COLUMNS or, if it needs the energies, in ENERGY_COLUMNS.

The declaration says what a column is called, its unit and meaning, how it is computed, and whether summaries show it. The table,
files, summaries and the tables of the paper all follow from it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import NOT_YET, Floats, History, Integers, Positions, SlipEvents
from stickslip.foundation.arguments import check_type, for_users
from stickslip.foundation.names import in_files, si_unit
from stickslip.solution.observables.energy.balance import event_energies

if TYPE_CHECKING:
    import pandas as pd

COLUMNS_DESCRIBED = ("recurrence", "duration", "slip", "peak_rate", "traction_drop", "static_drop", "released", "trapped")
"""Columns of a catalogue whose distribution is described, if the table has them."""

DIRECTED = ("slip", "static_drop")
"""Columns that are negative for an event that slips back: statistics describe their sizes."""

NO_SPREAD = 1e-9
"""Relative spread below which values count as equal: the correlation of successive values then says nothing."""


@for_users
def catalogue_statistics(table: pd.DataFrame) -> pd.DataFrame:
    """Return statistics of the events of a catalogue, such as `Solution.events`, one row per quantity, in the unit of the quantity.

    Columns: `count`; `mean`; `deviation`, the sample's standard deviation; `variation`, which is deviation / mean (of the
    recurrence times: 0 periodic, 1 as random as a Poisson process, above 1 clustered); `smallest`, `median`, `largest`; and `next`,
    the correlation of a value with the value of the next event. Values are NaN if there are too few events. An event that is cut
    off by the end of the run counts in the recurrence only. Slips, and the drops that are the stiffness times them, count by their
    sizes, in whichever direction.
    """
    import pandas as pd

    check_type("catalogue_statistics: table", table, pd.DataFrame, "a table of slip events, such as solution.events")
    rows = {name: _describe(pd.Series(that_count(table, name))) for name in COLUMNS_DESCRIBED if name in table}
    frame = pd.DataFrame.from_dict(rows, orient="index", columns=list(_describe(table.slip[:0])))
    return frame.astype({"count": int})


def that_count(events: Mapping[Any, Any] | pd.DataFrame, name: str) -> Floats:
    """Return the values of a column that count in statistics: finite, and not of an event that the end of the run cuts off.

    The recurrence of such an event does count: it ends where the event begins. What has the sign of its direction counts by its
    size.
    """
    values = np.asarray(events[name], float)
    values = np.abs(values) if name in DIRECTED else values
    over = np.isfinite(np.asarray(events["end"], float))
    counted: Floats = values[np.isfinite(values) & (over | (name == "recurrence"))]
    return counted


def _describe(values: pd.Series[float]) -> dict[str, float]:
    mean, deviation = values.mean(), values.std()
    return {
        "count": len(values),
        "mean": mean,
        "deviation": deviation,
        "variation": deviation / mean if mean != 0.0 else np.nan,
        "smallest": values.min(),
        "median": values.median(),
        "largest": values.max(),
        "next": _next(np.asarray(values, float)),
    }


def _next(values: NDArray[np.float64]) -> float:
    """Return the correlation of each value with the next one."""
    now, later = values[:-1], values[1:]
    if len(now) < 3 or min(np.ptp(now), np.ptp(later)) <= NO_SPREAD * np.abs(values).max():
        return np.nan
    return float(np.corrcoef(now, later)[0, 1])


@dataclass(frozen=True)
class FoundEvents:
    """Slip events in a history, with what several columns of their table need. Forces of a block are in N instead of Pa."""

    history: History
    events: SlipEvents

    @cached_property
    def placed(self) -> tuple[Integers, Floats]:
        """The starts of the events: whole rows since t = 0, and offsets in s."""
        return self.history.placed(self.events.begin)

    @cached_property
    def slip(self) -> Floats:
        """The slip within each event, m; negative where the contact slips back."""
        return self.history.slipped_within(self.events.begin, self.events.end)

    @cached_property
    def before(self) -> Floats:
        """The traction minus the reference strength just before each event, Pa."""
        return friction_before(self.history, self.events)

    @cached_property
    def after(self) -> Floats:
        """The traction minus the reference strength after each event, Pa."""
        return friction_after(self.history, self.events)

    @cached_property
    def energies(self) -> dict[str, Floats]:
        """The energies of each event, J/m^2 (block: J)."""
        return event_energies(self.history, self.events.begin, self.events.end)

    def if_over(self, values: Floats) -> Floats:
        """Return values, with NaN for events that are not over within the history."""
        return np.where(self.events.is_over, values, np.nan)

    def recurrence(self) -> Floats:
        """Return the time (s) from the start of the previous event to the start of each event, NaN for the first."""
        row, offset = self.placed
        since = np.full(len(row), np.nan)
        since[1:] = np.diff(row) * self.history.round_trip_time + np.diff(offset)
        return since


@dataclass(frozen=True)
class Column:
    """A column of the table of slip events: its SI unit, what it holds, and what computes it for each event.

    The units "slip", "slip_rate", "load" and "energy" stand for those of the body (`names.si_unit`). `place` is its place in
    summaries on a terminal, counted from 1; 0 if they do not show it.
    """

    unit: str
    meaning: str
    of: Callable[[FoundEvents], Any]
    place: int = 0

    @property
    def about(self) -> tuple[str, str]:
        """Unit and meaning."""
        return self.unit, self.meaning


EVENT_COLUMNS = {
    "start": Column("s", "when |v| rises above the threshold", lambda e: e.history.seconds(*e.placed), 1),
    "end": Column(
        "s",
        "when |v| falls to the threshold; NaN if the run ends first",
        lambda e: e.if_over(e.history.seconds(*e.history.placed(e.events.end))),
    ),
    "duration": Column(
        "s",
        "end - start, without the rounding of either",
        lambda e: e.if_over(e.history.lasting(e.events.begin, e.events.end)),
        2,
    ),
    "recurrence": Column("s", "start - start of the previous event, without the rounding of either", FoundEvents.recurrence),
    "slip": Column("slip", "slip within the event; negative if it slips back", lambda e: e.slip, 4),
    "peak_rate": Column("slip_rate", "largest |v|", lambda e: e.events.peak_rate, 5),
    "peak_time": Column("s", "time of the largest |v|", lambda e: e.history.seconds(*e.history.placed(e.events.peak))),
    "peak_after": Column(
        "s",
        "peak_time - start, without the rounding of either",
        lambda e: e.history.lasting(e.events.begin, e.events.peak),
        3,
    ),
    "traction_before": Column(
        "load",
        "friction just before the event begins; at rest: the load that friction carried",
        lambda e: e.history.problem.strength + e.before,
    ),
    "traction_after": Column("load", "friction at rest after", lambda e: e.history.problem.strength + e.after),
    "traction_drop": Column("load", "traction_before - traction_after", lambda e: e.before - e.after, 6),
    "static_drop": Column("load", "stiffness of the body times slip", lambda e: e.history.problem.body.stiffness * e.slip, 7),
    "pulses": Column("1", "maxima of |v| separated by minima below half the lower one", lambda e: e.events.pulses, 8),
    "phase": Column(
        "1",
        "part of the row (round trip, or period of a block) that has passed at the start",
        lambda e: e.placed[1] / e.history.round_trip_time,
    ),
    "amplification": Column(
        "1",
        "what has become, at most, of an error of 1 in the load at the start of the run; NaN if not known",
        lambda e: e.events.largest(e.history.store.amplified),
    ),
    "start_row": Column("1", "whole rows before the start", lambda e: e.placed[0]),
    "start_offset": Column(
        "s", "the rest: start = start_row * length of a row + start_offset, without rounding", lambda e: e.placed[1]
    ),
}
"""Columns of the catalogue."""

ENERGY_COLUMNS = {
    "released": Column("energy", "elastic and kinetic energy that the event takes from the body", lambda e: e.energies["released"]),
    "work": Column("energy", "work of the driver during the event, net of what radiates through it", lambda e: e.energies["work"]),
    "damped": Column("energy", "dissipated by damping of block or contact, or drag of layers", lambda e: e.energies["damped"]),
    "trapped": Column(
        "energy",
        "energy of waves travelling in the body at the end, beyond that of the same mean stress at rest",
        lambda e: e.energies["trapped"],
    ),
    "heat": Column("energy", "friction heat, from the law", lambda e: e.energies["heat"]),
    "balance": Column("energy", "released + work - heat - damped: zero for an exact solution", lambda e: e.energies["balance"]),
}
"""Columns that energies add to the catalogue."""

NEEDED = ("start", "end", "recurrence", "slip")
"""Columns without which a table is no catalogue. Others may be missing from the file of another version."""


def column_unit(name: str, load_unit: str) -> str:
    """Return the unit of a column of the table of slip events, as files spell it; "" for a column that is not known."""
    known = EVENT_COLUMNS | ENERGY_COLUMNS
    return in_files(si_unit(known[name].unit, load_unit)) if name in known else ""


def with_units(table: pd.DataFrame, load_unit: str) -> pd.DataFrame:
    """Return a table of slip events whose headings name the units of columns that are known, such as "slip (m)"."""
    known = EVENT_COLUMNS | ENERGY_COLUMNS
    units = {name: si_unit(one.unit, load_unit) for name, one in known.items()}
    return table.rename(columns={name: f"{name} ({unit})" for name, unit in units.items() if unit != "1"})


def shown_columns() -> list[str]:
    """Return the names of the columns that summaries show, in their order."""
    return sorted((name for name, one in EVENT_COLUMNS.items() if one.place), key=lambda name: EVENT_COLUMNS[name].place)


def events_table(history: History, threshold: float, energies: bool = False) -> pd.DataFrame:
    """Return a table with one row per maximal interval in which |slip rate| exceeds the threshold (m/s).

    The columns are those of EVENT_COLUMNS, and of ENERGY_COLUMNS with `energies`.
    """
    return with_energies(history, SlipEvents.of(history, threshold), energies)


def with_energies(history: History, events: SlipEvents, wanted: bool) -> pd.DataFrame:
    """Return a table with one row per event, including the energies if they are wanted."""
    import pandas as pd

    return pd.DataFrame(event_columns(history, events, energies=wanted))


def event_columns(history: History, events: SlipEvents, *, energies: bool = False) -> dict[str, Any]:
    """Return the columns of EVENT_COLUMNS, and of ENERGY_COLUMNS with `energies`, with one row per event.

    They need no pandas, which takes a fifth of a second to import.
    """
    found = FoundEvents(history, events)
    return {name: one.of(found) for name, one in (EVENT_COLUMNS | (ENERGY_COLUMNS if energies else {})).items()}


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
