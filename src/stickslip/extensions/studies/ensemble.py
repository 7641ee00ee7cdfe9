"""Ensembles: a problem run several times with tiny disturbances of its initial load, to see how far a run can be trusted."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stickslip.extensions.studies.kept_runs import KeptRuns
from stickslip.extensions.studies.separation import Separation, disturbed, drawn, is_lossy, separation, shared_events, slope
from stickslip.foundation.arguments import as_path, for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import YEAR
from stickslip.foundation.conversion import WithUnit
from stickslip.problem import Problem, check_event_rate
from stickslip.problem.scenarios import read_source
from stickslip.run import CallOptions, Study, TextProgress, telling, uninterrupted
from stickslip.run.study import MAX_PIECES
from stickslip.solution import Solution
from stickslip.solution.observables import LOST, Predictability, is_followed
from stickslip.solution.observables.predictability import predictability

if TYPE_CHECKING:
    from stickslip.problem.scenarios import Scenario

MAX_TOTAL = 2_000_000
"""Default limit on the pieces of history of all runs together."""


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(Study):
    """The result of `ensemble`, which compares all runs from t = 0 to `until` (s).

    `runs` are those of the members that were finished, of `wanted` members, beside the undisturbed run `reference`. `pushes` were
    added to the initial load; their largest magnitude is `size`, as a share of the static strength. Above
    `event_rate` (m/s) slip counts as an event; None stands for the default of `Solution.catalogue`.
    """

    reference: Solution
    runs: tuple[Solution, ...]
    pushes: Floats
    size: float
    wanted: int
    event_rate: float | None = None

    @property
    def problem(self) -> Problem:
        """The problem without disturbance."""
        return self.reference.problem

    def _all_runs(self) -> tuple[Solution, ...]:
        return self.reference, *self.runs

    @cached_property
    def until(self) -> float:
        """The end (s) of the comparison of runs: the earliest end of a run."""
        return min(run.history.span[1] for run in self._all_runs())

    @property
    def ok(self) -> bool:
        """True if every run reached its end."""
        return all(run.status.ok for run in self._all_runs())

    @property
    def note(self) -> str:
        """A warning if a disturbance of the initial load can only shift the whole run in time; otherwise ""."""
        problem = self.problem
        shifted = not problem.friction.states and not is_lossy(problem) and not problem.varies
        if not (shifted and -problem.strength - problem.backward_strength < problem.excess < 0.0):
            return ""
        return "the run begins at rest: its members do the same, earlier or later; give initial excess 0 to disturb what they do"

    @property
    def stopped(self) -> str:
        """The reason why there are fewer members or a shorter time than asked for; "" if nothing is missing."""
        missing = f"interrupted: {len(self.runs)} of {self.wanted} members" if len(self.runs) < self.wanted else ""
        reasons = ", ".join(dict.fromkeys(run.status.name for run in self._all_runs() if not run.status.ok))
        years = f" ({self.until / YEAR:.6g} years)" if self.until > 0.1 * YEAR else ""
        short = f"compared up to {self.until:.6g} s{years} only, where the first run ended ({reasons})" if reasons else ""
        return "; ".join(part for part in (missing, short) if part)

    @cached_property
    def _all_events(self) -> tuple[pd.DataFrame, ...]:
        return tuple(run.catalogue(self.event_rate) for run in self._all_runs())

    @cached_property
    def catalogues(self) -> tuple[pd.DataFrame, ...]:
        """The slip events that start up to `until`: first of the undisturbed run, then of each member."""
        return tuple(table[table.start <= self.until] for table in self._all_events)

    @cached_property
    def _shared(self) -> tuple[pd.DataFrame, NDArray[np.bool_]]:
        return shared_events(self.catalogues[0], self._all_events[1:], self.reference.history.round_trip_time, self.until)

    @property
    def table(self) -> pd.DataFrame:
        """A table with one row for each event of the undisturbed run.

        Columns: start, recurrence (s) and slip (m) of the event; members, the number of members that still have it; amplification,
        the predicted one. A member has an event if it has all earlier ones and starts this one at the same time, to within a tenth
        of the time from the undisturbed event to the nearer of its two neighbours.
        """
        return self._shared[0]

    @property
    def has(self) -> NDArray[np.bool_]:
        """True where a member (row) still has an event of the undisturbed run (column), shape (members, events)."""
        return self._shared[1]

    @property
    def first_lost(self) -> int | None:
        """The first row of `table` that some member lacks; None if every member has every event."""
        lost = np.flatnonzero(self.table.members < len(self.runs))
        return int(lost[0]) if lost.size else None

    @property
    def horizon(self) -> float:
        """The start (s) of the first event that some member lacks; inf if there is none."""
        return math.inf if self.first_lost is None else float(self.table.start.iloc[self.first_lost])

    @cached_property
    def separation(self) -> Separation:
        """The separation of the members' loads from the undisturbed load."""
        return separation(self.reference, self.runs, self.until)

    @cached_property
    def growth(self) -> pd.DataFrame:
        """The growth of the disturbances with time, one row for each interval of time.

        Columns: time (s), its end; growth, least and most, the separation of a member's load divided by its push: median, smallest
        and largest of the members; small, True until a separation first leaves the range between rounding and saturation;
        predicted, the largest predicted growth so far (NaN if it is not known).
        """
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
        """The predicted growth of the largest push; None for a block, a contact mass, and a law of slip or with a state."""
        if not is_followed(self.problem):
            return None
        found, lost = predictability(self.reference), self.separation.saturation
        error = LOST * float(np.abs(self.pushes).max()) / lost if lost > 0.0 else 0.0
        inside = found.time <= self.until
        return Predictability(found.time[inside], found.amplification[inside], error)

    @property
    def exponent(self) -> float:
        """The measured growth rate (1/s) of a disturbance, an estimate of the largest Lyapunov exponent.

        It is the slope of the straight line fitted to ln(growth) against time while the separation is small, and NaN if there are
        fewer than three such times. It is 0 for a disturbance that persists, and negative for one that decays.
        """
        small = self.growth[self.growth.small]
        return slope(small.time.to_numpy(), small.growth.to_numpy())

    @property
    def predicted_exponent(self) -> float:
        """The slope (1/s) of the predicted growth, at those times of `exponent` when it is small too; NaN if unknown."""
        largest = self.separation.saturation / np.abs(self.pushes).max()
        small = self.growth[self.growth.small & (self.growth.predicted < largest)]
        return slope(small.time.to_numpy(), small.predicted.to_numpy())

    @property
    def text(self) -> str:
        """Summarise how many events the members share."""
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
        """The measured exponent of the growth, and the predicted one with the predicted horizon."""
        if math.isnan(self.exponent):
            return "growth not measured: the loads are too soon too far apart, or not more than rounding"
        measured = f"exponent {self.exponent:.3g} 1/s"
        if self.prediction is None:
            return f"{measured} (no prediction for this problem)"
        horizon = self.prediction.horizon
        lost = f"horizon {_time(horizon)}" if math.isfinite(horizon) else "no horizon in this time"
        return f"{measured}; predicted {self.predicted_exponent:.3g} 1/s, {lost}"

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.studies.figures.ensemble import draw_ensemble

        return draw_ensemble

    def _sentences(self) -> tuple[str, ...]:
        about = f"{len(self.runs)} members, initial load disturbed by up to {self.size:g} of the strength"
        return about, self.note, self.text, self.growth_text, self.stopped


@for_users
def ensemble(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    members: int = 8,
    size: float = 1e-12,
    rtol: float = 1e-10,
    *,
    max_events: int | None = None,
    seed: int = 0,
    event_rate: float | str | WithUnit | None = None,
    progress: TextProgress | bool | None = None,
    max_pieces: int | None = None,
    checkpoint: str | Path | None = None,
) -> Ensemble:
    """Run a problem once undisturbed and n times with a disturbed initial load, and compare the runs.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        Problem to disturb, its scenario, the name of a bundled scenario, or a scenario file.
    duration : float or str, optional
        Duration of each run (s, or a text with a unit); by default the scenario's.
    members : int
        Number n of disturbed runs.
    size : float
        Largest disturbance, as a share of the static strength S mu_s (for a law that never sticks, of the initial load).
    rtol : float
        Relative tolerance of the runs.
    max_events : int, optional
        Number of slip events after which each run ends.
    seed : int
        Seed of the random signs and sizes of the disturbances.
    event_rate : float or str, optional
        Slip rate (m/s, or a text with a unit) above which slip counts as an event, as in `Solution.catalogue`.
    progress : bool or callable, optional
        True shows the progress in one line, on a terminal or in a notebook. A function is called with a line of text as each run
        begins.
    max_pieces : int, optional
        Largest number of pieces of history of one run; default 200 000, and 2 000 000 for all runs together. A run that needs more
        ends early, and all runs are compared up to that time.
    checkpoint : str or Path, optional
        Folder that keeps the runs, one file each. If the program is killed, the same call takes them up from there, and its
        result is the same, bit for bit.

    Returns
    -------
    Ensemble
        The runs, and how far they differ. After Ctrl-C it holds the members that are finished.

    Raises
    ------
    InputError
        If an argument is out of range, or if the folder holds runs of another ensemble or of another version.
    KeyboardInterrupt
        If the user presses Ctrl-C before the first member is finished.

    Notes
    -----
    The initial load of each member (slab: the uniform stress tau0; block: the force of its spring) is larger or smaller by size/2
    to size times the strength. Nothing else changes: not the slip, a state of the law, or the far stress. If the contact starts at
    its strength or beyond, no member is held back. If it starts from rest, another load only shifts the same run in time, see
    `Ensemble.note`.
    """
    scenario = read_source("ensemble", problem, duration)
    given = scenario.problem
    options = CallOptions(scenario.duration, rtol, max_events=max_events, max_pieces=max_pieces).check("ensemble", given)
    pushes = drawn(given, members, size, seed)
    rate = check_event_rate(event_rate, "ensemble")
    most = min(MAX_PIECES, MAX_TOTAL // (members + 1)) if max_pieces is None else max_pieces
    # leaps over creep and lumped events would hide the small differences between the runs
    options = replace(options, max_pieces=most, creep_rtol=0.0, shortest_event=0.0)
    folder = None if checkpoint is None else as_path("ensemble: checkpoint", checkpoint)
    runs: list[Solution] = []
    with KeptRuns.opened("ensemble", folder) as kept, telling(progress, "ensemble") as tell:
        tell("undisturbed")
        reference = uninterrupted(kept.run("undisturbed", given, options))
        try:
            for i, push in enumerate(pushes.tolist()):
                tell(f"member {i + 1} of {members}")
                runs.append(uninterrupted(kept.run(f"member-{i + 1}", disturbed(given, push), options)))
        except KeyboardInterrupt:
            if not runs:
                raise
    return Ensemble(reference, tuple(runs), pushes[: len(runs)], size, members, rate)


def _time(seconds: float) -> str:
    return f"{seconds / YEAR:.6g} years" if seconds > 0.1 * YEAR else f"{seconds:.6g} s"
