"""The report on the paper: one HTML page that needs no other file."""

from __future__ import annotations

import math
import re
from base64 import b64encode
from collections import Counter
from collections.abc import Mapping, Sequence

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

import stickslip as ss
from stickslip.foundation.constants import YEAR
from stickslip.paper.cases import REFERENCE, Runs
from stickslip.paper.claims import Outcome, Verdict
from stickslip.paper.plates import PLATES
from stickslip.paper.tables import cases_table, constants

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Translation of digits and the minus sign for powers of ten."""
MARKS = {Outcome.PRINTED: "✓", Outcome.READING: "◐", Outcome.QUALIFIED: "≈", Outcome.NOT: "✗"}
"""A sign for each outcome, so that colour alone need not tell them apart."""
DIGITS = 6
"""Significant digits of the numbers on the page; the tables beside it keep all."""
SYMBOL = re.compile(r"(?<![A-Za-z-])(?P<letter>[uD](?=0)|u(?=c)|α(?=c)|μ(?=[0SD]))(?P<index>[0cSD])(?![a-z])")
"""A symbol with an index, as the texts write it without markup: u0, D0, uc, αc, μ0, μS, μD."""
POWER = re.compile(r"(?<![\w-])1e(?P<power>[+-]\d+)\b")
"""A power of ten, as Python writes it."""
DAY = 86_400.0


def report(runs: Runs, images: Mapping[int, bytes], verdicts: Sequence[Verdict]) -> str:
    """Return the page as HTML, from the figures (SVG by number) and the verdicts; runs that are missing are made."""
    environment = Environment(
        loader=PackageLoader("stickslip.paper"), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["symbols"] = symbols
    environment.filters["quantity"] = with_unit
    counts, cases = Counter(v.outcome for v in verdicts), cases_table(runs)
    return environment.get_template("report.html.j2").render(
        version=ss.__version__,
        reference=REFERENCE,
        rtol=number(runs.rtol),
        digits=DIGITS,
        verdicts=verdicts,
        outcomes=[(outcome, MARKS[outcome], counts[outcome]) for outcome in Outcome],
        marks=MARKS,
        constants=constants(),
        plates=PLATES,
        pictures={n: "data:image/svg+xml;base64," + b64encode(svg).decode("ascii") for n, svg in images.items()},
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


def symbols(text: str) -> Markup:
    """Return a text as HTML in which the indices of symbols are subscripts and powers of ten are written as such."""
    text = POWER.sub(lambda found: "10" + _superscript(int(found["power"])), text)
    return Markup(SYMBOL.sub(r"\g<letter><sub>\g<index></sub>", str(escape(text))))


def _superscript(power: int) -> str:
    return str(power).translate(SUPERSCRIPTS)


def number(value: float) -> str:
    """Return a number as text for readers: plain from 1e-3 to 1e6, otherwise with a power of ten."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞" if value > 0 else "−∞"
    if value == 0 or 1e-3 <= abs(value) < 10.0**DIGITS:
        return f"{value:.{DIGITS}g}".replace("-", "−")
    mantissa, exponent = f"{value:.{DIGITS - 1}e}".split("e")
    short = mantissa.rstrip("0").rstrip(".")
    return f"{short} × 10{_superscript(int(exponent))}".replace("-", "−")


def with_unit(value: float | None, unit: str) -> str:
    """Return a number with a unit in which it can be read: large stresses in MPa or GPa, times in years, days or seconds."""
    if value is None:
        return "–"
    if unit == "Pa" and abs(value) >= 1e5:
        value, unit = (value / 1e6, "MPa") if abs(value) < 1e9 else (value / 1e9, "GPa")
    if unit == "year" or (unit == "s" and abs(value) >= YEAR):
        value, unit = _long_time(value * YEAR if unit == "year" else value)
    return f"{number(value)} {unit.removeprefix('1') if unit.startswith('1/') else unit}".strip()


def _long_time(seconds: float) -> tuple[float, str]:
    """Return a time in the largest of years, days and seconds of which it has at least a tenth, and the name of the unit."""
    for name, size in (("years", YEAR), ("days", DAY)):
        if abs(seconds) >= 0.1 * size:
            return seconds / size, name
    return seconds, "s"
