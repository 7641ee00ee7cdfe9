"""Files that appear whole or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING
from uuid import uuid4

if TYPE_CHECKING:
    import pandas as pd


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
