"""To which rule a sequence of runs converges, and with what order: read off their differences, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from stickslip.trajectory.history import Floats

CLEARLY = 0.25
"""A run is clearly nearer to a rule than to the next one within this share of their distance."""
FALLING = 0.1
"""Errors that fall more slowly than with this power of the size do not tend to anything."""
FEWEST = 3


@dataclass(frozen=True)
class Order:
    """A power of the size, fitted to the smallest sizes whose errors are above the runs' accuracy: so many `points`.

    first, last: the order between the two largest and between the two smallest of them. Where they differ the power still drifts.
    """

    power: float
    first: float
    last: float
    points: int

    def __str__(self) -> str:
        if not self.points:
            return "an order that cannot be measured: the errors are as small as the accuracy of the runs"
        return f"order {self.power:.2f} (from {self.first:.2f} to {self.last:.2f} over the {self.points} smallest sizes)"


NO_ORDER = Order(np.nan, np.nan, np.nan, 0)


def order_of(sizes: Floats, errors: Floats, floor: float = 0.0) -> Order:
    """Fit errors = constant size^power to the smaller half of the sizes, three at least, leaving out errors below the floor."""
    kept = np.flatnonzero(np.isfinite(errors) & (np.abs(errors) > floor))[-max(FEWEST, (len(sizes) + 1) // 2) :]
    if kept.size < FEWEST:
        return NO_ORDER
    x, y = np.log(sizes[kept]), np.log(np.abs(errors[kept]))
    x, y = x - x.mean(), y - y.mean()
    steps = np.diff(y) / np.diff(x)
    return Order(float(x @ y / (x @ x)), float(steps[0]), float(steps[-1]), int(kept.size))


def local_orders(sizes: Floats, errors: Floats) -> Floats:
    """Order between each size and the one before; NaN for the first."""
    with np.errstate(divide="ignore", invalid="ignore"):
        steps = np.diff(np.log(np.abs(errors))) / np.diff(np.log(sizes))
    return np.concatenate([[np.nan], np.where(np.isfinite(steps), steps, np.nan)])


@dataclass(frozen=True)
class Verdict:
    """rules: those whose answer the runs tend to (several with the same answer, none if there is none), and the order."""

    rules: tuple[str, ...]
    order: Order
    text: str


@dataclass(frozen=True)
class Errors:
    """What a verdict rests on, in m of mean slip difference: sizes (s, falling), the error of each run against the answer of each
    group of rules, the change from run to run (NaN first), the distances between the groups' answers, and the runs' accuracy."""

    sizes: Floats
    against: Mapping[tuple[str, ...], Floats]
    changes: Floats
    apart: Mapping[tuple[str, ...], float]
    """Distance from each group's answer to the nearest other one; inf where there is only one."""
    floor: float


def judge(found: Errors) -> Verdict:
    """The verdict on a sequence."""
    best = min(found.against, key=lambda group: float(found.against[group][-1]))
    errors = found.against[best]
    order = order_of(found.sizes, errors, found.floor)
    exact = bool(errors[-1] <= found.floor)
    clear = bool(errors[-1] < CLEARLY * found.apart[best])
    if clear and (exact or order.power > FALLING):
        if len(found.against) == 1 and len(best) > 1:
            return Verdict(best, order, f"all rules have the same answer here, and the runs tend to it: {order}")
        others = " and ".join(best) + (" (the same answer here)" if len(best) > 1 else "")
        return Verdict(best, order, f"the runs tend to {others}: {order}")
    settling = order_of(found.sizes, found.changes, found.floor)
    settled = bool(found.changes[-1] <= found.floor or (found.changes[-1] < CLEARLY * errors[-1] and settling.power > FALLING))
    nearest = f"the smallest size is {errors[-1]:.3g} m of mean slip from {' and '.join(best)}, the nearest"
    if settled:
        return Verdict((), settling, f"no rule: the runs tend to an answer of their own, {settling}; {nearest}")
    return Verdict((), NO_ORDER, f"no rule yet: the runs do not settle; {nearest}")


def groups(rules: Sequence[str], apart: Mapping[tuple[str, str], float], floor: float) -> list[tuple[str, ...]]:
    """Rules with the same answer (apart by no more than the floor, m) together, in the order of `rules`."""
    found: list[list[str]] = []
    for rule in rules:
        home = next((group for group in found if apart[group[0], rule] <= floor), None)
        if home is None:
            found.append([rule])
        else:
            home.append(rule)
    return [tuple(group) for group in found]
