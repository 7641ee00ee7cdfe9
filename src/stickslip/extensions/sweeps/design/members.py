"""Members that somebody else has chosen: an array or a table with a member in each row and a parameter in each column."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.extensions.sweeps.design.axis import Values, read_values, typed_value
from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.conversion import has_unit
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import ParameterPath

if TYPE_CHECKING:
    import pandas as pd

SUFFIX = ".csv"
"""How the name of a file of members ends, which tells it from the name of a kind of design."""
LARGEST_TABLE = 1_000_000_000
"""Largest size (bytes) of a CSV file of members; a larger one is refused before it fills the memory."""
FORMS = "an array, a DataFrame, a mapping of columns, a list of records, or a CSV file"
"""All that can hold members."""
KINDS_OF_NUMBERS = "iuf"
"""Kinds of arrays that hold plain numbers."""
Columns = list[tuple[str, Any]]
"""The name and the cells of each column."""


def columns_of(given: Any, names: Any, where: str) -> Columns:
    """Return the columns of an array or a table (FORMS); only those of an array are called `names`, which is otherwise None.

    Raises InputError, whose message begins with `where`, for anything else, and unless there is a member.
    """
    columns = _table(read_csv(Path(given), where) if isinstance(given, str | Path) else given, where)
    if columns is None:
        columns = _array(given, names, where)
    elif names is not None:
        raise InputError(f"{where}: its columns have names of their own: leave out vary")
    if not columns or not len(columns[0][1]):
        raise InputError(f"{where}: the table has no members")
    for name, cells in columns:
        if len(cells) != len(columns[0][1]):
            raise InputError(
                f"{where}: every column needs as many values as the first: {columns[0][0]} has {len(columns[0][1])}, "
                f"{name} has {len(cells)}"
            )
    return columns


def _table(given: Any, where: str) -> Columns | None:
    """Return the columns of a table that names them, or None if there is none."""
    if hasattr(given, "columns"):
        by_place = getattr(given, "iloc", None)  # of pandas, where two columns may have the same name
        return [
            (str(name).strip(), _cells(given[name] if by_place is None else by_place[:, i], where))
            for i, name in enumerate(given.columns)
        ]
    if isinstance(given, np.ndarray) and given.dtype.names:
        return [(name, given[name]) for name in given.dtype.names]
    if isinstance(given, Mapping):
        return [(str(name), _cells(cells, f"{where}: {name}")) for name, cells in given.items()]
    if isinstance(given, list | tuple) and given and all(isinstance(record, Mapping) for record in given):
        return [(str(name), [_cell(record, name, i, where) for i, record in enumerate(given)]) for name in _names_in(given, where)]
    return None


def _cells(column: Any, where: str) -> Any:
    """Return the values of a column, as an array if they are plain numbers or have a unit together, or as a list."""
    if isinstance(column, str | Mapping) or not isinstance(column, Iterable) or getattr(column, "ndim", 1) != 1:
        raise InputError(f"{where} must be a list of values, one for each member, got {shown(column)}")
    if isinstance(column, np.ndarray) or has_unit(column):  # a subclass of the array stays one: it may carry a unit or a mask
        return column
    dtype = getattr(column, "dtype", None)
    return np.asarray(column) if isinstance(dtype, np.dtype) and dtype.kind in KINDS_OF_NUMBERS else list(column)


def _names_in(records: Sequence[Mapping[Any, Any]], where: str) -> list[Any]:
    """Return the names in the first record, after checking that no other record has more."""
    names = list(records[0])
    for i, record in enumerate(records):
        if more := next((name for name in record if name not in names), None):
            raise InputError(f"{where}: member {i} has {shown(more)}, which member 0 has not")
    return names


def _cell(record: Mapping[Any, Any], name: Any, i: int, where: str) -> Any:
    if name not in record:
        raise InputError(f"{where}: member {i} has no {shown(name)}")
    return record[name]


def _array(given: Any, names: Any, where: str) -> Columns:
    """Return the columns of an array, or of a list of rows, with the given names."""
    if not isinstance(given, Iterable):
        raise InputError(f"{where} must be {FORMS}, got {shown(given)}")
    rows: Any = given if isinstance(given, np.ndarray) or has_unit(given) else _rows(given, where)
    if not rows.size:
        raise InputError(f"{where}: the table has no members")
    if rows.ndim != 2:
        wanted = "an array must have two dimensions, a row for each member and a column for each parameter"
        raise InputError(f"{where}: {wanted}, got one of shape {rows.shape}")
    if isinstance(names, str | Mapping) or not isinstance(names, Iterable) or getattr(names, "ndim", 1) != 1:
        raise InputError(f"{where}: an array needs the names of its columns: vary must be a list of them, got {shown(names)}")
    named = [str(name) for name in names]
    if len(named) != rows.shape[1]:
        raise InputError(f"{where}: the array has {rows.shape[1]} columns, but vary has {len(named)} names")
    return [(name, rows[:, i]) for i, name in enumerate(named)]


def _rows(given: Iterable[Any], where: str) -> Any:
    """Return rows as an array; numbers and texts stay what they are. Raises InputError for rows that differ in length."""
    if hasattr(given, "__array__"):
        return np.asarray(given)
    rows = list(given)
    lengths = {len(row) if isinstance(row, Sequence | np.ndarray) and not isinstance(row, str) else None for row in rows}
    if len(lengths) > 1:
        raise InputError(f"{where}: the rows differ in length")
    return np.array(rows, dtype=object)


def read_csv(path: Path, where: str) -> pd.DataFrame:
    """Read a table of members from a CSV file: a header line with parameters, then one line for each member. Raises InputError."""
    import pandas as pd

    try:
        content = BytesIO(read_bounded(path, LARGEST_TABLE))
        # Without a header for pandas, which would give a second column of the same name another name.
        lines = pd.read_csv(content, header=None, comment="#", dtype=str, keep_default_na=False, skipinitialspace=True)
    except FileNotFoundError:
        raise InputError(f"{where} {path}: no such file") from None
    except InputError as error:
        raise InputError(f"{where} {path}: {error}: not a table of members") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{where} {path}: not a table of members: {' '.join(str(error).split())}") from None
    return lines[1:].set_axis(lines.iloc[0], axis="columns")


def values_of(parameter: ParameterPath, cells: Any, where: str) -> Values:
    """Return the values of a parameter in SI. Raises InputError, which names the first member that cannot have its value."""
    is_array = has_unit(cells) or (isinstance(cells, np.ndarray) and cells.dtype.kind in KINDS_OF_NUMBERS)
    plain = cells if is_array else [typed_value(parameter, cell) for cell in cells]
    try:
        return read_values(parameter, plain, where, math.inf)
    except InputError:
        for i, cell in enumerate(plain):
            read_values(parameter, [cell], f"{where}: member {i}")
        raise
