"""Universal files (.uff, .unv) with datasets 58 as text: functions of time, each a column."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

from stickslip.foundation.record_files import Asked, Lines, Sheet

MOST_NUMBERS = 50_000_000
"""Read at most this many numbers from a file: they are kept until all functions are there."""
_EDGE = "-1"
"""The line before and behind each dataset."""
CODE_OF_TIME = 17
"""The code of time among the types of abscissas."""
_KINDS = {2: (13, 13), 4: (13, 20), 5: (13, 13), 6: (13, 20)}
"""Widths of an uneven abscissa and of an ordinate by the type of ordinates: real or complex, single or double."""
_COMPLEX = (5, 6)
_SYSTEMS = {1: ("m", "N"), 2: ("ft", "lbf"), 3: ("m", "kgf"), 5: ("mm", "mN"), 6: ("cm", "cN"), 7: ("in", "lbf"), 10: ("mm", "N")}
"""Units of length and force by the code in dataset 164."""
_OF_KIND = {8: "{0}", 9: "{1}", 11: "{0}/s", 12: "{0}/s^2", 13: "{1}"}
"""Units of the types of ordinates (displacement, reaction force, velocity, acceleration, excitation force), if none is named."""
_SECONDS = ("", "s", "sec", "second", "seconds")
_NOTHING = ("", "none", "no label", "unknown")


@dataclass
class _Function:
    """A dataset 58: names of the measured quantity, its unit, the numbers, and their times: first and step, or one for each."""

    names: list[str]
    unit: str
    clock: str
    line: int
    begin: float = 0.0
    step: float = 0.0
    times: array[float] | None = None
    values: array[float] = field(default_factory=lambda: array("d"))

    @property
    def count(self) -> int:
        """The number of samples."""
        return len(self.values)

    def at(self, i: int) -> float:
        """Return the time of a sample."""
        return self.begin + i * self.step if self.times is None else self.times[i]

    def fits(self, other: _Function) -> bool:
        """Return True if both have the same times."""
        own = (self.count, self.begin, self.step, self.clock, self.times)
        return own == (other.count, other.begin, other.step, other.clock, other.times)


def begins(first: Sequence[str]) -> bool:
    """Return True for the first lines of such a file."""
    said = [line.strip() for line in first if line.strip()]
    kind = next((line for line in said if line != _EDGE), "")
    return said[:1] == [_EDGE] and re.fullmatch(r"\d{1,6}|58b\s.*", kind) is not None


def sheet(lines: Lines, asked: Asked) -> Sheet:
    """Return the functions of time in a file, which must have the same times. Raises InputError."""
    functions, system, others = list[_Function](), None, 0
    for kind in _datasets(lines, asked):
        if sum(one.count for one in functions) > MOST_NUMBERS:
            raise asked.fault(lines.number, f"more than {MOST_NUMBERS} numbers: write fewer functions to a file")
        if kind == "58":
            found = _function(lines, asked)
            functions += [] if found is None else [found]
            others += found is None
        elif kind == "164":
            system = _system(lines, asked)
    if not functions:
        raise asked.fault(lines.number, "no dataset 58 with a real function of time")
    asked.check_columns(len(functions) + 1, lines.number, "functions")
    first = functions[0]
    for other in functions[1:]:
        if not first.fits(other):
            raise asked.fault(other.line, "this function has other times than the first: write it to a file of its own")
    headings = [asked.best(one.names, _with_system(one.unit, system)) for one in functions]
    names = [["", *(one.names[k] for one in functions)] for k in range(len(first.names))]
    header = asked.header([f"time ({first.clock})", *headings], first.line, names)
    notes = [f"{others} dataset{'s' * (others > 1)} 58 not a real function of time: passed over"] if others else []
    rows = ((i + 1, [repr(first.at(i)), *(repr(one.values[i]) for one in functions)]) for i in range(first.count))
    return Sheet(header, first.line, rows, notes, counted="sample")


def _datasets(lines: Lines, asked: Asked) -> Iterator[str]:
    """Yield the kind of each dataset, whose lines may then be read, and pass over the rest of it. Raises InputError for binary."""
    for line in lines:
        if line.strip() != _EDGE:
            continue
        kind = next((one for one in lines if one.strip() != _EDGE), "").strip()
        if kind.casefold().startswith("58b"):
            way = "`pyuff.UFF('FILE.uff').read_sets()` (pip install pyuff) gives x and data of each"
            raise asked.fault(lines.number, f"dataset 58b is binary and not read, dataset 58 is; in Python {way}")
        yield kind
        for rest in lines:
            if rest.strip() == _EDGE:
                break


def _function(lines: Lines, asked: Asked) -> _Function | None:
    """Read a dataset 58 behind its number; None if it is not a real function of time. Raises InputError."""
    head = list(islice(lines, 11))
    if len(head) < 11:
        raise asked.fault(lines.number, "a dataset 58 that ends within its header")
    begun = lines.number - 10
    kind, count, even = (asked.whole(head[6][k : k + 10].strip() or "0", begun + 6, "a field of its record 7") for k in (0, 10, 20))
    over, kept = (asked.whole(head[k][:10].strip() or "0", begun + k, "the type of an axis") for k in (7, 8))
    if kind not in _KINDS:
        raise asked.fault(begun + 6, "the type of ordinates must be 2, 4, 5 or 6")
    if kind in _COMPLEX or over != CODE_OF_TIME:
        return None
    if count > asked.most:
        raise asked.fault(begun + 6, f"more than {asked.most} rows")
    node = f"{head[5][41:51].strip()}{head[5][51:55].strip()}"
    names = [_said(head[0]), _said(head[8][25:46]), _said(f"{head[5][30:41].strip()} {node}")]
    unit, clock = _said(head[8][46:]) or _OF_KIND.get(kept, ""), _said(head[7][46:])
    clock = "s" if clock.casefold() in _SECONDS else clock
    found = _Function(names, unit, clock, begun)
    if even:
        found.begin, found.step = (asked.number(head[6][k : k + 13], begun + 6, "the abscissa") for k in (30, 43))
        _read(lines, [found.values], count, _KINDS[kind][1:], asked)
    else:
        found.times = array("d")
        _read(lines, [found.times, found.values], count, _KINDS[kind], asked)
    return found


def _said(text: str) -> str:
    """Return a text of a header, or nothing where it says none."""
    text = text.strip()
    return "" if text.casefold() in _NOTHING else text


def _read(lines: Lines, into: Sequence[array[float]], count: int, widths: Sequence[int], asked: Asked) -> None:
    """Read numbers to arrays in turn, until each has `count` of them. Raises InputError."""
    turn, left = 0, count * len(into)
    while left:
        line = next(lines, _EDGE)
        if line.strip() == _EDGE:
            raise asked.fault(lines.number, f"a dataset 58 that ends {left} numbers too early")
        for text in _numbers(line, widths)[:left]:
            into[turn].append(asked.number(text, lines.number, "each value"))
            turn = (turn + 1) % len(into)
            left -= 1


def _numbers(line: str, widths: Sequence[int]) -> list[str]:
    """Return the numbers of a line, which may touch each other: then each has the width of its field."""
    cells = line.split()
    if all(_is_one(cell) for cell in cells):
        return cells
    found, at, turn = [], 0, 0
    while line[at:].strip():
        found.append(line[at : at + widths[turn % len(widths)]])
        at += widths[turn % len(widths)]
        turn += 1
    return found


def _is_one(cell: str) -> bool:
    try:
        float(cell.replace("D", "E"))
    except ValueError:
        return False
    return True


def _system(lines: Lines, asked: Asked) -> tuple[str, str] | None:
    """Return the units of length and force of a dataset 164, if they are known."""
    line = next(lines, "")
    return _SYSTEMS.get(asked.whole(line[:10], lines.number, "the code of the units"))


def _with_system(unit: str, system: tuple[str, str] | None) -> str:
    """Return a unit with the system's length and force in place of {0} and {1}, or nothing if they are not known."""
    return unit if "{" not in unit else "" if system is None else unit.format(*system)
