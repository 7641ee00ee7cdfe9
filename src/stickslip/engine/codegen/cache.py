"""The cache of compiled code on disk: whose it is, what it holds, and whether that is what was put there.

Machine code and pickles from this folder are executed. It must therefore belong to this user alone (see `private_folder`);
where it cannot, code is compiled into a temporary folder that is removed at the end. Every file of numba's carries a checksum:
one that is damaged counts as missing, and is compiled again. Formulas are executed from the text in memory, never from the file.

The folder's name carries a hash of every source that is compiled: an edited kernel can never meet its old machine code (numba
itself looks at the file of a function, not at the functions it calls).
"""

from __future__ import annotations

import atexit
import hashlib
import importlib.util
import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
import platformdirs
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile, UserProvidedCacheLocator
from numba.core.ccallback import CFunc
from numba.core.sigutils import normalize_signature

from stickslip.engine.codegen.private_folder import private_folder
from stickslip.engine.codegen.uncompiled import UNCOMPILED
from stickslip.foundation.atomic_write import write_atomically

NOT_COMPILED = ("cache.py", "private_folder.py")
"""Files among the compiled ones that decide where machine code is kept, and nothing of what it does."""
SEAL = b"stickslip cache 1\n"
"""What each file of the cache begins with, before the checksum of its name and of the rest."""


COMPILED_FOLDERS = ("engine", "batch/kernels")
"""Folders of the package that are compiled."""
COMPILED_FILES = (
    "engine_input/branch_table.py",
    "friction/formula/expression.py",
    "trajectory/history.py",
    "trajectory/phase_index.py",
    "trajectory/slip_events.py",
    "trajectory/status.py",
)
"""Other files that hold compiled functions, or numbers that compiled functions use (tests/test_layers.py looks)."""


def compiled_sources() -> list[Path]:
    """Return every file whose content is compiled, in order."""
    package = Path(__file__).parents[2]
    folders = [path for folder in COMPILED_FOLDERS for path in (package / folder).rglob("*.py")]
    inside = [path for path in folders if path.name not in NOT_COMPILED]
    return sorted([*inside, *(package / name for name in COMPILED_FILES)])


def _sources_hash() -> str:
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for path in compiled_sources():
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


if UNCOMPILED:
    numba.config.DISABLE_JIT = True
SOURCES = _sources_hash()
"""Stands for the code that is compiled, and for what compiles it."""


@cache
def tell(message: str) -> None:
    """Say something once, in one line on standard error."""
    sys.stderr.write(f"stickslip: {' '.join(message.split())}\n")


def cache_folder() -> Path:
    """Return the folder of compiled code: in STICKSLIP_CACHE_DIR, else in the user's cache folder, else a temporary one."""
    chosen = os.environ.get("STICKSLIP_CACHE_DIR")
    root = Path(chosen) if chosen else platformdirs.user_cache_path("stickslip")
    try:
        return private_folder(root / f"compiled-{SOURCES}")
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}" if error.strerror else str(error)
    tell(
        f"no cache for compiled code: {ascii(reason)[1:-1]}; this run compiles for itself (15 s or more); "
        "STICKSLIP_CACHE_DIR names another folder"
    )
    folder = Path(tempfile.mkdtemp(prefix="stickslip-compiled-"))
    atexit.register(_remove, folder, os.getpid())
    return folder


def _remove(folder: Path, owner: int) -> None:
    """Remove a temporary folder when the process that made it ends, and not when one that was forked from it does."""
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


CACHE = cache_folder()
DAMAGED = f"the cache of compiled code in {CACHE} is damaged: what is damaged is compiled again"


class _SealedFile(IndexDataCacheFile):
    """The files of one function, each with its checksum: a damaged one is removed and counts as missing."""

    def _load_index(self) -> dict[Any, str]:
        content = self._unsealed(Path(self._index_path))
        stamp, overloads = pickle.loads(content) if content else (None, {})
        return overloads if stamp == self._source_stamp else {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        self._seal(Path(self._index_path), self._dump((self._source_stamp, overloads)))

    def _load_data(self, name: str) -> Any:
        content = self._unsealed(Path(self._data_path(name)))
        if content is None:
            raise FileNotFoundError(name)  # numba takes it for a function that is not compiled yet
        return pickle.loads(content)

    def _save_data(self, name: str, data: Any) -> None:
        self._seal(Path(self._data_path(name)), self._dump(data))

    def _seal(self, path: Path, content: bytes) -> None:
        sealed = SEAL + _checksum(path, content) + content
        write_atomically(path, lambda draft: draft.write_bytes(sealed))

    def _unsealed(self, path: Path) -> bytes | None:
        try:
            sealed = path.read_bytes()
        except FileNotFoundError:
            return None
        start = len(SEAL) + hashlib.sha256().digest_size
        content = sealed[start:]
        if sealed[:start] == SEAL + _checksum(path, content):
            return content
        tell(DAMAGED)
        path.unlink(missing_ok=True)
        return None


def _checksum(path: Path, content: bytes) -> bytes:
    return hashlib.sha256(path.name.encode() + b"\n" + content).digest()


class _Locator(UserProvidedCacheLocator):
    """Our folder and no other: numba's own search would go on to folders that are not checked."""

    def __init__(self, function: Any, file: str) -> None:
        super().__init__(function, file)
        self._cache_path = str(CACHE / self.get_suitable_cache_subpath(file))

    @classmethod
    def from_function(cls, function: Any, file: str) -> _Locator:
        return cls(function, file)


class _Files(CompileResultCacheImpl):
    _locator_classes = (_Locator,)


class SealedCache(FunctionCache):
    """The cache of one function. Whatever cannot be read is compiled again, whatever cannot be written is done without."""

    _impl_class = _Files

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._name = function.__name__
        locator = self._impl.locator
        self._cache_file = _SealedFile(self._cache_path, self._impl.filename_base, locator.get_source_stamp())

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Return the compiled function, or None if it has to be compiled, which is said where it takes long."""
        try:
            found = super().load_overload(signature, context)
        except Exception as error:  # whatever unpickling raises: it must not end every later start
            tell(f"compiled code in {CACHE} cannot be used ({type(error).__name__}): it is compiled again")
            return None
        if found is None and self._name in SLOW:
            announce(SLOW[self._name])
        return found

    def save_overload(self, signature: Any, data: Any) -> None:
        """Keep a compiled function for later starts if there is room for it."""
        try:
            super().save_overload(signature, data)
        except OSError as error:
            tell(f"compiled code cannot be kept in {CACHE}: {error.strerror}; later starts compile again")


SLOW = {
    "advance": "compiling the engine for this machine: about 15 s, once",
    "run_group": "compiling what batches add to the engine: a few seconds, once",
}
"""What to say before the functions are compiled whose compilation somebody waits for."""
announce: Callable[[str], None] = tell
"""Says it: on standard error, unless a progress display has put something else here."""


def announce_by(show: Callable[[str], None]) -> None:
    """Let something else than standard error say what is being compiled."""
    global announce
    announce = show


def sealed_cfunc(signature: Any, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """As numba's `cfunc`, with this cache."""

    def compiled(function: Callable[..., Any]) -> Any:
        if UNCOMPILED:
            return function
        found: Any = CFunc(function, normalize_signature(signature), locals={}, options=options)
        found._cache = SealedCache(function)
        found.compile()
        return found

    return compiled


def load_module(name: str, text: str) -> ModuleType:
    """Return a module from its source, which is also put into the cache: numba looks at the file of what it compiles."""
    folder = CACHE / "formulas"
    path = folder / f"{name}.py"
    source = text.encode()
    kept = path.read_bytes() if path.is_file() else None
    if kept != source:
        if kept is not None:
            tell(DAMAGED)
        folder.mkdir(exist_ok=True)
        write_atomically(path, lambda draft: draft.write_bytes(source))
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # numba looks a cached function's module up by its name; this keeps the code alive, too
    exec(compile(text, str(path), "exec"), module.__dict__)
    return module
