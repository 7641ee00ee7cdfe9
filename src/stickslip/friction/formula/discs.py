"""Evaluate a formula on discs of complex numbers around real centres, by numpy and without anything that the engine compiles.

The disc of a node contains every value that it takes for arguments in their own discs, the rounding of this evaluation included.
With radii of next to nothing that is the formula at a point, and how far rounding may have moved it; with the radii of a step it
bounds the formula around all of it. A disc on which an operation has no analytic continuation gets an infinite radius, or one that
is not a number. Source: Rump 2010, Verification methods, Acta Numerica 19.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.expression import Expression, nodes_of

ROUNDING = 1.2e-16
"""Relative rounding (1) of a sum, product or quotient."""
OF_FUNCTION = 8.0 * ROUNDING
"""The same of a function of the mathematical library: four units in the last place."""
LARGEST_EXPONENT = 700.0
"""Exponent (1) beyond which nothing is known of exp but that it is larger than e^700: enough where it is a denominator."""


class Disc(NamedTuple):
    """A disc: its real centre, its radius, and a lower bound of the magnitude of all values that the node may have in it.

    An exponential varies by orders of magnitude on a disc and stays away from zero, which a radius alone cannot express.
    """

    centre: Any
    radius: Any
    least: Any

    @classmethod
    def of(cls, centre: ArrayLike, radius: ArrayLike = 0.0) -> Disc:
        """Return the disc with a given centre and radius."""
        middle = np.asarray(centre, float)
        return cls(middle, radius, np.maximum(np.abs(middle) - radius, 0.0))

    @property
    def most(self) -> Any:
        """The largest magnitude in the disc."""
        return np.abs(self.centre) + self.radius

    def rounded(self, by: ArrayLike = ROUNDING, least: ArrayLike = 0.0) -> Disc:
        """Return the disc with a radius that contains a relative rounding of its centre, and with a better lower bound."""
        size = np.abs(self.centre)
        radius = self.radius + by * size
        return Disc(self.centre, radius, np.fmax(np.fmax(size - radius, np.multiply(least, 1.0 - 1e-14)), 0.0))


def on_discs(tree: Expression, numbers: Mapping[str, ArrayLike], variables: Mapping[Expression, Disc]) -> Disc:
    """Return a formula on the discs of its variables, which broadcast; `numbers` holds the law's parameters by name."""
    found = dict(variables)
    with np.errstate(all="ignore"):
        for node in nodes_of(tree):
            if node.arguments:
                found[node] = _RULES[node.operation](*(found[argument] for argument in node.arguments))
            elif node not in found:
                found[node] = Disc.of(np.asarray(numbers[node.name] if node.operation == "parameter" else node.value, float))
    return found[tree]


def _apart(a: Disc, b: Disc) -> Any:
    """Return a lower bound of a sum or difference one of whose terms is the larger one everywhere."""
    return np.maximum(a.least - b.most, b.least - a.most)


def _add(a: Disc, b: Disc) -> Disc:
    return Disc(a.centre + b.centre, a.radius + b.radius, 0.0).rounded(least=_apart(a, b))


def _sub(a: Disc, b: Disc) -> Disc:
    return Disc(a.centre - b.centre, a.radius + b.radius, 0.0).rounded(least=_apart(a, b))


def _mul(a: Disc, b: Disc) -> Disc:
    radius = np.abs(a.centre) * b.radius + b.most * a.radius
    return Disc(a.centre * b.centre, radius, 0.0).rounded(least=a.least * b.least)


def _div(a: Disc, b: Disc) -> Disc:
    centre = a.centre / b.centre
    moved = np.fmin((a.radius + np.abs(centre) * b.radius) / b.least, a.most / b.least + np.abs(centre))
    return Disc(centre, moved, 0.0).rounded(least=a.least / b.most)


def _turned(a: Disc) -> Any:
    """Return an upper bound of |log(value / centre)|, which is not a number where the disc reaches zero."""
    return -np.log1p(-a.radius / np.abs(a.centre))


def _pow(a: Disc, b: Disc) -> Disc:
    """Return a power whose exponent is a number of the law; a whole one above zero may pass zero."""
    exponent, size = b.centre, np.abs(a.centre)
    power = size**exponent
    radius = power * np.expm1(np.abs(exponent) * _turned(a))
    radius = np.where((exponent == np.rint(exponent)) & (exponent > 0.0), a.most**exponent - power, radius)
    least = np.minimum(a.least**exponent, a.most**exponent)
    by = OF_FUNCTION * (1.0 + np.abs(exponent) * (1.0 + np.abs(np.log(np.maximum(size, 1e-300)))))
    return Disc(a.centre**exponent, radius, 0.0).rounded(by, least)


def _exp(a: Disc) -> Disc:
    centre = np.exp(np.minimum(a.centre, LARGEST_EXPONENT))
    radius = np.where(a.centre > LARGEST_EXPONENT, np.inf, centre * np.expm1(a.radius))
    return Disc(centre, radius, 0.0).rounded(OF_FUNCTION, np.exp(np.minimum(a.centre - a.radius, LARGEST_EXPONENT)))


def _expm1(a: Disc) -> Disc:
    power = _exp(a)
    return Disc(np.expm1(np.minimum(a.centre, LARGEST_EXPONENT)), power.radius, 0.0).rounded(OF_FUNCTION, power.least - 1.0)


def _log(a: Disc) -> Disc:
    return Disc(np.log(a.centre), _turned(a), 0.0).rounded(OF_FUNCTION)


def _log1p(a: Disc) -> Disc:
    return Disc(np.log1p(a.centre), _turned(Disc(1.0 + a.centre, a.radius, 0.0)), 0.0).rounded(OF_FUNCTION)


def _sqrt(a: Disc) -> Disc:
    centre = np.sqrt(a.centre)
    return Disc(centre, centre * np.expm1(0.5 * _turned(a)), 0.0).rounded(OF_FUNCTION, np.sqrt(a.least))


def _wave(own: Any, other: Any, radius: Any) -> Disc:
    """Return sin or cos, from both at the centre: sin(m + d) = sin m cos d + cos m sin d."""
    moved = np.abs(own) * 2.0 * np.sinh(0.5 * radius) ** 2 + np.abs(other) * np.sinh(radius)
    return Disc(own, moved, 0.0).rounded(OF_FUNCTION)


def _tanh(a: Disc) -> Disc:
    """Return tanh, by |tanh z - tanh m| = |sinh(z - m)| / (|cosh z| |cosh m|), or by 2 / |exp(2 z) + 1| far from zero.

    |cosh z| is at least |cosh m| (cos r - |tanh m| sinh r) for a radius r below pi / 2, and at least sinh of the real part.
    """
    centre, size = np.tanh(a.centre), np.cosh(a.centre)
    apart, sinh = np.abs(a.centre) - a.radius, np.sinh(a.radius)
    least = np.maximum(size * (np.cos(np.minimum(a.radius, 2.0)) - np.abs(centre) * sinh), np.sinh(apart))
    near = np.where(least > 0.0, sinh / (least * size), np.inf)
    far = np.where(apart > 0.0, 4.0 / np.expm1(2.0 * apart), np.inf)
    return Disc(centre, np.fmin(near, far), 0.0).rounded(OF_FUNCTION)


def _arcsinh(a: Disc) -> Disc:
    """Return arcsinh, whose derivative 1 / sqrt((z - i)(z + i)) has its singularities at i and -i."""
    return Disc(np.arcsinh(a.centre), -np.log1p(-a.radius / np.hypot(1.0, a.centre)), 0.0).rounded(OF_FUNCTION)


_RULES: dict[str, Callable[..., Disc]] = {
    **{"add": _add, "sub": _sub, "mul": _mul, "div": _div, "pow": _pow, "exp": _exp, "expm1": _expm1, "log": _log},
    **{"log1p": _log1p, "sqrt": _sqrt, "tanh": _tanh, "arcsinh": _arcsinh},
    "sin": lambda a: _wave(np.sin(a.centre), np.cos(a.centre), a.radius),
    "cos": lambda a: _wave(np.cos(a.centre), np.sin(a.centre), a.radius),
}
"""Rule of each operation."""


def largest(values: Disc) -> Floats:
    """Return an upper bound of the magnitude on each disc; infinite where nothing is known."""
    return np.asarray(np.nan_to_num(values.most, nan=np.inf, posinf=np.inf))
