"""`stickslip check`: show what a scenario means, and what to know before trusting a run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_scenario
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

    from stickslip.contact.enclosed_folds import Fold
    from stickslip.contact.uniqueness import Uniqueness
    from stickslip.problem.problem import Problem
    from stickslip.scenarios.examine import Examination, Fact
    from stickslip.scenarios.scenario import Scenario

MOST_UNDECIDED = 10
"""Largest number of intervals of slip rates that are listed as undecided, because they may or may not hold a fold."""


def check(
    scenario: Annotated[str, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario)],
    figure: Annotated[
        Path | None,
        typer.Option("--figure", "-f", help="Save a figure of the set K, or of the map (.png, .pdf, .svg).", show_default=False),
    ] = None,
    map_axes: Annotated[
        list[str] | None,
        typer.Option("--map", help="Axis of a regime map: NAME=LOW..HIGH[:POINTS][:log]; give two.", show_default=False),
    ] = None,
) -> None:
    """Check a scenario without running it.

    The command shows every value as it is understood, with units (SI); what
    follows from the values (impedance, travel time, strength, excess); whether
    the contact slips at once; static stability and growth; whether the slip
    rate is unique, the critical values, the folds with what is proven of them,
    and the jumps; and warnings. Numbers marked with * depend on the selection
    rule.

    --figure draws the set K: every pair of slip rate and load that solves the
    contact equation. With --map twice it draws the regime over two numbers.

    \b
      stickslip check fig6-slab --figure k.png
      stickslip check fig6-slab --map alpha=0.01..10:40:log \\
        --map "normal_stress=10 MPa..500 MPa" --figure map.png
    """
    from stickslip.cli.output.files import check_target
    from stickslip.scenarios.examine import examine
    from stickslip.scenarios.scenario import load_scenario

    if figure is not None:
        check_target(figure, "--figure", (".png", ".pdf", ".svg"))
    loaded = load_scenario(scenario)
    drawn = _drawn(loaded.problem, figure, map_axes or [])
    found = examine(loaded)
    _show(loaded, found)
    if drawn is not None and figure is not None:
        from stickslip.foundation.atomic_write import write_atomically

        write_atomically(figure, drawn.savefig)
        typer.echo(f"written: {figure}")


def _show(scenario: Scenario, found: Examination) -> None:
    from stickslip.cli.output.show import clean, console

    screen = console()
    screen.print(clean(scenario.title or scenario.name), style="bold")
    if scenario.description:
        screen.print(clean(scenario.description))
    _print(screen, {f"[{name}]": facts for name, facts in found.given.items()} | {"what follows": found.derived})
    _print_findings(screen, found)


def _drawn(problem: Problem, figure: Path | None, axes: list[str]) -> Figure | None:
    """Return the figure that is asked for, or None. Raises InputError."""
    if axes and (len(axes) != 2 or figure is None):
        raise InputError(f"check: a map needs two --map and a --figure, got {len(axes)} and {'one' if figure else 'none'}")
    if figure is None:
        return None
    if not axes:
        from stickslip.figures.contact import admissible

        return admissible.draw(admissible.data(problem))
    return _map(problem, axes)


def _map(problem: Problem, axes: list[str]) -> Figure:
    from stickslip.cli.output.show import progress_to
    from stickslip.contact.regime_map import regime_map
    from stickslip.figures.contact import regimes
    from stickslip.scenarios.axes import read_axis

    x, y = (read_axis(problem, text, "check: --map") for text in axes)
    with progress_to("map:") as report:
        found = regime_map(problem, x, y, lambda done, count: report(f"{done} of {count} points"))
    return regimes.draw(regimes.data(problem, found))


def _print(screen: Console, groups: dict[str, list[Fact]]) -> None:
    from stickslip.cli.output.show import table, with_unit

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
    if found.along_slip:
        shown.add_row("along slip", found.along_slip)
    for fact in found.critical:
        shown.add_row("critical value", f"{fact.name} = {_exact(fact.value, fact.unit)}; {fact.meaning}")
    for fold in found.uniqueness.folds:
        shown.add_row("fold", f"slip rate {fold.rate:.9g} m/s, load {fold.load:.12g} Pa{_proof(fold)}")
    for low, high in found.uniqueness.undecided[:MOST_UNDECIDED]:
        shown.add_row("not decided", f"whether there is a fold between {low:.9g} and {high:.9g} m/s")
    for name, text in _by_rule(found.uniqueness):
        shown.add_row(name, text)
    for warning in found.warnings:
        shown.add_row("warning", warning, style="yellow")
    screen.print(shown)


def _proof(fold: Fold) -> str:
    """Return how closely a fold is proven, as the end of a sentence."""
    if fold.enclosure is None:
        return "; not proven"
    low, high = fold.enclosure
    return f"; proven to within {high - low:.1g} m/s" if high > low else "; proven, at a kink of the law"


def _exact(value: float | str, unit: str) -> str:
    return f"{value:.9g}{'' if unit == '1' else f' {unit}'}"


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
