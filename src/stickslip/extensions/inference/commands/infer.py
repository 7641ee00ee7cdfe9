"""`stickslip infer`: from a laboratory record to the parameters of a scenario, by full runs."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import Field, fields, make_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import ACCURACY, RESULTS, Changes, Columns, FigureFile, ScenarioName, complete_table, is_data, option
from stickslip.cli.output.files import FigureLook, Target, announce, check_folder, check_targets, drawing, write_files
from stickslip.extensions.inference.words import WORDS, Wishes
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.inference.inference import Inference
    from stickslip.problem.scenarios import Scenario

COMPARE = "Another scenario, to compare what both predict of the part left out; may be repeated."
COMPARE_FREE = "The free numbers of the scenarios of --compare; by default those of --free that they have."
SEARCH = "The search"
OUT_OF_TIME = 124
"""Exit code if the time of --max-time is over, as that of the command `timeout`."""
TOLD_AGAIN = 60.0
"""Processor time (s) between two lines on a long search where there is no terminal to show it in one."""
NAMES_TYPED = {"begin": "--from", "end": "--to", "bounds": "--bound", "priors": "--prior"}
"""What options are called on the command line, but for those that are called as in Python."""
OF_SEARCH = ("bounds", "priors", "begin_at", "loss", "weight", "starts", "seed", "trend", "max_time")
PANELS = dict.fromkeys(OF_SEARCH, SEARCH) | {"rtol": ACCURACY}
"""Where the help lists options, but for those under its first heading."""
MAPPING = "Mapping[str, Any] | None"
TYPED: dict[str, Any] = {
    "Sequence[str] | None": str | None,
    "Sequence[str] | str | None": str | None,
    "float | str | WithUnit | None": str | None,
    "str | Path | None": Path | None,
    "str | None": str | None,
    "bool": bool,
    "float": float,
    "int": int,
    "str": str,
    MAPPING: list[str] | None,
}
"""What is typed of an option, by the type of its field in `Wishes`."""
OPTIONS = {one.name: one for one in fields(Wishes) if str(one.type) in TYPED}
"""Those options of `infer` in Python that are options here."""


def _name(one: Field[Any]) -> str:
    """Return what an option of `infer` in Python is called on the command line."""
    return NAMES_TYPED.get(one.name, f"--{one.name.replace('_', '-')}")


def _declared(one: Field[Any]) -> tuple[str, Any, Any]:
    """Return an option of `infer` in Python as one of the command line: its name, its type with its help, and its default."""
    text, panel, is_shown = WORDS[one.name].meaning, PANELS.get(one.name), one.default is not None
    how = typer.Option(_name(one), help=text, rich_help_panel=panel, show_default=is_shown)
    return one.name, Annotated[TYPED[str(one.type)], how], one.default


if TYPE_CHECKING:
    TypedWishes = Any
else:
    TypedWishes = make_dataclass("TypedWishes", [_declared(one) for one in OPTIONS.values()], frozen=True)
"""The options of `infer` in Python as they are typed."""


def infer(
    scenario: ScenarioName,
    data: Annotated[
        list[str], typer.Argument(help="CSV files with a column time, and what was measured.", autocompletion=complete_table)
    ],
    *,
    free: Annotated[str, typer.Option(help=WORDS["free"].meaning)],
    changes: Changes = None,
    column: Columns = None,
    typed: TypedWishes,
    compare: Annotated[list[str] | None, option(COMPARE)] = None,
    compare_free: Annotated[str | None, option(COMPARE_FREE)] = None,
    out: Annotated[
        Path | None, option("Save all numbers and curves (.nc) or the table (.csv).", "--out", "-o", panel=RESULTS)
    ] = None,
    scenario_out: Annotated[Path | None, option("Write the scenario that runs to the curve found (.toml).", panel=RESULTS)] = None,
    report: Annotated[Path | None, option("Write a page with all of it to this folder.", panel=RESULTS)] = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Find the parameters with which a run follows a laboratory record, with their uncertainty.

    The data are columns with headings and units: time, friction (or
    "tau (MPa)" with "sigma (MPa)", or shear_force, or torque), slip,
    slip_rate, and load_point (displacement of the machine) or load_rate,
    which becomes the loading; of a contact that turns in deg and rpm, as in
    the log of a drill floor: STOR (torque at the drive), RPM, SWOB. Two files with clocks of their own are one record if they are
    given as FIRST+SECOND@SECONDS, where SECONDS says how much later the
    zero of the second clock is. Each trial is a full run with inertia and
    waves, so that machine stiffness, steps of rate, holds and stick-slip
    are all fitted as they are.

    For points of friction against slip or slip rate see `stickslip fit`.

    \b
      stickslip infer velocity-steps-block data.csv --free a,b,stiffness
      stickslip infer mine.toml data.csv --free a --prior "a=normal(0.01, 0.002)"
      stickslip infer mine.toml data.csv --free static,dynamic --parts rests
      stickslip infer mine.toml data.csv --free static,dynamic --by features
      stickslip infer a.toml data.csv --free a,b --held-out 0.3 --compare b.toml
      stickslip infer mine.toml data.csv --free a,b --scenario-out best.toml
      stickslip infer mine.toml data.csv --free a,b --report fitted
      stickslip infer mine.toml rig.lvm --free a,b --column "load_point=Ram (mm)"

    After Ctrl-C the command shows and saves the best numbers so far.
    So it does after the processor time of --max-time (10 min for the search).
    With --checkpoint a command that was killed is typed again, and its samples go on.

    Exit code: 0 done, 1 the record determines none of the numbers,
    2 unusable input, 124 the time is over, 130 interrupted.
    """
    from stickslip.cli.overrides import load
    from stickslip.extensions.inference.summary import show_inference, show_ranking

    targets = Target("--out", out, (".nc", ".csv")), Target("--scenario-out", scenario_out, (".toml",))
    check_targets(*targets, Target("--figure", figure))
    if report is not None:
        check_folder(report, "--report")
    look.check(figure)
    options = {name: _read(OPTIONS[name], value) for name, value in vars(typed).items()}
    if is_data(scenario):
        words = ["SCENARIO", scenario, *data] if is_data(data[0]) else [data[0], scenario, *data[1:]]
        raise InputError(f"infer: the scenario comes first, and then the data: `stickslip infer {' '.join(words)} --free {free}`")
    if compare and typed.held_out is None:
        raise InputError("infer: --compare needs --held-out, the part of the record that is predicted")
    chosen = load(scenario, "infer", changes)
    compared = [(one := load(name, "infer"), _free_of(name, one, compare_free or free)) for name in compare or ()]
    records = _records(data, column)
    found = _inferred(chosen, records, free, options)
    show_inference(chosen, found)
    others = [
        _inferred(one, records, names, options | dict.fromkeys(("priors", "bounds", "begin_at", "checkpoint")))
        for one, names in compared
    ]
    if others:
        show_ranking(found, *others)
    save = found.to_netcdf if out is not None and out.suffix.lower() == ".nc" else found.to_csv
    announce(*write_files((out, save), (scenario_out, found.to_toml), (figure, drawing(found.plot, look))))
    if report is not None:
        announce(found.report(report, *others))
    if not found.estimate.finished:
        if found.estimate.ended:
            raise typer.Exit(OUT_OF_TIME)
        raise KeyboardInterrupt
    if not found.determined:
        raise typer.Exit(1)


def _records(data: list[str], column: list[str] | None) -> list[Any]:
    """Return the records as they were typed, or read, if the user says what their columns are. Raises InputError."""
    from stickslip.cli.overrides import typed_columns
    from stickslip.extensions.inference.record.record import Record

    columns = typed_columns(column, "infer: --column")
    return [Record.read(one, columns=columns) for one in data] if columns else list(data)


def _inferred(scenario: Any, data: list[Any], free: str, options: dict[str, Any]) -> Inference:
    from stickslip.extensions.inference.infer import infer as study
    from stickslip.extensions.inference.summary import as_options
    from stickslip.run import progress_line

    with progress_line(f"{scenario.name}:") as report:
        try:
            return study(scenario, data, free, progress=_seldom(scenario.name, report), **options)
        except InputError as error:
            raise InputError(as_options(str(error))) from None


def _seldom(name: str, report: Callable[[str], object]) -> Callable[[str], object]:
    """Return what shows the progress: `report` on a terminal, and elsewhere one line on standard error now and then."""
    if sys.stderr.isatty():
        return report
    told = time.process_time()

    def show(text: str) -> None:
        nonlocal told
        if time.process_time() - told > TOLD_AGAIN:
            told = time.process_time()
            sys.stderr.write(f"{name}: {text}\n")

    return show


def _free_of(name: str, scenario: Scenario, free: str) -> str:
    """Return those of the free numbers that another scenario has. Raises InputError if it has none."""
    from stickslip.extensions.inference.fit.free import known_numbers
    from stickslip.foundation.errors import full_name

    known, found = known_numbers(scenario.problem, {}), []
    for one in free.split(","):
        try:
            found.append(full_name(one.strip(), known, "", ""))
        except InputError:
            continue
    if not found:
        raise InputError(f"infer: --compare {name}: has none of the numbers of --free: name its own with --compare-free")
    return ",".join(found)


def _read(one: Field[Any], typed: Any) -> Any:
    """Return the value of an option from what was typed. Raises InputError."""
    from stickslip.cli.overrides import typed_values
    from stickslip.problem.scenarios import typed_number

    if not typed:
        return None if one.type == MAPPING else typed
    if one.type == MAPPING:
        values = typed_values(typed, f"infer: {_name(one)}", "friction.a=0.01")
        return _bounds(values) if one.name == "bounds" else values
    if one.type == "Sequence[str] | None":
        return typed.split(",")
    return typed_number(typed) if "WithUnit" in str(one.type) else typed


def _bounds(typed: Mapping[str, Any]) -> dict[str, Any]:
    """Return limits by name. Raises InputError."""
    from stickslip.foundation.arguments import shown
    from stickslip.foundation.axis import TypedRange
    from stickslip.problem.scenarios import typed_number

    found = {}
    for name, value in typed.items():
        limits = TypedRange.of(str(value), "infer: --bound")
        if limits is None or limits.points is not None or limits.log:
            raise InputError(f'infer: --bound must be NAME=LOW..HIGH, as "friction.a=0.001..0.1", got {shown(f"{name}={value}")}')
        found[name] = (typed_number(limits.low), typed_number(limits.high))
    return found
