"""What a series shows of the program that wrote it: ringing, a shift by a step, and waves that come back as they should not.

These are named whether or not the series passes. A series that is right shows none of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.schemes.conventions import EXPLAINS
from stickslip.extensions.schemes.echoes.asked import LARGEST_WORK, Echoes, echoes_of
from stickslip.extensions.schemes.measures import MeasuredSeries
from stickslip.extensions.schemes.verdict import RulePaths
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.problem import Problem

ROUNDED_AWAY = 1e-6
"""A distance below this share of the exact values (1) has no cause that is looked for: files have so many digits."""
SMALLEST_SWING, FEWEST_SWINGS = 0.02, 8
"""A series rings if its slip rate swings about the exact one by more than this share of the largest, so many times in a row."""
LONGEST_PERIOD, SMALLEST_REGULAR = 12.0, 0.5
"""A mesh rings within so many steps, and so regularly that two samples foretell at least this share of the next one."""
SHIFTS = {-1.0: "a step early", -0.5: "half a step early", 0.5: "half a step late", 1.0: "a step late"}
"""Shifts in time that are looked for, in steps."""
FEWEST_SAMPLES = 10
"""A shift shows in at least so many samples, and explains most of them."""
LARGEST_HALF = 0.7
"""A quantity jumps if half the time brings more than this share of its change."""
SMALLEST_MISS = 0.01
"""Look for another echo if the load differs from what the echoes bring by more than this share of its range."""
FEWEST_STEPS = 200
"""Follow waves in at least so many steps, if those of the series are as short."""


def ringing(one: MeasuredSeries) -> Iterator[str]:
    """Yield a sentence if the slip rate swings about the exact one again and again, within few steps, and not as noise does."""
    gap, time = one.rate - one.exact_rate, one.time
    least = SMALLEST_SWING * float(np.abs(one.exact_rate).max())
    slope = np.sign(np.diff(gap))
    turns = 1 + np.flatnonzero(slope[1:] * slope[:-1] < 0.0)
    turns = turns[one.away[turns]]
    swings = np.abs(np.diff(gap[turns])) > least
    long = _longest(swings)
    if long.stop - long.start < FEWEST_SWINGS:
        return
    at = turns[long.start : long.stop + 1]
    steps = 2.0 * float(np.median(np.diff(time[at]))) / one.series.step
    if steps <= LONGEST_PERIOD and _regular(gap[at[0] : at[-1] + 1]) >= SMALLEST_REGULAR:
        size = 0.5 * float(np.median(np.abs(np.diff(gap[at]))))
        unit = one.exact.problem.unit_of("slip_rate")
        yield (
            f"{one.series.name} rings from {brief(float(time[at[1]]), 's')} on: its slip rate swings about the exact one by "
            f"{brief(size, unit, 2)}, {long.stop - long.start} times, with a period of {steps:.3g} steps"
        )


def _regular(gap: Floats) -> float:
    """Return the share of the variance of each sample that a linear rule tells from the two before it: 1 of swings, 0 of noise."""
    known = np.stack([np.ones(gap.size - 2), gap[1:-1], gap[:-2]], axis=1)
    left = gap[2:] - known @ np.linalg.lstsq(known, gap[2:], rcond=None)[0]
    return 1.0 - float(np.sum(left**2)) / (gap.size - 5) / float(np.var(gap[2:]))


def _longest(true: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> slice:
    """Return the longest run of values that are true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], true.astype(int), [0]])))
    starts, ends = edges[::2], edges[1::2]
    if not starts.size:
        return slice(0, 0)
    k = int(np.argmax(ends - starts))
    return slice(int(starts[k]), int(ends[k]))


def shifted(one: MeasuredSeries) -> Iterator[str]:
    """Yield a sentence if slip, slip rate or traction would be right at times that are half a step or a step away."""
    exact = one.exact
    own = {"slip": one.series.slip[: one.time.size] + exact.problem.initial_slip, "slip rate": one.rate, "traction": one.traction}
    found: dict[str, list[str]] = {}
    for name, values in own.items():
        at: Callable[[Floats], Floats] = getattr(exact, name.replace(" ", "_"))
        kept = _inside(one) if name == "slip" else _inside(one) & one.away
        best = _shift(at, one, values, kept)
        if best is not None:
            best = _shift(at, one, values, kept & _is_smooth(at, one))
        if best is not None:
            found.setdefault(SHIFTS[best], []).append(name)
    for words, names in found.items():
        listed = f"{', '.join(names[:-1])}{' and ' if len(names) > 1 else ''}{names[-1]}"
        yield f"{one.series.name} has its {listed} {words}: write the values of the time that stands beside them"


def _shift(at: Callable[[Floats], Floats], one: MeasuredSeries, values: Floats, kept: NDArray[np.bool_]) -> float | None:
    """Return the shift (steps) that explains what is off in some samples; None if none does, or if only few of them are off."""
    if not kept.any():
        return None
    exact, last = at(one.time), one.exact.history.span[1]
    moved = {shift: at(np.clip(one.time - shift * one.series.step, 0.0, last)) for shift in SHIFTS}
    left = {shift: float(np.abs(values - there)[kept].mean()) for shift, there in moved.items()}
    off, best = np.abs(values - exact), min(left, key=lambda shift: left[shift])
    least, mean = ROUNDED_AWAY * float(np.abs(exact).max()), float(off[kept].mean())
    changes = kept & (np.abs(moved[best] - exact) > least)
    explained = np.abs(values - moved[best])[changes] < EXPLAINS * off[changes]
    many = changes.sum() >= FEWEST_SAMPLES and 2 * explained.sum() > changes.sum()
    return best if many and mean > least and left[best] < EXPLAINS * mean else None


def _is_smooth(at: Callable[[Floats], Floats], one: MeasuredSeries) -> NDArray[np.bool_]:
    """Return where an exact quantity has no jump within a step and a half: there half the time brings half the change.

    Traction jumps at rest, too, when a wave of it arrives. Beside a jump a series that is right may have the value before it or
    after it, since its times are rounded, and so are travel times.
    """
    sides = np.linspace(-1.5, 1.5, 25)
    times = np.clip(one.time + one.series.step * sides[:, None], 0.0, one.exact.history.span[1])
    values = at(times.ravel()).reshape(times.shape)
    whole, half = (np.abs(np.diff(values[::stride], axis=0)).max(axis=0) for stride in (2, 1))
    return np.asarray((half <= LARGEST_HALF * whole) | (whole <= ROUNDED_AWAY * float(np.abs(values).max())))


def _inside(one: MeasuredSeries) -> NDArray[np.bool_]:
    """Return where a shift by a step stays between start and end of the exact solution."""
    step = one.series.step
    return np.asarray((one.time > 1.5 * step) & (one.time < one.exact.history.span[1] - 1.5 * step))


class _Means(NamedTuple):
    """Mean velocities of the contact, and mean loads, in each step that waves are followed through."""

    rates: Floats
    loads: Floats


def reflected(one: MeasuredSeries) -> Iterator[str]:
    """Yield a sentence if the load of a series fits to echoes of another size or sign than those of the body.

    Load and slip rate of a series belong together, whatever its friction does: the load is what the loading brings, and the echoes
    of the slip before.
    """
    echoes = echoes_of(one.exact.problem)
    followed = None if echoes is None else _in_steps(echoes, one)
    if followed is None:
        return
    steady = one.exact.problem.first_pull_rate  # sliding at this rate brings no echoes, whatever the driver is
    own, right = (_means(followed, one, exact) for exact in (False, True))
    free = right.loads - followed.load(right.rates - steady)
    scale = float(np.ptp(right.loads)) or float(np.abs(right.loads).max())

    def off(other: Echoes) -> float:
        return float(np.abs(own.loads - free - other.load(own.rates - steady)).mean()) / scale

    before = off(followed)
    if before <= SMALLEST_MISS:
        return
    tried = [
        (off(followed.changed(other, side, cell)), name, share, other)
        for name, share, side, cell in followed.places()
        for other in dict.fromkeys((-share, 0.0, 0.5 * share, 2.0 * share, 1.0, -1.0))
        if abs(other) <= 1.0 and other != share
    ]
    best, name, share, other = min(tried, default=(np.inf, "", 0.0, 0.0))
    if best < EXPLAINS * before:
        kind = "no echo" if other == 0.0 else "an echo with the wrong sign" if other * share < 0.0 else "an echo of the wrong size"
        yield (
            f"{one.series.name} has {kind} of {name}: {share:.4g} of the stress comes back there, the series fits to {other:.4g}"
        )


def _in_steps(echoes: Echoes, one: MeasuredSeries) -> Echoes | None:
    """Return echoes in cells as fine as the series allows; None if its steps are longer than a cell, or cells are too many."""
    lasts, finest = float(one.time[-1]), int(echoes.time / one.series.step)
    by = min(max(int(np.ceil(FEWEST_STEPS * echoes.time / lasts)), 1), finest)
    cells = sum(len(side.impedances) for side in echoes.sides) * by
    return echoes.finer(by) if by and cells * lasts / echoes.time * by <= LARGEST_WORK else None


def _means(echoes: Echoes, one: MeasuredSeries, exact: bool) -> _Means:
    """Return the means of the series, or of the exact solution at the same times, so that both are rounded alike."""
    step = echoes.time
    ends = step * np.arange(int(one.time[-1] / step + 1e-9) + 1)
    slip, traction = one.series.slip[: one.time.size], one.traction
    if exact:
        slip, traction = one.exact.slip(one.time), one.exact_traction
    whole = np.append(0.0, np.cumsum(0.5 * (traction[1:] + traction[:-1]) * np.diff(one.time)))
    ground = one.exact.problem.ground  # waves are sent by the motion of the contact in space
    slip = slip if ground is None else slip + ground.displacement_at(one.time)
    rates, tractions = (np.diff(np.interp(ends, one.time, values)) / step for values in (slip, whole))
    return _Means(rates, tractions + echoes.impedance * rates)


def orders_of(several: Sequence[MeasuredSeries]) -> str:
    """Return a sentence on how the errors of several series fall with their steps of time; "" if the steps are alike."""
    sorted_by_step = sorted(several, key=lambda one: -one.series.step)
    steps = np.array([one.series.step for one in sorted_by_step])
    if len(several) < 2 or steps[0] < 1.2 * steps[-1]:
        return ""
    found = []
    for name in ("slip_error", "rate_error"):
        errors = np.array([getattr(one, name) for one in sorted_by_step])
        if (errors <= 0.0).any() or np.isnan(errors).any():
            return ""
        found.append(float(np.polyfit(np.log(steps), np.log(errors), 1)[0]))
    names = ", ".join(one.series.name for one in sorted_by_step)
    return f"errors fall with the step as its power {found[0]:.2f} in slip and {found[1]:.2f} in slip rate: {names}"


def traits_of(one: MeasuredSeries) -> tuple[str, ...]:
    """Return what a series shows, one sentence each."""
    return (*ringing(one), *shifted(one), *reflected(one))


def why_not_told(paths: RulePaths, problem: Problem, others: Sequence[str]) -> str:
    """Return why a problem cannot tell selection rules apart, and the `others` that can; "" if it can."""
    if len(paths.groups()) > 1:
        return ""
    *some, last = others
    can = f"the benchmarks {', '.join(some)} and {last} can tell rules apart"
    if len(paths.exact) < len(problem.rules):
        return f"under a normal load that varies like this only {problem.rule} is followed: {can}"
    return f"all selection rules have the same solution here: {can}"
