"""A series of slip, slip rate and traction at the contact, by a scheme of the package or by any other program."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError


@dataclass(frozen=True, eq=False)
class Series:
    """A series at the contact; every array has the shape of `time`.

    Parameters
    ----------
    time
        Times (s), ascending.
    slip
        Slip since t = 0, m.
    rate
        Slip rate, m/s.
    traction
        Traction at the contact, Pa.
    name
        Name of the scheme or program.
    cells
        Number of cells in the thickness; 0 if unknown.
    energies
        A row of `Energies` (J/m^2) for each time; None if they are unknown.

    Raises
    ------
    InputError
        If there are fewer than three times, if they do not ascend, or if shapes differ or a number is not finite.
    """

    time: Floats
    slip: Floats
    rate: Floats
    traction: Floats
    name: str = "series"
    cells: int = 0
    energies: Floats | None = None

    def __post_init__(self) -> None:
        if self.time.size < 3:
            raise InputError(f"{self.name}: a series needs three or more times, got {self.time.size}")
        back = np.flatnonzero(np.diff(self.time) <= 0.0)
        if back.size:
            before, after = self.time[back[0] : back[0] + 2].tolist()
            raise InputError(f"{self.name}: times must ascend, but {after:.12g} s (sample {back[0] + 2}) follows {before:.12g} s")
        for name in ("time", "slip", "rate", "traction"):
            values = getattr(self, name)
            if values.shape != self.time.shape:
                raise InputError(f"{self.name}: {name} must have as many numbers as there are times")
            if not np.isfinite(values).all():
                raise InputError(f"{self.name}: {name}: a number is not finite")

    @property
    def step(self) -> float:
        """The median step of time, s."""
        return float(np.median(np.diff(self.time)))
