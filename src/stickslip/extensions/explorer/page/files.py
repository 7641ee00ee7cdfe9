"""Files that are opened on the page, which are untrusted (a scenario, or a table of friction), and files that it saves."""

from __future__ import annotations

import base64
import binascii
import re
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath, PureWindowsPath
from tempfile import TemporaryDirectory
from typing import Any

import stickslip
from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.difference import toml_of
from stickslip.extensions.explorer.model.exchange import with_kind
from stickslip.extensions.explorer.model.fault import FaultAnswer
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.foundation.atomic_write import write_table
from stickslip.foundation.errors import InputError, gathered
from stickslip.foundation.names import si_unit
from stickslip.friction.custom.points import table_in_text
from stickslip.problem.scenarios import LARGEST_SCENARIO_FILE, library, read_scenario, text_of

TABLES = (".csv", ".txt", ".tsv", ".dat")
"""Suffixes of files that hold points."""
MOST_ROWS = 20_000
"""Largest number of points of an uploaded table."""
LONGEST_NAME = 80
"""Largest number of characters of a file's name that are kept."""


def content_of(encoded: str) -> bytes:
    """Return the content of a file from the browser's text in base64. Raises InputError if it is too large or broken."""
    if len(encoded) > 4 * (LARGEST_SCENARIO_FILE // 3 + 2):
        raise InputError(f"the file is larger than {LARGEST_SCENARIO_FILE} bytes")
    try:
        return base64.b64decode(encoded, validate=True)
    except (binascii.Error, ValueError):
        raise InputError("the file did not arrive whole: open it again") from None


def opened(name: str, content: bytes, present: Setting) -> Setting:
    """Return the setting from an opened file: a scenario, or the present setting with a table of friction as its law.

    Folders in the name are dropped. Raises InputError, in one line, if the file is too large, is no text, or cannot be used.
    """
    name = plain_name(name)
    if PurePosixPath(name).suffix.lower() in TABLES:
        return _with_table(name, content, present)
    stem = PurePosixPath(name).stem
    own = f"{stem} (opened)" if stem in library.names() else stem  # or it would be taken for a change of the bundled one
    with gathered():  # these doubts, too
        return Setting.of(read_scenario(text_of(content, name), name, own))


def plain_name(name: str) -> str:
    """Return the last part of a file's name, without folders and signs that cannot be printed."""
    last = PureWindowsPath(PurePosixPath(name).name).name
    return "".join(sign for sign in last if sign.isprintable())[-LONGEST_NAME:] or "file"


def _with_table(name: str, content: bytes, present: Setting) -> Setting:
    with gathered() as notes:
        along, places, friction = table_in_text(text_of(content, name), name)
    if len(friction) > MOST_ROWS:
        raise InputError(f"{name}: has {len(friction)} points, at most {MOST_ROWS} are taken")
    key = "slip" if along == "slip" else "rate"
    table = {"kind": "table", key: places.tolist(), "friction": friction.tolist()}
    with gathered():  # doubts about the law itself are found whenever the setting is read
        changed = with_kind(present, "friction", "table").with_value("friction", table)
    changed.scenario()
    return replace(changed, notes=tuple(notes))


Write = Callable[[Setting, Any], bytes]

_DRAWING = threading.Lock()
"""Held while a figure is drawn: the style of matplotlib is one for all threads, and each page exports in its own."""
_UNSAFE = re.compile(r"[^\w.-]+", re.ASCII)


@dataclass(frozen=True)
class Format:
    """One kind of file: how the menu calls it, the end of its name, its media type, and the function that writes it."""

    label: str
    suffix: str
    media: str
    write: Write


def scenario_file(setting: Setting, answer: Answer) -> bytes:
    """Return the setting as a scenario file, whose run has the numbers that are shown."""
    made = f"# Made in the explorer of stickslip {stickslip.__version__}; run it with: stickslip run {file_name(setting, '.toml')}"
    return f"{made}\n\n{toml_of(setting)}".encode()


def netcdf_file(setting: Setting, answer: Answer) -> bytes:
    """Return the whole run as a netCDF file, as `stickslip run --out` writes it."""
    return _written(".nc", answer.solution.to_netcdf)


def fields_file(setting: Setting, answer: Any) -> bytes:
    """Return slip, slip rate, traction and heat of a fault over time and y as a netCDF file."""
    from stickslip.foundation.netcdf_file import write

    return _written(".nc", lambda path: write(answer.run.dataset(), path))


def events_file(setting: Setting, answer: Answer) -> bytes:
    """Return the table of slip events as CSV, with all digits."""
    problem = answer.solution.problem
    slip, rate = problem.unit_of("slip"), problem.unit_of("slip_rate")
    about = _about(setting, f"slip events; times in s, slips in {slip}, slip rates in {rate}, tractions in {problem.load_unit}")
    return _written(".csv", lambda path: write_table(path, answer.solution.events, about))


def curves_file(setting: Setting, answer: Answer) -> bytes:
    """Return the curves that are shown as CSV: slip, slip rate, traction and load of each body against time."""
    import pandas as pd

    tables = [
        pd.DataFrame(
            {
                "body": motion.name,
                "time": motion.time,
                "slip": motion.slip,
                "slip_rate": motion.slip_rate,
                "traction": motion.traction,
                "load": motion.load,
            }
        )
        for motion in answer.motions
    ]
    loads = ", ".join(f"{motion.load_unit} ({motion.name})" for motion in answer.motions)
    slip, rate = (si_unit(name, *(motion.load_unit for motion in answer.motions)) for name in ("slip", "slip_rate"))
    about = _about(
        setting, f"curves; time in s, slip in {slip}, slip_rate in {rate}, traction and load in {loads}; a jump has two rows"
    )
    return _written(".csv", lambda path: write_table(path, pd.concat(tables, ignore_index=True), about))


def png_file(setting: Setting, answer: Answer) -> bytes:
    """Return the figure of `stickslip run --figure` as PNG."""
    return _figure(answer, "png")


def svg_file(setting: Setting, answer: Answer) -> bytes:
    """Return the figure of `stickslip run --figure` as SVG."""
    return _figure(answer, "svg")


FORMATS = {
    "toml": Format("Scenario (TOML)", ".toml", "application/toml", scenario_file),
    "netcdf": Format("Whole run (netCDF)", ".nc", "application/x-netcdf", netcdf_file),
    "events": Format("Slip events (CSV)", "-events.csv", "text/csv", events_file),
    "curves": Format("Curves (CSV)", "-curves.csv", "text/csv", curves_file),
    "png": Format("Figure (PNG)", ".png", "image/png", png_file),
    "svg": Format("Figure (SVG)", ".svg", "image/svg+xml", svg_file),
}
"""The kinds of files, by their names in requests of the page."""
OF_A_FAULT = {
    "toml": FORMATS["toml"],
    "netcdf": Format("Whole run (netCDF)", ".nc", "application/x-netcdf", fields_file),
    "curves": FORMATS["curves"],
    "png": FORMATS["png"],
    "svg": FORMATS["svg"],
}
"""The kinds of files of a fault in 2D."""


def formats_of(setting: Setting) -> dict[str, Format]:
    """Return the kinds of files that a page can save, by name."""
    return OF_A_FAULT if setting.is_fault else FORMATS


def file_name(setting: Setting, suffix: str) -> str:
    """Return the name of a file: that of the setting in plain letters, which says so if it was changed."""
    stem = _UNSAFE.sub("-", setting.name).strip("-.")[:60] or "scenario"
    return f"{stem}{'-changed' if setting.is_changed else ''}{suffix}"


def export(kind: str, setting: Setting, answer: Answer | FaultAnswer) -> tuple[str, str, bytes]:
    """Return name, media type and content of a file. Raises InputError for an unknown kind."""
    formats = formats_of(setting)
    if kind not in formats:
        raise InputError(f"export: there is no kind {ascii(kind)[:40]}; allowed: {', '.join(formats)}")
    found = formats[kind]
    return file_name(setting, found.suffix), found.media, found.write(setting, answer)


def _about(setting: Setting, what: str) -> tuple[str, ...]:
    return (f"stickslip {stickslip.__version__} explorer: {what}", toml_of(setting))


def _written(suffix: str, write: Callable[[Path], object]) -> bytes:
    """Return what a function writes to a file of this suffix."""
    with TemporaryDirectory(prefix="stickslip-export-") as folder:
        path = Path(folder) / f"export{suffix}"
        write(path)
        return path.read_bytes()


def _figure(answer: Any, kind: str) -> bytes:
    from stickslip.figures.runs import run
    from stickslip.figures.sheet import StickslipFigure
    from stickslip.figures.style import image

    with _DRAWING:
        if isinstance(answer, FaultAnswer):
            return image(answer.run.plot(figure=StickslipFigure()), kind)
        return image(run.draw_run(answer.solution), kind)
