"""Formats of text for records: each is recognised by its first lines, and read as headings and rows of cells.

Delimited text is the core's own; all other formats are those of extensions (`Extension.forms`). `foreign` names the files that are
no text.
"""

from __future__ import annotations

import codecs
from collections.abc import Callable, Sequence

from stickslip.extension import members
from stickslip.foundation.record_files import delimited
from stickslip.foundation.record_files.foreign import OLD_LETTERS, check_is_text
from stickslip.foundation.record_files.sheet import Asked as Asked
from stickslip.foundation.record_files.sheet import Lines as Lines
from stickslip.foundation.record_files.sheet import RecordForm as RecordForm
from stickslip.foundation.record_files.sheet import Sheet as Sheet

FIRST_BYTES = 4096
"""This many bytes tell what a file is."""
_WIDE = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def form_of(first: Sequence[str]) -> Callable[[Lines, Asked], Sheet]:
    """Return the reader of a text with these first lines: delimited text, if it is in no other format."""
    return next((form.sheet for form in members("forms", RecordForm) if form.begins(first)), delimited.sheet)


def decoded(begin: bytes) -> tuple[str, str]:
    """Return the encoding of a text by its first bytes, and what is done with older letters: extensions may have those."""
    if begin.startswith(_WIDE):
        return "utf-16", "strict"
    first = begin[:FIRST_BYTES].removeprefix(codecs.BOM_UTF8).decode("latin-1").splitlines()
    return "utf-8-sig", "strict" if form_of(first) is delimited.sheet else OLD_LETTERS


def text_in(content: bytes) -> str:
    """Return the text of a whole file. Raises InputError as `check_is_text` does, and UnicodeDecodeError."""
    check_is_text(content[:FIRST_BYTES])
    return content.decode(*decoded(content))
