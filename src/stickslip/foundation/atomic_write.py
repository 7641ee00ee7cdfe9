"""Atomic writing of files, and reading of files up to a size limit."""

from __future__ import annotations

import errno
import io
import os
import re
import shutil
import stat
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO
from uuid import uuid4

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.foundation.locks import close, locked

if TYPE_CHECKING:
    import pandas as pd

DRAFT = ".stickslip-draft-"
"""Prefix of the temporary names (drafts) of files and folders that are being written; they get their final name afterwards."""
STALE = 60.0
"""An unlocked draft counts as left behind at this age (s): a living writer locks its draft long before that."""
STALE_WITHOUT_LOCKS = 86_400.0
"""A draft counts as left behind at this age (s) even if no lock on it could be taken: no file takes a day to write."""
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Error numbers that mean that there is no space left: full disk, exhausted quota, or a file size limit."""


@contextmanager
def open_bounded(path: Path, largest: int, *, own: bool = False) -> Iterator[BinaryIO]:
    """Open a regular file of at most `largest` bytes for reading; with `own`, only one of this user, and not through a link.

    Pipes and devices are refused at once, because they may never begin or never end. Raises OSError, and InputError with a message
    that is meant to follow the name of the file.
    """
    with open(path, "rb", opener=_opened_without_link if own else _opened_at_once) as stream:
        about = os.fstat(stream.fileno())
        if not stat.S_ISREG(about.st_mode):
            raise InputError("not an ordinary file")
        if own and hasattr(os, "geteuid") and about.st_uid != os.geteuid():
            raise InputError("of another user")
        if about.st_size > largest:
            raise InputError(f"larger than {largest} bytes")
        yield stream


def read_bounded(path: Path, largest: int, *, own: bool = False) -> bytes:
    """Return the content of a regular file of at most `largest` bytes. Raises OSError and InputError as `open_bounded` does."""
    with open_bounded(path, largest, own=own) as stream:
        content = stream.read(largest + 1)
    if len(content) > largest:  # it has grown, or has no size of its own
        raise InputError(f"larger than {largest} bytes")
    return content


def _opened_at_once(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _opened_without_link(path: str, flags: int) -> int:
    return _opened_at_once(path, flags | getattr(os, "O_NOFOLLOW", 0))


def write_atomically(path: Path, write: Callable[[Path], object], *, folder: bool = False) -> Path:
    """Let `write` fill a temporary file or folder (the draft) beside `path`, rename it to `path`, and return the path.

    Readers never see half of it. The content of a file is on the disk before the file is renamed, and the new name before the
    function returns. The draft is locked, and drafts of writers that were killed are removed. Raises OSError, which names `path`,
    or a file in it, and not the draft.
    """
    draft = _draft_beside(path)
    try:
        if folder:
            draft.mkdir()
        else:
            draft.touch(exist_ok=False)
        held = locked(draft)
        try:
            write(draft)
            if not folder:
                sync(draft)
            draft.replace(path)
            sync_folder(path.parent)
        finally:
            close(held)
    except OSError as error:
        named = path if error.filename is None else Path(str(error.filename))
        if error.errno is None or not (named == path or named.is_relative_to(draft)):
            raise
        final = path / named.relative_to(draft) if named.is_relative_to(draft) else path
        raise OSError(error.errno, error.strerror, str(final)) from None
    finally:
        _remove(draft)
    return path


def _remove(draft: Path) -> None:
    if draft.is_dir():
        shutil.rmtree(draft, ignore_errors=True)
    else:
        draft.unlink(missing_ok=True)


def _draft_beside(path: Path) -> Path:
    """Return a temporary name beside a path, with the same suffix, and remove drafts that killed writers have left there."""
    with suppress(OSError):
        for old in list(path.parent.glob(f"{DRAFT}*")):
            if _is_stale(old):
                _remove(old)
    return path.with_name(f"{DRAFT}{uuid4().hex}{path.suffix}")


def _is_stale(draft: Path) -> bool:
    """Return True if a draft is older than `STALE` and unlocked, or, whether locked or not, older than `STALE_WITHOUT_LOCKS`."""
    with suppress(OSError):
        age = time.time() - draft.stat().st_mtime
        if age < STALE or draft.is_symlink():
            return False
        held = locked(draft)
        close(held)
        return held is not None or age >= STALE_WITHOUT_LOCKS
    return False


def sync(path: Path) -> None:
    """Force the content of a file to the disk."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())


def sync_folder(folder: Path) -> None:
    """Force the names in a folder to the disk, if the operating system supports that."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


class SafeSink(io.FileIO):
    """A binary file for libraries that crash if a write fails: it stores the first error and reports success.

    Bytes that could not be written read back as zeros. Call `check` after the library has closed its file.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(path, "w+b")
        self._end = 0
        self.error: OSError | None = None

    @override
    def seek(self, offset: int, whence: int = os.SEEK_SET, /) -> int:
        if whence == os.SEEK_END:  # the apparent end: the file itself may be shorter
            return super().seek(self._end + offset)
        return super().seek(offset, whence)

    @override
    def write(self, data: Any, /) -> int:
        """Write all bytes, or store the error; return the full length in both cases."""
        view, place, done = memoryview(data).cast("B"), self.tell(), 0
        try:
            while done < len(view) and self.error is None:
                done += super().write(view[done:])
        except OSError as error:
            self.error = error
        self._end = max(self._end, super().seek(place + len(view)))
        return len(view)

    @override
    def readinto(self, buffer: Any, /) -> int:
        """Read bytes up to the apparent end of the file; those whose write failed are zeros."""
        view, place = memoryview(buffer).cast("B"), self.tell()
        wanted = max(min(len(view), self._end - place), 0)
        found = super().readinto(view[:wanted]) or 0
        view[found:wanted] = bytes(wanted - found)
        super().seek(place + wanted)
        return wanted

    @override
    def truncate(self, size: int | None = None, /) -> int:
        self._end = self.tell() if size is None else size
        if self.error is None:
            try:
                super().truncate(self._end)
            except OSError as error:
                self.error = error
        return self._end

    def check(self) -> None:
        """Raise the first error that was stored, if there is one."""
        if self.error is not None:
            raise self.error


OWN = re.compile(
    rb"^# (written by |code=)?stickslip\b|^start,end,duration,recurrence,"
    rb"|^time \(s\),slip \((?:m|rad)\),slip[ _]rate \((?:m|rad)/s\),(?:load|traction|normal_load) \(",
    re.MULTILINE,
)
"""What stands in the text files that this package writes: a comment, or the columns of a catalogue that grows."""
BINARY = {".nc": b"\x89HDF", ".parquet": b"PAR1"}
"""First bytes of files that name this package somewhere at their beginning or end, by suffix."""
LOOKED_AT = 65_536
"""A file of this package names it within this many bytes from the beginning, or from the end."""


def check_replaceable(path: Path, where: str) -> None:
    """Refuse to replace data that this package did not write, and scenarios, which people edit; an empty file may be replaced.

    Pictures are not looked into. Raises InputError, which begins with `where`.
    """
    suffix = path.suffix.lower()
    if suffix not in (".csv", ".txt", ".dat", ".toml", *BINARY) or not path.is_file() or not path.stat().st_size:
        return
    if suffix == ".toml":
        raise InputError(f"{where}: exists, and may have been edited: choose another name, or remove it")
    with path.open("rb") as file:
        ends = file.read(LOOKED_AT)
        file.seek(max(path.stat().st_size - LOOKED_AT, 0))
        ends += file.read()
    is_own = b"stickslip" in ends and ends.startswith(BINARY[suffix]) if suffix in BINARY else OWN.search(ends)
    if not is_own:
        raise InputError(f"{where}: exists, and stickslip did not write it: choose another name, or remove it")


def _no_formula(cell: Any) -> Any:
    """Return a cell of a table so that no spreadsheet takes a text, such as the name of a file, for a formula."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(("=", "+", "-", "@", "\t", "\r")) else cell


def write_table(path: Path, table: pd.DataFrame, about: Iterable[str]) -> Path:
    """Write a table as CSV with all digits, after comment lines (`#`) that say where it comes from, and return the path.

    Read it with `pandas.read_csv(path, comment="#")`. By one of the comments `check_replaceable` knows the file again.
    """
    lines = [line for text in about for line in text.splitlines()]
    lines = lines if any(line.startswith("stickslip ") for line in lines) else ["written by stickslip", *lines]
    comment = "".join(f"# {line}".rstrip() + "\n" for line in lines)
    texts = table.select_dtypes(exclude="number").columns
    table = table.assign(**{name: table[name].map(_no_formula) for name in texts})
    text = comment + table.to_csv(index=False, lineterminator="\n")
    return write_atomically(path, lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))
