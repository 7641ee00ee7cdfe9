"""Hold a laboratory record: time, motion of the machine, and measured quantities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from stickslip.extensions.inference.record.features import FEATURES, LEVELS_OF_SHEAR
from stickslip.foundation.arguments import CheckedArguments, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import QUANTITIES, TURNS, si_unit
from stickslip.foundation.show import brief
from stickslip.problem import Problem

SHEAR = ("friction", "shear_stress", "shear_force", "torque", "surface_torque")
"""Possible measures of the resistance; the first of them that a record has is fitted. The last is the torque at the drive."""
SHEAR_IN = {QUANTITIES[name].unit: name for name in SHEAR[1:4]}
"""The measure of resistance in each unit of loads."""
MEASURED = (*SHEAR, "slip", "slip_rate", "drive_rate")
"""All quantities that can be fitted."""
LOADING = ("load_point", "load_rate")
OF_EVENTS = (*(f"{name}_{level}" for name in SHEAR for level in LEVELS_OF_SHEAR), *FEATURES)
"""What may be known of each slip event."""
HIGHEST, LOWEST = 3.0, 1e-2
"""A record with a friction coefficient above HIGHEST is refused, one below LOWEST raises a doubt."""


def is_of(name: str, problem: Problem) -> bool:
    """Return True if a measured quantity is friction, a motion, or in the unit of the loads of a problem."""
    return name not in SHEAR[1:] or QUANTITIES[name].unit == problem.load_unit


@dataclass(frozen=True, eq=False)
class Record(CheckedArguments):
    """A laboratory record in SI, at ascending times (s). Make one with `Record.read`.

    `measured` holds friction (1), shear_stress (Pa), shear_force (N), torque (N m), slip (m) and slip_rate (m/s), NaN where nothing
    was measured, of a string also surface_torque (N m) and drive_rate (rad/s), which are measured at its drive, and `deviations`
    the standard deviations given for them. `load_point` (m) and `load_rate` (m/s) are displacement and rate of the load point, or
    None. `notes` say what was done with the record, one sentence each. `relative` is the noise of
    each sample relative to the usual noise if some samples are means over more samples than others, or None. `normal` is the normal
    stress (Pa), force (N) or torque (N m) by which shear was divided, or the weight on the bit (N), as `normal_name` says, or
    None. `slips_in` is "rad" if motions are angles, with rad for m above, "m" if they are lengths, and "" if there are none.
    """

    time: Floats
    measured: dict[str, Floats]
    deviations: dict[str, Floats] = field(default_factory=dict)
    load_point: Floats | None = None
    load_rate: Floats | None = None
    name: str = "record"
    notes: tuple[str, ...] = ()
    relative: Floats | None = None
    normal: Floats | None = None
    normal_name: str = ""
    slips_in: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.measured, Mapping) or not set(self.measured) <= {*MEASURED, *OF_EVENTS}:
            names = f"a mapping of arrays by name ({', '.join(MEASURED)})"
            example = 'Record.read({"time": t, "friction": x}) makes a record of columns'
            raise InputError(f"Record: measured must be {names}, got {shown(self.measured)}; {example}")

    @classmethod
    def read(
        cls,
        source: Any,
        begin: float | None = None,
        end: float | None = None,
        *,
        beside: Any = None,
        later: float = 0.0,
        columns: Mapping[str, str | int] | None = None,
    ) -> Record:
        """Read a record.

        Parameters
        ----------
        source : str, Path, DataFrame, mapping or Record
            A text file (CSV, or as LabVIEW, LAS and universal files are), or columns of numbers by their headings: `time` with any
            of `friction`, `shear_stress`, `shear_force`, `torque`, `slip` and `slip_rate`, and with `load_point` (displacement) or
            `load_rate` of the machine. Shear stress with `normal_stress`, shear force with `normal_force`, and torque with
            `normal_torque` give friction; `surface_torque` (STOR) is the torque at a drive, `weight_on_bit` (SWOB) presses a bit;
            `rotation_rate` (rpm) with `radius` gives the load rate. Without a radius the machine turns the contact itself, and slip
            may be in deg or rad and its rate in rpm: such a record is of a body that turns. Headings may carry units, as in
            "tau (MPa)". "FIRST.csv+SECOND.csv@SECONDS" is short for `beside` and `later`.
        begin, end : float, optional
            First and last time to use (s, as in the record).
        beside : str, Path, DataFrame or mapping, optional
            A second source with a clock of its own and other columns, such as the load point.
        later : float
            Delay of the zero of the second clock behind that of the first (s).
        columns : dict, optional
            What headings of the source mean, as in {"load_point": "Vert_disp (micron)", "friction": 5}: a heading with or without
            its unit, or the number of a column. A unit given here counts before that of the file.

        Raises
        ------
        InputError
            If the record cannot be used; the message is one line with the place and the cure.
        """
        if isinstance(source, Record):
            if columns:
                raise InputError(f"{source.name}: columns name the headings of a source, and a record has been read already")
            return source.part(begin, end)
        from stickslip.extensions.inference.record.read import read_record

        return read_record(source, beside, later, columns).part(begin, end)

    @property
    def shear_of_events(self) -> str | None:
        """The name of the resistance whose levels a table of events has; None for samples."""
        levels = {f"{name}_{level}": name for name in SHEAR for level in LEVELS_OF_SHEAR}
        return next((levels[name] for name in self.measured if name in levels), None)

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
            normal=cut(self.normal),
        )

    def unit_of(self, name: str) -> str:
        """Return the unit that a measured quantity has in this record."""
        return si_unit(name, TURNS if self.slips_in == "rad" else "Pa")

    def of_motion(self, unit: str, body: str) -> Record:
        """Return the record for a contact of a body whose slip is in m or rad: without a drive that turns where the contact slides.

        Raises InputError if slip or its rate is in the other unit.
        """
        if self.slips_in in ("", unit):
            return self
        slips = [name for name in ("slip", "slip_rate", "drive_rate") if name in self.measured]
        if self.slips_in == "rad" and not slips:
            note = "the rotation is passed over: a column radius (mm), the mean radius of the contact, makes it the load point"
            return replace(self, load_point=None, load_rate=None, notes=(*self.notes, note), slips_in="")
        what = " and ".join(slips or [name for name in LOADING if getattr(self, name) is not None])
        raise InputError(f"{self.name}: {what} in {self.slips_in}, where slip of a contact of {body} is in {unit}")

    def driven_as_measured(self) -> Record:
        """Return the record with the rate of its drive as something measured, and not as what moves the driver in a run."""
        if "drive_rate" in self.measured or self.load_rate is None or self.slips_in != "rad":
            return self
        note = "the rate of the drive is what is measured there: the drive is asked for what the problem says"
        measured = self.measured | {"drive_rate": self.load_rate}
        return replace(self, measured=measured, load_rate=None, notes=(*self.notes, note))

    @property
    def clock(self) -> Floats:
        """Times since the first sample (s), shape (n,): those of the run."""
        return np.asarray(self.time - self.time[0])

    @property
    def shear(self) -> str | None:
        """The name of the measured resistance; None without one."""
        return next((name for name in SHEAR if name in self.measured), None)

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        what = ", ".join([*self.measured, *(name for name in LOADING if getattr(self, name) is not None)])
        return f"Record({self.name}: {len(self)} samples in {brief(float(np.ptp(self.time)), 's')}: {what})"
