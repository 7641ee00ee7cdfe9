"""Random formulas, their radii from the generated text, and how far they really stray on complex discs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from types import SimpleNamespace
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from stickslip.engine.formula_code.taylor_series import FormulaWriter
from stickslip.engine.series import ball_radii
from stickslip.engine.state.layout import Ball
from stickslip.foundation.kernels.uncompiled import MATHS
from stickslip.friction.formula import expression as e
from stickslip.friction.formula import functions
from stickslip.friction.formula.operations import FUNCTIONS, OPERATIONS
from tests.core.engine.formulas import FLOATS

Complexes = NDArray[np.complex128]
LEAVES = (e.SLIP, e.RATE, e.STATE)
EXACT = SimpleNamespace(**{name: getattr(mpmath, OPERATIONS[name].in_math) for name in FUNCTIONS})
ROUNDING = 1e-14
"""Absolute error of a value at the centre (1): some nodes are known as a difference from a reference of order one."""
DIGITS = 60
"""Digits of the second look at what seems to be too far away: doubles may have lost theirs."""


@dataclass(frozen=True)
class Disc:
    """Centres of slip (m), slip rate (m/s) and state, and the radii in which they vary."""

    centre: tuple[float, float, float]
    radius: tuple[float, float, float]

    def points(self, rng: np.random.Generator, count: int) -> Complexes:
        """Points on the three circles, a row each: by the maximum principle nothing is further away inside."""
        angle = rng.uniform(0.0, 2.0 * np.pi, (3, count))
        angle[:, :8] = rng.choice([0.0, 0.5 * np.pi, np.pi, -0.5 * np.pi], (3, 8))  # singularities lie here as a rule
        centre = np.array(self.centre)[:, None]
        inside = np.maximum(np.array(self.radius)[:, None] - 4e-16 * abs(centre), 0.0)  # rounding must not lead out of the disc
        return centre + inside * np.exp(1j * angle)


def drawn_number(rng: np.random.Generator, smallest: float = -3.0, largest: float = 3.0) -> float:
    """A number of any sign between powers of ten."""
    return float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(smallest, largest))


def drawn_disc(rng: np.random.Generator) -> Disc:
    """Centres up to 1e3, radii from 1e-8 to 1e3 and zero, mostly smaller than their centre."""
    slip, state = drawn_number(rng), drawn_number(rng)
    centre = (slip, abs(drawn_number(rng)), state)
    sizes = [abs(x) if rng.random() < 0.7 else 1.0 for x in centre]
    radius = [size * 10.0 ** rng.uniform(-5.0, 0.3) * (rng.random() < 0.85) for size in sizes]
    return Disc(centre, (radius[0], radius[1], radius[2]))


def drawn_formula(rng: np.random.Generator, depth: int, leaves: Sequence[e.Expression] = LEAVES) -> e.Expression:
    """A random tree of all operations; what has a restricted domain gets an argument inside it in most cases."""
    if depth == 0:
        if rng.random() < 0.35:
            return e.as_expression(drawn_number(rng, -2.0, 2.0))
        leaf = leaves[int(rng.integers(len(leaves)))]
        return leaf * drawn_number(rng, -2.0, 2.0) if rng.random() < 0.5 else leaf - drawn_number(rng)
    kind = str(rng.choice(["add", "sub", "mul", "div", "pow", "square", "logistic", "cosh", *FUNCTIONS]))
    a = drawn_formula(rng, depth - 1, leaves)
    if kind in ("add", "sub", "mul", "div"):
        b = drawn_formula(rng, depth - 1, leaves)
        return OPERATIONS[kind](a, 1.0 + b * b if kind == "div" and rng.random() < 0.7 else b)
    if kind == "square":
        return a * a
    if kind == "logistic":
        return 1.0 / (1.0 + functions.exp(a))
    if kind == "cosh":
        return 1.0 / (functions.exp(a) + functions.exp(-a))
    if kind in ("log", "sqrt", "pow") and rng.random() < 0.8:
        a = 0.5 + a * a if rng.random() < 0.5 else 0.1 + functions.exp(a)
    if kind == "pow":
        return e.Expression(
            "pow", (a, e.as_expression(round(rng.uniform(-30.0, 30.0), 2) if rng.random() < 0.5 else rng.uniform(-2.0, 2.0)))
        )
    return OPERATIONS[kind](a)


def values_of(tree: e.Expression, at: tuple[Any, Any, Any], functions: Any) -> list[Any]:
    """The values of all nodes at slip, slip rate and state, the tree's own last; functions of numpy, or of mpmath."""
    found: dict[e.Expression, Any] = dict(zip(LEAVES, at, strict=True))
    number = complex if functions is np else mpmath.mpf
    for node in e.nodes_of(tree):
        arguments = [found[argument] for argument in node.arguments]
        if node.operation == "constant":
            found[node] = number(node.value)
        elif node.operation in FUNCTIONS:
            found[node] = getattr(functions, node.operation)(*arguments)
        elif arguments:
            found[node] = OPERATIONS[node.operation](*arguments)
    return [*found.values(), found[tree]]


def distances(tree: e.Expression, disc: Disc, points: Complexes) -> NDArray[np.float64]:
    """How far the formula is at these points from its value at the centre; NaN where it overflows on the way."""
    with np.errstate(all="ignore"):
        rows = tuple(np.concatenate(([centre], row)) for centre, row in zip(disc.centre, points, strict=True))
        found = [np.broadcast_to(np.asarray(value, complex), rows[0].shape) for value in values_of(tree, rows, np)]
        finite = np.isfinite(found).all(axis=0)
        real = all(value[0].imag == 0.0 for value in found)  # elsewhere the law has no value: the logarithm of a negative number
        away: NDArray[np.float64] = np.abs(found[-1] - found[-1][0])[1:]
        return np.where(finite[1:] & finite[0] & real, away, np.nan)


def exact_distance(tree: e.Expression, disc: Disc, point: Complexes) -> float:
    """The same at one point, in DIGITS digits."""
    with mpmath.workdps(DIGITS):
        there = values_of(tree, tuple(mpmath.mpc(complex(z)) for z in point), EXACT)[-1]
        here = values_of(tree, tuple(mpmath.mpf(x) for x in disc.centre), EXACT)[-1]
        return float(abs(there - here))


def radius_of(tree: e.Expression, disc: Disc, rules: Mapping[str, Any] | None = None) -> float:
    """The radius by the generated text, executed as Python; `rules` replaces functions of `ball_radii`."""
    writer, ball = FormulaWriter(tree, (), state_rates=(tree,)), Ball(np.zeros(Ball.total))
    ball.slip, ball.rate, ball.state[0] = disc.radius
    ball.at_slip, ball.at_rate, ball.at_state[0] = disc.centre
    names = {**vars(MATHS), **vars(ball_radii), **FLOATS, **(rules or {})}
    names |= {"c": np.zeros(writer.size), "p": np.zeros(1), "x_ref": np.float64(0.0)}
    names["k"] = ball.numbers
    with np.errstate(all="ignore"):
        exec("\n".join([*writer.prepare(), *writer.around()]), names)
    return float(ball.friction)


@dataclass(frozen=True)
class Drawn:
    """A formula, a disc, and points on it."""

    formula: e.Expression
    disc: Disc
    points: Complexes


@cache
def drawn(seed: int) -> Drawn:
    """A random formula of depth 4, a disc, and points on it."""
    rng = np.random.default_rng(seed)
    formula, disc = drawn_formula(rng, 4), drawn_disc(rng)
    return Drawn(formula, disc, disc.points(rng, 40))


def farthest(one: Drawn, radius: float, rounding: float = ROUNDING) -> float:
    """How far a formula strays at these points, as a share of its radius; in DIGITS digits if that is too far; 0 if not known."""
    away = distances(one.formula, one.disc, one.points)
    if not np.isfinite(away).any():
        return 0.0
    worst = int(np.nanargmax(away))
    found = float(away[worst])
    if found > radius:
        found = exact_distance(one.formula, one.disc, one.points[:, worst])
    return found / (radius + rounding)
