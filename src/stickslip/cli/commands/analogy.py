"""`stickslip analogy`: map where a block gives the same first slip event as a slab."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_scenario
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario
    from stickslip.studies.analogy import Analogy

BUNDLED = "block-or-slab"
"""The bundled scenario for this command."""
AXES = ("wavelength=0.9..60:13:log", "alpha=0.00392..3.92:9:log")
"""Axes of its map unless others are given."""


def analogy(
    scenario: Annotated[
        str, typer.Argument(help="A slab: a TOML file, or a bundled name.", autocompletion=complete_scenario)
    ] = BUNDLED,
    map_axes: Annotated[
        list[str] | None,
        typer.Option("--map", help="Axis of the map: NAME=LOW..HIGH[:POINTS][:log]; give two.", show_default=False),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Save the table, a row for each point (.csv).", show_default=False)
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", "-f", help="Save the map (.png, .pdf or .svg).", show_default=False)
    ] = None,
    within: Annotated[float, typer.Option(help="Largest relative difference of the answers.")] = 0.1,
    duration: Annotated[
        str | None, typer.Option(help="How long to wait for the end of the event: s, or with a unit.", show_default=False)
    ] = None,
) -> None:
    """Find where a block can replace a slab: compare the first slip event of both, over two numbers of a scenario.

    The block has the slab's stiffness G/h and the mass rho h/3 of its slow limit,
    the same law and the same load. The map compares slip, peak slip rate,
    duration and number of pulses. Without --map the bundled scenario is mapped
    over the wavelength of its weakening with slip and over alpha, the strength
    of its weakening with slip rate: 117 points, some ten seconds.

    \b
      stickslip analogy --figure map.png --out map.csv
      stickslip analogy mine.toml --map "friction.distance=1 mm..1 m:20:log" \\
        --map "body.thickness=1 km..50 km:15"

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.output.files import check_target

    for path, option, suffixes in ((out, "--out", (".csv",)), (figure, "--figure", (".png", ".pdf", ".svg"))):
        if path is not None:
            check_target(path, option, suffixes)
    axes = _axes(scenario, map_axes)
    chosen = _adjusted(scenario, duration)
    found = _study(chosen, axes, within)
    _show(chosen, found)
    for line in _save(chosen, found, out, figure):
        typer.echo(line)


def _axes(scenario: str, typed: list[str] | None) -> tuple[str, str]:
    if typed is None and scenario == BUNDLED:
        return AXES
    if typed is None or len(typed) != 2:
        raise InputError(f'analogy: give two --map, as --map "friction.alpha=0.01..10:20:log", got {len(typed or [])}')
    return typed[0], typed[1]


def _adjusted(name: str, duration: str | None) -> Scenario:
    from stickslip.scenarios.scenario import load_scenario
    from stickslip.scenarios.schema import read_duration

    loaded = load_scenario(name)
    return loaded if duration is None else replace(loaded, duration=read_duration(duration, "analogy", "--duration"))


def _study(scenario: Scenario, typed: tuple[str, str], within: float) -> Analogy:
    from stickslip.cli.output.show import progress_to
    from stickslip.scenarios.axes import read_axis
    from stickslip.studies.analogy import analogy as study

    x, y = (read_axis(scenario.problem, text, "analogy: --map") for text in typed)
    with progress_to(f"{scenario.name}:") as report:
        return study(
            scenario.problem, scenario.duration, x, y, within=within, progress=lambda done, of: report(f"{done} of {of} points")
        )


def _show(scenario: Scenario, found: Analogy) -> None:
    from stickslip.cli.output.show import clean, console, number, table

    screen = console()
    screen.print(clean(scenario.title or scenario.name), style="bold")
    screen.print(f"slab over block: slip of the first event, over {found.x.parameter} (across) and {found.y.parameter} (down)\n")
    ratios = found.ratio("slip")
    columns = sorted({round(k) for k in _spread(found.x.points)})
    shown = table("", *(number(found.x.values[j], 3) for j in columns), numbers=True)
    for i in sorted({round(k) for k in _spread(found.y.points)}):
        shown.add_row(number(found.y.values[i], 3), *(number(ratios[i, j], 3) for j in columns))
    screen.print(shown)
    screen.print(f"\n{found.text[0].upper()}{found.text[1:]}.", soft_wrap=True)


def _spread(points: int, most: int = 7) -> list[float]:
    """Return at most `most` evenly spaced places among the points, both ends included."""
    count = min(points, most)
    return [k * (points - 1) / (count - 1) for k in range(count)]


def _save(scenario: Scenario, found: Analogy, out: Path | None, figure: Path | None) -> list[str]:
    import stickslip
    from stickslip.foundation.atomic_write import write_atomically, write_table

    written = []
    if out is not None:
        about = (f"stickslip {stickslip.__version__} analogy: {found.text}", scenario.to_toml())
        written.append(f"written: {write_table(out, found.table, about)}")
    if figure is not None:
        write_atomically(figure, found.plot().savefig)
        written.append(f"written: {figure}")
    return written
