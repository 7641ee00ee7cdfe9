"""`stickslip sweep`: run a scenario many times with varied numbers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import (
    Changes,
    Duration,
    ScenarioName,
    choices,
    complete_curve,
    complete_vary,
    names_in,
    option,
)
from stickslip.cli.output.files import FigureLook, announce, drawing
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.extensions.sweeps.execution.plan import Plan
    from stickslip.extensions.sweeps.sweep import SweepProgress

complete_design = choices("design", names_in("extensions.sweeps.design.design", "KINDS_OF_DESIGN"))
complete_quantity = choices("quantity", names_in("extensions.sweeps.design.quantities", "QUANTITIES"))


def complete_series(incomplete: str) -> list[str]:
    """Return the lists of curves that begin with what is typed: names of curves with commas between them."""
    before, comma, last = incomplete.rpartition(",")
    return [f"{before}{comma}{name}" for name in complete_curve(last) if name not in before.split(",")]


VARY_HELP = "KEY=LOW..HIGH:POINTS[:log] or KEY=VALUE,VALUE,...; once for each key."
Vary = Annotated[list[str] | None, option(VARY_HELP, "--vary", "-v", autocompletion=complete_vary)]
TABLE_HELP = "Members from a table instead (.csv): one column per key, one row per member."
Table = Annotated[Path | None, option(TABLE_HELP, "--list")]
DESIGN_HELP = "A grid, or samples between LOW and HIGH: random, or a Latin hypercube; or the members in FILE.csv, like --list."
DesignKind = Annotated[str, typer.Option(help=DESIGN_HELP, autocompletion=complete_design)]
Members = Annotated[int | None, option("How many samples.", "--members", "-m")]
Seed = Annotated[int, typer.Option(help="Seed of the random samples; the same seed gives the same members.")]
QUANTITY_HELP = "Quantity to keep of each run; may be repeated."
Quantities = Annotated[list[str] | None, option(QUANTITY_HELP, "--quantity", "-q", autocompletion=complete_quantity)]
SERIES_HELP = "Curves over time to keep too, with commas between them; also state, for a law with a state."
Series = Annotated[str, option(SERIES_HELP, autocompletion=complete_series)]
Samples = Annotated[int, typer.Option(help="Number of times in each curve.")]
Out = Annotated[Path | None, option("Save the results as they come (a folder, .zarr).", "--out", "-o")]
Threads = Annotated[int | None, option("Threads (default: all cores).")]
Chunk = Annotated[int | None, option("Number of members run and saved together (default: 1/64 of all).")]
Workers = Annotated[int | None, option("Start a dask cluster of so many processes here, instead of threads.")]
Scheduler = Annotated[str | None, option("Run on the dask cluster at HOST:PORT, or of a scheduler file.")]
Figure = Annotated[Path | None, option("Draw the first quantity (.png, .pdf or .svg).", "--figure", "-f")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Say how many members there are, and stop.")]


def sweep(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    duration: Duration = None,
    vary: Vary = None,
    table: Table = None,
    design: DesignKind = "grid",
    members: Members = None,
    seed: Seed = 0,
    quantity: Quantities = None,
    series: Series = "",
    samples: Samples = 200,
    out: Out = None,
    threads: Threads = None,
    chunk: Chunk = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    figure: Figure = None,
    look: FigureLook,
    dry_run: DryRun = False,
) -> None:
    r"""Run a scenario many times with two or three varied numbers, for maps of pulses, slips and regimes.

    Any number of a scenario can be varied, by its place in the file
    (friction.alpha, body.thickness, friction.slip.mean, run.rtol), with the
    units of scenarios. Runs that fail are counted, with their reasons.

    \b
      stickslip sweep fig6-slab --vary friction.alpha=0.05..2:40 \
        --vary "body.thickness=1km..50km:30:log" --out map.zarr
      stickslip sweep mine.toml -v alpha=0.1,1,10 -q recurrence -q heat
      stickslip sweep mine.toml -v alpha=0.1..10:log -v static=0.6..0.8 \
        --design lhs --members 1000 --out sample.zarr
      stickslip sweep mine.toml --design members.csv -q slip

    After a stop, the same command continues where the store ends.

    By default a sweep keeps events, pulses, slip, peak_rate, first_duration,
    recurrence and arrested, and of a chain all its quantities. A wrong
    name lists them.

    Exit code: 0 done, 1 every run failed or a cluster lost some, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load_with
    from stickslip.extensions.sweeps.design.axis import typed_axes
    from stickslip.extensions.sweeps.execution.chunk import NOT_RUN
    from stickslip.extensions.sweeps.execution.plan import make_plan
    from stickslip.extensions.sweeps.summary import show_plan, show_slowest, show_sweep

    _check_members(vary, table, design)
    _check_files(out, figure)
    look.check(figure)
    chosen = load_with("sweep", scenario, changes, any_kind=True, duration=duration)
    plan = make_plan(
        chosen,
        table or (typed_axes(chosen, vary, "--vary") if vary else None),
        design=design,
        members=members,
        seed=seed,
        quantities=quantity or None,
        series=[name.strip() for name in series.split(",") if name.strip()],
        samples=samples,
        chunk=chunk,
        where="--list" if table else "--vary",
    )
    if figure is not None:
        _check_can_be_drawn(plan)
    resources: dict[str, Any] = {"threads": threads, "workers": workers, "scheduler": scheduler}
    if dry_run:
        show_plan(plan)
        return
    with _losses():
        found, spent = _found(plan, out, resources)
    if out is not None:
        from stickslip.extensions.sweeps.results.layout import SWEEP_FORMAT

        with SWEEP_FORMAT.reading(out):  # its chunks may have been damaged since they were written
            found = found.load()
    if (found.status.values == NOT_RUN).all():
        announce(out)
        raise KeyboardInterrupt
    if figure is not None:
        _draw(found, plan.work.names[0], figure, look)
    code = show_sweep(chosen.title or chosen.name, found)
    if spent is not None:
        show_slowest(plan, spent)
    announce(out, figure)
    if (found.status.values == NOT_RUN).any():
        raise KeyboardInterrupt
    raise typer.Exit(code)


def _check_members(vary: list[str] | None, table: Path | None, design: str) -> None:
    """Raise InputError unless either axes, or one table of members, are given."""
    from stickslip.extensions.sweeps.design.design import is_from_outside

    given = {"--vary": vary, "--list": table, f"--design {design}": is_from_outside(design)}
    found = [option for option, one in given.items() if one]
    if len(found) != 1:
        got = " and ".join(found) or "neither; as in --vary friction.alpha=0.1..1:20"
        raise InputError(f"sweep: needs either --vary or --list, got {got}")


def _check_files(out: Path | None, figure: Path | None) -> None:
    """Raise InputError unless all files can be written."""
    from stickslip.cli.output.files import check_target
    from stickslip.extensions.sweeps.sweep import check_out

    if out is not None:
        check_out(out, "--out")
    check_target(figure, "--figure")


def _check_can_be_drawn(plan: Plan) -> None:
    """Refuse, before any member is run, a figure of a grid with too many keys or none. Raises InputError."""
    varied = sum(count > 1 for count in plan.design.shape)
    if not varied or varied > 3:
        number = f"{varied} keys vary" if varied else "no key varies"
        raise InputError(f"sweep: --figure draws one to three keys, but here {number}: leave out --figure, or vary fewer keys")


@contextmanager
def _losses() -> Iterator[None]:
    """Report in one line what a cluster has lost, and exit with code 1."""
    from stickslip.extensions.sweeps.execution.cluster import ChunksLostError

    try:
        yield
    except ChunksLostError as error:
        typer.echo(f"stickslip: {error}", err=True)
        raise typer.Exit(1) from None


def _found(plan: Plan, out: Path | None, resources: dict[str, Any]) -> tuple[xr.Dataset, SweepProgress | None]:
    """Return the results of a sweep and its last progress."""
    from stickslip.extensions.sweeps.sweep import carry_out, runner_of
    from stickslip.run import progress_line

    last: list[SweepProgress] = []
    with runner_of(**resources) as run, progress_line(f"{plan.scenario.name}:") as tell:

        def note(progress: SweepProgress) -> None:
            last[:] = [progress]
            tell(progress)

        found = carry_out(plan, out, run, note)
    return found, last[0] if last else None


def _draw(dataset: xr.Dataset, quantity: str, figure: Path, look: FigureLook) -> None:
    from stickslip.extensions.sweeps.figures.sweep import plot_sweep

    drawing(partial(plot_sweep, dataset, quantity), look)(figure)
