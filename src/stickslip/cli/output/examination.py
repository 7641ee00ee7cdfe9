"""Show what `stickslip check` finds: given numbers, derived ones, what the contact does, and warnings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from stickslip.cli.output.show import say, titled
from stickslip.cli.output.tables import print_words
from stickslip.foundation.formatting import clean, with_unit

if TYPE_CHECKING:
    from stickslip.contact.folds import Fold
    from stickslip.contact.uniqueness import Uniqueness
    from stickslip.scenarios.examine import Examination
    from stickslip.scenarios.scenario import Scenario

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
    yield "stability", found.stability
    yield "uniqueness", found.uniqueness.summary
    if found.along_slip:
        yield "along slip", found.along_slip
    for fact in found.critical:
        unit = "" if fact.unit == "1" else f" {fact.unit}"
        yield "critical value", f"{fact.name} = {fact.value:.9g}{unit}; {fact.meaning}"
    for fold in found.uniqueness.folds:
        yield "fold", f"slip rate {fold.rate:.9g} m/s, load {fold.load:.12g} Pa{_proof(fold)}"
    for low, high in found.uniqueness.undecided[:MOST_UNDECIDED]:
        yield "not decided", f"whether there is a fold between {low:.9g} and {high:.9g} m/s"
    yield from _by_rule(found.uniqueness)


def _proof(fold: Fold) -> str:
    """Return how closely a fold is proven, as the end of a sentence."""
    if fold.enclosure is None:
        return "; not proven"
    low, high = fold.enclosure
    return f"; proven to within {high - low:.1g} m/s" if high > low else "; proven, at a kink of the law"


def _by_rule(contact: Uniqueness) -> Iterator[tuple[str, str]]:
    """Yield what depends on the selection rule: the jumps, and the loop that they enclose."""
    for jump in contact.jumps:
        change = jump.traction_after - jump.traction_before
        rates = f"slip rate {jump.rate_before:.9g} to {jump.rate_after:.9g} m/s at a load of {jump.load:.12g} Pa"
        yield f"jump {jump.direction} *", f"{rates}; traction changes by {change:.6g} Pa"
    if contact.jumps:
        retraced = ": the path is retraced" if contact.loop_area == 0.0 else " in the plane of load and slip rate"
        yield "loop *", f"the load going up and down encloses {contact.loop_area:.6g} Pa m/s{retraced}"
        yield "*", f"depends on the rule '{contact.rule}'; nothing else above does."
