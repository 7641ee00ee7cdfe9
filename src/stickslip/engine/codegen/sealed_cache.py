"""Verify each file of the cache of compiled code before it is used.

Every file that numba writes carries a checksum; a damaged file counts as missing, and its function is compiled again.
"""

from __future__ import annotations

import os
import pickle
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, ClassVar

from stickslip.engine.codegen import cache
from stickslip.engine.codegen.cache import CACHE, NOTICED, OTHERS, SLOW, SOURCES, cache_root, tell, tidy
from stickslip.engine.codegen.numba_privates import (
    CompileResultCacheImpl,
    FunctionCache,
    IndexDataCacheFile,
    UserProvidedCacheLocator,
    rtsys,
)
from stickslip.engine.codegen.sealed_file import read_sealed, write_sealed


class _SealedFile(IndexDataCacheFile):
    """The cache files of one function, each with a checksum. A damaged file is removed and counts as missing."""

    def _load_index(self) -> dict[Any, str]:
        path = Path(self._index_path)
        content = read_sealed(path)
        stamp, overloads = pickle.loads(content) if content else (None, {})
        with suppress(OSError):
            os.utime(path)  # this function has been used
        return overloads if stamp == self._source_stamp else {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        write_sealed(Path(self._index_path), self._dump((self._source_stamp, overloads)))

    def _load_data(self, name: str) -> Any:
        content = read_sealed(Path(self._data_path(name)))
        if content is None:
            raise FileNotFoundError(name)  # numba then compiles the function
        return pickle.loads(content)

    def _save_data(self, name: str, data: Any) -> None:
        write_sealed(Path(self._data_path(name)), self._dump(data))


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


class _Wait:
    """What this process has spent on compilation (processor time, s), and what its user has been told."""

    spent, began = 0.0, 0.0
    told: ClassVar[set[str]] = set()

    @classmethod
    def begin(cls, name: str) -> None:
        """Begin to compile a function, and say so if its user has to wait and does not know."""
        message = SLOW.get(name, "")
        if not message and cls.spent > NOTICED and not cls.told:
            is_new = CACHE is None or not any(CACHE.glob("*/loop.run_until-*.nbi"))
            message = SLOW["run_until"] if is_new else OTHERS
        if message and message not in cls.told:
            cls.told.add(message)
            cache.announce(message)
        cls.began = time.process_time()


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
        if found is None:
            _Wait.begin(self._name)
        return found

    def save_overload(self, signature: Any, data: Any) -> None:
        """Store a compiled function for later starts, or say that it cannot be written."""
        _Wait.spent += time.process_time() - _Wait.began
        if CACHE is None:
            return
        try:
            super().save_overload(signature, data)
            tidy()
        except OSError as error:
            tell(
                f"compiled code cannot be kept in {CACHE}: {error.strerror}; later starts compile again; "
                "STICKSLIP_CACHE_DIR names another folder"
            )
