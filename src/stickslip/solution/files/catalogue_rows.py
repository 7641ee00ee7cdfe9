"""The rows of a catalogue: append them during a run, cut them back when it resumes, and write their final format at its end."""

from __future__ import annotations

import csv
import hashlib
import importlib.util
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.foundation import netcdf_file
from stickslip.foundation.arguments import check_ordinary
from stickslip.foundation.atomic_write import sync, write_atomically
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import cannot_be_written, digest_of, write_with
from stickslip.solution.observables.event_table import EVENT_COLUMNS, column_unit

if TYPE_CHECKING:
    import pandas as pd

SUFFIXES = (".csv", ".parquet", ".nc")
"""File suffixes of the formats for a catalogue."""
LONGEST_HEADER = 10_000
"""Largest length, in bytes, of the first line of a catalogue."""
AT_A_TIME = 50_000
"""Convert this many rows from one format to another at a time, which bounds the memory."""

CHUNK = 1024
"""Number of rows in a chunk of a netCDF file, whose dimension has no fixed size."""


def check_catalogue(path: Path, where: str = "catalogue") -> None:
    """Refuse a file name whose suffix is unknown or whose format needs a library that is missing. Raises InputError."""
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"{where}: {path}: the name must end in {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}")
    if path.suffix.lower() == ".parquet" and importlib.util.find_spec("pyarrow") is None:
        raise InputError(f"{where}: {path}: Parquet needs pyarrow (pip install 'stickslip[parquet]'); .csv and .nc do not")


@dataclass(frozen=True)
class Rows:
    """The rows of a table in a CSV file, which stores every number to the last digit.

    `path` is the file of the finished table. A CSV table grows in this file; a table of another format grows beside it, in
    NAME.rows.csv, and `publish` converts it.
    """

    path: Path

    @property
    def growing(self) -> Path:
        """The growing file: rows are appended to it during the run."""
        return self.path if self.path.suffix.lower() == ".csv" else self.path.with_suffix(".rows.csv")

    @property
    def size(self) -> int:
        """Size of the growing file in bytes, 0 if it does not exist."""
        return self.growing.stat().st_size if self.growing.exists() else 0

    def append(self, rows: pd.DataFrame) -> None:
        """Append rows of numbers, after a header line if they are the first. Raises InputError if they cannot be written."""
        try:
            with self.growing.open("a", encoding="utf-8", newline="") as file:
                if file.tell() == 0:
                    file.write(",".join(rows.columns) + "\n")
                file.writelines(lines_of(rows))
        except OSError as error:
            kept = "; the rows up to the last checkpoint are kept, and --resume continues from it when there is room"
            raise cannot_be_written(self.growing, error, kept) from None

    def sync(self) -> None:
        """Force the rows onto the disk, before a checkpoint that relies on them."""
        if self.growing.exists():
            sync(self.growing)

    def digest(self, size: int) -> str:
        """Return the SHA-256 of the first `size` bytes of the growing file, or of all its bytes if it has fewer."""
        if not self.growing.exists():
            return hashlib.sha256().hexdigest()
        with self.growing.open("rb") as file:
            return digest_of(file, size)

    def take_up(self, rows: int, size: int, digest: str) -> None:
        """Go back to the first `rows` rows, which filled `size` bytes with this digest.

        The growing file holds them; a file with other columns than a catalogue's is not touched. If the run had ended, the file is
        written again from the finished table, atomically: a process that dies here leaves either no growing file or a complete one.
        Raises InputError if rows are missing or differ.
        """
        ended = self.growing != self.path and self.path.exists() and not self._has(size, digest)
        if ended:  # `tidy` deleted the growing file when the run ended
            table = read_table(self.path).iloc[:rows]
            text = ",".join(table.columns) + "\n" + "".join(lines_of(table))
            write_atomically(self.growing, lambda draft: draft.write_text(text, encoding="utf-8", newline=""))
        if self.size and not self._is_catalogue():
            raise InputError(f"{self.growing}: not a catalogue of slip events, so that no catalogue can be resumed in it")
        if not self._has(size, digest):
            lost = self.size < size
            what = "has lost rows that the checkpoint counts on" if lost else "has other rows than the checkpoint counts on"
            raise InputError(f"{self.growing}: {what}; run it again from the start")
        if self.growing.exists():
            os.truncate(self.growing, size)

    def _is_catalogue(self) -> bool:
        """Return True if the growing file begins with the names of the columns of slip events."""
        with self.growing.open("rb") as file:
            names = file.readline(LONGEST_HEADER).decode("utf-8", errors="replace").strip().split(",")
        return set(EVENT_COLUMNS) <= set(names)

    def _has(self, size: int, digest: str) -> bool:
        return self.size >= size and self.digest(size) == digest

    def clear(self) -> None:
        """Delete the growing file and the table."""
        self.growing.unlink(missing_ok=True)
        self.path.unlink(missing_ok=True)

    def columns(self, *names: str) -> pd.DataFrame:
        """Return the named columns of all rows so far."""
        import pandas as pd

        return pd.concat([chunk[[*names]] for chunk in read_csv(self.growing)], ignore_index=True)

    def read(self) -> pd.DataFrame:
        """Return the finished table."""
        return read_table(self.path)

    def publish(self, about: Mapping[str, Any], load_unit: str) -> None:
        """Write the finished table with the attributes `about`, whole or not at all. Raises InputError if it cannot be written.

        A CSV table is finished as it is. `load_unit` is Pa, N or N m.
        """
        suffix = self.path.suffix.lower()
        if suffix == ".parquet":
            try:
                write_atomically(self.path, lambda draft: _to_parquet(read_csv(self.growing), draft, about))
            except OSError as error:
                raise cannot_be_written(self.path, error, f"; its rows are in {self.growing}") from None
        elif suffix == ".nc":
            write_with(lambda file: _to_netcdf(read_csv(self.growing), file, about, load_unit), self.path)

    def tidy(self) -> None:
        """Delete the growing file, which is not needed once the table is finished."""
        if self.growing != self.path:
            self.growing.unlink(missing_ok=True)


@dataclass(frozen=True)
class RowsInMemory:
    """The rows of a table that goes to no file, with the interface of `Rows`."""

    tables: list[pd.DataFrame] = field(default_factory=list)
    size: int = 0

    def append(self, rows: pd.DataFrame) -> None:
        """Append rows."""
        self.tables.append(rows)

    def publish(self, about: Mapping[str, Any], load_unit: str) -> None:
        """Do nothing, because a table in memory has no other format."""

    def tidy(self) -> None:
        """Do nothing, because there is no growing file."""

    def columns(self, *names: str) -> pd.DataFrame:
        """Return the named columns of all rows so far."""
        return self.read()[[*names]]

    def read(self) -> pd.DataFrame:
        """Return the table of all rows."""
        import pandas as pd

        filled = [table for table in self.tables if len(table)]
        return pd.concat(filled, ignore_index=True) if filled else self.tables[-1]


def lines_of(rows: pd.DataFrame) -> Iterator[str]:
    """Yield the rows as lines of CSV, with numbers that read back to the last digit and with nothing for NaN."""
    texts = [["" if value != value else repr(value) for value in rows[name].tolist()] for name in rows.columns]
    yield from (",".join(row) + "\n" for row in zip(*texts, strict=True))


def read_table(path: Path) -> pd.DataFrame:
    """Read a finished catalogue. Raises InputError for a file that is missing, is not a catalogue, or is visibly damaged."""
    import pandas as pd

    check_ordinary(path)
    suffix = path.suffix.lower()
    if suffix == ".nc":
        return netcdf_file.read(path, "a catalogue").to_dataframe().reset_index(drop=True)
    try:
        if suffix == ".parquet":
            import pyarrow.parquet as pq

            table: pd.DataFrame = pq.read_table(path, page_checksum_verification=True).to_pandas()
            return table
        return pd.concat(list(read_csv(path)), ignore_index=True)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except InputError:
        raise
    except Exception as error:  # the libraries raise errors of many kinds for a damaged file
        raise InputError(f"{path}: not a catalogue that can be read: {' '.join(str(error).split())[:200]}") from None


def read_csv(path: Path) -> Iterator[pd.DataFrame]:
    """Yield a CSV catalogue as tables of at most AT_A_TIME rows; the first one may be empty.

    Numbers are exact to the last digit, which pandas' own reader does not promise. Raises InputError for an empty file, and for a
    row with the wrong number of entries or with an entry that is not a number.
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
    """Return integers if every text is one, and floats otherwise: `lines_of` writes a float with a point and NaN as nothing."""
    try:
        return [int(text) for text in texts]
    except ValueError:
        return [float(text or "nan") for text in texts]


def _to_parquet(chunks: Iterator[pd.DataFrame], path: Path, about: Mapping[str, Any]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    tables = (pa.Table.from_pandas(chunk, preserve_index=False) for chunk in chunks)
    first = next(tables)
    known = {name: str(value) for name, value in about.items()}
    schema = first.schema.with_metadata(known | (first.schema.metadata or {}))
    with pq.ParquetWriter(path, schema, write_page_checksum=True) as writer:
        for table in chain([first], tables):
            writer.write_table(table.cast(schema))


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
