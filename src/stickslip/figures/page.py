"""What all reports share: how their pages are made from templates, how numbers are written for readers, and how files are saved."""

from __future__ import annotations

import math
import re
from base64 import b64encode
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jinja2 import Environment, PackageLoader, PrefixLoader, StrictUndefined
from markupsafe import Markup, escape

from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.constants import YEAR
from stickslip.foundation.names import readable_unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Translation of digits and the minus sign for powers of ten."""
DIGITS_ON_PAGE = 6
"""Significant digits of the numbers on a page; the tables beside it keep all."""
SYMBOL = re.compile(r"(?<![A-Za-z-])(?P<letter>[uD](?=0)|u(?=c)|α(?=c)|μ(?=[0SD]))(?P<index>[0cSD])(?![a-z])")
"""A symbol with an index, as the texts write it without markup: u0, D0, uc, αc, μ0, μS, μD."""
POWER = re.compile(r"(?<![\w-])1e(?P<power>[+-]\d+)\b")
"""A power of ten, as Python writes it."""
DAY = 86_400.0


def rendered(package: str, template: str, **values: Any) -> str:
    """Return the page that a template of a package gives; the template may extend `shared/page.html.j2`."""
    loader = PrefixLoader({"shared": PackageLoader("stickslip.figures"), "own": PackageLoader(package)})
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {"symbols": symbols, "quantity": with_unit}
    return environment.get_template(f"own/{template}").render(**values)


def picture(svg: bytes) -> str:
    """Return the address of a picture that holds the picture itself."""
    return "data:image/svg+xml;base64," + b64encode(svg).decode("ascii")


def save_text(path: Path, text: str) -> Path:
    """Write text in UTF-8 with line feeds as line ends, either whole or not at all, and return the path."""
    return write_atomically(path, lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))


def save_figure(path: Path, figure: Figure) -> bytes:
    """Write a figure as PNG and SVG under a path without suffix, each whole or not at all, and return the bytes of the SVG file."""
    from stickslip.figures.style import image

    images = {kind: image(figure, kind) for kind in ("png", "svg")}
    for kind, content in images.items():
        write_atomically(path.with_name(f"{path.name}.{kind}"), partial(Path.write_bytes, data=content))
    return images["svg"]


def symbols(text: str) -> Markup:
    """Return a text as HTML in which the indices of symbols are subscripts and powers of ten are written as such."""
    text = POWER.sub(lambda found: "10" + superscript(int(found["power"])), text)
    return Markup(SYMBOL.sub(r"\g<letter><sub>\g<index></sub>", str(escape(text))))


def superscript(power: int) -> str:
    """Return a whole number as an exponent."""
    return str(power).translate(SUPERSCRIPTS)


def number(value: float) -> str:
    """Return a number as text for readers: plain from 1e-3 to 1e6, otherwise with a power of ten."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞" if value > 0 else "−∞"
    if value == 0 or 1e-3 <= abs(value) < 10.0**DIGITS_ON_PAGE:
        return f"{value:.{DIGITS_ON_PAGE}g}".replace("-", "−")
    mantissa, exponent = f"{value:.{DIGITS_ON_PAGE - 1}e}".split("e")
    short = mantissa.rstrip("0").rstrip(".")
    return f"{short} × 10{superscript(int(exponent))}".replace("-", "−")


def with_unit(value: float | None, unit: str) -> str:
    """Return a number with a unit in which it can be read: loads and energies with a prefix, times in years, days or seconds."""
    if value is None:
        return "–"
    unit, size = readable_unit(unit, value, plain=True)
    value /= size
    if unit == "year" or (unit == "s" and abs(value) >= YEAR):
        value, unit = _long_time(value * YEAR if unit == "year" else value)
    return f"{number(value)} {unit.removeprefix('1') if unit.startswith('1/') else unit}".strip()


def _long_time(seconds: float) -> tuple[float, str]:
    """Return a time in the largest of years, days and seconds of which it has at least a tenth, and the name of the unit."""
    for name, size in (("years", YEAR), ("days", DAY)):
        if abs(seconds) >= 0.1 * size:
            return seconds / size, name
    return seconds, "s"
