"""Files that are opened on the page: a scenario (TOML), or measured points of friction (CSV). They are untrusted."""

from __future__ import annotations

import base64
import binascii
from dataclasses import replace
from pathlib import PurePosixPath, PureWindowsPath

from stickslip.explorer.model.exchange import with_kind
from stickslip.explorer.model.setting import Setting
from stickslip.foundation.errors import InputError, gathered
from stickslip.friction.custom.measured import table_in_text
from stickslip.scenarios import library
from stickslip.scenarios.scenario import read_scenario
from stickslip.scenarios.text_of_files import LARGEST_SCENARIO_FILE, text_of

TABLES = (".csv", ".txt", ".tsv", ".dat")
"""Suffixes of files that hold points."""
MOST_ROWS = 20_000
"""Largest number of points of an uploaded table."""
LONGEST_NAME = 80
"""Largest number of characters of a file's name that are kept."""


def content_of(encoded: str) -> bytes:
    """Return the content of a file from the browser's text in base64. Raises InputError if it is too large or broken."""
    if len(encoded) > 4 * (LARGEST_SCENARIO_FILE // 3 + 2):
        raise InputError(f"the file is larger than {LARGEST_SCENARIO_FILE} bytes")
    try:
        return base64.b64decode(encoded, validate=True)
    except (binascii.Error, ValueError):
        raise InputError("the file did not arrive whole: open it again") from None


def opened(name: str, content: bytes, present: Setting) -> Setting:
    """Return the setting to which an opened file leads: a scenario, or the present setting with a table of friction as its law.

    Folders in the name are dropped. Raises InputError, in one line, if the file is too large, is no text, or cannot be used.
    """
    name = plain_name(name)
    if PurePosixPath(name).suffix.lower() in TABLES:
        return _with_table(name, content, present)
    stem = PurePosixPath(name).stem
    own = f"{stem} (opened)" if stem in library.names() else stem  # or it would be taken for a change of the bundled one
    with gathered():  # these doubts, too
        return Setting.of(read_scenario(text_of(content, name), name, own))


def plain_name(name: str) -> str:
    """Return the last part of a file's name, without folders and signs that cannot be printed."""
    last = PureWindowsPath(PurePosixPath(name).name).name
    return "".join(sign for sign in last if sign.isprintable())[-LONGEST_NAME:] or "file"


def _with_table(name: str, content: bytes, present: Setting) -> Setting:
    """Return the present setting with the points of a file as its friction law."""
    with gathered() as notes:
        along, places, friction = table_in_text(text_of(content, name), name)
    if len(friction) > MOST_ROWS:
        raise InputError(f"{name}: has {len(friction)} points, at most {MOST_ROWS} are taken")
    key = "slip" if along == "slip" else "rate"
    table = {"kind": "table", key: places.tolist(), "friction": friction.tolist()}
    with gathered():  # doubts about the law itself are found whenever the setting is read
        changed = with_kind(present, "friction", "table").with_value("friction", table)
    changed.scenario()
    return replace(changed, notes=tuple(notes))
