"""Say whether the series of another program passes, how far it is from the exact one, and which convention would explain that."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.conventions import Written
from stickslip.extensions.schemes.measures import COMPARED, MeasuredSeries
from stickslip.extensions.schemes.shocks import CELLS_NEAR_SHOCK, MADE
from stickslip.extensions.schemes.traits import ROUNDED_AWAY, traits_of
from stickslip.extensions.schemes.verdict import UNTOLD, RulePaths, travel_time
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief

TOLERANCE = 0.05
"""A series may be off by this share of the exact values, if no other is given."""
QUANTITIES_JUDGED = {"slip": "slip", "slip rate": "slip_rate", "traction": "traction"}
"""What a series has, each with the name that a problem knows its unit by."""
ROWS_ENOUGH = 20
"""So many rows for each shock are enough for that: nine of them, at most, lie beside it."""


@dataclass(frozen=True, eq=False)
class Judgement:
    """A series beside the exact solution under the problem's own selection rule, and the largest share that it may be off by."""

    measured: MeasuredSeries
    paths: RulePaths
    tolerance: float = TOLERANCE

    @property
    def name(self) -> str:
        """The name of the series."""
        return self.measured.series.name

    @cached_property
    def shares(self) -> dict[str, float]:
        """How far the series is from the exact one, for slip, slip rate, traction, and traction at rest.

        The mean distance in slip is a share of the largest slip, that in slip rate of the mean slip rate, and that in traction, in
        the whole and while the exact contact rests, of the range of traction; of traction itself, if that is constant. Slip rate
        and traction are compared away from shocks, and traction away from its jumps at rest.
        """
        return {name: share for what in QUANTITIES_JUDGED for name, share in self._shares(what, self._pairs[what][0]).items()}

    @cached_property
    def _pairs(self) -> dict[str, tuple[Floats, Floats]]:
        one = self.measured
        slip = one.exact.slip(one.time) - one.exact.problem.initial_slip
        found = (slip + one.gap, slip), (one.rate, one.exact_rate), (one.traction, one.exact_traction)
        return dict(zip(QUANTITIES_JUDGED, found, strict=True))

    def _unit_of(self, what: str) -> str:
        return self.measured.exact.problem.unit_of(QUANTITIES_JUDGED[what])

    def _shares(self, what: str, own: Floats) -> dict[str, float]:
        exact, away, weights = self._pairs[what][1], self.measured.away, self.measured.weights
        gap = np.abs(own - exact)
        if what == "slip":
            mean = float(np.trapezoid(gap, self.measured.time) / np.ptp(self.measured.time))
            return {what: _share(mean, float(np.abs(exact).max()) or self.paths.size.slip)}
        if what == "slip rate":
            return {what: _share(_mean(gap, away, weights), float(weights @ np.abs(exact)) or self.paths.size.rate)}
        away = self.measured.away_from_jumps
        rest, scale, largest = away & (self.measured.exact_rate == 0.0), float(np.ptp(exact)), float(np.abs(exact).max())
        if scale <= ROUNDED_AWAY * largest:  # traction is constant: its range is what rounding leaves
            scale = largest
        return {what: _share(_mean(gap, away, weights), scale), "traction at rest": _share(_mean(gap, rest, weights), scale)}

    @cached_property
    def faults(self) -> tuple[str, ...]:
        """What keeps the series from passing, one text each; none if it passes."""
        found = [f"{name} is off by {share:.2g}" for name, share in self.shares.items() if not share <= self.tolerance]
        row, rule = self.measured.row(), self.paths.followed(self.measured.series)
        own, exact = self.measured.exact.problem.rule, row["shocks"] + self._missed
        if rule != UNTOLD and own not in rule.split(" or "):
            found.append(f"the rule that it follows is {rule}, and not {own}")
        if row["shocks"] < exact:
            found.append(f"it makes {row['shocks']} of {exact} shocks")
        if self.measured.compared < COMPARED:
            found.append(self._unseen())
        if row["own_shocks"]:
            more = "a shock" if row["own_shocks"] == 1 else f"{row['own_shocks']} shocks"
            found.append(f"it makes {more} that the exact series does not have")
        return tuple(found)

    @property
    def _missed(self) -> int:
        """How many exact shocks are not made, of those that are larger than the slip rate may be off by, as a share of the largest.

        A series whose slip rate is off by more than half a shock need not pass the middle of it, and none that passes must.
        """
        least = self.tolerance * float(np.abs(self.measured.exact_rate).max())
        return sum(math.isnan(shock.time) and shock.jump > least for shock in self.measured.shocks)

    def _unseen(self) -> str:
        """Say that the series lies beside shocks for the most part, and what is enough."""
        one = self.measured
        shocks = sum(not math.isnan(shock.exact_time) for shock in one.shocks)
        enough = f"{ROWS_ENOUGH * shocks + 1} rows in equal steps are"
        if travel_time(one.series, one.exact) > one.series.step:
            each = 2.0 * CELLS_NEAR_SHOCK * one.exact.problem.body.time_to_driver / (COMPARED * one.until)
            enough = f"{math.ceil(each * shocks) + 1} cells are"
        beside = f"{np.count_nonzero(~one.away)} of its {one.time.size} rows lie beside shocks"
        return f"it is too coarse: {beside}, where slip rate and traction are not compared; {enough} enough"

    @property
    def passed(self) -> bool:
        """True if every share is within the tolerance, the rule is the problem's own, and the shocks are the exact ones."""
        return not self.faults

    @property
    def text(self) -> str:
        """Whether the series passes."""
        return f"{'passed' if self.passed else 'not passed'}, with a tolerance of {self.tolerance:g}: {self.name}"

    @property
    def reasons(self) -> str:
        """Why it does not pass, or how far it is off."""
        shares = "; ".join(f"{name} is off by {share:.2g}" for name, share in self.shares.items())
        return "; ".join(self.faults) or shares

    @property
    def texts(self) -> tuple[str, ...]:
        """All that is said of the series."""
        return (self.text, self.reasons, *self.hints, *self.traits)

    @cached_property
    def hints(self) -> tuple[str, ...]:
        """The conventions that explain what is off, or a step that is too long for the shocks, one sentence each."""
        if self.passed:
            return ()
        return tuple(self._written.sentences(self.name, "exact", self._unit_of)) or tuple(self._too_coarse())

    @cached_property
    def _written(self) -> Written:
        """The conventions that the series is written in, if it does not pass."""
        if self.passed:
            return Written(self._pairs)
        return Written.of(self._pairs, lambda what, own: max(self._shares(what, own).values()), self.tolerance)

    def _too_coarse(self) -> Iterator[str]:
        """Yield a sentence if shocks are wrong because they are too near to each other, or too short, for the series' steps."""
        one, times = self.measured, self.measured.exact.shocks.time.to_numpy(float)
        if not any("shock" in fault for fault in self.faults):
            return
        said = f"{self.name} is too coarse for its shocks: its step is {brief(one.series.step, 's')}, and"
        times = times[times <= one.until]
        wide, between = one.shadows(times), np.diff(times)
        nearest = float(between[between < wide[1:] + wide[:-1]].min(initial=math.inf))
        if nearest < math.inf:
            yield f"{said} exact shocks are as near as {brief(nearest, 's')}: write more times"
            return
        for shock in one.shocks:
            if math.isnan(shock.time):
                wide = one.shadows(np.array(shock.exact_time))
                sides = np.clip([shock.exact_time - wide, shock.exact_time + wide], 0.0, one.until)
                if abs(float(np.diff(one.exact.slip_rate(sides))[0])) < MADE * shock.jump:
                    yield f"{said} the exact slip rate turns back soon after {brief(shock.exact_time, 's')}: write more times"
                    return

    @cached_property
    def traits(self) -> tuple[str, ...]:
        """What the series shows of its program, whether it passes or not: ringing, a shift by a step, a wrong echo.

        They are looked for in the convention used here: half of the slip is not half of an echo.
        """
        one, written = self.measured, self._written
        if not written.found:
            return traits_of(one)
        slip, rate, traction = written.mended.values()
        return traits_of(replace(one, series=Series(one.time, slip, rate, traction, self.name, one.series.cells)))


def _mean(gap: Floats, which: NDArray[np.bool_], weights: Floats) -> float:
    """Return the mean over the time of some samples; 0 if there are none."""
    return float(weights[which] @ gap[which] / weights[which].sum()) if which.any() else 0.0


def _share(value: float, scale: float) -> float:
    return 0.0 if value == 0.0 else value / scale if scale > 0.0 else math.inf
