"""`stickslip benchmark`: problems with exact series for other programs, and a report on a series of theirs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stickslip.cli.options import Columns, FigureFile, option
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError, nearest

ACTIONS = ("list", "get", "judge")
"""What the command can do."""


def benchmark(
    action: Annotated[str, typer.Argument(help="list, get or judge.")] = "list",
    what: Annotated[str | None, typer.Argument(help="The name of a problem (get), or a file (judge).", show_default=False)] = None,
    *,
    name: Annotated[str | None, option("Judge: the problem; by default it has the name of the file.")] = None,
    folder: Annotated[Path | None, option("Get: where the files go (by default here).")] = None,
    out: Annotated[Path | None, option("Judge: save the table (.csv, and the shocks in NAME-shocks.csv).", "--out", "-o")] = None,
    tolerance: Annotated[float, option("Judge: the largest share by which a series that passes may be off.")] = 0.05,
    column: Columns = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Give twelve problems with exact series to other programs, and judge the series that they write.

    `get` writes the problem as TOML, its exact series as netCDF, and checksums
    of both. `judge` reads time, slip since the start, slip rate and traction
    from a CSV file or one in the layout of the SCEC benchmarks, and says
    whether the series passes: whether slip, slip rate and traction, at rest
    too, are within --tolerance, and shocks and selection rule are the exact
    ones. Opposite signs, other zeros and halves are recognised.

    \b
      stickslip benchmark list
      stickslip benchmark get loop
      stickslip benchmark judge mine.csv --name loop --figure mine.png

    Exit code: 0 done, 1 the series does not pass, 2 unusable input,
    130 interrupted.
    """
    if action not in ACTIONS:
        raise InputError(f"benchmark: there is nothing called {ascii(action)[:60]}; {nearest(action, ACTIONS)}")
    of_judge = {"--name": name, "--out": out, "--column": column, "--figure": figure}
    of_others = (of_judge if action != "judge" else {}) | ({"--folder": folder} if action != "get" else {})
    wrong = next((typed for typed, value in of_others.items() if value is not None), None)
    if wrong is not None:
        cure = "get writes files to --folder" if action == "get" else "leave it out"
        raise InputError(f"benchmark: {wrong} does not belong to {action}: {cure}")
    if action == "list":
        _list()
        return
    if what is None:
        raise InputError(f"benchmark: {action} needs {'the name of a problem: see `list`' if action == 'get' else 'a file'}")
    if action == "get":
        from stickslip.extensions.schemes.benchmarks import write_benchmark

        announce(*write_benchmark(what, folder or Path()))
        return
    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    if not _judge(Path(what), name, tolerance, column, (out, figure, look)):
        raise typer.Exit(1)


def _list() -> None:
    from stickslip.cli.output.show import console, print_numbers
    from stickslip.extensions.schemes.benchmarks import BENCHMARKS

    print_numbers(console(), ("name", "asks for"), [[name, one.asks] for name, one in BENCHMARKS.items()], text=2)


def _judge(
    file: Path,
    name: str | None,
    tolerance: float,
    column: list[str] | None,
    results: tuple[Path | None, Path | None, FigureLook],
) -> bool:
    """Judge a series, show and write what comes out, and return True if it passes."""
    from stickslip.cli.overrides import typed_columns
    from stickslip.extensions.schemes.benchmarks import benchmark_of, judge_benchmark
    from stickslip.extensions.schemes.summary import show_judged, tables_of
    from stickslip.run import progress_line

    asked = benchmark_of(file.stem if name is None else name)
    columns = typed_columns(column, "benchmark: --column")
    with progress_line("benchmark") as tell:
        study = judge_benchmark(file, asked.name, tolerance=tolerance, columns=columns, progress=tell)
    show_judged(asked.scenario, study)
    out, figure, look = results
    announce(*write_files(*tables_of(study, out), (figure, drawing(study.plot, look))))
    return study.passed
