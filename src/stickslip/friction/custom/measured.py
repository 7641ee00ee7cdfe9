"""Hold measured points of friction, and read them from files, tables and arrays."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arguments import CheckedArguments, as_path, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.columns import Table, read_mapping
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.headings import COLUMNS, missing
from stickslip.foundation.text_columns import read_file, read_text
from stickslip.friction.piecewise import PiecewiseLaw, note_percent

Along = Literal["slip", "slip_rate"]
"""The two variables on which friction can depend, as columns of files are called."""

LARGEST_FILE = 100_000_000
"""Size (bytes) of the largest file of points that is read."""
MOST_POINTS = 1_000_000
"""Largest number of measured points; a fit to that many takes minutes."""
ALONG: tuple[Along, ...] = ("slip", "slip_rate")
STRESSES = ("shear_stress", "normal_stress")
"""Columns whose ratio is friction, where no column holds friction itself."""
WANTED = (*ALONG, "friction", *STRESSES)
"""The columns that are looked for."""


@dataclass(frozen=True, eq=False)
class Points(CheckedArguments):
    """Measured friction coefficients (no unit), with the slip (m) or the slip rate (m/s, not negative) of each point, or both.

    Make one with `Points.read`. Points may be in any order and may repeat a slip or a slip rate. `name` is for messages and
    figures.
    """

    friction: Floats
    slip: Floats | None = None
    slip_rate: Floats | None = None
    name: str = "points"

    @classmethod
    def read(cls, source: Any) -> Points:
        """Read points from a CSV file, or from columns of numbers by their headings, in the order of the source.

        The columns are `friction` with `slip`, `slip_rate` or both. `shear_stress` and `normal_stress` may take the place of
        friction. A heading may carry a unit, as in "v (mm/s)"; without one numbers are in SI. `u`, `v`, `mu`, `tau`, `sigma` and
        some full names are understood, and other columns are ignored. Notes before the headings are skipped. Points, and a law
        given by points, are taken as they are. Raises InputError if the file or the columns cannot be used; the message is one line
        with the place and the cure.
        """
        if isinstance(source, Points):
            return source
        table = _table_in(source)
        columns = table.columns
        note_percent(columns["friction"], table.place)
        return cls(columns["friction"], columns.get("slip"), columns.get("slip_rate"), table.place)

    @property
    def has(self) -> tuple[Along, ...]:
        """The variables that are given: slip, slip_rate or both."""
        return tuple(name for name in ALONG if getattr(self, name) is not None)

    def along(self, variable: str | None = None) -> Points:
        """Return the points along "slip" or "slip_rate" alone; leave the variable out if they have only one.

        Raises InputError if the points do not have this variable, or have both and none is named.
        """
        if variable is None and len(self.has) == 1:
            return self
        if variable is None:
            raise InputError(f"{self.name}: the points have slip and slip_rate: choose one with along")
        if variable not in self.has:
            hint = nearest(str(variable), self.has)
            raise InputError(f"{self.name}: the points have no {ascii(variable)[:40]}; {hint}")
        return replace(self, slip=None) if variable == "slip_rate" else replace(self, slip_rate=None)

    @property
    def places(self) -> Floats:
        """The slips (m) or the slip rates (m/s) of points that have one of the two, shape (n,)."""
        (variable,) = self.along().has
        return np.asarray(self.slip if variable == "slip" else self.slip_rate)

    @property
    def variables(self) -> tuple[Floats, Floats]:
        """The slips (m) and the slip rates (m/s) of all points, zeros where they are not given."""
        zeros = np.zeros(len(self))
        return (zeros if self.slip is None else self.slip), (zeros if self.slip_rate is None else self.slip_rate)

    def __len__(self) -> int:
        return len(self.friction)

    def __repr__(self) -> str:
        ranges = [f"{name} {np.min(x):.3g} to {np.max(x):.3g} {COLUMNS[name].unit}" for name, x in self._columns().items()]
        return f"Points({len(self)} points, {', '.join(ranges)})"

    def _columns(self) -> dict[str, Floats]:
        named: dict[str, ArrayLike | None] = {"slip": self.slip, "slip_rate": self.slip_rate}
        return {name: np.asarray(x) for name, x in named.items() if x is not None} | {"friction": self.friction}


def read_table(source: Any, along: str | None = None) -> tuple[Along, Floats, Floats]:
    """Return points that are to be joined exactly: the variable, its ascending values and the friction coefficients.

    `along` names the variable where the source has both. Raises InputError as `Points.read` does, for points with slip and slip
    rate, and for those that do not ascend.
    """
    if isinstance(source, Points):
        points = source.along(along)
        columns = {points.has[0]: points.places, "friction": points.friction}
        table = Table(columns, points.name, np.arange(len(points)), "point")
    else:
        table = _table_in(source)
    return _joined(table, along)


def table_in_text(text: str, name: str) -> tuple[Along, Floats, Floats]:
    """Return the points in the text of a CSV file, called `name` in messages, as `read_table` does."""
    return _joined(_from_text(text, name))


def _joined(table: Table, along: str | None = None) -> tuple[Along, Floats, Floats]:
    found = [name for name in ALONG if name in table.columns and along in (None, name)]
    if along is not None and not found:
        hint = nearest(str(along), [name for name in ALONG if name in table.columns])
        raise InputError(f"{table.place}: the points have no {shown(along)} to go along; {hint}")
    if len(found) != 1:
        raise InputError(f'{table.place}: slip and slip_rate are both there: choose one with along="slip" or along="slip_rate"')
    table.check_ascending(found[0])
    return found[0], table.columns[found[0]], table.columns["friction"]


def _table_in(source: Any) -> Table:
    """Return the columns of a source, which has friction and at least one variable. Raises InputError."""
    if isinstance(source, PiecewiseLaw):
        places, friction = source.points
        source = {"slip_rate" if source.knot_variable == "rate" else "slip": places, "friction": friction}
    if isinstance(source, Mapping) or hasattr(source, "columns"):
        return _complete(read_mapping(source, WANTED, "points"))
    if not isinstance(source, str | os.PathLike):
        wanted = "a CSV file, a DataFrame, or a mapping of headings to numbers"
        raise InputError(f"points must be {wanted}, got {shown(source)}")
    return _from_file(as_path("points", source))


def _from_file(path: Path) -> Table:
    return _complete(read_file(path, WANTED, (LARGEST_FILE, MOST_POINTS)))


def _from_text(text: str, name: str) -> Table:
    return _complete(read_text(text, WANTED, name, MOST_POINTS))


def _complete(table: Table) -> Table:
    """Return a table if it has all that points need. Raises InputError if not."""
    found, header, place = table.columns, table.header, table.at_header
    shear, normal = (found.pop(name, None) for name in STRESSES)
    if "friction" not in found and shear is not None and normal is not None:
        found["friction"] = _ratio(shear, normal, table)
    if "friction" not in found:
        raise InputError(f"{place}: no column 'friction'; {missing(header, 'friction')}")
    if not set(ALONG) & set(found):
        raise InputError(f"{place}: no column slip or slip_rate; {missing(header, 'slip_rate')}")
    if len(found["friction"]) < 2:
        raise InputError(f"{table.place}: at least two points are needed, got {len(found['friction'])}")
    for numbers in found.values():
        numbers.flags.writeable = False
    return table


def _ratio(shear: Floats, normal: Floats, table: Table) -> Floats:
    """Return friction from shear and normal stress. Raises InputError for a shear stress below 0 and a normal stress that is 0."""
    for i in np.flatnonzero((normal == 0.0) | (shear < 0.0))[:1].tolist():
        what = "normal_stress must be above 0" if normal[i] == 0.0 else "shear_stress must not be negative"
        raise InputError(f"{table.at(i)}: {what}, got {(normal if normal[i] == 0.0 else shear)[i]:g}")
    return np.asarray(shear / normal)
