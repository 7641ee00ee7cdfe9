"""`stickslip check`: what a scenario means, and what to know before trusting a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_scenario

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.scenarios.examine import Examination, Fact


def check(
    scenario: Annotated[str, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario)],
) -> None:
    """Check a scenario without running it.

    Shows every value as it is understood, with units (SI); what follows from
    them (impedance, travel time, strength, excess); whether the contact slips
    at once; static stability and growth; whether the slip rate is unique, the
    folds and what will jump; and warnings.

    \b
      stickslip check fig6-slab
      stickslip check mine.toml
    """
    from stickslip.cli.show import clean, console
    from stickslip.scenarios.examine import examine
    from stickslip.scenarios.scenario import load_scenario

    loaded = load_scenario(scenario)
    found = examine(loaded)
    screen = console()
    screen.print(clean(loaded.title or loaded.name), style="bold")
    if loaded.description:
        screen.print(clean(loaded.description))
    _print(screen, {f"[{name}]": facts for name, facts in found.given.items()} | {"what follows": found.derived})
    _print_findings(screen, found)


def _print(screen: Console, groups: dict[str, list[Fact]]) -> None:
    from stickslip.cli.show import table, with_unit

    shown = table("", "value", "meaning")
    for heading, facts in groups.items():
        shown.add_row(heading, style="bold")
        for fact in facts:
            shown.add_row(fact.name, fact.value if isinstance(fact.value, str) else with_unit(fact.value, fact.unit), fact.meaning)
        shown.add_section()
    screen.print(shown)


def _print_findings(screen: Console, found: Examination) -> None:
    from rich.table import Table

    shown = Table.grid(padding=(0, 2))
    shown.add_row("start", found.start)
    shown.add_row("stability", found.stability)
    shown.add_row("uniqueness", found.uniqueness.summary)
    for fold in found.uniqueness.folds:
        shown.add_row("fold", f"slip rate {fold.rate:.9g} m/s, load {fold.load:.12g} Pa")
    for warning in found.warnings:
        shown.add_row("warning", warning, style="yellow")
    screen.print(shown)
