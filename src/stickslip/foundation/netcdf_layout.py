"""How arrays lie in a netCDF file: netCDF 4 is HDF5 with rules for dimensions, which are kept here."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    import h5py

NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable."
"""How the name of a dimension without values begins; its length follows."""


class Variable(NamedTuple):
    """An array of a file, with the names of its dimensions and with its attributes."""

    dims: tuple[str, ...]
    values: ArrayLike
    attrs: Mapping[str, Any] = {}


def fill(sink: BinaryIO, variables: Mapping[str, Variable], attrs: Mapping[str, Any]) -> None:
    """Write arrays as netCDF stores them in HDF5: a dimension is a scale, which is attached to the tables that have it."""
    import h5py

    arrays = {name: np.asarray(variable.values) for name, variable in variables.items()}
    sizes = [zip(variable.dims, arrays[name].shape, strict=True) for name, variable in variables.items()]
    with h5py.File(sink, "w", track_order=True) as file:
        file.attrs.update({name: _stored(value) for name, value in attrs.items()})
        file.attrs["_NCProperties"] = np.bytes_(f"version=2,hdf5={h5py.version.hdf5_version},h5py={h5py.__version__}")
        tables = {name: _new_table(file, name, one.shape, one.dtype) for name, one in arrays.items()}
        scales = {}
        for number, (axis, size) in enumerate(dict(chain.from_iterable(sizes)).items()):
            scale = scales[axis] = tables.get(axis) or _new_table(file, axis, (size,), np.dtype(">f4"))
            scale.make_scale(axis if axis in tables else NO_VARIABLE + b"%10d" % size)
            scale.attrs["_Netcdf4Dimid"] = np.int32(number)
        for name, variable in variables.items():
            tables[name].attrs.update({key: _stored(value) for key, value in variable.attrs.items()})
            for place, axis in enumerate(variable.dims if name not in scales else ()):
                tables[name].dims[place].attach_scale(scales[axis])
            tables[name][...] = arrays[name]


def _new_table(file: h5py.File, name: str, shape: tuple[int, ...], kind: np.dtype[Any]) -> h5py.Dataset:
    """Make a table; a dimension without values may grow, as netCDF has it, and texts have any length."""
    import h5py

    most = tuple(size or None for size in shape) if 0 in shape else None
    return file.create_dataset(name, shape, h5py.string_dtype() if kind.kind == "U" else kind, maxshape=most, track_order=True)


def _stored(value: Any) -> Any:
    """Return the value of an attribute as netCDF stores it: a number in an array of one, texts of any length."""
    stored = value if isinstance(value, str) else np.atleast_1d(value)
    return stored.astype(object) if isinstance(stored, np.ndarray) and stored.dtype.kind == "U" else stored
