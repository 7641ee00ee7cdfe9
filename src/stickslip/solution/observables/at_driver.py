"""Rate and load at the driver of a run: what a sensor at the top drive of a string, or behind the spring of a block, measures.

At the face that the driver holds the two waves of a body with waves meet: the one that left the contact h/c ago, and the one that
the driver sends back, which reaches the contact h/c later. Half their difference is the load there, half their sum over Z the rate.
A block has no waves: its driver moves at the pull rate, and bears the force of the spring.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine import History, Side
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import OfLayers, as_waves
from stickslip.solution.observables.energy.ground import spring_force
from stickslip.solution.observables.inside_layers import beside
from stickslip.solution.observables.layer_records import VALUE
from stickslip.solution.observables.layers import MOST, LayerWaves
from stickslip.solution.observables.waves import Waves

ROUNDING = 4.0
"""Times within so many units in the last place of a front lie on it."""


class AtDriver(NamedTuple):
    """What is measured at the driver at some times, one-dimensional."""

    rate: Floats
    """Velocity of the face that the driver holds, m/s."""
    load: Floats
    """Shear stress there (Pa, N or N m), positive if the driver pulls forwards."""


def at_driver(history: History, time: Floats, side: Side) -> AtDriver:
    """Return rate and load at the (first) driver at times (s since the epoch); at a jump on the given side.

    Raises InputError for times outside the run, and for a side that is none.
    """
    begin, end = history.span
    found = history.find(time, side)  # raises InputError
    body, begun = history.problem.body, history.epoch.trip * history.round_trip_time + history.epoch.offset
    if isinstance(body, OfLayers):
        return _of_layers(history, body, time, side)
    slack = ROUNDING * np.spacing(np.maximum(np.abs(time), history.round_trip_time)) * (1.0 if side == "left" else -1.0)
    if not body.has_waves:
        rate = history.problem.pull_rate_at(np.maximum(begun + time - slack, 0.0))
        return AtDriver(np.asarray(rate, float), history.problem.strength + spring_force(history, found))
    waves = Waves(history, as_waves(body))
    left = time - waves.half  # when the wave that meets the driver left the contact
    in_run = left - slack >= begin if side == "right" else left - slack > begin
    leaving = waves.left_before(np.minimum(left - begin, 0.0))
    if in_run.any():
        leaving[in_run] = waves.leaving(history.find(np.clip(left - slack, begin, end)[in_run], side))
    sent_back = waves.arriving(leaving, left - begin, slack)
    rate = (leaving + sent_back) / (2.0 * body.impedance)
    return AtDriver(rate, waves.reference + 0.5 * (sent_back - leaving))


def _of_layers(history: History, body: OfLayers, time: Floats, side: Side) -> AtDriver:
    """Return the same for a body of layers, whose waves are replayed up to the last cell of the first side."""
    waves = LayerWaves(history, body)
    last = int(waves.last[0])
    found = np.empty((2, len(time)))
    together = max(MOST // (2 * len(waves.is_away)), 1)
    for low in range(0, len(time), together):
        part = time[low : low + together]
        away, back = (waves.placed(beside(waves, part - ago, part, side)) for ago in (waves.time, 0.0))
        of_even, of_odd = (away, back) if waves.is_away[last] else (back, away)
        before = waves.earlier(*of_odd)
        both = waves.waves(*(np.concatenate(pair) for pair in zip(of_even, before, strict=True)))
        even, odd = both[: len(part), last], waves.odd(both[len(part) :, None], *before)[:, VALUE, last]
        found[:, low : low + together] = (even, odd) if waves.is_away[last] else (odd, even)
    met, sent = found
    impedance, reference = float(waves.ladder.impedance[last]), float(waves.reference[last])
    return AtDriver((met + sent) / (2.0 * impedance), reference + 0.5 * (sent - met))


def fronts_at_driver(history: History) -> Floats:
    """Return the times (s since the epoch) when the ends of recorded pieces are at the driver, in the run, and the run's ends.

    In layers these are the fronts that come straight from the contact.
    """
    begin, end = history.span
    body = history.problem.body
    way = sum(body.stacks[0].counts) * body.cells.time if isinstance(body, OfLayers) else body.inflow_delay
    fronts = history.breaks + way
    return np.concatenate([[begin], fronts[(fronts > begin) & (fronts < end)], [end]])
