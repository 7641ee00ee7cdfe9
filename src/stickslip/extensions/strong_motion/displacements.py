"""The result of a study of sliding: its table, a summary of each record, statistics over all, and its figures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import pandas as pd

from stickslip.extensions.strong_motion.asked import SlidingAsked, read_length
from stickslip.extensions.strong_motion.motion import GroundMotion
from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import write_table
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.show import number
from stickslip.run import StudyWithDataset
from stickslip.solution import known_to_pyplot

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from stickslip.foundation.place import Place

HEADINGS: Mapping[str, tuple[str, str]] = {
    "record": ("record", ""),
    "polarity": ("polarity", ""),
    "scale": ("scale", ""),
    "yield_coefficient": ("yield coefficient", "g"),
    "backward_coefficient": ("backward yield coefficient", "g"),
    "yield_ratio": ("yield / PGA", ""),
    "pga": ("PGA", "g"),
    "pgv": ("PGV", "length/s"),
    "arias": ("Arias intensity", "m/s"),
    "duration": ("significant duration D5-95", "s"),
    "mean_period": ("mean period Tm", "s"),
    "displacement": ("permanent displacement", "length"),
    "peak_displacement": ("peak displacement", "length"),
    "peak_velocity": ("peak relative velocity", "length/s"),
    "peak_time": ("time of the peak velocity", "s"),
    "slips": ("slips", ""),
    "sliding_time": ("sliding time", "s"),
    "first_slip": ("first slip", "s"),
    "last_stop": ("last stop", "s"),
    "status": ("status", ""),
}
"""The words of the field for the columns of the table, and their units in files."""
DRIFTING = 0.2
"""The ground that still moves at this share of its peak velocity, when a record ends, is told."""
FEW_NAMED = 3
"""Name at most this many records in a sentence."""


@dataclass(frozen=True, eq=False, repr=False)
class SlidingDisplacements(StudyWithDataset):
    """The result of `sliding`: how far a block or a column slides under each record, polarity, scale and yield coefficient.

    The `table` has one row for each of these, yields varying fastest, in SI. Columns: record, polarity (1 as it comes, -1
    opposite), scale (the factor on the record), level (the scale or the PGA in g that was asked), pga (m/s^2), pgv (m/s), arias
    (m/s), duration (s, D5-95) and mean_period (s, Tm) of the scaled record; yield_coefficient and backward_coefficient (of g;
    infinite where there is no backward slip), yield_ratio (yield over PGA); displacement (m, permanent), peak_displacement (m,
    largest magnitude), peak_velocity (m/s, relative) and peak_time (s), slips (their number), sliding_time (s), first_slip and
    last_stop (s; NaN if there is none), and status, how the analysis ended.
    """

    asked: SlidingAsked
    motions: tuple[GroundMotion, ...]
    table: pd.DataFrame
    unit: str = "m"

    @cached_property
    def records(self) -> pd.DataFrame:
        """A row for each record as it is, unscaled, in SI: its samples, its measures, and how the ground ends.

        Columns: record, samples, interval (s), lasts (s), pga (m/s^2), pgv (m/s), pgd (m), arias (m/s), duration (s), mean_period
        (s), cav (m/s), final_velocity (m/s) and final_displacement (m).
        """
        return pd.DataFrame(
            {"record": one.name, "samples": len(one.acceleration), "interval": one.interval, "lasts": one.lasts}
            | one.measures._asdict()
            for one in self.motions
        )

    @cached_property
    def statistics(self) -> pd.DataFrame:
        """A row for each level and yield coefficient: the displacements (m) over all records and polarities.

        Columns: level, yield_coefficient, cases (their number), at_rest (how many do not slide), mean, median, std_ln (standard
        deviation of the natural logarithm over those that slide), least and most.
        """
        groups = self.table.groupby(["level", "yield_coefficient"], sort=False).displacement
        found = groups.agg(cases="size", at_rest=lambda one: int((one == 0.0).sum()), mean="mean", median="median")
        logarithms = np.log(self.table.displacement.abs().where(self.table.displacement != 0.0))
        keys = [self.table.level, self.table.yield_coefficient]
        found["std_ln"] = logarithms.groupby(keys, sort=False).std()
        table: pd.DataFrame = found.assign(least=groups.min(), most=groups.max()).reset_index()
        return table

    @property
    def ok(self) -> bool:
        """True if every analysis reached its end."""
        return bool((self.table.status == "finished").all())

    @property
    def sentences(self) -> tuple[str, ...]:
        """What is said of the result: what was asked, how far it slides, and what has to be known."""
        return tuple(self._sentences())

    @property
    def text(self) -> str:
        """Say how far it slides, over all records, at the smallest and at the largest yield coefficient."""
        parts = []
        for level, group in self.statistics.groupby("level", sort=False):
            where = "" if self.statistics.level.nunique() == 1 else f"{self._level_text(float(level))}: "  # type: ignore[arg-type]
            ends = [group.iloc[0]] if len(group) == 1 else [group.iloc[0], group.iloc[-1]]
            parts.append(where + ", ".join(self._at_yield(row) for row in ends))
        return "; ".join(parts)

    def _at_yield(self, row: Any) -> str:
        size = read_length("sliding", self.unit)
        mean = f"median {number(row['median'] / size, 4)} {self.unit}"
        spread = f", {number(row.least / size, 4)} to {number(row.most / size, 4)}" if row.cases > 1 else ""
        return f"{mean}{spread} at a yield of {number(row.yield_coefficient, 4)} g"

    def _level_text(self, level: float) -> str:
        return f"PGA {number(level, 4)} g" if self.asked.levels.is_pga else f"scale {number(level, 4)}"

    @property
    def notes(self) -> tuple[str, ...]:
        """What has to be known of the numbers: cases that do not slide, and cases without an answer."""
        table, found = self.table, []
        still = int((table.slips == 0).sum())
        if still:
            above = int(((table.slips == 0) & (table.yield_ratio >= 1.0)).sum())
            why = "the yield is not below the PGA" if above == still else f"in {above} of them the yield is not below the PGA"
            found.append(f"{still} of {len(table)} cases do not slide, displacement 0: {why}")
        failed = table[table.status != "finished"]
        if len(failed):
            found.append(f"{len(failed)} of {len(table)} cases have no answer: {', '.join(sorted(set(failed.status)))}")
        sliding = int((table.last_stop.isna() & (table.slips > 0)).sum())
        if sliding:
            found.append(
                f"{sliding} of {len(table)} cases still slide when the column was left ringing: a column with damping ends"
            )
        drifting = [one for one in self.motions if abs(one.measures.final_velocity) > DRIFTING * one.measures.pgv]
        if drifting:
            which = ", ".join(one.name for one in drifting[:FEW_NAMED]) + (" and others" if len(drifting) > FEW_NAMED else "")
            worst = max(abs(one.measures.final_velocity) / one.measures.pgv for one in drifting)
            moving = f"the ground does not come to rest at the end of {which} (up to {100 * worst:.0f} % of its PGV)"
            found.append(f"{moving}: an instrument's offset? baseline 'mean' takes it off")
        return tuple(found)

    def to_csv(self, path: str | Path) -> Path:
        """Write the table with the words of the field and the chosen unit as CSV, and return its path."""
        return write_table(Path(path), self.in_words(), self._about())

    def in_words(self) -> pd.DataFrame:
        """Return the table with the words of the field as its headings, in g, s, m/s and the unit of the study."""
        size = read_length("sliding", self.unit)
        units = {"g": ("g", GRAVITY), "length": (self.unit, size), "length/s": (f"{self.unit}/s", size)}
        columns = {}
        for name, (words, unit) in HEADINGS.items():
            if self._says_nothing(name):
                continue
            shown_in, divisor = units.get(unit, (unit, 1.0))
            divisor = 1.0 if name.endswith("coefficient") else divisor
            heading = f"{words} ({shown_in})" if shown_in else words
            columns[heading] = self.table[name] / divisor if unit in units else self.table[name]
        return pd.DataFrame(columns)

    def _says_nothing(self, name: str) -> bool:
        """Return True for a column that tells nothing here: of backward slip that is not there, of a status that is always one."""
        one_way = bool(np.isinf(self.table.backward_coefficient).all())
        of_both_ways = name in ("backward_coefficient", "peak_displacement")
        return (one_way and of_both_ways) or (name == "status" and bool((self.table.status == "finished").all()))

    def to_dataset(self) -> xr.Dataset:
        """Return what `plot` draws, in SI units: displacements by case and yield coefficient, with what tells the cases apart."""
        from stickslip.extensions.strong_motion.figures.displacements import displacements_data

        return displacements_data(self)

    def plot_record(
        self,
        name: str | None = None,
        *,
        yields: float | None = None,
        polarity: int | None = None,
        level: float | None = None,
        **place: Unpack[Place],
    ) -> Figure:
        """Plot one record as SLAMMER does: acceleration with the yield, relative velocity, and displacement below each other.

        Parameters
        ----------
        name : str, optional
            A record by its name, or by a part of it that no other has; by default the first one.
        yields : float, optional
            A yield coefficient of the study; by default the smallest one.
        polarity : {1, -1}, optional
            A polarity of the study; by default each in a colour.
        level : float, optional
            A scale, or a PGA (g), of the study; by default the first one.
        figure, size, dpi
            Where to draw, and how large, as for `solution.plot()`.
        """
        from stickslip.extensions.strong_motion.figures.record import draw_shaken, shaken_data

        asked, motion = self.asked, self.motions[self.place_of(name)]
        n = int(np.argmin(asked.forward)) if yields is None else _place(yields, asked.forward.tolist(), "yields")
        signs = asked.polarities if polarity is None else (asked.polarities[_place(polarity, list(asked.polarities), "polarity")],)
        k = 0 if level is None else _place(level, list(asked.levels.values), "level")
        factors = [sign * asked.levels.scales(motion)[k] for sign in signs]
        data = shaken_data(asked, motion, factors, n)
        return known_to_pyplot(draw_shaken(data, self.unit, **place), place)

    def place_of(self, name: str | None) -> int:
        """Return the place of a record among all by a part of its name; None is the first one. Raises InputError."""
        names = [one.name for one in self.motions]
        if name is None:
            return 0
        fits = [n for n, one in enumerate(names) if one == name] or [n for n, one in enumerate(names) if str(name) in one]
        if len(fits) != 1:
            what = "several records have" if fits else "no record has"
            raise InputError(f"plot_record: {what} {shown(name)} in their name; {nearest(str(name), names)}")
        return fits[0]

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.strong_motion.figures.displacements import draw_displacements

        return draw_displacements

    def _about(self) -> tuple[str, ...]:
        import stickslip

        how = {1: "as they come (load -m a)", -1: "opposite (load m a)"}
        signs = " and ".join(how[one] for one in self.asked.polarities)
        return f"stickslip {stickslip.__version__} slide: {self.asked.analysis}, g = {GRAVITY} m/s^2, records {signs}", *self.notes

    def _sentences(self) -> Iterator[str]:
        cases = len(self.table) // len(self.asked.forward)
        records = "1 record" if len(self.motions) == 1 else f"{len(self.motions)} records"
        yields = "1 yield coefficient" if len(self.asked.forward) == 1 else f"{len(self.asked.forward)} yield coefficients"
        yield f"{records}, {cases} with their polarities and scales, {yields}, {self.asked.analysis}"
        yield self.text
        yield from self.notes


def _place(wanted: float, there: list[Any], what: str) -> int:
    """Return the place of a number among those of the study. Raises InputError if it is none of them."""
    for n, one in enumerate(there):
        if abs(one - wanted) <= 1e-9 * abs(one):
            return n
    raise InputError(
        f"plot_record: {what} must be one of the study, {', '.join(f'{one:.6g}' for one in there)}, got {shown(wanted)}"
    )
