"""Pulses of slip events, and their fracture energy, which is the energy that each spends on weakening the contact.

Fracture energy is Tinti's breakdown work: the work of friction above the smallest traction of the pulse, from the start of the
pulse until that traction is reached. For a contact that weakens with slip to a residual traction it is the area between that
traction and the curve of traction against slip. It is a part of the friction heat of the run, not another loss.
Source: Tinti et al. 2005, J. Geophys. Res. 110, B12303; Abercrombie & Rice 2005, Geophys. J. Int. 162, 406.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, Positions, SlipEvents, Turn, walk
from stickslip.foundation.arrays import Floats
from stickslip.solution.observables.quadrature import between

if TYPE_CHECKING:
    import pandas as pd

PULSE_COLUMNS = {
    "event": ("1", "row of the event in the catalogue"),
    "start": ("s", "start of the event, or where |v| is smallest since the pulse before"),
    "start_after": ("s", "time from the start of the event to that of the pulse, without rounding"),
    "duration": ("s", "time until the next pulse, or the end of the event"),
    "slip": ("slip", "slip during the pulse; negative if it slips back"),
    "peak_rate": ("slip_rate", "largest |v|"),
    "smallest_traction": ("load", "smallest traction of the pulse while it slips, against the slip"),
    "weakening_slip": ("slip", "slip until the smallest traction"),
    "fracture": ("energy", "fracture energy: work of friction above the smallest traction until that is reached"),
}
"""Columns of `Solution.pulses`: unit, as `names.si_unit` understands it, and meaning."""

GRID = 17
"""Number of places on a piece to compare in search of the smallest traction."""
REFINEMENTS = 14
"""Refine the grid this many times, by a factor of 8, around the smallest traction."""


class Pulses(NamedTuple):
    """Pulses in order of time: the event of each; where it begins, is weakest and ends; and its largest slip rate (m/s)."""

    event: NDArray[np.intp]
    begin: Positions
    weakest: Positions
    end: Positions
    peak_rate: Floats

    @classmethod
    def of(cls, history: History, events: SlipEvents) -> Pulses:
        """Find the pulses of these slip events: some or all of those in the history."""
        turns = Turn.of(walk(history, events.threshold, int(events.piece[0].min(initial=len(history)))))
        piece, xi, rate, kind = turns.piece, turns.xi, turns.rate, turns.kind
        starts = np.flatnonzero(kind == 1)
        # Piece plus half of xi puts places in order; the end of a piece stays before the start of the next one.
        which = np.searchsorted(piece[starts] + 0.5 * xi[starts], events.piece[0] + 0.5 * events.xi[0])
        begins, pasts = starts[which], np.append(starts, len(kind))[which + 1]
        places = [_starts(rate, begin, past) for begin, past in zip(begins.tolist(), pasts.tolist(), strict=True)]
        event = np.repeat(np.arange(len(places)), [len(found) for found in places])
        first = np.concatenate([*places, np.empty(0, np.intp)]).astype(np.intp)
        last_of_event = np.append(event[1:] != event[:-1], np.full(len(event[:1]), True))
        past = np.where(last_of_event, pasts[event] - 1, np.append(first[1:], 0))
        begin, end = (Positions.inside(piece[where], xi[where]) for where in (first, past))
        peak = np.array([rate[a : b + 1].max() for a, b in zip(first.tolist(), past.tolist(), strict=True)])
        return cls(event, begin, _weakest(history, begin, end), end, peak)

    def fracture(self, history: History) -> Floats:
        """Return the fracture energy of each pulse, J/m^2 (block: J)."""
        traction, reference = history.resistance, history.problem.strength

        def power(at: Positions) -> Floats:
            return (traction(at) - reference) * np.abs(history.rate(at))

        spent = between(history, self.begin, self.weakest, power)
        return spent - (traction(self.weakest) - reference) * self.weakening_slip(history)

    def weakening_slip(self, history: History) -> Floats:
        """Return the slip of each pulse until its smallest traction, m."""
        return np.abs(history.slipped_within(self.begin, self.weakest))

    def smallest_traction(self, history: History) -> Floats:
        """Return the smallest traction of each pulse against its slip (Pa, block: N)."""
        return history.resistance(self.weakest)


def pulses_table(history: History, threshold: float) -> pd.DataFrame:
    """Return a table with one row per pulse of the slip events above a threshold (m/s) and the columns of PULSE_COLUMNS."""
    import pandas as pd

    events = SlipEvents.of(history, threshold)
    pulses = Pulses.of(history, events)
    begun = events.begin
    event_begin = Positions.inside(begun.piece[pulses.event], begun.xi[pulses.event])
    columns = {
        "event": pulses.event,
        "start": history.seconds(*history.placed(pulses.begin)),
        "start_after": history.lasting(event_begin, pulses.begin),
        "duration": history.lasting(pulses.begin, pulses.end),
        "slip": history.slipped_within(pulses.begin, pulses.end),
        "peak_rate": pulses.peak_rate,
        "smallest_traction": pulses.smallest_traction(history),
        "weakening_slip": pulses.weakening_slip(history),
        "fracture": pulses.fracture(history),
    }
    return pd.DataFrame(columns)


def _starts(rate: Floats, begin: int, past: int) -> list[int]:
    """Return the first index of each pulse of an event among the turning points of |v|.

    The pulses are those that `engine.history.slip_events.group_turns` counts.
    """
    found: list[int] = []
    peak, low = 0.0, begin
    for k in range(begin, past):
        if rate[k] <= 0.0:
            continue
        if not found or rate[low] < 0.5 * min(peak, rate[k]):
            found.append(low if found else begin)
            peak, low = rate[k], k
        elif rate[k] > peak:
            peak, low = rate[k], k
        elif rate[k] < rate[low]:
            low = k
    return found


def _weakest(history: History, begin: Positions, end: Positions) -> Positions:
    """Find the positions of the smallest traction against slip (the first, if several are equal) between pairs of positions.

    The search compares places on a grid, and then refines it.
    """
    count = end.piece - begin.piece + 1
    owner = np.repeat(np.arange(len(count)), count)
    piece = begin.piece[owner] + np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    low = np.where(piece == begin.piece[owner], begin.xi[owner], 0.0)
    high = np.where(piece == end.piece[owner], end.xi[owner], 1.0)
    xi, value = _lowest(history, piece, low, high)
    order = np.lexsort((value, owner))
    best = order[np.searchsorted(owner[order], np.arange(len(count)))]
    piece, xi, low, high = piece[best], xi[best], low[best], high[best]
    width = (high - low) / (GRID - 1)
    for _ in range(REFINEMENTS):
        xi, _ = _lowest(history, piece, np.maximum(xi - width, low), np.minimum(xi + width, high))
        width = width / 8.0
    return Positions.inside(piece, xi)


def _lowest(history: History, piece: NDArray[np.intp], low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return the place of the smallest traction in each piece on a grid from low to high (xi), and that traction."""
    xi = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, GRID)
    values = history.resistance(Positions.inside(np.repeat(piece, GRID), xi.ravel())).reshape(xi.shape)
    chosen = np.arange(len(piece)), np.argmin(values, axis=1)
    return xi[chosen], values[chosen]
