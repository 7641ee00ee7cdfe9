"""The report on the paper: one HTML page that needs no other file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import pandas as pd

import stickslip as ss
from stickslip.extensions.paper.cases import REFERENCE, Runs
from stickslip.extensions.paper.claims import ClaimVerdict, Outcome
from stickslip.extensions.paper.planar import ANSWER, BASIS, table
from stickslip.extensions.paper.plates import PLATES
from stickslip.extensions.paper.rate_law_report import ANSWER as RATE_LAW
from stickslip.extensions.paper.tables import cases_table, constants
from stickslip.figures.page import DIGITS_ON_PAGE, number, picture, rendered, with_unit

MARKS = {Outcome.PRINTED: "✓", Outcome.READING: "◐", Outcome.QUALIFIED: "≈", Outcome.NOT: "✗"}
"""A sign for each outcome, so that colour alone need not tell them apart."""


def report(runs: Runs, images: Mapping[int, bytes], verdicts: Sequence[ClaimVerdict]) -> str:
    """Return the page as HTML, from the figures (SVG by number) and the verdicts; runs that are missing are made."""
    counts, cases = Counter(v.outcome for v in verdicts), cases_table(runs)
    return rendered(
        "stickslip.extensions.paper",
        "report.html.j2",
        version=ss.__version__,
        reference=REFERENCE,
        rtol=number(runs.rtol),
        digits=DIGITS_ON_PAGE,
        verdicts=verdicts,
        outcomes=[(outcome, MARKS[outcome], counts[outcome]) for outcome in Outcome],
        marks=MARKS,
        constants=constants(),
        plates=PLATES,
        pictures={n: picture(svg) for n, svg in images.items()},
        answer=ANSWER,
        basis=BASIS,
        rate_law=RATE_LAW,
        study=table(),
        cases=_readable(cases),
        columns=[(str(name).partition(" [")[0].capitalize(), pd.api.types.is_numeric_dtype(cases[name])) for name in cases],
    )


def _readable(table: pd.DataFrame) -> list[list[str]]:
    """Return the rows of a table as texts, each number with the unit that stands in brackets in the heading of its column."""
    units = [str(name).partition(" [")[2].rstrip("]") for name in table]
    rows = table.to_numpy(dtype=object).tolist()
    return [
        [cell if isinstance(cell, str) else with_unit(cell, unit) for cell, unit in zip(row, units, strict=True)] for row in rows
    ]
