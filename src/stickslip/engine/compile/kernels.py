"""Compile kernels by `one_module` or, if that is not possible, by numba's public compiler with its own cache ("plainly").

Numba's compiler makes machine code of every function separately, so that a first start takes longer; the results are the same. Its
files have no checksums: ours are noted when a process ends, and at the next start files that do not match them are removed.
"""

from __future__ import annotations

import atexit
import hashlib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba import types
from numba.extending import models, register_model, typeof_impl

from stickslip.engine.compile.cache import CACHE, cache_folder
from stickslip.engine.compile.lock import LOCK
from stickslip.engine.compile.numba_privates import WHY_PLAIN
from stickslip.engine.compile.uncompiled import UNCOMPILED, as_python
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError
from stickslip.foundation.sealed_files import LARGEST_FILE, read_sealed, remove, tell, write_sealed

F = TypeVar("F", bound=Callable[..., Any])
OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "fastmath": {"contract"}, "no_cfunc_wrapper": True}
"""Options of all kernels: divisions by zero give infinity or NaN as in numpy, the interpreter's lock is released, and a product and
a sum may be fused into one operation."""


class Plain:
    """Numba's public compiler, with its own cache."""

    def __init__(self) -> None:
        tell(f"numba {numba.__version__} is used plainly ({WHY_PLAIN}): what is new is compiled several times as long, once")
        self.folder = cache_folder(f"{CACHE.name}/plain") if CACHE else None
        if CACHE and self.folder:
            self._noted = CACHE / "plain.checksums"
            noted = (read_sealed(self._noted) or b"").split()
            for path in self._files():
                if _checksum_of(path) not in noted:
                    remove(path)
            atexit.register(self._note)

    def _files(self) -> list[Path]:
        """Return all files and links, and folders where numba has files."""
        if self.folder is None:
            return []
        found = self.folder.rglob("*")
        return [path for path in found if path.is_symlink() or not path.is_dir() or path.suffix in (".nbi", ".nbc")]

    def _note(self) -> None:
        """Note the checksums of all files that numba has kept."""
        with suppress(OSError):  # the next process compiles again
            write_sealed(self._noted, b"\n".join(map(_checksum_of, self._files())))

    def dispatchers(self, function: Callable[..., Any], entry: dict[str, Any], part: dict[str, Any]) -> tuple[Any, Any]:
        """Return what compiled code and what Python calls: here they are the same."""
        before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(self.folder or "")
        try:
            both = numba.njit(cache=self.folder is not None, **entry, **part)(function)
        finally:
            numba.config.CACHE_DIR = before
        return both, both


def _checksum_of(path: Path) -> bytes:
    """Return the checksum of a file's place and content, or nothing if it cannot be read or may not be (see `read_sealed`)."""
    try:
        content = read_bounded(path, LARGEST_FILE, own=True)
    except (OSError, InputError):
        return b""
    return hashlib.sha256(f"{path.parent.name}/{path.name}\n".encode() + content).hexdigest().encode()


if WHY_PLAIN and not UNCOMPILED:
    dispatchers = Plain().dispatchers
elif not UNCOMPILED:
    from stickslip.engine.compile.one_module import dispatchers


class Kernel:
    """A compiled function of the engine: `entry` is what Python calls, `part` what compiled code calls.

    Both are made when one is first needed: most processes need a few of all kernels. They are made once, whatever threads ask for
    them: the addresses of machine code are handed on, and it goes with its entry.
    """

    part: Any
    entry: Any

    def __init__(self, function: Callable[..., Any], **options: bool) -> None:
        self.__doc__, self.__name__, self.__module__ = function.__doc__, function.__name__, function.__module__
        self.__wrapped__ = function
        self._options = options

    def __getattr__(self, name: str) -> Any:
        """Make `part` and `entry`; Python asks here for what an object does not have."""
        if name not in ("part", "entry"):
            raise AttributeError(f"{type(self).__name__} has no attribute {name}")
        with LOCK:
            if name not in vars(self):
                self.part, self.entry = dispatchers(self.__wrapped__, OPTIONS, self._options)
        return vars(self)[name]

    def __call__(self, *arguments: Any) -> Any:
        """Call the machine code, which the first call compiles or loads."""
        return self.entry(*arguments)


class _Part(types.Dispatcher):  # type: ignore[misc] # numba is untyped
    """The type of a kernel's part, which is compiled once for whole numbers and not for each number that is written in a call."""

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        return super().get_call_type(context, tuple(map(types.unliteral, args)), kws)


register_model(_Part)(models.OpaqueModel)


@typeof_impl.register(Kernel)
def _type_of_kernel(kernel: Kernel, context: Any) -> Any:
    """Return the type that compiled code sees when it calls a kernel: that of its part."""
    return _Part(kernel.part)


def kernel(function: F) -> F:
    """Return a function of the engine in compiled form, with its machine code kept in the cache."""
    return _compiled(function)


def inlined(function: F) -> F:
    """Return a compiled function, like `kernel`, that is always inlined: for small functions in the innermost loops."""
    return _compiled(function, forceinline=True)


def _compiled(function: F, **options: bool) -> F:
    """Return a function as a `Kernel`, or as plain Python if the compiler is switched off."""
    compiled: Any = as_python(function) if UNCOMPILED else Kernel(function, **options)
    return compiled


def address_of(function: Any, arguments: tuple[Any, ...]) -> int:
    """Return the address of a kernel's machine code, which lives as long as the kernel. Compiles it if it is new."""
    with LOCK:
        function.entry.compile(arguments)
        compiled = function.entry.overloads[arguments]
        return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name))
