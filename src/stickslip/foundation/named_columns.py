"""Columns that the user names: "this heading of my file is the load point, in micron"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, nearest, warn
from stickslip.foundation.headings import LONGEST_HEADING, heading_of, plain, split_heading, trailing_unit, understood

MOST_SHOWN = 12
"""A message names at most this many headings."""


class NamedColumns:
    """Headings of a file by the columns they are, as {"load_point": "Vert_disp (micron)"}.

    What is given is a heading of the file, with or without its unit, or the number of a column, from 1 on; a unit in brackets
    behind it counts before that of the file. If `optional`, as where there are two files, a file may have none of them; `used` are
    the columns that some file had. Unless `shows`, no message repeats a heading of the file.
    """

    def __init__(self, given: Any, where: str = "columns", *, optional: bool = False, shows: bool = True) -> None:
        if not isinstance(given, Mapping) or not all(isinstance(name, str) for name in given):
            raise InputError(f'{where} must map columns to headings, as {{"load_point": "Vert_disp (micron)"}}, got {shown(given)}')
        for name, heading in given.items():
            if isinstance(heading, bool) or not isinstance(heading, str | int):
                raise InputError(f"{where}: {shown(name)} must be a heading or the number of a column, got {shown(heading)}")
        self.given = {name: str(heading).strip() for name, heading in given.items()}
        self.where, self.optional, self.shows = where, optional, shows
        self.used: set[str] = set()

    def among(self, cells: Sequence[str]) -> int:
        """Return how many of the headings that were given stand in a row of cells that may be a header."""
        return sum(
            len(self._places(text, cells, ())[0]) == 1 and not split_heading(text)[0].isdigit() for text in self.given.values()
        )

    def renamed(self, header: Sequence[str], wanted: Sequence[str], place: str, others: Sequence[Sequence[str]] = ()) -> list[str]:
        """Return a header with the columns' own names, and their units in brackets, in place of the headings that were given.

        `others` are further names for the columns of a file. Raises InputError for a heading that is not there.
        """
        found, taken = list(header), dict[int, str]()
        for name, text in self.given.items():
            places, unit = self._places(text, header, others)
            if not places and self.optional:
                continue
            at = self._only(name, text, places, header, place)
            if at in taken:
                raise InputError(f"{place}: {self.where}: {taken[at]} and {name} are both column {at + 1}")
            column, heading = self._column(name, unit, header[at], wanted, f"{place}, column {at + 1}")
            rivals = [i for i, cell in enumerate(found) if i not in taken and plain(split_heading(cell)[0]) == plain(column)]
            for i in rivals:
                found[i] = ""
            found[at], taken[at] = heading, name
            self.used.add(name)
        return found

    def check_used(self, headers: str) -> None:
        """Raise InputError unless each named column was in one of the files; `headers` names them."""
        for name in sorted(set(self.given) - self.used):
            raise InputError(f"{headers}: {self.where}: neither has a column {shown(self.given[name])} for {name}")

    def _column(self, name: str, unit: str | None, heading: str, wanted: Sequence[str], place: str) -> tuple[str, str]:
        """Return the column that a name means, and a heading for it. Raises InputError for a name that is not looked for."""
        own = split_heading(heading)[1]
        if unit is not None and own is not None and own != unit:
            warn(f"{place}: read in the unit that {self.where} gives, where the heading of the file has another one")
        unit = own if unit is None else unit
        column = understood(heading_of(name, unit), wanted)
        if column is None:
            raise InputError(f"{self.where}: {shown(name)} is no column that is looked for; {nearest(name, wanted)}")
        unit = trailing_unit(heading, column) if unit is None else unit
        return column, heading_of(column, unit)

    def _places(self, text: str, header: Sequence[str], others: Sequence[Sequence[str]]) -> tuple[list[int], str | None]:
        """Return the places of the columns that a text names, and the unit that is part of it, but not of the heading itself."""
        every = [[(i, cell.strip()) for i, cell in enumerate(cells) if cell.strip()] for cells in (header, *others)]
        for cells in every:
            if whole := [i for i, cell in cells if cell == text]:
                return whole, None
        name, unit = split_heading(text)
        for same in (str.strip, plain):
            for cells in every:
                short = [(i, cell) for i, cell in cells if len(cell) <= LONGEST_HEADING]
                if found := [i for i, cell in short if same(split_heading(cell)[0]) == same(name) != ""]:
                    return found, unit
        if name.isascii() and name.isdigit() and 1 <= int(name[:9]) <= len(header):
            return [int(name) - 1], unit
        return [], None

    def _only(self, name: str, text: str, places: Sequence[int], header: Sequence[str], place: str) -> int:
        """Return the one place. Raises InputError if there is none, or more than one."""
        if len(places) == 1:
            return places[0]
        if places:
            two = f"columns {places[0] + 1} and {places[1] + 1} are both called"
            raise InputError(f'{place}: {self.where}: {two} {shown(text)}: give the number, as {name}="{places[0] + 1}"')
        missing = f"{place}: {self.where}: there is no column {shown(text)} for {name}"
        named = [cell.strip() for cell in header if cell.strip()]
        if not self.shows:
            raise InputError(f"{missing} among the {len(header)}; its number does, too")
        holding = [one for one in named if plain(text) and plain(text) in plain(one)]
        close = nearest(holding[0] if holding else text, [one[:LONGEST_HEADING] for one in named], "")
        close = close if close.startswith("did") else ""
        more = f" and {len(named) - MOST_SHOWN} more" if len(named) > MOST_SHOWN else ""
        there = ", ".join(repr(one)[:60] for one in named[:MOST_SHOWN]) + more
        raise InputError(f"{missing}; {close}{' ' if close else ''}it has {there or 'no headings'}")
