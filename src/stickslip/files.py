"""Files that appear whole or not at all, and files that are read only so far."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING
from uuid import uuid4

from stickslip.errors import InputError

if TYPE_CHECKING:
    import pandas as pd


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
    """Let `write` fill a temporary file beside `path`, then give it the name: never half a file. Returns the path."""
    draft = path.with_name(f".{uuid4().hex}{path.suffix}")
    try:
        write(draft)
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)
    return path


def write_table(path: Path, table: pd.DataFrame, about: Iterable[str]) -> Path:
    """CSV with every digit, behind lines of comment (`#`) that say where it comes from: `pandas.read_csv(path, comment="#")`."""
    comment = "".join(f"# {line}".rstrip() + "\n" for text in about for line in text.splitlines())
    text = comment + table.to_csv(index=False, lineterminator="\n")
    return write_atomically(path, lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))
