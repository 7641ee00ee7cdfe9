"""`stickslip analogy`: map where a block gives the same first slip event as a slab."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import SCENARIO, Changes, FigureFile, axes_of, complete_scenario, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.studies.analogy import Analogy
    from stickslip.problem.scenarios import Scenario

BUNDLED = "block-or-slab"
"""The bundled scenario for this command."""
AXES = ["wavelength=0.9..60:13:log", "alpha=0.00392..3.92:9:log"]
"""Axes of its map unless others are given."""


def analogy(
    scenario: Annotated[str, typer.Argument(help=f"A slab. {SCENARIO}", autocompletion=complete_scenario)] = BUNDLED,
    *,
    changes: Changes = None,
    map_axes: Annotated[list[str] | None, axes_of("the map")] = None,
    out: Annotated[Path | None, table_of("point")] = None,
    figure: FigureFile = None,
    look: FigureLook,
    within: Annotated[float, typer.Option(help="Largest relative difference of the answers.")] = 0.1,
    duration: Annotated[str | None, option("How long to wait for the end of the event: s, or with a unit.")] = None,
) -> None:
    r"""Find where a block can replace a slab: compare the first slip event of both, over two numbers of a scenario.

    The block has the slab's stiffness G/h and the mass rho h/3 of its slow limit,
    the same law and the same load. The map compares slip, peak slip rate,
    duration and number of pulses. Without --map the bundled scenario is mapped
    over the wavelength of its weakening with slip and over alpha, the strength
    of its weakening with slip rate: 117 points, some ten seconds.

    \b
      stickslip analogy --figure map.png --out map.csv
      stickslip analogy mine.toml --map "friction.distance=1 mm..1 m:20:log" \
        --map "body.thickness=1 km..50 km:15"

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load_with
    from stickslip.extensions.studies.summary import show_analogy

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    typed = AXES if map_axes is None and scenario == BUNDLED else map_axes or []
    if len(typed) != 2:
        raise InputError(f'analogy: give two --map, as --map "friction.alpha=0.01..10:20:log", got {len(typed)}')
    chosen = load_with("analogy", scenario, changes, duration=duration)
    found = _study(chosen, typed, within)
    show_analogy(chosen, found)
    announce(*write_files((out, lambda path: _save(path, chosen, found)), (figure, drawing(found.plot, look))))


def _study(scenario: Scenario, typed: list[str], within: float) -> Analogy:
    from stickslip.cli.overrides import read_axis
    from stickslip.extensions.studies.analogy import analogy as study
    from stickslip.run import progress_line

    x, y = (read_axis(scenario.problem, text, "analogy: --map") for text in typed)
    with progress_line(f"{scenario.name}:") as report:
        return study(scenario.problem, scenario.duration, x, y, within=within, progress=report)


def _save(path: Path, scenario: Scenario, found: Analogy) -> None:
    import stickslip
    from stickslip.foundation.atomic_write import write_table

    write_table(path, found.table, (f"stickslip {stickslip.__version__} analogy: {found.text}", scenario.to_toml()))
