"""Tables of the paper's cases: runs, events, shocks, claims and constants, with units in the headings or in a column."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from stickslip.paper.cases import READINGS, Runs
from stickslip.paper.claims import Verdict
from stickslip.paper.constants import constants

UNITS = {
    "start": "s",
    "end": "s",
    "time": "s",
    "slip": "m",
    "peak_rate": "m/s",
    "peak_time": "s",
    "traction_drop": "Pa or N",
    "static_drop": "Pa or N",
    "rate_before": "m/s",
    "rate_after": "m/s",
    "traction_before": "Pa",
    "traction_after": "Pa",
}
"""Units of the columns of events and shocks, added to their headings."""


def all_tables(runs: Runs, verdicts: Sequence[Verdict]) -> dict[str, pd.DataFrame]:
    """Return every table by the name of its file, without the suffix."""
    return {
        "cases": cases_table(runs),
        "events": _stacked(runs, "events"),
        "shocks": _stacked(runs, "shocks"),
        "claims": claims_table(verdicts),
        "constants": pd.DataFrame(constants()),
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


def _stacked(runs: Runs, table: str) -> pd.DataFrame:
    """Return the events or shocks of all cases in one table, with the name of the case in the first column."""
    parts: dict[str, pd.DataFrame] = {name: getattr(runs.case(name), table) for name in READINGS}
    # Leave out cases without a row: they would make the types of the columns ambiguous.
    whole = pd.concat([part.assign(case=name) for name, part in parts.items() if len(part)], ignore_index=True)
    whole.insert(0, "case", whole.pop("case"))
    return whole.rename(columns={name: f"{name} [{unit}]" for name, unit in UNITS.items()})


def claims_table(verdicts: Sequence[Verdict]) -> pd.DataFrame:
    """Return a table with a row for each measured number, after its claim and verdict."""
    rows = [
        (v.number, v.claim, str(v.outcome), v.reading, measured.label, measured.value, measured.unit)
        for v in verdicts
        for measured in v.measured
    ]
    return pd.DataFrame(rows, columns=["number", "claim", "verdict", "reading", "measured", "value", "unit"])
