"""What a benchmark is: a problem for other programs, a series that is right, and the judgement of a series of theirs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.converged import SeriesWithinBand
from stickslip.extensions.schemes.exact_series import RTOL_OF_EXACT, dataset_of
from stickslip.extensions.schemes.judging import check_tolerance, judged
from stickslip.extensions.schemes.schemes import Schemes
from stickslip.foundation.arrays import Floats
from stickslip.problem.scenarios import Scenario
from stickslip.run import TextProgress

if TYPE_CHECKING:
    import xarray as xr


RTOL_OF_EXACT_RUNS = 1e-10
"""Relative tolerance of the exact runs with which series are compared."""


class Band(NamedTuple):
    """How far a series that is converged, and not exact, may itself be off, for each of its samples."""

    slip: Floats
    """Of slip, m."""
    slip_rate: Floats
    """Of the slip rate, m/s."""
    traction: Floats
    """Of traction, Pa."""


@dataclass(frozen=True)
class Benchmark:
    """A problem for other programs: what it asks of them, and its scenario. The exact solver gives its series."""

    name: str
    asks: str
    make: Callable[[], Scenario]
    tells_rules: bool = False
    """True if its solution depends on the selection rule."""

    band: ClassVar[Band | None] = None
    """How far the series itself may be off; None if it is exact."""

    @property
    def scenario(self) -> Scenario:
        """The scenario, with the tolerance of the exact series."""
        return replace(self.make(), rtol=RTOL_OF_EXACT, name=self.name, title=f"benchmark {self.name}", description=self.asks)

    def series(self) -> xr.Dataset:
        """Return time, slip since t = 0, slip rate and traction along the dimension `sample`, in SI units."""
        return dataset_of(self.scenario)

    def judge(self, several: Sequence[Series], tolerance: float, progress: TextProgress | bool | None = None) -> Schemes:
        """Compare series of another program with that of this problem."""
        return judged(self.scenario, several, (tolerance, RTOL_OF_EXACT_RUNS), progress)


@dataclass(frozen=True)
class ConvergedBenchmark:
    """A problem without an exact solution. `converge` makes a series of its scenario that has converged, with an error band.

    The series is a dataset with time, slip since t = 0, slip rate and traction along the dimension `sample` in SI units. Three more
    columns say how far each sample of slip, slip rate and traction may be off: their names end in _band.
    """

    name: str
    asks: str
    make: Callable[[], Scenario]
    converge: Callable[[Scenario], xr.Dataset]

    tells_rules: ClassVar[bool] = False

    @property
    def scenario(self) -> Scenario:
        """The scenario."""
        return replace(self.make(), name=self.name, title=f"benchmark {self.name}", description=self.asks)

    @cached_property
    def _found(self) -> xr.Dataset:
        return self.converge(self.scenario)

    def series(self) -> xr.Dataset:
        """Return the series with its error band; it is computed once."""
        return self._found

    @property
    def band(self) -> Band:
        """How far the series itself may be off."""
        return Band(*(self._found[f"{name}_band"].to_numpy() for name in Band._fields))

    def judge(self, several: Sequence[Series], tolerance: float, progress: TextProgress | bool | None = None) -> SeriesWithinBand:
        """Compare series of another program with that of this problem."""
        check_tolerance(tolerance)
        return SeriesWithinBand(self._found, tuple(several), tolerance)
