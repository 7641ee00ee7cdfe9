"""Keep compiled code in a cache on disk that belongs to this user.

Machine code and pickles from the cache folder are executed. The folder must therefore belong to this user alone (see
`private_folder`). If there is no such folder, each process compiles for itself.

The name of the folder contains a hash of all code that is compiled (`sources.py`), so that an edited kernel never meets its old
machine code. Numba's own comparison does not suffice: it looks at the date of a function's file, and not at the files of the
functions that it calls.

The cache has a largest size. The functions that have not been used for longest are removed, whichever version of the code they
belong to; a process that still needs one compiles it again.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path

import numba
import platformdirs

from stickslip.engine.codegen.private_folder import private_folder
from stickslip.engine.codegen.sources import remembered_key
from stickslip.engine.codegen.uncompiled import UNCOMPILED
from stickslip.foundation.errors import InputError

LARGEST_CACHE = 500_000_000
"""Size (bytes) of all functions in the cache above which the least recently used are removed."""

if UNCOMPILED:
    numba.config.DISABLE_JIT = True
elif numba.config.DISABLE_JIT:
    raise InputError("NUMBA_DISABLE_JIT is set, and the engine needs the compiler: unset it, or set STICKSLIP_UNCOMPILED=1, too")


@cache
def tell(message: str) -> None:
    """Write a message to standard error on one line, once for each distinct message."""
    sys.stderr.write(f"stickslip: {' '.join(message.split())}\n")


def cache_root() -> Path:
    """Return the folder of all caches: STICKSLIP_CACHE_DIR if that is set, otherwise one in the user's cache folder."""
    chosen = os.environ.get("STICKSLIP_CACHE_DIR")
    return Path(chosen) if chosen else platformdirs.user_cache_path("stickslip")


def sources_key() -> str:
    """Return the key of the code that is compiled, kept in the cache if there is a private folder for it."""
    try:
        return remembered_key(private_folder(cache_root() / "keys"))
    except OSError:
        return remembered_key(None)


SOURCES = sources_key()
"""Hash that identifies the code that is compiled, together with the versions of numba and Python that compile it."""


def cache_folder() -> Path | None:
    """Return the folder of compiled code in `cache_root`, or None if it cannot be made there or would not be private."""
    try:
        return private_folder(cache_root() / f"compiled-{SOURCES}")
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}" if error.strerror else str(error)
    tell(
        f"no cache for compiled code: {ascii(reason)[1:-1]}; this run compiles for itself (15 s or more); "
        "STICKSLIP_CACHE_DIR names another folder"
    )
    return None


CACHE = cache_folder()
"""The folder of compiled code, or None if this process has to compile for itself."""


def make_room(largest: int = LARGEST_CACHE) -> None:
    """Remove the least recently used functions from the caches of all versions until they take at most `largest` bytes together."""
    files: dict[tuple[Path, str], list[Path]] = {}
    for path in cache_root().glob("compiled-*/*/*.nb[ico]"):  # NAME.nbi is the index of a function, NAME.1.nbc its code; KEY.nbo
        files.setdefault((path.parent, path.name.rsplit(".", 2 if path.suffix == ".nbc" else 1)[0]), []).append(path)
    found = []
    for paths in files.values():
        with suppress(FileNotFoundError):  # another process removes it, too
            stats = [path.stat() for path in paths]
            found.append((max(one.st_mtime for one in stats), sum(one.st_size for one in stats), paths))
    excess = sum(size for _, size, _ in found) - largest
    for _, size, paths in sorted(found):
        if excess <= 0:
            return
        with suppress(OSError):  # on Windows a file that is being read stays
            for path in paths:
                path.unlink(missing_ok=True)
            excess -= size


@cache
def tidy() -> None:
    """Make room once in each process that writes: to look at all files for each function would slow down a first start."""
    make_room()


SLOW = {
    "run_until": "compiling the engine for this machine: about half a minute until the first summary, once",
    "implicit_steps": "compiling implicit steps, for stiff contacts and laws with a state: about 6 s, once",
    "run_group": "compiling what sweeps and batches add to the engine: about 20 s, once",
}
"""Messages to show before the compilation of those functions for which a user has to wait, with all that is compiled after them."""
OTHERS = "compiling more of the engine for this machine: up to 20 s, once"
"""Message to show when other functions have taken `NOTICED` s and the next one is compiled."""
NOTICED = 3.0
"""Processor time (s) of compilation without a message that a user hardly notices."""
announce: Callable[[str], None] = tell
"""Function that shows such a message: on standard error, unless a progress display has replaced it."""


def announce_by(show: Callable[[str], None]) -> None:
    """Show messages about compilation with the given function instead of on standard error."""
    global announce
    announce = show
