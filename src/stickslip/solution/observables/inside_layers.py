"""Displacement, velocity and stress inside a body of layers, from its replayed waves.

In a cell of impedance Z, at the travel time d from its side nearer to the contact, the waves f = Z v - sigma and g = Z v + sigma
left the two sides of the cell d and T - d ago. The displacement relative to the contact is the integral of sigma / Z over d, which
is a difference of integrals of these waves over time: both are exact.
"""

from __future__ import annotations

import numpy as np

from stickslip.engine import Floats, History, Integers, Side
from stickslip.foundation.errors import InputError
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables.field import rounding, velocity_and_stress
from stickslip.solution.observables.layer_records import MOVED, MOVED_IN_TRIP
from stickslip.solution.observables.layers import NUMBERS_TOGETHER, LayerWaves

ROUNDING_OF_PLACE = 1e-12
"""Places may lie outside by this share (1) of the thickness."""


def field_of_layers(
    history: History, body: OfLayers, slip: Floats, *, x: Floats, t: Floats, side: Side
) -> tuple[Floats, Floats, Floats]:
    """Return displacement (m), velocity (m/s) and stress (Pa) at places x (m) and times t (s since the epoch), all of one length.

    `slip` is the displacement of the contact at these times (m). The first side has positive x. Where the other side is a slab of
    its own, that of negative x, its motion is given as an observer at rest sees it: forward slip moves it backwards. Its face has
    not been displaced at the start. Raises InputError for places outside the body.
    """
    waves = LayerWaves(history, body)
    depths = [np.append(0.0, np.cumsum(_widths(waves, n))) for n in range(len(body.stacks))]
    lowest = -depths[1][-1] if len(depths) > 1 else 0.0
    slack = ROUNDING_OF_PLACE * (depths[0][-1] - lowest)
    if not np.all((x >= lowest - slack) & (x <= depths[0][-1] + slack)):
        of_lowest = "0 (the contact)" if lowest == 0.0 else f"{lowest:g} m (the other driver)"
        raise InputError(f"field: x must lie between {of_lowest} and {depths[0][-1]:g} m (the driver)")
    cell, away = np.empty(len(x), np.int64), np.empty(len(x))
    for n, edges in enumerate(depths):
        chosen = x < 0.0 if n == 1 else x >= min(0.0, lowest)
        inside = np.clip(np.searchsorted(edges, np.abs(x[chosen]), side="right") - 1, 0, len(edges) - 2)
        share = (np.abs(x[chosen]) - edges[inside]) / np.diff(edges)[inside]
        cell[chosen], away[chosen] = waves.starts[n] + inside, waves.time * np.clip(share, 0.0, 1.0)
    found = np.empty((3, len(x)))
    together = max(NUMBERS_TOGETHER // len(waves.is_away), 1)
    for low in range(0, len(x), together):
        part = slice(low, low + together)
        found[:, part] = _field(waves, slip[part], t[part], side, cell=cell[part], away=away[part])
    return found[0], found[1], found[2]


def _widths(waves: LayerWaves, side: int) -> Floats:
    """Return the width of each cell of a side (m)."""
    layers = waves.body.stacks[side]
    return np.repeat(layers.wave_speed, layers.counts) * waves.time


def _field(waves: LayerWaves, slip: Floats, t: Floats, side: Side, *, cell: Integers, away: Floats) -> Floats:
    moments, which = np.unique(t, return_inverse=True)
    trip, phase = waves.placed(beside(waves, moments, moments, side))
    base = np.maximum(trip - 1, waves.first)
    inside = _Totals(waves, base)
    now, before = inside.at(trip, phase), inside.at(*waves.earlier(trip, phase))
    passed = np.zeros((len(moments), len(waves.is_away) + 1))
    outward, inward = (np.where(waves.is_away, now[n] - before[n], now[1 - n] - before[1 - n]) for n in (0, 1))
    strain = _strain(waves, inward - outward, waves.time)
    np.cumsum(strain, axis=1, out=passed[:, 1:])
    first = waves.starts[np.searchsorted(waves.starts, cell, side="right") - 1]

    left, came = (waves.placed(beside(waves, t - ago, t, side)) for ago in (away, waves.time - away))
    is_away, at = waves.is_away[cell], (np.arange(len(t)), cell)
    of_left, of_came = _Totals(waves, base, which), _Totals(waves, base, which)
    of_left.ends = of_came.ends = inside.ends
    to_left, to_came = of_left.at(*left), of_came.at(*came)
    here = which, cell
    f_total = np.where(is_away, now[0][here] - to_left[0][at], now[1][here] - to_left[1][at])
    g_total = np.where(is_away, to_came[1][at] - before[1][here], to_came[0][at] - before[0][here])
    f = np.where(is_away, of_left.values[0][at], of_left.values[1][at])
    g = np.where(is_away, of_came.values[1][at], of_came.values[0][at])

    impedance, reference = waves.ladder.impedance[cell], waves.reference[cell]
    rise = passed[which, cell] - passed[which, first] + (0.5 * (g_total - f_total) + reference * away) / impedance
    velocity, stress = velocity_and_stress(f, g, impedance, reference)
    if len(waves.starts) == 2 or waves.body.is_joined:
        return np.stack([slip + rise, velocity, stress])
    moved = waves.sums(trip, phase)[:, MOVED_IN_TRIP] + waves.sums(base, np.full(len(base), waves.round))[:, MOVED]
    face, sign = np.where(first > 0, moved[which], slip - moved[which]), np.where(first > 0, -1.0, 1.0)
    return np.stack([sign * (face + rise), sign * velocity, stress])


def beside(waves: LayerWaves, time: Floats, known: Floats, side: Side) -> Floats:
    """Return times (s) moved to one side of the fronts on which they lie, by the rounding of the times `known` that are asked for.

    The end of the run has one side only, the left one.
    """
    slack = rounding(known, waves.round)
    ahead = (side == "right") & (known + slack < waves.history.span[1])
    return np.asarray(time + np.where(ahead, slack, -slack))


def _strain(waves: LayerWaves, total: Floats, lasting: float) -> Floats:
    """Return the rise of the displacement (m) across each cell from the integral of g - f (Pa s)."""
    return np.asarray((0.5 * total + waves.reference * lasting) / waves.ladder.impedance)


class _Totals:
    """Integrals of E and O (Pa s) from the start of round trips `base`, or T later for O, at places in time not far behind.

    `which` says which of these round trips belongs to each place. `values` are E and O themselves (Pa) at the last places.
    """

    def __init__(self, waves: LayerWaves, base: Integers, which: Integers | None = None) -> None:
        self.waves, self.base, self.which = waves, base, np.arange(len(base)) if which is None else which
        self.values = np.empty(0), np.empty(0)
        if which is None:
            end = np.full(len(base), waves.round)
            rows = waves.rows(base, end)
            self.ends = rows[:, 1], waves.odd(rows, base, end)[:, 1]

    def at(self, trip: Integers, phase: Floats) -> tuple[Floats, Floats]:
        """Return the integrals of E and O, shape (places, cells)."""
        before = self.waves.earlier(trip, phase)
        both = self.waves.rows(*(np.concatenate(pair) for pair in zip((trip, phase), before, strict=True)))
        of_even, of_odd = both[: len(trip)], self.waves.odd(both[len(trip) :], *before)
        self.values = of_even[:, 0], of_odd[:, 0]
        passed = [(one > self.base[self.which])[:, None] for one in (trip, before[0])]
        even, odd = (np.where(past, ends[self.which], 0.0) for past, ends in zip(passed, self.ends, strict=True))
        return of_even[:, 1] + even, of_odd[:, 1] + odd
