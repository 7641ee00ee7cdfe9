"""The key under which machine code is kept changes with the code that is compiled, and with nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from stickslip.engine.codegen.sources import compiled_sources, key_of, remembered_key

TEXT = b'''"""Say what this is."""

WIDTH = 2.0
"""Width, m."""


def twice(x):
    """Return twice x."""
    return WIDTH * x
'''


@pytest.mark.parametrize(
    ("before", "after"),
    [(b"Return twice x.", b"Double x."), (b"Width, m.", b"Width."), (b"is.", b"was."), (b"* x", b"* x  # why"), (b"\n\n\n", b"\n")],
)
def test_texts_and_layout_leave_the_key(before: bytes, after: bytes) -> None:
    changed = TEXT.replace(before, after)
    assert changed != TEXT
    assert key_of([changed]) == key_of([TEXT])


@pytest.mark.parametrize(("before", "after"), [(b"2.0", b"2.5"), (b"WIDTH * x", b"x * WIDTH"), (b"twice(x)", b"thrice(x)")])
def test_every_change_of_code_changes_the_key(before: bytes, after: bytes) -> None:
    changed = TEXT.replace(before, after)
    assert changed != TEXT
    assert key_of([changed]) != key_of([TEXT])


def test_code_that_moves_to_another_file_changes_the_key() -> None:
    assert key_of([TEXT, b""]) != key_of([b"", TEXT])


def test_a_key_is_remembered_and_a_damaged_one_is_made_anew(tmp_path: Path) -> None:
    key = key_of(path.read_bytes() for path in compiled_sources())
    assert remembered_key(tmp_path) == key
    (kept,) = tmp_path.iterdir()
    kept.write_text("0" * len(key))
    assert remembered_key(tmp_path) == "0" * len(key)  # what is read is used
    kept.write_bytes(b"\xff damaged")
    assert remembered_key(tmp_path) == key
    assert kept.read_text() == key
    assert remembered_key(tmp_path / "missing") == key_of(path.read_bytes() for path in compiled_sources())
