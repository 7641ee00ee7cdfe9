"""Formats of text for records: each is recognised by its first lines, and read as headings and rows of cells.

To add one, write a module with `begins` and `sheet`, and name it in `FORMS`. `foreign` names the files that are no text.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from stickslip.foundation.record_files import delimited, las, lvm, uff
from stickslip.foundation.record_files.sheet import Asked, Lines, Sheet

FORMS: tuple[tuple[Callable[[Sequence[str]], bool], Callable[[Lines, Asked], Sheet]], ...] = (
    (lvm.begins, lvm.sheet),
    (las.begins, las.sheet),
    (uff.begins, uff.sheet),
)


def form_of(first: Sequence[str]) -> Callable[[Lines, Asked], Sheet]:
    """Return the reader of a text with these first lines: delimited text, if it is in no other format."""
    return next((read for begins, read in FORMS if begins(first)), delimited.sheet)
