"""Make a friction law from an expression in u and v with named parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar, Literal

import numpy as np
from typing_extensions import override

from stickslip.foundation.conversion import Converted, WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Choice, Named, NamedNumbers, Text, declare, quantity
from stickslip.friction.contract import Formula
from stickslip.friction.custom.sampled import check_samples
from stickslip.friction.families import RemembersSlip
from stickslip.friction.formula.bounds import bounds
from stickslip.friction.formula.dimensions import check_dimensions
from stickslip.friction.formula.expression import SLIP, Expression, depends_on, evaluate, nodes_of
from stickslip.friction.formula.parse import LARGEST_EXPONENT, LONGEST, RESERVED, parse

MOST_PARAMETERS = 50
"""Largest number of parameters of an expression, which comes from an untrusted scenario file."""
LONGEST_NAME = 40
"""Largest number of characters in the name of a parameter, so that messages and tables stay readable."""


@dataclass(frozen=True)
class FromExpression(RemembersSlip):
    """mu(u, v) as the user writes it, u the slip (m) that `counts` names and v >= 0 the slip rate (m/s).

    For example `FromExpression("mu_d + (mu_s - mu_d) / (1 + alpha*v)", {"mu_s": 0.8, "mu_d": 0.3, "alpha": "1 s/m"})`. `values` has
    the parameters by name, as numbers in SI or as texts with a unit. The text is never evaluated as Python.

    The static friction coefficient is the value at v = 0, unless `static` gives a higher one: friction then drops by the difference
    as soon as the contact slips.

    The expression must not be negative and must have all derivatives, also where slip begins, at v = 0. Both are checked on
    samples up to 10 m and 10 m/s. Units are checked if at least one value has a unit; a value without one is then a pure number.
    """

    kind = "expression"
    source = "the user's formula"
    example: ClassVar = {
        "expression": "mu_d + (mu_s - mu_d) / (1 + alpha*v)",
        "values": {"mu_s": 0.8, "mu_d": 0.3, "alpha": "1 s/m"},
    }

    expression: str = declare(Text("friction coefficient in u (slip, m), v (slip rate, m/s) and parameters", LONGEST))
    values: Converted[tuple[Named, ...], Mapping[str, float | str | WithUnit] | Sequence[Named]] = declare(
        NamedNumbers("values of the parameters", "parameters"), ()
    )
    _: KW_ONLY
    static: float | None = quantity("1", "friction coefficient at rest, if above that at v = 0+", at_least=0, default=None)
    counts: Literal["net", "path"] = declare(Choice("slip that u denotes", ("net", "path")), "net")  # type: ignore[misc] # here a choice of the user

    @override
    def check(self) -> None:
        self._check_names()
        units = {value.name: value.unit for value in self.values}
        try:
            if any(units.values()):
                check_dimensions(self.tree, units)
            self._check_exponents()
            check_samples(self.tree, self.numbers(), backwards=self.counts == "net")
        except InputError as error:
            raise InputError(f"FromExpression: expression: {error}") from None
        if self.static is not None:
            self._check_static(self.static)

    def _check_names(self) -> None:
        names = [value.name for value in self.values]
        if len(names) > MOST_PARAMETERS:
            raise InputError(f"FromExpression: parameters: at most {MOST_PARAMETERS} parameters are allowed")
        for name in names:
            if not (isinstance(name, str) and name.isidentifier() and name.isascii() and len(name) <= LONGEST_NAME):
                raise InputError(f"FromExpression: parameters: {ascii(name)[:60]} is not a name: letters, digits and _, up to 40")
            if name in RESERVED or names.count(name) > 1:
                raise InputError(f"FromExpression: parameters: the name {name} is reserved or used twice")
        used = {node.name for node in nodes_of(self.tree) if node.operation == "parameter"}
        for name in names:
            if name not in used:
                hint = nearest(name, used) if used else "the expression has no parameters"
                raise InputError(f"FromExpression: parameters: {name} does not occur in the expression; {hint}")

    def _check_exponents(self) -> None:
        for node in nodes_of(self.tree):
            if node.operation == "pow":
                with np.errstate(all="ignore"):
                    exponent = float(evaluate(node.arguments[1], self.numbers(), 0.0, 0.0))
                if not abs(exponent) <= LARGEST_EXPONENT:
                    raise InputError(f"an exponent is {exponent:g}, it must be within {LARGEST_EXPONENT:g}")

    def _check_static(self, static: float) -> None:
        if depends_on(self.tree, SLIP):
            raise InputError("FromExpression: static needs an expression without u: the step at rest would change with slip")
        sliding = float(self.coefficient(0.0))
        if static < sliding:
            raise InputError(f"FromExpression: static must be at least the expression at v = 0, got {static:g} < {sliding:g}")

    @property
    def tree(self) -> Expression:
        """The formula as an expression tree."""
        try:
            return parse(self.expression, tuple(value.name for value in self.values))
        except InputError as error:
            raise InputError(f"FromExpression: expression: {error}") from None

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        tree, names = self.tree, self.parameters()
        return (lambda law, u, v: evaluate(tree, {name: getattr(law, name) for name in names}, u, v),)

    @override
    def parameters(self) -> tuple[str, ...]:
        return tuple(value.name for value in self.values)

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        return tuple(value.value for value in self.values)

    @property
    @override
    def static_excess(self) -> float:
        return 0.0 if self.static is None else self.static - float(self.coefficient(0.0))

    @override
    def range(self) -> tuple[float, float]:
        """Return bounds of the expression over all slips and slip rates, the lower one raised to 0 if it is negative.

        The upper bound includes the coefficient at rest.
        """
        low, high = self._bounds()
        return max(low, 0.0), max(high, self.static or 0.0)

    @property
    @override
    def can_be_negative(self) -> bool:
        return not self._bounds()[0] >= 0.0

    def _bounds(self) -> tuple[float, float]:
        slip = (0.0 if self.counts == "path" else -math.inf, math.inf)
        return bounds(self.tree, self.numbers(), slip, (0.0, math.inf))

    @property
    @override
    def variation(self) -> float:
        """The finite size by which friction changes (no unit).

        If the bounds are not finite, it is the range of the values at slips up to 10 m and slip rates up to 10 m/s.
        """
        low, high = self.range()
        if math.isfinite(high):
            return high - low
        slip, rate = np.linspace(0.0, 10.0, 201)[:, None], np.append(0.0, np.geomspace(1e-9, 10.0, 200))
        values = self.coefficient(slip, rate)
        return max(float(np.ptp(values)), self.static_excess)

    @property
    @override
    def rate_scales(self) -> tuple[float, ...]:
        """The characteristic slip rates (m/s): values in m/s, and inverses of values in s/m.

        If no value has a unit, any number of the expression may be a slip rate or the inverse of one: both are returned.
        """
        units = {value.unit for value in self.values} - {""}
        scales = [
            abs(value.value) ** (1 if value.unit == "m s^-1" else -1)
            for value in self.values
            if value.value and value.unit in _RATES
        ]
        if units:
            return tuple(scales)
        constants = [node.value for node in nodes_of(self.tree) if node.operation == "constant"]
        sizes = [abs(number) for number in (*self.piece_values(0), *constants) if number]
        return tuple(dict.fromkeys(scale for size in sizes for scale in (size, 1.0 / size)))


_RATES = ("m s^-1", "m^-1 s")
"""Units of slip rates and of their inverses, as `si_base` writes them."""
