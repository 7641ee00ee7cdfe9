"""`stickslip ensemble`: find how far a run and its statistics can be trusted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_scenario

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario
    from stickslip.studies.ensemble import Ensemble

FIRST = 12
"""Number of events that are shown: the first ones, or those around the first event at which members differ."""


def ensemble(
    scenario: Annotated[str, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario)],
    members: Annotated[int, typer.Option("--members", "-m", help="How many disturbed runs.")] = 8,
    size: Annotated[float, typer.Option(help="Largest disturbance of the initial load, as a share of the strength.")] = 1e-12,
    until: Annotated[
        str | None, typer.Option("--until", help='Override the duration: s, or with a unit ("480 year").', show_default=False)
    ] = None,
    events: Annotated[int | None, typer.Option(help="Stop each run after this number of slip events.", show_default=False)] = None,
    seed: Annotated[int, typer.Option(help="Seed of the random disturbances; the same seed gives the same members.")] = 0,
    rtol: Annotated[float | None, typer.Option(help="Override the relative tolerance.", show_default=False)] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Save the table of events (.csv), or all that is drawn (.nc).", show_default=False),
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", "-f", help="Save a figure (.png, .pdf or .svg).", show_default=False)
    ] = None,
) -> None:
    """Find how far single events and statistics can be trusted: repeat a run with tiny disturbances of the initial load.

    A slab whose friction falls with slip rate amplifies its own echoes, so that
    two runs which differ by rounding diverge. Each member begins with a load
    that is larger or smaller by `size`/2 to `size` of the static strength. The
    command shows the event from which on members differ, the growth rate of
    the disturbance beside the predicted one, and how far the statistics of the
    members are apart.

    \b
      stickslip ensemble fig6-slab --until "30000 years" --events 65 --figure a.png
      stickslip ensemble cycles-block --size 1e-6 --out events.csv
      stickslip ensemble mine.toml --members 20 --size 1e-6 --seed 1

    After Ctrl-C the command shows and saves the result of the finished members.

    Exit code: 0 done, 1 a run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.output.files import check_target

    for path, option, suffixes in ((out, "--out", (".csv", ".nc")), (figure, "--figure", (".png", ".pdf", ".svg"))):
        if path is not None:
            check_target(path, option, suffixes)
    chosen = _adjusted(scenario, until, events, rtol)
    study = _study(chosen, members, size, seed)
    _show(chosen, study)
    for line in _save(study, out, figure):
        typer.echo(line)
    if len(study.runs) < study.wanted:
        raise KeyboardInterrupt
    raise typer.Exit(0 if study.ok else 1)


def _adjusted(name: str, until: str | None, events: int | None, rtol: float | None) -> Scenario:
    from stickslip.scenarios.scenario import load_scenario
    from stickslip.scenarios.schema import check_events, check_rtol, read_duration

    loaded = load_scenario(name)
    if until is not None:
        loaded = replace(loaded, duration=read_duration(until, "ensemble", "--until"))
    if events is not None:
        loaded = replace(loaded, max_events=check_events(events, "ensemble", "--events"))
    if rtol is not None:
        loaded = replace(loaded, rtol=check_rtol(rtol, "ensemble", "--rtol"))
    return loaded


def _study(scenario: Scenario, members: int, size: float, seed: int) -> Ensemble:
    from stickslip.cli.output.show import progress_to
    from stickslip.studies.ensemble import ensemble as study

    with progress_to(f"{scenario.name}:") as report:
        run = scenario.problem, scenario.duration, members, size, scenario.rtol
        return study(*run, max_events=scenario.max_events, seed=seed, progress=report)


def _show(scenario: Scenario, study: Ensemble) -> None:
    from stickslip.cli.output.show import clean, console, number, with_unit

    screen = console()
    screen.print(clean(scenario.title or scenario.name), style="bold")
    largest = with_unit(float(abs(study.pushes).max()), study.problem.load_unit)
    about = f"initial load disturbed by up to {number(study.size)} of the strength ({largest})"
    screen.print(f"{len(study.runs)} members, {about}\n", soft_wrap=True)
    if len(study.table):
        _show_events(study)
        _show_statistics(study)
    for line in (study.note, study.stopped, study.text, study.growth_text):
        if line:
            screen.print(f"{line[0].upper()}{line[1:]}.", soft_wrap=True)


def _show_events(study: Ensemble) -> None:
    from stickslip.cli.output.show import console, number, table

    lost = study.first_lost or 0
    first = max(0, min(lost - FIRST // 2, len(study.table) - FIRST))
    headings = ("\nevent", "start\ns", "\nmembers", "spread of\nstart s", "spread of\nslip m", "\namplification")
    shown = table(*headings, numbers=True)
    for i, row in enumerate(study.table.iloc[first : first + FIRST].to_dict("records"), first + 1):
        numbers = (number(float(row[name]), 3) for name in ("start_spread", "slip_spread", "amplification"))
        shown.add_row(str(i), number(float(row["start"]), 10), f"{row['members']} of {len(study.runs)}", *numbers)
    screen = console()
    screen.print(f"{len(study.table)} slip events" + (f", of them {first + 1} to {first + len(shown.rows)}" if first else ""))
    screen.print(shown)


def _show_statistics(study: Ensemble) -> None:
    from stickslip.cli.output.show import console, number, table

    units = {"recurrence": "s", "slip": "m", "peak_rate": "m/s"}
    headings = ("mean,\nundisturbed", "mean over\nmembers", "their\ndeviation", "by\nchance")
    shown = table("\nstatistics", *headings, "variation,\nundisturbed", "over\nmembers", "their\ndeviation", numbers=True)
    columns = ("mean", "mean_members", "mean_deviation", "chance", "variation", "variation_members", "variation_deviation")
    for name, row in study.statistics.iterrows():
        values = (number(float(row[column]), 4) for column in columns)
        shown.add_row(f"{name} ({units[str(name)]})".replace("_", " "), *values)
    console().print(shown)
    console().print()


def _save(study: Ensemble, out: Path | None, figure: Path | None) -> list[str]:
    from stickslip.foundation.atomic_write import write_atomically

    written = []
    if out is not None:
        study.save(out)
        written.append(f"written: {out}")
    if figure is not None:
        write_atomically(figure, study.plot().savefig)
        written.append(f"written: {figure}")
    return written
