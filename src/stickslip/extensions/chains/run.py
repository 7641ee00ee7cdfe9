"""A run of a chain: its catalogue of events, its changes, its energies, and its motion."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.state import ChainState
from stickslip.foundation.arguments import NamesAttributes, check_whole
from stickslip.foundation.conversion import has_unit, without_unit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import ShownAsTable
from stickslip.problem import STATUSES, Status, Stop

if TYPE_CHECKING:
    import pandas as pd

    from stickslip.extensions.chains.chain import Chain
    from stickslip.extensions.chains.parting import ChainPredictability
    from stickslip.extensions.chains.plots import ChainPlots

Floats = NDArray[np.float64]
TIME = Quantity("s", "time")
EVENT_TYPE = np.dtype(
    [
        ("time", float),
        ("first_block", np.int64),
        ("size", np.int64),
        ("moment", float),
        ("duration", float),
        ("largest_rate", float),
        ("heat", float),
        ("dashpot", float),
        ("work", float),
        ("springs_before", float),
        ("springs_after", float),
    ]
)
"""Columns of the catalogue, in the order of rows of compiled code."""
EVENT_UNITS = dict(zip(EVENT_TYPE.names or (), ("s", "1", "1", "m", "s", "m/s", "J", "J", "J", "J", "J"), strict=True))
"""Units of these columns."""
CHANGE_TYPE = np.dtype([("time", float), ("since", float), ("block", np.int64), ("kind", np.int64), ("slip", float)])
"""Columns of changes: time (s), time since the first onset of its event (s), block, kind, slip (m)."""
CHANGE_NAMES = ("onset", "arrest", "turn", "knot")
"""Kinds of changes by their number."""


class ChainMotion(NamedTuple):
    """The motion of all blocks: times (s), and for each time the slip (m) and the slip rate (m/s) of each block."""

    times: Floats
    slip: Floats
    slip_rate: Floats


class ChainEnergy(NamedTuple):
    """Energies at the end of a run (J): in springs, of motion, heat of friction, heat of dashpots, and the work of the driver.

    `springs_at_start` is that in springs at t = 0. `error` is springs + kinetic + heat + dashpots - driver - springs_at_start,
    which is 0 but for rounding.
    """

    springs: float
    kinetic: float
    heat: float
    dashpots: float
    driver: float
    springs_at_start: float

    @property
    def error(self) -> float:
        """What the balance lacks (J)."""
        return self.springs + self.kinetic + self.heat + self.dashpots - self.driver - self.springs_at_start


def structured(rows: Floats, kind: np.dtype[Any]) -> NDArray[Any]:
    """Return rows of compiled code as an array with named columns."""
    found = np.empty(len(rows), kind)
    for n, name in enumerate(kind.names or ()):
        found[name] = rows[:, n]
    return found


def checked_times(times: Any) -> Floats:
    """Return times (s), given as one or as a list of them, as an array. Raises InputError."""
    if has_unit(times):
        times = without_unit(times, TIME.unit)
    if not isinstance(times, np.ndarray) or times.dtype.kind not in "fiu":
        several = list(times) if isinstance(times, Iterable) and not isinstance(times, str | bytes) else [times]
        times = np.array([TIME.check("ChainRun", "a time", one) for one in several])
    found = np.atleast_1d(times).astype(float)
    if found.ndim > 1:
        raise InputError(f"ChainRun: times must be a number or a list of numbers, got {' by '.join(map(str, found.shape))}")
    if not found.size:
        raise InputError("ChainRun: times must be at least one, got none")
    return found


@dataclass(frozen=True, eq=False, repr=False)
class ChainRun(ShownAsTable, NamesAttributes):
    """A chain that was solved from t = 0 to a time, by `stickslip.simulate`.

    An event lasts from the first onset after rest of all blocks to their next rest. Blocks that change at the same instant change
    together; the first block of an event is then the one with the lowest number.

    Attributes
    ----------
    chain : Chain
        What was solved.
    duration : float
        The time that was reached (s).
    status : Status
        What ended the run.
    """

    chain: Chain
    duration: float
    event_rows: Floats
    change_rows: Floats | None
    snapshots: list[ChainState]
    state: ChainState
    final: ChainState
    status: Status = STATUSES[Stop.FINISHED]
    title: str = ""

    def _lines(self) -> list[tuple[str]]:
        from stickslip.extensions.chains.summary import lines_of

        return [(line,) for line in lines_of(self)]

    @cached_property
    def events(self) -> NDArray[Any]:
        """The finished events, as a structured array.

        Its columns are the time of the first onset (s), first_block, size (number of blocks that slipped), moment (sum of their
        slip, m), duration (s), largest_rate (m/s), and energies (J): heat of friction, heat in dashpots, work of the driver, and
        that of springs before and after.
        """
        return structured(self.event_rows, EVENT_TYPE)

    def events_table(self) -> pd.DataFrame:
        """Return the events as a table of pandas, with the columns of `events`."""
        import pandas as pd

        return pd.DataFrame(self.events)

    def to_csv(self, path: str | Path) -> Path:
        """Write the events as .csv, .parquet or .nc, with a unit in each heading, and return the path. Raises InputError."""
        from stickslip.extensions.chains.event_files import write_events

        return write_events(self, path)

    @cached_property
    def changes(self) -> NDArray[Any]:
        """The changes of blocks, as a structured array. Raises InputError if the run did not keep them.

        Its columns are time (s), since (time since the first onset of the event, s), block, kind (0
        onset, 1 arrest, 2 turn, 3 knot: `CHANGE_NAMES`), slip (m).
        """
        if self.change_rows is None:
            raise InputError('ChainRun: changes were not kept: simulate(chain, duration, keep="changes") keeps them')
        return structured(self.change_rows, CHANGE_TYPE)

    @property
    def count_of_changes(self) -> int:
        """The number of changes of blocks, whether they are kept or not."""
        return int(self.state.now[at.COUNT_OF_CHANGES])

    @property
    def count_of_events(self) -> int:
        """The number of finished events."""
        return int(self.state.now[at.EVENTS])

    @property
    def moving_steps(self) -> int:
        """The sum of the numbers of moving blocks over all steps."""
        return int(self.state.now[at.BLOCK_STEPS])

    @property
    def slip(self) -> Floats:
        """The slip of each block at the end (m)."""
        return np.array(self.final.blocks[at.SLIP])

    @property
    def slip_rate(self) -> Floats:
        """The slip rate of each block at the end (m/s)."""
        return np.array(self.final.blocks[at.RATE_NOW])

    def energy(self) -> ChainEnergy:
        """Return the energies at the end (J) and their balance."""
        from stickslip.extensions.chains.numbers import numbers_of
        from stickslip.extensions.chains.solver import energies_of

        numbers, first, now = numbers_of(self.chain).chain, ChainState.empty(self.chain.count), self.final.now
        first.blocks[at.SLIP] = self.chain.values("initial_slip")
        kinetic = 0.5 * float(self.chain.values("mass") @ self.final.blocks[at.RATE_NOW] ** 2)
        springs = energies_of(numbers, self.final), energies_of(numbers, first)
        return ChainEnergy(springs[0], kinetic, float(now[at.HEAT]), float(now[at.DASHPOT]), float(now[at.WORK]), springs[1])

    def motion(self, start: float | str, end: float | str, count: int = 1001) -> ChainMotion:
        """Return the motion at so many even times (s) from `start` to `end`: see `at`."""
        first, last = (TIME.check("ChainRun", name, one) for name, one in (("start", start), ("end", end)))
        return self.at(np.linspace(first, last, check_whole("ChainRun: count", count)))

    def at(self, times: ArrayLike) -> ChainMotion:
        """Return slip (m) and slip rate (m/s) of all blocks at times (s), calculated again from the snapshot before the first.

        A time may be a text with a unit.
        """
        from stickslip.extensions.chains.solver import motion_from

        wanted = checked_times(times)
        for one in wanted[~((wanted >= 0.0) & (wanted <= self.duration))][:1]:
            raise InputError(f"ChainRun: times must lie from 0 to {self.duration:g} s, got {one:g} s")
        order = np.argsort(wanted, kind="stable")
        known = [one for one in self.snapshots if one.time <= wanted.min()] or self.snapshots[:1]
        found = motion_from(self.chain, known[-1], np.ascontiguousarray(wanted[order]))
        back = np.empty_like(order)
        back[order] = np.arange(len(order))
        return ChainMotion(wanted, found.slip[back], found.slip_rate[back])

    def predictability(self, size: float = 1e-12, *, runs: int = 4, seed: int = 0) -> ChainPredictability:
        """Run the chain again with disturbed initial slips, and return how many of its events remain.

        All slips are disturbed by a share `size` of the largest mean slip of the blocks of an event at most, in so many `runs`,
        drawn by `seed`; then by 10 times as much, and so on up to 1e-4. An event remains if its first block and its number of
        blocks are the same, and its time to within a tenth of that to the nearer of its neighbours. By default that makes 36 runs
        as long as this one. Raises InputError if an argument is out of range, or if the run has no event to compare.
        """
        from stickslip.extensions.chains.parting import chain_predictability

        return chain_predictability(self, size, runs, seed)

    @property
    def plot(self) -> ChainPlots:
        """The figures: `plot()` draws the catalogue, `plot.rupture()` which blocks slip when."""
        from stickslip.extensions.chains.plots import ChainPlots

        return ChainPlots(self)

    def proof(self) -> str:
        """Return in a sentence what is proven of the run."""
        from stickslip.extensions.chains.numbers import is_straight

        now = self.state.now
        steps, left_out, lacks = int(now[at.COUNT_OF_STEPS]), float(now[at.DEFECT]), float(now[at.RESIDUAL])
        placed = "no change lies before the one that ends a step (proven for the polynomials of the step)"
        if all(is_straight(law) for law in self.chain.laws[0]):
            return (
                f"In each of {steps} steps the terms left out of the series move no block further than {left_out:.1e} of the "
                f"largest motion in the step (proven, but for rounding), and {placed}."
            )
        return (
            f"In each of {steps} steps the force that the equation of any block lacks is at most {left_out:.1e} of its strength "
            f"(proven on complex discs, but for rounding, with which it is {lacks:.1e} at the ends of steps), and {placed}."
        )
