"""What users bring: a scenario file, measured points for the friction law, a formula. All of it is untrusted text.

Nothing is evaluated, and no path in an uploaded text is followed: the points of a table go into the document itself.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import PurePosixPath

from stickslip.explorer.model.exchange import with_kind
from stickslip.explorer.model.setting import Setting
from stickslip.foundation.errors import InputError
from stickslip.friction import FromExpression, FromTable
from stickslip.friction.formula.parse import RESERVED
from stickslip.scenarios import library
from stickslip.scenarios.points import points_in
from stickslip.scenarios.scenario import read_scenario
from stickslip.scenarios.values import show

LARGEST = 1_000_000
"""Largest number of bytes of an upload."""
MOST_ROWS = 20_000
"""Largest number of lines of an upload; a law takes fewer points still (`foundation.quantities.LARGEST_SERIES`)."""
LONGEST_NAME = 60
"""Number of characters of the name of a file that are kept."""
_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
"""A name in a formula; the e of 1e-3 is none."""


def uploaded(setting: Setting, file: str, content: bytes) -> Setting:
    """Return the setting that an uploaded file makes of the present one.

    Parameters
    ----------
    setting : Setting
        The present setting, which takes the points of a table as its friction law.
    file : str
        Name of the file: "....toml" is a scenario, anything else is a table with a column "friction" and one of "slip" (m) or
        "slip_rate" (m/s), separated by commas; headings may carry other units.
    content : bytes
        The file.

    Returns
    -------
    Setting
        The new setting; it makes a scenario.

    Raises
    ------
    InputError
        If the file is too large, is no text, or has a fault; in one line.
    """
    name = _name_of(file)
    text = _text(name, content)
    made = _scenario(name, text) if name.lower().endswith(".toml") else with_table(setting, name, text)
    made.scenario()
    return made


def _name_of(file: str) -> str:
    """Return the last part of a file's name in ASCII, cut to a length that fits a line."""
    name = PurePosixPath(file.replace("\\", "/")).name
    return ("".join(letter if letter.isascii() and letter.isprintable() else "_" for letter in name) or "upload")[-LONGEST_NAME:]


def _text(name: str, content: bytes) -> str:
    if len(content) > LARGEST:
        raise InputError(f"{name}: {len(content) / 1e6:.1f} MB is too large; at most {LARGEST / 1e6:g} MB are read")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{name}: not a text file in UTF-8") from None
    lines = text.count("\n")
    if lines > MOST_ROWS:
        raise InputError(f"{name}: {lines} lines are too many; at most {MOST_ROWS} are read")
    return text


def _scenario(name: str, text: str) -> Setting:
    read_scenario(text, name)  # refuses files that the scenario names, since it lies in no folder
    stem = name.removesuffix(".toml")
    return Setting(f"{stem} (uploaded)" if stem in library.names() else stem, tomllib.loads(text))


def with_table(setting: Setting, name: str, text: str) -> Setting:
    """Return a setting whose friction law joins the points of a table, in CSV text. Raises InputError, in one line."""
    points = points_in(text, FromTable.columns, name)
    table = {"kind": FromTable.kind} | points
    return with_kind(setting, "friction", FromTable.kind).with_value("friction", table)


def with_expression(setting: Setting, text: str) -> Setting:
    """Return a setting whose friction law is a formula in u (slip, m), v (slip rate, m/s) and parameters.

    Parameters that the setting already has keep their values, new ones are 1, and those that the formula no longer names go.
    Whether the formula is allowed turns out when the scenario is read. Raises InputError if it is no text.
    """
    if not isinstance(text, str):
        raise InputError(f"expression must be text, got {show(text)}")
    if setting.value("friction.kind") != FromExpression.kind:
        setting = with_kind(setting, "friction", FromExpression.kind)
    known = setting.value("friction.parameters") or {}
    names = dict.fromkeys(name for name in _NAME.findall(text) if name not in RESERVED)
    parameters = {name: known.get(name, 1.0) for name in names}
    return setting.with_value("friction.expression", text).with_value("friction.parameters", parameters or None)
