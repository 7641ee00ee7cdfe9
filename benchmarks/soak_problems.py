"""Random problems over every registry: laws, bodies, loadings, selection rules, memory and state, extreme numbers included."""

from __future__ import annotations

import math
import re
from dataclasses import MISSING, dataclass
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, LawField, NamedNumbers, NumberSeries, Quantity, Text, fields_of
from stickslip.friction import LAWS, FrictionLaw, FromExpression
from stickslip.problem.fields import INITIAL_STATES
from stickslip.problem.selection_rule import SELECTION_RULES

EXTREME = 0.15
"""Share of problems whose numbers are drawn from many decades."""
RTOLS = (1e-4, 1e-6, 1e-8, 1e-10, 1e-10)
TRIES = 50
LONG = 0.04
"""Share of problems that run for many round trips."""
FRESH = 0.01
"""Share of expressions that are put together anew, and so compiled anew: 0.3 to 1 s each."""
BUMP, WELL = "a*exp(-((u - c)/w)**2)", "b*exp(-((v - y)/x)**2)"
TEMPLATES = (
    "m + a/(1 + v/x)",
    "m + a/(1 + (v/x)**2)",
    "m + a*exp(-v/x) + b*log(1 + v/y)",
    "m + a/(1 + exp((v - y)/x))",
    "m*(1 + b*arcsinh(v/x))",
    "m + a*tanh(v/x) - b*v/(v + y)",
    "m + a*sqrt(1 + v/x)/(1 + v/y)",
    f"m + a/(1 + v/x) + {WELL}",
    f"m + {BUMP}",
    "m + a*tanh((u - c)/w)",
    "m + a*sin(u/w)",
    "m + a*sin(u/w)*exp(-(u/z)**2)",
    "m + a/(1 + exp((u - c)/w))",
    "m + a/(1 + (u/w)**2)**2",
    "m + a*cos(u/w) + b*sin(u/z)",
    "m + a*sin(u/w)*exp(-v/x)",
    "m + a*exp(-u**2/w**2)/(1 + v/x)",
    "m + a*tanh((u - c)/w) + b*arcsinh(v/x)",
    f"m + {BUMP} + {WELL}",
    "m + a/(1 + v/x + (u/w)**2)",
)
"""Formulas of expressions: their numbers are parameters, so that each is compiled once."""
TERMS = (
    "a/(1 + v/x)",
    "a*exp(-v/x)",
    "b*log(1 + v/y)",
    "b*arcsinh(v/y)",
    "b*tanh((v - y)/x)",
    WELL,
    BUMP,
    "a*sin(u/w)",
    "b*cos(u/z)",
    "a*tanh((u - c)/w)",
    "b/(1 + (u/z)**2)",
    "b*u/sqrt(u**2 + w**2)",
)
"""What fresh formulas are put together from."""
PAIRS = (
    ("linear-slip-weakening", "hyperbolic-rate"),
    ("sinusoidal-slip", "piecewise-linear-rate"),
    ("table", "exponential-stribeck"),
    ("exponential-slip-weakening", "velocity-strengthening"),
)
SMOOTH = ("hyperbolic-rate", "exponential-stribeck", "power-stribeck", "velocity-strengthening")


@dataclass(frozen=True)
class Draw:
    """A problem with what it is run with."""

    kind: str
    problem: ss.Problem
    duration: float
    rtol: float

    def __repr__(self) -> str:
        return f"ss.simulate({self.problem!r}, {self.duration!r}, rtol={self.rtol!r})"


class Drawing:
    """Draws one problem; sizes follow the body, so that what is drawn matters."""

    def __init__(self, seed: int, index: int) -> None:
        self.rng = np.random.default_rng([seed, index])
        self.extreme = bool(self.rng.random() < EXTREME)
        self.slip = self.rate = self.time = 1.0

    def log(self, low: float, high: float) -> float:
        """A number between 10**low and 10**high; three times as many decades where numbers are extreme."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        return float(10 ** (middle + (3.0 if self.extreme else 1.0) * self.rng.uniform(-half, half)))

    def one_of(self, *choices: Any) -> Any:
        """One of several, each as likely."""
        return choices[int(self.rng.integers(len(choices)))]

    def body(self) -> Any:
        """A body; sets the sizes of slip, slip rate and time."""
        rng = self.rng
        if rng.random() < 0.4:
            mass, stiffness, normal = self.log(-1, 12), self.log(1, 13), self.log(1, 14)
            damping = float(self.one_of(0.0, 0.0, 0.1, 3.0)) * math.sqrt(mass * stiffness)
            block = ss.SpringBlock(mass, stiffness, normal, damping)
            self.slip, self.time, self.rate = normal / stiffness, float(block.period), normal / math.sqrt(mass * stiffness)
            return block
        density, speed, thickness, normal = self.log(3, 4), self.log(3, 3.7), self.log(0, 4.5), self.log(6, 8.5)
        impedance = density * speed
        driver = float(self.one_of(math.inf, math.inf, math.inf, 0.0, impedance, impedance * self.log(-1, 1)))
        mass = float(self.one_of(0.0, 0.0, 0.0, density * thickness * self.log(-5, -0.5)))
        slab = ss.ElasticSlab(density, speed, thickness, normal, driver, mass)
        self.slip, self.time, self.rate = normal / slab.stiffness, slab.two_way_time, normal / impedance
        return slab

    def number(self, declared: Quantity) -> float:
        """A value of a declared quantity."""
        rng = self.rng
        if declared.whole:
            return float(rng.integers(1, 4))
        sizes = {"m": self.slip, "m/s": self.rate, "s/m": 1.0 / self.rate, "1/m": 1.0 / self.slip, "s": self.time}
        if declared.unit in sizes:
            return float(sizes[declared.unit] * self.log(-2.5, 0.5))
        return float(rng.uniform(0.0, 1.2)) if rng.random() < 0.8 else self.log(-4, 0)

    def field(self, declared: Any) -> Any:
        """A value of a declared field of a law."""
        if isinstance(declared, Quantity):
            return self.number(declared)
        if isinstance(declared, NumberSeries):
            count = int(self.rng.integers(2, 7))
            values = [self.number(declared.item) for _ in range(count)]
            return tuple(sorted(set(values))) if declared.ascending else tuple(values)
        if isinstance(declared, Choice):
            return self.one_of(*declared.allowed)
        assert isinstance(declared, LawField | NamedNumbers | Text)
        return None

    def law(self, kind: str) -> FrictionLaw:
        """A law of a kind; combinations that the law refuses are drawn again."""
        for _ in range(TRIES):
            try:
                return self._law(kind)
            except InputError:
                continue
        raise InputError(f"no law of kind {kind} in {TRIES} tries")

    def _law(self, kind: str) -> FrictionLaw:
        rng = self.rng
        if kind == "expression":
            return self._expression()
        given: dict[str, Any] = {
            name: self.field(declared)
            for name, (declared, default) in fields_of(LAWS[kind]).items()
            if default is MISSING or rng.random() < 0.6
        }
        if kind == "table":
            given.pop(str(self.one_of("slip", "rate")), None)
            given.setdefault("slip" if "rate" not in given else "rate", None)
            if given.get("slip") is None and given.get("rate") is None:
                given["slip"] = self.field(fields_of(LAWS[kind])["slip"][0])
        if kind == "lagged":
            lagging = given["rate"] = self.law(str(self.one_of(*SMOOTH)))
            most = math.asinh(1e3 * self.rate / given.get("direct_rate", 1e-6))  # friction must stay positive as v vanishes
            given["direct"] = float(self.one_of(0.0, 0.5)) * float(rng.random()) * max(lagging.range()[0], 0.0) / most
        elif kind in ("sum", "product"):
            slip, rate = PAIRS[int(self.rng.integers(len(PAIRS)))]
            given = {"slip": self.law(slip), "rate": self.law(rate)}
        elif kind == "both-ways":
            given = {way: self.law(str(self.one_of(*SMOOTH))) for way in ("forward", "backward")}
        elif kind == "self-energising":
            given = {"law": self.law(str(self.one_of(*SMOOTH))), "gain": float(rng.uniform(-0.5, 0.5))}
        lengths = [len(value) for value in given.values() if isinstance(value, tuple)]
        given = {name: value[: min(lengths)] if isinstance(value, tuple) else value for name, value in given.items()}
        return LAWS[kind](**given)

    def _expression(self) -> FrictionLaw:
        rng = self.rng
        if rng.random() < FRESH:
            chosen = rng.choice(len(TERMS), size=int(rng.integers(2, 4)), replace=False)
            text = "m + " + str(self.one_of(" + ", " * ")).join(f"({TERMS[i]})" for i in chosen)
        else:
            text = str(self.one_of(*TEMPLATES))
        values = {name: self._value(name) for name in sorted(set(re.findall(r"\b[abcmwxyz]\b", text)))}
        return FromExpression(text, values, counts=self.one_of("path", "net"), memory=self.one_of("all", "all", "since-arrest"))

    def _value(self, name: str) -> float:
        """A value of one of the names that formulas use: m, a, b numbers, c, w, z slips, x, y slip rates."""
        if name == "m":
            return float(self.rng.uniform(0.2, 1.0))
        if name in "ab":
            return float(self.rng.uniform(0.0, 0.5)) if self.rng.random() < 0.5 else self.log(-4, -1)
        return (self.slip if name in "cwz" else self.rate) * self.log(-3, 0)

    def history(self, size: float) -> Any:
        """A loading history with values of a size."""
        rng = self.rng

        def value() -> float:
            return float(size * rng.normal())

        times = tuple(float(t) for t in np.cumsum(rng.uniform(0.05, 1.0, 3)) * self.time)
        kind = self.one_of("steps", "piecewise-linear", "hold-and-slide", "sinusoidal")
        if kind == "steps":
            return ss.loading.Steps((0.0, *times), (value(), value(), value(), value()))
        if kind == "piecewise-linear":
            return ss.loading.PiecewiseLinear((0.0, *times), (value(), value(), value(), value()))
        if kind == "hold-and-slide":
            return ss.loading.HoldAndSlide(slide=value(), slide_time=times[0], hold_times=times[1:])
        return ss.loading.Sinusoidal(value(), value(), self.time * self.log(-1, 1), float(rng.uniform(0.0, 6.0)))

    def problem(self, kind: str) -> Draw:
        """A problem under a law of a kind, and how long it runs."""
        rng, body = self.rng, self.body()
        law = self.law(kind)
        normal = body.normal_force if isinstance(body, ss.SpringBlock) else body.normal_stress
        given: dict[str, Any] = {"selection": str(self.one_of(*SELECTION_RULES))}
        if law.depends_on_slip and law.depends_on_rate:
            given["selection"] = SELECTION_RULES[0]  # the only rule where folds move with slip
        speed = float(self.one_of(0.0, 1.0, 1.0, -1.0)) * self.rate * self.log(-8, -0.5)
        given["pull_rate"] = self.history(abs(speed)) if rng.random() < 0.2 else speed
        lossy = isinstance(body, ss.ElasticSlab) and math.isfinite(body.driver_impedance)
        if lossy and rng.random() < 0.5:
            given["far_stress"] = normal * float(rng.uniform(0.0, 1.0))
            given["far_stress_rate"] = normal / self.time * self.log(-6, -1) * float(self.one_of(0.0, 1.0, -1.0))
        if rng.random() < 0.3:
            given["initial_slip"] = self.slip * float(rng.normal())
        if law.sticks:
            given["initial_excess"] = float(self.one_of(0.0, 1.0, 1.0, -1.0)) * normal * self.log(-6, -0.5)
        else:
            given["initial_load"] = normal * float(rng.uniform(-1.0, 1.0))
            given |= {name: self.time * self.log(-3, 3) for name in INITIAL_STATES[: len(law.states)]}
        rounds = float(rng.uniform(0.3, 6.0)) * (self.log(2, 5) if rng.random() < LONG else 1.0)
        rtol = float(self.one_of(*RTOLS))
        if not law.sticks and body.has_inertia and rng.random() < 0.5:
            given["initial_rate"] = float(self.one_of(0.0, 1.0, -1.0)) * self.rate * self.log(-8, -0.5)
        return Draw(kind, ss.Problem(body, law, **given), float(rounds * self.time), rtol)


def draw(seed: int, index: int, only: str | None = None) -> Draw:
    """The problem with a number. Raises InputError where the package refuses what was drawn."""
    drawing = Drawing(seed, index)
    kinds = tuple(LAWS)
    return drawing.problem(only or kinds[index % len(kinds)])
