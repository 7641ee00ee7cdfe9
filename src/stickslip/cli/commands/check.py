"""`stickslip check`: show what a scenario means, and what to know before trusting a run."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from stickslip.cli.options import Changes, Dpi, ScenarioName, Size, axes_of, option
from stickslip.cli.output.files import Look, announce, check_target, drawing, write_files
from stickslip.foundation.errors import InputError, InputWarning

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario


def check(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    figure: Annotated[
        Path | None, option("Save a figure of the set K, or of the map (.png, .pdf, .svg).", "--figure", "-f")
    ] = None,
    dpi: Dpi = None,
    size: Size = None,
    map_axes: Annotated[list[str] | None, axes_of("a regime map")] = None,
) -> None:
    r"""Check a scenario without running it.

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
      stickslip check fig6-slab --map alpha=0.01..10:40:log \
        --map "normal_stress=10 MPa..500 MPa" --figure map.png
    """
    from stickslip.cli.output.examination import show_examination
    from stickslip.cli.overrides import load
    from stickslip.scenarios.examine import examine

    look = Look(dpi, size)
    check_target(figure, "--figure")
    look.check(figure)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*the points look noisy", InputWarning)  # the examination says so
        loaded = load(scenario, "check", changes)
    axes = map_axes or []
    if axes and (len(axes) != 2 or figure is None):
        raise InputError(f"check: a map needs two --map and a --figure, got {len(axes)} and {'one' if figure else 'none'}")
    drawn = None if figure is None else _map(loaded, axes) if axes else _set(loaded)
    show_examination(loaded, examine(loaded))
    if drawn is not None:
        announce(*write_files((figure, drawing(drawn, look))))


def _set(loaded: Scenario) -> Callable[..., object]:
    """Return the function that draws the set K of a scenario."""
    from stickslip.figures.contact import admissible

    return partial(admissible.draw, admissible.data(loaded.problem, title=loaded.heading))


def _map(loaded: Scenario, axes: list[str]) -> Callable[..., object]:
    """Return the function that draws the regimes of a scenario over two numbers."""
    from stickslip.contact.regime_map import regime_map
    from stickslip.figures.contact import regimes
    from stickslip.run.progress_line import progress_line
    from stickslip.scenarios.axes import read_axis

    x, y = (read_axis(loaded.problem, text, "check: --map") for text in axes)
    with progress_line("map:") as report:
        found = regime_map(loaded.problem, x, y, lambda done, count: report(f"{done} of {count} points"))
    return partial(regimes.draw, loaded.problem, found, loaded.heading)
