"""Files as LabVIEW, loggers and analysers write them, of one motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
STEP = 0.05
CLOCK = STEP * np.arange(40)
FORCE = 5.1 + 0.3 * np.sin(3.0 * CLOCK)
"""Shear force, kN."""
RAM = -0.2 + 0.01 * CLOCK
"""Displacement of the ram, mm."""


class Segment(NamedTuple):
    """A segment of a LabVIEW file: its rows, X0, the time of day at which it begins, and comments by row."""

    rows: slice = slice(None)
    x0: float = 0.0
    begun: str = "14:02:10.125"
    comments: dict[int, str] = {}  # noqa: RUF012 # never changed


def labview(
    segments: Sequence[Segment] = (Segment(),),
    x_columns: str = "No",
    *,
    decimal: str = ".",
    separator: str = "\t",
    names: tuple[str, str] = ("Shear force", "Ram displacement"),
    units: tuple[str, str] = ("kN", "mm"),
    special: bool = False,
) -> str:
    """Return a file of two channels, as LabVIEW 2012 to 2024 writes it by `Write To Measurement File`."""

    def line(*cells: object) -> str:
        return separator.join(f"{one:.9E}".replace(".", decimal) if isinstance(one, float) else str(one) for one in cells) + "\n"

    blank = separator if x_columns == "No" else ""
    text = line("LabVIEW Measurement", "") + line("Writer_Version", "2") + line("Reader_Version", "2")
    text += line("Separator", "Tab" if separator == "\t" else "Comma")
    text += line("Decimal_Separator", decimal) + line("Multi_Headings", "Yes") + line("X_Columns", x_columns)
    text += line("Time_Pref", "Relative") + line("Operator", "lab") + line("Date", "2026/11/03")
    text += line("Time", "14:02:10.1254565715789794921".replace(".", decimal)) + line("***End_of_Header***", "") + blank + "\n"
    for segment in segments:
        if special:
            text += "***Start_Special***\n" + line("[wfm]", "X_Value", 1.0) + "Channels of another kind\n***End_Special***\n"
        force, ram, count = FORCE[segment.rows], RAM[segment.rows], len(FORCE[segment.rows])
        entries = {
            **{"Samples": (count, count), "Date": ("2026/11/03",) * 2, "Time": (segment.begun.replace(".", decimal),) * 2},
            **{"Y_Unit_Label": units, "X_Dimension": ("Time", "Time"), "X0": (segment.x0,) * 2, "Delta_X": (STEP, STEP)},
        }
        text += line("Channels", 2, "", "")
        for key, (one, other) in entries.items():
            text += line(key, one, "", other, "") if x_columns == "Multi" else line(key, one, other, "")
        text += line("***End_of_Header***", "", "", "")
        xs = ("X_Value", names[0], "X_Value", names[1]) if x_columns == "Multi" else ("X_Value", *names)
        text += line(*xs, "Comment")
        for i in range(count):
            x, comment = segment.x0 + STEP * i, segment.comments.get(i, "")
            cells = {"No": ("", force[i], ram[i]), "One": (x, force[i], ram[i]), "Multi": (x, force[i], x, ram[i])}[x_columns]
            text += line(*map(float_or_text, cells), *([comment] if comment else []))
        text += blank + "\n"
    return text


def float_or_text(value: object) -> object:
    """Return a number of numpy as one of Python."""
    return value if isinstance(value, str) else float(value)  # type: ignore[arg-type]


def log_ascii(*, version: str = "2.0", wrap: bool = False, null: str = "-999.25", curves: str = "", rows: str = "") -> str:
    """Return a LAS file of time, shear stress (MPa) and displacement of the load point (mm)."""
    curves = (
        curves or "TIME.S            : 1 Elapsed time\nCH3 .MPA          : 2 Shear stress\nLPD .MM  00 001 00 00 : Load point\n"
    )
    row = "{:.4f}\n{:.9f} {:.9f}\n" if wrap else "{:.4f} {:.9f} {:.9f}\n"
    rows = rows or "".join(row.format(*one) for one in zip(CLOCK, FORCE, RAM, strict=True))
    head = f"# of a logger\n~Version information\n VERS. {version}  : CWLS\n WRAP. {'YES' if wrap else 'NO'} : lines\n"
    head += f"~Well\n STRT.S 0.0 : START\n STOP.S 1.95 : STOP\n STEP.S 0.05 : STEP\n NULL. {null} : NULL VALUE\n"
    head += f" COMP. A. B. Co. : COMPANY: OF THE RIG\n~Curve\n{curves}~Parameter\n BHT.DEGC 35.5 : temperature\n~Other\n ~ no\n"
    return f"{head}~A TIME CH3 LPD\n{rows}"


KINDS = {2: "{:13.5e}", 4: "{:20.11e}"}


def universal(kind: int = 4, *, even: bool = True, code: int | None = None, force: str = "kN", apart: bool = True) -> str:
    """Return a universal file with two datasets 58: shear force, and the load point in mm; `apart` puts blanks between numbers."""
    text = ""
    if code is not None:
        text += f"    -1\n   164\n{code:10d}{'units':<20}{1:10d}\n{1.0:25.17e}{1.0:25.17e}{1.0:25.17e}\n{273.15:25.17e}\n    -1\n"
    columns = (("rig 2", "Shear force", force, 13, FORCE), ("LPD", "Displacement", "mm" if code is None else "", 8, RAM))
    for node, (id1, label, unit, code_of, values) in enumerate(columns):
        text += f"    -1\n    58\n{id1:<80}\n" + 4 * f"{'NONE':<80}\n"
        text += f"    1{0:10d}{0:5d}{0:10d} {'Cell':>10}{node + 1:10d}{3:4d} {'NONE':>10}{1:10d}{1:4d}\n"
        text += f"{kind:10d}{len(values):10d}{int(even):10d}{0.0:13.5e}{STEP if even else 0.0:13.5e}{0.0:13.5e}\n"
        text += f"{17:10d}{0:5d}{0:5d}{0:5d} {'Time':<20} {'s':<20}\n{code_of:10d}{0:5d}{0:5d}{0:5d} {label:<20} {unit:<20}\n"
        text += 2 * f"{0:10d}{0:5d}{0:5d}{0:5d} {'NONE':<20} {'NONE':<20}\n"
        cell = KINDS[kind]
        cells = [cell.format(one) for one in values]
        if not even:
            cells = [f"{t:13.5e}{one}" for t, one in zip(CLOCK, cells, strict=True)]
        if not apart:
            assert all(len(one) == len(cells[0]) for one in cells)
        in_line = {(2, True): 6, (4, True): 4, (2, False): 3, (4, False): 2}[kind, even]
        text += "".join("".join(cells[i : i + in_line]) + "\n" for i in range(0, len(cells), in_line)) + "    -1\n"
    return text
