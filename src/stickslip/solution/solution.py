"""The result of a run: values at any time, tables, energies, and the status that says what ended it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import BRIEF_DIGITS, NamedLine, ShownAsTable, brief, how_long
from stickslip.problem import Problem, RunOptions, Status, check_event_rate, default_event_rate, in_given_units
from stickslip.problem.scenarios import UNNAMED, Scenario
from stickslip.solution.accessors import Exports, Plots, known_to_pyplot

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stickslip.engine import Checkpoint, History, Reach
    from stickslip.foundation.place import Place
    from stickslip.solution.account import Account
    from stickslip.solution.observables.predictability import Predictability
    from stickslip.solution.observables.proof_of_run import ProofOfRun
    from stickslip.solution.observables.rule_influence import RuleInfluence
    from stickslip.solution.window import Window


class SolutionPlots(Plots["Solution"]):
    """Figures of a whole run: as in `Plots`, its catalogue, and its path through the solutions of the contact equation."""

    @in_given_units
    def catalogue(self, event: int | None = None, **place: Unpack[Place]) -> Figure:
        """Draw the slip events, one of them in ever closer zooms, and their distributions.

        `event` is the row number in `solution.events` of the zooms; negative ones count from the last. By default it is the last
        event whose slip is at least 99 % of the largest. A figure of one journal column has two panels in a row instead of three.
        Panels for which a figure is too low are left out, the zooms first. Raises InputError if the run has no slip event, or not
        the one asked for.
        """
        from stickslip.figures.runs import catalogue

        return known_to_pyplot(catalogue.draw_catalogue(catalogue.catalogue_shown(self._run, event), **place), place)

    @in_given_units
    def path(self, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the solutions of the contact equation (the set K) and the path of the run through them.

        Raises InputError for a block, a contact mass, or a law with a state variable, which have no such set.
        """
        from stickslip.figures.contact import admissible

        return known_to_pyplot(admissible.draw_admissible(admissible.admissible_data(self._run.problem, self._run), **place), place)


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Exports, ShownAsTable):
    """A finished run.

    Times are in s from the start of the run. Methods take scalars or arrays and return arrays of the same shape. `side` ("left"
    or "right") picks the limit at a shock; the left limit at t = 0 is the initial state. Times outside the run raise
    InputError. Tables are built when they are first asked for.
    """

    problem: Problem
    options: RunOptions
    """How long and how accurately the problem was to be run, as the user gave it, and the title of its scenario."""
    status: Status
    history: History
    checkpoint: Checkpoint | None = None
    """State for continuing the run, or a longer one (`stickslip.resume`)."""
    lumping_note: str = ""
    """One line on automatic lumping; empty if it did not begin."""
    rounding_note: str = ""
    """One line on steps that miss the contact equation by more than the tolerance, by rounding; empty if there are none."""

    @property
    def asked_duration(self) -> float:
        """The latest end of the run (s), as it was asked for; `duration` is the time that the run reached."""
        return self.options.duration

    @property
    def rtol(self) -> float:
        """The relative tolerance of the run."""
        return self.options.rtol

    @property
    def max_events(self) -> int | None:
        """The number of slip events after which the run was told to stop."""
        return self.options.max_events

    @property
    def creep_rtol(self) -> float | None:
        """The tolerance of leaps over creep: None is automatic, 0 computes every round trip."""
        return self.options.creep_rtol

    @property
    def shortest_event(self) -> float | None:
        """Events shorter than this (s) are lumped: None is automatic, 0 lumps none."""
        return self.options.shortest_event

    @property
    def title(self) -> str:
        """The title of the scenario, which figures show; empty for a problem from Python."""
        return self.options.title

    @property
    def description(self) -> str:
        """The description of the scenario; empty for a problem from Python."""
        return self.options.description

    @property
    def duration(self) -> float:
        """The time (s) that the run reached: less than `asked_duration` if it ended early, which `status` explains."""
        return self.history.duration

    @cached_property
    def events(self) -> pd.DataFrame:
        """The slip events, one row each: maximal intervals with |v| above the default event rate (see `catalogue`)."""
        return self.catalogue()

    def catalogue(self, event_rate: float | str | WithUnit | None = None, *, energy: bool = False) -> pd.DataFrame:
        """Return the slip events as a table, one row each: a slip event is a maximal interval with |v| above `event_rate`.

        That is a slip rate in m/s, or a text with a unit; the default is 1e-6 S (range of mu) / Z, for the block 1e-6 S (range of
        mu) / sqrt(K m); 0 takes every slip. With `energy` the table has the energies of each event (J/m^2; block: J), which take
        longer to compute. Columns and units are those of EVENT_COLUMNS and ENERGY_COLUMNS in
        `stickslip.solution.observables.event_table`.
        """
        from stickslip.solution.observables.event_table import events_table

        return events_table(self.history, self._rate(event_rate), energy)

    def _rate(self, event_rate: float | str | WithUnit | None) -> float:
        """Return the slip rate (m/s) that defines an event: the given one, or the default of the problem."""
        given = check_event_rate(event_rate, "Solution")
        return default_event_rate(self.problem) if given is None else given

    def energetics(self, event_rate: float | str | WithUnit | None = None) -> pd.DataFrame:
        """Return the energy budget of the slip events of `catalogue(event_rate)` as seismologists define it, one row per event.

        The columns are the parts of the energy (J/m^2; block: J), static and dynamic stress drop, overshoot, apparent stress and
        efficiencies; their units are in `stickslip.solution.observables.energetics.ENERGETICS_COLUMNS`.
        """
        from stickslip.solution.observables.energetics import energetics_table

        return energetics_table(self.history, self._rate(event_rate))

    def pulses(self, event_rate: float | str | WithUnit | None = None) -> pd.DataFrame:
        """Return the pulses of the slip events of `catalogue(event_rate)`, one row each.

        The columns are times, slip, largest slip rate, smallest traction and fracture energy; their units are in
        `stickslip.solution.observables.energy.pulses.PULSE_COLUMNS`.
        """
        from stickslip.solution.observables.energy.pulses import pulses_table

        return pulses_table(self.history, self._rate(event_rate))

    @cached_property
    def creep(self) -> pd.DataFrame:
        """The leaps over creep (`simulate(..., creep_rtol=...)`), one row each.

        Columns: start and end (s); start_row (whole round trips before the leap, without rounding); round_trips in it; error (bound
        of the error of slip at the landing, m); time_error (s: the error divided by the slip rate there; the following events may
        be early or late by this much).

        Notes
        -----
        Within a leap the slip is an average over round trips. It is right to within the error; the true slip oscillates around it
        by half of its growth in one round trip. Slip rate, traction and load are averages too.
        """
        from stickslip.engine import creep_table

        return creep_table(self.history)

    @property
    def creep_note(self) -> str:
        """One line on the leaps over creep; empty if there are none."""
        from stickslip.engine import creep_note

        return creep_note(self.history)

    def window(
        self,
        event: int | pd.Series = 0,
        before: float | str | WithUnit | None = None,
        after: float | str | WithUnit | None = None,
    ) -> Window:
        """Return the run around one slip event, in seconds since the event began.

        The event is a row number in `events` (negative ones count from the last), or a row of any `catalogue`. The window begins a
        tenth of the event's duration before its start, and ends 1.1 times its duration after that, unless `before` and `after` give
        other times (s, or texts with a unit). Local times are exact to their own rounding, however late in the run the event is.
        Raises InputError if there is no such event, and if `before` or `after` is not a finite time of the right sign.
        """
        from stickslip.solution.window import window_around

        return window_around(self, self._row(event), before, after)

    def _row(self, event: int | pd.Series) -> pd.Series:
        if not isinstance(event, int | np.integer):
            return event
        count = len(self.events)
        if not -count <= event < count:
            raise InputError(f"window: no event {event}: the run has {count}" + (f", 0 to {count - 1}" if count else ""))
        return self.events.iloc[event]

    def energy(self, t: ArrayLike) -> xr.Dataset:
        """Return the energies of the run at times (s) as differences from its start.

        See `stickslip.solution.observables.energy.balance.energy`.
        """
        from stickslip.solution.observables.energy.balance import energy

        return energy(self.history, t)

    def scenario(self, name: str = UNNAMED) -> Scenario:
        """Return the scenario of this run."""
        return Scenario(self.problem, **vars(self.options), name=name)

    def to_netcdf(self, path: str | Path) -> Path:
        """Write the solution to a netCDF file, and return the path; `stickslip.open_solution` restores it bit for bit."""
        from stickslip.solution.files.netcdf import write_solution

        return write_solution(self, path)

    @property
    def plot(self) -> SolutionPlots:
        """The figures: `plot()` draws the default one, `plot.energy()`, `plot.catalogue()` ... draw others."""
        return SolutionPlots(self)

    @property
    def span_text(self) -> str:
        """The time that the run reached and, if it ended early, the time that was asked for."""
        return how_long(self.duration, self.asked_duration)

    def events_in_words(self, digits: int = BRIEF_DIGITS) -> str:
        """Return the number of slip events, and what the largest did, with so many digits."""
        from stickslip.solution.account import events_in_words

        return events_in_words(self.events, self.problem, digits)

    @property
    def account(self) -> Account:
        """What is said of the run: how it went, and what is noted of it."""
        from stickslip.solution.account import Account

        notes = {
            "begun": self.begun_note,
            "reach": self.reach_note,
            "creep": self.creep_note,
            "lumping": self.lumping_note,
            "selection": self.selection_note,
            "short": self.short_note,
            "trapped": self.trapped_note,
            "predictability": self.horizon_note,
            "proven": self.proven.text,
            "rounding": self.rounding_note,
        }
        return Account(self.scenario(), self.status, self.duration, {word: note for word, note in notes.items() if note})

    @in_given_units
    def _lines(self) -> list[NamedLine]:
        """Return what is said of the run, with its body, law and loading, in lines of a name and a text."""
        problem, account = self.problem, self.account
        loading = ", ".join(f"{name.replace('_', ' ')} {text}" for name, text in problem.loading_texts.items())
        if not self.history.given:
            loading += f", initial load {brief(problem.load, problem.load_unit)}"
        return [
            ("body", repr(problem.body)),
            ("friction", problem.law_text),
            ("loading", loading),
            *account.lines(),
            ("events", self.events_in_words()),
            ("shocks", f"{len(self.shocks)}"),
            *account.noted(),
        ]

    @property
    def begun_note(self) -> str:
        """One line on the given wave with which the run began; empty if it began as its problem says."""
        return f"not that of the scenario: a given wave, until {brief(self.history.begun, 's')}" if self.history.given else ""

    @cached_property
    def reach(self) -> Reach:
        """How far the contact has gone: its displacement at the end (m, or rad), and the largest one with its time (s)."""
        from stickslip.engine import reach_of

        return reach_of(self.history)

    @property
    def reach_note(self) -> str:
        """One line on the slip at the end and the largest displacement."""
        return self.reach.text(self.problem)

    @cached_property
    def trapped_note(self) -> str:
        """One line on the energy of the waves that travel in the slab at the end of the run; empty for a block."""
        from stickslip.solution.observables.energy.balance import trapped_note

        return trapped_note(self.history)

    @cached_property
    def proven(self) -> ProofOfRun:
        """What is proven of the run: how far it misses the contact equation at any moment, and its other equations."""
        from stickslip.solution.observables.proof_of_run import proof_of_run

        return proof_of_run(self.history)

    @cached_property
    def _prediction(self) -> Predictability | None:
        from stickslip.solution.observables.predictability import is_followed, predictability

        return predictability(self) if is_followed(self.problem) else None

    @property
    def horizon_note(self) -> str:
        """One line on how long single events are predictable.

        It is empty if the growth of an error is not known for the problem (see `predictability`).
        """
        return self._prediction.text if self._prediction else ""

    @property
    def short_note(self) -> str:
        """What is proven, what energy is trapped in waves, and how long events are predictable, in one short line."""
        from stickslip.solution.observables.predictability import in_short

        return in_short(self.proven.short, self.trapped_note, self._prediction.short if self._prediction else "")

    @cached_property
    def rule_influence(self) -> RuleInfluence:
        """The shocks that the selection rule decided, and the first time when it had a choice."""
        from stickslip.solution.observables.rule_influence import rule_influence

        return rule_influence(self.history, lambda: self.curve("load"))

    @property
    def selection_note(self) -> str:
        """One line that says whether the result depends on the selection rule."""
        return self.rule_influence.note
