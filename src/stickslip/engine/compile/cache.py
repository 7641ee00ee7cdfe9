"""Keep compiled code in a cache on disk that belongs to this user.

Machine code and pickles from the cache folder are executed. The folder must therefore belong to this user alone (see
`private_folder`). If there is no such folder, each process compiles for itself.

Every file carries a checksum, because LLVM does not check what it loads: of 300 machine codes with one wrong bit 30 ended the
process and 6 gave wrong numbers. A file that is damaged in any way counts as missing, and its code is compiled again.

The name of the folder contains a hash of all code that is compiled, so that an edited kernel never meets its old machine code. It
is made from Python's bytecode: an edited comment, docstring or line break leaves it as it is. To make the bytecode takes a tenth of
a second, so the hash is kept on disk, too, under a hash of the files themselves.

The cache has a largest size. The files that have not been used for longest are removed, whichever version of the code they belong
to; a process that still needs one compiles it again.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import CodeType

import numba
import platformdirs

from stickslip.engine.compile.private_folder import private_folder
from stickslip.engine.compile.uncompiled import UNCOMPILED
from stickslip.foundation.atomic_write import read_bounded, write_atomically
from stickslip.foundation.errors import InputError

LARGEST_CACHE = 500_000_000
"""Largest size (bytes) of the cache; beyond it, the least recently used files are removed."""
LARGEST_FILE = 50_000_000
"""Largest size (bytes) of a file of the cache, far more than any machine code takes; what is larger is neither written nor read."""
LOOK_AFTER = 10_000_000
"""The size of the cache is looked at again after a process has written this many bytes, so that a long one keeps the bound."""
SEAL = b"stickslip cache 1\n"
"""First bytes of each file of the cache; the checksum of its name and content follows, then the content."""
OF_SEAL = len(SEAL) + hashlib.sha256().digest_size
"""Number of bytes before the content of a file."""
NOT_COMPILED = ("cache.py", "lock.py", "private_folder.py")
"""Files in the compiled folders that decide where machine code is kept, but not what it does; the hash leaves them out."""
COMPILED_FOLDERS = (
    *(
        "engine/compile",
        "engine/contact",
        "engine/contact_step",
        "engine/folds",
        "engine/formula_code",
        "engine/lanes",
        "engine/memory",
    ),
    *("engine/radau", "engine/series", "engine/state", "engine/waves", "friction/formula/operations"),
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
DIGITS = 16
"""Number of hexadecimal digits of a key."""

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


# ---- files with a checksum -------------------------------------------------------------------------------------------------


def write_sealed(path: Path, content: bytes) -> None:
    """Write content to a file, after the mark SEAL and the checksum."""
    sealed = SEAL + _checksum(path, content) + content
    write_atomically(path, lambda draft: draft.write_bytes(sealed))


def read_sealed(path: Path) -> bytes | None:
    """Return the content of a file, or None if it is missing or damaged; remove it in the second case.

    Whatever else has the name of the file counts as damage and is not read: a pipe or a device, which might never end, a link, a
    file of another user, and one that is larger than any of the cache.
    """
    with suppress(OSError, InputError):  # it cannot be read, or may not be
        sealed = read_bounded(path, LARGEST_FILE, own=True)
        content = sealed[OF_SEAL:]
        if sealed[:OF_SEAL] == SEAL + _checksum(path, content):
            return content
    if os.path.lexists(path):
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


# ---- the key of all code ---------------------------------------------------------------------------------------------------


def compiled_sources() -> list[Path]:
    """Return the paths of all files whose content is compiled, sorted."""
    package = Path(__file__).parents[2]
    folders = [path for folder in COMPILED_FOLDERS for path in (package / folder).rglob("*.py")]
    inside = [path for path in folders if path.name not in NOT_COMPILED]
    return sorted([*inside, *(package / name for name in COMPILED_FILES)])


def key_of(texts: Iterable[bytes]) -> str:
    """Return the hash of the code in some source files, without comments, docstrings, assertions and the layout of lines."""
    digest = hashlib.sha256(VERSIONS.encode())
    for text in texts:
        digest.update(_bytecode(compile(text, "", "exec", dont_inherit=True, optimize=2)).encode())
    return digest.hexdigest()[:DIGITS]


def _bytecode(code: CodeType) -> str:
    """Return all that a code object does, with the functions in it, as a text: without numbers of lines."""
    parts = [code.co_name, code.co_argcount, code.co_kwonlyargcount, code.co_posonlyargcount, code.co_flags, code.co_code]
    parts += [code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_exceptiontable]
    for one in code.co_consts:
        parts.append(_bytecode(one) if isinstance(one, CodeType) else sorted(map(repr, one)) if isinstance(one, frozenset) else one)
    return repr(parts)


def remembered_key(folder: Path) -> str:
    """Return the key of all compiled sources.

    It is kept in `folder`, in a file that is named for the hash of the unchanged files. The folder must be private: a wrong key
    would lead to other machine code. Where it cannot be written, the key is made anew.
    """
    texts = [path.read_bytes() for path in compiled_sources()]
    digest = hashlib.sha256(VERSIONS.encode())
    for text in texts:
        digest.update(text)
    kept = folder / digest.hexdigest()
    found = read_sealed(kept)
    if found is not None:
        return found.decode()
    key = key_of(texts)
    with suppress(OSError):  # the folder of machine code will meet the same fault, and says so
        write_sealed(kept, key.encode())
    return key


def sources_key() -> str:
    """Return the key of the code that is compiled, kept in the cache if there is a private folder for it."""
    try:
        return remembered_key(private_folder(cache_root() / "keys"))
    except OSError:
        return key_of(path.read_bytes() for path in compiled_sources())


SOURCES = sources_key()
"""Hash that identifies the code that is compiled, together with the versions of numba and Python that compile it."""


# ---- the folder of machine code --------------------------------------------------------------------------------------------


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
        if self.path is None or len(code) > LARGEST_FILE - OF_SEAL:
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
