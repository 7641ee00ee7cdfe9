"""Make the table of slip events, with their energies if they are wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.observables.energy.balance import event_energies
from stickslip.trajectory.history import History
from stickslip.trajectory.slip_events import SlipEvents
from stickslip.trajectory.tables import event_columns

if TYPE_CHECKING:
    import pandas as pd


def events_table(history: History, threshold: float, energies: bool = False) -> pd.DataFrame:
    """Return a table with one row per maximal interval in which |slip rate| exceeds the threshold (m/s).

    The columns are those of EVENT_COLUMNS, and of ENERGY_COLUMNS with `energies` (both in `trajectory.tables`).
    """
    return with_energies(history, SlipEvents.of(history, threshold), energies)


def with_energies(history: History, events: SlipEvents, wanted: bool) -> pd.DataFrame:
    """Return a table with one row per event, including the energies if they are wanted."""
    import pandas as pd

    table = pd.DataFrame(event_columns(history, events))
    return table.assign(**event_energies(history, events.begin, events.end)) if wanted else table
