"""Keep compiled code in a cache on disk that belongs to this user, and verify each file before it is used.

Machine code and pickles from the cache folder are executed. The folder must therefore belong to this user alone (see
`private_folder`). If there is no such folder, each process compiles for itself. Every file that numba writes carries a checksum; a
damaged file counts as missing, and its function is compiled again. The text of formulas stays in memory.

The name of the folder contains a hash of all code that is compiled (`sources.py`), so that an edited kernel never meets its old
machine code. Numba's own comparison does not suffice: it looks at the date of a function's file, and not at the files of the
functions that it calls.

The cache has a largest size. The functions that have not been used for longest are removed, whichever version of the code they
belong to; a process that still needs one compiles it again.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
import platformdirs
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile, UserProvidedCacheLocator
from numba.core.ccallback import CFunc
from numba.core.runtime import rtsys
from numba.core.sigutils import normalize_signature

from stickslip.engine.codegen.lean_compiler import LeanCompiler
from stickslip.engine.codegen.private_folder import private_folder
from stickslip.engine.codegen.sources import remembered_key
from stickslip.engine.codegen.uncompiled import UNCOMPILED
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError

SEAL = b"stickslip cache 1\n"
"""First bytes of each file of the cache; the checksum of its name and content follows, then the content."""
LARGEST = 500_000_000
"""Size (bytes) of all functions in the cache above which the least recently used are removed; a formula takes up to 2 MB."""

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
DAMAGED = f"the cache of compiled code in {CACHE} is damaged: what is damaged is compiled again"


def make_room(largest: int = LARGEST) -> None:
    """Remove the least recently used functions from the caches of all versions until they take at most `largest` bytes together."""
    files: dict[tuple[Path, str], list[Path]] = {}
    for path in cache_root().glob("compiled-*/*/*.nb[ic]"):  # NAME.nbi is the index of a function, NAME.1.nbc its code
        files.setdefault((path.parent, path.name.rsplit(".", 1 if path.suffix == ".nbi" else 2)[0]), []).append(path)
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
def _tidy() -> None:
    """Make room once in each process that writes: to look at all files for each function would slow down a first start."""
    make_room()


class _SealedFile(IndexDataCacheFile):
    """The cache files of one function, each with a checksum. A damaged file is removed and counts as missing."""

    def _load_index(self) -> dict[Any, str]:
        path = Path(self._index_path)
        content = self._unsealed(path)
        stamp, overloads = pickle.loads(content) if content else (None, {})
        with suppress(OSError):
            os.utime(path)  # this function has been used
        return overloads if stamp == self._source_stamp else {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        self._seal(Path(self._index_path), self._dump((self._source_stamp, overloads)))

    def _load_data(self, name: str) -> Any:
        content = self._unsealed(Path(self._data_path(name)))
        if content is None:
            raise FileNotFoundError(name)  # numba then compiles the function
        return pickle.loads(content)

    def _save_data(self, name: str, data: Any) -> None:
        self._seal(Path(self._data_path(name)), self._dump(data))

    def _seal(self, path: Path, content: bytes) -> None:
        """Write content to a file, after the mark SEAL and the checksum."""
        sealed = SEAL + _checksum(path, content) + content
        write_atomically(path, lambda draft: draft.write_bytes(sealed))

    def _unsealed(self, path: Path) -> bytes | None:
        """Return the content of a file, or None if it is missing or its checksum is wrong; remove it in the second case."""
        try:
            sealed = path.read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            return None
        start = len(SEAL) + hashlib.sha256().digest_size
        content = sealed[start:]
        if sealed[:start] == SEAL + _checksum(path, content):
            return content
        tell(DAMAGED)
        path.unlink(missing_ok=True)
        return None


def _checksum(path: Path, content: bytes) -> bytes:
    """Return the SHA-256 digest of a file's name and content; with the name, a file copied over another one does not pass."""
    return hashlib.sha256(path.name.encode() + b"\n" + content).digest()


class _Locator(UserProvidedCacheLocator):
    """Locates cache files in CACHE only, because numba's own search would continue with folders that are not checked."""

    def __init__(self, function: Any, file: str) -> None:
        super().__init__(function, file)
        self._cache_path = str((CACHE or cache_root()) / self.get_suitable_cache_subpath(file))

    @classmethod
    def from_function(cls, function: Any, file: str) -> _Locator:
        return cls(function, file)

    def get_source_stamp(self) -> str:
        """Return the key of all code in place of the date of one file, which an edited comment would change."""
        return SOURCES


class _Files(CompileResultCacheImpl):
    """The cache implementation of numba, restricted to the one locator above."""

    _locator_classes = (_Locator,)


class SealedCache(FunctionCache):
    """The cache of one function. A file that cannot be read is compiled again; one that cannot be written is left out.

    Without a folder (CACHE) nothing is read or written.
    """

    _impl_class = _Files

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._name = function.__name__
        locator = self._impl.locator
        self._cache_file = _SealedFile(self._cache_path, self._impl.filename_base, locator.get_source_stamp())

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Return the compiled function, or None if it must be compiled; announce the compilation if it takes long (see SLOW).

        numba's own method first makes ready all that it needs to compile (`context.refresh()`), which takes half a second. Machine
        code from the disk needs the run-time functions only. The compiler calls `refresh` itself before it compiles anything.
        """
        try:
            rtsys.initialize(context)
            found = self._load_overload(signature, context) if CACHE else None
        except Exception as error:  # unpickling may raise anything, and must not make every later start fail
            tell(f"compiled code in {CACHE} cannot be used ({type(error).__name__}): it is compiled again")
            return None
        if found is None and self._name in SLOW:
            announce(SLOW[self._name])
        return found

    def save_overload(self, signature: Any, data: Any) -> None:
        """Store a compiled function for later starts; say so on standard error if it cannot be written."""
        if CACHE is None:
            return
        try:
            super().save_overload(signature, data)
            _tidy()
        except OSError as error:
            tell(
                f"compiled code cannot be kept in {CACHE}: {error.strerror}; later starts compile again; "
                "STICKSLIP_CACHE_DIR names another folder"
            )


SLOW = {
    "run_until": "compiling the engine for this machine: about 10 s, once",
    "implicit_steps": "compiling implicit steps, for stiff contacts and laws with a state: about 5 s, once",
    "run_group": "compiling what batches add to the engine: a few seconds, once",
}
"""Messages to show before the compilation of those functions for which a user has to wait."""
announce: Callable[[str], None] = tell
"""Function that shows such a message: on standard error, unless a progress display has replaced it."""


def announce_by(show: Callable[[str], None]) -> None:
    """Show messages about compilation with the given function instead of on standard error."""
    global announce
    announce = show


def sealed_cfunc(signature: Any, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator like numba's `cfunc` that uses this cache; without the compiler it returns the function unchanged."""

    def compiled(function: Callable[..., Any]) -> Any:
        if UNCOMPILED:
            return function
        found: Any = CFunc(function, normalize_signature(signature), locals={}, options=options, pipeline_class=LeanCompiler)
        found._cache = SealedCache(function)
        found.compile()
        return found

    return compiled


def load_module(name: str, text: str) -> ModuleType:
    """Return a new module with a given name and source text, which has the name of a file but needs none."""
    module = ModuleType(name)
    sys.modules[name] = module  # numba finds the module of a cached function by its name; this entry also keeps the code alive
    path = (CACHE or cache_root()) / "formulas" / f"{name}.py"  # numba keeps the functions of a file together
    exec(compile(text, str(path), "exec"), module.__dict__)
    return module
