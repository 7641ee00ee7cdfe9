"""Log ASCII Standard files (.las) of versions 1.2 and 2.0: sections of parameters and curves, and columns of numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from stickslip.foundation.record_files import Asked, Lines, Sheet

_MOST_LINES = 20_000
"""The sections before the numbers have at most this many lines."""
_VERSIONS = ("1.2", "2.0")


class _LasEntry(NamedTuple):
    """A line of a section: its mnemonic, unit, value and description."""

    name: str
    unit: str
    value: str
    about: str

    @classmethod
    def of(cls, line: str) -> _LasEntry:
        """Read MNEM.UNIT VALUE : DESCRIPTION."""
        name, _, rest = line.partition(".")
        unit = "" if rest[:1].isspace() or rest[:1] in (":", "") else rest.split(None, 1)[0]
        rest = rest[len(unit) :]
        value, _, about = rest.rpartition(":") if ":" in rest else (rest, "", "")
        return cls(name.strip(), unit.strip("()[]"), value.strip(), about.strip().lstrip("0123456789 ").strip())


class _LasHead(NamedTuple):
    """The entries of the sections before the numbers, by letter of the section, and the number of the line ~A."""

    sections: dict[str, list[_LasEntry]]
    line: int

    def value(self, section: str, name: str) -> str:
        """Return the value of an entry, or nothing."""
        return next((one.value for one in self.sections.get(section, ()) if one.name.upper() == name), "")


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    return next((line.lstrip()[:2].upper() for line in first if line.strip() and not line.lstrip().startswith("#")), "") == "~V"


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the curves of a file, with units, and the mark of missing numbers that it names. Raises InputError."""
    head = _head(lines, asked)
    version = head.value("V", "VERS").split()[:1]
    if version and version[0].startswith("3"):
        way = "`las = lasio.read('FILE.las'); las.df().to_csv('FILE.csv')` (pip install lasio), with units in the headings then"
        raise asked.fault(head.line, f"LAS 3 is not read, LAS 2.0 is; to CSV in Python: {way}")
    curves = head.sections.get("C", [])
    if not curves:
        raise asked.fault(head.line, "a LAS file without a section ~C, which names its curves")
    asked.check_columns(len(curves), head.line, "curves")
    headings = [asked.best([curve.name, curve.about], curve.unit) for curve in curves]
    header = asked.header(headings, head.line, [[one.name for one in curves], [one.about for one in curves]])
    null = head.value("W", "NULL")
    wrapped = head.value("V", "WRAP").upper().startswith("Y")
    rows = _wrapped(lines, len(curves), asked) if wrapped else _rows(lines)
    missing = asked.number(null, head.line, "NULL") if null else None
    return Sheet(header, head.line, rows, [], missing, hint="; one row has one line where WRAP is NO")


def _head(lines: Lines, asked: Asked) -> _LasHead:
    """Read the sections up to the line ~A. Raises InputError if there is none."""
    sections: dict[str, list[_LasEntry]] = {}
    letter = ""
    for line in lines:
        text = line.strip()
        if text.startswith("~"):
            letter = text[1:2].upper()
            if letter == "A":
                return _LasHead(sections, lines.number)
        elif text and not text.startswith("#") and letter in ("V", "W", "C"):
            sections.setdefault(letter, []).append(_LasEntry.of(line))
        if lines.number > _MOST_LINES:
            break
    raise asked.fault(lines.number, "a LAS file without a section ~A, which holds its numbers")


def _rows(lines: Lines) -> Iterator[tuple[int, list[str]]]:
    for line in lines:
        if (text := line.strip()) and text[0] not in "#~":
            yield lines.number, text.split()


def _wrapped(lines: Lines, count: int, asked: Asked) -> Iterator[tuple[int, list[str]]]:
    """Yield rows that go on over several lines, each with the number of its first line. Raises InputError for half a row."""
    cells, begun = list[str](), 0
    for at, row in _rows(lines):
        begun = begun if cells else at
        cells += row
        if len(cells) >= count:
            if len(cells) > count:
                raise asked.fault(at, f"{len(cells)} numbers of a row that is wrapped, but there are {count} curves")
            yield begun, cells
            cells = []
    if cells:
        raise asked.fault(begun, f"{len(cells)} numbers of a row that is wrapped, but there are {count} curves")
