"""How far can a run be trusted? The same problem again and again, each time with its initial load disturbed by next to nothing."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip import YEAR
from stickslip.foundation.errors import InputError
from stickslip.observables.predictability import LOST, Predictability, is_followed, predictability
from stickslip.problem.problem import Problem
from stickslip.run.simulate import check_run, simulate
from stickslip.solution.solution import Solution
from stickslip.studies.disturbances import disturbed, drawn, is_lossy
from stickslip.studies.separation import Separation, separation, shared_events, slope, statistics_spread
from stickslip.trajectory.history import Floats

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MAX_PIECES, MAX_TOTAL = 200_000, 2_000_000
"""Pieces of history of one run, and of all runs together (some 400 bytes each), unless more are allowed."""
Report = Callable[[str], Any]


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble:
    """What `ensemble` found: the undisturbed run (`reference`) and one of each member that was finished.

    `pushes` (Pa; block: N) were added to the initial load. All is compared from t = 0 to `until` (s), which every run has
    reached. `wanted` members were asked for.
    """

    reference: Solution
    runs: tuple[Solution, ...]
    pushes: Floats
    size: float
    wanted: int
    event_rate: float | None = None

    @property
    def problem(self) -> Problem:
        """The problem that was disturbed."""
        return self.reference.problem

    @cached_property
    def until(self) -> float:
        """Time (s) up to which runs are compared: where the first of them ended."""
        return min(run.history.span[1] for run in (self.reference, *self.runs))

    @property
    def note(self) -> str:
        """Where a disturbance of the initial load cannot do anything but make all earlier or later; else empty."""
        problem = self.problem
        shifted = problem.friction.state is None and not is_lossy(problem) and not problem.varies
        if not (shifted and -2.0 * problem.strength < problem.excess < 0.0):
            return ""
        return "the run begins at rest: its members do the same, earlier or later; give initial excess 0 to disturb what they do"

    @property
    def ok(self) -> bool:
        """Whether every run reached its end."""
        return all(run.status.ok for run in (self.reference, *self.runs))

    @property
    def stopped(self) -> str:
        """Why there are fewer members, or a shorter time, than asked for; empty if all is there."""
        early = [run for run in (self.reference, *self.runs) if not run.status.ok]
        reasons = ", ".join(dict.fromkeys(run.status.name for run in early))
        parts = [f"interrupted: {len(self.runs)} of {self.wanted} members"] if len(self.runs) < self.wanted else []
        parts += [f"compared up to {_time(self.until)} only, where the first run ended ({reasons})"] if early else []
        return "; ".join(parts)

    @cached_property
    def _all_events(self) -> tuple[pd.DataFrame, ...]:
        return tuple(run.catalogue(self.event_rate) for run in (self.reference, *self.runs))

    @cached_property
    def catalogues(self) -> tuple[pd.DataFrame, ...]:
        """Slip events that start up to `until`: of the undisturbed run, then of each member."""
        return tuple(table[table.start <= self.until] for table in self._all_events)

    @cached_property
    def _shared(self) -> tuple[pd.DataFrame, NDArray[np.bool_]]:
        return shared_events(self.catalogues[0], self._all_events[1:], self.reference.history.row_time, self.until)

    @property
    def table(self) -> pd.DataFrame:
        """One row an event of the undisturbed run: start, recurrence (s), slip (m); `members` that still have it; start_spread,
        recurrence_spread (s), slip_spread (m): root mean square of their differences from it; the predicted amplification.

        A member has an event if it has had all before it and starts it at the same time, within a tenth of the time to the nearer
        of the undisturbed events beside it.
        """
        return self._shared[0]

    @property
    def has(self) -> NDArray[np.bool_]:
        """Whether each member (row) still has each event of the undisturbed run (column)."""
        return self._shared[1]

    @property
    def first_lost(self) -> int | None:
        """Row of `table` from which on sequences differ; None if every member has every event."""
        lost = np.flatnonzero(self.table.members < len(self.runs))
        return int(lost[0]) if lost.size else None

    @property
    def horizon(self) -> float:
        """Start (s) of the first event that not all members have; inf if there is none."""
        return math.inf if self.first_lost is None else float(self.table.start.iloc[self.first_lost])

    @cached_property
    def separation(self) -> Separation:
        """How far the loads of the members are from that of the undisturbed run."""
        return separation(self.reference, self.runs, self.until)

    @cached_property
    def growth(self) -> pd.DataFrame:
        """At `time` (s), how many times its push the load of a member is away: median, least and most of the members; `small`,
        while that is far from everything; and what is predicted (the largest so far; NaN where it is not known)."""
        import pandas as pd

        times = self.separation.apart / np.abs(self.pushes)[:, None]
        columns = {"time": self.separation.time, "growth": np.median(times, axis=0), "least": times.min(axis=0)}
        return pd.DataFrame(columns | {"most": times.max(axis=0), "small": self.separation.small, "predicted": self._predicted()})

    def _predicted(self) -> Floats:
        found, time = self.prediction, self.separation.time
        if found is None:
            return np.full(len(time), np.nan)
        so_far = np.maximum.accumulate(np.append(1.0, found.amplification))
        return so_far[np.searchsorted(found.time, time, side="right")]

    @cached_property
    def prediction(self) -> Predictability | None:
        """What is known beforehand of the growth of the largest push; None for a block, a slip law, a state, a contact mass."""
        if not is_followed(self.problem):
            return None
        found, lost = predictability(self.reference), self.separation.saturation
        error = LOST * float(np.abs(self.pushes).max()) / lost if lost > 0.0 else 0.0
        inside = found.time <= self.until
        return Predictability(found.time[inside], found.amplification[inside], error)

    @property
    def exponent(self) -> float:
        """Measured growth rate (1/s) of a disturbance, an estimate of the largest Lyapunov exponent.

        Slope of the straight line through ln(growth) against time while the separation is small; NaN where that is not long
        enough. 0 for what stays as it was, negative for what is forgotten.
        """
        small = self.growth[self.growth.small]
        return slope(small.time.to_numpy(), small.growth.to_numpy())

    @property
    def predicted_exponent(self) -> float:
        """The same slope of the predicted growth, at the same times while it is small too; NaN where it is not known."""
        largest = self.separation.saturation / np.abs(self.pushes).max()
        small = self.growth[self.growth.small & (self.growth.predicted < largest)]
        return slope(small.time.to_numpy(), small.predicted.to_numpy())

    @cached_property
    def statistics(self) -> pd.DataFrame:
        """What statistics keep: one row each for recurrence (s), slip (m) and peak_rate (m/s).

        `count`, `mean` and `variation` of the undisturbed run (see `stickslip.catalogue_statistics`); mean and standard deviation
        over the members of their own `mean` and `variation`; and `chance`, deviation / sqrt(count): how far means of so many
        independent events are apart anyway. A mean_deviation no larger than that says that statistics are stable.
        """
        own, *others = self.catalogues
        return statistics_spread(own, others)

    @property
    def text(self) -> str:
        """What was found, in a few words."""
        events, lost, members = len(self.table), self.first_lost, len(self.runs)
        if not events:
            return "no slip event"
        if lost is None:
            which = "the same slip event" if events == 1 else f"the same {events} slip events"
            return f"all {members} members have {which}" if members > 1 else f"the member has {which}"
        return (
            f"sequences differ from event {lost + 1} of {events} on, at {_time(self.horizon)}; then only statistics mean anything"
        )

    @property
    def growth_text(self) -> str:
        """Measured growth beside the predicted one, in a few words."""
        if math.isnan(self.exponent):
            return "growth not measured: the loads are too soon too far apart, or not more than rounding"
        largest = float(self.growth.growth[self.growth.small].iloc[-1])
        measured = f"a disturbance is multiplied by {largest:.3g}, exponent {self.exponent:.3g} 1/s"
        if self.prediction is None:
            return f"{measured} (no prediction for this problem)"
        horizon = self.prediction.horizon
        lost = f"horizon {_time(horizon)}" if math.isfinite(horizon) else "no horizon in this time"
        return f"{measured}; predicted {self.predicted_exponent:.3g} 1/s, {lost}"

    def save(self, path: str | Path) -> Path:
        """Write the table of events (.csv), or all that is drawn with its provenance (.nc). Raises InputError for other names."""
        from stickslip.figures.studies.ensemble import data
        from stickslip.foundation.atomic_write import write_atomically
        from stickslip.foundation.netcdf_file import write
        from stickslip.io.netcdf import origin

        path = Path(path)
        if path.suffix.lower() == ".csv":
            return write_atomically(path, lambda draft: self.table.to_csv(draft, index=False, lineterminator="\n"))
        if path.suffix.lower() != ".nc":
            raise InputError(f"ensemble: {path}: the name must end in .csv or .nc")
        return write(data(self).assign_attrs({**origin(self.reference), "title": "stickslip ensemble"}), path)

    def plot(self) -> Figure:
        """Events of every member, the growth of the disturbance, and the distribution of slips."""
        from stickslip.figures.studies.ensemble import data, draw

        return draw(data(self))

    def __repr__(self) -> str:
        about = f"{len(self.runs)} members, initial load disturbed by up to {self.size:g} of the strength"
        return "\n".join(
            ["stickslip Ensemble", *(f"  {line}" for line in (about, self.note, self.text, self.growth_text, self.stopped) if line)]
        )


def ensemble(
    problem: Problem,
    duration: float,
    members: int = 8,
    size: float = 1e-12,
    rtol: float = 1e-10,
    *,
    events: int | None = None,
    seed: int = 0,
    event_rate: float | None = None,
    progress: Report | None = None,
    max_pieces: int | None = None,
) -> Ensemble:
    """Run a problem undisturbed, and `members` times with its initial load disturbed, and compare.

    Each member's initial load (slab: the uniform stress tau0; block: the force of its spring) is larger or smaller by `size`/2 to
    `size` times the static strength S mu_s (of a law that never sticks: times the initial load); nothing else changes, not the
    slip, nor a state of the law, nor the far stress. Signs and sizes are drawn from `seed`; where the contact begins at its
    strength or beyond, no member is held back (begun from rest, another load makes the same run earlier or later, see `note`).

    A run that needs more than max_pieces (default: 200 000, and 2 000 000 of all runs together) ends early, and all are compared
    up to there. event_rate (m/s) is that of `Solution.catalogue`. Ctrl-C keeps the members that are finished, KeyboardInterrupt
    if there is none. Raises InputError for an argument out of range.
    """
    check_run("ensemble", duration, rtol, events, 0.0)
    pushes = drawn(problem, members, size, seed)
    if event_rate is not None and not event_rate >= 0.0:
        raise InputError(f"ensemble: event_rate must be a slip rate in m/s, got {event_rate!r}")
    tell = progress or (lambda text: None)
    most = min(MAX_PIECES, MAX_TOTAL // (members + 1)) if max_pieces is None else max_pieces
    tell("undisturbed")
    reference = _run(problem, duration, rtol, events, most)
    runs: list[Solution] = []
    try:
        for i, push in enumerate(pushes.tolist()):
            tell(f"member {i + 1} of {members}")
            runs.append(_run(disturbed(problem, push), duration, rtol, events, most))
    except KeyboardInterrupt:
        if not runs:
            raise
    return Ensemble(reference, tuple(runs), pushes[: len(runs)], size, members, event_rate)


def _run(problem: Problem, duration: float, rtol: float, events: int | None, max_pieces: int) -> Solution:
    exact: dict[str, Any] = {"creep_rtol": 0.0, "shortest_event": 0.0}  # leaps and lumps would hide the differences looked for
    solution = simulate(problem, duration, rtol, events=events, max_pieces=max_pieces, **exact)
    if solution.status.name == "interrupted":
        raise KeyboardInterrupt
    return solution


def _time(seconds: float) -> str:
    return f"{seconds / YEAR:.6g} years" if seconds > 0.1 * YEAR else f"{seconds:.6g} s"
