"""Show what numerical schemes give beside the exact solution, and say which files a study writes."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.cli.output.show import print_numbers, print_sentences, say, titled
from stickslip.extensions.schemes.converged import SeriesWithinBand
from stickslip.extensions.schemes.measures import period_of, units_for
from stickslip.foundation.show import clean, number

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.extensions.schemes.schemes import Schemes
    from stickslip.problem.scenarios import Scenario


def tables_of(study: Schemes | SeriesWithinBand, out: Path | None) -> list[tuple[Path | None, Callable[[Path], object]]]:
    """Return the files of a study with what writes each: the table, and a table of shocks beside it if there is an exact series."""
    if out is None:
        return []
    if isinstance(study, SeriesWithinBand):
        return [(out, study.to_csv)]
    return [(out, study.to_csv), (out.with_name(f"{out.stem}-shocks{out.suffix}"), study.shocks_to_csv)]


def show_judged(scenario: Scenario, study: Schemes | SeriesWithinBand) -> None:
    """Print what a series of another program gives beside the right one of a benchmark, exact or converged."""
    if not isinstance(study, SeriesWithinBand):
        show_schemes(scenario, study)
        return
    screen = titled(scenario)
    rows = [
        [clean(row["series"]), row["quantity"], *(number(row[name], 3) for name in ("distance", "beyond", "share"))]
        for row in study.table.to_dict("records")
    ]
    headings = ("\nseries", "\nquantity", "mean distance,\nSI", "beyond\nthe band, SI", "beyond,\nshare")
    print_numbers(screen, headings, rows, text=2)
    screen.print()
    print_sentences(screen, *(clean(text) for text in study.sentences))


def show_schemes(scenario: Scenario, study: Schemes) -> None:
    """Print errors, orders, pulses and the rule that each run follows on standard output."""
    screen = titled(scenario)
    own, units = study.own, units_for(study.problem.body.load_unit)
    unit, rate = units["m"], units["m/s"]
    slip = float(own.slip(study.until)) - study.problem.initial_slip
    is_periodic = bool(study.table.periods.notna().any())
    periods = f", {number(slip / period_of(study.problem.friction), 3)} periods of friction," if is_periodic else ""
    say(screen, f"exact, {study.problem.rule}: slip {number(slip, 6)} {unit}{periods} after {number(study.until, 6)} s\n")
    headings: tuple[str, ...] = ("\nscheme", "\ncells", f"mean slip\nerror {unit}", "\norder", f"rate error\n{rate}", "\npulses")
    headings = (
        *headings,
        *["periods\nof slip"] * is_periodic,
        "arrest\ns",
        f"final slip\n{unit}",
        "own\nshocks",
        "heat\nerror",
        "damped,\nof heat",
        "oscil-\nlation",
        "follows\nthe rule",
    )
    rows = []
    for row in study.table.to_dict("records"):
        errors = [number(row["slip_error"], 3), _order(row["slip_order"]), number(row["rate_error"], 3)]
        of_slip = [number(row["periods"], 3)] * is_periodic
        results = [str(row["pulses"]), *of_slip, number(row["arrest"], 6), number(row["final_slip"], 6), str(row["own_shocks"])]
        damped = row["damped"] / row["heat"] if row["heat"] else math.nan
        shares = [number(row["heat_error"], 2), number(damped, 2), number(row["oscillation"], 2), str(row["rule"])]
        rows.append([clean(row["scheme"]), str(row["cells"] or "-"), *errors, *results, *shares])
    print_numbers(screen, headings, rows, text=1)
    screen.print()
    _show_shocks(screen, study)
    if study.interrupted:
        print_sentences(screen, "Interrupted: these are the runs that were finished")
    if study.not_told:
        print_sentences(screen, study.not_told)
    else:
        for verdict in dict.fromkeys(study.verdicts.values()):
            names = [clean(scheme) for scheme, found in study.verdicts.items() if found == verdict]
            print_sentences(screen, f"rule {verdict}: {', '.join(names)}")
    if study.tolerance is not None:
        print_sentences(screen, *(clean(text) for text in study.told))


def _order(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"


def _show_shocks(screen: Console, study: Schemes) -> None:
    """Print the exact shocks beside those of each scheme's finest mesh; shocks of its own are counted in the table before."""
    finest = study.table.loc[study.table.groupby("scheme", sort=False).step.idxmin(), ["scheme", "cells"]]
    table = finest.merge(study.shocks, on=["scheme", "cells"])
    table = table[table.exact_time.notna()]
    if table.empty:
        return
    rate = units_for(study.problem.body.load_unit)["m/s"]
    headings = ("\nshocks of", "\ncells", "exact\ntime s", "\ntime s", "\ndelay s", f"exact\n{rate}", f"\n{rate}", "\nsize")
    rows = []
    for row in table.to_dict("records"):
        times = [number(row["exact_time"], 6), number(row["time"], 6), number(row["delay"], 2)]
        jumps = [f"{number(row[f'{whose}before'], 3)} to {number(row[f'{whose}after'], 3)}" for whose in ("exact_", "")]
        jumps[1] = jumps[1] if math.isfinite(row["time"]) else "-"
        rows.append([clean(row["scheme"]), str(row["cells"] or "-"), *times, *jumps, number(row["size"], 3)])
    print_numbers(screen, headings, rows, text=1)
    screen.print()
