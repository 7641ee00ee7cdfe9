"""The free numbers of an inference: their names, scales, limits and priors."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.quantities import Quantity
from stickslip.problem import Problem

FARTHEST, FARTHEST_PURE = 1e3, 30.0
"""Largest factors between a positive number (with a unit, without) and its starting value, unless the user gives bounds."""
NEAR, NEAR_KNOWN = 10.0, 2.0
"""Starts are drawn within these factors: slips and rates of a law; pure numbers and the body, which are known better."""
FREE_LISTED = "`stickslip check SCENARIO --parameters` lists those of the scenario"
"""Where the numbers that may be free are."""
TREND, DRIFT, DELAY, SERVO = "record.trend", "record.drift", "record.delay", "record.servo"
LOAD, INITIAL_STATE = "initial.load", "initial.state"
_PRIOR = re.compile(r"\s*(normal|lognormal|uniform)\s*\(\s*([^,()]+)\s*,\s*([^,()]+)\s*\)\s*")


@dataclass(frozen=True)
class Prior:
    """A prior: its kind and two numbers (SI).

    These are mean and standard deviation ("normal"), median and standard deviation of the logarithm ("lognormal"), or both ends
    ("uniform").
    """

    kind: str
    first: float
    second: float

    def residual(self, value: float) -> float:
        """Return the distance of a value from the prior's middle, in standard deviations; 0 for a uniform prior."""
        if self.kind == "uniform":
            return 0.0
        if self.kind == "normal":
            return (value - self.first) / self.second
        return math.log(value / self.first) / self.second if value > 0.0 else math.inf


@dataclass(frozen=True)
class Free:
    """A free number: its full name such as "friction.a", its limits and its starting value (SI).

    The search works on the logarithm of a positive number (`log`), and otherwise in steps of `scale` (SI). `part` is the one part
    of the record that the number belongs to, or None. `bounded` is True if the user gave the limits. `given` is the value in the
    problem if the search starts from another one. `aside` is True for what is not known of the loading, and was not asked for.
    """

    name: str
    declared: Quantity
    start: float
    low: float
    high: float
    log: bool
    prior: Prior | None = None
    part: int | None = None
    scale: float = 1.0
    bounded: bool = False
    given: float | None = None
    aside: bool = False

    def begun_at(self, value: float) -> Free:
        """Return the number with another starting value; its former one becomes a second start."""
        return replace(self, start=value, given=self.start)

    @property
    def label(self) -> str:
        """The name with the number of its part, if it belongs to one."""
        return self.name if self.part is None else f"{self.name}[{self.part}]"

    def searched(self, value: float) -> float:
        """Return the searched number for a value (SI): its logarithm, or a multiple of the scale."""
        if not self.log:
            return value / self.scale
        return math.log(value) if value > 0.0 else -math.inf

    def natural(self, searched: float) -> float:
        """Return the value (SI) from the searched number."""
        return math.exp(min(searched, 700.0)) if self.log else searched * self.scale

    @property
    def slope(self) -> float:
        """The derivative of the value with respect to the searched number, where that is constant."""
        return self.scale

    def width(self, value: float, searched: float) -> float:
        """Return the standard deviation of the value (SI) from that of the searched number."""
        return abs(value) * searched if self.log else self.scale * searched

    @property
    def near(self) -> tuple[float, float]:
        """Lower and upper end of the range of starts, as searched numbers."""
        low, high = self.searched(self.low), self.searched(self.high)
        at = self.searched(self.start)
        reach = math.log(NEAR_KNOWN if self.declared.unit == "1" or self.name.startswith("body.") else NEAR) if self.log else 1.0
        if self.prior is not None and self.prior.kind != "uniform":
            around = self.searched(self.prior.first)
            wide = 2.0 * self.prior.second
            if not (self.log and self.prior.kind == "lognormal"):
                wide = wide / (max(abs(self.prior.first), 1e-300) if self.log else self.scale)
            at, reach = around, min(wide, 3.0 * reach)
        if self.bounded and math.isfinite(low) and math.isfinite(high):
            return low, high
        return max(low, at - reach), min(high, at + reach)


def read_free(problem: Problem, names: Sequence[str], hints: Mapping[str, float], **given: Any) -> tuple[Free, ...]:
    """Return the free numbers of a problem.

    `hints` has starting values for numbers that the problem lacks, such as "initial.state", and scales, as for "record.trend".
    `given` may hold `bounds`, `priors` and `start`, each a mapping by name. Raises InputError.
    """
    known = known_numbers(problem, hints)
    if isinstance(names, str):
        names = [one for one in names.split(",") if one.strip()]
    if not names or not all(isinstance(one, str) for one in names):
        raise InputError('infer: free must name at least one number, as ["friction.a", "friction.b"]')
    chosen = [full_name(one.strip(), known, "infer: free: ", "is no number of this problem", FREE_LISTED) for one in names]
    twice = next((one for one in chosen if chosen.count(one) > 1), None)
    if twice is not None:
        raise InputError(f"infer: free: {twice} is named twice")
    limits, priors, starts = (_by_name(given.get(what), chosen, what) for what in ("bounds", "priors", "start"))
    return tuple(
        _one(name, known[name], limits.get(name), _prior(priors.get(name), known[name][0], name), starts.get(name))
        for name in chosen
    )


def known_numbers(problem: Problem, hints: Mapping[str, float]) -> dict[str, tuple[Quantity, float]]:
    """Return declaration and value of every number that may be free."""
    found = {
        name: (one.declared, one.value)
        for name, one in problem.parameters.items()
        if not name.startswith("loading.") and name != "initial.second_state"  # the record has the loading
    }
    found[LOAD] = Quantity(problem.load_unit, "load at the start"), hints.get(LOAD, math.nan)
    if problem.friction.states:
        state = problem.friction.states[0]
        found[INITIAL_STATE] = (
            Quantity(state.unit, "state at the start", above=None if state.signed else 0.0),
            hints.get(INITIAL_STATE, math.nan),
        )
    found[TREND] = Quantity("1/m", "trend of friction with slip"), 0.0
    found[DRIFT] = Quantity("1/s", "drift of friction with time"), 0.0
    found[DELAY] = Quantity("s", "delay of the record behind the machine"), 0.0
    found[SERVO] = Quantity("s", "time in which the load point approaches a new rate", at_least=0.0), 0.0
    return found


def _by_name(given: Mapping[str, Any] | None, chosen: Sequence[str], what: str) -> dict[str, Any]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InputError(f"infer: {what} must be a mapping of names to values, got {shown(given)}")
    return {
        full_name(str(name), chosen, f"infer: {what}: ", "is not among the free numbers"): value for name, value in given.items()
    }


def _one(name: str, known: tuple[Quantity, float], limits: Any, prior: Prior | None, start: Any) -> Free:
    declared, value = known
    if start is not None:
        value = declared.check("infer", f"start: {name}", start)
    elif not math.isfinite(value) and prior is not None:
        value = prior.first
    positive = declared.above == 0.0 or declared.at_least == 0.0
    if not math.isfinite(value):
        raise InputError(f"infer: {name}: the problem does not say where to begin: give start={{'{name}': VALUE}}")
    log = bool(positive and value > 0.0)
    far = FARTHEST_PURE if declared.unit == "1" else FARTHEST
    low, high = (value / far, value * far) if log else (-math.inf, math.inf)
    least = next((one for one in (declared.above, declared.at_least) if one is not None), None)
    low = low if least is None else max(low, least)
    if prior is not None and prior.kind == "uniform":
        limits = (prior.first, prior.second) if limits is None else limits
    if limits is not None:
        low, high = _limits(name, declared, limits)
        if log and low <= 0.0:
            low = value / far if high > value / far else high / far
        if not low <= value <= high:
            value = math.sqrt(low * high) if log else 0.5 * (low + high)
    scale = _scale(name, value, low, high, prior)
    return Free(name, declared, value, low, high, log, prior, scale=scale, bounded=limits is not None)


def _scale(name: str, value: float, low: float, high: float, prior: Prior | None) -> float:
    if prior is not None and prior.kind == "normal":
        return prior.second
    if math.isfinite(low) and math.isfinite(high):
        return 0.25 * (high - low)
    return abs(value) or 1.0


def _limits(name: str, declared: Quantity, limits: Any) -> tuple[float, float]:
    try:
        low, high = limits
    except (TypeError, ValueError):
        raise InputError(f"infer: bounds: {name} must be two numbers, the lower one first, got {shown(limits)}") from None
    low, high = (end if end in (-math.inf, math.inf) else declared.check("infer", f"bounds: {name}", end) for end in (low, high))
    if not low < high:
        raise InputError(f"infer: bounds: {name}: the first must be smaller, got {low:g} and {high:g}")
    return float(low), float(high)


def _prior(given: Any, declared: Quantity, name: str) -> Prior | None:
    """Return a prior from a `Prior`, a text such as "normal(0.6, 0.05)", or (kind, first, second). Raises InputError."""
    if given is None or isinstance(given, Prior):
        return given
    if isinstance(given, str):
        found = _PRIOR.fullmatch(given)
        given = found.groups() if found else given
    wanted = f'infer: priors: {name} must be like "normal(0.6, 0.05)", "lognormal(10 um, 0.5)" or "uniform(0, 1)"'
    if (
        isinstance(given, str)
        or not isinstance(given, Sequence)
        or len(given) != 3
        or given[0] not in ("normal", "lognormal", "uniform")
    ):
        raise InputError(f"{wanted}, got {shown(given)}")
    kind, *numbers = given
    plain = Quantity("1", "", above=0.0)
    units = (
        replace(declared, above=None, at_least=None),
        plain if kind == "lognormal" else replace(declared, above=None, at_least=None),
    )
    first, second = (unit.check("infer", f"priors: {name}", _number(one)) for unit, one in zip(units, numbers, strict=True))
    if (
        (kind == "uniform" and not first < second)
        or (kind != "uniform" and second <= 0.0)
        or (kind == "lognormal" and first <= 0.0)
    ):
        raise InputError(f"{wanted}, got {kind}({first:g}, {second:g})")
    return Prior(kind, first, second)


def _number(one: Any) -> Any:
    if not isinstance(one, str):
        return one
    try:
        return float(one)
    except ValueError:
        return one.strip()


def with_scale(free: Iterable[Free], scales: Mapping[str, float]) -> tuple[Free, ...]:
    """Return free numbers, with scales (SI) for those that start at 0 and have no scale yet."""
    return tuple(replace(one, scale=scales[one.name]) if one.scale == 1.0 and one.name in scales else one for one in free)
