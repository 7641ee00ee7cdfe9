"""Laws that hide a barrier, and the slip at which friction first equals the load, by a search of the law itself."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

import stickslip as ss

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
NORMAL, EXCESS, DURATION = 1e8, 1.2e7, 3.0
CLAIM = 1e-7
FUNCTIONS: dict[str, Any] = {name: getattr(np, name) for name in ("sin", "cos", "exp", "log", "sqrt", "tanh", "arcsinh")}


class Barrier(NamedTuple):
    """A formula of the slip, where its narrow features are (m), and the slip at which it holds the load (m), known beforehand."""

    formula: str
    features: tuple[float, ...]
    stops: float


BARRIERS = {
    "power of a square": Barrier("0.6 + 0.3*(sin(pi*u)**2)**10", (), 0.404381),
    "power of a power": Barrier("0.6+0.3*(cos(pi*(u+0.55))**16)**16", (), 0.4231),
    "difference of logarithms": Barrier("0.6+0.3*(log((u-.8)**2+4*1e-7**2)-log((u-.8)**2+1e-7**2))/log(4)", (0.8,), 0.7999999),
    "denominator beside an exponential": Barrier("0.6+0.3/((1+((u-.8)/1e-7)**2)*(1+exp(-u)))", (0.8,), 0.7999999),
    "top hat of arcsinh": Barrier(
        "0.6+0.3*(arcsinh((u-.8)/1e-7)-arcsinh((u-.8)/2e-7)-arcsinh((u-.9)/1e-7)+arcsinh((u-.9)/2e-7))/log(4)", (0.8, 0.9), 0.8
    ),
}
STEEP = {
    f"tanh over {width:g} m": Barrier(f"0.6+0.15*(1+tanh((u-0.8)/{width}))", (0.8,), 0.8)
    for width in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
}


def value(formula: str, u: Any, v: Any = 0.0) -> Any:
    """The formula by numpy. An exponential inside another may overflow on the way to a finite value."""
    with np.errstate(over="ignore"):
        return eval(formula, {"u": u, "v": v, "pi": math.pi, **FUNCTIONS})


def first_balance(barrier: Barrier, excess: float) -> float:
    """The first slip at which friction equals the load, m."""
    near = np.concatenate([[0.0], np.geomspace(1e-11, 1.0, 20_001)])
    parts = [np.linspace(0.0, 2.0, 200_001), *(c + side * near for c in barrier.features for side in (-1.0, 1.0))]
    slips = np.unique(np.concatenate(parts))
    slips = slips[slips >= 0.0]

    def missing(u: Any) -> Any:
        return NORMAL * (value(barrier.formula, u) - value(barrier.formula, 0.0)) - excess

    first = int(np.argmax(missing(slips) >= 0.0))
    return float(brentq(missing, slips[first - 1], slips[first], xtol=1e-15))


def problem(barrier: Barrier, excess: float = EXCESS) -> ss.Problem:
    return ss.Problem(SLAB, ss.friction.FromExpression(barrier.formula), initial_excess=excess)
