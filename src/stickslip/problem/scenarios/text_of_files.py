"""The text of a scenario file; for a file that holds none, what it is instead and what to do with it."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import BINARY, read_bounded
from stickslip.foundation.errors import InputError, did_you_mean, meant
from stickslip.problem.scenarios import library

LARGEST_SCENARIO_FILE = 1_000_000
"""Size (bytes) of the largest scenario file that is read: scenarios are untrusted."""
_SHOW = "a file of results, not a scenario: `stickslip show` summarises it, and `stickslip run --resume` continues a run"
_TABLE = (
    "a table, not a scenario: a scenario names it, as [friction] file, or `stickslip sweep --list` reads it; to follow a record "
    "the scenario comes first: `stickslip infer SCENARIO DATA --free NAMES`"
)
_PICTURE = "a picture, not a scenario"
_STARTS = (
    (BINARY[".nc"], _SHOW),
    (b"CDF", _SHOW),
    (b"PAR1", _SHOW),
    (b"\x89PNG", _PICTURE),
    (b"%PDF", _PICTURE),
    (b"GIF8", _PICTURE),
)
"""The first bytes of files of other kinds, each with what the file is."""
_WIDE = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
"""First bytes of text in UTF-16, which some shells write."""
_START = "`stickslip new slab > mine.toml` writes a scenario to start from"


def read_text(path: Path, file: str) -> str:
    """Return the text of a scenario file, called `file` in messages. Raises InputError if it is none."""
    try:
        if path.is_dir():
            raise InputError(f"{file}: {_about_folder(path, file)}")
        return text_of(read_bounded(path, LARGEST_SCENARIO_FILE), file)
    except FileNotFoundError:
        raise InputError(f"{file}: no such file, and no bundled scenario of that name; {_hint(path)}") from None
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {error.strerror}") from None
    except InputError as error:
        if str(error).startswith(f"{file}: "):
            raise
        raise InputError(f"{file}: {_about_first_bytes(path) or f'{error}: not a scenario'}") from None


def text_of(content: bytes, file: str) -> str:
    """Return the text in the content of a scenario file, called `file` in messages. Raises InputError if it is no text."""
    if len(content) > LARGEST_SCENARIO_FILE:
        raise InputError(f"{file}: larger than {LARGEST_SCENARIO_FILE} bytes: not a scenario")
    other = next((what for start, what in _STARTS if content.startswith(start)), None)
    if other:
        raise InputError(f"{file}: {other}")
    try:
        text = content.decode("utf-16" if content.startswith(_WIDE) else "utf-8-sig")
    except UnicodeDecodeError as error:
        if b"\0" in content:
            raise InputError(f"{file}: not a text file, so not a scenario; {_START}") from None
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{file}: not a text file in UTF-8: line {line} has other letters; save it as UTF-8") from None
    if "\0" in text:
        raise InputError(f"{file}: not a text file, so not a scenario; {_START}")
    if not text.strip():
        raise InputError(f"{file}: is empty; {_START}")
    return text


def _about_folder(path: Path, file: str) -> str:
    """Return what a folder is, and what to do with it."""
    if path.suffix == ".zarr" or (path / "zarr.json").exists():
        return f"a folder of results, not a scenario: `stickslip show {file}` summarises them"
    inside = sorted(one.name for one in path.glob("*.toml"))
    found = f"its scenarios: {', '.join(inside[:5])}{' ...' if len(inside) > 5 else ''}" if inside else "it holds no TOML file"
    return f"is a folder, not a scenario; {found if all(map(str.isprintable, inside)) else 'name a file in it'}"


def _about_first_bytes(path: Path) -> str | None:
    """Return what a file is that is too large for a scenario, if its first bytes tell."""
    if not path.is_file():
        return "not an ordinary file: not a scenario; the name - stands for standard input"
    with path.open("rb") as stream:
        start = stream.read(16)
    return next((what for begin, what in _STARTS if start.startswith(begin)), None)


def _hint(path: Path) -> str:
    if path.stem in library.STARTERS:
        return f"`stickslip new {path.stem} > {path.stem}.toml` writes one to start from"
    close = meant(path.stem, library.names())
    return did_you_mean(close) if close else library.NAMES_LISTED


def is_scenario_name(text: str) -> bool:
    """Return True for a text that is the name of a scenario, bundled or in TOML, where the name of another file is expected."""
    return text.endswith(".toml") or (text in (*library.STARTERS, *library.names()) and not Path(text).exists())


def about_suffix(file: str) -> str | None:
    """Return what a file of this name usually is, if it is a table and not TOML."""
    return _TABLE if Path(file).suffix.lower() in (".csv", ".tsv") else None


_PLACE = re.compile(r" \(at line (\d+), column \d+\)")
_FORM = 'write a number as 1.5 or 1e3, and a word or a number with a unit in quotes, as "1.5 s/m"'


def why_not_toml(text: str, fault: str) -> str:
    """Return why a text is not TOML: the line, and how values are written, or else what the parser says."""
    place, fault = _PLACE.search(fault), " ".join(fault.split())
    if place is None:
        ends = "end of document" in fault
        return f"not TOML: {fault}{'; a quotation mark or a bracket is not closed' if ends else ''}"
    lines, number = text.split("\n"), int(place[1])
    line = lines[number - 1].strip() if number <= len(lines) else ""
    _, equals, value = line.partition("=")
    is_value = equals and value and not line.startswith("[") and not fault.startswith("Cannot ")
    return f"line {number}: {shown(line)} is not TOML: {_FORM if is_value else _PLACE.sub('', fault)}"
