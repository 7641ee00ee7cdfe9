"""Rows of a catalogue on disk: appended while a run goes on, cut back where it is taken up, given their form at its end."""

from __future__ import annotations

import csv
import hashlib
import importlib.util
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.foundation import netcdf_file
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import cannot_be_written, write_with
from stickslip.io.netcdf import column_unit

if TYPE_CHECKING:
    import pandas as pd

SUFFIXES = (".csv", ".parquet", ".nc")
AT_A_TIME = 50_000
"""Rows that are in memory at a time where a file is turned into another one."""

CHUNK = 1024
"""Rows in a block of a netCDF file."""
BYTES_AT_A_TIME = 2**20


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
        """Add rows of numbers; the first ones bring the names of the columns. Raises InputError where there is no room."""
        try:
            with self.growing.open("a", encoding="utf-8", newline="") as file:
                if file.tell() == 0:
                    file.write(",".join(rows.columns) + "\n")
                file.writelines(lines_of(rows))
        except OSError as error:
            kept = "; the rows up to the last checkpoint are there, and --resume goes on from it when there is room"
            raise cannot_be_written(self.growing, error, kept) from None

    def sync(self) -> None:
        """Have what was written on the disk, before anything that counts on it."""
        if self.growing.exists():
            with self.growing.open("rb+") as file:
                os.fsync(file.fileno())

    def digest(self, size: int) -> str:
        """Return the SHA-256 of the first `size` bytes; of fewer if there are not so many."""
        digest = hashlib.sha256()
        if self.growing.exists():
            with self.growing.open("rb") as file:
                while size > 0 and (some := file.read(min(size, BYTES_AT_A_TIME))):
                    digest.update(some)
                    size -= len(some)
        return digest.hexdigest()

    def take_up(self, rows: int, size: int, digest: str) -> None:
        """Go back to the first `rows` rows, which were so many bytes with this digest.

        They are in the growing file; of a run that had ended, they are made again from its table, as a whole: a process that dies
        here leaves either no growing file or all of it. Raises InputError where they are not there, or are others.
        """
        if self._has(size, digest):
            self._cut(size)
            return
        if self.growing != self.path and self.path.exists():  # the run had ended
            ended = read_table(self.path).iloc[:rows]
            text = ",".join(ended.columns) + "\n" + "".join(lines_of(ended))
            write_atomically(self.growing, lambda draft: draft.write_text(text, encoding="utf-8", newline=""))
            if self._has(size, digest):
                self._cut(size)
                return
        what = "has lost rows that the checkpoint counts on" if self.size < size else "has other rows than the checkpoint counts on"
        raise InputError(f"{self.growing}: {what}; run it again from the start")

    def _has(self, size: int, digest: str) -> bool:
        return self.size >= size and self.digest(size) == digest

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
            try:
                write_atomically(self.path, lambda draft: _to_parquet(self.chunks(), draft, about))
            except OSError as error:
                raise cannot_be_written(self.path, error, f"; its rows are in {self.growing}") from None
        elif suffix == ".nc":
            write_with(lambda file: _to_netcdf(self.chunks(), file, about, load_unit), self.path)

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


def lines_of(rows: pd.DataFrame) -> Iterator[str]:
    """Yield the rows as lines of CSV that give every number back."""
    texts = [["" if value != value else repr(value) for value in rows[name].tolist()] for name in rows.columns]
    yield from (",".join(row) + "\n" for row in zip(*texts, strict=True))


def read_table(path: Path) -> pd.DataFrame:
    """Read a catalogue in its final form. Raises InputError for a file that is not one, or is damaged so that it shows."""
    import pandas as pd

    suffix = path.suffix.lower()
    if suffix == ".nc":
        return netcdf_file.read(path, "a catalogue").to_dataframe().reset_index(drop=True)
    try:
        if suffix == ".parquet":
            return _from_parquet(path)
        return pd.concat(list(read_csv(path)), ignore_index=True)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except InputError:
        raise
    except Exception as error:  # whatever a library says of a damaged file
        raise InputError(f"{path}: not a catalogue that can be read: {' '.join(str(error).split())[:200]}") from None


def read_csv(path: Path) -> Iterator[pd.DataFrame]:
    """Tables of some rows at a time, at least one. Every number to the last digit, which pandas' own reader does not promise.

    Raises InputError for a row that is none.
    """
    with path.open(encoding="utf-8", newline="") as file:
        lines = csv.reader(file)
        names = next(lines, [])
        if not names:
            raise InputError(f"{path}: not a catalogue: it is empty")
        yield _table_of(names, list(islice(lines, AT_A_TIME)), path)
        while some := list(islice(lines, AT_A_TIME)):
            yield _table_of(names, some, path)


def _table_of(names: list[str], rows: list[list[str]], path: Path) -> pd.DataFrame:
    import pandas as pd

    wrong = next((row for row in rows if len(row) != len(names)), None)
    if wrong is not None:
        raise InputError(f"{path}: not a catalogue: the row '{','.join(wrong)[:80]}' has {len(wrong)} numbers, not {len(names)}")
    try:
        return pd.DataFrame({name: _typed([row[n] for row in rows]) for n, name in enumerate(names)})
    except ValueError as error:
        raise InputError(f"{path}: not a catalogue: {error}") from None


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
                writer = pq.ParquetWriter(
                    path, table.schema.with_metadata(known | (table.schema.metadata or {})), write_page_checksum=True
                )
            writer.write_table(table.cast(writer.schema))
    finally:
        if writer is not None:
            writer.close()


def _to_netcdf(chunks: Iterator[pd.DataFrame], file: Any, about: Mapping[str, Any], load_unit: str) -> None:
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


def _from_parquet(path: Path) -> pd.DataFrame:
    import pyarrow.parquet as pq

    table: pd.DataFrame = pq.read_table(path, page_checksum_verification=True).to_pandas()
    return table
