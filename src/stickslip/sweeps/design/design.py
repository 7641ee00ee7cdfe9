"""The members of a sweep: every combination of the values of its axes (a grid), random samples between ends, or a list."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError, nearest
from stickslip.scenarios.scenario import Scenario
from stickslip.sweeps.design.axis import LARGEST_AXIS, Axis, Values, axis_of, read_axis, read_values
from stickslip.sweeps.design.parameter_paths import Key, key_named

if TYPE_CHECKING:
    import pandas as pd

KINDS = ("grid", "random", "lhs")
"""Designs made from axes: every combination, independent random samples, or a Latin hypercube."""
LARGEST_TABLE = 1_000_000_000
"""Largest size (bytes) of a CSV file of members; a larger one is refused before it fills the memory."""
LARGEST_GRID = 1_000_000_000
"""Largest number of members of a grid: 8 GB for each quantity that is kept."""
MEMBER = "member"
"""Name of the single dimension of samples and lists."""


@dataclass(frozen=True, eq=False)
class Design:
    """The members of a sweep, in their order: the last axis of a grid varies fastest.

    `columns` holds one array for each key (SI, or words). For a grid it contains the values of the axis, for samples and lists
    one value for each member.
    """

    kind: str
    keys: tuple[Key, ...]
    columns: tuple[Values, ...]
    seed: int | None = None
    logs: frozenset[str] = frozenset()
    """Names of the keys whose values are spaced evenly in the logarithm."""

    @property
    def is_grid(self) -> bool:
        """Return True if every combination of the values in the columns is a member."""
        return self.kind == "grid"

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the number of members along each dimension."""
        return tuple(len(column) for column in (self.columns if self.is_grid else self.columns[:1]))

    @property
    def dims(self) -> tuple[str, ...]:
        """Return the names of the dimensions: the keys of a grid, otherwise `member`."""
        return tuple(key.name for key in self.keys) if self.is_grid else (MEMBER,)

    @property
    def size(self) -> int:
        """Return the number of members."""
        return math.prod(self.shape)

    def values(self, members: slice | NDArray[np.intp]) -> dict[str, Values]:
        """Return the values of these members for each key, as one-dimensional arrays in SI."""
        numbers = np.arange(*members.indices(self.size)) if isinstance(members, slice) else np.asarray(members)
        if not self.is_grid:
            return {key.name: column[numbers] for key, column in zip(self.keys, self.columns, strict=True)}
        places = np.unravel_index(numbers, self.shape)
        return {key.name: column[place] for key, column, place in zip(self.keys, self.columns, places, strict=True)}

    def __str__(self) -> str:
        if self.is_grid:
            return f"{' x '.join(str(one) for one in self.shape)} = {self.size} members"
        names = {
            "random": "drawn at random",
            "lhs": "drawn as a Latin hypercube",
            "list": "from a list",
            "refined": "of a refined map",
        }
        return f"{self.size} members {names[self.kind]}"


Vary = str | Sequence[str] | Mapping[str, Any]
"""Axes: texts "KEY=LOW..HIGH:POINTS", or a mapping from keys to the text after the "=" or to lists of values."""


def read_design(
    scenario: Scenario, vary: Any, kind: str = "grid", members: int | None = None, seed: int = 0, where: str = "sweep: vary"
) -> Design:
    """Return the design that `vary` describes: axes (`Vary`), a DataFrame or CSV file (`Path`) of members, or a finished design.

    Raises InputError. A message on the axes or the table begins with `where`.
    """
    if isinstance(vary, Design):
        return vary
    if isinstance(vary, Path) or hasattr(vary, "columns"):
        return listed(scenario, read_csv(vary, where) if isinstance(vary, Path) else vary, where)
    axes = axes_of(scenario, vary, where)
    if kind not in KINDS:
        raise InputError(f"sweep: design '{kind}' is unknown; {nearest(kind, KINDS)}")
    if kind == "grid":
        if members is not None:
            raise InputError("sweep: members belongs to the designs random and lhs: a grid has every combination of its axes")
        return grid(axes, where)
    return sampled(axes, kind, members, seed, where)


def axes_of(scenario: Scenario, vary: Vary, where: str) -> list[Axis]:
    """Return the axes that `vary` describes. Raises InputError, whose message begins with `where`."""
    if isinstance(vary, Mapping):
        axes = [axis_of(scenario, str(name), content, where) for name, content in vary.items()]
    else:
        axes = [read_axis(scenario, text, where) for text in ([vary] if isinstance(vary, str) else vary)]
    if not axes:
        raise InputError(f"{where} is missing: name at least one parameter to vary")
    _check_keys([axis.key for axis in axes], where)
    return axes


def _check_keys(keys: Sequence[Key], where: str) -> None:
    names = [key.name for key in keys]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{where}: {name} is varied twice")
    if {"initial.load", "initial.excess"} <= set(names):
        raise InputError(f"{where}: initial.load and initial.excess exclude each other")


def grid(axes: Iterable[Axis], where: str) -> Design:
    """Return the design of every combination of the axes.

    Raises InputError for an axis without points or with a repeated value, and for more than LARGEST_GRID members.
    """
    axes = list(axes)
    for axis in axes:
        if len(axis.values) == 0:
            raise InputError(f"{where}: {axis.key.name} needs a number of points: LOW..HIGH:POINTS")
        ordered = np.sort(axis.values)
        twice = np.flatnonzero(ordered[1:] == ordered[:-1])
        if twice.size:
            raise InputError(f"{where}: {axis.key.name} has the value {ordered[twice[0]]} twice")
    keys, columns = tuple(axis.key for axis in axes), tuple(axis.values for axis in axes)
    found = Design("grid", keys, columns, logs=_logs(axes))
    if found.size > LARGEST_GRID:
        raise InputError(f"{where}: a grid has at most {LARGEST_GRID:.0e} members, got {found.size:.3g}")
    return found


def _logs(axes: Iterable[Axis]) -> frozenset[str]:
    return frozenset(axis.key.name for axis in axes if axis.log)


def sampled(axes: Sequence[Axis], kind: str, members: int | None, seed: int, where: str) -> Design:
    """Return a design of the given number of members, drawn between the ends of the axes.

    `kind` "random" draws members independently. "lhs" is a Latin hypercube: every axis is divided into as many equal intervals as
    there are members, with one member in each (McKay, Beckman & Conover 1979, Technometrics 21, 239). Raises InputError.
    """
    if members is None or not (isinstance(members, int) and members > 0):
        raise InputError(f"sweep: members must be a whole number above 0 for the design {kind}, got {members!r}")
    if not (isinstance(seed, int) and seed >= 0):
        raise InputError(f"sweep: seed must be a whole number, 0 or above, got {seed!r}")
    for axis in axes:
        if axis.ends is not None and len(axis.values):
            raise InputError(f"{where}: {axis.key.name} takes no number of points in the design {kind}: give LOW..HIGH")
    if members > LARGEST_AXIS:
        raise InputError(f"sweep: members must be at most {LARGEST_AXIS} for the design {kind}, got {members}")
    shares = _shares(kind, members, len(axes), seed)
    columns = tuple(axis.at(shares[:, i]) for i, axis in enumerate(axes))
    return Design(kind, tuple(axis.key for axis in axes), columns, seed, _logs(axes))


def _shares(kind: str, members: int, axes: int, seed: int) -> NDArray[np.float64]:
    if kind == "random":
        return np.random.default_rng(seed).random((members, axes))
    from scipy.stats import qmc

    return np.asarray(qmc.LatinHypercube(axes, rng=np.random.default_rng(seed)).random(members))


def read_csv(path: Path, where: str) -> pd.DataFrame:
    """Read a table of members from a CSV file: a header line with keys, then one line for each member. Raises InputError."""
    import pandas as pd

    try:
        content = BytesIO(read_bounded(path, LARGEST_TABLE))
        return pd.read_csv(content, comment="#", dtype=str, keep_default_na=False, skipinitialspace=True)
    except FileNotFoundError:
        raise InputError(f"{where} {path}: no such file") from None
    except InputError as error:
        raise InputError(f"{where} {path}: {error}: not a table of members") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{where} {path}: not a table of members: {error}") from None


def listed(scenario: Scenario, table: pd.DataFrame, where: str) -> Design:
    """Return the design of a table with one member in each row.

    Columns are named by keys, and cells hold numbers in SI or texts with units. Raises InputError.
    """
    if not len(table) or not len(table.columns):
        raise InputError(f"{where}: the table has no members")
    keys = tuple(key_named(scenario, str(name).strip(), where) for name in table.columns)
    _check_keys(keys, where)
    columns = (table.iloc[:, i] for i in range(len(keys)))
    return Design("list", keys, tuple(read_values(key, column, where) for key, column in zip(keys, columns, strict=True)))
