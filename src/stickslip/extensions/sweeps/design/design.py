"""The members of a sweep: every combination of the values of its axes (a grid), random samples between ends, or a list."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.sweeps.design.axis import LARGEST_AXIS, DesignAxis, Values
from stickslip.extensions.sweeps.design.members import SUFFIX, columns_of, values_of
from stickslip.foundation.arguments import check_whole, shown
from stickslip.foundation.errors import InputError, nearest
from stickslip.problem.scenarios import ParameterPath, Scenario, find_parameter

GRID, RANDOM, LATIN_HYPERCUBE = KINDS_OF_DESIGN = ("grid", "random", "lhs")
"""Designs made from axes: every combination, independent random samples, or a Latin hypercube."""
LIST = "list"
"""The design that consists of members given one by one."""
IN_WORDS = {
    RANDOM: "drawn at random",
    LATIN_HYPERCUBE: "drawn as a Latin hypercube",
    LIST: "from a list",
}
LARGEST_GRID = 1_000_000_000
"""Largest number of members of a grid: 8 GB for each quantity that is kept."""
MEMBER = "member"
"""Name of the single dimension of samples and lists."""


@dataclass(frozen=True, eq=False)
class Design:
    """The members of a sweep, in their order: the last axis of a grid varies fastest.

    `columns` holds one array for each parameter (SI, or words). For a grid it contains the values of the axis, for samples and
    lists one value for each member. `logs` are the names of the parameters whose values are spaced evenly in the logarithm.
    """

    kind: str
    parameters: tuple[ParameterPath, ...]
    columns: tuple[Values, ...]
    seed: int | None = None
    logs: frozenset[str] = frozenset()

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the parameters."""
        return tuple(parameter.name for parameter in self.parameters)

    @property
    def is_grid(self) -> bool:
        """True if every combination of the values in the columns is a member."""
        return self.kind == GRID

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of members along each dimension."""
        return tuple(len(column) for column in (self.columns if self.is_grid else self.columns[:1]))

    @property
    def dims(self) -> tuple[str, ...]:
        """The names of the dimensions: the parameters of a grid, otherwise `member`."""
        return self.names if self.is_grid else (MEMBER,)

    @property
    def size(self) -> int:
        """The number of members."""
        return math.prod(self.shape)

    def values(self, members: slice | NDArray[np.intp]) -> dict[str, Values]:
        """Return the values of these members by parameter, as one-dimensional arrays in SI."""
        numbers = np.arange(*members.indices(self.size)) if isinstance(members, slice) else np.asarray(members)
        places = np.unravel_index(numbers, self.shape) if self.is_grid else (numbers,) * len(self.columns)
        return {name: column[place] for name, column, place in zip(self.names, self.columns, places, strict=True)}

    def __str__(self) -> str:
        return in_words(self.kind, self.shape)


def in_words(kind: str, shape: tuple[int, ...]) -> str:
    """Return how many members a design has, and where they come from."""
    if kind == GRID:
        return f"{' x '.join(str(one) for one in shape)} = {math.prod(shape)} members"
    return f"{math.prod(shape)} members {IN_WORDS[kind]}"


def read_design(
    scenario: Scenario, vary: Any, kind: Any = GRID, *, members: int | None = None, seed: int = 0, where: str = "sweep: vary"
) -> Design:
    """Return the design that `vary` describes: a mapping or axes (`axes_of`), a table of members, or a finished design.

    Members from outside are `vary` if that is a DataFrame or the `Path` of a CSV file, or stand in place of the `kind`
    (`is_from_outside`); `vary` is then None, or names the columns of an array. Raises InputError. A message on `vary` begins with
    `where`.
    """
    if isinstance(vary, Design):
        return vary
    if is_from_outside(kind):
        if members is not None:
            raise InputError("sweep: members belongs to the designs random and lhs: leave it out")
        return listed(scenario, kind, "sweep: design", vary)
    if isinstance(vary, Path) or hasattr(vary, "columns"):
        return listed(scenario, vary, where)
    axes = axes_of(scenario, vary, where, sampled=kind != GRID)
    if kind not in KINDS_OF_DESIGN:
        raise InputError(f"sweep: design '{kind}' is unknown; {nearest(kind, KINDS_OF_DESIGN)}")
    if kind != GRID:
        return sampled(axes, kind, members, seed, where)
    if members is not None:
        raise InputError("sweep: members belongs to the designs random and lhs: a grid has every combination of its axes")
    return grid(axes, where)


def is_from_outside(design: Any) -> bool:
    """Return True for members or a file of them in place of the name of a kind of design."""
    return not isinstance(design, str) or design.endswith(SUFFIX)


def axes_of(scenario: Scenario, vary: Any, where: str, *, sampled: bool = False) -> list[DesignAxis]:
    """Return the axes of a mapping from parameters to values (`DesignAxis.of_values`); a list of axes is returned as it is.

    If `sampled`, a tuple (LOW, HIGH) or (LOW, HIGH, "log") stands for the ends between which samples are drawn. Raises
    InputError, whose message begins with `where`.
    """
    if isinstance(vary, Mapping):
        axes = [_axis(find_parameter(scenario, str(name), where), content, where, sampled) for name, content in vary.items()]
    elif isinstance(vary, list) and all(isinstance(axis, DesignAxis) for axis in vary):
        axes = vary
    else:
        got = " ".join(shown(vary.tolist() if isinstance(vary, np.ndarray) else vary).split())
        hint = "; an array of members is a design, whose columns vary names" if isinstance(vary, np.ndarray | list) else ""
        forms = "a mapping from parameters to arrays, a DataFrame or the Path of a CSV file"
        raise InputError(f"{where} must be {forms}, got {got}{hint}")
    if not axes:
        raise InputError(f"{where} is missing: name at least one parameter to vary")
    _check_names([axis.parameter.name for axis in axes], where)
    return axes


def _axis(parameter: ParameterPath, content: Any, where: str, sampled: bool) -> DesignAxis:
    if not isinstance(content, tuple):
        return DesignAxis.of_values(parameter, content, where)
    if not sampled or len(content) < 2 or content[2:] not in ((), ("log",)):
        ends = '(LOW, HIGH) or (LOW, HIGH, "log")'
        raise InputError(f"{where}: {parameter.name} must be an array or a list: a tuple {ends} is for the designs random and lhs")
    return DesignAxis.of_range(parameter, content[:2], content[2:] == ("log",), where)


def _check_names(names: Sequence[str], where: str) -> None:
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{where}: {name} is varied twice")
    if {"initial.load", "initial.excess"} <= set(names):
        raise InputError(f"{where}: initial.load and initial.excess exclude each other")


def _design(kind: str, axes: Sequence[DesignAxis], columns: Sequence[Values], seed: int | None = None) -> Design:
    logs = frozenset(axis.parameter.name for axis in axes if axis.log)
    return Design(kind, tuple(axis.parameter for axis in axes), tuple(columns), seed, logs)


def grid(axes: Sequence[DesignAxis], where: str) -> Design:
    """Return the design of every combination of the axes.

    Raises InputError for an axis without points or with a repeated value, and for more than LARGEST_GRID members.
    """
    for axis in axes:
        if len(axis.values) == 0:
            raise InputError(f"{where}: {axis.parameter.name} needs a number of points: LOW..HIGH:POINTS")
        ordered = np.sort(axis.values)
        twice = np.flatnonzero(ordered[1:] == ordered[:-1])
        if twice.size:
            raise InputError(f"{where}: {axis.parameter.name} has the value {ordered[twice[0]]} twice")
    found = _design(GRID, axes, [axis.values for axis in axes])
    if found.size > LARGEST_GRID:
        raise InputError(f"{where}: a grid has at most {LARGEST_GRID:.0e} members, got {found.size:.3g}")
    return found


def sampled(axes: Sequence[DesignAxis], kind: str, members: int | None, seed: int, where: str) -> Design:
    """Return a design of the given number of members, drawn between the ends of the axes.

    `kind` "random" draws members independently. "lhs" is a Latin hypercube: every axis is divided into as many equal intervals as
    there are members, with one member in each (McKay, Beckman & Conover 1979, Technometrics 21, 239). Raises InputError.
    """
    members = check_whole(f"sweep: the design {kind}: members", members, 1, LARGEST_AXIS)
    seed = check_whole("sweep: seed", seed, 0)
    for axis in axes:
        if axis.ends is not None and len(axis.values):
            raise InputError(f"{where}: {axis.parameter.name} takes no number of points in the design {kind}: give LOW..HIGH")
    shares = _shares(kind, members, len(axes), seed)
    return _design(kind, axes, [axis.at(shares[:, i]) for i, axis in enumerate(axes)], seed)


def _shares(kind: str, members: int, axes: int, seed: int) -> NDArray[np.float64]:
    """Return the places (0 to 1) of members along each axis, with the shape (members, axes)."""
    if kind == RANDOM:
        return np.random.default_rng(seed).random((members, axes))
    from scipy.stats import qmc

    return np.asarray(qmc.LatinHypercube(axes, rng=np.random.default_rng(seed)).random(members))


def listed(scenario: Scenario, given: Any, where: str, names: Any = None) -> Design:
    """Return the design of a table or an array with one member in each row (`members.columns_of`).

    Columns are named by parameters, and cells hold numbers in SI or texts with units. Raises InputError.
    """
    columns = columns_of(given, names, where)
    parameters = tuple(find_parameter(scenario, name, where) for name, _ in columns)
    _check_names([parameter.name for parameter in parameters], where)
    values = (values_of(parameter, cells, where) for parameter, (_, cells) in zip(parameters, columns, strict=True))
    return Design(LIST, parameters, tuple(values))
