"""Keep compiled code in a cache on disk that belongs to this user.

Machine code and pickles from the cache folder are executed. The folder must therefore belong to this user alone (see
`private_folder`). If there is no such folder, each process compiles for itself.

Every file carries a checksum (`sealed_files`), because LLVM does not check what it loads: of 300 machine codes with one wrong bit
30 ended the process and 6 gave wrong numbers. A file that is damaged in any way counts as missing, and its code is compiled again.

The name of the folder contains the key of all code that is compiled (`code_key`), so that an edited kernel never meets its old
machine code, and an edited comment, docstring or line break leaves it as it is.

The cache has a largest size. The files that have not been used for longest are removed, whichever version of the code they belong
to; a process that still needs one compiles it again.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numba

from stickslip.engine.compile.uncompiled import UNCOMPILED
from stickslip.foundation.code_key import key_of_files
from stickslip.foundation.errors import InputError
from stickslip.foundation.private_folder import private_folder
from stickslip.foundation.sealed_files import cache_root, read_sealed, tell, write_sealed

LARGEST_CACHE = 500_000_000
"""Largest size (bytes) of the cache; beyond it, the least recently used files are removed."""
LOOK_AFTER = 10_000_000
"""The size of the cache is looked at again after a process has written this many bytes, so that a long one keeps the bound."""
NOT_COMPILED = ("cache.py", "lock.py")
"""Files in the compiled folders that decide where machine code is kept, but not what it does; the hash leaves them out."""
COMPILED_FOLDERS = (
    *("engine/compile", "engine/contact", "engine/contact_step", "engine/folds", "engine/formula_code", "engine/lanes"),
    *("engine/memory", "engine/radau", "engine/series", "engine/state", "engine/waves", "friction/formula/operations"),
)
"""Folders of the package whose files all enter the hash, because they hold compiled functions or write them."""
COMPILED_FILES = (
    "engine/compiled_formula.py",
    "engine/creep/pattern.py",
    "engine/input/branch_table.py",
    "engine/loop.py",
    "engine/on_demand.py",
    "foundation/constants.py",
    "friction/formula/expression.py",
    "solution/observables/layer_records.py",
    "solution/observables/layer_replay.py",
    "engine/history/history.py",
    "engine/history/machine_motion.py",
    "engine/history/phase_index.py",
    "engine/history/slip_events.py",
    "problem/run_codes.py",
    "engine/history/turning_points.py",
)
"""Other files that hold compiled functions, or constants that compiled functions use; tests/test_rooms.py checks the list."""
VERSIONS = f"{numba.__version__} {sys.version}"
"""The versions of numba and Python, because machine code depends on them, too."""

if UNCOMPILED:
    numba.config.DISABLE_JIT = True
elif numba.config.DISABLE_JIT:
    raise InputError("NUMBA_DISABLE_JIT is set, and the engine needs the compiler: unset it, or set STICKSLIP_UNCOMPILED=1, too")


# ---- the key of all that is compiled, and the folder of machine code -------------------------------------------------------


def compiled_sources() -> list[Path]:
    """Return the paths of all files whose content is compiled, sorted."""
    package = Path(__file__).parents[2]
    folders = [path for folder in COMPILED_FOLDERS for path in (package / folder).rglob("*.py")]
    inside = [path for path in folders if path.name not in NOT_COMPILED]
    return sorted([*inside, *(package / name for name in COMPILED_FILES)])


SOURCES = key_of_files(compiled_sources(), VERSIONS)
"""Hash that identifies the code that is compiled, together with the versions of numba and Python that compile it."""


def cache_folder(name: str) -> Path | None:
    """Return a folder of compiled code in `cache_root`, or None if it cannot be made there or would not be private."""
    try:
        return private_folder(cache_root() / name)
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}" if error.strerror else str(error)
    tell(
        f"no cache for compiled code: {ascii(reason)[1:-1]}; this run compiles for itself (15 s or more); "
        "STICKSLIP_CACHE_DIR names another folder"
    )
    return None


CACHE = cache_folder(f"compiled-{SOURCES}")
"""The folder of compiled code, or None if this process has to compile for itself."""


class Kept:
    """A file of machine code, named for what it holds and for a hash of the text that decides its content."""

    def __init__(self, name: str, text: str) -> None:
        self.path = None if CACHE is None else CACHE / f"{name}-{hashlib.sha256(text.encode()).hexdigest()}.nbc"

    def read(self) -> bytes | None:
        """Return the machine code, or None if it must be compiled."""
        if self.path is None:
            return None
        content = read_sealed(self.path)
        if content is not None:
            with suppress(OSError):  # it belongs to a medium that cannot be written
                os.utime(self.path)  # it has been used
        return content

    def write(self, code: bytes) -> None:
        """Keep machine code for later starts, or say that it cannot be written."""
        if self.path is None:
            return
        try:
            write_sealed(self.path, code)
            TIDY.after(len(code))
        except OSError as error:
            tell(
                f"compiled code cannot be kept in {CACHE}: {error.strerror}; later starts compile again; "
                "STICKSLIP_CACHE_DIR names another folder"
            )


def make_room(largest: int = LARGEST_CACHE) -> None:
    """Remove the least recently used files from the caches of all versions until they take at most `largest` bytes together."""
    found = []
    for path in cache_root().glob("compiled-*/**/*.nb[ico]"):  # numba's own cache has all of these endings
        with suppress(OSError):  # another process removes it, too, or it is damaged
            about = path.lstat()  # a link takes no room, whatever it leads to
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


# ---- announcements ---------------------------------------------------------------------------------------------------------

SLOW = {
    "run_until": "compiling the engine for this machine: about half a minute until the first summary, once",
    "implicit_steps": "compiling implicit steps, for stiff contacts and laws with a state: about 6 s, once",
    "run_group": "compiling what sweeps and batches add to the engine: about 20 s, once",
}
"""Messages to show before a user has to wait for the compilation of a function and of all that is compiled after it."""
OTHERS = "compiling more of the engine for this machine: up to 20 s, once"
"""Message to show when the compilation of other functions has taken `NOTICED` s and goes on."""
NOTICED = 3.0
"""Processor time (s) of compilation without a message that a user hardly notices."""
announce: Callable[[str], None] = tell
"""Function that shows such a message: on standard error, unless a progress display has replaced it."""


def announce_by(show: Callable[[str], None]) -> None:
    """Show messages about compilation with the given function instead of on standard error."""
    global announce
    announce = show
