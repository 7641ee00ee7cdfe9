"""Say in words what the residuals of a fit look like: drift, lag, offset, oscillation, or steps that the samples do not resolve.

Each look is a regression of the residuals, beside which the free numbers may still move and the noise may be correlated. A look is
told if chance does not explain it and if it makes up a share of what is left that one would see. Residuals far above the noise from
sample to sample that do not forget themselves are no noise anyway: there the share alone decides.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.fit.memory import (
    LONGEST_MEMORY,
    Memory,
    ResidualBlock,
    independent,
    independent_columns,
    memory_of,
    spread_by,
)
from stickslip.extensions.inference.record.noise import noise_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief

CHANCE = 1e-5
"""Largest probability that noise alone looks like this, for each kind of look."""
SHARE_TOLD = 0.08
"""A look is told if it makes up at least this share of the sum of squares that is left."""
LARGE, FORGETS, PLAIN = 3.0, 0.9, 0.3
"""Residuals are no noise if they exceed LARGE times the noise of neighbouring samples and remember themselves for more than FORGETS
of the longest time that is considered: looks with a share above PLAIN are then told without asking for chance."""
LOOKS_TOLD = 3
"""Largest number of looks that are told."""
SAMPLES_BESIDE_CHANGE = 2
"""Samples on each side of a change of the pull rate that are unsure if the samples do not resolve the change."""
AFTER = 0.25
"""What follows a change is told of this share of the time to the next one."""
LARGER = 2.0
"""Residuals near changes must be so many times larger than elsewhere, in the root of the mean square, to be told."""
ALIKE = 0.7
"""The more special of two looks is told if it explains at least this share of what the other one does."""
APART_DRIFTS_TOLD = 10.0
"""A drift is told to be with slip, or with time, if twice the log-likelihoods differ by this much: a chance of one in 150."""
PERIODS, FEWEST = 3.0, 32
"""An oscillation has at least so many periods in a record, and a record that is looked at at least so many samples."""


Size = Callable[[Floats], float]
"""The size of a look from the coefficients of its columns."""


class ResidualLook(NamedTuple):
    """One look of residuals (data minus run): its kind, its share of the sum of squares, and its size in the unit of its kind.

    Kinds and sizes are "drift with slip" (unit of the residual per metre), "drift with time" and "drift" with either (per second),
    "lag" (s by which the record is late), "offset" (residual), "oscillation" (its period in s), "steps" (number of changes of the
    pull rate that the samples do not resolve), and "transients" (how many times larger what is left is after changes).
    """

    kind: str
    share: float
    size: float


@dataclass(frozen=True, eq=False)
class Residuals:
    """Residuals of one quantity, data minus run (SI), with what they may follow.

    `blocks` are the parts that follow in time. `slip` (m) and `change`, the derivative of the run in time, belong to the samples.
    `near` and `after` are True for samples beside a change of the pull rate and for some time after one; `changes` is the number of
    these. `slopes` are the derivatives with respect to the free numbers, shape (n, p).
    """

    values: Floats
    blocks: Sequence[ResidualBlock]
    slip: Floats
    change: Floats
    near: NDArray[np.bool_]
    after: NDArray[np.bool_]
    changes: int
    slopes: Floats

    @property
    def time(self) -> Floats:
        """The times of the residuals (s)."""
        return np.concatenate([one.time for one in self.blocks])

    def without(self, columns: Floats) -> Residuals:
        """Return what is left once these columns are free, too."""
        slopes = np.column_stack([self.slopes, columns])
        used = independent_columns(slopes)
        rest = self.values - used @ (used.T @ self.values)
        return Residuals(rest, self.blocks, self.slip, self.change, self.near, self.after, self.changes, slopes)

    def only(self, kept: NDArray[np.bool_]) -> Residuals:
        """Return some of the residuals."""
        blocks, count = list[ResidualBlock](), 0
        for rows, time in self.blocks:
            inside = time[kept[rows]]
            blocks.append(ResidualBlock(slice(count, count + len(inside)), inside))
            count += len(inside)
        blocks = [one for one in blocks if len(one.time)]
        arrays = (self.slip[kept], self.change[kept], self.near[kept], self.after[kept])
        return Residuals(self.values[kept], blocks, *arrays, self.changes, self.slopes[kept])


def what_is_left(found: Residuals) -> list[ResidualLook]:
    """Return what residuals look like, the largest share first; an empty list if they look like noise."""
    total, looks = float(found.values @ found.values), list[ResidualLook]()
    bare = found.without(np.zeros((len(found.values), 0)))
    least = PLAIN if len(bare.values) >= FEWEST and _is_no_noise(bare) else math.inf
    while len(looks) < LOOKS_TOLD and len(bare.values) >= FEWEST and total > 0.0:
        look, rest = _next(bare, total, {one.kind.partition(" ")[0] for one in looks}, least)
        if look is None or rest is None:
            break
        looks.append(look)
        bare = rest
    return looks


def _is_no_noise(found: Residuals) -> bool:
    longest = LONGEST_MEMORY * max(float(np.ptp(time)) for _, time in found.blocks)
    size, noise = math.sqrt(float(np.mean(found.values**2))), max(noise_of(found.values[rows]) for rows, _ in found.blocks)
    return size > LARGE * noise and _memory(found).time > FORGETS * longest


class _Try(NamedTuple):
    """A look that residuals may have: its share, what is left without it, and whether chance does not explain it."""

    look: ResidualLook
    rest: Callable[[], Residuals]
    sure: Callable[[], bool]


def _next(found: Residuals, total: float, known: set[str], least: float) -> tuple[ResidualLook | None, Residuals | None]:
    """Return the look that explains most of what is left, if it is no chance or above `least`, and the residuals without it."""
    tries = [one for one in _tries(found, total) if one.look.kind.partition(" ")[0] not in known and one.look.share >= SHARE_TOLD]
    tries.sort(key=lambda one: -one.look.share)
    special = [one for one in tries if one.look.kind == "steps" and one.look.share > ALIKE * tries[0].look.share]
    plain = [one for one in tries if one.look.kind not in ("steps", "transients") and one.look.share > ALIKE * tries[0].look.share]
    for one in dict.fromkeys([*special, *plain, *tries]):
        if one.look.share > least or one.sure():
            return one.look, one.rest()
    return None, None


def _tries(found: Residuals, total: float) -> Iterator[_Try]:
    time, parts = found.time, np.zeros((len(found.values), len(found.blocks)))
    for i, (rows, _) in enumerate(found.blocks):
        parts[rows, i] = 1.0
    yield _regressed(found, total, "offset", parts, lambda c: float(c[np.argmax(np.abs(c))]))
    level = found.without(parts)
    yield _drift(level, total, time)
    if np.ptp(found.change) > 0.0:
        yield _regressed(level, total, "lag", found.change[:, None], lambda c: -float(c[0]))
    wave = _wave(found)
    if wave is not None:
        period, columns, tried = wave
        yield _regressed(found, total, "oscillation", columns, lambda c: period, tried=tried)
    for kind, chosen in (("steps", found.near), ("transients", found.after)):
        if 3 <= chosen.sum() <= len(chosen) - 3:
            yield _larger(found, total, kind, chosen)


def _drift(found: Residuals, total: float, time: Floats) -> _Try:
    """Return the drift that explains more: with slip, with time, or either if they are alike."""
    ways = {"drift with slip": found.slip[:, None], "drift with time": time[:, None]}
    kept = {name: found.without(one) for name, one in ways.items()}
    left = {name: max(float(one.values @ one.values), 1e-300) for name, one in kept.items()}
    kind = min(left, key=lambda name: left[name])
    if float(found.values @ found.values) - left[kind] < SHARE_TOLD * total:
        return _regressed(found, total, kind, ways[kind], lambda c: float(c[0]))  # too small to be told
    gain = _count(found, _memory(kept[kind])) * math.log(max(left.values()) / left[kind])
    if gain >= APART_DRIFTS_TOLD:
        return _regressed(found, total, kind, ways[kind], lambda c: float(c[0]), tried=2)
    per_second = _regressed(found, total, "drift", ways["drift with time"], lambda c: float(c[0])).look.size
    return _regressed(found, total, "drift", ways[kind], lambda _: per_second, tried=2)


def _count(found: Residuals, memory: Memory) -> float:
    """Return the number of independent residuals, given the memory of the noise."""
    return sum(independent(time, memory) for _, time in found.blocks)


def _memory(found: Residuals) -> Memory:
    return memory_of(found.values, found.slopes, found.blocks)


def _regressed(found: Residuals, total: float, kind: str, columns: Floats, size: Size, *, tried: int = 1) -> _Try:
    """Return a look that is linear in some columns; `tried` is the number of such looks among which it was chosen."""
    used = independent_columns(found.slopes) if found.slopes.size else np.zeros((len(columns), 0))
    across = columns - used @ (used.T @ columns)
    seen = np.linalg.norm(across, axis=0) > 1e-6 * np.linalg.norm(columns, axis=0)
    across = across[:, seen]
    inverse = np.linalg.pinv(across, rcond=1e-8)
    some = inverse @ found.values
    coefficients = np.zeros(columns.shape[1])
    coefficients[seen] = some
    explained = float(np.sum((across @ some) ** 2))

    def sure() -> bool:
        from scipy.stats import f

        rest = found.without(columns)
        memory = _memory(rest)
        covariance = spread_by(np.asarray(inverse.T, float), memory, found.blocks)
        rank = int(np.linalg.matrix_rank(across))
        if not rank:
            return False
        freedom = max(_count(found, memory) - found.slopes.shape[1] - rank, 4.0)
        ratio = float(some @ np.linalg.pinv(covariance, rcond=1e-10, hermitian=True) @ some) / rank
        return bool(f.sf(ratio, rank, freedom) * tried < CHANCE)

    return _Try(ResidualLook(kind, explained / total, size(coefficients)), lambda: found.without(columns), sure)


def _larger(found: Residuals, total: float, kind: str, chosen: NDArray[np.bool_]) -> _Try:
    """Return the look of residuals that are larger at some samples than at others."""
    inside, outside = found.values[chosen], found.values[~chosen]
    quiet = max(float(np.mean(outside**2)), 1e-300)
    ratio = float(np.mean(inside**2)) / quiet
    excess = float(inside @ inside) - len(inside) * quiet if ratio > LARGER**2 else 0.0

    def sure() -> bool:
        from scipy.stats import f

        share = _count(found, _memory(found)) / max(len(found.values), 1)
        freedom = [max(1.0, share * len(one)) for one in (inside, outside)]
        return bool(f.sf(ratio, *freedom) < CHANCE)

    size = float(found.changes) if kind == "steps" else math.sqrt(ratio)
    return _Try(ResidualLook(kind, excess / total, size), lambda: found.only(~chosen), sure)


def _wave(found: Residuals) -> tuple[float, Floats, int] | None:
    """Return the period (s) of the strongest oscillation, its columns, and the number of frequencies that were tried."""
    rows, time = max(found.blocks, key=lambda one: len(one.time))
    lasts = float(time[-1] - time[0])
    if len(time) < FEWEST or not lasts > 0.0:
        return None
    even = np.linspace(time[0], time[-1], len(time))
    values = np.interp(even, time, found.values[rows])
    count = 4 * len(even)
    power = np.abs(np.fft.rfft(values - values.mean(), count)) ** 2
    frequency = np.arange(len(power)) * (len(even) - 1) / (lasts * count)
    power[frequency * lasts < PERIODS] = 0.0
    best = float(frequency[int(np.argmax(power))])
    if not best > 0.0:
        return None
    phase = 2.0 * math.pi * best * found.time
    return 1.0 / best, np.column_stack([np.cos(phase), np.sin(phase)]), len(even) // 2


def near_changes(time: Floats, changes: Floats) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which samples are beside a change of the pull rate (at times in s), and which follow one soon."""
    near, after = np.zeros(len(time), bool), np.zeros(len(time), bool)
    for at, end in pairwise([*changes.tolist(), float(time[-1])]):
        k = int(np.searchsorted(time, at))
        near[max(k - 1, 0) : k + SAMPLES_BESIDE_CHANGE] = True
        after |= (time >= at) & (time <= at + AFTER * (end - at))
    return near, after


def words(looks: Sequence[ResidualLook], unit: str) -> str:
    """Return what residuals look like as text, such as "a drift with slip of -2 /m (76 % of it)"; `unit` is theirs."""
    return ", ".join(f"{_named(one, unit)} ({one.share:.0%} of it)" for one in looks) or "noise"


def _named(look: ResidualLook, unit: str) -> str:
    per: Mapping[str, str] = {"drift with slip": "/m", "drift with time": "/s", "drift": "/s"}
    if look.kind in per:
        return f"a {look.kind} of {look.size:.3g} {'' if unit == '1' else unit}{per[look.kind]}"
    if look.kind == "lag":
        return f"a {'lag' if look.size > 0.0 else 'lead'} of {brief(abs(look.size), 's', 2)}"
    if look.kind == "oscillation":
        return f"an oscillation with a period of {brief(look.size, 's', 3)}"
    if look.kind == "offset":
        return f"an offset of {brief(look.size, unit, 3)}"
    if look.kind == "steps":
        return f"steps that the samples do not resolve, beside {look.size:.0f} changes of the pull rate"
    return f"a misfit after changes of the pull rate, {look.size:.2g} times what is left elsewhere"
