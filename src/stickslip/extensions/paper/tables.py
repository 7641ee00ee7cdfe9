"""Tables of the paper's cases: runs, events, shocks, claims and constants, with units in the headings or in a column.

The constants stand as printed and as reconstructed, with those derived from them; all are read from the bundled cases.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from stickslip.contact import uniqueness_of
from stickslip.engine import SHOCK_COLUMNS
from stickslip.extensions.paper.cases import READINGS, Runs, problem, typed
from stickslip.extensions.paper.claims import ClaimVerdict
from stickslip.extensions.paper.planar import STORED
from stickslip.foundation.constants import YEAR
from stickslip.foundation.names import si_unit
from stickslip.friction import HyperbolicRate, SinusoidalSlip
from stickslip.problem import Problem
from stickslip.problem.bodies import as_block, as_slab
from stickslip.solution.observables import EVENT_COLUMNS


def all_tables(runs: Runs, verdicts: Sequence[ClaimVerdict]) -> dict[str, pd.DataFrame]:
    """Return every table by the name of its file, without the suffix."""
    return {
        "cases": cases_table(runs),
        "events": _stacked(runs, "events", {name: one.unit for name, one in EVENT_COLUMNS.items()}),
        "shocks": _stacked(runs, "shocks", SHOCK_COLUMNS),
        "claims": claims_table(verdicts),
        "constants": pd.DataFrame(constants()),
        "planar": pd.read_csv(STORED, dtype=str, keep_default_na=False),
    }


def cases_table(runs: Runs) -> pd.DataFrame:
    """Return a table with a row for each case: what was run, and its results."""
    rows = []
    for name, reading in READINGS.items():
        solution = runs.case(name)
        row = {
            "case": name,
            "reading": reading,
            "duration [s]": solution.duration,
            "selection rule": solution.problem.rule,
            "largest slip rate [m/s]": solution.catalogue(0.0).peak_rate.max(),
            "slip [m]": float(solution.slip(solution.duration)) - solution.problem.initial_slip,
            "events": len(solution.events),
            "shocks": len(solution.shocks),
            "status": solution.status.name,
        }
        rows.append(row)
    return pd.DataFrame(rows)


def _stacked(runs: Runs, table: str, units: Mapping[str, str]) -> pd.DataFrame:
    shown = {name: si_unit(unit, "Pa", "N") for name, unit in units.items() if unit not in ("", "1")}
    parts: dict[str, pd.DataFrame] = {name: getattr(runs.case(name), table) for name in READINGS}
    # Leave out cases without a row: they would make the types of the columns ambiguous.
    whole = pd.concat([part.assign(case=name) for name, part in parts.items() if len(part)], ignore_index=True)
    whole.insert(0, "case", whole.pop("case"))
    return whole.rename(columns={name: f"{name} [{unit}]" for name, unit in shown.items()})


def claims_table(verdicts: Sequence[ClaimVerdict]) -> pd.DataFrame:
    """Return a table with a row for each measured number, after its claim and verdict."""
    rows = [
        (v.number, v.claim, str(v.outcome), v.reading, measured.label, measured.value, measured.unit)
        for v in verdicts
        for measured in v.measured
    ]
    return pd.DataFrame(rows, columns=["number", "claim", "verdict", "reading", "measured", "value", "unit"])


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
    rate, slip, other_slip = (problem(name) for name in ("fig6-slab", "fig5-slab-printed", "fig5-slab-reconstructed"))
    slab, law = as_slab(rate.body), typed(rate.friction, HyperbolicRate)
    sine, other_sine = (typed(case.friction, SinusoidalSlip) for case in (slip, other_slip))
    block, other_block = (as_block(problem(f"fig6-block-{name}").body) for name in ("printed", "reconstructed"))
    start_k, start_omega = (problem(f"fig5-block-reconstructed-{name}").initial_slip for name in ("k", "omega"))
    cube = "m and S describe a cube of 1 km, whose stiffness is G × 10³ m; printed: G × 10⁴ m"
    needed = "the events described need ω ≥ 6.86 /m"
    lacking = "S μ'(u0) + K = 0 has no solution as printed"
    return [
        Constant("ρ", "density", slab.density, None, "kg/m³"),
        Constant("c", "shear wave speed", slab.wave_speed, None, "m/s"),
        Constant("h", "thickness of the slab", slab.thickness, None, "m"),
        Constant("S", "normal stress of the slab", slab.normal_stress, None, "Pa"),
        Constant("V", "pull rate", rate.first_pull_rate * YEAR, None, "m/year", "a year is 31 557 600 s"),
        Constant("m", "mass of the block", block.mass, None, "kg"),
        Constant("S", "normal force on the block", block.normal_force, None, "N"),
        Constant("K", "stiffness of the block's spring", block.stiffness, other_block.stiffness, "N/m", cube),
        Constant("μ0", "mean friction, law (14)", sine.mean, None, ""),
        Constant("a", "amplitude, law (14)", sine.amplitude, None, ""),
        Constant("ω", "wavenumber, law (14)", sine.wavenumber, other_sine.wavenumber, "1/m", needed),
        Constant("μS", "static friction, law (15)", law.static, None, ""),
        Constant("μD", "dynamic friction, law (15)", law.dynamic, None, ""),
        Constant("α", "velocity weakening, law (15), Fig. 6", law.alpha, None, "s/m", "no unit is printed: s/m is consistent"),
        Constant("G", "shear modulus ρc²", slab.shear_modulus, None, "Pa"),
        Constant("Z", "impedance ρc", slab.impedance, None, "Pa s/m"),
        Constant("R", "two-way travel time 2h/c", slab.two_way_time, None, "s"),
        Constant("αc", "critical α, √(ρG)/(S(μS − μD))", uniqueness_of(rate).critical_value, None, "s/m"),
        Constant("uc", "slip of the largest friction, π/(2ω)", _peak(slip), _peak(other_slip), "m"),
        Constant("u0", "initial slip of the slab", slip.initial_slip, other_slip.initial_slip, "m", "uc + 10⁻³ m"),
        Constant("G(D0−u0)/h", "initial load of the slab", slip.load, other_slip.load, "Pa", "reconstructed: D0 is 10⁻³ m larger"),
        Constant("u0", "initial slip of the block", None, start_k, "m", f"{lacking}; K = G × 10³ m"),
        Constant("u0", "initial slip of the block", None, start_omega, "m", f"{lacking}; ω = 50 /m"),
    ]


def _peak(case: Problem) -> float:
    return math.pi / (2.0 * typed(case.friction, SinusoidalSlip).wavenumber)
