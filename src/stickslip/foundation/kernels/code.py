"""Where machine code is found: what came with the package, what the cache has, or what is made now because neither has it.

Machine code is executed. The folder of the cache must therefore belong to this user alone (see `private_folder`); without such a
folder each process compiles for itself. What came with the package is as safe as the package.

Every file carries a checksum (`sealed_files`), because nobody else checks what is loaded: of 300 machine codes with one wrong bit
30 ended the process and 6 gave wrong numbers. A file that is damaged in any way counts as missing, and its code is made again.

The names of the folders contain the key of all code that is compiled (`code_key`), so that an edited kernel never meets its old
machine code, and an edited comment, docstring or line break leaves it as it is; and what processor it is for.

The cache has a largest size. The files that have not been used for longest are removed, whichever version of the code they belong
to; a process that still needs one makes it again.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm

from stickslip.foundation.code_key import PACKAGE, SHIPPED, key_of_files
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.processor import PROCESSOR
from stickslip.foundation.private_folder import private_folder
from stickslip.foundation.sealed_files import cache_root, read_sealed, tell, write_sealed

LARGEST_CACHE = 500_000_000
"""Largest size (bytes) of the cache; beyond it, the least recently used files are removed."""
LOOK_AFTER = 10_000_000
"""The size of the cache is looked at again after a process has written this many bytes, so that a long one keeps the bound."""
COMPILED_FOLDERS = (
    *("engine/contact", "engine/contact_step", "engine/folds", "engine/formula_code", "engine/lanes", "engine/radau"),
    *("engine/series", "engine/state", "engine/waves", "foundation/kernels"),
    "friction/formula/operations",
)
"""Folders of the package whose files all enter the key, because they hold compiled functions or write them."""
COMPILED_FILES = (
    *("engine/compiled_formula.py", "engine/creep/pattern.py", "engine/input/branch_table.py", "engine/loop.py"),
    *("engine/on_demand.py", "engine/history/history.py", "engine/history/machine_motion.py", "engine/history/phase_index.py"),
    *("engine/history/slip_events.py", "engine/history/turning_points.py", "problem/run_codes.py"),
    *("contact/fold_rates.py", "contact/slopes.py", "contact/turn_search.py", "foundation/constants.py", "foundation/phasors.py"),
    *("friction/formula/at_points.py", "friction/formula/on_boxes.py", "friction/formula/on_cells.py"),
    *("friction/formula/tape.py", "friction/formula/expression.py"),
    *("solution/observables/layer_records.py", "solution/observables/layer_replay.py"),
)
"""Other files that hold compiled functions, or constants that compiled functions use; tests/test_rooms.py checks the list."""
NOT_COMPILED = ("code.py", "lock.py")
"""Files in these folders that decide where machine code is kept, but not what it does; the key leaves them out."""


# ---- the key of all that is compiled, and the folders of machine code ------------------------------------------------------


def compiled_sources() -> list[Path]:
    """Return the paths of all files whose content is compiled, sorted."""
    folders = [path for folder in COMPILED_FOLDERS for path in (PACKAGE / folder).rglob("*.py")]
    inside = [path for path in folders if path.name not in NOT_COMPILED]
    return sorted([*inside, *(PACKAGE / name for name in COMPILED_FILES)])


SOURCES = key_of_files(compiled_sources())
"""Key that identifies the code that is compiled."""
NAME = f"{SOURCES}-{PROCESSOR.name}"
"""Name of folders of machine code that this process can use."""


@cache
def cache_folder() -> Path | None:
    """Return the folder of machine code in `cache_root`, or None if it cannot be made there or would not be private."""
    try:
        return private_folder(cache_root() / f"compiled-{NAME}")
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}" if error.strerror else str(error)
    tell(f"no cache for machine code: {ascii(reason)[1:-1]}; STICKSLIP_CACHE_DIR names another folder")
    return None


class Kept:
    """A file of machine code."""

    def __init__(self, name: str, text: str = "") -> None:
        """Look for the code of a name; `text` is what else decides it, beside the sources."""
        self.file = f"{name}-{hashlib.sha256(text.encode()).hexdigest()[:32]}.o" if text else f"{name}.o"

    def read(self) -> bytes | None:
        """Return the machine code, or None if it must be compiled."""
        return self._shipped() or self._in_cache()

    def _shipped(self) -> bytes | None:
        path = SHIPPED / NAME / self.file
        return read_sealed(path, own=False) if path.exists() else None

    def _in_cache(self) -> bytes | None:
        folder = cache_folder()
        if folder is None:
            return None
        content = read_sealed(folder / self.file)
        if content is not None:
            with suppress(OSError):  # it belongs to a medium that cannot be written
                os.utime(folder / self.file)  # it has been used
        return content

    def write(self, code: bytes) -> None:
        """Keep machine code for later starts, or say that it cannot be written."""
        folder = cache_folder()
        if folder is None:
            return
        try:
            write_sealed(folder / self.file, code)
            TIDY.after(len(code))
        except OSError as error:
            tell(
                f"compiled code cannot be kept in {folder}: {error.strerror}; later starts compile again; "
                "STICKSLIP_CACHE_DIR names another folder"
            )


def make_room(largest: int = LARGEST_CACHE) -> None:
    """Remove the least recently used files from the caches of all versions until they take at most `largest` bytes together."""
    found = []
    for path in cache_root().glob("compiled-*/**/*"):
        with suppress(OSError):  # another process removes it, too, or it is damaged
            about = path.lstat()  # a link takes no room, whatever it leads to
            if not path.is_dir() or path.is_symlink():
                found.append((about.st_mtime, about.st_size, path))
    excess = sum(size for _, size, _ in found) - largest
    for _, size, path in sorted(found):
        if excess <= 0:
            return
        with suppress(OSError):  # on Windows a file that is being read stays
            path.unlink(missing_ok=True)
            excess -= size


class Tidy:
    """Makes room in the cache when a process first writes, and again whenever it has written `LOOK_AFTER` bytes.

    To look at all files for each function would slow down a first start.
    """

    def __init__(self) -> None:
        self._written = LOOK_AFTER

    def after(self, size: int) -> None:
        """Count a file of `size` bytes, which has been written, and make room if it is time to."""
        self._written += size
        if self._written >= LOOK_AFTER:
            self._written = 0
            make_room()


TIDY = Tidy()
"""What this process has written, and its look at the size of the cache."""


# ---- loading ---------------------------------------------------------------------------------------------------------------


def loaded(code: bytes) -> Any:
    """Return LLVM's engine with the machine code of an object file, which lives as long as the engine."""
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), PROCESSOR.machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return engine


_engines: list[Any] = []
"""Machine code of entries, which lives as long as the process."""


def kept_of(entry: Any) -> Kept:
    """Return the file of machine code of an entry; those of an extension have the key of its folder `compiled`, beside SOURCES."""
    own = PACKAGE.parent.joinpath(*entry.__module__.split(".")).parent
    return Kept(entry.name, key_of_files(sorted(own.glob("*.py"))) if own.name == "compiled" else "")


def address_of_entry(entry: Any) -> int:
    """Return the address of the machine code of an entry of the engine, which is made now if neither package nor cache has it."""
    kept = kept_of(entry)
    code = kept.read()
    if code is None:
        code = made_now(entry)
        kept.write(code)
    _engines.append(loaded(code))
    return int(_engines[-1].get_function_address(entry.name))


def made_now(entry: Any) -> bytes:
    """Return the machine code of an entry, after a line that says why it has to be made."""
    if os.environ.get("NUMBA_DISABLE_JIT", "") not in ("", "0"):
        raise InputError(f"{why_not_shipped()}, and NUMBA_DISABLE_JIT is set, so that nothing compiles it: unset it")
    try:
        compiler = import_module("stickslip.foundation.kernels.compiler.objects")  # loads numba, which nothing else does
    except ImportError as error:
        raise InputError(
            f"{why_not_shipped()}, and the compiler that would make it is missing ({error}): pip install 'stickslip[compiler]'"
        ) from None
    announce(f"compiling the engine, a minute or more, once: {why_not_shipped()}")
    return bytes(compiler.object_of(entry, PROCESSOR))


def why_not_shipped() -> str:
    """Return in a few words why the machine code that came with the package does not serve this process."""
    there = [path.name for path in SHIPPED.glob("*-*")] if SHIPPED.is_dir() else []
    if any(name == NAME for name in there):
        return "a file of the machine code that came with the package is missing or damaged"
    if any(name.endswith(PROCESSOR.name) for name in there):
        return "the code has changed since the package was built"
    found = ", ".join(sorted({name.partition("-")[2] for name in there}))
    came = f"came only for {found}" if found else "did not come with the package"
    return f"machine code for this processor ({PROCESSOR.name}) {came}"


announce: Callable[[str], None] = tell
"""Function that says that something is compiled: on standard error, unless a progress display has replaced it."""


def announce_by(show: Callable[[str], None]) -> None:
    """Say that something is compiled by the given function instead of on standard error."""
    global announce
    announce = show
