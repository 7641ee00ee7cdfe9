"""Locks on files, folders and names, against other processes: by flock, and by filelock where the system has no flock."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from stickslip.foundation.errors import InputError

try:
    import fcntl
except ImportError:  # Windows
    HAS_FLOCK = False
else:
    HAS_FLOCK = True


@contextmanager
def held(path: Path, refusal: str) -> Iterator[None]:
    """Reserve a folder, or the name of a file that need not exist yet, against other processes.

    A folder is locked itself. For a file the lock is on the file `.NAME.lock` beside it, which is removed afterwards. The operating
    system releases the lock when the process ends, however it ends. Raises InputError with the text `refusal` if another process
    holds the name, and if the file of the lock cannot be made. If the file system does not support locks, nothing is reserved.
    Where folders cannot be locked, as on Windows, the lock is beside a folder, too.
    """
    lock = path.with_name(f".{path.name}.lock")
    if not HAS_FLOCK:
        with _held_by_library(path, lock, refusal):
            yield
        return
    beside = None if path.is_dir() else lock
    try:
        number = locked(path, refusal) if beside is None else _locked_beside(beside, refusal)
    except OSError as error:
        wrong = beside if beside is not None and os.path.lexists(beside) else path  # what stands there, or the file that was named
        raise InputError(f"{wrong}: cannot be written: {error.strerror or error}") from None
    try:
        yield
    finally:
        if beside is not None and number is not None:
            beside.unlink(missing_ok=True)
        close(number)


@contextmanager
def _held_by_library(path: Path, lock: Path, refusal: str) -> Iterator[None]:
    """Reserve a name as `held` does, by the locks of filelock, which knows how on other systems than POSIX."""
    import filelock

    file = filelock.FileLock(lock)
    try:
        os.scandir(lock.parent).close()  # a folder that is not there would be made
        file.acquire(timeout=0.0)
    except filelock.Timeout:
        raise InputError(refusal) from None
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    try:
        yield
    finally:
        file.release()


def locked(path: Path, refusal: str = "", flags: int = os.O_RDONLY) -> int | None:
    """Lock a file or folder and return its descriptor; return None if another process holds it or locks are not supported.

    Raises InputError with the text `refusal`, if there is one, in place of returning None if another process holds it.
    """
    if not HAS_FLOCK:
        return None
    number = os.open(path, flags | os.O_NONBLOCK, 0o666)  # a pipe of this name would never open
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(number)
        if refusal and isinstance(error, BlockingIOError):
            raise InputError(refusal) from None
        return None
    return number


def _locked_beside(lock: Path, refusal: str) -> int | None:
    """Create and lock a file of this name, which another process may be about to remove. Returns and raises as `locked` does."""
    while True:
        number = locked(lock, refusal, os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0))
        with suppress(FileNotFoundError):
            if number is None or os.path.samestat(os.fstat(number), lock.stat()):
                return number
        close(number)  # the file was removed in between, so no other process would ever see this lock: try again


def close(number: int | None) -> None:
    """Release what `locked` has locked."""
    if number is not None:
        os.close(number)
