"""Results on steady sliding: each steady motion, the changes of its stability, and sentences about them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar, Unpack

import numpy as np

from stickslip.foundation.constants import YEAR
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import si_unit
from stickslip.foundation.show import ShownAsTable, brief, brief_repr, exactly
from stickslip.problem import in_given_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stickslip.foundation.place import Place
    from stickslip.problem import Problem

RATES = np.geomspace(1e-15, 1e3, 73)
"""Slip rates (m/s) for examining the stability of a law with states, four a decade; changes are then found to rounding. Slower
rates, below 30 nm a year, are left out: there the slip law is made smooth, which would look like a change."""
NEVER = 1e-20
"""At this growth rate (1/s) a disturbance grows by less than half a per cent in the age of the universe."""


@dataclass(frozen=True)
class Sliding:
    """One steady sliding motion: slip rate and traction with their signs, and what a small disturbance does."""

    rate: float
    traction: float
    states: tuple[float, ...]
    """The states of the law, as users see them, in the direction of slip."""
    stable: bool | None
    """True if every small disturbance fades, False if one grows, None if one keeps its size, or if it is not decided."""
    growth: float
    """Growth rate (1/s) of the disturbance that grows fastest or fades most slowly; nan if it is not decided.

    It is inf if the contact has no mass and friction falls with the slip rate faster than waves carry away: nothing stays at
    such a rate. It is 0 if disturbances keep their size, or fade ever more slowly at ever higher frequencies.
    """
    period: float
    """Period (s) with which that disturbance swings, inf if it does not."""

    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = {"rate": "slip_rate", "traction": "load", "growth": "1/s", "period": "s"}
    __repr__ = brief_repr

    @property
    def lasts(self) -> bool:
        """True if the contact stays at this rate: sliding is stable, or a disturbance takes for ever to grow."""
        return self.stable is True or 0.0 < self.growth <= NEVER

    @property
    def verdict(self) -> str:
        """The word for `stable`: stable, unstable, neutral or not decided."""
        if self.stable is None and math.isnan(self.growth):
            return "not decided"
        return "neutral" if self.stable is None else "stable" if self.stable else "unstable"

    def __str__(self) -> str:
        if self.growth == math.inf:
            return "unstable at once: friction falls faster with the slip rate than waves carry away"
        if math.isnan(self.growth):
            known = {True: "every small disturbance fades", False: "a small disturbance grows"}
            if self.stable is None:
                return "not decided: too many modes, or one of them so close to keeping its size that rounding decides"
            return f"{self.verdict}: {known[self.stable]}, how fast is not decided"
        if self.stable is None:
            return "neutral: a small disturbance neither grows nor fades"
        swings = f", with a period of {self.period:.6g} s" if 0.0 < self.period < math.inf else ""
        if self.growth == 0.0:
            return "stable: every small disturbance fades, but the faster it swings, the more slowly"
        does = "fades" if self.stable else "grows"
        size = "at once" if math.isinf(self.growth) else f"at {abs(self.growth):.6g} /s"
        slowly = f", by a factor e in {brief(1.0 / self.growth / YEAR, '1', 2)} years" if 0.0 < self.growth <= NEVER else ""
        return f"{self.verdict}: a small disturbance {does} {size}{slowly}{swings}"


@dataclass(frozen=True)
class StabilityChange:
    """A slip rate (m/s) where steady sliding gains or loses its stability, and the pull rate (m/s) that leads to it."""

    rate: float
    pull_rate: float | None
    """None under a dead load, which does not feel the pull rate."""
    stable_above: bool
    """True if sliding a little faster is stable."""
    enclosure: tuple[float, float] | None = None
    """Interval of slip rates (m/s) with a proof that it holds the change; None without a proof."""

    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = dict.fromkeys(("rate", "pull_rate", "enclosure"), "slip_rate")
    __repr__ = brief_repr


@dataclass(frozen=True)
class FromRest:
    """Outcome of exact runs from rest at pull rates with stable steady sliding; rates (m/s) without their sign."""

    sticks_at: float | None
    """The highest pull rate (m/s) of a run that still stuck; None if the run just above the critical rate slid already."""
    slides_at: float | None
    """The lowest pull rate (m/s) of a run that came to slide without rest; None if none did."""
    runs: int
    duration: float
    """Duration of each run (s)."""
    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""
    stopped_at: float | None = None
    """The pull rate (m/s) of a run that met its limit before its end, so that nothing is known there; None if none did."""
    fastest: float | None = None
    """The pull rate (m/s) that would make the body slide as fast as its waves run, if the runs went up to it; else None."""

    units: ClassVar = dict.fromkeys(("sticks_at", "slides_at", "stopped_at", "fastest"), "slip_rate") | {"duration": "s"}
    __repr__ = brief_repr

    def __str__(self) -> str:
        by = f"by {self.runs} exact run{'s' * (self.runs > 1)} of {brief(self.duration, 's', 3)}"
        if self.sticks_at is None:
            return self._unless_it_sticks(by)
        sticks = self._rate(self.sticks_at)
        if self.stopped_at is not None:
            also = "" if self.slides_at is None else f" and slides at {self._rate(self.slides_at)}"
            still = "still sticks" if self.slides_at is None else "sticks"
            return f"from rest it {still} at {sticks}{also} ({by}); {self._unknown}"
        if self.slides_at is not None:
            return f"from rest it sticks up to {sticks} (to {100.0 * FROM_REST_WITHIN:g} %, {by})"
        if self.fastest is not None:
            return f"from rest it sticks at every rate that was tried, up to {sticks}, as fast as its waves run ({by})"
        return f"from rest it still sticks at {sticks} ({by}; stickslip find looks further)"

    def _unless_it_sticks(self, by: str) -> str:
        """Return the sentence if no run stuck."""
        if self.slides_at is not None:
            return f"from rest it slides at {self._rate(self.slides_at)}, too ({by})"
        if self.fastest is not None:
            return f"from rest: not examined, because waves run at {self._rate(self.fastest)} only"
        return "from rest: not known, because a run did not reach its end"

    @property
    def _unknown(self) -> str:
        assert self.stopped_at is not None
        return f"at {self._rate(self.stopped_at)} it is not known, because a run met its limit before its end"

    def _rate(self, value: float) -> str:
        return brief(value, si_unit("slip_rate", self.load_unit), 3)


FROM_REST_WITHIN = 0.02
"""The highest pull rate that lets a contact stick from rest is found to this relative width."""


@dataclass(frozen=True, repr=False)
class SteadySlidings(ShownAsTable):
    """All steady sliding motions of a problem at its pull rate, and the rates where their stability changes."""

    pull_rate: float
    """The (first) pull rate V (m/s)."""
    far_stress: float | None
    """The stress far beyond a driver of finite impedance (Pa), None for a driver that does not give way."""
    slidings: tuple[Sliding, ...]
    """Slowest first; at most one if the driver does not give way."""
    changes: tuple[StabilityChange, ...]
    """Slowest first."""
    can_rest: bool
    """True if a driver of finite impedance does not pull hard enough to free a contact that rests."""
    proven: bool
    """True if interval arithmetic shows that there are no other changes."""
    sticks: bool = False
    """True if the law lets the contact rest."""
    varies: bool = False
    """True if the pull rate or the far stress varies in time: all results are then for its value at the start."""
    is_damped: bool = True
    """False if something slides, and neither body nor driver takes energy from a disturbance, so that only friction can."""
    why_none: str = ""
    """Reason why there is no steady sliding; "" if there is."""
    traction_at_pull_rate: float = math.nan
    """The far stress (Pa) with which a contact slides at the pull rate behind a driver that gives way: friction and drag there."""
    unit: str = "Pa"
    """Unit of tractions."""
    is_calm: bool = False
    """True if the contact can come slowly from its start to `settled`, provided that no slower rate is unstable."""
    problem: Problem | None = field(default=None, compare=False)
    """The problem that was asked about."""
    from_rest: FromRest | None = None
    """Motion from rest at pull rates with stable steady sliding; None if it was not examined."""

    @property
    def is_pressed(self) -> bool:
        """True if the normal load varies in time: all results are then for its value at the start."""
        return self.problem is not None and self.problem.normal_varies

    @property
    def regained(self) -> float | None:
        """The critical pull rate (m/s, magnitude) if sliding is stable above it, though a contact from rest may stick; or None."""
        last = self.changes[-1] if self.changes else None
        if not self.sticks or self.varies or self.is_pressed or last is None or not last.stable_above or last.pull_rate is None:
            return None
        is_against = self.far_stress is not None and last.pull_rate * self.pull_rate <= 0.0
        return None if is_against else abs(last.pull_rate)

    @property
    def settled(self) -> Sliding | None:
        """The end of every slow motion: the steady sliding that lasts, if there is exactly one and rest is not possible."""
        lasting = [one for one in self.slidings if one.lasts]
        return lasting[0] if len(lasting) == 1 and not self.can_rest else None

    @in_given_units
    def plot(self, **place: Unpack[Place]) -> Figure | Axes:
        """Plot friction of steady sliding against the slip rate: where it is stable, this motion, critical rates, hysteresis.

        The keywords `ax`, `figure`, `size` and `dpi` say where to draw, and how large, as for `solution.plot()`. Raises InputError
        if nothing slides steadily.
        """
        from stickslip.figures.contact import steady
        from stickslip.figures.sheet import known_to_pyplot

        self.check_drawn("plot")
        return known_to_pyplot(steady.draw_steady(steady.steady_data(self), **place), place)

    def check_drawn(self, where: str) -> None:
        """Raise InputError, which begins with `where`, if there is no steady sliding that could be drawn."""
        if not self.slidings:
            raise InputError(f"{where}: no steady sliding: {self.why_none}")

    def _lines(self) -> list[tuple[str]]:
        return [(line,) for line in self.lines()]

    def __str__(self) -> str:
        return " ".join(f"{line[0].upper()}{line[1:]}." for line in self.lines())

    @in_given_units
    def lines(self) -> list[str]:
        """Return sentences for users, without a capital and without a full stop."""
        if self.why_none:
            return [f"none: {self.why_none}"]
        at = "at the first pull rate, " if self.varies else "at "
        at = f"under the first normal load, {at}" if self.is_pressed else at
        found = [f"{at}{brief(one.rate, self._rate)}, traction {brief(one.traction, self.unit)}: {one}" for one in self.slidings]
        if self.is_calm and self.settled and all(one.rate > abs(self.settled.rate) for one in self.changes):
            found.append(slides_on(self.settled, is_driven_rigidly=self.far_stress is None, unit=self._rate))
        rests = "at rest: the driver does not pull hard enough to free a contact that sticks" if self.can_rest else ""
        found += [self._given_way(), rests]
        if not self.is_damped and any(one.stable is False for one in self.slidings):
            found.append("neither body nor driver damps: it is unstable wherever friction falls with the slip rate, however gently")
        return [line for line in [*found, self._changes()] if line]

    def _given_way(self) -> str:
        """Return a sentence on a contact that does not slide at the pull rate, because the driver gives way."""
        others = [one for one in self.slidings if not math.isclose(one.rate, self.pull_rate, rel_tol=1e-9, abs_tol=0.0)]
        if self.far_stress is None or not others:
            return ""
        far, pull = brief(self.far_stress, self.unit), brief(self.pull_rate, self._rate)
        return (
            f"not at the pull rate of {pull}, because the driver gives way: the far stress, which holds the initial load unless"
            f' given, is {far}; far_stress = "{brief(self.traction_at_pull_rate, self.unit, 9)}" makes it slide at the pull rate'
        )

    def _changes(self) -> str:
        """Return a sentence on the critical rates and their proof."""
        if not self.changes and self.proven and self.slidings:
            said = f"{self.slidings[0].verdict} at any other slip rate{self._way}, too (proven{self._searched})"
            return said * (len(self.slidings) == 1)
        if not self.changes:
            return ""
        hint = "" if self.regained is None else "; from rest it may stick at a higher rate all the same: stickslip find"
        hint = hint if self.from_rest is None else f"; {self.from_rest}"
        how = f"proven by interval arithmetic{self._searched}" if self.proven else f"found{self._searched}, not proven"
        return f"{self._way[1:]}{': ' * bool(self._way)}{', '.join(self._ranges())} ({how}){hint}"

    def _ranges(self) -> Iterator[str]:
        """Yield the words for each range of rates between two changes, and for the ranges below and above all of them."""
        first, last, words = self.changes[0], self.changes[-1], ("unstable", "stable")
        rates = [exactly(one.rate, self._rate) for one in self.changes]
        yield f"{words[not first.stable_above]} below {self._place(first)}"
        for one, low, high in zip(self.changes[1:], rates, rates[1:], strict=False):
            yield f"{words[not one.stable_above]} from {low} to {high}{self._pulled(one)}"
        yield f"{words[last.stable_above]} above{f' {rates[-1]}' * (len(rates) > 1)}"

    @property
    def _rate(self) -> str:
        """The unit of slip rates."""
        return si_unit("slip_rate", self.unit)

    @property
    def _way(self) -> str:
        """The direction of slip that the results are for, if friction differs in the other one."""
        differs = self.problem is not None and self.problem.friction.backward_from and self.slidings
        return "" if not differs else " backwards" if self.slidings[0].rate < 0.0 else " forwards"

    @property
    def _searched(self) -> str:
        """The words for the slip rates that were examined, if not all were."""
        has_states = self.problem is not None and self.problem.friction.states
        return f" between {RATES[0]:g} and {RATES[-1]:g} {self._rate}" if has_states or not self.proven else ""

    def _place(self, change: StabilityChange) -> str:
        """Return the words for where stability changes."""
        of = "pull" if change.pull_rate == change.rate else "slip"
        return f"a {of} rate of {exactly(change.rate, self._rate)}{self._pulled(change)}"

    def _pulled(self, change: StabilityChange) -> str:
        """Return the words for the pull rate that leads to a change, if it is not the slip rate."""
        if change.pull_rate is None or change.pull_rate == change.rate:
            return ""
        is_back = self.far_stress is not None and change.pull_rate * self.pull_rate < 0.0
        back = " (the driver would have to move back)" if is_back else ""
        return f", at a pull rate of {exactly(change.pull_rate, self._rate)}{back}"


def driven_at(rate: float, *, is_driven_rigidly: bool, unit: str = "m/s") -> str:
    """Return the words for the slip rate (in `unit`) of steady sliding: that of the driver, if it does not give way."""
    return "the driver's rate" if is_driven_rigidly else brief(abs(rate), unit)


def slides_on(sliding: Sliding, *, is_driven_rigidly: bool, unit: str = "m/s") -> str:
    """Return a sentence without its subject, a contact that slides steadily and stays at this rate."""
    how = "steadily and stably" if sliding.stable else "steadily"
    return f"slides {how} at {driven_at(sliding.rate, is_driven_rigidly=is_driven_rigidly, unit=unit)}: no event will come"
