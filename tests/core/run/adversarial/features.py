"""Features that a friction law may hide from a solver, each as text for the package and as plain Python for the truth."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Variable = Literal["u", "v"]
RIPPLES = 30.0
"""Phase of a ripple per width of its envelope, rad."""


@dataclass(frozen=True)
class Shape:
    """A function of one variable x with amplitude a, centre c and width w."""

    text: str
    value: Callable[[float, float, float, float], float]
    fineness: float = 1.0
    """Widths of the smallest detail, in w."""


@dataclass(frozen=True)
class Feature:
    """A shape of the slip (u, m) or of the slip rate (v, m/s)."""

    shape: str
    variable: Variable
    amplitude: float
    centre: float
    width: float

    @property
    def detail(self) -> float:
        """Size of its smallest detail, in the unit of its variable."""
        return self.width * SHAPES[self.shape].fineness

    def value(self, x: float) -> float:
        """Contribution to the coefficient of friction."""
        return SHAPES[self.shape].value(x, self.amplitude, self.centre, self.width)

    def text(self, number: int) -> str:
        """The formula, with parameters that carry a number."""
        names = {name: f"{name}{number}" for name in "acw"}
        return SHAPES[self.shape].text.format(x=self.variable, **names)

    def values(self, number: int) -> dict[str, float]:
        """Values of the parameters in the formula."""
        found = {f"a{number}": self.amplitude, f"c{number}": self.centre, f"w{number}": self.width}
        return {name: value for name, value in found.items() if name in self.text(number)}


def safe_exp(x: float) -> float:
    """exp(x), held below the largest float."""
    return math.exp(min(x, 700.0))


def _ripple(x: float, a: float, c: float, w: float) -> float:
    y = (x - c) / w
    return a * math.sin(RIPPLES * y) * safe_exp(-(y**2))


SHAPES = {
    "bump": Shape("{a}*exp(-(({x}-{c})/{w})**2)", lambda x, a, c, w: a * safe_exp(-(((x - c) / w) ** 2))),
    "step": Shape("{a}*tanh(({x}-{c})/{w})", lambda x, a, c, w: a * math.tanh((x - c) / w)),
    "tail": Shape("{a}*exp(-{x}/{w})", lambda x, a, c, w: a * safe_exp(-x / w)),
    "ripple": Shape("{a}*sin(30*(({x}-{c})/{w}))*exp(-(({x}-{c})/{w})**2)", _ripple, 1.0 / RIPPLES),
    "lorentz": Shape("{a}/(1+(({x}-{c})/{w})**2)", lambda x, a, c, w: a / (1.0 + ((x - c) / w) ** 2)),
    "corner": Shape("{a}*sqrt(({x}-{c})**2+{w}**2)", lambda x, a, c, w: a * math.sqrt((x - c) ** 2 + w**2)),
    "logistic": Shape("{a}/(1+exp(({x}-{c})/{w}))", lambda x, a, c, w: a / (1.0 + safe_exp((x - c) / w))),
}
"""Every shape; a tail begins at x = 0, the amplitude of a corner is its slope."""


@dataclass(frozen=True)
class Recipe:
    """mean + sum of features, or mean times the product of (1 + feature): a formula in text and in Python."""

    mean: float
    features: tuple[Feature, ...]
    product: bool = False

    def value(self, u: float, v: float) -> float:
        """The coefficient of friction at slip u (m) and slip rate v (m/s)."""
        parts = [f.value(u if f.variable == "u" else v) for f in self.features]
        return self.mean * math.prod(1.0 + part for part in parts) if self.product else self.mean + sum(parts)

    @property
    def text(self) -> str:
        """The formula for `FromExpression`."""
        parts = [f.text(n) for n, f in enumerate(self.features)]
        return "m*" + "*".join(f"(1+{part})" for part in parts) if self.product else "+".join(["m", *parts])

    @property
    def parameters(self) -> dict[str, float]:
        """Values of the formula's parameters."""
        found = {"m": self.mean}
        for n, feature in enumerate(self.features):
            found |= feature.values(n)
        return found

    def sees(self, variable: Variable) -> bool:
        """Return True if friction depends on the variable."""
        return any(f.variable == variable for f in self.features)
