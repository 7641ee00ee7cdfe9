"""`stickslip compare`: compare runs side by side."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import Duration, FigureFile, Rtol, complete_source, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.studies.compare import Comparison

RUNS = "Two or more: TOML files, bundled names, files of `run --out` (.nc), - for standard input. With --rules one."
RULES = "Run the one scenario under each selection rule: wait until the next event, slip and jumps."


def compare(
    runs: Annotated[list[str], typer.Argument(help=RUNS, autocompletion=complete_source)],
    *,
    rules: Annotated[bool, typer.Option("--rules", help=RULES)] = False,
    out: Annotated[Path | None, table_of("run")] = None,
    figure: FigureFile = None,
    look: FigureLook,
    event: Annotated[int | None, option("Draw this slip event of each, in local time: 0 the first, -1 the last.")] = None,
    duration: Duration = None,
    rtol: Rtol = None,
) -> None:
    r"""Compare runs: one table, and one figure of slip, slip rate and traction against time.

    The table gives for each run its selection rule and regime, the slip at its
    end and its largest displacement, the number of slip events, the largest one with its stress drops, the duration of the
    first one, and the number of jumps of the slip rate. Slabs can be compared
    with blocks: drops are then in Pa and N, and the figure shows friction over
    the normal load. Runs of very different lengths are drawn
    over the share of their own time; late events are best seen with --event.
    With --rules one scenario is run under each selection rule, and the table
    says how long the contact then waits until its next event.

    \b
      stickslip compare fig6-block-reconstructed fig6-slab --figure fig6.png
      stickslip compare second-event-maxwell second-event-maximal --event 1
      stickslip compare second-event-maxwell --rules --figure rules.png
      stickslip compare mine.toml yesterday.nc --out table.csv

    Exit code: 0 done, 1 a run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.extensions.studies.summary import show_comparison

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    found = _compared(runs, duration, rtol, event, rules=rules)
    show_comparison(found)
    announce(*write_files((out, found.to_csv), (figure, drawing(found.plot, look))))
    if not all(solution.status.ok for solution in found.runs.values()):
        raise typer.Exit(1)


def _compared(names: list[str], duration: str | None, rtol: float | None, event: int | None, *, rules: bool) -> Comparison:
    """Read all sources before any of them is run, then run them. Raises InputError."""
    from stickslip.cli.overrides import STDIN, load, typed_option
    from stickslip.extensions.studies.compare import Comparison, distinct, title_of, under_each_rule
    from stickslip.run import progress_line, run_source

    if len(names) < 2 and not rules:
        cure = "--rules runs one under each selection rule; `stickslip new --list` lists the bundled ones"
        raise InputError(f"compare: needs two runs or more, got {len(names)}; {cure}")
    length = typed_option("duration", duration, "compare")
    tolerance = typed_option("rtol", rtol, "compare")
    given = [load(name, "compare") if name == STDIN else name for name in names]
    chosen = under_each_rule(given) if rules else []
    sources = [run_source(one, length, tolerance) for one in chosen or given]
    runs = {}
    for name, source in zip(distinct([source.name for source in sources]), sources, strict=True):
        with progress_line(f"{name}:") as report:
            runs[name] = source.solution(report)
    return Comparison(runs, event, title_of(chosen) if chosen else "")
