"""Energy budget of slip events as seismologists define it: parts of the energy, stress drops, apparent stress, efficiencies.

    elastic + work = kinetic + heat + damped + balance

`waves` is the sum of three energies: that radiated through the driver; the growth of the energy trapped in the slab; and that
dissipated by the drag of layers, or by the damping of a block, which is to a block what radiation is to a slab. What a dashpot at
the contact of a slab takes is `damped`, but never was in waves. If the waves of earlier events feed an event,
`waves` is negative.
Source: Kanamori & Brodsky 2004, Rep. Prog. Phys. 67, 1429; Kanamori & Rivera 2006, AGU Geophysical Monograph 170, 3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.engine import History, Positions, SlipEvents
from stickslip.foundation.arrays import Floats
from stickslip.solution.observables.asked import observables_of
from stickslip.solution.observables.energy.balance import event_energies, taken_between
from stickslip.solution.observables.energy.pulses import Pulses
from stickslip.solution.observables.event_table import ENERGY_COLUMNS, EVENT_COLUMNS, friction_before

if TYPE_CHECKING:
    import pandas as pd

ENERGETICS_COLUMNS = {
    "start": EVENT_COLUMNS["start"].about,
    "slip": EVENT_COLUMNS["slip"].about,
    "work": ("energy", "work of the driver, net of what is radiated"),
    "elastic": ("energy", "elastic energy that the event takes from the body"),
    "kinetic": ("energy", "kinetic energy at the end less that at the start"),
    "heat": ("energy", "all work of friction, from the law: fracture energy is part of it"),
    "fracture": ("energy", "fracture energy, summed over the pulses"),
    "damped": ENERGY_COLUMNS["damped"].about,
    "radiated": ("energy", "energy radiated through a driver of finite impedance during the event"),
    "trapped": ENERGY_COLUMNS["trapped"].about,
    "waves": ("energy", "made into waves: radiated + damped inside the body + what is trapped at the end more than at the start"),
    "balance": ("energy", "elastic + work - kinetic - heat - damped: zero for an exact solution"),
    "static_drop": EVENT_COLUMNS["static_drop"].about,
    "dynamic_drop": ("load", "traction_before less the smallest traction while it slips, both against the slip"),
    "overshoot": ("1", "size of static_drop / dynamic_drop - 1: negative for an undershoot, NaN where friction does not fall"),
    "apparent_stress": ("load", "waves / size of slip"),
    "efficiency": ("1", "seismic efficiency: waves / (waves + heat + what a dashpot at the contact takes)"),
    "radiation_efficiency": ("1", "waves / (waves + fracture)"),
}
"""Columns of `Solution.energetics`: unit, as `names.si_unit` understands it, and meaning."""

DROP_ROUNDING = 1e-12
"""Rounding of a stress drop, relative to the normal stress (block: force)."""


def energetics_table(history: History, threshold: float) -> pd.DataFrame:
    """Return a table with one row per slip event above a threshold (m/s) and the columns of ENERGETICS_COLUMNS.

    A ratio of zero to zero is NaN.
    """
    import pandas as pd

    events = SlipEvents.of(history, threshold)
    begin, end = events.begin, events.end
    columns: dict[str, Floats] = {
        "start": history.seconds(*history.placed(begin)),
        "slip": history.slipped_within(begin, end),
        **_energies(history, begin, end),
    }
    pulses = Pulses.of(history, events)
    columns["fracture"] = np.asarray(np.bincount(pulses.event, pulses.fracture(history), len(begin.piece)), float)
    columns["static_drop"] = history.problem.body.stiffness * columns["slip"]
    before, smallest = extreme_tractions(history, events, pulses)
    columns["dynamic_drop"] = before - smallest
    table = pd.DataFrame(columns | _ratios(history, columns))
    return table[list(ENERGETICS_COLUMNS)]


def _energies(history: History, begin: Positions, end: Positions) -> dict[str, Floats]:
    parts = event_energies(history, begin, end)
    extra = observables_of(history.problem).energetics(history, begin, end)
    dashpot = taken_between(history, begin, end)
    made = extra["radiated"] + (parts["damped"] - dashpot) + parts["trapped"] - extra.pop("trapped_before")
    return parts | extra | {"elastic": parts["released"] + extra["kinetic"], "waves": made, "dashpot": dashpot}


def extreme_tractions(history: History, events: SlipEvents, pulses: Pulses) -> tuple[Floats, Floats]:
    """Return two tractions against the slip of each event (Pa, block: N): before it, and the smallest of its pulses."""
    smallest = np.full(len(events.pulses), np.inf)
    np.minimum.at(smallest, pulses.event, pulses.smallest_traction(history))
    return history.mode(events.begin) * (history.problem.strength + friction_before(history, events)), smallest


def _ratios(history: History, columns: dict[str, Floats]) -> dict[str, Floats]:
    drop, rounding = columns["dynamic_drop"], DROP_ROUNDING * history.problem.normal
    with np.errstate(invalid="ignore", divide="ignore"):
        waves = columns["waves"]
        return {
            "overshoot": np.where(drop > rounding, np.abs(columns["static_drop"]) / drop - 1.0, np.nan),
            "apparent_stress": waves / np.abs(columns["slip"]),
            "efficiency": waves / (waves + columns["heat"] + columns["dashpot"]),
            "radiation_efficiency": waves / (waves + columns["fracture"]),
        }
