"""`stickslip infer`: from a laboratory record to the parameters of a scenario, by full runs."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import ACCURACY, RESULTS, Changes, Columns, FigureFile, ScenarioName, complete_table, is_data, option
from stickslip.cli.output.files import FigureLook, Target, announce, check_folder, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.inference.inference import Inference
    from stickslip.problem.scenarios import Scenario

FREE = 'The numbers to find, with commas: "a,b,body.stiffness".'
BY = "What is fitted: samples, or features of slip events."
OBSERVE = (
    "Which samples or features: friction, shear_stress, shear_force, torque, slip, slip_rate, surface_torque, drive_rate; peak, "
    "rest, drop, recurrence, duration, event_slip, peak_rate."
)
SENSOR = "Where shear is measured: contact, spring (load cell of a block), or drive (torque of a top drive)."
START = "How the run begins: steady, record (load of the first samples) or problem."
PRIOR = 'What you know beforehand: "friction.a=normal(0.01, 0.002)"; lognormal and uniform too.'
BOUND = 'Limits of a number: "friction.a=0.001..0.1".'
COMPARE = "Another scenario, to compare what both predict of the part left out; may be repeated."
COMPARE_FREE = "The free numbers of the scenarios of --compare; by default those of --free that they have."
WEIGHT = "More weight for samples soon after a change of the pull rate: exponent p of (n/j)^p, as in RSFit3000."
TREND = "auto: a drift with slip or time is free, too, if plateaus of friction show one; none: it is not."
MAX_TIME = 'Processor time (s, or as "1 h") after which the best numbers so far are shown; 10 min for the search by default.'
SEARCH = "The search"
OUT_OF_TIME = 124
"""Exit code if the time of --max-time is over, as that of the command `timeout`."""
TOLD_AGAIN = 60.0
"""Processor time (s) between two lines on a long search where there is no terminal to show it in one."""


def infer(
    scenario: ScenarioName,
    data: Annotated[
        list[str], typer.Argument(help="CSV files with a column time, and what was measured.", autocompletion=complete_table)
    ],
    *,
    free: Annotated[str, typer.Option(help=FREE)],
    changes: Changes = None,
    column: Columns = None,
    begin: Annotated[str | None, option("Take the record from this time on (s, or with a unit).", "--from")] = None,
    end: Annotated[str | None, option("Take the record up to this time.", "--to")] = None,
    by_what: Annotated[str, option(BY, "--by")] = "samples",
    observe: Annotated[str | None, option(OBSERVE)] = None,
    start: Annotated[str | None, option(START)] = None,
    sensor: Annotated[str, typer.Option(help=SENSOR)] = "contact",
    normal: Annotated[
        str, typer.Option(help="Normal load of the runs: problem, or record (its column, as it varies).")
    ] = "problem",
    parts: Annotated[str | None, option("rests: a run of its own after each slip event of the record.")] = None,
    each: Annotated[str | None, option("What is free for each part of --parts: initial.load, initial.state.")] = None,
    bound: Annotated[list[str] | None, option(BOUND, panel=SEARCH)] = None,
    prior: Annotated[list[str] | None, option(PRIOR, panel=SEARCH)] = None,
    begin_at: Annotated[list[str] | None, option("Where the search for a number begins: NAME=VALUE.", panel=SEARCH)] = None,
    weight: Annotated[float, typer.Option(help=WEIGHT, rich_help_panel=SEARCH)] = 0.0,
    windows: Annotated[bool, typer.Option("--windows", help="Fit shorter parts of the record, too, and show the spread.")] = False,
    loss: Annotated[str, typer.Option(help="linear; soft_l1, huber or cauchy for outliers.", rich_help_panel=SEARCH)] = "linear",
    starts: Annotated[int, typer.Option(help="How many starts the search has.", rich_help_panel=SEARCH)] = 4,
    seed: Annotated[int, typer.Option(help="Seed of starts and samples.", rich_help_panel=SEARCH)] = 0,
    held_out: Annotated[str | None, option('Leave the end out, to be predicted: a share as 0.3, or "100 s".')] = None,
    profiles: Annotated[bool, typer.Option("--profiles", help="Intervals from profiles of the likelihood.")] = False,
    samples: Annotated[int, typer.Option(help="Samples of the posterior distribution to draw (needs emcee).")] = 0,
    checkpoint: Annotated[Path | None, option("Keep the samples in this file (.nc); the same command goes on with them.")] = None,
    trend: Annotated[str, option(TREND, panel=SEARCH)] = "auto",
    max_time: Annotated[str | None, option(MAX_TIME, panel=SEARCH)] = None,
    compare: Annotated[list[str] | None, option(COMPARE)] = None,
    compare_free: Annotated[str | None, option(COMPARE_FREE)] = None,
    rtol: Annotated[float, typer.Option(help="Relative tolerance of the runs.", rich_help_panel=ACCURACY)] = 1e-8,
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
    options: dict[str, Any] = {
        "by": by_what,
        "observe": observe,
        "start": start,
        "sensor": sensor,
        "normal": normal,
        "parts": parts,
    }
    options |= {"loss": loss, "starts": starts, "weight": weight, "windows": windows}
    options |= {"each": each and each.split(","), "seed": seed, "profiles": profiles, "samples": samples, "rtol": rtol}
    options |= {"checkpoint": checkpoint, "trend": trend, "max_time": _typed(max_time)}
    options |= {"held_out": _typed(held_out), "begin": _typed(begin), "end": _typed(end)}
    options |= {"bounds": _bounds(bound), "priors": _values(prior, "--prior"), "begin_at": _values(begin_at, "--begin-at")}
    if is_data(scenario):
        words = ["SCENARIO", scenario, *data] if is_data(data[0]) else [data[0], scenario, *data[1:]]
        raise InputError(f"infer: the scenario comes first, and then the data: `stickslip infer {' '.join(words)} --free {free}`")
    if compare and held_out is None:
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


def _typed(text: str | None) -> Any:
    """Return what was typed as a number if it is one."""
    from stickslip.problem.scenarios import typed_number

    return None if text is None else typed_number(text)


def _values(texts: list[str] | None, where: str) -> dict[str, Any] | None:
    from stickslip.cli.overrides import typed_values

    return typed_values(texts, f"infer: {where}", "friction.a=0.01") if texts else None


def _bounds(texts: list[str] | None) -> dict[str, Any] | None:
    """Return limits by name. Raises InputError."""
    from stickslip.foundation.arguments import shown
    from stickslip.foundation.axis import TypedRange
    from stickslip.problem.scenarios import typed_number

    if not texts:
        return None
    found = {}
    for name, value in (_values(texts, "--bound") or {}).items():
        typed = TypedRange.of(str(value), "infer: --bound")
        if typed is None or typed.points is not None or typed.log:
            raise InputError(f'infer: --bound must be NAME=LOW..HIGH, as "friction.a=0.001..0.1", got {shown(f"{name}={value}")}')
        found[name] = (typed_number(typed.low), typed_number(typed.high))
    return found
