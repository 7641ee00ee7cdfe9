"""Write the curves of a run at evenly spaced times: as CSV, whose headings have units, or as netCDF with units and provenance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError
from stickslip.solution.evaluation import Curve, Readings
from stickslip.solution.files.sampling import Span, sampled_curves

if TYPE_CHECKING:
    from stickslip.foundation.arrays import Floats

CURVES_IN_ORDER: tuple[Curve, ...] = ("slip", "event_slip", "slip_rate", "load", "traction")
"""The order of the columns after time; states of the law follow."""
SUFFIXES = (".csv", ".nc")
"""File suffixes of curves."""


class Evenly(Span, total=False):
    """The optional arguments of functions that write evenly spaced curves: either `sampling_rate` (Hz) or `points`, or neither."""

    sampling_rate: float | None
    points: int | None


def write_curves(run: Readings, path: str | Path, **evenly: Unpack[Evenly]) -> Path:
    """Write time, slip, slip rate, load, traction and states of a run, or of a window on it, and return the path.

    A name that ends in .csv makes a table whose first line names the columns with their units (SI); one that ends in .nc a netCDF
    file, with the attributes of `to_dataset`. The values are those of the run, right limits at shocks; in a window the slip counts
    from the start of the event. The arguments are those of `stickslip.solution.files.sampling.sampled_curves`.

    Raises InputError as that does, and for another suffix.
    """
    file, known = checked_path(Path(path)), run.curves
    names = [*(name for name in CURVES_IN_ORDER if name in known), *(name for name in known if name not in CURVES_IN_ORDER)]
    time, values = sampled_curves(run, names, **evenly)
    if file.suffix.lower() == ".csv":
        return write_columns(file, {heading("time", "s"): time} | _with_headings(run, names, values))
    from stickslip.foundation.netcdf_file import write
    from stickslip.solution.files.netcdf import to_dataset

    dataset = to_dataset(run, time)
    for name, filtered in zip(names, values, strict=True):
        dataset[name].values[:] = filtered
    return write(dataset, file)


def checked_path(file: Path) -> Path:
    """Return the path of a file of curves. Raises InputError for another suffix."""
    if file.suffix.lower() not in SUFFIXES:
        raise InputError(f"{file}: the name must end in {' or '.join(SUFFIXES)}")
    return file


def _with_headings(run: Readings, names: Sequence[Curve], values: Sequence[Floats]) -> dict[str, Floats]:
    states = dict(zip(("state", "second_state"), (state.unit for state in run.problem.friction.states), strict=False))
    units = {name: states.get(name) or run.problem.unit_of(name) for name in names}
    return {heading(name, units[name]): one for name, one in zip(names, values, strict=True)}


def heading(name: str, unit: str) -> str:
    """Return the heading of a column: "slip rate (m/s)"; that of a pure number has no unit."""
    words = name.removeprefix("event_").replace("_", " ")
    return words if unit in ("", "1") else f"{words} ({unit})"


def write_columns(path: Path, columns: Mapping[str, Floats]) -> Path:
    """Write columns of numbers as CSV with all digits, whole or not at all, and return the path; NaN is an empty cell."""

    def lines() -> Iterator[str]:
        yield ",".join(columns) + "\n"
        for row in zip(*(values.tolist() for values in columns.values()), strict=True):
            yield ",".join("" if one != one else repr(one + 0.0) for one in row) + "\n"

    def write(draft: Path) -> None:
        with draft.open("w", encoding="utf-8", newline="") as file:
            file.writelines(lines())

    return write_atomically(path, write)
