"""The report on the paper: one HTML page that needs no other file."""

from __future__ import annotations

import math
from base64 import b64encode
from collections import Counter
from collections.abc import Mapping, Sequence

from jinja2 import Environment, PackageLoader, StrictUndefined

import stickslip as ss
from stickslip.paper.cases import REFERENCE, Runs
from stickslip.paper.claims import Outcome, Verdict
from stickslip.paper.constants import constants
from stickslip.paper.plates import PLATES
from stickslip.paper.tables import cases_table

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Translation of digits and the minus sign for powers of ten."""
MARKS = {Outcome.PRINTED: "✓", Outcome.READING: "◐", Outcome.QUALIFIED: "≈", Outcome.NOT: "✗"}
"""A sign for each outcome, so that colour alone need not tell them apart."""


def report(runs: Runs, images: Mapping[int, bytes], verdicts: Sequence[Verdict]) -> str:
    """Return the page as HTML, from the figures (SVG by number) and the verdicts; runs that are missing are made."""
    environment = Environment(
        loader=PackageLoader("stickslip.paper"), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["number"] = number
    environment.filters["quantity"] = lambda measured: with_unit(measured.value, measured.unit)
    counts, cases = Counter(v.outcome for v in verdicts), cases_table(runs)
    return environment.get_template("report.html.j2").render(
        version=ss.__version__,
        reference=REFERENCE,
        rtol=f"{runs.rtol:g}",
        verdicts=verdicts,
        outcomes=[(outcome, MARKS[outcome], counts[outcome]) for outcome in Outcome],
        marks=MARKS,
        constants=constants(),
        plates=PLATES,
        pictures={n: "data:image/svg+xml;base64," + b64encode(svg).decode("ascii") for n, svg in images.items()},
        cases=cases.to_numpy().tolist(),
        headings=list(cases),
    )


def number(value: float | int | str | None, digits: int = 9) -> str:
    """Return a number as text for readers: plain from 1e-3 to 1e7, otherwise with a power of ten."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞"
    if value == 0 or 1e-3 <= abs(value) < 1e7:
        return f"{value:.{digits}g}".replace("-", "−")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    short = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    return f"{short} × 10{str(int(exponent)).translate(SUPERSCRIPTS)}".replace("-", "−")


def with_unit(value: float, unit: str) -> str:
    """Return a number with its unit; stresses from 1e5 Pa on are given in MPa."""
    if unit == "Pa" and abs(value) >= 1e5:
        value, unit = value / 1e6, "MPa"
    return f"{number(value)} {unit}".strip()
