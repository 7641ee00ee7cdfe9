"""Files that appear whole or not at all, files that are read only so far, and locks on names."""

from __future__ import annotations

import errno
import io
import os
import shutil
import stat
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

DRAFT = ".stickslip-draft-"
"""Prefix of the temporary names under which files and folders are written."""
STALE = 60.0
"""Age (s) from which a draft that nobody has locked was left by a process that died."""
STALE_WITHOUT_LOCKS = 86_400.0
"""The same (s) where the file system or the operating system has no locks: no file takes a day to write."""
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Error numbers which say that there is no more room."""


def read_bounded(path: Path, largest: int) -> bytes:
    """Return what an ordinary file of at most `largest` bytes holds.

    A pipe or a device is not waited for: it may never begin, or never end. Raises OSError, and InputError, the end of a sentence
    that begins with the file.
    """
    with open(path, "rb", opener=_opened_at_once) as stream:
        if not stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
            raise InputError("not an ordinary file")
        content = stream.read(largest + 1)
    if len(content) > largest:
        raise InputError(f"larger than {largest} bytes")
    return content


def _opened_at_once(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def write_atomically(path: Path, write: Callable[[Path], object]) -> Path:
    """Let `write` fill a temporary file beside `path`, then give it the name: never half a file. Returns the path.

    The content is on the disk before the name is changed, and the name before this returns. Drafts of writers that were killed
    are removed. Raises OSError, which names `path` and not the draft.
    """
    draft = draft_beside(path)
    try:
        draft.touch(exist_ok=False)
        held = _locked(draft)
        try:
            write(draft)
            sync(draft)
            draft.replace(path)
            sync_folder(path.parent)
        finally:
            _close(held)
    except OSError as error:
        if error.errno is None or Path(str(error.filename)) not in (draft, Path("None")):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        draft.unlink(missing_ok=True)
    return path


def draft_beside(path: Path) -> Path:
    """Return a temporary name beside a path, with its suffix, and remove what killed writers have left under such names."""
    with suppress(OSError):
        for old in list(path.parent.glob(f"{DRAFT}*")):
            if _is_stale(old):
                shutil.rmtree(old) if old.is_dir() else old.unlink(missing_ok=True)
    return path.with_name(f"{DRAFT}{uuid4().hex}{path.suffix}")


def _is_stale(draft: Path) -> bool:
    """Return True if a draft is old and no living process holds it."""
    with suppress(OSError):
        age = time.time() - draft.stat().st_mtime
        if age < STALE or draft.is_symlink():
            return False
        held = _locked(draft)
        _close(held)
        return held is not None or age >= STALE_WITHOUT_LOCKS
    return False


def sync(path: Path) -> None:
    """Have the content of a file on the disk."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())


def sync_folder(folder: Path) -> None:
    """Have the names in a folder on the disk, where the operating system can do that."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


def _locked(path: Path) -> int | None:
    """Lock a file or folder for this process; None where another one has it, or where there are no locks."""
    try:
        import fcntl
    except ImportError:  # Windows
        return None
    number = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(number)
        return None
    return number


def _close(number: int | None) -> None:
    if number is not None:
        os.close(number)


@contextmanager
def held(path: Path, refusal: str) -> Iterator[None]:
    """Hold a name against other processes, also if there is no such file; the lock ends with the process, however it ends.

    The lock is on the file `.NAME.lock` beside it, which is removed afterwards. Raises InputError with this text where another
    process holds the name. Where the file system has no locks nothing is held.
    """
    lock = path.with_name(f".{path.name}.lock")
    number = _lock_of(lock, refusal)
    try:
        yield
    finally:
        if number is not None:
            lock.unlink(missing_ok=True)
            os.close(number)


def _lock_of(lock: Path, refusal: str) -> int | None:
    """Lock the file of this name, which another process may be about to remove. Raises InputError where that one holds it."""
    try:
        import fcntl
    except ImportError:  # Windows
        return None
    while True:
        number = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o666)
        try:
            fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(number), lock.stat()):
                    return number
            os.close(number)  # it was removed in between: nobody else would meet this lock
        except BlockingIOError:
            os.close(number)
            raise InputError(refusal) from None
        except OSError:  # a file system without locks
            os.close(number)
            return None


class Sink(io.RawIOBase):
    """A binary file for libraries that crash where a write fails: it keeps the first error and pretends that all went well.

    What could not be written reads as zeros. Call `check` when the library has closed its file.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("w+b", buffering=0)
        self._end, self._place = 0, 0
        self.error: OSError | None = None

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET, /) -> int:
        self._place = offset + (0, self._place, self._end)[whence]
        return self._place

    def tell(self) -> int:
        return self._place

    def write(self, data: Any, /) -> int:
        """Write all of it, or keep the error."""
        view = memoryview(data).cast("B")
        done = 0
        try:
            while done < len(view) and self.error is None:
                self._file.seek(self._place + done)
                done += self._file.write(view[done:])
        except OSError as error:
            self.error = error
        self._place += len(view)
        self._end = max(self._end, self._place)
        return len(view)

    def readinto(self, buffer: Any, /) -> int:
        """Read as much as was written, or seemed to be."""
        view = memoryview(buffer).cast("B")
        wanted = max(min(len(view), self._end - self._place), 0)
        self._file.seek(self._place)
        found = self._file.readinto(view[:wanted])
        view[found:wanted] = bytes(wanted - found)
        self._place += wanted
        return wanted

    def truncate(self, size: int | None = None, /) -> int:
        self._end = self._place if size is None else size
        if self.error is None:
            try:
                self._file.truncate(self._end)
            except OSError as error:
                self.error = error
        return self._end

    def close(self) -> None:
        self._file.close()
        super().close()

    def check(self) -> None:
        """Raise the first error."""
        if self.error is not None:
            raise self.error


def write_table(path: Path, table: pd.DataFrame, about: Iterable[str]) -> Path:
    """CSV with every digit, behind lines of comment (`#`) that say where it comes from: `pandas.read_csv(path, comment="#")`."""
    comment = "".join(f"# {line}".rstrip() + "\n" for text in about for line in text.splitlines())
    text = comment + table.to_csv(index=False, lineterminator="\n")
    return write_atomically(path, lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))
