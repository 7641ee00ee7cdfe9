"""Search for the parameters of a law: choose the parameters to fit and their starting values, and minimise the sum of squares."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.other_values import with_values
from stickslip.foundation.quantities import LawField, NamedNumbers, NumberSeries, Quantity, fields_of
from stickslip.friction import FrictionLaw, Points
from stickslip.friction.contract import states_in

STEP = 1e-100
"""Imaginary step for derivatives of a formula; it loses no digit (Squire & Trapp 1998, SIAM Rev. 40, 110)."""


class Leaf(NamedTuple):
    """One parameter: its names in the formula and in the law, its declaration and its value.

    `optional` ones are 0 if they are not given.
    """

    inner: str
    full: str
    declared: Quantity
    value: float
    optional: bool = False

    @property
    def is_scale(self) -> bool:
        """True for a slip, a slip rate or the inverse of one whose sign is known: its size may be anything."""
        declared = self.declared
        positive = declared.above is not None or declared.at_least == 0.0 or (not declared.meaning and self.value > 0.0)
        return declared.unit != "1" and positive and not self.optional


def template(law: Any) -> FrictionLaw:
    """Return the law to fit, with values where a search may begin.

    `law` is a law, the class of one, or its name in scenario files; two names may be joined by + or *. Raises InputError for
    anything else, and for laws that no points determine.
    """
    from stickslip.friction import LAWS, SlipPlusRate, SlipTimesRate

    if isinstance(law, str):
        for mark, join in (("+", SlipPlusRate), ("*", SlipTimesRate)):
            if mark in law:
                slip, rate = (template(one.strip()) for one in law.split(mark, 1))
                return join(*((rate, slip) if rate.depends_on_slip else (slip, rate)))
        if law not in LAWS:
            hint = nearest(law, LAWS, listed="`stickslip new --list` lists all")
            raise InputError(f"fit: law {ascii(law)[:60]} is unknown; {hint}")
        law = LAWS[law]
    is_class = isinstance(law, type) and issubclass(law, FrictionLaw)
    if not is_class and not isinstance(law, FrictionLaw):
        raise InputError(f"fit: law must be a friction law or the name of one, got {shown(law)}")
    if states_in(law.state):  # the class of a law that users type has a property there
        of = "its steady friction" if hasattr(law, "steady_coefficient") else "friction in steady sliding"
        raise InputError(
            f"fit: {law.kind} has a state, which points do not show: {of} does not determine all of its parameters; "
            "fit velocity-strengthening, or another law without a state"
        )
    law = _example(law) if is_class else law
    if law.backward_from:
        each = "points with slip rates of both signs give BothWays by themselves"
        raise InputError(f"fit: {law.kind} differs with the direction of slip: name the law of one direction, {each}")
    if not leaves(law):
        raise InputError(f"fit: {law.kind} has no parameters to be fitted: use smooth, or FromTable for exact interpolation")
    return law  # type: ignore[no-any-return] # checked above


def _example(law: type[FrictionLaw]) -> FrictionLaw:
    """Return a law with the values of its example. Raises InputError for a law that consists of parts or of points."""
    for declared, _ in fields_of(law).values():
        if isinstance(declared, LawField):
            raise InputError(f"fit: {law.kind} is made of laws: give it with its parts, or join two names by + or *")
        if isinstance(declared, NumberSeries):
            raise InputError(f"fit: {law.kind} is given by points: use smooth, or FromTable for exact interpolation")
        if isinstance(declared, NamedNumbers):
            raise InputError(f"fit: {law.kind} has parameters of your own: give the law itself, with values to begin with")
    return law(**law.example)


def leaves(law: FrictionLaw, inner: str = "", outer: str = "") -> dict[str, Leaf]:
    """Return the parameters of a law by their names in scenario files, such as "alpha" or "rate.alpha" in a part."""
    found: dict[str, Leaf] = {}
    fields = fields_of(type(law))
    is_expression = any(isinstance(declared, NamedNumbers) for declared, _ in fields.values())
    for name, (declared, default) in fields.items():
        value = getattr(law, name)
        if isinstance(declared, Quantity) and value is not None and not is_expression:
            found[outer + name] = Leaf(inner + name, outer + name, declared, value, default == 0.0)
        elif isinstance(declared, NamedNumbers):
            for one in value:
                full = f"{outer}{declared.key}.{one.name}"
                found[outer + one.name] = Leaf(inner + one.name, full, Quantity(one.unit or "1", ""), one.value)
        elif isinstance(declared, LawField):
            found |= leaves(value, f"{inner}{name}_", f"{outer}{name}.")
    return found


def rebuilt(law: FrictionLaw, values: Mapping[str, float], *, checked: bool = True) -> FrictionLaw:
    """Return the law with other values of parameters. Raises InputError if it is no law; unchecked ones are only evaluated."""
    known = leaves(law)
    return with_values(
        law, {known[name].full: value for name, value in values.items()}, dataclasses.replace if checked else _changed
    )


def _changed(law: Any, **changes: Any) -> Any:
    """Return a law with other fields, which are not checked, and all that it remembers: its formula stays."""
    made = copy.copy(law)
    vars(made).update(changes)
    return made


def slopes(law: FrictionLaw, names: list[str], u: Floats, v: Floats) -> Floats:
    """Return the derivatives of the friction coefficient with respect to parameters, shape (n, number of names).

    `u` and `v` (m and m/s) have shape (n,). The derivatives are exact but for rounding.
    """
    known, result = leaves(law), np.zeros((len(u), len(names)))
    piece = law.piece_at(u, v)
    for i in np.unique(piece).tolist():
        chosen, numbers = piece == i, law.numbers(i)
        for column, name in enumerate(names):
            inner = known[name].inner
            if inner in numbers:
                stepped = SimpleNamespace(**(numbers | {inner: complex(numbers[inner], STEP)}))
                with np.errstate(all="ignore"):
                    mu = law.pieces[i](stepped, u[chosen].astype(complex), v[chosen].astype(complex))
                result[chosen, column] = np.imag(mu) / STEP
    return result


def numbers_of(given: Mapping[str, Any] | None, known: Mapping[str, Leaf], what: str) -> dict[str, float]:
    """Return given values of parameters, numbers or texts with a unit, in SI. Raises InputError for unknown names and values."""
    found = {}
    if given is not None and not isinstance(given, Mapping):
        raise InputError(f"fit: {what} must be a mapping of names to values, got {shown(given)}")
    for name, value in (given or {}).items():
        if name not in known:
            raise InputError(f"fit: {what} {ascii(name)[:60]} is no parameter of this law; {nearest(str(name), known)}")
        found[name] = known[name].declared.check("fit", f"{what} {name}", value)
    return found


PER_SCALE = 9
"""Number of starts along a slip or a slip rate of the law, evenly spaced in the logarithm over the points and a factor 3 beyond."""
MOST_WAVES = 100
"""Searches begin with at most this many half waves in the range of the points."""
MOST_STARTS = 600
"""Largest number of starts; of more, every second, third and so on is taken."""
FARTHEST = 1e6
"""A slip or a slip rate of the law may be beyond all starts by this factor; farther out it has no effect on the points."""
FOLLOWED = 4
"""The search is carried to its end from this many of the best starts."""
POINTS_OF_STARTS = 2000
"""Starts are compared on this many points."""
EXPONENTS = (1.0, 2.0, 3.0, 4.0)
"""Exponents to try."""


class _Model:
    """A law with some free parameters, and the points that they are to fit.

    The search works on logarithms of parameters that must be positive, such as slip rates.
    """

    def __init__(self, law: FrictionLaw, free: list[str], points: Points) -> None:
        known = leaves(law)
        self.law, self.free, self.points = law, free, points
        self.leaves = [known[name] for name in free]
        self.sizes = [_sizes(leaf, points) for leaf in self.leaves]
        self.logarithmic = np.array([leaf.is_scale for leaf in self.leaves], bool)
        ends = [_ends(leaf, sizes) for leaf, sizes in zip(self.leaves, self.sizes, strict=True)]
        self.bounds = self.searched([low for low, _ in ends]), self.searched([high for _, high in ends])

    def searched(self, natural: Sequence[float]) -> Floats:
        return np.log(natural, where=self.logarithmic, out=np.array(natural, float))

    def natural(self, searched: Floats) -> Floats:
        return np.exp(searched, where=self.logarithmic, out=searched.copy())

    def at(self, searched: Floats) -> FrictionLaw:
        return rebuilt(self.law, dict(zip(self.free, self.natural(searched).tolist(), strict=True)), checked=False)

    def differences(self, searched: Floats) -> Floats:
        """Return the law minus the points, shape (n,)."""
        return np.asarray(self.at(searched).coefficient(*self.points.variables)) - self.points.friction

    def jacobian(self, searched: Floats) -> Floats:
        """Return the derivatives of `differences` with respect to the searched numbers, shape (n, number of free parameters)."""
        plain = slopes(self.at(searched), self.free, *self.points.variables)
        return np.nan_to_num(plain) * np.where(self.logarithmic, self.natural(searched), 1.0)

    def solved(self, start: Floats, **options: Any) -> Any:
        from scipy.optimize import least_squares

        return least_squares(self.differences, start, self.jacobian, self.bounds, x_scale="jac", **options)


def search(law: FrictionLaw, free: list[str], points: Points, start: Mapping[str, float]) -> tuple[float, dict[str, float]]:
    """Return the smallest sum of squares found, and the free parameters there.

    `start` has the starting values of some free parameters for all searches; those of the others follow from the points.
    Raises InputError if the law is not finite at any start.
    """
    every = slice(None, None, -(-len(points) // POINTS_OF_STARTS))
    slip, rate = (None if one is None else one[every] for one in (points.slip, points.slip_rate))
    thin = _Model(law, free, Points(points.friction[every], slip, rate, points.name, points.slips_in))
    model = _Model(law, free, points)
    begun = [_with_linear_part(thin, one) for one in _starts(thin, start)]
    begun = sorted((one for one in begun if np.isfinite(one[0])), key=lambda one: one[0])
    if not begun:
        raise InputError(f"fit: {law.kind} is not a finite number where the search begins: give other values with start")
    best = min((thin.solved(one, xtol=1e-6, max_nfev=60) for _, one in begun[:FOLLOWED]), key=lambda found: found.cost)
    found = model.solved(np.clip(best.x, *model.bounds), xtol=1e-13, ftol=1e-13, gtol=1e-13, max_nfev=200)
    idle = ~np.any(found.jac, axis=0)  # these have no effect, and may have gone anywhere
    values = model.natural(np.where(idle, begun[0][1], found.x))
    return 2.0 * float(found.cost), dict(zip(free, values.tolist(), strict=True))


def _with_linear_part(model: _Model, searched: Floats) -> tuple[float, Floats]:
    """Return the sum of squares at a start, and the start, after one step that solves for friction coefficients and viscosities.

    Most laws are linear in these, so that they follow from slips and slip rates of the law.
    """
    linear = np.array([not leaf.is_scale and (leaf.declared.unit == "1" or leaf.optional) for leaf in model.leaves])
    with np.errstate(all="ignore"):
        before, columns = model.differences(searched), model.jacobian(searched)[:, linear]
        if linear.any() and np.isfinite(before).all() and np.isfinite(columns).all():
            improved = searched.copy()
            improved[linear] -= np.linalg.lstsq(columns, before, rcond=1e-12)[0]
            searched = np.clip(improved, *model.bounds)
        return float(np.sum(model.differences(searched) ** 2)), searched


def _starts(model: _Model, given: Mapping[str, float]) -> Iterator[Floats]:
    """Yield the starts of searches, as searched numbers: all combinations of possible sizes of the law's slips and slip rates."""
    choices = [[given[name]] if name in given else sizes for name, sizes in zip(model.free, model.sizes, strict=True)]
    combined = list(product(*choices))
    for one in combined[:: -(-len(combined) // MOST_STARTS)]:
        yield np.clip(model.searched(one), *model.bounds)


def _ends(leaf: Leaf, sizes: Sequence[float]) -> tuple[float, float]:
    """Return the smallest and the largest value of a parameter in a search that begins with some sizes."""
    if leaf.is_scale:
        return min(sizes) / FARTHEST, max(sizes) * FARTHEST
    least = leaf.declared.at_least
    return -np.inf if least is None else least, np.inf


def _sizes(leaf: Leaf, points: Points) -> Sequence[float]:
    """Return starting values for a parameter, by its unit."""
    slip, rate = points.variables
    unit = leaf.declared.unit
    if unit == "1":
        return [float(points.friction.max()) if leaf.declared.meaning else leaf.value]
    if unit == "m":
        reach = float(np.ptp(slip)) or 1.0
        return np.geomspace(reach / 30.0, 3.0 * reach, PER_SCALE).tolist() if leaf.is_scale else [0.0, 0.1 * reach, 0.3 * reach]
    if unit in ("1/m", "m^-1"):
        waves = np.arange(1.0, 1.0 + min(MOST_WAVES, len(points) // 2))
        return list(np.pi / (float(np.ptp(slip)) or 1.0) * waves)
    if unit in ("m/s", "m s^-1", "s/m", "m^-1 s") and leaf.is_scale:
        moving = rate[rate > 0.0]
        slowest, fastest = (float(moving.min()), float(moving.max())) if len(moving) else (1.0, 1.0)
        sizes = np.geomspace(max(slowest, 1e-9 * fastest) / 3.0, 3.0 * fastest, PER_SCALE)
        return list(sizes if unit in ("m/s", "m s^-1") else 1.0 / sizes)
    return [0.0 if leaf.optional else leaf.value]
