"""From a problem to the numbers that the compiled engine works on."""

from __future__ import annotations

import ctypes
import math
from typing import Any

import numpy as np

from stickslip.bodies import ElasticSlab
from stickslip.contact.selection import selection_table
from stickslip.errors import InputError
from stickslip.evolution import layout as at
from stickslip.evolution.compiled import CompiledFormula, compile_formula
from stickslip.evolution.layout import Setup
from stickslip.problem import Problem


def row_time(problem: Problem) -> float:
    """Length of a row of the history, in s: the slab's two-way travel time, the block's period of free oscillation."""
    body = problem.body
    return body.two_way_time if isinstance(body, ElasticSlab) else body.period


def has_inertia(problem: Problem) -> bool:
    """Whether the contact itself has mass, so that its slip rate cannot jump."""
    return not isinstance(problem.body, ElasticSlab) or problem.body.contact_mass > 0.0


def is_algebraic(problem: Problem) -> bool:
    """Whether the slip rate follows from the load alone: a massless contact under a law of rate only."""
    law = problem.friction
    return not has_inertia(problem) and law.depends_on_rate and not law.depends_on_slip


def prepare(problem: Problem, rtol: float) -> Setup:
    """Everything that the engine needs to know of a problem; compiles the law's formulas if they are new."""
    law = problem.friction
    if not has_inertia(problem) and law.depends_on_rate and law.depends_on_slip:
        raise InputError(
            f"{type(law).__name__} depends on slip and on rate: a slab without contact_mass cannot carry it yet; give a contact_mass"
        )
    par = _parameters(problem, rtol)
    branches, table = selection_table(problem)
    par[at.STICK_TO] = table.stick_to
    return Setup(
        par=par,
        **_formulas(problem),
        rate_from=np.array([branch.rate_from for branch in branches]),
        rate_to=np.array([branch.rate_to for branch in branches]),
        keep_from=np.array(table.keep_from),
        keep_to=np.array(table.keep_to),
        excess_from=np.array([branch.excess_from for branch in branches]),
        excess_to=np.array([branch.excess_to for branch in branches]),
        **_first_load(problem),
    )


def _parameters(problem: Problem, rtol: float) -> at.Floats:
    body, law = problem.body, problem.friction
    par = np.zeros(at.PARAMETERS)
    par[at.ROW_TIME] = row_time(problem)
    par[at.NORMAL] = problem.normal
    par[at.REFERENCE] = problem.strength
    par[at.COUNTS_NET] = 1.0 if law.counts == "net" else 0.0
    par[at.STATIC_EXCESS] = law.static_excess
    par[at.TOLERANCE] = rtol * SAFETY
    par[at.RELATIVE_JUMP] = max(1e-10, 10.0 * rtol)
    lowest, _ = law.range()
    par[at.LARGEST_DROP] = max(problem.strength - problem.normal * lowest, 0.0)
    if isinstance(body, ElasticSlab):
        par[at.IMPEDANCE], par[at.INERTIA], par[at.REFLECTION] = body.impedance, body.contact_mass, body.reflection
        par[at.SMALLEST_JUMP] = 1e-14 * problem.normal / body.impedance
        par[at.INFLOW], par[at.INFLOW_RATE] = inflow(problem)
        par[at.RAMP] = par[at.INFLOW] if body.reflection == -1.0 else problem.far_stress_rate * body.two_way_time
    else:
        par[at.IMPEDANCE], par[at.INERTIA], par[at.STIFFNESS] = body.damping, body.mass, body.stiffness
        par[at.RAMP] = body.stiffness * problem.pull_rate * body.period
    return par


SAFETY = 0.1
"""Local tolerance per step as a share of rtol: leaves the error of a whole run near rtol (see tests/evolution/test_convergence)."""


def inflow(problem: Problem) -> tuple[float, float]:
    """What the driver adds to the load, minus (1 + r) times the reference strength: value at t = 0 (Pa) and rate (Pa/s).

    beta(t) = r w(t - R) + 2 Z [Zd V + s(t - h/c)] / (Z + Zd), which for a rigid driver is -w(t - R) + 2 Z V.
    """
    body = problem.body
    assert isinstance(body, ElasticSlab)
    if body.reflection == -1.0:
        return 2.0 * body.impedance * problem.pull_rate, 0.0
    gain = 1.0 + body.reflection
    far = problem.excess if problem.far_stress is None else problem.far_stress - problem.strength
    delay = 0.5 * body.two_way_time
    steady = gain * body.driver_impedance * problem.pull_rate + gain * (far - problem.far_stress_rate * delay)
    return steady, gain * problem.far_stress_rate


def _first_load(problem: Problem) -> dict[str, Any]:
    """The load of the first round trip (minus the reference), linear between its breaking points."""
    body, excess, pull = problem.body, problem.excess, problem.pull_rate
    if not isinstance(body, ElasticSlab):
        return _pieces([0.0, body.period], [excess], [body.stiffness * pull])
    slope = body.impedance * pull / (0.5 * body.two_way_time)  # G V / h
    if body.reflection == -1.0:
        return _pieces([0.0, body.two_way_time], [excess], [slope])
    r, half = body.reflection, 0.5 * body.two_way_time
    steady, rate = inflow(problem)
    # for h/c <= t < R the start comes back: w(t - R) = G V (R - t) / h - tau0
    reflected = steady + rate * half + r * (slope * half - excess)
    before = excess + slope * half
    jump = abs(reflected - before) > 1e-12 * max(abs(problem.strength), abs(before))
    if not jump:
        reflected = before
    return _pieces([0.0, half, 2.0 * half], [excess, reflected], [slope, rate - r * slope], [0, int(jump)])


def _pieces(theta: list[float], load: list[float], slope: list[float], jump: list[int] | None = None) -> dict[str, Any]:
    return {
        "first_theta": np.array(theta),
        "first_load": np.array(load),
        "first_slope": np.array(slope),
        "first_jump": np.array(jump or [0] * len(load), np.int64),
    }


def _formulas(problem: Problem) -> dict[str, Any]:
    """Addresses, constants and offsets of the law's pieces."""
    law, start = problem.friction, problem.law_slip
    names = law.parameters()
    values = np.array([getattr(law, name) for name in names], float)
    formulas = [compile_formula(tree, names) for tree in law.trees()]
    home = int(np.searchsorted(np.asarray(law.knots), start, side="right"))
    # each piece's friction is a difference from its own reference slip: the start for the piece we start in, else its near knot
    references = [start if i == home else law.knots[i - 1 if i > home else i] for i in range(len(formulas))]
    constants = np.zeros((len(formulas), max(formula.size for formula in formulas)))
    for row, formula, reference in zip(constants, formulas, references, strict=True):
        _fill(formula, values, reference, row)
    static = float(law.static_coefficient(start))
    at_reference = [float(piece(law, np.float64(x), np.float64(0.0))) for piece, x in zip(law.pieces, references, strict=True)]
    offsets = [-law.static_excess if i == home else value - static for i, value in enumerate(at_reference)]
    jet = "motion_jet" if has_inertia(problem) else "rate_jet"
    return {
        "value_at": np.array([formula.value for formula in formulas], np.int64),
        "jet_at": np.array([getattr(formula, jet) for formula in formulas], np.int64),
        "constants": constants,
        "slip_shift": np.array([start - reference for reference in references]),
        "offset": np.array(offsets),
        "knots": np.array([knot - start for knot in law.knots]),
    }


def _fill(formula: CompiledFormula, values: at.Floats, reference: float, row: at.Floats) -> None:
    double = ctypes.POINTER(ctypes.c_double)
    formula.prepare(values.ctypes.data_as(double), reference, row.ctypes.data_as(double))


def start_state(problem: Problem) -> tuple[at.Floats, at.Integers]:
    """State and counts at t = 0: at rest, the load not yet met."""
    state, count = np.zeros(at.STATES), np.zeros(at.COUNTS, np.int64)
    state[at.LAST_STEP] = math.inf
    count[at.PIECE] = int(np.searchsorted(np.asarray(problem.friction.knots), problem.law_slip, side="right"))
    count[at.IS_BLOCK] = not isinstance(problem.body, ElasticSlab)
    count[at.HAS_INERTIA] = has_inertia(problem)
    count[at.IS_ALGEBRAIC] = is_algebraic(problem)
    return state, count
