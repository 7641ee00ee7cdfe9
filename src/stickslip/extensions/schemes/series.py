"""Read a series of slip, slip rate and traction that any program has written, as CSV or in the layout of the SCEC benchmarks."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from stickslip.extensions.schemes.contract import Series
from stickslip.foundation.errors import InputError
from stickslip.foundation.headings import example, has_unit, is_of_scec
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.text_columns import read_file

LARGEST_FILE = 200_000_000
"""Largest size of a file, bytes."""
MOST_SAMPLES = 5_000_000
"""Largest number of times."""
CALLED = {
    "Pa": {"time": "time_s", "slip": "slip_m", "slip_rate": "slip_rate_m_per_s", "shear_stress": "traction_Pa"},
    "N": {"time": "time_s", "slip": "slip_m", "slip_rate": "slip_rate_m_per_s", "shear_force": "traction_N"},
    "N m": {"time": "time_s", "slip_angle": "slip_rad", "slip_rotation": "slip_rate_rad_per_s", "torque": "traction_N_m"},
}
"""The columns of a series by the unit of a body's loads, each with the heading of the exact series."""
COLUMNS_READ = ("time", "slip", "slip rate", "traction")
"""What these columns are, for messages."""
IN_MPA = ("shear-stress", "h-shear-stress")
"""Headings without a unit that the SCEC benchmarks use for stress in MPa."""


def read_series(
    path: str | Path, *, cells: int = 0, columns: Mapping[str, str | int] | None = None, load_unit: str = "Pa"
) -> Series:
    """Read a series, named after the file; `cells` is the number of cells in the thickness, if it is known.

    Columns and units are understood as those of records (`stickslip.foundation.text_columns.read_text`): time, slip, slip rate, and
    traction or shear stress, which is in MPa under the headings of the SCEC benchmarks. Traction is a force if the loads of the
    body have the unit N, and a torque if it is N m; slip is then an angle. Slip counts from t = 0. Of two lines with the same time,
    as at a shock, the last one counts. `columns` say what headings mean, as {"slip": "D (mm)"}. Raises InputError if the file
    cannot be read, if a column is missing, if a value is not a finite number, or if times do not ascend.
    """
    asked = CALLED[load_unit]
    table = read_file(Path(path), tuple(asked), (LARGEST_FILE, MOST_SAMPLES), raw=True, named=NamedColumns(columns or {}))
    in_mpa = any(heading.strip().casefold() in IN_MPA and not has_unit(heading) for heading in table.header)
    found = {}
    for (name, called), named in zip(asked.items(), COLUMNS_READ, strict=True):
        if name not in table.columns:
            there = repr(", ".join(table.header))[1:-1][:80]
            raise InputError(
                f"{table.place}: no column for the {named}: call it {called} or {example(name)}; its columns are {there}"
            )
        values = table.columns[name]
        for row in np.flatnonzero(~np.isfinite(values))[:1]:
            raise InputError(f"{table.at(int(row))}: {named} is not a finite number")
        found[name] = values
    if in_mpa and "shear_stress" in found and not is_of_scec(table.header):  # else its unit is known already
        found["shear_stress"] = 1e6 * found["shear_stress"]
    if not in_mpa:  # the benchmarks name the units of their columns
        table.warned()
    last = np.append(np.diff(found["time"]) != 0.0, True)
    time, slip, rate, traction = (values[last] for values in found.values())
    return Series(time, slip, rate, traction, Path(path).stem, cells)
