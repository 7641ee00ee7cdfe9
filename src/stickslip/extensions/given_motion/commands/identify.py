"""`stickslip identify`: find a friction law along measured motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import RESULTS, Changes, Columns, FigureFile, ScenarioName, complete_table, option
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.identification import Identification

FREE = 'The numbers to find: "static,dynamic,record.offset".'
NORMAL_LOAD = 'The normal load, if neither record nor scenario has it: "100 N".'
BEGIN_AT = "Where the search for a number begins: NAME=VALUE."
BOUND = 'Limits of a number: "friction.rate=1e-4..1e-2".'
DEVIATION = 'Standard deviation of the noise of slip_rate ("0.1 mm/s"), or of slip ("1 um").'
SMOOTH = "Take a measured slip rate from a smooth curve through it, too."


def identify(
    scenario: ScenarioName,
    data: Annotated[str, typer.Argument(help="A CSV file: time, slip_rate or slip, and friction.", autocompletion=complete_table)],
    *,
    free: Annotated[str, typer.Option(help=FREE)],
    changes: Changes = None,
    column: Columns = None,
    normal_load: Annotated[str | None, option(NORMAL_LOAD)] = None,
    begin_at: Annotated[list[str] | None, option(BEGIN_AT)] = None,
    bound: Annotated[list[str] | None, option(BOUND)] = None,
    initial_state: Annotated[str | None, option('State of the law at the start: a number, or "steady".')] = None,
    motion_deviation: Annotated[str | None, option(DEVIATION)] = None,
    smooth: Annotated[bool, typer.Option("--smooth", help=SMOOTH)] = False,
    starts: Annotated[int, typer.Option(help="How many starts the search has.", min=1, max=1000)] = 1,
    seed: Annotated[int, typer.Option(help="Seed of starts, and of draws of the noise of the motion.", min=0)] = 0,
    out: Annotated[Path | None, option("Save the numbers (.json or .csv).", "--out", "-o", panel=RESULTS)] = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Find the numbers of a friction law along measured motion.

    The record has columns with headings and units: time; slip_rate (or
    velocity), or slip (a position, whose rate is that of a smooth curve);
    shear_force, shear_stress, torque or friction; and normal_force,
    normal_stress or normal_torque if it was measured. Motion may go both ways,
    with friction of its sign. Only the states of friction are solved: no body,
    spring or controller is needed, and none of the scenario is used but its
    law and its normal load. Noise of the motion enters the standard errors.

    Friction measured behind a spring, by a load point, is for `stickslip infer`.

    \b
      stickslip identify axis.toml axis.csv --free static,dynamic,rate
      stickslip identify axis.toml axis.csv --free stiffness,damping --smooth
      stickslip identify axis.toml axis.csv --free a,b --out found.json

    Exit code: 0 done, 1 the record does not determine the numbers,
    2 unusable input.
    """
    from stickslip.cli.output.show import console, print_sentences
    from stickslip.cli.overrides import load, typed_columns, typed_values
    from stickslip.extensions.given_motion.identify import identify as study
    from stickslip.extensions.given_motion.moved import MovedContact
    from stickslip.problem.scenarios import check_solved_by_core, typed_number

    check_targets(Target("--out", out, (".json", ".csv")), Target("--figure", figure))
    look.check(figure)
    chosen = load(scenario, "identify", changes, any_kind=True)
    if not isinstance(chosen.to_solve, MovedContact):
        check_solved_by_core("identify", chosen)
    found: Identification = study(
        chosen,
        data,
        free,
        normal_load=normal_load,
        begin_at=typed_values(begin_at or (), "identify: --begin-at", "friction.static=0.2"),
        bounds=_bounds(bound or []),
        initial_state=None if initial_state is None else typed_number(initial_state),
        motion_deviation=motion_deviation,
        smooth=smooth,
        starts=starts,
        seed=seed,
        columns=typed_columns(column, "identify: --column"),
    )
    print_sentences(console(), *str(found).splitlines())
    save = found.to_json if out is not None and out.suffix.lower() == ".json" else found.to_csv
    announce(*write_files((out, save), (figure, drawing(found.plot, look))))
    if not found.determined:
        raise typer.Exit(1)


def _bounds(typed: list[str]) -> dict[str, tuple[Any, Any]]:
    """Return limits by name. Raises InputError."""
    from stickslip.cli.overrides import typed_values
    from stickslip.problem.scenarios import typed_number

    found = {}
    for name, value in typed_values(typed, "identify: --bound", '"friction.rate=1e-4..1e-2"').items():
        low, dots, high = str(value).partition("..")
        if not dots:
            raise InputError(f"identify: --bound must be NAME=LOW..HIGH, got {name}={value}")
        found[name] = (typed_number(low), typed_number(high))
    return found
