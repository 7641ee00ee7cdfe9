"""Tables of slip events as parts of a fit: what a run is compared with where nobody kept the record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stickslip.extensions.inference.fit.asked import FITTED_KINDS
from stickslip.extensions.inference.fit.part import Part
from stickslip.extensions.inference.record.features import LEVELS_OF_SHEAR
from stickslip.extensions.inference.record.record import SHEAR_IN, Record, is_of
from stickslip.extensions.inference.words import Wishes
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem

CYCLES = 6.0
"""Length of a run, in recurrence times of the record; the first events are skipped."""


@dataclass(frozen=True, eq=False)
class EventPart(Part):
    """Slip events from a table: there are no samples of them."""

    @cached_property
    def duration(self) -> float:
        """The length of a run (s): enough for several events, and for the way to the first one."""
        cycles = CYCLES if self.start == "record" else 2.0 * CYCLES
        return cycles * float(np.nanmedian(self.record.measured["recurrence"]))

    def first_load(self, normal: float) -> tuple[float, float]:
        """Return the load after an event and its standard error. Raises InputError if the table has none."""
        shear = self.record.shear_of_events
        rest = self.record.measured.get(f"{shear}_{LEVELS_OF_SHEAR[1]}")
        if rest is None:
            raise InputError(f"{self.record.name}: no shear after events is in the table: start='problem'")
        known, scale = rest[np.isfinite(rest)], normal if shear == "friction" else 1.0
        return float(known.mean()) * scale, float(known.std() / math.sqrt(len(known))) * scale


def are_tables(records: Sequence[Record], wishes: Wishes) -> bool:
    """Return True if records are tables of events. Raises InputError if they are fitted in another way, or only some are."""
    tables = [record for record in records if record.shear_of_events is not None]
    if tables and wishes.by != "features":
        raise InputError(f"{tables[0].name}: is a table of slip events, and no record of samples: fit it with by='features'")
    if tables and (len(tables) < len(records) or wishes.held_out is not None or wishes.normal == "record"):
        what = (
            "records of samples beside it" if len(tables) < len(records) else "held_out" if wishes.held_out else "normal='record'"
        )
        raise InputError(f"{tables[0].name}: is a table of slip events, which allows no {what}")
    return bool(tables)


def parts_of_events(problem: Problem, records: Sequence[Record], start: str | None, sensor: str) -> tuple[list[Part], list[str]]:
    """Return a part for each table of events, and sentences on them. Raises InputError for one that the problem does not fit."""
    FITTED_KINDS[problem.body.structure].check_sensor(problem.body, sensor)
    found, notes = list[Part](), list[str]()
    for record in records:
        shear = record.shear_of_events
        assert shear is not None
        if not is_of(shear, problem):
            loads = f"the loads of a {problem.body.noun} are in {problem.load_unit}, and {shear} in {record.unit_of(shear)}"
            raise InputError(f"{record.name}: {loads}: give friction, or {SHEAR_IN[problem.load_unit]}")
        has_rest = f"{shear}_{LEVELS_OF_SHEAR[1]}" in record.measured
        found.append(EventPart(record, None, (), sensor, start or ("record" if has_rest else "problem")))
        lost = {name: int((~np.isfinite(values)).sum()) for name, values in record.measured.items()}
        notes += [*record.notes, f"{record.name} is a table of events: the loading is that of the problem"]
        notes += [f"{name} has no number in {count} of {len(record)} events" for name, count in lost.items() if count]
    return found, notes
