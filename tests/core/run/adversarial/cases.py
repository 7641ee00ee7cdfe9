"""Adversarial problems, drawn at random but reproducible: a body, a law with features in its way, and what it starts from."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from scipy.interpolate import PchipInterpolator

import stickslip as ss
from tests.core.run.adversarial.features import SHAPES, Feature, Recipe, Variable

Mu = Callable[[float, float], float]
BODIES = ("block", "slab", "mass", "matched")
"""A block; a slab without contact mass within one round trip, with contact mass, and with a driver of the slab's own impedance."""
Given = Literal["formula", "function", "table", "lagged"]
MEAN = 0.6


@dataclass(frozen=True)
class Template:
    """What a law is made of: shapes and the variables they see; how it is given; sum or product."""

    shapes: tuple[tuple[str, Variable], ...]
    given: Given = "formula"
    product: bool = False

    @property
    def name(self) -> str:
        """A short name for test reports."""
        joined = ("*" if self.product else "+").join(f"{shape}({x})" for shape, x in self.shapes)
        return joined if self.given == "formula" else f"{self.given}-{joined}"


SINGLE = tuple(Template(((shape, x),)) for x in ("u", "v") for shape in SHAPES)  # type: ignore[arg-type]
SEVERAL = (
    Template((("bump", "u"), ("bump", "u"))),
    Template((("step", "v"), ("tail", "v"))),
    Template((("bump", "u"), ("logistic", "v"))),
    Template((("lorentz", "u"), ("tail", "v"))),
    Template((("step", "u"), ("bump", "v")), product=True),
    Template((("corner", "u"), ("ripple", "u")), product=True),
    Template((("bump", "v"), ("lorentz", "v")), product=True),
)
OTHERWISE = (
    Template((("bump", "u"),), "function"),
    Template((("step", "v"),), "function"),
    Template((("bump", "u"),), "table"),
    Template((("lorentz", "u"), ("step", "u")), "table"),
    Template((("bump", "v"),), "table"),
    Template((("bump", "v"),), "lagged"),
    Template((("step", "v"), ("tail", "v")), "lagged"),
)
TEMPLATES = {template.name: template for template in (*SINGLE, *SEVERAL, *OTHERWISE)}


@dataclass(frozen=True)
class Case:
    """A problem, its law as plain Python, and the features in its way."""

    name: str
    problem: ss.Problem
    mu: Mu
    recipe: Recipe
    duration: float
    slip: float
    """Size of the slip without features, m."""
    rate: float
    """Size of the slip rate without features, m/s."""
    lag: float = 0.0

    def with_excess(self, share: float) -> Case:
        """The same case with a load changed by a share of the normal load."""
        excess = self.problem.excess + share * self.problem.normal
        return replace(self, problem=replace(self.problem, initial_excess=excess))


@dataclass(frozen=True)
class _Setting:
    """A body under a load: what would happen under constant friction."""

    body: Any
    pull_rate: float
    duration: float
    slip: float
    rate: float


def draw(template: str, seed: int) -> Case:
    """The case of a template with a seed; its body is drawn too. Raises InputError where the package refuses the law."""
    chosen = TEMPLATES[template]
    rng = np.random.default_rng([seed, *template.encode()])
    bodies = [body for body in BODIES if _possible(body, chosen)]
    kind = str(rng.choice(bodies))
    excess = 10 ** rng.uniform(-2.5, -0.6)
    setting = _block(rng, excess) if kind == "block" else _slab(rng, excess, kind)
    recipe = Recipe(MEAN, tuple(_feature(rng, *one, excess, setting) for one in chosen.shapes), chosen.product)
    lag = 10 ** rng.uniform(-2.5, -0.5) * setting.duration if chosen.given == "lagged" else 0.0
    law, mu = _law(recipe, chosen.given, lag, setting)
    normal = setting.body.normal_force if kind == "block" else setting.body.normal_stress
    problem = ss.Problem(setting.body, law, pull_rate=setting.pull_rate, initial_excess=excess * normal)
    name = f"{template}, {kind}, seed {seed}"
    return Case(name, problem, mu, recipe, setting.duration, setting.slip, setting.rate, lag)


def _possible(body: str, template: Template) -> bool:
    """Return False for a massless contact whose slip rate follows from the load alone: other tests look at its branches."""
    return body in ("block", "mass") or template.given == "lagged" or all(x == "u" for _, x in template.shapes)


def _block(rng: np.random.Generator, excess: float) -> _Setting:
    mass, stiffness = 10 ** rng.uniform(-1, 12), 10 ** rng.uniform(1, 13)
    slip = 10 ** rng.uniform(-4, 0.3)
    normal = slip * stiffness / excess
    period = 2.0 * math.pi * math.sqrt(mass / stiffness)
    damping = float(rng.choice([0.0, 0.2])) * math.sqrt(mass * stiffness)
    body = ss.SpringBlock(mass, stiffness, normal, damping)
    rate = slip * 2.0 * math.pi / period
    pull = float(rng.choice([0.0, 0.05, -0.05])) * rate
    return _Setting(body, pull, 0.8 * period, 2.0 * slip, rate)


def _slab(rng: np.random.Generator, excess: float, kind: str) -> _Setting:
    slab = ss.ElasticSlab(rng.uniform(2000, 3500), rng.uniform(1500, 4500), 10 ** rng.uniform(1, 4), 10 ** rng.uniform(6.5, 8.5))
    trip = slab.two_way_time
    if kind == "matched":
        slab = replace(slab, driver_impedance=slab.impedance)
    if kind == "mass":
        slab = replace(slab, contact_mass=slab.impedance * trip * 10 ** rng.uniform(-3, -1))
    span = 0.5 * trip if kind == "matched" else 0.95 * trip
    change = float(rng.choice([0.0, rng.uniform(0.2, 1.0), -rng.uniform(0.3, 0.9), -rng.uniform(1.1, 1.5)]))
    pull = change * excess * slab.normal_stress * slab.thickness / (slab.shear_modulus * span)
    rate = excess * slab.normal_stress / slab.impedance
    duration = 1.2 * trip if kind == "matched" else span
    return _Setting(slab, pull, duration, rate * duration * (1.0 + 0.5 * change), rate * max(1.0 + change, 1.0))


def _feature(rng: np.random.Generator, shape: str, variable: Variable, excess: float, setting: _Setting) -> Feature:
    size = max(setting.slip, 0.3 * setting.rate * setting.duration) if variable == "u" else setting.rate
    sign = float(rng.choice([-1.0, 1.0]))
    amplitude = sign * excess * 10 ** rng.uniform(-1.5, -0.05)
    if shape == "corner":
        amplitude = abs(amplitude) / size
    return Feature(shape, variable, amplitude, rng.uniform(0.05, 0.95) * size, size * 10 ** rng.uniform(-4, 0))


def _law(recipe: Recipe, given: Given, lag: float, setting: _Setting) -> tuple[Any, Mu]:
    """The law as the package has it, and as plain Python."""
    make: Any = ss.friction.FromExpression
    if given == "function":
        return _from_function(recipe), recipe.value
    if given == "table":
        return _table(recipe, setting)
    law = make(recipe.text, recipe.parameters, counts="path")
    return (law if lag == 0.0 else ss.friction.LaggedFriction(law, lag)), recipe.value


def _from_function(recipe: Recipe) -> Any:
    """The first feature through a function of numpy's, as a user would write it."""
    (one,) = recipe.features

    def bump(u: Any, v: Any, mean: float, a: float, c: float, w: float) -> Any:
        return mean + a * np.exp(-(((u - c) / w) ** 2))

    def step(u: Any, v: Any, mean: float, a: float, c: float, w: float) -> Any:
        return mean + a * np.tanh((v - c) / w)

    values = {"mean": recipe.mean, "a": one.amplitude, "c": one.centre, "w": one.width}
    return ss.friction.FromFunction({"bump": bump, "step": step}[one.shape], counts="path", **values)


def _table(recipe: Recipe, setting: _Setting) -> tuple[Any, Mu]:
    """Points of the formula, dense at the features; scipy's PCHIP through the same points is the truth."""
    slip = recipe.sees("u")
    top = 3.0 * (setting.slip if slip else setting.rate)
    near = [f.centre + f.detail * np.linspace(-5.0, 5.0, 41) for f in recipe.features]
    places = np.unique(np.concatenate([np.linspace(0.0, top, 25), *near]))
    places = places[(places >= 0.0) & (places <= top)]
    places = places[np.concatenate(([True], np.diff(places) > 1e-9 * top))]
    values = np.array([recipe.value(x, 0.0) if slip else recipe.value(0.0, x) for x in places.tolist()])
    curve = PchipInterpolator(places, values)

    def mu(u: float, v: float) -> float:
        return float(curve(min(max(u if slip else v, 0.0), top)))

    law = ss.friction.FromTable(friction=values.tolist(), **{"slip" if slip else "rate": places.tolist()})
    return law, mu
