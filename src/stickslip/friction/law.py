"""Define the base class of all friction laws, the common parts of families of laws, and the check of a law's own statements.

Runs, proofs and searches for folds believe the statements of a law: its knots, its step at rest, and its range. Tests check those
of the package's laws. Those of a user's class are compared with its formula, by samples, when the law is made.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import reduce
from typing import Any, Literal

import numpy as np
from typing_extensions import override

from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, NumberSeries, Quantity, declare, fields_of, quantity
from stickslip.friction.contract import STATE_NAMES, one_argument
from stickslip.friction.values import LawValues


@dataclass(frozen=True)
class FrictionLaw(LawValues):
    """A friction law: the coefficient mu(u, v) of a contact that slips, and the static coefficient at rest.

    Subclass this to add a law; `stickslip.friction.contract` lists what a law states about itself.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if not is_known(self):
            check_statements(self)
        if self.states_range and (low := stated_range(self)[0]) < 0:
            raise InputError(f"{type(self).__name__}: friction must not be negative anywhere it slips, its minimum here is {low:g}")


def hull(*values: Any) -> tuple[Any, Any]:
    """Return the smallest and the largest of some numbers, or of arrays entry by entry: the range of a law between them."""
    return reduce(np.minimum, values), reduce(np.maximum, values)


@dataclass(frozen=True, kw_only=True)
class RemembersSlip(FrictionLaw):
    """A law of slip that lets users choose from when slip is counted, by its field `memory`.

    "all" counts slip from the start of the run, initial slip included. "since-arrest" counts slip from the last arrest; the contact
    heals at once when it is arrested. The class attribute `counts` says which slip is counted: net slip with its sign, or the path.

    An arrest is rest for a positive time: the contact can stay at rest under the friction that it has at that moment, before it
    heals. The counted slip is then set back to 0. If the healed strength is below the load, the contact slips again at once.

    Passing through v = 0 directly into slip in the other direction is not an arrest. Nor is a touch of v = 0: with inertia, rest
    counts as a touch if without healing it would end within sqrt(rtol) times the period or the round trip.

    The start of the run counts as an arrest: with "since-arrest" the initial slip does not enter friction.
    """

    memory: Literal["all", "since-arrest"] = declare(  # type: ignore[misc] # a class attribute in the base, a field here
        Choice("slip that friction remembers", ("all", "since-arrest")), "all"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.memory == "since-arrest" and not self.depends_on_slip:
            name = type(self).__name__
            raise InputError(f"{name}: memory 'since-arrest' needs friction that depends on slip; allowed here: all")


@dataclass(frozen=True)
class SlipWeakening(RemembersSlip):
    """A law whose friction changes from `static` to `dynamic` over a `distance` of slip path.

    The slip path d is the accumulated length of slip in both directions.
    """

    counts = "path"

    static: float = quantity("1", "friction coefficient before slip", at_least=0)
    dynamic: float = quantity("1", "friction coefficient after much slip", at_least=0)
    distance: Number = quantity("m", "slip over which friction falls (often Dc)", above=0)

    @staticmethod
    def weakened(law: Any, u: Any, v: Any) -> Any:
        """Return the constant mu of the piece after complete weakening."""
        return law.dynamic + 0.0 * u

    @override
    def range(self) -> tuple[float, float]:
        return hull(self.static, self.dynamic)


@dataclass(frozen=True)
class Stribeck(FrictionLaw):
    """A law that falls from `static` to `dynamic` around the slip rate `rate`, and rises again with `viscosity`.

    The exponent must be whole: otherwise the curve has no derivatives at v = 0, where every slip begins.
    """

    critical = "rate"

    static: float = quantity("1", "friction coefficient at rest", at_least=0)
    dynamic: float = quantity("1", "friction coefficient at high slip rate, without the viscous term", at_least=0)
    rate: Number = quantity("m/s", "slip rate v_s over which friction falls", above=0)
    exponent: float = quantity("1", "exponent of v / rate; whole", at_least=1, whole=True)
    viscosity: Number = quantity("s/m", "increase of friction with slip rate", at_least=0, default=0.0)


# ---- the check of statements -----------------------------------------------------------------------------------------------

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


def is_known(law: LawValues) -> bool:
    """Return True for a law of the package, which is tested there."""
    return type(law).__module__.partition(".")[0] == "stickslip"


def check_statements(law: LawValues) -> None:
    """Raise InputError, in one line, if a law contradicts its own formula at one of many slips, slip rates and states."""
    name = type(law).__name__
    _check_knots(law)
    step = _number(law.static_excess)
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


def _number(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return math.nan


def stated_range(law: LawValues) -> tuple[float, float]:
    """Return the bounds of a law's friction coefficient, as it states them. Raises InputError if they are not two numbers."""
    given: Any = law.range()
    if not (isinstance(given, tuple | list) and len(given) == 2 and _number(given[0]) <= _number(given[1])):
        raise InputError(
            f"{type(law).__name__}: range() must return two numbers, a lower and an upper bound of mu, got {str(given)[:60]}"
        )
    return _number(given[0]), _number(given[1])


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
