"""`stickslip check`: show what a scenario means, and what to know before trusting a run."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import Changes, ScenarioName, axes_of, option
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.cli.output.show import print_words, say, titled
from stickslip.foundation.errors import InputError, InputWarning

if TYPE_CHECKING:
    from stickslip.contact import SteadySlidings
    from stickslip.problem.scenarios import Scenario
    from stickslip.run.check import Examination

PARAMETERS = "List the names, units and meanings of all numbers that --set, --vary and --free take, and stop."
RUNS = "Make a dozen short exact runs from rest, where steady sliding becomes stable at a critical rate."


def check(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    figure: Annotated[
        Path | None, option("Save a figure of the set K, or of the map (.png, .pdf, .svg).", "--figure", "-f")
    ] = None,
    steady_figure: Annotated[Path | None, option("Save a figure of steady sliding (.png, .pdf, .svg).", "--steady-figure")] = None,
    look: FigureLook,
    map_axes: Annotated[list[str] | None, axes_of("a regime map")] = None,
    runs: Annotated[bool, typer.Option("--runs/--no-runs", help=RUNS)] = True,
    parameters: Annotated[bool, typer.Option("--parameters", help=PARAMETERS)] = False,
) -> None:
    r"""Check a scenario before it is run.

    The command shows every value as it understands it, with units (SI); what
    follows from the values (impedance, travel time, strength, excess); whether
    the contact slips at once; static stability and growth; steady sliding at
    the pull rate: its slip rate and traction, whether it is stable, and from
    which pull rate on, and up to which rate a contact from rest sticks all the
    same (a dozen short exact runs; --no-runs skips them); whether the slip rate
    is unique, the critical values, the folds with what is proven of them, and
    the jumps; and warnings. Numbers marked with * depend on the selection rule.

    --figure draws the set K: every pair of slip rate and load that solves the
    contact equation. With --map twice it draws the regime over two numbers.
    --steady-figure draws friction of steady sliding against the slip rate, where
    it is stable, and where it sticks from rest.

    \b
      stickslip check fig6-slab --figure k.png
      stickslip check fig6-slab --map alpha=0.01..10:40:log \
        --map "normal_stress=10 MPa..500 MPa" --figure map.png
    """
    from stickslip.cli.overrides import load
    from stickslip.run.check.examine import examine

    check_targets(Target("--figure", figure), Target("--steady-figure", steady_figure))
    look.check(figure, steady_figure)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*the points look noisy", InputWarning)  # the examination says so
        loaded = load(scenario, "check", changes, any_kind=True)
    if parameters:
        _show_parameters(loaded)
        return
    if not loaded.is_of_core:
        _show_special(loaded, figure or map_axes or steady_figure)
        return
    axes = map_axes or []
    if axes and (len(axes) != 2 or figure is None):
        raise InputError(f"check: a map needs two --map and a --figure, got {len(axes)} and {'one' if figure else 'none'}")
    drawn = None if figure is None else _map(loaded, axes) if axes else _set(loaded)
    steady = _steady(loaded, runs=runs)
    if steady_figure is not None:
        steady.check_drawn("check: --steady-figure")
    _show_examination(loaded, replace(examine(loaded), steady=steady))
    files = [(figure, drawing(drawn, look))] if drawn is not None else []
    steadily = None if steady_figure is None else _sliding(steady, loaded.heading)
    announce(*write_files(*files, *([(steady_figure, drawing(steadily, look))] if steadily is not None else [])))


def _show_parameters(loaded: Scenario) -> None:
    """Print the names of all parameters of a scenario with their units and meanings."""
    from stickslip.problem.scenarios.parameter_paths import parameter_paths

    rows = [(one.name, "" if one.unit == "1" else one.unit, one.declared.meaning) for one in parameter_paths(loaded)]
    print_words(titled(loaded), ("name", "unit", "meaning"), rows)


def _steady(loaded: Scenario, *, runs: bool) -> SteadySlidings:
    """Return what is found about steady sliding, with runs from rest if they are wanted."""
    from stickslip.run import progress_line, steady

    with progress_line("runs from rest:") as report:
        return steady(loaded, from_rest=runs, progress=report)


def _show_special(loaded: Scenario, drawing_wanted: object) -> None:
    """Print what is found about a scenario that the solver of an extension runs. Raises InputError if a drawing is wanted."""
    from stickslip.run import special_solver_of

    tables = "] and [".join(name for name, _ in loaded.tables)
    if drawing_wanted:
        raise InputError(f"check: figures and maps draw the contact equation of a single place: leave them out with a [{tables}]")
    solver = special_solver_of(loaded)
    if solver is None:
        raise InputError(f"check: {loaded.name}: no solver is there for what [{tables}] describes")
    if solver.examine is None:
        _show_parameters(loaded)
        return
    _show_examination(loaded, solver.examine(loaded))


def _show_examination(scenario: Scenario, found: Examination) -> None:
    """Print what was found about a scenario: its numbers, and what follows from them."""
    from stickslip.foundation.show import clean  # with numpy, which help does without

    screen = titled(scenario)
    if scenario.description:
        say(screen, clean(scenario.description))
    print_words(screen, ("", "value", "meaning"), list(found.numbers()))
    screen.print()
    print_words(screen, ("", ""), list(found.findings()), {"warning": "yellow"})


def _set(loaded: Scenario) -> Callable[..., object]:
    """Return the function that draws the set K of a scenario."""
    from stickslip.figures.contact import admissible

    return partial(admissible.draw_admissible, admissible.admissible_data(loaded.problem, title=loaded.heading))


def _sliding(found: SteadySlidings, title: str) -> Callable[..., object]:
    """Return the function that draws steady sliding."""
    from stickslip.figures.contact import steady

    return partial(steady.draw_steady, steady.steady_data(found, title))


def _map(loaded: Scenario, axes: list[str]) -> Callable[..., object]:
    """Return the function that draws the regimes of a scenario over two numbers."""
    from stickslip.cli.overrides import read_axis
    from stickslip.contact.regime_map import regime_map
    from stickslip.figures.contact import regimes
    from stickslip.run import progress_line

    x, y = (read_axis(loaded.problem, text, "check: --map") for text in axes)
    with progress_line("map:") as report:
        found = regime_map(loaded.problem, x, y, lambda done, count: report(f"{done} of {count} points"))
    return partial(regimes.draw_regimes, loaded.problem, found, loaded.heading)
