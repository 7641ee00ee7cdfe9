"""netCDF files with a checksum at their end, which is verified before anything else in them is read.

After the part that netCDF readers see, a file ends with the line `stickslip sha256 HEX`: the SHA-256 of every byte before that
line. Other programs ignore it. A file that was damaged, cut off or changed is refused before the HDF5 library opens it, because
that library may crash on it.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import check_ordinary
from stickslip.foundation.atomic_write import FULL, SafeSink, write_atomically
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_layout import NO_VARIABLE, fill
from stickslip.foundation.netcdf_layout import Variable as Variable

if TYPE_CHECKING:
    import h5py
    import xarray as xr

OTHER_FORMATS = (".csv", ".tsv", ".txt", ".dat", ".parquet", ".png", ".pdf", ".svg", ".gif", ".toml", ".json", ".mat", ".xlsx")
"""Other programs, and people, take a file for something else than netCDF if its name ends so."""
MAGIC = b"\x89HDF\r\n\x1a\n"
"""First bytes of every HDF5 file, and so of every netCDF file of this package."""
MARK = b"\nstickslip sha256 "
"""Beginning of the line with the checksum, including the line break before it."""
SEAL = len(MARK) + 64 + 1
"""Length of the line with the checksum, in bytes."""
AT_A_TIME = 2**20
"""Read this many bytes at once for the checksum, so that a large file is never held in memory."""

MOST_TABLES, MOST_ATTRIBUTES = 256, 256
"""Largest number of tables in a file, and of attributes of the file or of a table; a run's file has some seventy and thirty. The
libraries take 5 ms for each."""
OF_NETCDF = {"CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST", "_NCProperties", "_Netcdf4Dimid", "_Netcdf4Coordinates"}
"""Attributes that netCDF uses to store dimensions."""


class Tables(NamedTuple):
    """What a file holds: its arrays by name, the lengths of their dimensions, and the attributes of the file."""

    variables: dict[str, Variable]
    sizes: dict[str, int]
    attrs: dict[str, Any]

    def array(self, name: str) -> NDArray[Any]:
        """Return an array, in the order of C. Raises KeyError if there is none of this name."""
        return np.ascontiguousarray(self.variables[name].values)


class FullDiskError(InputError):
    """Raised if the disk has no space for a file; `solution`, if set, could not be written and can be saved elsewhere."""

    solution: Any = None


def write(dataset: xr.Dataset, path: Path) -> Path:
    """Write a netCDF file completely or not at all, and return its path.

    Raises InputError if it cannot be written, and FullDiskError if the reason is a lack of space.
    """
    from xarray.backends import H5NetCDFStore

    encoding = {name: {"_FillValue": None} for name, variable in dataset.variables.items() if variable.dtype.kind == "f"}

    def dump(file: Any) -> None:
        dataset.dump_to_store(H5NetCDFStore(file), encoding=encoding)

    return write_with(dump, path)


def write_variables(variables: Mapping[str, Variable], attrs: Mapping[str, Any], path: Path) -> Path:
    """Write arrays of floats, whole numbers or texts, with the guarantees and errors of `write`.

    Readers find in the file what they find in that which `write` makes of a dataset of the same arrays. It is written without
    xarray, which takes a third of a second to import, and without h5netcdf, which takes five times as long: it looks for each
    table and each dimension anew whenever it needs one.
    """
    return _write(lambda sink: fill(sink, variables, attrs), path)


def write_with(fill: Callable[[Any], object], path: Path) -> Path:
    """Let `fill` write into an `h5netcdf.File`, with the guarantees and errors of `write`."""
    import h5netcdf

    def opened(sink: SafeSink) -> None:
        with h5netcdf.File(sink, "w") as file:
            fill(file)

    return _write(opened, path)


def _write(fill: Callable[[SafeSink], None], path: Path) -> Path:
    """Let `fill` write into what the HDF5 library takes for a file, with the guarantees and errors of `write`."""
    if path.suffix.lower() in OTHER_FORMATS:
        raise InputError(f"{path}: what is written is netCDF: the name must end in .nc")
    try:
        return write_atomically(path, lambda draft: _sealed(draft, fill))
    except OSError as error:
        raise cannot_be_written(path, error) from None


def cannot_be_written(path: Path, error: OSError, kept: str = "") -> InputError:
    """Return the error for a file that could not be written; `kept` is appended to its message if the disk is full."""
    kind = FullDiskError if error.errno in FULL else InputError
    return kind(f"{path}: cannot be written: {error.strerror or error}{kept if kind is FullDiskError else ''}")


def _sealed(draft: Path, fill: Callable[[SafeSink], None]) -> None:
    """Write the file, then its checksum. Failed writes are hidden from the HDF5 library, which would crash on them."""
    sink = SafeSink(draft)
    try:
        try:
            fill(sink)
        except Exception:
            sink.check()  # a failed write is the true cause if HDF5 stumbled over zeros that it read back
            raise
        sink.check()
    finally:
        sink.close()
    seal(draft)


def seal(path: Path) -> None:
    """Append the checksum to the end of a file."""
    with path.open("rb+") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        file.seek(0, os.SEEK_END)
        file.write(MARK + digest.encode() + b"\n")


def check(path: Path, what: str = "a file") -> None:
    """Raise InputError unless a file is as this package wrote it; `what` names in the message what the file should be."""
    check_ordinary(path)
    try:
        with path.open("rb") as file:
            size = os.fstat(file.fileno()).st_size
            if file.read(len(MAGIC)) != MAGIC:
                raise InputError(f"{path}: not a netCDF file that can be read: it does not begin as one")
            file.seek(max(size - SEAL, 0))
            seal = file.read(SEAL)
            if not (seal.startswith(MARK) and seal.endswith(b"\n")):
                lacks = "it does not end with its checksum: another program or an older version wrote it, or its end was cut off"
                raise InputError(f"{path}: not {what} of this version of stickslip ({lacks})")
            if digest_of(file, size - SEAL).encode() != seal[len(MARK) : -1]:
                raise InputError(f"{path}: damaged: its content does not have its checksum; take a copy of it, or run again")
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None


def digest_of(file: Any, size: int) -> str:
    """Return the SHA-256 of the first `size` bytes of an open file, or of all its bytes if it has fewer."""
    digest = hashlib.sha256()
    file.seek(0)
    while size > 0 and (some := file.read(min(size, AT_A_TIME))):
        digest.update(some)
        size -= len(some)
    return digest.hexdigest()


def read(path: Path, what: str = "a file") -> xr.Dataset:
    """Read a file that `write` wrote. Raises InputError for any other file, and for one whose tables claim more than its size."""
    import xarray as xr  # here, because it takes half a second to import, with pandas, pint, and dask where it is installed

    tables = read_tables(path, what)
    with _readable(path):
        return xr.decode_cf(xr.Dataset(tables.variables, attrs=tables.attrs), decode_times=False)


def read_tables(path: Path, what: str = "a file") -> Tables:
    """Read a file that `write_variables` wrote, without xarray. Raises InputError as `read` does."""
    check(path, what)
    with _readable(path):
        _check_sizes(path)
        return _tables(path)


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    """Turn any other error than an InputError into one."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:  # a file made by hand can carry a valid checksum and still make any library raise anything
        raise InputError(f"{path}: not a netCDF file that can be read: {' '.join(str(error).split())[:200]}") from None


def _tables(path: Path) -> Tables:
    """Return the tables of a netCDF file as they are stored. h5netcdf takes three times as long: it looks for each often."""
    import h5py

    with h5py.File(path, "r") as file:
        found = Tables({}, {}, _about(file))
        for name, table in ((name, table) for name, table in file.items() if not _is_axis(table)):
            values = np.asarray(table.asstr()[...], str) if h5py.check_string_dtype(table.dtype) else np.asarray(table[...])
            found.variables[name] = Variable(tuple(_dimensions(table)), values, _about(table))
            for axis, size in zip(found.variables[name].dims, values.shape, strict=True):
                if found.sizes.setdefault(axis, size) != size:
                    raise InputError(f"{path}: not a file of stickslip: '{axis}' is of several lengths in it")
        return found


def _dimensions(table: h5py.Dataset) -> list[str]:
    """Return the names of a table's dimensions; a coordinate has its own."""
    import h5py

    if table.attrs.get("CLASS") == b"DIMENSION_SCALE":
        return [table.name.removeprefix("/")]
    axes = table.attrs["DIMENSION_LIST"] if table.ndim else []
    return [h5py.h5r.get_name(axis[0], table.file.id).decode().removeprefix("/") for axis in axes]


def _about(table: h5py.Group | h5py.Dataset) -> dict[str, Any]:
    """Return the attributes of a file or a table."""
    return {name: _plain(table.attrs[name]) for name in table.attrs if name not in OF_NETCDF}


def _plain(value: Any) -> Any:
    """Return the only element of an array of one, and a list in place of an array of texts."""
    if not isinstance(value, np.ndarray):
        return value
    if value.shape == (1,):
        return value[0]
    return value.tolist() if value.dtype.kind == "O" else value


def attributes(path: Path) -> dict[str, Any]:
    """Return the attributes of a file that `write` wrote; return an empty dictionary for any other file."""
    import h5py

    try:
        check(path)
        with h5py.File(path, "r") as opened:
            _check_number("attributes", len(opened.attrs), MOST_ATTRIBUTES, path)
            return _about(opened)
    except Exception:
        return {}


def _check_sizes(path: Path) -> None:
    """Raise InputError for a file with links to other places, with too many tables, or whose tables are larger than the file.

    Files of this package are never compressed, so that a table larger than the file cannot be genuine.
    """
    import h5py

    size, claimed = path.stat().st_size, 0
    with h5py.File(path, "r") as file:
        _check_number("tables", len(file), MOST_TABLES, path)
        _check_number("attributes", len(file.attrs), MOST_ATTRIBUTES, path)
        for name in file:
            if not isinstance(file.get(name, getlink=True), h5py.HardLink):
                raise InputError(f"{path}: not a file of stickslip: '{name}' in it is a link")
            claimed += _claimed(file[name], path)
    if claimed > size:
        raise InputError(f"{path}: not a file of stickslip: its tables claim {claimed:.3g} bytes, it has {size}")


def _check_number(what: str, count: int, most: int, path: Path) -> None:
    if count > most:
        raise InputError(f"{path}: not a file of stickslip: it has {count} {what}, at most {most} are allowed")


def _claimed(found: Any, path: Path) -> int:
    """Return the number of bytes that a table claims to hold; a dimension without values claims none."""
    import h5py

    if not isinstance(found, h5py.Dataset) or found.external or found.is_virtual:
        raise InputError(f"{path}: not a file of stickslip: '{found.name}' in it is no plain table")
    _check_number(f"attributes of '{found.name}'", len(found.attrs), MOST_ATTRIBUTES, path)
    if _is_axis(found):
        return 0
    return int(found.size or 0) * int(found.dtype.itemsize)


def _is_axis(found: h5py.Dataset) -> bool:
    name = found.attrs.get("NAME", b"")
    return isinstance(name, bytes) and name.startswith(NO_VARIABLE)
