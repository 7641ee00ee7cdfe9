"""Show the result of a study of sliding on the terminal: its records, and displacements by yield coefficient."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.show import console, print_numbers, print_sentences, say
from stickslip.extensions.strong_motion.asked import read_length
from stickslip.extensions.strong_motion.measures import GRAVITY
from stickslip.foundation.show import clean, number

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.extensions.strong_motion.displacements import SlidingDisplacements

RECORDS_SHOWN = 30
"""Show this many records; the table on file has all."""
YIELDS_SHOWN = 25
"""Show this many yield coefficients of a record, or of the statistics."""


def show_sliding(study: SlidingDisplacements) -> None:
    """Print the records, and the displacements of one record, or the statistics over several."""
    screen = console()
    first, *others = study.sentences
    say(screen, clean(first), style="bold")
    screen.print()
    _show_records(screen, study)
    screen.print()
    if len(study.motions) == 1:
        _show_rows(screen, study)
    else:
        _show_statistics(screen, study)
    screen.print()
    print_sentences(screen, *others)


def _show_records(screen: Console, study: SlidingDisplacements) -> None:
    size, unit = read_length("slide", study.unit), study.unit
    headings = ("record", "PGA\ng", f"PGV\n{unit}/s", "Arias\nm/s", "D5-95\ns", "Tm\ns", "final velocity\nof the ground")
    rows = []
    for one in study.records.head(RECORDS_SHOWN).to_dict("records"):
        sizes = (one["pga"] / GRAVITY, one["pgv"] / size, one["arias"], one["duration"], one["mean_period"])
        rows.append(
            [clean(str(one["record"])), *(number(x, 4) for x in sizes), f"{number(one['final_velocity'] / size, 3)} {unit}/s"]
        )
    print_numbers(screen, headings, rows, text=1)
    if len(study.records) > RECORDS_SHOWN:
        say(screen, f"and {len(study.records) - RECORDS_SHOWN} more records")


def _show_rows(screen: Console, study: SlidingDisplacements) -> None:
    size, unit = read_length("slide", study.unit), study.unit
    headings = (
        "polarity",
        "scale",
        "yield\ng",
        "yield\n/ PGA",
        f"displacement\n{unit}",
        f"peak velocity\n{unit}/s",
        "slips",
        "last stop\ns",
    )
    rows = []
    for one in study.table.head(YIELDS_SHOWN).to_dict("records"):
        moved = [number(one[name] / size, 6) for name in ("displacement", "peak_velocity")]
        tells = [f"{one['polarity']:+d}", *(number(one[name], 4) for name in ("scale", "yield_coefficient", "yield_ratio"))]
        rows.append([*tells, *moved, _count(one["slips"]), number(one["last_stop"], 5)])
    print_numbers(screen, headings, rows)
    if len(study.table) > YIELDS_SHOWN:
        say(screen, f"and {len(study.table) - YIELDS_SHOWN} more rows")


def _show_statistics(screen: Console, study: SlidingDisplacements) -> None:
    size, unit = read_length("slide", study.unit), study.unit
    level = "PGA\ng" if study.asked.levels.is_pga else "scale"
    headings = (
        level,
        "yield\ng",
        "cases",
        "at\nrest",
        f"median\n{unit}",
        f"mean\n{unit}",
        "std of\nln",
        f"least\n{unit}",
        f"most\n{unit}",
    )
    rows = []
    for one in study.statistics.head(YIELDS_SHOWN).to_dict("records"):
        moved = {name: number(one[name] / size, 5) for name in ("median", "mean", "least", "most")}
        begin = [number(one["level"], 4), number(one["yield_coefficient"], 4), str(one["cases"]), str(one["at_rest"])]
        rows.append([*begin, moved["median"], moved["mean"], number(one["std_ln"], 3), moved["least"], moved["most"]])
    print_numbers(screen, headings, rows)
    if len(study.statistics) > YIELDS_SHOWN:
        say(screen, f"and {len(study.statistics) - YIELDS_SHOWN} more rows")


def _count(value: Any) -> str:
    return "-" if math.isnan(value) else str(int(value))
