"""Read a laboratory record: time, what the machine did, and what was measured."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import as_path, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.columns import Table, find, missing, read_mapping, read_text
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import brief
from stickslip.studies.inference.noise import noise_of, saturated, spikes

LARGEST_FILE = 500_000_000
"""Size (bytes) of the largest record that is read."""
MOST_SAMPLES = 5_000_000
"""Largest number of samples of a record."""
SHEAR = ("friction", "shear_stress", "shear_force")
"""What may be measured of the resistance; a record is fitted by the first of these that it has."""
MEASURED = (*SHEAR, "slip", "slip_rate")
"""Everything that may be fitted."""
LOADING = ("load_point", "load_rate")
UNITS = {"friction": "1", "shear_stress": "Pa", "shear_force": "N", "slip": "m", "slip_rate": "m/s"}
UNITS |= {f"{name}_{level}": UNITS[name] for name in SHEAR for level in ("peak", "rest", "drop")}
UNITS |= {"recurrence": "s", "duration": "s", "event_slip": "m", "peak_rate": "m/s"}
WANTED = ("time", *LOADING, *MEASURED, "normal_stress", "normal_force", *(f"{name}_deviation" for name in MEASURED))
"""The columns that are looked for."""
BACKWARD = 0.9
"""Share of shear stresses below 0 from which the sign of a record is turned."""
FALLING = 0.7
"""Share of its fast samples in which shear drops, from which a load point is slip."""
HIGHEST, LOWEST = 3.0, 1e-2
"""Friction coefficients beyond which a record is refused, or doubted."""


@dataclass(frozen=True, eq=False)
class Record:
    """A laboratory record in SI, at ascending times (s). Make one with `Record.read`.

    `measured` holds friction (1), shear_stress (Pa), shear_force (N), slip (m) and slip_rate (m/s), NaN where nothing was measured,
    and `deviations` their standard deviations, where they are given. `load_point` (m) and `load_rate` (m/s) are those of the load
    point, or None. `notes` say what was done with the record, one sentence each. `relative` is the noise of each sample relative to
    the usual one, where some are means of more samples than others, or None.
    """

    time: Floats
    measured: dict[str, Floats]
    deviations: dict[str, Floats] = field(default_factory=dict)
    load_point: Floats | None = None
    load_rate: Floats | None = None
    name: str = "record"
    notes: tuple[str, ...] = ()
    relative: Floats | None = None

    @classmethod
    def read(cls, source: Any, begin: float | None = None, end: float | None = None) -> Record:
        """Read a record.

        Parameters
        ----------
        source : str, Path, DataFrame, mapping or Record
            A CSV file, or columns of numbers by their headings: `time` with any of `friction`, `shear_stress`, `shear_force`,
            `slip` and `slip_rate`, and with `load_point` (displacement) or `load_rate` of the machine. Shear stress with
            `normal_stress`, and shear force with `normal_force`, give friction. Headings may carry units, as in "tau (MPa)".
        begin, end : float, optional
            Times (s, as in the record) between which the record is taken.

        Raises
        ------
        InputError
            If the record cannot be used; the message is one line with the place and the cure.
        """
        if isinstance(source, Record):
            return source.part(begin, end)
        table = _table_in(source)
        found, place = dict(table.columns), table.place
        if "time" not in found:
            raise InputError(f"{table.at_header or place}: no column 'time'; {missing(table.header, 'time')}")
        notes = _not_understood(table)
        ordered = _in_order(found, place, notes)
        time = ordered.pop("time")
        _take_ratio(ordered, "shear_stress", "normal_stress")
        _take_ratio(ordered, "shear_force", "normal_force")
        measured = {name: ordered[name] for name in MEASURED if name in ordered}
        if not measured:
            raise InputError(f"{table.at_header or place}: nothing measured; {missing(table.header, 'friction')}")
        deviations = {name: ordered[f"{name}_deviation"] for name in measured if f"{name}_deviation" in ordered}
        _check_deviations(deviations, place)
        load_point, load_rate = (ordered.get(name) for name in LOADING)
        made = cls(time, measured, deviations, load_point, load_rate, place, tuple(notes))
        return made._checked().part(begin, end)

    def part(self, begin: float | None = None, end: float | None = None) -> Record:
        """Return the samples between two times (s, as in the record). Raises InputError if there are fewer than two."""
        inside = (self.time >= (-np.inf if begin is None else begin)) & (self.time <= (np.inf if end is None else end))
        if inside.sum() < 2:
            spans = f"the record goes from {self.time[0]:g} to {self.time[-1]:g} s"
            raise InputError(f"{self.name}: fewer than two samples in the part that is asked for; {spans}")
        return self if inside.all() else self._of(inside)

    def _of(self, chosen: Any) -> Record:
        def cut(values: Floats | None) -> Floats | None:
            return None if values is None else np.asarray(values[chosen])

        measured = {name: values[chosen] for name, values in self.measured.items()}
        deviations = {name: values[chosen] for name, values in self.deviations.items()}
        loads = cut(self.load_point), cut(self.load_rate)
        return replace(
            self,
            time=self.time[chosen],
            measured=measured,
            deviations=deviations,
            load_point=loads[0],
            load_rate=loads[1],
            relative=cut(self.relative),
        )

    @property
    def clock(self) -> Floats:
        """Times since the first sample (s), shape (n,): those of the run."""
        return np.asarray(self.time - self.time[0])

    @property
    def shear(self) -> str | None:
        """The name of the measured resistance; None if there is none."""
        return next((name for name in SHEAR if name in self.measured), None)

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        what = ", ".join([*self.measured, *(name for name in LOADING if getattr(self, name) is not None)])
        return f"Record({self.name}: {len(self)} samples in {brief(float(np.ptp(self.time)), 's')}: {what})"

    def _checked(self) -> Record:
        """Return the record with forward shear positive and without samples of a saturated sensor. Raises InputError."""
        notes, measured = list(self.notes), dict(self.measured)
        driven = {name: values for name in LOADING if (values := getattr(self, name)) is not None}
        for name, values in {**measured, **driven}.items():
            if not np.isfinite(values).any():
                raise InputError(f"{self.name}: {name} has no number in any row")
        _check_signs(measured, self.load_point, notes)
        for name in SHEAR:
            if name in measured and (lone := spikes(measured[name])).any():
                worst = brief(float(measured[name][lone][0]), UNITS[name])
                measured[name] = np.where(lone, np.nan, measured[name])
                notes.append(f"{name} is far beyond the rest in {int(lone.sum())} lone samples, as at {worst}: they are left out")
        if "friction" in measured:
            _check_friction(float(np.nanmedian(np.abs(measured["friction"]))), self.name, notes)
        for name, values in measured.items():
            flat = saturated(values)
            if flat.any():
                measured[name] = np.where(flat, np.nan, values)
                at = f"{int(flat.sum())} samples at {brief(float(values[flat][0]), UNITS[name])}"
                notes.append(
                    f"{name} is constant at the end of its range in {at}: the sensor was saturated there; they are left out"
                )
        made = replace(self, measured=measured, notes=tuple(notes))
        made._check_load_point()
        return made

    def _check_load_point(self) -> None:
        """Raise InputError if the column of the load point is slip: it jumps where the shear stress drops."""
        shear, moved = self.shear, self.load_point
        if moved is None:
            return
        if "slip" in self.measured and np.array_equal(moved, self.measured["slip"], equal_nan=True):
            raise InputError(f"{self.name}: load_point and slip are the same numbers: leave the column out that is wrong")
        if shear is None or len(self) < 30:
            return
        change, step = np.diff(self.measured[shear]), np.diff(moved)
        known = np.isfinite(change) & np.isfinite(step)
        change, step, lasting = change[known], step[known], np.diff(self.time)[known]
        noise = max(noise_of(self.measured[shear]), 1e-9 * float(np.nanmax(np.abs(self.measured[shear]))))
        falls = change < -10.0 * noise
        rate = step / lasting
        fast = rate > 10.0 * max(float(np.median(rate)), 0.0)
        if 2 <= fast.sum() < 0.2 * len(rate) and float(np.mean(falls[fast])) > FALLING:
            why = "it jumps where the shear stress drops, as slip does and a driven load point does not"
            raise InputError(f"{self.name}: load_point looks like slip: {why}; call the column slip, and give the load rate")


def _check_signs(measured: dict[str, Floats], moved: Floats | None, notes: list[str]) -> None:
    """Turn the sign of shear that is negative while the machine moves forwards, and doubt a machine that moves against shear."""
    ends = None if moved is None else moved[np.isfinite(moved)][[0, -1]]
    for name in (name for name in SHEAR if name in measured):
        negative = float(np.nanmean(measured[name] < 0.0))
        if negative > BACKWARD and (ends is None or ends[1] >= ends[0]):
            measured[name] = -measured[name]
            notes.append(f"{name} is negative while the machine moves forwards: its sign was turned")
        elif negative < 1.0 - BACKWARD and ends is not None and ends[1] < ends[0]:
            notes.append(
                f"load_point falls while {name} is positive: does its sensor count backwards, so that its sign must be turned?"
            )


def _check_friction(size: float, name: str, notes: list[str]) -> None:
    if size > HIGHEST:
        raise InputError(
            f"{name}: friction is {size:.3g} in the median: is a stress in N, or friction in percent? Friction is 0.1 to 1"
        )
    if size < LOWEST:
        notes.append(f"friction is {size:.3g} in the median: are the units of shear and normal stress in the headings right?")


def _check_deviations(deviations: Mapping[str, Floats], place: str) -> None:
    for name, values in deviations.items():
        if not (np.isfinite(values) & (values > 0.0)).all():
            raise InputError(f"{place}: {name}_deviation must be above 0 in each row")


def _take_ratio(found: dict[str, Floats], shear: str, normal: str) -> None:
    """Replace a shear stress or force with its normal one by friction, unless friction itself is there."""
    if shear in found and normal in found and "friction" not in found:
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = found.pop(shear) / found[normal]
            if f"{shear}_deviation" in found:
                found["friction_deviation"] = found.pop(f"{shear}_deviation") / np.abs(found[normal])
        found["friction"] = np.where(np.isfinite(ratio), ratio, np.nan)


def _in_order(found: dict[str, Floats], place: str, notes: list[str]) -> dict[str, Floats]:
    """Return columns sorted by time, with one row for each time. Raises InputError for fewer than two rows with a time."""
    known = np.isfinite(found["time"])
    if not known.all():
        notes.append(f"{int((~known).sum())} rows without a time are left out")
        found = {name: values[known] for name, values in found.items()}
    time = found["time"]
    if len(time) < 2:
        raise InputError(f"{place}: at least two rows with a time are needed, got {len(time)}")
    for name, values in found.items():
        lost = int((~np.isfinite(values)).sum())
        if lost and name != "time":
            notes.append(f"{name} has no number in {lost} of {len(values)} rows: they are left out")
            found[name] = np.where(np.isfinite(values), values, np.nan)
    if (np.diff(time) < 0.0).any():
        notes.append("the rows were not in the order of time: they were sorted")
        order = np.argsort(time, kind="stable")
        found = {name: values[order] for name, values in found.items()}
        time = found["time"]
    if (np.diff(time) == 0.0).any():
        first = np.flatnonzero(np.append(True, np.diff(time) > 0.0))
        notes.append(f"{len(time) - len(first)} rows repeat a time: their mean was taken")
        if len(first) < 2:
            raise InputError(f"{place}: all rows have one time, {time[0]:g} s")
        found = {name: _means(values, first) for name, values in found.items()}
    return found


def _means(values: Floats, first: NDArray[np.intp]) -> Floats:
    """Return means of groups of rows that begin at some indices; numbers that are missing do not count."""
    known = np.isfinite(values)
    count = np.add.reduceat(known.astype(float), first)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.add.reduceat(np.where(known, values, 0.0), first) / count)


def _not_understood(table: Table) -> list[str]:
    """Return a sentence on columns that are passed over, if one of them may be the load point."""
    chosen = find(table.header, WANTED, table.place)
    used = {place for place, _ in chosen.values()}
    others = [shown(heading) for i, heading in enumerate(table.header) if i not in used]
    if not others or set(LOADING) & set(chosen):
        return []
    cure = "the displacement of the machine is called load_point, and its rate load_rate"
    return [f"columns that were not understood: {', '.join(others[:6])}; {cure}"]


def _table_in(source: Any) -> Table:
    """Return the known columns of a source. Raises InputError."""
    if isinstance(source, Mapping) or hasattr(source, "columns"):
        return read_mapping(source, WANTED, "record", raw=True)
    if not isinstance(source, str | os.PathLike):
        raise InputError(f"infer: record must be a CSV file, a DataFrame, or a mapping of headings to numbers, got {shown(source)}")
    path = as_path("infer: record", source)
    name = str(path) if str(path).isprintable() else ascii(str(path))
    return read_text(_text(path, name), WANTED, name, MOST_SAMPLES, raw=True)


def _text(path: Path, name: str) -> str:
    try:
        return read_bounded(path, LARGEST_FILE).decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{name}: no such file") from None
    except UnicodeDecodeError:
        raise InputError(f"{name}: not a text file in UTF-8; save it as CSV in UTF-8") from None
    except OSError as error:
        raise InputError(f"{name}: cannot be read: {error.strerror}") from None
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
