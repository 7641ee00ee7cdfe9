"""`stickslip sweep`: many runs of a scenario over what varies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_design, complete_quantity, complete_scenario, complete_vary
from stickslip.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.sweeps.estimate import Estimate
    from stickslip.sweeps.plan import Plan
    from stickslip.sweeps.sweep import Report, Runner


def sweep(
    scenario: Annotated[str, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario)],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            "-v",
            help="KEY=LOW..HIGH:POINTS[:log] or KEY=VALUE,VALUE,...; once for each key.",
            autocompletion=complete_vary,
            show_default=False,
        ),
    ] = None,
    table: Annotated[
        Path | None,
        typer.Option("--list", help="Members from a table instead (.csv): a column a key, a row a member.", show_default=False),
    ] = None,
    design: Annotated[
        str, typer.Option(help="grid, or samples between LOW and HIGH: random, lhs.", autocompletion=complete_design)
    ] = "grid",
    members: Annotated[int | None, typer.Option("--members", "-m", help="How many samples.", show_default=False)] = None,
    seed: Annotated[int, typer.Option(help="What samples are drawn from: the same seed, the same members.")] = 0,
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            "--quantity", "-q", help="What is kept of each run; several.", autocompletion=complete_quantity, show_default=False
        ),
    ] = None,
    series: Annotated[
        str, typer.Option(help="Curves over time to be kept too: slip,slip_rate,traction,load.", show_default=False)
    ] = "",
    samples: Annotated[int, typer.Option(help="Times of such a curve.")] = 200,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Save the results as they come (a folder, .zarr).", show_default=False)
    ] = None,
    threads: Annotated[int | None, typer.Option(help="Threads (default: all cores).", show_default=False)] = None,
    chunk: Annotated[
        int | None,
        typer.Option(help="Members that are run and saved together (default: 1/64, from 16 to 4096).", show_default=False),
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say how many members, how much time and disk, and stop.")] = False,
) -> None:
    """Run a scenario many times, over two or three numbers: a map of pulses, slips, regimes.

    Any number of a scenario can be varied, by its place in the file
    (friction.alpha, body.thickness, friction.slip.mean, run.rtol); units are
    those of scenarios. Runs that fail are counted, with their reasons.

    \b
      stickslip sweep fig6-slab --vary friction.alpha=0.05..2:40 \\
        --vary "body.thickness=1km..50km:30:log" --out map.zarr
      stickslip sweep mine.toml -v alpha=0.1,1,10 -q recurrence -q heat
      stickslip sweep mine.toml -v alpha=0.1..10:log -v static=0.6..0.8 \\
        --design lhs --members 1000 --out sample.zarr

    Stopped or killed, the same command goes on where the store ends.

    Kept unless said otherwise: events, pulses, slip, peak_rate,
    first_duration, recurrence, arrested. A wrong name lists all quantities.

    Exit code: 0 done, 1 every run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.sweep_summary import show_estimate, show_sweep
    from stickslip.sweeps.plan import make_plan
    from stickslip.sweeps.quantities import DEFAULT
    from stickslip.sweeps.sweep import check_out, on_threads

    if (table is None) == (not vary):
        raise InputError(f"sweep: needs either --vary or --list, got {'both' if vary else 'neither'}")
    if out is not None:
        check_out(out, "--out")
    plan = make_plan(
        scenario,
        table or vary,
        design=design,
        members=members,
        seed=seed,
        quantities=quantity or DEFAULT,
        series=[name.strip() for name in series.split(",") if name.strip()],
        samples=samples,
        chunk=chunk,
        where="--list" if table else "--vary",
    )
    run = on_threads(threads)
    if dry_run:
        show_estimate(plan, _estimated(plan, run))
        return
    found = _found(plan, out, run)
    raise typer.Exit(show_sweep(plan, found, out))


def _estimated(plan: Plan, run: Runner) -> Estimate:
    from stickslip.cli.show import progress_to
    from stickslip.sweeps.estimate import estimate

    with progress_to(f"{plan.scenario.name}: timing a sample"):
        return estimate(plan, run)


def _found(plan: Plan, out: Path | None, run: Runner) -> xr.Dataset:
    from stickslip.cli.show import progress_to
    from stickslip.sweeps.sweep import carry_out

    with progress_to(f"{plan.scenario.name}:") as tell:
        return carry_out(plan, out, run, lambda report: tell(so_far(report)))


def so_far(report: Report) -> str:
    """How far a sweep is, in one line."""
    from stickslip.cli.show import about_time, number

    parts = [f"{report.done} of {report.members} members"]
    if report.rate > 0.0:
        parts += [f"{number(report.rate, 3)} a second", f"{about_time(report.left)} left"]
    return ", ".join([*parts, *([f"{report.failed} failed"] if report.failed else [])])
