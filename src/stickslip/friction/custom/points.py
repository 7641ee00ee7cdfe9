"""Read measured points, and make a friction law from them, joined by a monotone cubic."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from stickslip.foundation.arguments import CheckedArguments, as_path, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.columns import Table, read_mapping
from stickslip.foundation.conversion import OptionalNumbers
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.headings import KNOWN_COLUMNS, headings, missing, names_of
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.names import TURNS, own_units
from stickslip.foundation.quantities import Choice, NumberSeries, Quantity, declare
from stickslip.foundation.text_columns import read_file, read_text
from stickslip.friction.law import FrictionLaw, RemembersSlip
from stickslip.friction.piecewise import PiecewiseLaw, note_percent

Along = Literal["slip", "slip_rate"]
"""The two possible variables of friction, by the names of columns in files."""

LARGEST_FILE = 100_000_000
"""Refuse a file of points that is larger than this (bytes)."""
MOST_POINTS = 1_000_000
"""Take at most this many measured points; a fit to that many takes minutes."""
ALONG: tuple[Along, ...] = ("slip", "slip_rate")
NORMAL_UNITS = {"shear_force": "N", "torque": "N m"}
"""Units of the normal load that is asked for beside a lone column; of stresses a missing column is the likelier cause."""
RATIOS = {"shear_stress": "normal_stress", "shear_force": "normal_force", "torque": "normal_torque"}
"""Columns whose ratio is friction, where no column holds friction itself; the last are those of a contact that turns."""
ROLLING = ("slide_roll_ratio", "rolling_speed")
"""Columns of a machine that rolls and slides, whose product is the slip rate."""
LARGEST_RATIO = 2.0
"""A surface at rest under one that turns slides at twice the mean speed: larger ratios of sliding to rolling are percentages."""
BY_ANGLE: Mapping[str, Along] = {"slip_angle": "slip", "slip_rotation": "slip_rate"}
"""Columns of a contact that turns, and what they are of it."""
WANTED = (*ALONG, *BY_ANGLE, "friction", *RATIOS, *RATIOS.values(), *ROLLING)
"""The columns that are looked for."""


@dataclass(frozen=True, eq=False)
class Points(CheckedArguments):
    """Measured friction coefficients (no unit), with the slip (m) or the slip rate (m/s, not negative) of each point, or both.

    Where slip was measured in both directions they are the points of forward slip, and `backward` has those of backward slip, with
    friction and slip rates as magnitudes. Make one with `Points.read`. Points may be in any order and may repeat a slip or a slip
    rate. `name` is for messages and figures. `slips_in` is "rad" for a contact that turns, with rates in rad/s, and else empty.
    `notes` say what was understood of a file: a row of units below the headings, or decimal commas.
    """

    friction: Floats
    slip: Floats | None = None
    slip_rate: Floats | None = None
    name: str = "points"
    slips_in: str = ""
    backward: Points | None = None
    notes: tuple[str, ...] = ()

    @classmethod
    def read(cls, source: Any, *, columns: Mapping[str, str | int] | None = None, normal_force: Any = None) -> Points:
        """Read points from a CSV file, or from columns of numbers by their headings, in the order of the source.

        The columns are `friction` with `slip`, `slip_rate` or both. `shear_stress` and `normal_stress` may take the place of
        friction. A heading may carry a unit, as in "v (mm/s)"; without one numbers are in SI. With a unit of an angle, as in
        "v (rpm)", the points are those of a contact that turns, and `torque` over `normal_torque` may be friction. `u`, `v`, `mu`,
        `tau`, `sigma` and some full names are understood, and other columns are ignored. Notes before the headings are skipped.
        Points, and a law given by points, are taken as they are. `columns` say what headings mean, as in {"slip_rate": "Kanal 3
        (mm/s)"}: a heading with or without its unit, or the number of a column. `normal_force` is that of a column `shear_force`,
        as "100 N"; for one of stresses or torques it is the normal stress or torque. Negative slip rates are backward slip, where
        friction is negative, too, or a magnitude in all rows. Rows with a mark of a missing number, as -999.25,
        are left out, with a warning. Raises InputError if the file or the columns cannot be used; the message is one line with the
        place and the cure.
        """
        if isinstance(source, Points):
            if columns or normal_force is not None:
                raise InputError(f"{source.name}: columns name the headings of a source, and these points have been read already")
            return source
        table, slips_in = _table_in(source, NamedColumns(columns or {}), normal_force, both=True)
        found, back = table.columns, _backward(table)
        note_percent(found["friction"], table.place)
        ways = []
        for rows in (~back, back):
            slip, rate = (None if name not in found else found[name][rows] for name in ALONG)
            size = None if rate is None else np.abs(rate)
            ways.append(cls(np.abs(found["friction"][rows]), slip, size, table.place, slips_in, notes=table.notes))
        ahead, behind = ways
        return replace(ahead, backward=behind) if len(ahead) and len(behind) else ahead if len(ahead) else behind

    @property
    def ways(self) -> tuple[Points, ...]:
        """The points of forward slip and those of backward slip, each as points of one direction; or the points themselves."""
        return (self,) if self.backward is None else (replace(self, backward=None), self.backward)

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
        back = None if self.backward is None else self.backward.along(variable)
        without = {"slip": None} if variable == "slip_rate" else {"slip_rate": None}
        return replace(self, backward=back, **without)  # type: ignore[arg-type] # fields by name

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

    @property
    def load_unit(self) -> str:
        """A unit of loads that stands for the kind of contact: "N m" for one that turns, "Pa" for one that slides."""
        return TURNS if self.slips_in == "rad" else "Pa"

    def of_contact(self, law: FrictionLaw) -> None:
        """Note in a law made from the points that its numbers are those of a contact that turns, if they are."""
        if self.slips_in:
            object.__setattr__(law, "_slips_in", self.slips_in)

    def __len__(self) -> int:
        return len(self.friction)

    def __repr__(self) -> str:
        columns = {"slip": self.slip, "slip_rate": self.slip_rate, "friction": self.friction}.items()
        units = own_units(self.load_unit)
        given = [(name, x, KNOWN_COLUMNS[name].unit) for name, x in columns if x is not None]
        ranges = [f"{name} {np.min(x):.3g} to {np.max(x):.3g} {units.get(unit, unit)}" for name, x, unit in given]
        back = "" if self.backward is None else f", backward {self.backward!r}"
        return f"Points({len(self)} points, {', '.join(ranges)}{back})"


def read_table(source: Any, along: str | None = None) -> tuple[Along, Floats, Floats, str]:
    """Return points that are to be joined exactly: the variable, its ascending values, friction and the `slips_in` of `Points`.

    `along` names the variable where the source has both. Raises InputError as `Points.read` does, for points with slip and slip
    rate, and for those that do not ascend.
    """
    if isinstance(source, Points):
        points = source.along(along)
        if points.backward is not None:
            cure = "BothWays(*(FromTable(one) for one in points.ways)) joins those of each"
            raise InputError(f"{points.name}: slip was measured in both directions: {cure}")
        columns = {points.has[0]: points.places, "friction": points.friction}
        table, slips_in = Table(columns, points.name, np.arange(len(points)), "point"), points.slips_in
    else:
        table, slips_in = _table_in(source)
    return (*_joined(table, along), slips_in)


def table_in_text(text: str, name: str) -> tuple[Along, Floats, Floats]:
    """Return the points in the text of a CSV file, called `name` in messages, as `read_table` does."""
    return _joined(_complete(read_text(text, WANTED, name, MOST_POINTS, skip=True))[0])


def _backward(table: Table) -> NDArray[np.bool_]:
    """Return which rows are of backward slip. Raises InputError for friction that does not resist slip."""
    friction = table.columns["friction"]
    rate = table.columns.get("slip_rate", np.zeros(len(friction)))
    back = (rate < 0.0) | ((rate == 0.0) & (friction < 0.0) & (rate < 0.0).any())
    wrong = np.where(back, friction > 0.0, friction < 0.0) & ((friction < 0.0).any() or not back.any())
    for i in np.flatnonzero(wrong)[:1].tolist():
        if not back.any():
            raise InputError(f"{table.at(i)}: friction must not be negative, got {friction[i]:g}")
        why = "friction must have the sign of slip_rate, or none in all rows"
        raise InputError(f"{table.at(i)}: {why}, got {friction[i]:g} at {rate[i]:g} m/s; leave out rows next to a reversal")
    return np.asarray(back)


def _joined(table: Table, along: str | None = None) -> tuple[Along, Floats, Floats]:
    found = [name for name in ALONG if name in table.columns and along in (None, name)]
    if along is not None and not found:
        hint = nearest(str(along), [name for name in ALONG if name in table.columns])
        raise InputError(f"{table.place}: the points have no {shown(along)} to go along; {hint}")
    if len(found) != 1:
        raise InputError(f'{table.place}: slip and slip_rate are both there: choose one with along="slip" or along="slip_rate"')
    table.check_ascending(found[0])
    return found[0], table.columns[found[0]], table.columns["friction"]


def _table_in(source: Any, named: NamedColumns | None = None, normal: Any = None, *, both: bool = False) -> tuple[Table, str]:
    """Return the columns of a source, which has friction and at least one variable, and `Points.slips_in`. Raises InputError."""
    if isinstance(source, PiecewiseLaw):
        places, friction = source.points
        source = {"slip_rate" if source.knot_variable == "rate" else "slip": places, "friction": friction}
    if isinstance(source, Mapping) or hasattr(source, "columns"):
        return _complete(read_mapping(source, WANTED, "points", named=named), normal, both)
    if not isinstance(source, str | os.PathLike):
        wanted = "a CSV file, a DataFrame, or a mapping of headings to numbers"
        raise InputError(f"points must be {wanted}, got {shown(source)}")
    read = read_file(as_path("points", source), WANTED, (LARGEST_FILE, MOST_POINTS), skip=True, named=named)
    return _complete(read, normal, both)


def _complete(table: Table, given: Any = None, both: bool = False) -> tuple[Table, str]:
    """Return a table if it has all that points need, and "rad" if slip in it is an angle, else "". Raises InputError if not.

    `given` is a normal force for forces. Only if `both` may slip rates be negative.
    """
    found, header, place = table.columns, table.header, table.at_header
    ratio, speed = (found.pop(name, None) for name in ROLLING)
    if ratio is not None and speed is not None and "slip_rate" not in found:
        found["slip_rate"] = ratio * speed / (100.0 if np.abs(ratio).max(initial=0.0) > LARGEST_RATIO else 1.0)
    angles, lengths = ([name for name in names if name in found] for names in (BY_ANGLE, ALONG))
    if angles and lengths:
        raise InputError(f"{place}: {lengths[0]} is a length, and {BY_ANGLE[angles[0]]} an angle: a contact slides, or it turns")
    for name in angles:
        found[BY_ANGLE[name]] = found.pop(name)
    alone = _take_ratio(table, given)
    if "friction" not in found:
        unit = NORMAL_UNITS.get(alone)
        cure = f"with {alone} give its {RATIOS[alone].replace('_', ' ')}, `--normal-force '100 {unit}'`" if unit else ""
        cure = cure or missing(header, "friction")
        raise InputError(f"{place}: no column 'friction'; {cure}")
    if not set(ALONG) & set(found):
        over_time = not headings("time").isdisjoint(names_of(header))
        cure = "a record over time is for `stickslip infer`" if over_time else missing(header, "slip_rate")
        raise InputError(f"{place}: no column slip or slip_rate; {cure}")
    for i in np.flatnonzero(found["slip_rate"] < 0.0)[:1].tolist() if "slip_rate" in found and not both else ():
        cure = "a law for each direction is BothWays, and Points.read takes both"
        raise InputError(f"{table.at(i)}: slip_rate must not be negative, got {found['slip_rate'][i]:g}; {cure}")
    _backward(table)
    if len(found["friction"]) < 2:
        raise InputError(f"{table.place}: at least two points are needed, got {len(found['friction'])}")
    for numbers in found.values():
        numbers.flags.writeable = False
    return table.warned(), "rad" if angles else ""


def _take_ratio(table: Table, given: Any) -> str:
    """Replace stresses, forces or torques by friction, with the normal load that is given or measured; return which lacks one."""
    found = table.columns
    pairs = {name: (found.pop(name, None), found.pop(of, None)) for name, of in RATIOS.items()}
    measured = {name: (shear, normal) for name, (shear, normal) in pairs.items() if shear is not None}
    if "friction" in found and given is not None:
        raise InputError(f"{table.place}: normal_force: there is a column of friction, which needs none")
    if given is not None and not measured:
        raise InputError(f"{table.at_header}: normal_force: no column shear_force, torque or shear_stress that it presses")
    for name, (shear, normal) in measured.items():
        if "friction" in found:
            continue
        of = RATIOS[name]
        if given is not None:
            number = Quantity(KNOWN_COLUMNS[of].unit, of.replace("_", " "), above=0).check(table.place, "normal_force", given)
            normal = np.full(len(shear), number)
        if normal is None:
            return name
        both = (found.get("slip_rate", np.zeros(1)) < 0.0).any()
        for i in np.flatnonzero((normal == 0.0) | ((shear < 0.0) & ~both))[:1].tolist():
            what = f"{of} must be above 0" if normal[i] == 0.0 else f"{name} must not be negative"
            raise InputError(f"{table.at(i)}: {what}, got {(normal if normal[i] == 0.0 else shear)[i]:g}")
        found["friction"] = np.asarray(shear / normal)
    return ""


@dataclass(frozen=True, init=False)
class FromTable(RemembersSlip, PiecewiseLaw):
    """mu through measured points of slip or of slip rate: monotone cubic between them, constant outside (no extrapolation).

    Give the points as a CSV file, a DataFrame or `Points`, as in `FromTable("data.csv")`; `Points.read` says what is understood. Or
    give either `slip` or `rate`, with as many points as `friction`. `along` names the column, slip or slip_rate, that counts where
    a source has both. Slips must not be negative where the path is counted.

    The cubic passes through the points without overshoot. Its slope is continuous between the first and the last point. Through
    noisy points it turns at almost every one of them, and an `InputWarning` says so: see `smooth` and `fit`.
    """

    kind = "table"
    source = "the user's points; Fritsch & Carlson 1980, SIAM J. Numer. Anal. 17, 238; slopes: `monotone_slopes`"
    example: ClassVar = {"friction": [0.7, 0.62, 0.45, 0.4], "slip": [0.0, "0.1 m", "0.3 m", "1 m"]}
    columns: ClassVar = {"slip": "slip", "slip_rate": "rate", "friction": "friction"}

    friction: Sequence[float] = declare(NumberSeries(Quantity("1", "friction coefficients at the points", at_least=0)))
    slip: OptionalNumbers = declare(
        NumberSeries(Quantity("m", "slips of the points; give either slip or rate"), ascending=True), None
    )
    rate: OptionalNumbers = declare(
        NumberSeries(Quantity("m/s", "slip rates of the points; give either slip or rate", at_least=0), ascending=True), None
    )
    counts: Literal["net", "path"] = declare(Choice("slip that a table of slip sees", ("path", "net")), "path")  # type: ignore[misc] # here a choice of the user

    def __init__(
        self,
        source: Any = None,
        /,
        *,
        friction: Iterable[Any] | None = None,
        slip: Iterable[Any] | None = None,
        rate: Iterable[Any] | None = None,
        along: Literal["slip", "slip_rate"] | None = None,
        counts: Literal["net", "path"] = "path",
        memory: Literal["all", "since-arrest"] = "all",
    ) -> None:
        slips_in = ""
        if source is not None:
            if not (friction is slip is rate is None):
                raise InputError("FromTable: give a source of points or lists of numbers, not both")
            slip, rate, friction, slips_in = _read(source, along)
        elif along is not None:
            raise InputError("FromTable: along chooses a column of a source: lists are given as slip or as rate")
        elif friction is None:
            raise InputError("FromTable: friction is missing: give a file, a DataFrame, or friction with slip or rate")
        given = {"friction": friction, "slip": slip, "rate": rate, "counts": counts, "memory": memory}
        for name, value in given.items():
            object.__setattr__(self, name, value)
        self.__post_init__()
        if slips_in:
            object.__setattr__(self, "_slips_in", slips_in)

    @override
    def check(self) -> None:
        if (self.slip is None) == (self.rate is None):
            raise InputError(f"FromTable: give either slip or rate, got {'neither' if self.slip is None else 'both'}")
        if self.slip is not None and self.counts == "path" and self.slip[0] < 0.0:
            raise InputError(f"FromTable: slip[0] must be at least 0 where the path is counted, got {self.slip[0]:g}")
        super().check()

    @property
    @override
    def knot_variable(self) -> Literal["slip", "rate"]:  # type: ignore[override] # depends on the columns here
        return "slip" if self.rate is None else "rate"

    @property
    @override
    def points(self) -> tuple[Sequence[float], Sequence[float]]:
        return self.slip or self.rate or (), self.friction

    @override
    def polynomials(self) -> NDArray[np.float64]:
        """Return the coefficients of Hermite cubics with the slopes of `monotone_slopes`, in ascending order."""
        places, values = (np.array(one) for one in self.points)
        width, slope = np.diff(places), monotone_slopes(places, values)
        secant, left, right = np.diff(values) / width, slope[:-1], slope[1:]
        second = (3.0 * secant - 2.0 * left - right) / width
        third = (left + right - 2.0 * secant) / width**2
        return np.column_stack((values[:-1], left, second, third))


def _read(source: Any, along: str | None) -> tuple[Any, Any, Any, str]:
    """Return slips or None, slip rates or None, friction, and `Points.slips_in` of a source of points. Raises InputError."""
    try:
        variable, places, friction, slips_in = read_table(source, along)
    except InputError as error:
        raise InputError(f"FromTable: {error}") from None
    return (places, None, friction, slips_in) if variable == "slip" else (None, places, friction, slips_in)


def monotone_slopes(places: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return slopes at the points so that Hermite cubics preserve every rise, fall and extremum of the data.

    At an inner point the slope is the weighted harmonic mean of the two secants, or 0 if they differ in sign or one is 0 (Fritsch
    & Butland 1984, SIAM J. Sci. Stat. Comput. 5, 300). At the two ends it comes from a three-point formula, limited to preserve
    the shape.
    """
    width, secant = np.diff(places), np.diff(values) / np.diff(places)
    if len(secant) == 1:
        return np.repeat(secant, 2)
    slopes = np.zeros(len(places))
    w1, w2 = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
    same = secant[:-1] * secant[1:] > 0.0
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        mean = (w1 + w2) / (w1 / secant[:-1] + w2 / secant[1:])
    slopes[1:-1][same] = mean[same]
    slopes[0] = _end_slope(width[0], width[1], secant[0], secant[1])
    slopes[-1] = _end_slope(width[-1], width[-2], secant[-1], secant[-2])
    return slopes


def _end_slope(near: float, far: float, first: float, second: float) -> float:
    """Return the end slope of the parabola through the first three points, limited where the cubic would overshoot.

    The limited slope is 0 if it would differ in sign from the first secant. Where the data turn, its size is at most three times
    that of the first secant.
    """
    slope = ((2.0 * near + far) * first - near * second) / (near + far)
    if slope * first <= 0.0:
        return 0.0
    return 3.0 * first if first * second < 0.0 and abs(slope) > 3.0 * abs(first) else slope
