"""Friction laws with drawn parameters, from what the registry says of their fields."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from numpy.typing import NDArray

from stickslip import InputError
from stickslip.engine.compiled_formula import compile_formula
from stickslip.engine.state.layout import LawValue
from stickslip.foundation.quantities import Choice, LawField, NamedNumbers, NumberSeries, Quantity, Text, fields_of
from stickslip.friction import LAWS, FrictionLaw, FromExpression

SIZES = {"1": (0.0, 1.5), "m": (1e-3, 2.0), "m/s": (1e-3, 2.0), "s/m": (0.0, 5.0), "1/m": (-10.0, 10.0), "s": (1e-3, 1.0)}
"""Plausible values by unit."""

EXPRESSIONS: dict[str, dict[str, float | str]] = {
    "mu_d + (mu_s - mu_d) / (1 + alpha*v)": {"mu_s": 0.8, "mu_d": 0.3, "alpha": "1 s/m"},
    "a + b * sin(k*u) * exp(-v / w) + c * log(1 + v / w)": {"a": 0.9, "b": 0.3, "k": "5 / m", "w": "10 cm/s", "c": 0.01},
    "0.4 + 0.1*tanh(u)**2 + 0.1*sqrt(1 + v**2) + arcsinh(v) * 1e-2 + (1 + v)**-0.5 - cos(pi*u)/9": {},
    "0.6 - 0.1*v + 0.01*v**3": {},
}
PAIRS = [
    ("linear-slip-weakening", "hyperbolic-rate"),
    ("sinusoidal-slip", "piecewise-linear-rate"),
    ("table", "exponential-stribeck"),
]

SAME_BOTH_WAYS = ["hyperbolic-rate", "coulomb", "exponential-stribeck", "piecewise-linear-rate"]


@st.composite
def laws(draw: st.DrawFn, kind: str) -> FrictionLaw:
    """A law of a kind; combinations that the law refuses are not drawn."""
    given = {name: draw(_field(entry)) for name, (entry, default) in fields_of(LAWS[kind]).items() if _wanted(name, kind, default)}
    if kind == "lagged":
        given["rate"] = draw(laws(draw(st.sampled_from(["hyperbolic-rate", "exponential-stribeck"]))))
    elif kind == "both-ways":
        given = {way: draw(laws(draw(st.sampled_from(SAME_BOTH_WAYS)))) for way in ("forward", "backward")}
    elif kind == "self-energising":
        given = {"law": draw(laws(draw(st.sampled_from(SAME_BOTH_WAYS)))), "gain": draw(st.floats(-0.5, 0.5))}
    elif any(isinstance(entry, LawField) for entry, _ in fields_of(LAWS[kind]).values()):
        slip, rate = draw(st.sampled_from(PAIRS))
        given = {"slip": draw(laws(slip)), "rate": draw(laws(rate))}
    lengths = [len(value) for value in given.values() if isinstance(value, tuple)]
    given = {name: value[: min(lengths)] if isinstance(value, tuple) else value for name, value in given.items()}
    try:
        if kind == "expression":
            choices = {name: given[name] for name in ("counts", "memory")}
            return FromExpression(given["expression"], EXPRESSIONS[given["expression"]], **choices)
        return LAWS[kind](**given)
    except InputError:
        assume(False)
        raise


def _wanted(name: str, kind: str, default: Any) -> bool:
    return not (kind == "table" and name == "rate") and not (kind == "expression" and name == "static")


def _field(entry: Any) -> st.SearchStrategy[Any]:
    if isinstance(entry, Quantity):
        return _number(entry)
    if isinstance(entry, NumberSeries):
        drawn = st.lists(_number(entry.item), min_size=2, max_size=6, unique_by=lambda x: round(x, 2))
        return drawn.map(sorted).map(tuple) if entry.ascending else drawn.map(tuple)
    if isinstance(entry, Choice):
        return st.sampled_from(entry.allowed)
    if isinstance(entry, Text):
        return st.sampled_from(list(EXPRESSIONS))
    assert isinstance(entry, LawField | NamedNumbers)
    return st.none()


def _number(declared: Quantity) -> st.SearchStrategy[float]:
    if declared.whole:
        return st.integers(1, 3).map(float)
    low, high = SIZES[declared.unit]
    return st.floats(max(low, declared.at_least or low), high, allow_subnormal=False).map(lambda x: round(x, 6))


def compiled_value(law: FrictionLaw, i: int, reference: float, slip: float, rate: float) -> NDArray[np.float64]:
    """mu(slip, rate) - mu(reference, 0) by the compiled piece i, and its slopes by rate and slip; with all states 0."""
    formula = compile_formula(law.trees()[i], law.parameters(), law.state_trees())
    constants, out, at_zero = np.zeros(formula.size), np.zeros(LawValue.total), np.zeros(len(law.states))
    formula.fill(np.array(law.piece_values(i)), reference, constants)
    arrays = (constants, at_zero, out) if law.states else (constants, out)
    first, *others = (array.ctypes.data for array in arrays)
    kinds = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double, *[ctypes.c_void_p] * len(others)]
    address = formula.address("state_value" if law.states else "value")
    ctypes.CFUNCTYPE(None, *kinds)(address)(first, slip - reference, rate, *others)
    return out[:3]
