"""LabVIEW measurement files (.lvm), as LabVIEW writes them: a header, and segments with headers of their own."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from datetime import datetime
from typing import NamedTuple

from stickslip.foundation.record_files import Asked, Lines, Sheet

MAGIC = "LabVIEW Measurement"
"""How such a file begins."""
END = "***End_of_Header***"
SPECIAL, END_SPECIAL = "***Start_Special***", "***End_Special***"
_ENTRIES = frozenset(
    (
        *("Channels", "Samples", "Date", "Time", "Y_Unit_Label", "Y_Dimension", "X_Unit_Label", "X_Dimension", "X0", "Delta_X"),
        *("Test_Name", "Test_Numbers", "Test_Series", "UUT_Name", "UUT_M/N", "UUT_S/N", "Notes", "Description", "X_Value", MAGIC),
    )
)
"""First cells of lines that belong to the header of a segment."""
_ENDS = re.compile(r"[\t,]")
_MOST_LINES = 500
"""A header has at most this many lines."""


class _Form(NamedTuple):
    """How a file writes its rows: the separator of cells, the decimal separator, and the columns of X: no, one or multi."""

    separator: str
    decimal: str
    x_columns: str

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line."""
        return [cell.strip() for cell in line.split(self.separator)]

    def completed(self, segment: _Segment, row: str) -> _Form:
        """Return the form with what the header of the file does not say, from that of the first segment, and its first row."""
        comma = any("," in cell for key in ("X0", "Delta_X") for cell in segment.listed(key))
        own = "multi" if segment.names.count("X_Value") > 1 else "one" if self.cells(row)[0] else "no"
        return self._replace(
            decimal=self.decimal or ("," if comma and self.separator != "," else "."),
            x_columns=self.x_columns if self.x_columns in ("no", "one", "multi") else own,
        )

    def channels(self, segment: _Segment) -> list[str]:
        """Return the names of the channels of a segment."""
        names = list(segment.names[1:])
        while names and names[-1] in ("", "Comment"):
            names.pop()
        return names[::2] if self.x_columns == "multi" else names

    def of_channels(self, segment: _Segment, key: str) -> list[str]:
        """Return the cells of an entry, one for each channel that it has: with columns of X they stand above those of channels."""
        cells = segment.entries.get(key, [])
        return _trimmed(cells[::2] if self.x_columns == "multi" else cells)

    def row(self, cells: list[str], count: int, asked: Asked, line: int) -> tuple[str, list[str], bool]:
        """Return X, the cells of the channels, and whether there is a comment, of a row. Raises InputError for several X."""
        width = 2 * count if self.x_columns == "multi" else count + 1
        numbers = [self.number(cell) for cell in cells[:width]]
        if self.x_columns != "multi":
            return numbers[0], numbers[1:], any(cells[width:])
        own = {as_number(x) for x in numbers[::2] if x}
        if len(own) > 1:
            raise asked.fault(line, "the channels have clocks of their own: let LabVIEW write one X column, or a file for each")
        return next((x for x in numbers[::2] if x), ""), numbers[1::2], any(cells[width:])

    def number(self, text: str) -> str:
        """Return a number with a decimal point."""
        return text.replace(self.decimal, ".") if self.decimal != "." else text


def _trimmed(cells: Sequence[str]) -> list[str]:
    """Return cells without empty ones at the end."""
    found = list(cells)
    while found and not found[-1]:
        found.pop()
    return found


class _Segment(NamedTuple):
    """The header of a segment: the line on which it ends, entries by their names, and the line of names of columns."""

    line: int
    entries: dict[str, list[str]]
    names: list[str]

    def listed(self, key: str) -> list[str]:
        """Return the cells of an entry, without empty ones at the end."""
        return _trimmed(self.entries.get(key, ()))

    @property
    def begun(self) -> datetime | None:
        """The time of day when the segment begins, if its header says so."""
        date, time = ((self.listed(key) or [""])[0] for key in ("Date", "Time"))
        whole, _, rest = time.replace(",", ".").partition(".")
        try:
            return datetime.strptime(f"{date.replace('-', '/')} {whole}.{rest[:6] or '0'}", "%Y/%m/%d %H:%M:%S.%f")
        except ValueError:
            return None


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    return bool(first) and first[0].startswith(MAGIC)


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the channels of a file, with their times. Raises InputError.

    Times are X_Value, or follow from X0 and Delta_X where X_Columns is No. The comments of rows are passed over. Segments go on
    where the one before ended, or later by their dates and times.
    """
    form = _form(lines, asked)
    segment = _next_segment(lines, form, asked, "")
    if segment is None:
        raise asked.fault(lines.number, "a LabVIEW file without data: no line begins with X_Value")
    form = form.completed(segment, lines.peek())
    channels, labels, over = form.channels(segment), form.of_channels(segment, "Y_Unit_Label"), segment.listed("X_Dimension")
    headings = [asked.best([name], labels[i] if i < len(labels) else "") for i, name in enumerate(channels)]
    x = f"time ({(segment.listed('X_Unit_Label') or ['s'])[0]})" if over[:1] in ([], ["Time"]) else "X_Value"
    header = asked.header([x, *headings], segment.line, [["X_Value", *channels]])
    notes = list[str]()
    return Sheet(header, segment.line, _rows(lines, form, segment, asked, notes), notes)


def _form(lines: Lines, asked: Asked) -> _Form:
    """Return how the file writes its rows, from its header. Raises InputError."""
    found: dict[str, str] = {}
    for line in lines:
        key = _ENDS.split(line, 1)[0].strip()
        if key == END:
            break
        found[key] = line[len(key) + 1 :].strip()
        if lines.number > _MOST_LINES:
            raise asked.fault(lines.number, f"the header of a LabVIEW file does not end: there is no {END}")
    else:
        raise asked.fault(lines.number, f"the header of a LabVIEW file does not end: there is no {END}")
    separator = "," if found.get("Separator", "").casefold().startswith("comma") else "\t"
    decimal = found.get("Decimal_Separator", "")[:1]
    if separator == decimal:
        raise asked.fault(lines.number, "commas separate both columns and decimals: let LabVIEW separate columns by tabs")
    return _Form(separator, decimal, found.get("X_Columns", "").split("\t")[0].strip(" ,").casefold())


def _next_segment(lines: Lines, form: _Form, asked: Asked, line: str) -> _Segment | None:
    """Return the next header of a segment, which may begin with a line that was read already; None at the end of the file."""
    entries: dict[str, list[str]] = {}
    following: str | None = line
    while following is not None:
        cells = form.cells(following)
        if cells[0] == SPECIAL:
            _pass_special(lines)
        elif cells[0] == "X_Value":
            return _Segment(lines.number, entries, cells)
        elif cells[0]:
            entries[cells[0]] = cells[1:]
        if len(entries) > _MOST_LINES:
            raise asked.fault(lines.number, "the header of a segment does not end: no line begins with X_Value")
        following = next(lines, None)
    return None


def _pass_special(lines: Lines) -> None:
    """Read over a block of something other than measured numbers."""
    for line in lines:
        if line.startswith(END_SPECIAL):
            return


class _Clock:
    """The times of segments: each goes on behind the one before it, by its numbers or by its date and time."""

    def __init__(self, asked: Asked, first: _Segment) -> None:
        self.asked, self.first, self.segment = asked, first, first
        self.last, self.later, self.count, self.is_new = -math.inf, 0.0, 0, True

    def begin(self, segment: _Segment) -> None:
        """Begin a segment."""
        self.segment, self.is_new = segment, True
        self.count += 1

    def time(self, x: float, line: int) -> float:
        """Return the time of a row from its X_Value. Raises InputError for one before that of the row above."""
        if self.is_new:
            begun, first = self.segment.begun, self.first.begun
            self.later = (begun - first).total_seconds() if x <= self.last and begun and first else 0.0
            if x + self.later <= self.last:
                why = f"a segment begins again at {x:g} s, and by date and time not behind the one above"
                raise self.asked.fault(line, f"{why}: write each segment to a file of its own")
            self.is_new = False
        found = x + self.later
        if found < self.last:
            cure = "let LabVIEW write a header for each segment (Multi_Headings Yes), or each to a file of its own"
            raise self.asked.fault(line, f"X_Value begins again at {x:g} s within a segment: {cure}")
        self.last = found
        return found


def _rows(lines: Lines, form: _Form, segment: _Segment, asked: Asked, notes: list[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows of all segments: the time, and a cell for each channel. Raises InputError."""
    channels, clock, said = form.channels(segment), _Clock(asked, segment), list[int]()
    following: _Segment | None = segment
    while following is not None:
        if form.channels(following) != channels:
            raise asked.fault(following.line, "this segment has other channels: write each segment to a file of its own")
        clock.begin(following)
        begin, step = _steps(form, following, asked)
        declared = max(map(as_number, following.listed("Samples")), default=0.0)
        line, i = next(lines, None), 0
        while line is not None and (cells := form.cells(line))[0] not in _ENTRIES:
            if cells[0] == SPECIAL:
                _pass_special(lines)
            elif any(cells) or (form.x_columns == "no" and len(cells) > len(channels) and i < declared):
                if form.x_columns == "no" and cells[0]:
                    raise asked.fault(lines.number, "a row must begin with an empty cell where X_Columns is No")
                x, values, comment = form.row(cells, len(channels), asked, lines.number)
                said += [lines.number] if comment else []
                at = begin + i * step if form.x_columns == "no" else as_number(x)
                yield lines.number, [x if math.isnan(at) else repr(clock.time(at, lines.number)), *values]
                i += 1
            line = next(lines, None)
        following = None if line is None else _next_segment(lines, form, asked, line)
    if said:
        notes.append(f"{_comments(said)}: passed over")
    if clock.count > 1:
        notes.append(f"{clock.count} segments, each behind the one before it by the times in the file")


def _comments(lines: Sequence[int]) -> str:
    return f"{len(lines)} comments in the file, the first in line {lines[0]}" if len(lines) > 1 else f"a comment in line {lines[0]}"


def as_number(text: str) -> float:
    """Return a number, or NaN."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def _steps(form: _Form, segment: _Segment, asked: Asked) -> tuple[float, float]:
    """Return the time of the first row of a segment without columns of X, and the time between rows. Raises InputError."""
    if form.x_columns != "no":
        return 0.0, 0.0
    found, samples = list[float](), segment.listed("Samples")
    for key, default in (("X0", "0"), ("Delta_X", "")):
        cells = segment.listed(key) or [default]
        filled = [cell for i, cell in enumerate(cells) if i >= len(samples) or samples[i] != "0"]  # others have no row
        values = {asked.number(form.number(cell), segment.line, key) for cell in filled or cells}
        if len(values) > 1:
            raise asked.fault(segment.line, f"channels with different {key}: write each to a file of its own")
        found += values
    begin, step = found
    if not (math.isfinite(begin) and math.isfinite(step) and step > 0.0):
        raise asked.fault(segment.line, "X0 must be a number, and Delta_X above 0, where X_Columns is No")
    return begin, step
