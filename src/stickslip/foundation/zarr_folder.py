"""Folders of zarr: how their arrays are compressed, and errors of one line for all that goes wrong with them."""

from __future__ import annotations

import errno
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import zarr
from zarr.codecs import Crc32cCodec, ZstdCodec

from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import clean

COMPRESSED = (ZstdCodec(), Crc32cCodec())
"""Codecs of every array: compression, then a CRC-32C checksum after each chunk, which every reader of zarr verifies."""
IN_ONE_FOLDER: Any = {"name": "default", "separator": "."}
"""Names of chunks with which all chunks of an array lie in one folder."""


def consolidate(place: Any) -> None:
    """Write what is known of all arrays into one file, which readers open first and which changes at once."""
    with warnings.catch_warnings():
        # zarr warns that this is not part of its format, but xarray reads it, and of files in the folder that are not its own
        warnings.simplefilter("ignore", category=UserWarning)
        zarr.consolidate_metadata(place)


@contextmanager
def reading(place: Any, what: str) -> Iterator[None]:
    """Turn every error in the `with` block, which reads a store, into an InputError with a message of one line.

    `what` says in the message what the store should be.
    """
    try:
        yield
    except InputError as error:
        text = str(error)
        raise (error if text.startswith(str(place)) else InputError(f"{place}: not {what}: {text}")) from None
    except Exception as error:  # the libraries raise errors of many kinds for a damaged file
        text = f"{type(error).__name__}: {clean(' '.join(str(error).split()))[:200]}"
        raise InputError(f"{place}: cannot be read: {text}") from None


@contextmanager
def writing(place: Any, kept: str) -> Iterator[None]:
    """Turn an error of the file system in the `with` block into an InputError with a message of one line.

    `kept` ends the message if the disk is full.
    """
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        where = ascii(error.filename)[1:-1] if error.filename else place
        raise InputError(f"{where}: cannot be written: {error.strerror or error}{f'; {kept}' if full else ''}") from None
