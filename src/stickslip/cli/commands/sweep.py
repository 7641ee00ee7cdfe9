"""`stickslip sweep`: run a scenario many times with varied numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.names import complete_design, complete_quantity, complete_scenario, complete_vary
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.sweeps.estimate import Estimate
    from stickslip.sweeps.execution.plan import Plan
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
        typer.Option(
            "--list", help="Members from a table instead (.csv): one column per key, one row per member.", show_default=False
        ),
    ] = None,
    design: Annotated[
        str, typer.Option(help="grid, or samples between LOW and HIGH: random, lhs.", autocompletion=complete_design)
    ] = "grid",
    members: Annotated[int | None, typer.Option("--members", "-m", help="How many samples.", show_default=False)] = None,
    seed: Annotated[int, typer.Option(help="Seed of the random samples; the same seed gives the same members.")] = 0,
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            "--quantity",
            "-q",
            help="Quantity to keep of each run; may be repeated.",
            autocompletion=complete_quantity,
            show_default=False,
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
        typer.Option(help="Members that are run and saved together (default: 1/64 of all).", show_default=False),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(help="Processes of a dask cluster to be started here, instead of threads.", show_default=False)
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Run on the dask cluster at HOST:PORT, or of a scheduler file.", show_default=False)
    ] = None,
    refine: Annotated[
        str | None,
        typer.Option(
            help="Refine the map where this quantity changes.",
            autocompletion=complete_quantity,
            show_default=False,
            metavar="QUANTITY",
        ),
    ] = None,
    depth: Annotated[int, typer.Option(help="With --refine: how often cells are halved.")] = 6,
    factor: Annotated[
        float | None, typer.Option(help="With --refine: look for jumps by more than this factor.", show_default=False)
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(
            "--figure", "-f", help="Draw the first quantity, or the one that is refined (.png, .pdf or .svg).", show_default=False
        ),
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say how many members, how much time and disk, and stop.")] = False,
) -> None:
    """Run a scenario many times with two or three varied numbers, for maps of pulses, slips and regimes.

    Any number of a scenario can be varied, by its place in the file
    (friction.alpha, body.thickness, friction.slip.mean, run.rtol), with the
    units of scenarios. Runs that fail are counted, with their reasons.

    \b
      stickslip sweep fig6-slab --vary friction.alpha=0.05..2:40 \\
        --vary "body.thickness=1km..50km:30:log" --out map.zarr
      stickslip sweep mine.toml -v alpha=0.1,1,10 -q recurrence -q heat
      stickslip sweep mine.toml -v alpha=0.1..10:log -v static=0.6..0.8 \\
        --design lhs --members 1000 --out sample.zarr
      stickslip sweep fig6-slab -v alpha=0.05..2:9 -v thickness=1km..50km:9 \\
        --refine events --depth 5 --figure map.png

    After a stop, the same command continues where the store ends.

    By default a sweep keeps events, pulses, slip, peak_rate, first_duration,
    recurrence and arrested. A wrong name lists all quantities.

    Exit code: 0 done, 1 every run failed or a cluster lost some, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.output.files import check_target
    from stickslip.cli.output.sweep_summary import show_estimate, show_sweep
    from stickslip.sweeps.design.quantities import DEFAULT
    from stickslip.sweeps.execution.plan import make_plan
    from stickslip.sweeps.sweep import check_out, runner_of

    if (table is None) == (not vary):
        raise InputError(f"sweep: needs either --vary or --list, got {'both' if vary else 'neither'}")
    if out is not None:
        check_out(out, "--out")
    if figure is not None:
        check_target(figure, "--figure", (".png", ".pdf", ".svg"))
    if refine is not None and (table or design != "grid" or series or dry_run):
        raise InputError("sweep: --refine needs a grid of --vary; it takes no --list, --design, --series and --dry-run")
    plan = make_plan(
        scenario,
        table or vary,
        design=design,
        members=members,
        seed=seed,
        quantities=_kept(quantity or DEFAULT, refine),
        series=[name.strip() for name in series.split(",") if name.strip()],
        samples=samples,
        chunk=chunk,
        where="--list" if table else "--vary",
    )
    with _losses():
        if refine is not None:
            where: dict[str, Any] = {"threads": threads, "workers": workers, "scheduler": scheduler}
            search = {"quantity": refine, "depth": depth, "factor": factor, "out": out, "chunk": chunk}
            plan, found = _refined(plan, vary, search | where)
        else:
            with runner_of(threads, workers, scheduler) as (run, at_once):
                if dry_run:
                    show_estimate(plan, _estimated(plan, run, at_once))
                    return
                found = _found(plan, out, run)
    if figure is not None:
        _draw(found, refine or plan.work.names[0], figure)
    raise typer.Exit(show_sweep(plan, found, out, figure))


@contextmanager
def _losses() -> Iterator[None]:
    """Report in one line what a cluster has lost, and exit with code 1."""
    from stickslip.sweeps.execution.cluster import ChunksLostError

    try:
        yield
    except ChunksLostError as error:
        typer.echo(f"stickslip: {error}", err=True)
        raise typer.Exit(1) from None


def _kept(wanted: Sequence[str], refined: str | None) -> list[str]:
    """Return the quantities to keep, with the one by which the map is refined."""
    return [*wanted, *([refined] if refined and refined not in wanted else [])]


def _estimated(plan: Plan, run: Runner, at_once: int) -> Estimate:
    from stickslip.cli.output.show import progress_to
    from stickslip.sweeps.estimate import estimate

    with progress_to(f"{plan.scenario.name}: timing a sample"):
        return estimate(plan, run, at_once)


def _found(plan: Plan, out: Path | None, run: Runner) -> xr.Dataset:
    from stickslip.cli.output.show import progress_to
    from stickslip.sweeps.sweep import carry_out

    with progress_to(f"{plan.scenario.name}:") as tell:
        return carry_out(plan, out, run, lambda report: tell(so_far(report)))


def _refined(plan: Plan, vary: list[str] | None, options: dict[str, Any]) -> tuple[Plan, xr.Dataset]:
    """Return the plan of all members of a refined map, and their results."""
    from stickslip.cli.output.show import progress_to
    from stickslip.sweeps.design.design import Design
    from stickslip.sweeps.refine import COMPLETE, refine

    with progress_to(f"{plan.scenario.name}:") as tell:
        kept = plan.work.quantities
        found = refine(plan.scenario, vary, quantities=kept, progress=lambda report: tell(so_far(report)), **options)
    if not found.attrs[COMPLETE]:
        typer.echo(f"stickslip: the refinement ended after {found.sizes['member']} members: the map is not complete", err=True)
    keys = plan.design.keys
    return replace(plan, design=Design("refined", keys, tuple(found[key.name].values for key in keys))), found


def _draw(dataset: xr.Dataset, quantity: str, figure: Path) -> None:
    from stickslip.figures.sweeps.sweep import plot_sweep

    plot_sweep(dataset, quantity, figure)


def so_far(report: Report) -> str:
    """Format the progress of a sweep in one line."""
    from stickslip.cli.output.show import about_time, number

    parts = [f"{report.done} of {report.members} members"]
    if report.rate > 0.0:
        parts += [f"{number(report.rate, 3)} a second", f"{about_time(report.left)} left"]
    return ", ".join([*parts, *([f"{report.failed} failed"] if report.failed else [])])
