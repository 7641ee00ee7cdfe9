"""The study of sliding: displacements of a block or a column under many records, at many yield accelerations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from stickslip.extensions.strong_motion.analyses import CaseShaken, answer_of, mass_of
from stickslip.extensions.strong_motion.asked import SlidingAsked, read_analysis, read_asked, read_length
from stickslip.extensions.strong_motion.compiled.rigid_block import (
    DISPLACEMENT,
    FIRST_START,
    LAST_STOP,
    PEAK_DISPLACEMENT,
    PEAK_TIME,
    PEAK_VELOCITY,
    SLIDING_TIME,
    SLIPS,
)
from stickslip.extensions.strong_motion.displacements import SlidingDisplacements
from stickslip.extensions.strong_motion.motion import GroundMotion, motions_of
from stickslip.foundation.arguments import for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY
from stickslip.run import TextProgress, telling

ANSWER_PLACES = {
    "displacement": DISPLACEMENT,
    "peak_displacement": PEAK_DISPLACEMENT,
    "peak_velocity": PEAK_VELOCITY,
    "peak_time": PEAK_TIME,
    "slips": SLIPS,
    "sliding_time": SLIDING_TIME,
    "first_slip": FIRST_START,
    "last_stop": LAST_STOP,
}
"""Columns of the table by their places in an answer."""
OF_RECORD = ("pga", "pgv", "arias", "duration", "mean_period")
"""Measures of a record that the table repeats, scaled as the record is."""


@for_users
def sliding(
    records: Any,
    yields: Any,
    *,
    polarity: int | str = "both",
    scale: float | Sequence[float] | None = None,
    scale_to_pga: Any = None,
    backward: Any = None,
    analysis: str = "rigid",
    column: Any = None,
    component: str | None = None,
    baseline: str | None = None,
    unit: str = "m",
    progress: TextProgress | bool | None = None,
) -> SlidingDisplacements:
    """Find how far a slope or an isolated block slides in earthquakes: every record at every yield coefficient.

    A block on shaken ground slides while the ground accelerates by more than its yield acceleration: the strength of its base less
    the pull of gravity along it, over its mass. Under straight lines between the samples of a record the answer of a rigid block is
    exact.

    Parameters
    ----------
    records : str, Path, record or several of them
        Files of strong motion, folders of them, records of `ss.loading`, or histories of acceleration with even times; a dict gives
        them names. A trace of ObsPy becomes a record by `ss.loading.record(trace, unit="m/s^2")`.
    yields : float, str or several of them
        Yield coefficients: yield accelerations as parts of g (9.80665 m/s^2), such as 0.1, or with a unit, such as "1 m/s^2".
    polarity : {"both", 1, -1}
        1 takes a record as it comes: the load on the block gains -m a, so that it slides forward while -a exceeds the yield. -1
        is the opposite, as most programs of this field have it. One-way slip has another answer for each.
    scale : float or several, optional
        Factors on the records.
    scale_to_pga : float, str or several, optional
        Peak accelerations to which each record is scaled: parts of g, or with a unit.
    backward : float, str, several of them or "same", optional
        Yield coefficients of backward slip, as on level ground; by default the block never slides backward.
    analysis : {"rigid", "coupled", "decoupled"}
        A rigid block; a column that deforms while it slides; or one that deforms first, and whose mean acceleration then moves a
        rigid block.
    column : body, optional
        The column of the last two, such as `ss.SoilColumn(..., damping_ratio=0.05)`. Its normal stress has no effect: the yields
        say how strong its base is.
    component : str, optional
        Which component of files that have several.
    baseline : {None, "mean"}
        "mean" takes the mean off each record; by default nothing is taken off.
    unit : {"m", "cm", "mm", "in", "ft"}
        Unit of displacements in texts, figures and files; the tables in memory are in SI.
    progress : bool or callable, optional
        True shows the progress in one line, on a terminal or in a notebook. A function is called with a line of text for each
        record.

    Returns
    -------
    SlidingDisplacements
        A table with one row for each record, polarity, scale and yield, a summary of each record, and statistics over all.

    Raises
    ------
    InputError
        If a record cannot be read, or an argument is out of range.
    """
    asked = read_asked("sliding", yields, backward, polarity, scale=scale, scale_to_pga=scale_to_pga)
    asked = asked._replace(analysis=read_analysis("sliding", analysis, column), column=column)
    read_length("sliding", unit)
    if column is not None:
        mass_of(column, "sliding: ")
    motions = motions_of(records, "sliding", component, baseline)
    tables: list[dict[str, Any]] = []
    cases = len(asked.polarities) * len(asked.levels.values) * len(motions)
    with telling(progress, "sliding") as tell:
        for motion in motions:
            tell(f"record {len(tables) * len(motions) // cases + 1} of {len(motions)}: {motion.name}")
            for level, scaled in zip(asked.levels.values, asked.levels.scales(motion), strict=True):
                tables += [_table_of(asked, motion, sign * scaled, level, tell) for sign in asked.polarities]
    return SlidingDisplacements(asked, tuple(motions), _joined(tables), unit)


def _table_of(asked: SlidingAsked, motion: GroundMotion, factor: float, level: float, tell: Any) -> dict[str, Any]:
    """Return the columns of one case: a value for all of its rows, or one for each yield coefficient."""
    found = answer_of(asked, CaseShaken(motion, factor), tell)
    measured = motion.measures.scaled(abs(factor))
    alike = {"record": motion.name, "polarity": 1 if factor > 0.0 else -1, "scale": abs(factor), "level": level}
    alike |= {name: getattr(measured, name) for name in OF_RECORD}
    own: dict[str, Floats] = {"yield_coefficient": asked.forward, "backward_coefficient": asked.backward}
    own["yield_ratio"] = asked.forward * GRAVITY / measured.pga if measured.pga else np.full(len(asked.forward), np.inf)
    own |= {name: found.rows[:, place] for name, place in ANSWER_PLACES.items()}
    return alike | own | {"status": found.status}


def _joined(tables: list[dict[str, Any]]) -> pd.DataFrame:
    """Return all cases in one table."""
    rows = len(tables[0]["status"])
    columns: dict[str, Any] = {}
    for name, first in tables[0].items():
        parts = [one[name] for one in tables]
        kind = object if isinstance(first, str | list) else None
        several = isinstance(first, np.ndarray | list)
        columns[name] = (
            np.concatenate([np.array(one, kind) for one in parts]) if several else np.repeat(np.array(parts, kind), rows)
        )
    if np.isfinite(columns["slips"]).all():  # else some analysis has no answer
        columns["slips"] = columns["slips"].astype(int)
    return pd.DataFrame(columns)
