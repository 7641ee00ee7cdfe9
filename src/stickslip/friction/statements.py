"""Check a law's own statements against its formula, by samples.

Runs, proofs and searches for folds believe the statements of a law: its knots, its step at rest, and its range. Tests check those
of the package's laws. Those of a user's class are compared with its formula when the law is made.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import NumberSeries, Quantity, fields_of
from stickslip.friction.contract import STATE_NAMES, one_argument
from stickslip.friction.values import LawValues, as_number, stated_range

RATES = np.append(0.0, np.geomspace(1e-9, 1e3, 73))
"""Every law is sampled at these slip rates (m/s), and at multiples of its own scales."""
SLIPS = np.append(0.0, np.geomspace(1e-6, 1e2, 73))
"""A law of slip is sampled at these slips (m), and at multiples of its own scales."""
SOME = 12
"""Every such slip is sampled at all slip rates, and every such slip rate at all slips."""
MULTIPLES = np.array([0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 10.0, 30.0])
"""A law is sampled at these multiples of its own scales."""
SLACK = 1e-7
"""Relative difference between a statement and the formula that counts as rounding."""


def check_statements(law: LawValues) -> None:
    """Raise InputError, in one line, if a law contradicts its own formula at one of many slips, slip rates and states."""
    for way in law.ways if law.backward_from else ():
        check_statements(way)
    if law.backward_from:
        return
    name = type(law).__name__
    _check_knots(law)
    step = as_number(law.static_excess)
    if not (step >= 0.0 and math.isfinite(step)):
        raise InputError(f"{name}: static_excess must be a number of at least 0, got {law.static_excess!r}")
    if not law.states_range:
        return
    low, high = stated_range(law)
    try:
        slips, rates = _slips(law), _rates(law)
        along_rate = _Samples.of(law, slips[::SOME], rates)
        along_slip = _Samples.of(law, slips, rates[::SOME]) if len(slips) > 1 else along_rate
    except (TypeError, ValueError, AttributeError, ArithmeticError):
        return  # a formula that cannot be evaluated like this has its own message where it is traced
    for samples in (along_rate, along_slip):
        samples.check_range(name, low, high, step, law.can_be_negative)


def _check_knots(law: LawValues) -> None:
    name, knots, pieces = type(law).__name__, np.asarray(law.knots, float), len(law.pieces)
    if knots.ndim != 1 or len(knots) != pieces - 1:
        raise InputError(f"{name}: knots must be one fewer than pieces, got {knots.size} knots and {pieces} pieces")
    if not np.all(np.isfinite(knots)) or np.any(np.diff(knots) <= 0.0):
        raise InputError(f"{name}: knots must be finite and ascending, got {', '.join(f'{one:g}' for one in knots[:8])}")
    if law.knot_variable == "rate" and len(knots) and knots[0] < 0.0:
        raise InputError(f"{name}: knots in slip rate must be at least 0 m/s, got {knots[0]:g}")


@dataclass(frozen=True)
class _Samples:
    """Friction coefficients at slips and states (rows) and at slip rates (columns)."""

    slip: Floats  # (rows,), m
    states: list[Floats]  # (rows,) each
    rate: Floats  # (columns,), ascending, m/s
    coefficient: Floats
    law: LawValues

    @classmethod
    def of(cls, law: LawValues, slips: Floats, rate: Floats) -> _Samples:
        sampled = _states(law)
        slip = np.repeat(slips, len(sampled[0]) if sampled else 1)
        states = [np.tile(one, len(slips)) for one in sampled]
        rows = [one[:, None] for one in states]
        with np.errstate(all="ignore"):
            value = law.coefficient(slip[:, None], rate, one_argument(rows))
        return cls(slip, states, rate, value, law)

    def place(self, row: int, column: int) -> str:
        where = [f"slip {self.slip[row]:.4g} m"] if self.law.depends_on_slip else []
        where += [f"slip rate {self.rate[column]:.4g} m/s"] if len(self.rate) > 1 or not where else []
        where += [f"state {one[row]:.4g}" for one in self.states]
        return " and ".join(where)

    def check_range(self, name: str, low: float, high: float, step: float, can_be_negative: bool) -> None:
        """Compare all samples, and the coefficient at rest, with the bounds of `range`."""
        at_rest = np.where(self.rate == 0.0, step, 0.0)
        value = np.where(np.isfinite(self.coefficient), self.coefficient + at_rest, low)
        allowed = SLACK * max(1e-3, float(np.max(np.abs(value[value <= max(2.0 * high, 1.0)]), initial=0.0)))
        least = np.where(value < 0.0, max(low, 0.0), value) if can_be_negative and low <= 0.0 else value
        for found, bound, word in ((least, low, "at least"), (-value, -high, "at most")):
            row, column = np.unravel_index(int(np.argmin(found)), found.shape)
            if found[row, column] < bound - allowed:
                rest = " at rest" if column == 0 and step else ""
                raise InputError(
                    f"{name}: range() says that mu is {word} {abs(bound):.6g}, but{rest} it is {value[row, column]:.6g} at"
                    f" {self.place(int(row), int(column))}; the bounds must hold at all slips and slip rates"
                )


def rises_with_rate(law: LawValues) -> bool:
    """Return False if friction of a law with a state falls with the slip rate at one of many slip rates and steady states."""
    rates = _rates(law)[1:]
    steady = law.steady_state(rates)
    many, some = len(law.states), slice(None, None, len(rates) // SOME)
    states = [np.zeros(1)] * many
    if steady is not None:
        seen = np.reshape(steady, (many, -1))[:, some]
        states = list(np.transpose([law.inner_states(one.tolist()) for one in seen.T]))
    with np.errstate(all="ignore"):
        slopes = law.slopes(0.0, rates, one_argument([one[:, None] for one in states]))[1]
    return not bool(np.any(slopes < 0.0))


def _beside(law: LawValues, variable: str) -> Floats:
    """Return places at the knots of a law, and just below them, if the knots are in the given variable."""
    knots = np.asarray(law.knots if law.knot_variable == variable else (), float)
    return np.concatenate((knots, np.nextafter(knots, -np.inf)[knots > 0.0]))


def _rates(law: LawValues) -> Floats:
    """Return the slip rates (m/s) for samples of a law, ascending from 0."""
    if not law.depends_on_rate and not law.states:
        return np.zeros(1)
    return np.unique(np.concatenate((RATES, np.outer(law.rate_scales, MULTIPLES).ravel(), _beside(law, "rate"))))


def _slips(law: LawValues) -> Floats:
    """Return the slips (m) for samples of a law; negative ones, too, if it counts net slip."""
    if not law.depends_on_slip:
        return np.zeros(1)
    scales = [size if unit == "m" else 1.0 / size for unit, size in _sizes(law) if unit in ("m", "1/m")]
    slips = np.unique(np.concatenate((SLIPS, np.outer(scales, MULTIPLES).ravel(), _beside(law, "slip"))))
    return np.concatenate((slips, -slips[slips > 0.0])) if law.counts == "net" else slips[slips >= 0.0]


def _sizes(law: LawValues) -> list[tuple[str, float]]:
    """Return the unit and the magnitude of each number of a law that is not 0."""
    found = []
    for name, (declared, _) in fields_of(type(law)).items():
        item = declared.item if isinstance(declared, NumberSeries) else declared
        if isinstance(item, Quantity):
            value = getattr(law, name)
            values = value if isinstance(value, tuple) else (value,)
            found += [(item.unit, abs(one)) for one in values if isinstance(one, float | int) and one]
    return found


def _states(law: LawValues) -> list[Floats]:
    """Return the samples of each state, as the formulas use it: 0, and that of the law's example, if that is a number."""
    given = [law.start.get(name) for name in STATE_NAMES[: len(law.states)]]
    numbers = [float(one) for one in given if isinstance(one, int | float)]
    if len(numbers) < len(law.states):
        return [np.zeros(1)] * len(law.states)
    return [np.array([0.0, one]) for one in law.inner_states(numbers)]
