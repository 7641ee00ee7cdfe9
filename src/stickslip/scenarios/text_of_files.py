"""The text of a scenario file; for a file that holds none, what it is instead and what to do with it."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.conversion import decimal_point
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.netcdf_file import MAGIC
from stickslip.scenarios import library

LARGEST_SCENARIO_FILE = 1_000_000
"""Size (bytes) of the largest scenario file that is read: scenarios are untrusted."""
_SHOW = "a file of results, not a scenario: `stickslip show` summarises it, and `stickslip run --resume` continues a run"
_TABLE = "a table, not a scenario: a scenario names it, as [friction] file, or `stickslip sweep --list` reads it"
_PICTURE = "a picture, not a scenario"
_STARTS = (
    (MAGIC, _SHOW),
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
    hint = nearest(path.stem, library.names())
    return hint if hint.startswith("did") else "`stickslip new --list` lists them"


def about_suffix(file: str) -> str | None:
    """Return what a file of this name usually is, if it is a table and not TOML."""
    return _TABLE if Path(file).suffix.lower() in (".csv", ".tsv") else None


LONGEST = 200
"""Longest line (characters) for which a cure is looked for: scenarios are untrusted, and patterns take time."""
_PLACE = re.compile(r"\(at line (\d+), column (\d+)\)")
_ENTRY = re.compile(r"""\s*(?P<key>[\w."'-]+)\s*(?P<sign>[=:])\s*(?P<value>.*)""")
_HEADING = re.compile(r"\s*\[+\s*(?P<name>[\w.\- ]+?)\s*\]*\s*")
_TWICE = re.compile(r"Cannot (overwrite|declare|mutate)")
_NUMBER = r"[+-]?[\d_]*\.?\d[\d_]*\.?(?:[eE][+-]?\d+)?"


def why_not_toml(text: str, fault: str) -> str:
    """Return why a text is not TOML, from the message of the parser: where, what is there, and the cure if it is known."""
    place, fault = _PLACE.search(fault), " ".join(fault.split())
    if place is None:
        ends = "end of document" in fault
        return f"not TOML: {fault}{'; a quotation mark or a bracket is not closed' if ends else ''}"
    line = _line(text, int(place[1]))
    cure = _cure(line, fault) if len(line) <= LONGEST and line.isprintable() else None
    return f"line {place[1]}: {shown(line.strip())} is not TOML: {cure}" if cure else f"not TOML: {fault}: {shown(line.strip())}"


def _line(text: str, number: int) -> str:
    lines = text.split("\n")
    return lines[number - 1].rstrip("\r").replace("\t", " ") if number <= len(lines) else ""


def _cure(line: str, fault: str) -> str | None:
    """Return how to write a line, or None if that is not known."""
    entry, heading = _ENTRY.fullmatch(line), _HEADING.fullmatch(line)
    if _TWICE.search(fault):
        return f"{shown(entry['key'])} is given twice" if entry else "this table is given twice"
    if line.lstrip().startswith("["):
        whole = heading is not None and line.strip() == f"[{heading['name']}]"
        if whole:
            return "a bracket or a quotation mark before it is not closed"
        return f"write [{heading['name']}]" if heading else None
    if entry is None:
        return "write KEY = VALUE, or # before a comment" if "=" not in line else None
    value = re.split(r"\s+#", entry["value"])[0].strip()
    if entry["sign"] == ":":
        is_whole = re.fullmatch(rf"{_NUMBER}|\"[^\"]*\"", value)
        return f"write {entry['key']} = {value}" if is_whole else "write KEY = VALUE, or # before a comment"
    if not value:
        return f"{entry['key']} has no value"
    written = _written(value)
    return f"write {entry['key']} = {written}" if written else None


def _written(value: str) -> str | None:
    """Return a value as TOML has it, with the reason, or None if it is not known what was meant."""
    if any(mark in value for mark in "\u201c\u201d\u201e\u2018\u2019"):
        straight = re.sub("[\u201c\u201d\u201e\u2018\u2019]", '"', value)
        return f"{straight}, with straight quotes"
    point = decimal_point(value)
    plain = value.strip("=;, ")
    if plain != value and re.fullmatch(_NUMBER, plain):
        return f"{plain}, and no other sign"
    if re.fullmatch(rf"{_NUMBER}(?:\s*(?:[*^/+-]|\*\*)\s*{_NUMBER})+", value):
        return "the number itself, as 1e3: nothing is calculated"
    if point:
        quoted = f'"{point}"' if re.search(r"[A-Za-z/%]", re.sub(r"[eE][+-]?\d", "", point)) else point
        return f"{quoted}, with a decimal point"
    if value.count('"') % 2:
        whole = value.replace('"', "").strip()
        return f'"{whole}", with both quotes'
    return _by_form(value)


def _by_form(value: str) -> str | None:
    if re.fullmatch(r"[+-]?\.\d[\d_]*(?:[eE][+-]?\d+)?", value):
        return f"{value.replace('.', '0.', 1)}, with a digit before the point"
    if re.fullmatch(r"[+-]?\d[\d_]*\.(?:[eE][+-]?\d+)?", value):
        return f"{value.replace('.', '.0', 1)}, with a digit after the point"
    if re.fullmatch(r"(?i:true|false|nan|[+-]?inf)", value):
        return f"{value.lower()}, in small letters"
    grouped = re.sub(r"(?<=\d)[ '\u00a0\u202f](?=\d{3})", "", value)
    if grouped != value and re.fullmatch(_NUMBER, grouped):
        return f"{grouped}, without gaps"
    if re.fullmatch(r"[+-]?0[\d_]+(?:\.\d+)?", value):
        shorter = re.sub(r"^([+-]?)0+(?=[0-9])", r"\1", value)
        return f"{shorter}, without the first 0"
    if re.fullmatch(rf"{_NUMBER}\s*[A-Za-z/%\u00b5\u03bc][^\"']*", value) or re.fullmatch(r"[A-Za-z][\w ./^-]*", value):
        return f'"{value}", in quotes'
    return None
