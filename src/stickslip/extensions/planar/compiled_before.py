"""What JAX has compiled for planar runs is kept for later processes, in JAX's own persistent cache in the cache of this package.

JAX runs what lies in that folder, so it belongs to this user alone. JAX's settings hold for the whole process: they are ours only
while a run computes, and a cache of the user's own is left as it is. Where no folder can be used, each process compiles for itself.
"""

from __future__ import annotations

import os
import threading
import time
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import jax
import jaxlib.version
from jax.experimental.compilation_cache.compilation_cache import reset_cache
from packaging.version import Version

from stickslip.foundation.private_folder import private_folder
from stickslip.foundation.sealed_files import cache_root, remove

QUIET_SINCE = Version("0.10.2")
"""JAX before this writes errors to the terminal when it loads what it compiled for AVX-512 (its issue 38445)."""
LARGEST_CACHE_OF_JAX = 20_000_000
"""Largest size of the cache (bytes); a kind of run takes some 80 kB. JAX removes what has not been used for longest."""
CODE, USED = "-cache", "-atime"
"""How JAX names what it compiled, and the file beside it with the time of its last use, which it writes second."""
UNDER_WAY = 60.0
"""Age (s) after which a file whose second is missing is no longer being written."""
FOLDER = "jax_compilation_cache_dir"
SETTINGS = {
    "jax_compilation_cache_max_size": LARGEST_CACHE_OF_JAX,
    "jax_persistent_cache_min_compile_time_secs": 0.0,
    "jax_persistent_cache_enable_xla_caches": "none",  # they have no largest size
}
"""JAX's settings of its cache, beside FOLDER."""


class CompiledBefore:
    """JAX's cache of compiled code, switched to our folder while any thread of this process computes a run."""

    def __init__(self) -> None:
        self._lock, self._runs = threading.Lock(), 0
        self._theirs: dict[str, Any] = {}

    @contextmanager
    def in_use(self) -> Iterator[None]:
        """Let JAX keep what it compiles in our folder, and find it there, unless the user has chosen a folder."""
        with self._lock:
            self._runs += 1
            if self._runs == 1:
                self._begin()
        try:
            yield
        finally:
            with self._lock:
                self._runs -= 1
                if not self._runs:
                    self._end()

    def _begin(self) -> None:
        folder = None if getattr(jax.config, FOLDER) is not None else usable_folder(cache_root())
        if folder is None:
            return
        # A full disk, or a file that cannot be read, is no fault of the run: what is missing is compiled.
        warnings.filterwarnings("ignore", "Error (read|writ)ing persistent compilation cache entry")
        ours = SETTINGS | {FOLDER: str(folder)}
        self._theirs = {name: getattr(jax.config, name) for name in ours}
        for name, value in ours.items():
            jax.config.update(name, value)
        reset_cache()

    def _end(self) -> None:
        if self._theirs and getattr(jax.config, FOLDER) != str(usable_folder(cache_root())):  # the user has chosen one meanwhile
            self._theirs.pop(FOLDER)
        for name, value in self._theirs.items():
            jax.config.update(name, value)
        if self._theirs:
            reset_cache()  # JAX would go on to use the folder
        self._theirs = {}


COMPILED_BEFORE = CompiledBefore()


@cache
def usable_folder(root: Path) -> Path | None:
    """Return our folder in the cache, in which only sound files are left, or None if it cannot be used."""
    if Version(jaxlib.version.__version__) < QUIET_SINCE:
        return None
    try:
        folder = private_folder(root / "jax")
        tidy(folder)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK | os.X_OK) else None


def tidy(folder: Path) -> None:
    """Remove damaged files: JAX would find them each time, compile anew, and never write them again."""
    for path in folder.glob(f"*{CODE}"):
        used = path.with_name(path.name.removesuffix(CODE) + USED)
        with suppress(FileNotFoundError):  # another process has removed it
            if not (used.is_file() or time.time() - path.lstat().st_mtime < UNDER_WAY) or not is_sound(path):
                remove(path)
                remove(used)


def is_sound(path: Path) -> bool:
    """Return False for a file of JAX's cache that does not unpack."""
    try:
        packed = path.read_bytes()
        if packed[:1] == b"\x78":  # of zlib, with a checksum; JAX takes zstandard where that is installed
            zlib.decompress(packed)
    except (OSError, zlib.error):
        return False
    return True
