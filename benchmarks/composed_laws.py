"""Random compositions of depth 4, of all functions and operators, with features of random narrowness hidden in them.

The structure of a formula and its numbers are drawn apart: formulas that differ in their numbers alone share machine code.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import stickslip as ss
from benchmarks.enclosures import Law

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
BLOCK = ss.SpringBlock(1.0, 20.0, 10.0)
SLAB_EXCESS, SLAB_TIME, BLOCK_EXCESS, BLOCK_TIME = 1.2e7, 3.0, 8.0, 2.0
MEAN = 0.6
KINDS = {"slab, u": "u", "block, v": "v", "block, u and v": "uv"}
ATOMS = (
    "exp(-(({x}-{c})/{w})**2)",
    "1/(1+(({x}-{c})/{w})**2)",
    "tanh(({x}-{c})/{w})",
    "1/(1+exp(({x}-{c})/{w}))",
    "exp(-{x}/{w})",
    "(log(({x}-{c})**2+4*{w}**2)-log(({x}-{c})**2+{w}**2))/log(4)",
    "(arcsinh(({x}-{c})/{w})-arcsinh(({x}-{c})/(2*{w})))/log(2)",
    "({x}-{c})/sqrt(({x}-{c})**2+{w}**2)",
    "(1+(({x}-{c})/{w})**2)**-{p}",
    "sin({k}*{x})",
    "cos({k}*{x})",
    "{x}/({q}+{x})",
    "log(1+{x}/{q})/3",
    "{x}-{c}",
)
"""Functions of one variable: features with a centre c and a width w, and smooth ones."""
JOINTS = (
    "({a})*({b})",
    "0.5*(({a})+({b}))",
    "0.5*(({a})-({b}))",
    "({a})/(1+({b})**2)",
    "({a})/(1+exp({k}*({b})))",
    "({a})/((1+({b})**2)*(1+exp(-({a}))))",
    "({a})**{n}",
    "(({a})**2)**{n}",
    "(({a})**{n})**{m}",
    "({q}+({a})**2)**{p}",
    "sin({k}*({a}))",
    "cos({k}*({a})+({b}))",
    "exp(-{k}*({a})**2)",
    "exp({a})/3",
    "exp(-exp({k}*({a})))",
    "tanh({k}*(({a})-{q}))",
    "arcsinh({k}*({a}))/3",
    "log(1+{k}*({a})**2)/3",
    "log(2+({a})**2)-log(1+({b})**2)",
    "sqrt({q}**2+({a})**2)",
)
"""Operators and functions of one or two parts a and b."""
DEPTH = 4
SAMPLES = 2001


@dataclass
class _Drawing:
    """A formula under construction: one generator for its structure, one for its numbers."""

    structure: np.random.Generator
    numbers: np.random.Generator
    variables: str
    features: list[tuple[str, float, float]] = field(default_factory=list)
    given: dict[str, float] = field(default_factory=dict)

    def part(self, depth: int) -> str:
        """Text of a random part; most of the ways end at the full depth."""
        if depth == 0 or self.structure.random() < 0.1:
            return self._filled(str(self.structure.choice(ATOMS)), str(self.structure.choice(list(self.variables))))
        joint = str(self.structure.choice(JOINTS))
        texts = {name: self.part(depth - 1) for name in "ab" if "{" + name + "}" in joint}
        return self._filled(joint, "", **texts)

    def _filled(self, template: str, variable: str, **texts: str) -> str:
        n, m = (int(x) for x in self.structure.integers(2, (13, 9)))
        c, w = self.numbers.uniform(0.05, 1.2), 10.0 ** self.numbers.uniform(-6.0, -1.0)
        k, p, q = 10.0 ** self.numbers.uniform(-0.5, 1.2), self.numbers.uniform(0.3, 3.0), self.numbers.uniform(0.2, 0.8)
        if variable and "{w}" in template:
            self.features.append((variable, float(c) if "{c}" in template else 0.0, float(w)))
        names = {
            name: self._named(value)
            for name, value in (("c", c), ("w", w), ("k", k), ("p", p), ("q", q))
            if "{" + name + "}" in template
        }
        return template.format(x=variable, n=n, m=m, **names, **texts)

    def _named(self, value: float) -> str:
        """Name of a new number."""
        name = f"n{len(self.given)}"
        self.given[name] = float(f"{value:.12g}")
        return name


@dataclass(frozen=True)
class Composed:
    """A problem with a composed law."""

    kind: str
    formula: str
    numbers: dict[str, float]
    features: tuple[tuple[str, float, float], ...]
    """Variable, centre and width (m or m/s) of each feature."""

    @property
    def text(self) -> str:
        """The formula with its numbers."""
        return with_numbers(self.formula, self.numbers)

    @property
    def law(self) -> Law:
        """The law for the independent answer."""
        return Law(self.text)

    @property
    def duration(self) -> float:
        """Length of the run, s."""
        return SLAB_TIME if self.kind == "slab, u" else BLOCK_TIME

    @property
    def excess(self) -> float:
        """Load at the start minus the static strength, Pa or N."""
        return SLAB_EXCESS if self.kind == "slab, u" else BLOCK_EXCESS

    @property
    def normal(self) -> float:
        """Normal stress or force, Pa or N."""
        return SLAB.normal_stress if self.kind == "slab, u" else BLOCK.normal_force

    @property
    def problem(self) -> ss.Problem:
        """The problem for the package. Raises InputError where the package refuses the law."""
        body: Any = SLAB if self.kind == "slab, u" else BLOCK
        return ss.Problem(body, ss.friction.FromExpression(self.formula, self.numbers), initial_excess=self.excess)


def places(features: tuple[tuple[str, float, float], ...], variable: str, top: float) -> np.ndarray:
    """Slips (m) or slip rates (m/s) up to `top`, dense at the features."""
    near = np.linspace(-8.0, 8.0, 161)
    parts = [np.linspace(0.0, top, SAMPLES), *(c + w * near for x, c, w in features if x == variable)]
    found = np.unique(np.concatenate(parts))
    return found[(found >= 0.0) & (found <= top)]


def draw(seed: int, structure: int, variant: int) -> Composed:
    """A law by the numbers of its structure and of the variant of its numbers; friction varies by 0.05 to 0.3 about 0.6."""
    shape = np.random.default_rng([seed, structure])
    kind = str(shape.choice(list(KINDS), p=[0.6, 0.2, 0.2]))
    drawing = _Drawing(shape, np.random.default_rng([seed, structure, variant]), KINDS[kind])
    text = drawing.part(DEPTH)
    features = tuple(drawing.features)
    spread, level = _seen(Law(with_numbers(text, drawing.given)), features)
    size = drawing.numbers.uniform(0.05, 0.3) * float(drawing.numbers.choice([-1.0, 1.0])) / max(spread, 1e-3)
    formula = f"{MEAN}+size*(({text})-level)"
    return Composed(kind, formula, {**drawing.given, "size": float(f"{size:.12g}"), "level": float(f"{level:.12g}")}, features)


def with_numbers(formula: str, numbers: dict[str, float]) -> str:
    """Put the numbers in the place of their names."""
    return re.sub(r"\b(n\d+|size|level)\b", lambda name: f"({numbers[name[0]]!r})", formula)


def _seen(law: Law, features: tuple[tuple[str, float, float], ...]) -> tuple[float, float]:
    """Spread and median of a formula at places that are dense at its features."""
    u, v = (places(features, x, 2.0 if x == "u" else 3.0) for x in "uv")
    rows = [(u, y) for y in v[:: max(len(v) // 9, 1)]] + [(x, v) for x in u[:: max(len(u) // 9, 1)]]
    with np.errstate(all="ignore"):
        values = np.concatenate([np.atleast_1d(law(*row)) for row in rows])
    values = values[np.isfinite(values)]
    return (float(np.ptp(values)), float(np.median(values))) if len(values) else (0.0, 0.0)
