"""Show numerical schemes beside the exact solution."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from stickslip.cli.output.show import print_numbers, print_sentences, say, titled
from stickslip.foundation.formatting import clean, number

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario
    from stickslip.studies.schemes import Schemes


def show_schemes(scenario: Scenario, study: Schemes) -> None:
    """Print errors, orders, pulses and the rule that each run follows on standard output."""
    screen = titled(scenario)
    own = study.own
    slip = float(own.slip(study.until)) - study.problem.initial_slip
    say(screen, f"exact, {study.problem.rule}: slip {number(slip, 6)} m after {number(study.until, 6)} s\n")
    headings: tuple[str, ...] = ("\nscheme", "\ncells", "mean slip\nerror m", "\norder", "rate error\nm/s", "\npulses", "arrest\ns")
    headings = (*headings, "final slip\nm", "energy\ndrift", "oscil-\nlation", "follows\nthe rule")
    rows = []
    for row in study.table.to_dict("records"):
        errors = [number(row["slip_error"], 3), _short(row["slip_order"]), number(row["rate_error"], 3)]
        results = [str(row["pulses"]), number(row["arrest"], 6), number(row["final_slip"], 6)]
        shares = [number(row["energy_drift"], 2), number(row["oscillation"], 2), str(row["rule"])]
        rows.append([clean(row["scheme"]), str(row["cells"] or "-"), *errors, *results, *shares])
    print_numbers(screen, headings, rows, text=1)
    screen.print()
    if study.interrupted:
        print_sentences(screen, "Interrupted: these are the runs that were finished")
    if len(study.groups) == 1:
        print_sentences(screen, "all selection rules have the same solution here")
        return
    for verdict in dict.fromkeys(study.verdicts.values()):
        names = [clean(scheme) for scheme, found in study.verdicts.items() if found == verdict]
        print_sentences(screen, f"rule {verdict}: {', '.join(names)}")


def _short(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"
