"""Rows of a catalogue on disk: appended while a run goes on, cut back where it is taken up, given their form at its end."""

from __future__ import annotations

import csv
import importlib.util
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.errors import InputError
from stickslip.files import write_atomically
from stickslip.storage import column_unit

if TYPE_CHECKING:
    import pandas as pd

SUFFIXES = (".csv", ".parquet", ".nc")
AT_A_TIME = 50_000
"""Rows that are in memory at a time where a file is turned into another one."""

CHUNK = 1024
"""Rows in a block of a netCDF file."""


def check_catalogue(path: Path, where: str = "catalogue") -> None:
    """Refuse a name that says no format, or one whose library is missing. Raises InputError."""
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"{where}: {path}: the name must end in {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}")
    if path.suffix.lower() == ".parquet" and importlib.util.find_spec("pyarrow") is None:
        raise InputError(f"{where}: {path}: Parquet needs pyarrow (pip install 'stickslip[parquet]'); .csv and .nc do not")


@dataclass(frozen=True)
class Rows:
    """Rows of a table in a CSV file, which gives every number back to the last digit.

    `path` is where the table is wanted. One that is wanted as CSV grows there; another one grows beside it, as NAME.rows.csv, and
    is put into its form by `publish`.
    """

    path: Path

    @property
    def growing(self) -> Path:
        """Where the rows are while the run goes on."""
        return self.path if self.path.suffix.lower() == ".csv" else self.path.with_suffix(".rows.csv")

    @property
    def size(self) -> int:
        """Bytes so far."""
        return self.growing.stat().st_size if self.growing.exists() else 0

    def append(self, rows: pd.DataFrame) -> None:
        """Add rows of numbers; the first ones bring the names of the columns."""
        texts = [["" if value != value else repr(value) for value in rows[name].tolist()] for name in rows.columns]
        with self.growing.open("a", encoding="utf-8", newline="") as file:
            if file.tell() == 0:
                file.write(",".join(rows.columns) + "\n")
            file.writelines(",".join(row) + "\n" for row in zip(*texts, strict=True))

    def sync(self) -> None:
        """Have what was written on the disk, before anything that counts on it."""
        if self.growing.exists():
            with self.growing.open("rb+") as file:
                os.fsync(file.fileno())

    def take_up(self, rows: int, size: int) -> None:
        """Go back to the first `rows` rows, which were so many bytes. Raises InputError where they are not there."""
        if not self.growing.exists() and self.path.exists():  # the run had ended
            self.append(read_table(self.path).iloc[:rows])
        elif self.size >= size:
            self._cut(size)
        else:
            raise InputError(f"{self.growing}: has lost rows that the checkpoint counts on; run it again from the start")

    def _cut(self, size: int) -> None:
        if self.growing.exists():
            os.truncate(self.growing, size)

    def clear(self) -> None:
        """No rows, no table."""
        self.growing.unlink(missing_ok=True)
        self.path.unlink(missing_ok=True)

    def chunks(self) -> Iterator[pd.DataFrame]:
        """The rows, some at a time."""
        return read_csv(self.growing)

    def columns(self, *names: str) -> pd.DataFrame:
        """Some columns of the rows so far."""
        import pandas as pd

        return pd.concat([chunk[[*names]] for chunk in self.chunks()], ignore_index=True)

    def read(self) -> pd.DataFrame:
        """The table, once it has its form."""
        return read_table(self.path)

    def publish(self, about: Mapping[str, Any], load_unit: str) -> None:
        """Give the table its form, whole or not at all."""
        suffix = self.path.suffix.lower()
        if suffix == ".parquet":
            write_atomically(self.path, lambda draft: _to_parquet(self.chunks(), draft, about))
        elif suffix == ".nc":
            write_atomically(self.path, lambda draft: _to_netcdf(self.chunks(), draft, about, load_unit))

    def tidy(self) -> None:
        """The table has its form: the growing file is no longer needed."""
        if self.growing != self.path:
            self.growing.unlink(missing_ok=True)


@dataclass(frozen=True)
class RowsInMemory:
    """The same for a table that goes to no file."""

    tables: list[pd.DataFrame] = field(default_factory=list)
    size: int = 0

    def append(self, rows: pd.DataFrame) -> None:
        """Add rows."""
        self.tables.append(rows)

    def publish(self, about: Mapping[str, Any], load_unit: str) -> None:
        """A table in memory has its form."""

    def tidy(self) -> None:
        """Nothing lies about."""

    def columns(self, *names: str) -> pd.DataFrame:
        """Some columns of the rows so far."""
        return self.read()[[*names]]

    def read(self) -> pd.DataFrame:
        """The table."""
        import pandas as pd

        filled = [table for table in self.tables if len(table)]
        return pd.concat(filled, ignore_index=True) if filled else self.tables[-1]


def read_table(path: Path) -> pd.DataFrame:
    """A catalogue in its final form."""
    import pandas as pd
    import xarray as xr

    suffix = path.suffix.lower()
    if suffix == ".parquet":
        return pd.read_parquet(path, engine="pyarrow")
    if suffix == ".nc":
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as dataset:
            return dataset.to_dataframe().reset_index(drop=True)
    return pd.concat(list(read_csv(path)), ignore_index=True)


def read_csv(path: Path) -> Iterator[pd.DataFrame]:
    """Tables of some rows at a time, at least one. Every number to the last digit, which pandas' own reader does not promise."""
    import pandas as pd

    with path.open(encoding="utf-8", newline="") as file:
        lines = csv.reader(file)
        names = next(lines)
        some = list(islice(lines, AT_A_TIME))
        yield pd.DataFrame({name: _typed([row[n] for row in some]) for n, name in enumerate(names)})
        while some := list(islice(lines, AT_A_TIME)):
            yield pd.DataFrame({name: _typed([row[n] for row in some]) for n, name in enumerate(names)})


def _typed(texts: list[str]) -> list[Any]:
    """Numbers as what they were: a float is never written as an integer, and one that is not a number as nothing."""
    try:
        return [int(text) for text in texts]
    except ValueError:
        return [float(text or "nan") for text in texts]


def _to_parquet(chunks: Iterator[pd.DataFrame], path: Path, about: Mapping[str, Any]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    writer = None
    try:
        for chunk in chunks:
            table = pa.Table.from_pandas(chunk, preserve_index=False)
            if writer is None:
                known = {name: str(value) for name, value in about.items()}
                writer = pq.ParquetWriter(path, table.schema.with_metadata(known | (table.schema.metadata or {})))
            writer.write_table(table.cast(writer.schema))
    finally:
        if writer is not None:
            writer.close()


def _to_netcdf(chunks: Iterator[pd.DataFrame], path: Path, about: Mapping[str, Any], load_unit: str) -> None:
    import h5netcdf

    with h5netcdf.File(path, "w") as file:
        file.attrs.update(about)
        file.dimensions = {"event": None}
        done = 0
        for chunk in chunks:
            for name in chunk.columns:
                values = chunk[name].to_numpy()
                if name not in file.variables:
                    made = file.create_variable(name, ("event",), values.dtype, chunks=(CHUNK,))
                    made.attrs["units"] = column_unit(name, load_unit)
                if name == chunk.columns[0]:
                    file.resize_dimension("event", done + len(chunk))
                file.variables[name][done : done + len(chunk)] = values
            done += len(chunk)
