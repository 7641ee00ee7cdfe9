"""Read a run from where it was kept, of whatever kind it is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stickslip.foundation.arguments import as_path, for_users
from stickslip.run.kinds import no_results, reader_of
from stickslip.solution.files import read_solution


@for_users
def open_solution(path: str | Path) -> Any:
    """Read a run from a netCDF file that `to_netcdf` or a run wrote, or from the folder of a `PlanarSlab`'s run.

    It is bit for bit as it was; the fields of a `PlanarSolution` are read when they are first used. Raises InputError if the file
    is missing, damaged, no solution of this version of stickslip, or holds numbers that no run can have; also if its selection rule
    is not registered.
    """
    file = as_path("open_solution: path", path)
    if (reader := reader_of(file)) is not None:
        return reader.open(file)
    if file.is_dir():
        raise no_results(file)
    return read_solution(file)
