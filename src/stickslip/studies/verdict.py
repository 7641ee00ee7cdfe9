"""The rule to which a sequence of runs converges, and the order of convergence, from the differences between the runs alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from stickslip.foundation.arrays import Floats

CLEARLY = 0.25
"""A run is clearly nearer to a rule than to any other if its error is below this share of the distance to the nearest other."""
FALLING = 0.1
"""Order (power of the size) that errors must exceed to count as convergent."""
FEWEST = 3
"""Smallest number of points to which an order is fitted."""


@dataclass(frozen=True)
class Order:
    """An order of convergence: the power of the size, fitted to the smallest sizes whose errors exceed the accuracy of the runs.

    `points` is the number of these sizes; `first` and `last` are the orders between the two largest and between the two smallest of
    them. If these differ, the power still drifts.
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
    """Fit errors = constant size^power to the smallest sizes whose errors exceed the floor, at most half of all sizes or three.

    Returns NO_ORDER if fewer than three errors exceed the floor.
    """
    kept = np.flatnonzero(np.isfinite(errors) & (np.abs(errors) > floor))[-max(FEWEST, (len(sizes) + 1) // 2) :]
    if kept.size < FEWEST:
        return NO_ORDER
    x, y = np.log(sizes[kept]), np.log(np.abs(errors[kept]))
    x, y = x - x.mean(), y - y.mean()
    steps = np.diff(y) / np.diff(x)
    return Order(float(x @ y / (x @ x)), float(steps[0]), float(steps[-1]), int(kept.size))


def local_orders(sizes: Floats, errors: Floats) -> Floats:
    """Return the order between each size and the one before; NaN for the first."""
    with np.errstate(divide="ignore", invalid="ignore"):
        steps = np.diff(np.log(np.abs(errors))) / np.diff(np.log(sizes))
    return np.concatenate([[np.nan], np.where(np.isfinite(steps), steps, np.nan)])


@dataclass(frozen=True)
class Verdict:
    """The rules to whose solution the runs converge, the order, and a sentence.

    `rules` holds several rules if they have the same solution, and none if the runs converge to none of them.
    """

    rules: tuple[str, ...]
    order: Order
    text: str


@dataclass(frozen=True)
class Errors:
    """The data of a verdict, as mean slip differences (m).

    `sizes` (s) is descending; `against` holds the error of each run relative to the solution of each group of rules; `changes` is
    the difference between each run and the one before (NaN first); `floor` is the accuracy of the runs.
    """

    sizes: Floats
    against: Mapping[tuple[str, ...], Floats]
    changes: Floats
    apart: Mapping[tuple[str, ...], float]
    """Distance (m) from the solution of each group of rules to the nearest other one; inf if there is only one."""
    floor: float


def judge(found: Errors) -> Verdict:
    """Decide to which group of rules, if any, a sequence of runs converges."""
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
    """Group the rules whose solutions differ by no more than the floor (m), in the order of `rules`."""
    found: dict[str, list[str]] = {}
    for rule in rules:
        first = next((one for one in found if apart[one, rule] <= floor), rule)
        found.setdefault(first, []).append(rule)
    return [tuple(group) for group in found.values()]
