"""What `stickslip check` prints about a scenario: its values, what follows from them, and what is found about its contact."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from stickslip.cli.output.show import print_words, say, titled
from stickslip.foundation.show import brief, clean, exact_range, exactly, with_unit

if TYPE_CHECKING:
    from stickslip.contact import Fold, Uniqueness
    from stickslip.problem.scenarios import Scenario
    from stickslip.run.check import Examination

MOST_UNDECIDED = 10
"""Largest number of intervals of slip rates that are listed as undecided, because they may or may not hold a fold."""


def show_examination(scenario: Scenario, found: Examination) -> None:
    """Print what was found about a scenario on standard output."""
    screen = titled(scenario)
    if scenario.description:
        say(screen, clean(scenario.description))
    rows: list[tuple[str, ...]] = []
    for heading, facts in [*((f"[{name}]", facts) for name, facts in found.given.items()), ("what follows", found.derived)]:
        rows.append((heading,))
        rows += [
            (one.name, one.value if isinstance(one.value, str) else with_unit(one.value, one.unit), one.meaning) for one in facts
        ]
    print_words(screen, ("", "value", "meaning"), rows)
    screen.print()
    findings = [*_findings(found), *(("warning", warning) for warning in found.warnings)]
    print_words(screen, ("", ""), findings, {"warning": "yellow"})


def _findings(found: Examination) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each finding but the warnings."""
    yield "start", found.start
    for line in found.chosen:
        yield "chosen", line
    if found.stability:
        yield "stability", found.stability
    for line in found.steady.lines():
        yield "steady sliding", line
    yield "uniqueness", found.uniqueness.summary
    if found.along_slip:
        yield "along slip", found.along_slip
    for fact in found.critical:
        yield "critical value", f"{fact.name} = {brief(float(fact.value), fact.unit, 9)}; {fact.meaning}"
    contact = found.uniqueness
    assert contact.problem is not None
    loads, rates = contact.problem.load_unit, contact.problem.unit_of("slip_rate")
    for fold in contact.folds:
        yield "fold", f"slip rate {exactly(fold.rate, rates)}, load {brief(fold.load, loads, 12)}{_proof(fold, rates)}"
    for low, high in contact.undecided[:MOST_UNDECIDED]:
        yield "not decided", f"whether there is a fold between {exact_range((low, high), rates, between=' and ')}"
    yield from _by_rule(contact, loads, rates)


def _proof(fold: Fold, unit: str) -> str:
    """Return how closely a fold is proven, as the end of a sentence, with the unit of slip rates."""
    if fold.enclosure is None:
        return "; not proven"
    low, high = fold.enclosure
    return f"; proven to within {exactly(high - low, unit, 1)}" if high > low else "; proven, at a kink of the law"


def _by_rule(contact: Uniqueness, loads: str, unit: str) -> Iterator[tuple[str, str]]:
    """Yield what depends on the selection rule: the jumps, and the loop that they enclose, with the units of loads and rates."""
    for jump in contact.jumps:
        change = jump.traction_after - jump.traction_before
        span = exact_range((jump.rate_before, jump.rate_after), unit)
        rates = f"slip rate {span} at a load of {brief(jump.load, loads, 12)}"
        yield f"jump {jump.direction} *", f"{rates}; traction changes by {brief(change, loads)}"
    if contact.jumps:
        retraced = ": the path is retraced" if contact.loop_area == 0.0 else " in the plane of load and slip rate"
        yield "loop *", f"the load going up and down encloses {brief(contact.loop_area, f'{loads} {unit}')}{retraced}"
        yield "*", f"depends on the rule '{contact.rule}'; nothing else above does."
