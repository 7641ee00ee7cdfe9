"""Files of the cache, each with a checksum: what is damaged counts as missing.

The cache is a folder of this user. It holds what takes long to make: machine code, and keys of code.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

import platformdirs

from stickslip.foundation.atomic_write import read_bounded, write_atomically
from stickslip.foundation.errors import InputError

LARGEST_FILE = 50_000_000
"""Largest size (bytes) of a file of the cache, far more than any machine code takes; what is larger is neither written nor read."""
SEAL = b"stickslip cache 1\n"
"""First bytes of each file of the cache; the checksum of its name and content follows, then the content."""
OF_SEAL = len(SEAL) + hashlib.sha256().digest_size
"""Number of bytes before the content of a file."""


@cache
def tell(message: str) -> None:
    """Write a message to standard error on one line, once for each distinct message."""
    sys.stderr.write(f"stickslip: {' '.join(message.split())}\n")


def cache_root() -> Path:
    """Return the folder of all caches: STICKSLIP_CACHE_DIR if that is set, otherwise one in the user's cache folder."""
    chosen = os.environ.get("STICKSLIP_CACHE_DIR")
    return Path(chosen) if chosen else platformdirs.user_cache_path("stickslip")


def write_sealed(path: Path, content: bytes) -> None:
    """Write content to a file, after the mark SEAL and the checksum; if that is too much for a file, write nothing."""
    sealed = SEAL + _checksum(path, content) + content
    if len(sealed) <= LARGEST_FILE:
        write_atomically(path, lambda draft: draft.write_bytes(sealed))


def read_sealed(path: Path, *, own: bool = True) -> bytes | None:
    """Return the content of a file, or None if it is missing or damaged; a damaged one of the cache (`own`) is removed.

    Whatever else has the name of the file counts as damage and is not read: a pipe or a device, which might never end, a link, a
    file of another user, and one that is larger than any of the cache.
    """
    with suppress(OSError, InputError):  # it cannot be read, or may not be
        sealed = read_bounded(path, LARGEST_FILE, own=own)
        content = sealed[OF_SEAL:]
        if sealed[:OF_SEAL] == SEAL + _checksum(path, content):
            return content
    if not own:
        tell(f"{path} came with the package and is damaged: what it holds is made anew; pip install --force-reinstall stickslip")
    elif os.path.lexists(path):
        tell(f"the cache of compiled code in {path.parent} is damaged: what is damaged is compiled again")
        remove(path)
    return None


def _checksum(path: Path, content: bytes) -> bytes:
    """Return the SHA-256 digest of a file's name and content; with the name, a file copied over another one does not pass."""
    return hashlib.sha256(path.name.encode() + b"\n" + content).digest()


def remove(path: Path) -> None:
    """Remove what stands in place of a sound file of the cache."""
    with suppress(OSError):
        if not path.is_symlink() and path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink()
