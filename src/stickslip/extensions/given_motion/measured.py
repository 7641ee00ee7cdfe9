"""Read a record of measured motion and friction: slip rate or slip, force, and the normal load if it is there."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stickslip.foundation.arguments import as_path, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.columns import Table, read_mapping
from stickslip.foundation.errors import InputError
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.text_columns import read_file

LARGEST_RECORD, MOST_ROWS = 500_000_000, 1_000_000
"""Largest size of a file (bytes), and largest number of its rows."""
LEAST_ROWS = 20
"""Least number of samples."""
OF_LOAD = {"shear_force": "N", "shear_stress": "Pa", "torque": "N m", "friction": ""}
"""Columns of friction, each with its unit; a friction coefficient takes that of the normal load."""
OF_NORMAL = {"normal_force": "N", "normal_stress": "Pa", "normal_torque": "N m"}
"""Columns of the normal load, each with its unit."""
MOTIONS = {"slip_rate": False, "slip": False, "slip_rotation": True, "slip_angle": True}
"""Columns of motion; True for those of a contact that turns."""
RECORD_COLUMNS = (
    *("time", *OF_LOAD, *OF_NORMAL, *MOTIONS),
    *("shear_force_deviation", "shear_stress_deviation", "torque_deviation", "friction_deviation"),
    *("slip_rate_deviation", "slip_deviation"),
)


@dataclass(frozen=True, eq=False)
class MeasuredMotion:
    """A record in SI: time (s, from 0), friction (N, Pa, N m, or 1 where it is a coefficient), and slip rate (m/s) or slip (m)."""

    name: str
    time: Floats
    friction: Floats
    unit: str
    """The unit of friction: N, Pa or N m; "" for a coefficient."""
    rate: Floats | None
    slip: Floats | None
    normal: Floats | None
    normal_unit: str
    friction_deviation: Floats | None
    motion_deviation: Floats | None
    turns: bool

    @classmethod
    def read(cls, source: Any, columns: Mapping[str, str | int] | None = None) -> MeasuredMotion:
        """Read a file, or columns by their headings. Raises InputError with the place and the cure."""
        named = NamedColumns(columns or {})
        table = _table(source, named)
        found, where = table.columns, table.at_header or table.place
        if "time" not in found:
            raise InputError(f"{where}: no column 'time'")
        force = next((name for name in OF_LOAD if name in found), None)
        if force is None:
            raise InputError(f"{where}: no column of friction: {', '.join(OF_LOAD)}")
        motion = next((name for name in MOTIONS if name in found), None)
        if motion is None:
            raise InputError(f"{where}: no column of motion: slip_rate, or slip")
        normal = next((name for name in OF_NORMAL if name in found), None)
        if normal and OF_LOAD[force] not in ("", OF_NORMAL[normal]):
            raise InputError(f"{where}: {force} is in {OF_LOAD[force]}, and {normal} in {OF_NORMAL[normal]}")
        used = [name for name in ("time", force, motion, normal) if name]
        whole = np.all([np.isfinite(found[name]) for name in used], axis=0)
        if whole.sum() < LEAST_ROWS:
            raise InputError(f"{where}: {int(whole.sum())} rows with {', '.join(used)}: at least {LEAST_ROWS} are needed")
        order = np.flatnonzero(whole)
        time = found["time"][order]
        if not (np.diff(time) > 0.0).all():
            n = int(np.flatnonzero(np.diff(time) <= 0.0)[0])
            raise InputError(f"{where}: time must ascend, but {time[n + 1]:g} s follows {time[n]:g} s")

        def of(name: str | None) -> Floats | None:
            return found[name][order] if name in found else None

        table.warned()
        of_rate = motion.startswith("slip_r")
        return cls(
            table.place,
            time - time[0],
            found[force][order],
            OF_LOAD[force],
            found[motion][order] if of_rate else None,
            None if of_rate else found[motion][order],
            of(normal),
            OF_NORMAL[normal] if normal else "",
            of(f"{force}_deviation"),
            of("slip_rate_deviation" if of_rate else "slip_deviation"),
            MOTIONS[motion],
        )


def _table(source: Any, named: NamedColumns) -> Table:
    if isinstance(source, Mapping) or hasattr(source, "columns"):
        return read_mapping(source, RECORD_COLUMNS, "record", raw=True, named=named)
    if not isinstance(source, str | os.PathLike):
        raise InputError(
            f"identify: record must be a CSV file, a DataFrame, or a mapping of headings to numbers, got {shown(source)}"
        )
    path: Path = as_path("identify: record", source)
    return read_file(path, RECORD_COLUMNS, (LARGEST_RECORD, MOST_ROWS), raw=True, named=named)
