"""The constants of the paper, as printed and as reconstructed, and those derived from them, all read from the bundled cases."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stickslip import YEAR
from stickslip.bodies import as_block, as_slab
from stickslip.contact.uniqueness import uniqueness
from stickslip.friction import HyperbolicRate, SinusoidalSlip
from stickslip.paper.cases import problem


@dataclass(frozen=True)
class Constant:
    """One row of the table of constants.

    `reconstructed` is None if the printed number is kept; `printed` is None if the printed equation has no solution.
    """

    symbol: str
    meaning: str
    printed: float | None
    reconstructed: float | None
    unit: str
    note: str = ""


def constants() -> list[Constant]:
    """Return every constant, the printed ones before those derived from them."""
    return [*_slab(), *_block(), *_laws(), *_derived()]


def _slab() -> list[Constant]:
    case = problem("fig6-slab")
    slab = as_slab(case.body)
    return [
        Constant("ρ", "density", slab.density, None, "kg/m³"),
        Constant("c", "shear wave speed", slab.wave_speed, None, "m/s"),
        Constant("h", "thickness of the slab", slab.thickness, None, "m"),
        Constant("S", "normal stress of the slab", slab.normal_stress, None, "Pa"),
        Constant("V", "pull rate", case.first_pull_rate * YEAR, None, "m/year", "a year is 31 557 600 s"),
    ]


def _block() -> list[Constant]:
    printed, other = (as_block(problem(name).body) for name in ("fig6-block-printed", "fig6-block-reconstructed"))
    cube = "m and S describe a cube of 1 km, whose stiffness is G × 10³ m; printed: G × 10⁴ m"
    return [
        Constant("m", "mass of the block", printed.mass, None, "kg"),
        Constant("S", "normal force on the block", printed.normal_force, None, "N"),
        Constant("K", "stiffness of the block's spring", printed.stiffness, other.stiffness, "N/m", cube),
    ]


def _laws() -> list[Constant]:
    printed, other = problem("fig5-slab-printed").friction, problem("fig5-slab-reconstructed").friction
    rate = problem("fig6-slab").friction
    assert isinstance(printed, SinusoidalSlip)
    assert isinstance(other, SinusoidalSlip)
    assert isinstance(rate, HyperbolicRate)
    return [
        Constant("μ0", "mean friction, law (14)", printed.mean, None, ""),
        Constant("a", "amplitude, law (14)", printed.amplitude, None, ""),
        Constant("ω", "wavenumber, law (14)", printed.wavenumber, other.wavenumber, "1/m", "the events described need ω ≥ 6.86 /m"),
        Constant("μS", "static friction, law (15)", rate.static, None, ""),
        Constant("μD", "dynamic friction, law (15)", rate.dynamic, None, ""),
        Constant("α", "velocity weakening, law (15), Fig. 6", rate.alpha, None, "s/m", "no unit is printed: s/m is consistent"),
    ]


def _derived() -> list[Constant]:
    printed, other, rate = (problem(name) for name in ("fig5-slab-printed", "fig5-slab-reconstructed", "fig6-slab"))
    slab = as_slab(rate.body)
    lacking = "S μ'(u0) + K = 0 has no solution as printed"
    return [
        Constant("G", "shear modulus ρc²", slab.shear_modulus, None, "Pa"),
        Constant("Z", "impedance ρc", slab.impedance, None, "Pa s/m"),
        Constant("R", "two-way travel time 2h/c", slab.two_way_time, None, "s"),
        Constant("αc", "critical α, √(ρG)/(S(μS − μD))", uniqueness(rate).critical_value, None, "s/m"),
        Constant("uc", "slip of the largest friction, π/(2ω)", _peak(printed.friction), _peak(other.friction), "m"),
        Constant("u0", "initial slip of the slab", printed.initial_slip, other.initial_slip, "m", "uc + 10⁻³ m"),
        Constant("G(D0−u0)/h", "initial load of the slab", printed.load, other.load, "Pa", "reconstructed: D0 is 10⁻³ m larger"),
        Constant(
            "u0",
            "initial slip of the block",
            None,
            problem("fig5-block-reconstructed-k").initial_slip,
            "m",
            lacking + "; K = G × 10³ m",
        ),
        Constant(
            "u0",
            "initial slip of the block",
            None,
            problem("fig5-block-reconstructed-omega").initial_slip,
            "m",
            lacking + "; ω = 50 /m",
        ),
    ]


def _peak(law: object) -> float:
    assert isinstance(law, SinusoidalSlip)
    return math.pi / (2.0 * law.wavenumber)
