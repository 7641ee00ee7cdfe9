"""A branch of cycles that goes on: read from its table, or from the branch itself."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pandas as pd

from stickslip.extensions.cycles.branch import BranchOfCycles, PointOnBranch
from stickslip.extensions.cycles.edges import GRAZING, HALVING, MEANING, NOT_FOUND, STEADY_END, CycleEdge
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.measures import Measures
from stickslip.extensions.cycles.path import Path, PlaceOnBranch
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import ParameterPath

SAME_CYCLE = 1e-6
"""The first cycle of a table is that of the scenario if value and period differ by less than this share (1)."""
SAME_END = 1e-12
"""A branch is at an end of its range if it is no farther from it than this share (1) of the range."""
NOTHING_BEHIND = (STEADY_END, HALVING, GRAZING, NOT_FOUND)
"""Edges where a part of a branch ends for good."""
BESIDE_EDGE = (-1e-11, 1e-11, -1e-9, 1e-9)
"""If no run comes back at an edge, which is found to rounding, one beside it does, off by these shares (1) of its value."""


def check_can_be_kept(cycle: LimitCycle, *, double: bool, resume: bool) -> None:
    """Refuse what needs the start of a cycle in a few numbers where that is a wave. Raises InputError."""
    if (double or resume) and not cycle.orbit.is_kept:
        what = "double: cycles of twice the period are followed" if double else "resume: a branch goes on"
        raise InputError(f"follow: {what} for rigid bodies only, and this is a body of waves: leave it out")


def points_to_go_on(
    earlier: BranchOfCycles | str | os.PathLike[str], cycle: LimitCycle, parameter: ParameterPath, ends: tuple[float, float]
) -> list[PointOnBranch]:
    """Return the cycles of an earlier branch, up to the last one that is no edge unless nothing is behind an edge.

    Raises InputError if it is another branch.
    """
    if isinstance(earlier, BranchOfCycles):
        where, name, points = "follow: resume", earlier.parameter.name, list(earlier.points)
    else:
        where = f"follow: {os.fspath(earlier)}"
        name, points = _read(FilePath(earlier), where, parameter)
    if name != parameter.name:
        raise InputError(f"{where}: holds a branch along {name}, not along {parameter.name}")
    if not points:
        raise InputError(f"{where}: holds no cycle: leave out resume")
    begin, last = ends[0], points[-1].value
    same_value = abs(points[0].value - begin) <= SAME_CYCLE * max(abs(begin), abs(points[0].value))
    if not same_value or abs(points[0].measures.period - cycle.period) > SAME_CYCLE * cycle.period:
        found, wanted = (
            f"{brief(value, parameter.unit)} with a period of {brief(period, 's')}"
            for value, period in ((points[0].value, points[0].measures.period), (begin, cycle.period))
        )
        raise InputError(f"{where}: begins at {parameter.name} = {found}, and this cycle is at {wanted}: it is another branch")
    if not min(ends) <= last <= max(ends):
        at, given = (brief(one, parameter.unit) for one in (last, ends[1]))
        raise InputError(f"{where}: has come to {parameter.name} = {at}, beyond to = {given}: give one that is farther")
    while points[-1].edge and points[-1].edge not in NOTHING_BEHIND:
        points.pop()
    return points


def is_at_its_end(points: list[PointOnBranch], ends: tuple[float, float]) -> bool:
    """Return True if the last part of a branch has come to its end: to an end of its range, or to an edge with nothing behind."""
    last = points[-1]
    near = SAME_END * abs(ends[1] - ends[0])
    return last.edge in NOTHING_BEHIND or (len(points) > 1 and min(abs(last.value - one) for one in ends) <= near)


def _read(path: FilePath, where: str, parameter: ParameterPath) -> tuple[str, list[PointOnBranch]]:
    """Return the name of the parameter, and the cycles in a table. Raises InputError if it is none of `follow`."""
    try:
        table = pd.read_csv(path, comment="#", keep_default_na=True)
    except OSError:
        raise InputError(f"{where}: cannot be read: give the table (.csv) of a branch") from None
    except (ValueError, pd.errors.ParserError):
        raise InputError(f"{where}: is no table of a branch") from None
    if missing := [one for one in (*Measures._fields, "edge", "part", "doubled", "ahead") if one not in table]:
        raise InputError(f"{where}: is no table of a branch that can go on: it has no column {missing[0]!r}")
    name = str(table.columns[0])
    try:
        return name, [_point(row, name) for row in table.to_dict("records")]
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{where}: a row of it is damaged") from None


def _point(row: dict[Any, Any], name: str) -> PointOnBranch:
    edge = "" if pd.isna(row["edge"]) else str(row["edge"])
    if edge and edge not in MEANING:
        raise ValueError(edge)
    sizes = _numbered(row, "multiplier_{}"), _numbered(row, "multiplier_{}_imaginary")
    multipliers: Any = sizes[0] if not np.any(sizes[1]) else sizes[0] + 1j * sizes[1]
    measures = Measures(*(float(row[one]) for one in Measures._fields))
    start, ahead = _numbered(row, "start_{}"), np.append(_numbered(row, "ahead_{}"), float(row["ahead"]))
    if edge:
        ahead = np.zeros(0)
    elif len(ahead) != len(start) + 1 or not 0.0 < np.abs(ahead).max() < np.inf:
        raise ValueError(ahead)
    parts = int(row["part"]), int(row["doubled"])
    return PointOnBranch(float(row[name]), measures, multipliers, measures.stick_share > 0.0, edge, *parts, start, ahead)


def _numbered(row: dict[Any, Any], name: str) -> Any:
    """Return the values of columns that are counted from 1, up to an empty one; an empty multiplier is not known."""
    found = []
    for n in range(1, len(row)):
        value = row.get(name.format(n))
        if value is None or pd.isna(value):
            break
        found.append(float(value))
    if not found and name.startswith("multiplier"):
        found = [np.nan if name == "multiplier_{}" else 0.0]
    return np.array(found)


def edge_of(point: PointOnBranch, path: Path) -> CycleEdge:
    """Return the edge at a place on a branch, with the cycle there or, where it just ceased to be, next to it.

    Raises InputError.
    """
    for share in (0.0, *BESIDE_EDGE):
        with suppress(InputError):
            orbit = path.orbit_at(point.value * (1.0 + share), point.start, point.measures.period)
            return CycleEdge(point.edge, point.value, orbit)
    at = f"{path.parameter.name} = {brief(point.value, path.parameter.unit)}"
    raise InputError(f"follow: resume: the cycle at {at} does not come back")


def step_to_go_on(path: Path, last: PointOnBranch) -> tuple[Path, PlaceOnBranch, float]:
    """Return the path and the place of the last cycle of a branch, with its way on, and the length (1) of the next step.

    Raises InputError if the cycle does not come back.
    """
    here = path.cut(at_onset=last.at_onset)
    ahead = last.ahead / here.scales
    length = float(np.linalg.norm(ahead))
    orbit = here.orbit_at(last.value, last.start, last.measures.period)
    return here, PlaceOnBranch(last.value, orbit, ahead / length), length
