"""The parameters of a law that can be fitted: their places in the law, their declarations, and the law for other values."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.other_values import with_values
from stickslip.foundation.quantities import NamedNumbers, Part, Quantity, Series, fields_of
from stickslip.friction.contract import states_in
from stickslip.friction.law import FrictionLaw

STEP = 1e-100
"""Imaginary step by which a formula is differentiated; it loses no digit (Squire & Trapp 1998, SIAM Rev. 40, 110)."""


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
    """Return the law whose parameters are to be fitted, with the values at which a search may begin.

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
            raise InputError(f"fit: law {ascii(law)[:60]} is unknown; {nearest(law, LAWS)}")
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
    if not leaves(law):
        raise InputError(f"fit: {law.kind} has no parameters to be fitted: use smooth, or FromTable for exact interpolation")
    return law  # type: ignore[no-any-return] # checked above


def _example(law: type[FrictionLaw]) -> FrictionLaw:
    """Return a law with the values of its example. Raises InputError for a law that consists of parts or of points."""
    for declared, _ in fields_of(law).values():
        if isinstance(declared, Part):
            raise InputError(f"fit: {law.kind} is made of laws: give it with its parts, or join two names by + or *")
        if isinstance(declared, Series):
            raise InputError(f"fit: {law.kind} is given by points: use smooth, or FromTable for exact interpolation")
        if isinstance(declared, NamedNumbers):
            raise InputError(f"fit: {law.kind} has parameters of your own: give the law itself, with values to begin with")
    return law(**law.example)


def leaves(law: FrictionLaw, inner: str = "", outer: str = "") -> dict[str, Leaf]:
    """Return the parameters of a law by their names in scenario files, such as "alpha" or "rate.alpha" in a part."""
    found: dict[str, Leaf] = {}
    for name, (declared, default) in fields_of(type(law)).items():
        value = getattr(law, name)
        if isinstance(declared, Quantity) and value is not None and not _is_expression(law):
            found[outer + name] = Leaf(inner + name, outer + name, declared, value, default == 0.0)
        elif isinstance(declared, NamedNumbers):
            for one in value:
                full = f"{outer}{declared.key}.{one.name}"
                found[outer + one.name] = Leaf(inner + one.name, full, Quantity(one.unit or "1", ""), one.value)
        elif isinstance(declared, Part):
            found |= leaves(value, f"{inner}{name}_", f"{outer}{name}.")
    return found


def _is_expression(law: FrictionLaw) -> bool:
    return any(isinstance(declared, NamedNumbers) for declared, _ in fields_of(type(law)).values())


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
