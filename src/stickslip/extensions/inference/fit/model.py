"""Runs of a problem under the loading of a record, and how far they are from it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from stickslip.engine import Side
from stickslip.extensions.inference.fit.asides import moved
from stickslip.extensions.inference.fit.free import DELAY, DRIFT, INITIAL_STATE, LOAD, SERVO, TREND, Free
from stickslip.extensions.inference.fit.memory import Memory, ResidualBlock, independent
from stickslip.extensions.inference.fit.part import Part, approached, changed, not_begun
from stickslip.extensions.inference.fit.turns import felt, moving
from stickslip.extensions.inference.record.record import SHEAR
from stickslip.extensions.inference.record.resample import RAMP, Jumps, jumps_in, spread, unsure
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.run import uninterrupted
from stickslip.run.simulate import simulate
from stickslip.solution import Solution
from stickslip.solution.observables import fronts_at_driver

OF_NO_ZERO = ("slip",)
"""Quantities with an arbitrary zero of the sensor: the mean of their residual is subtracted."""
JUMPING = (*SHEAR, "slip_rate", "drive_rate")
"""Quantities that may jump in a run."""
SMALLEST_JUMP_SPREAD = 0.1
"""Jumps higher than this many standard deviations are spread between samples."""
FAILED = 1e5
"""Residual, in standard deviations, of every sample of a failed run."""
LARGEST_RESIDUAL = 1e7
"""Largest residual, in standard deviations, so that squares and their sums stay finite."""
STEP_OF_DIFFERENCES = 2e-4
"""Longest step of differences, in searched numbers. Errors: the square of the step, and the noise of runs, 1e-8 over the step."""
NO_ROOM = 1e-10
"""If a limit leaves less room than this for a step, there is no difference to that side."""
CHANGED, ABOVE_NOISE = 0.5, 30.0
"""A fine step changes all residuals together by CHANGED standard deviations, or by ABOVE_NOISE times the noise of runs if more."""


@dataclass
class Model:
    """Residuals of a record, part by part, as a function of the searched numbers.

    `sizes` are the standard deviations (SI) of the observed quantities without a column of deviations; `memory` is the memory of
    their noise, in units of `sizes`. Each `every`-th sample is used. `step` is the step of differences, in searched numbers: one
    for all, or one each. Residuals are averaged over the share `smooth` of the samples, so that an event at a wrong time is felt
    from afar. A run that needs more than `max_pieces` has failed. A jump of a run is spread over `blur` samples. `unsure` is the
    standard deviation (SI) that the unknown time of a nearby jump gives each used sample, by part and quantity. `weight` is the
    exponent of the weight of samples after a change of the pull rate. `ran` is called after each run, and `tried`
    with the model, searched numbers and residuals after each trial. `of_means` is True if
    residuals are few means whose errors are known.
    """

    problem: Problem
    parts: tuple[Part, ...]
    free: tuple[Free, ...]
    rtol: float = 1e-8
    sizes: dict[str, float] = field(default_factory=dict)
    memory: dict[str, Memory] = field(default_factory=dict)
    every: int = 1
    step: float | Floats = STEP_OF_DIFFERENCES
    smooth: float = 0.0
    max_pieces: int = 20_000
    blur: int = RAMP
    unsure: dict[tuple[int, str], Floats] = field(default_factory=dict)
    weight: float = 0.0
    ran: Callable[[], object] = lambda: None
    tried: Callable[[Any, Floats, Floats], object] = lambda model, searched, residual: None
    _last: dict[int, tuple[bytes, Floats]] = field(default_factory=dict)
    of_means: ClassVar[bool] = False

    def values(self, searched: Floats) -> list[float]:
        """Return the free values (SI), within their limits."""
        return [min(max(one.natural(x), one.low), one.high) for one, x in zip(self.free, searched.tolist(), strict=True)]

    def at(self, searched: Floats, part: int) -> Problem:
        """Return the problem of a part at searched numbers. Raises InputError if there is none."""
        values = self.values(searched)
        own = {one.name: v for one, v in zip(self.free, values, strict=True) if one.part in (None, part)}
        first = {name: v for name, v in own.items() if name not in (LOAD, INITIAL_STATE)}
        asked = any(one.name == SERVO and one.part is None for one in self.free)
        this = moved(self.parts[part], own, asked=asked)
        begun = this.begun(changed(self.problem, first, not_begun))
        if this.loading is None and own.get(SERVO, 0.0) > 0.0:
            begun = replace(begun, pull_rate=approached(begun.pull_rate, own[SERVO]))
        return changed(begun, {name: v for name, v in own.items() if name in (LOAD, INITIAL_STATE)})

    def solve(self, searched: Floats, part: int, rtol: float | None = None) -> Solution | None:
        """Return the run of a part, or None if it failed. Raises KeyboardInterrupt after Ctrl-C."""
        delay = self._own(searched, part).get(DELAY, 0.0)
        try:
            problem = self.at(searched, part)
            lasts = self.parts[part].duration + max(0.0, -delay)
            run = uninterrupted(simulate(problem, lasts, self.rtol if rtol is None else rtol, max_pieces=self.max_pieces))
        except (InputError, ArithmeticError):
            return None
        self.ran()
        return run if run.status.ok and run.history.span[1] >= lasts * (1.0 - 1e-12) else None

    def _own(self, searched: Floats, part: int) -> dict[str, float]:
        return {one.name: v for one, v in zip(self.free, self.values(searched), strict=True) if one.part in (None, part)}

    def curves(self, run: Solution, searched: Floats, part: int, every: int = 1) -> dict[str, Floats]:
        """Return the values that would be measured in a run at each sample, by the name of the quantity (SI)."""
        this, own = self.parts[part], self._own(searched, part)
        time = np.clip(this.record.clock[::every] - own.get(DELAY, 0.0), 0.0, run.history.span[1])
        found, shift = {}, own.get(DRIFT, 0.0) * this.record.clock[::every]
        if TREND in own:
            slip = run.slip(time)
            shift = shift + own[TREND] * (slip - slip[0])
        for name in this.observed:
            values = measured(run, name, this.sensor, time)
            if name in JUMPING:
                values = spread(values, time, self.jumps(run, part, name), self.blur)
            if name == "friction":
                values = values + shift
            elif name in SHEAR:
                values = values + shift * run.problem.normal_at(time)
            found[name] = values
        return found

    def jumps(self, run: Solution, part: int, name: str) -> Jumps:
        """Return the jumps of a quantity in a run that move as its numbers change: those of slip events."""
        this, least = self.parts[part], SMALLEST_JUMP_SPREAD * self.sizes.get(name, 0.0)
        step = self.every * this.record.clock[-1] / max(len(this.record) - 1, 1)
        breaks = breaks_of(run, is_at_driver(name, this.sensor))[1:-1]
        found = jumps_in(lambda time, side: measured(run, name, this.sensor, time, side), breaks, least, step)
        return moving(found, felt(run.problem, this.duration, step), step)

    def with_jumps(self, searched: Floats) -> Model:
        """Return the model with added uncertainty for samples beside a jump, whose time lies somewhere between two samples."""
        model, added = self.with_(unsure={}), dict[tuple[int, str], Floats]()
        for i, part in enumerate(self.parts):
            run = model.solve(searched, i)
            if run is None:
                continue
            time = part.record.clock[:: self.every] - self._own(searched, i).get(DELAY, 0.0)
            for name in part.observed:
                jumps = model.jumps(run, i, name) if name in JUMPING else None
                if jumps is not None and len(jumps.time):
                    added[i, name] = unsure(time, self.data(i, name)[:: self.every], jumps)
        return self.with_(unsure=added)

    def data(self, part: int, name: str) -> Floats:
        """Return the measured values of a quantity in a part (SI); slip is counted from the first sample."""
        values = self.parts[part].record.measured[name]
        return np.asarray(values - self.parts[part].first[name][0]) if name in OF_NO_ZERO else values

    def _deviations(self, part: int, name: str) -> Floats | float:
        given = self.parts[part].record.deviations.get(name)
        relative = self.parts[part].record.relative
        scale: Floats | float = self.sizes[name]
        for factor in (given, relative):
            scale = scale if factor is None else factor[:: self.every] * scale
        added = self.unsure.get((part, name))
        scale = scale if added is None else np.hypot(scale, added)
        return scale / self.weights(part) if self.weight else scale

    def weights(self, part: int) -> Floats:
        """Return the weight of each used sample of a part."""
        if not self.weight:
            return np.ones(len(self.parts[part].record.clock[:: self.every]))
        return self.parts[part].weights(self.problem, self.weight)[:: self.every]

    def part_residual(self, searched: Floats, part: int) -> Floats:
        """Return the residuals of a part in standard deviations: model minus data, quantity after quantity."""
        key = searched.tobytes()
        if self._last.get(part, (b"",))[0] != key:
            self._last[part] = key, self._new_residual(searched, part)
        return self._last[part][1]

    def _new_residual(self, searched: Floats, part: int) -> Floats:
        run = self.solve(searched, part)
        wanted = {name: self.data(part, name)[:: self.every] for name in self.parts[part].observed}
        if run is None:
            return np.concatenate([np.full(int(np.isfinite(y).sum()), FAILED) for y in wanted.values()])
        with np.errstate(all="ignore"):
            curves = self.curves(run, searched, part, self.every)
            pieces = []
            for name, y in wanted.items():
                scale = np.broadcast_to(self._deviations(part, name), y.shape)
                known = np.isfinite(y)
                curve, data = curves[name][known], y[known]
                rest = curve - data
                rest = (rest - np.mean(rest) if name in OF_NO_ZERO else rest) / scale[known]
                rest = averaged(rest, round(self.smooth * len(rest))) if self.smooth else rest
                pieces.append(np.clip(np.where(np.isfinite(rest), rest, FAILED), -LARGEST_RESIDUAL, LARGEST_RESIDUAL))
        return np.concatenate(pieces)

    def blocks(self, part: int) -> list[tuple[str, ResidualBlock]]:
        """Return the rows of each quantity among the residuals of a part, and their times."""
        found, begin = [], 0
        clock = self.parts[part].record.clock[:: self.every]
        for name in self.parts[part].observed:
            time = clock[np.isfinite(self.data(part, name)[:: self.every])]
            found.append((name, ResidualBlock(slice(begin, begin + len(time)), time)))
            begin += len(time)
        return found

    def priors(self, searched: Floats) -> Floats:
        """Return the distances from the priors, in standard deviations, times the root of samples per independent sample.

        The factor balances the residuals, which are correlated but counted as if they were independent.
        """
        values = zip(self.free, self.values(searched), strict=True)
        found = [one.prior.residual(v) for one, v in values if one.prior is not None and one.prior.kind != "uniform"]
        return np.asarray(np.clip(math.sqrt(self.inflation) * np.array(found, float), -LARGEST_RESIDUAL, LARGEST_RESIDUAL))

    def residual(self, searched: Floats) -> Floats:
        """Return all residuals, those of the priors last."""
        rest = np.concatenate([self.part_residual(searched, i) for i in range(len(self.parts))])
        self.tried(self, searched, rest)
        return np.concatenate([rest, self.priors(searched)])

    def jacobian(self, searched: Floats, *, sides: Sequence[float] = (1.0, -1.0)) -> Floats:
        """Return the derivatives of all residuals with respect to the searched numbers, by differences.

        A number of one part needs runs of that part only, and one that was not asked for a step to one side. If the run on one side
        fails, the difference is taken on the other.
        """
        lows, highs = self.limits
        base = [self.part_residual(searched, i) for i in range(len(self.parts))]
        counts = [len(one) for one in base]
        begins = np.append(0, np.cumsum(counts))
        result = np.zeros((int(begins[-1]) + len(self.priors(searched)), len(self.free)))
        steps = np.broadcast_to(self.step, len(self.free))
        for column, one in enumerate(self.free):
            stepped = []
            for side in sides[:1] if one.aside else sides:
                x = searched.copy()
                x[column] = min(max(x[column] + side * float(steps[column]), lows[column]), highs[column])
                stepped.append(x)
            for i in range(len(self.parts)) if one.part is None else (one.part,):
                result[begins[i] : begins[i + 1], column] = self._difference(searched, stepped, column, i, base[i])
            result[begins[-1] :, column] = self._prior_slope(stepped, searched, column)
        return result

    def fine(self, searched: Floats) -> Model:
        """Return the model with steps of differences inside the uncertainty: a sharp event bends residuals within longer steps."""
        change, steps = max(CHANGED, ABOVE_NOISE * self.noise), np.full(len(self.free), STEP_OF_DIFFERENCES)
        for _ in range(3):  # across a bend a long step gives too small a slope, and so too long a next step
            sizes = np.linalg.norm(self.with_(step=steps).jacobian(searched, sides=(1.0,)), axis=0)
            shorter = np.minimum(change / np.maximum(sizes, 1e-300), steps)
            if np.all(shorter > 0.5 * steps):
                break
            steps = shorter
        return self.with_(step=steps)

    @property
    def noise(self) -> float:
        """The error of all runs together, in standard deviations, as expected from their tolerance."""
        return self.rtol * math.sqrt(sum(self._squares(i) for i in range(len(self.parts))))

    def _squares(self, part: int) -> float:
        """Return the sum of squares of the measured values of a part, in standard deviations."""
        names = self.parts[part].observed
        return sum(float(np.nansum((self.data(part, name)[:: self.every] / self._deviations(part, name)) ** 2)) for name in names)

    def _difference(self, searched: Floats, stepped: list[Floats], column: int, part: int, base: Floats) -> Floats:
        ends = []
        for x in stepped:
            if abs(x[column] - searched[column]) > NO_ROOM:
                rest = self._new_residual(x, part)
                if len(rest) and not np.all(rest == FAILED):
                    ends.append((x[column], rest))
        if len(ends) < 2 and not np.all(base == FAILED):
            ends.append((searched[column], base))
        if len(ends) < 2 or ends[0][0] == ends[1][0]:
            return np.zeros(len(base))
        (x1, r1), (x2, r2) = ends[0], ends[1]
        by = (r1 - r2) / (x1 - x2)
        return np.where((np.abs(r1) < FAILED) & (np.abs(r2) < FAILED), by, 0.0)

    def _prior_slope(self, stepped: list[Floats], searched: Floats, column: int) -> Floats:
        ends = [x for x in (*stepped, searched) if x is searched or x[column] != searched[column]]
        first, second = ends[0], ends[1] if len(ends) > 1 else ends[0]
        width = first[column] - second[column]
        return (self.priors(first) - self.priors(second)) / width if width else 0.0 * self.priors(first)

    @property
    def limits(self) -> tuple[Floats, Floats]:
        """The searched numbers at the limits of the free values."""
        low = [one.searched(one.low) for one in self.free]
        high = [one.searched(one.high) for one in self.free]
        return np.array(low, float), np.array(high, float)

    @property
    def begin(self) -> Floats:
        """The searched numbers where the search begins."""
        low, high = self.limits
        return np.clip([one.searched(one.start) for one in self.free], low, high)

    @property
    def given(self) -> Floats:
        """The searched numbers as the problem gives them, for those that start elsewhere."""
        low, high = self.limits
        return np.clip([one.searched(one.start if one.given is None else one.given) for one in self.free], low, high)

    @property
    def samples(self) -> int:
        """The number of fitted values."""
        return sum(block.rows.stop - block.rows.start for i in range(len(self.parts)) for _, block in self.blocks(i))

    @property
    def counted(self) -> str:
        """What is fitted, as text."""
        return f"{self.samples} samples"

    @property
    def independent(self) -> float:
        """The effective number of independent samples, given the memory of the noise."""
        blocks = [one for i in range(len(self.parts)) for one in self.blocks(i)]
        return sum(independent(block.time, self.memory[name]) if name in self.memory else len(block.time) for name, block in blocks)

    @property
    def scatter(self) -> float:
        """The sum of squares of the measured values about their means, in standard deviations."""
        total = 0.0
        for i, part in enumerate(self.parts):
            for name in part.observed:
                values = self.data(i, name)[:: self.every]
                total += float(np.nansum(((values - np.nanmean(values)) / self._deviations(i, name)) ** 2))
        return total

    @property
    def inflation(self) -> float:
        """The number of samples per independent sample."""
        return self.samples / self.independent if self.memory else 1.0

    def variance(self, searched: Floats) -> float:
        """Return the factor on the covariance of the numbers, besides the size of the noise: 1."""
        return 1.0

    def thinned(self, most: int) -> Model:
        """Return the same model on about `most` samples, but at least 200 of the longest part."""
        longest = max(len(part.record) for part in self.parts)
        return self.with_(every=max(1, -(-longest // max(most // len(self.parts), 200))), unsure={})

    def with_(self, **others: Any) -> Model:
        """Return the model with other settings."""
        return replace(self, **others, _last={})


def measured(run: Solution, name: str, sensor: str, time: Floats, side: Side = "right") -> Floats:
    """Return a quantity in a run at some times (SI), as a sensor at the contact, behind the spring or at the driver measures it."""
    if name == "slip":
        return run.slip(time) - run.problem.initial_slip
    if name == "slip_rate":
        return run.slip_rate(time, side)
    if name == "drive_rate":
        return run.drive_rate(time, side)
    behind = is_at_driver(name, sensor) or sensor == "spring"
    force = run.drive_traction(time, side) if behind else run.traction(time, side)
    return force / run.problem.normal_at(time) if name == "friction" else force


def is_at_driver(name: str, sensor: str) -> bool:
    """Return True for a quantity that is measured at the driver, by its name or as the sensor of shear says."""
    return name in ("surface_torque", "drive_rate") or (sensor == "drive" and name in SHEAR)


def breaks_of(run: Solution, at_driver: bool) -> Floats:
    """Return the times (s) when another piece of a run begins to hold at the contact, or at the driver; the run's ends, too."""
    return fronts_at_driver(run.history) if at_driver else run.breaks


def averaged(rest: Floats, width: int) -> Floats:
    """Return running means of `width` residuals, times the root of that number, so that white noise keeps its size."""
    if width < 2:
        return rest
    sums = np.append(0.0, np.cumsum(np.clip(np.nan_to_num(rest, nan=FAILED), -LARGEST_RESIDUAL, LARGEST_RESIDUAL)))
    ends = np.clip(np.arange(len(rest)) + width // 2 + 1, 0, len(rest))
    begins = np.clip(np.arange(len(rest)) - (width - 1) // 2, 0, len(rest))
    return np.asarray((sums[ends] - sums[begins]) / np.sqrt(ends - begins))
