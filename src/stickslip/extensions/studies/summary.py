"""Show the results of studies: comparisons, block against slab, ensembles."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.show import console, print_numbers, print_sentences, say, titled
from stickslip.engine import shown_slip
from stickslip.foundation.given import preferred, show_in
from stickslip.foundation.names import si_unit
from stickslip.foundation.show import brief, clean, number, with_unit
from stickslip.problem import units_shared

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.extensions.studies.analogy import Analogy
    from stickslip.extensions.studies.compare import Comparison
    from stickslip.extensions.studies.ensemble import Ensemble
    from stickslip.problem.scenarios import Scenario

EVENTS_SHOWN = 12
"""Number of events of an ensemble that are shown: the first ones, or those around the first event at which members differ."""


def show_comparison(found: Comparison) -> None:
    """Print the settings and the results of each run on standard output."""
    screen, rows = console(), found.table.to_dict("records")
    show_in(units_shared(found.problems))
    say(screen, clean(found.scenario or f"{len(rows)} runs side by side"), style="bold")
    say(screen, clean(found.reach_text))
    screen.print()
    if found.scenario:
        _show_rules(screen, found, rows)
        return
    words = ("rule", "regime", "status")
    ends = [[shown_slip(row[name], si_unit("slip", row["load_unit"])) for name in ("end_slip", "displacement")] for row in rows]
    settings = [[clean(row["name"]), *(str(row[name]) for name in words), *end] for row, end in zip(rows, ends, strict=True)]
    print_numbers(screen, ("\n", *(f"\n{word}" for word in words), "slip at\nthe end", "largest\ndisplacement"), settings, text=4)
    screen.print()
    (slip, slips), (rate, rates) = (_in_one_unit(rows, *both) for both in (("slip", "slip"), ("peak_rate", "slip_rate")))
    headings = (f"largest\nslip\n{slip}", "its\npulses", f"peak\nrate\n{rate}", "static\ndrop", "dynamic\ndrop", "first\nlasts\ns")
    sizes = [_sizes(row, *both) for row, *both in zip(rows, slips, rates, strict=True)]
    print_numbers(screen, ("", "events", *headings, "shocks"), sizes, text=1)


def _in_one_unit(rows: Sequence[Mapping[Hashable, Any]], column: str, quantity: str) -> tuple[str, list[str]]:
    """Return the unit of a column for its heading, and its numbers; those of several kinds of bodies have each its own unit."""
    values, units = [row[column] for row in rows], [si_unit(quantity, row["load_unit"]) for row in rows]
    if len(set(units)) > 1:
        return "", ["-" if math.isnan(value) else brief(value, unit) for value, unit in zip(values, units, strict=True)]
    largest = max((abs(value) for value in values if not math.isnan(value)), default=None)
    name, size = preferred(units[0], largest) or (units[0], 1.0)
    return name, [number(value / size, 6) for value in values]


def _show_rules(screen: Console, found: Comparison, rows: Sequence[Mapping[Hashable, Any]]) -> None:
    """Print what each selection rule makes of one scenario: the wait until the next event, slips and jumps."""
    headings = ("rule", "wait until\nnext event", "its\nslip", "slip at\nthe end", "largest\ndisplacement", "\nevents", "\njumps")
    slips = ("next_slip", "end_slip", "displacement")
    lines = []
    for row in rows:
        unit = si_unit("slip", row["load_unit"])
        sizes = ["-" if math.isnan(row[name]) else shown_slip(row[name], unit) for name in slips]
        wait = "-" if math.isnan(row["wait"]) else brief(row["wait"], "s")
        lines.append([row["name"], wait, *sizes, str(row["events"]), str(row["shocks"])])
    print_numbers(screen, headings, lines, text=1)
    screen.print()
    missing = sum(math.isnan(row["wait"]) for row in rows)
    if missing:
        say(screen, f"- : no next event within {brief(max(run.duration for run in found.runs.values()), 's')}")
    if all(line[1:] == lines[0][1:] for line in lines):
        say(screen, "these numbers are the same under every rule")


def _sizes(row: Mapping[Hashable, Any], slip: str, rate: str) -> list[str]:
    """Return the results of one run of a comparison as texts, its name first, then largest slip and slip rate as they are shown."""
    drops = (_drop(row[name], row["load_unit"]) for name in ("static_drop", "dynamic_drop"))
    sizes = slip, f"{row['pulses']:g}", rate, *drops, number(row["duration"], 6)
    return [clean(row["name"]), str(row["events"]), *sizes, str(row["shocks"])]


def _drop(value: float, unit: str) -> str:
    """Format a drop with five significant digits, or as a dash if there is no event."""
    if math.isnan(value):
        return "-"
    return brief(value, unit, 5) if preferred(unit, abs(value)) else with_unit(float(f"{value:.5g}"), unit)


def show_analogy(scenario: Scenario, found: Analogy) -> None:
    """Print the map of slips, slab over block, on standard output."""
    screen, over = titled(scenario), f"over {found.x.parameter} (across) and {found.y.parameter} (down)"
    say(screen, f"{found.problem.body.noun} over block: slip of the first event, {over}\n")
    ratios, columns = found.ratio("slip"), _spread(found.x.points)
    rows = [[number(found.y.values[i], 3), *(number(ratios[i, j], 3) for j in columns)] for i in _spread(found.y.points)]
    print_numbers(screen, ["", *(number(found.x.values[j], 3) for j in columns)], rows)
    screen.print()
    print_sentences(screen, found.text)


def _spread(points: int, most: int = 7) -> list[int]:
    """Return at most `most` evenly spaced places among the points, both ends included."""
    count = min(points, most)
    return sorted({round(k * (points - 1) / (count - 1)) for k in range(count)})


def show_ensemble(scenario: Scenario, study: Ensemble) -> None:
    """Print on standard output how far events and statistics of the members agree."""
    screen = titled(scenario)
    largest = with_unit(float(abs(study.pushes).max()), study.problem.load_unit)
    about = f"initial load disturbed by up to {number(study.size)} of the strength ({largest})"
    say(screen, f"{len(study.runs)} members, {about}\n")
    if len(study.table):
        _show_events(screen, study)
    print_sentences(screen, study.note, study.stopped, study.text, study.growth_text)


def _show_events(screen: Console, study: Ensemble) -> None:
    lost = study.first_lost or 0
    first = max(0, min(lost - EVENTS_SHOWN // 2, len(study.table) - EVENTS_SHOWN))
    headings = ("event", "start\ns", "members", "amplification")
    rows = []
    for i, row in enumerate(study.table.iloc[first : first + EVENTS_SHOWN].to_dict("records"), first + 1):
        shared = f"{row['members']} of {len(study.runs)}"
        rows.append([str(i), number(float(row["start"]), 10), shared, number(float(row["amplification"]), 3)])
    say(screen, f"{len(study.table)} slip events" + (f", of them {first + 1} to {first + len(rows)}" if first else ""))
    print_numbers(screen, headings, rows)
