"""Residuals in words: each kind is named with its size, at each level of noise, and noise is not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from stickslip.extensions.inference.fit.memory import ResidualBlock
from stickslip.extensions.inference.fit.what_is_left import Residuals, near_changes, what_is_left, words
from tests.extensions.inference.laboratory import Floats, correlated

CHANGES = np.array([15.0, 25.0, 40.0, 50.0])
RATES = np.array([1e-5, 1e-4, 1e-5, 3e-5, 1e-5])


def run(count: int) -> tuple[Floats, Floats, Floats]:
    """Return time, slip and friction of velocity steps: a direct effect, and its decay over 15 um."""
    time = np.linspace(0.0, 60.0, count)
    rate = RATES[np.searchsorted(CHANGES, time, side="right")]
    slip = np.append(0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time)))
    friction = np.zeros(count)
    for at, before, after in zip(CHANGES, RATES[:-1], RATES[1:], strict=True):
        moved = np.maximum(slip - np.interp(at, time, slip), 0.0)
        friction += (
            np.log(after / before) * (0.0125 * np.exp(-moved / 15e-6) - 0.008 * np.exp(-moved / 3e-6) - 0.0045) * (time >= at)
        )
    return time, slip, friction


def residuals(values: Floats, slopes: Floats | None = None) -> Residuals:
    """Return values as residuals of a run of velocity steps, beside whose derivatives they are looked at."""
    time, slip, friction = run(len(values))
    near, after = near_changes(time, CHANGES)
    by = np.zeros((len(time), 0)) if slopes is None else slopes
    change = np.gradient(friction, time)
    return Residuals(values, [ResidualBlock(slice(0, len(time)), time)], slip, change, near, after, len(CHANGES), by)


def of_kind(kind: str, count: int = 1500) -> tuple[Floats, float]:
    """Return residuals of one kind with the standard deviation 1, and their size."""
    time, slip, friction = run(count)
    shapes: dict[str, tuple[Floats, float]] = {
        "drift with slip": (-slip, -1.0),
        "drift with time": (time, 1.0),
        "lag": (-np.gradient(friction, time), 1.0),
        "oscillation": (np.sin(2.0 * np.pi * time / 3.7), 0.0),
        "steps": (np.where(near_changes(time, CHANGES)[0], np.cos(7.0 * np.arange(count)), 0.0), 0.0),
    }
    if kind == "offset":
        return np.ones(count), 1.0
    shape, size = shapes[kind]
    scale = float(np.std(shape))
    found = {"oscillation": 3.7, "steps": 4.0}.get(kind, size / scale)
    return (shape - (np.mean(shape) if kind.startswith("drift") else 0.0)) / scale, found


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("noise", [1.5, 0.3, 0.03])
@pytest.mark.parametrize("kind", ["drift with slip", "drift with time", "lag", "oscillation", "offset", "steps"])
def test_each_kind_is_named_with_its_size_at_each_level_of_noise(kind: str, noise: float) -> None:
    shape, size = of_kind(kind)
    look = what_is_left(residuals(shape + noise * correlated(len(shape), 0.0, 3)))[0]
    assert look.kind == kind
    assert look.share == pytest.approx(1.0 / (1.0 + noise**2), rel=0.12)
    assert look.size == pytest.approx(size, rel=0.12 * max(noise, 0.1))


def test_white_noise_is_noise_however_long_the_record_and_remembering_noise_too() -> None:
    """None of 36 records of noise, white or with a memory of a few samples, gets a word."""
    found = [
        what_is_left(residuals(correlated(count, memory, seed)))
        for seed in range(6)
        for count in (60, 200, 800)
        for memory in (0.0, 3.0)
    ]
    assert [one for one in found if one] == []


def test_two_kinds_are_told_one_after_the_other() -> None:
    shape = 2.0 * of_kind("drift with slip")[0] + of_kind("oscillation")[0]
    looks = what_is_left(residuals(shape + 0.2 * correlated(len(shape), 0.0, 1)))
    assert [look.kind.partition(" ")[0] for look in looks] == ["drift", "oscillation"]
    assert looks[0].share > looks[1].share > 0.1


def test_a_drift_that_the_fit_has_hidden_among_its_numbers_is_told_in_its_full_size() -> None:
    """A level for each rate takes up most of a drift: beside them its slope is that of the record, and without them it is not."""
    time, slip, _ = run(1500)
    levels = np.array([np.searchsorted(CHANGES, time, side="right") == i for i in (1, 3)], float).T
    used, _ = np.linalg.qr(np.column_stack([np.ones(len(time)), levels]))
    rest = 2.0 * slip + 1e-5 * correlated(len(time), 0.0, 2)
    rest -= used @ (used.T @ rest)
    beside, alone = (what_is_left(residuals(rest, by)) for by in (used, None))
    assert beside[0].kind == "drift with slip"
    assert beside[0].size == pytest.approx(2.0, rel=0.01)
    assert not alone or abs(alone[0].size - 2.0) > 0.5


def test_a_drift_of_one_rate_is_with_slip_or_with_time() -> None:
    time = np.linspace(0.0, 60.0, 600)
    none = np.zeros(600, bool)
    values: Any = 1e-3 * time + 0.01 * correlated(600, 0.0, 1)
    blocks = [ResidualBlock(slice(0, 600), time)]
    look = what_is_left(Residuals(values - values.mean(), blocks, 1e-5 * time, 0.0 * time, none, none, 0, np.zeros((600, 0))))[0]
    assert look.kind == "drift"
    assert look.size == pytest.approx(1e-3, rel=0.1)


def test_a_misfit_after_steps_is_no_noise_though_it_looks_like_noise_that_remembers_itself() -> None:
    time, *_ = run(3000)
    since = time - np.append(0.0, CHANGES)[np.searchsorted(CHANGES, time, side="right")]
    shape = np.where(time > CHANGES[0], (1.0 - since) * np.exp(-since), 0.0)
    looks = what_is_left(residuals(shape + 0.02 * correlated(len(time), 0.0, 1)))
    assert looks[0].kind == "transients"
    assert looks[0].size > 3.0
    assert words(looks[:1], "1").startswith("a misfit after changes of the pull rate")
