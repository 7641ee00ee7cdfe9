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
CONVERGED = " (converged, with an error band)"
"""What `list` adds to a problem whose series is not exact."""
WHAT = "Names of problems, or all (get); a file, or several of different steps (judge)."


def benchmark(
    action: Annotated[str, typer.Argument(help="list, get or judge.")] = "list",
    what: Annotated[list[str] | None, typer.Argument(help=WHAT, show_default=False)] = None,
    *,
    name: Annotated[str | None, option("Judge: the problem; by default it has the name of the file.")] = None,
    folder: Annotated[Path | None, option("Get: where the files go (by default here).")] = None,
    out: Annotated[Path | None, option("Judge: save the table (.csv, and the shocks in NAME-shocks.csv).", "--out", "-o")] = None,
    tolerance: Annotated[float, option("Judge: the largest share by which a series that passes may be off.")] = 0.05,
    column: Columns = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Give problems with exact series to other programs, and judge the series that they write.

    `list` says what each problem asks of a program. `get` writes a problem as
    TOML, its exact series as netCDF, and checksums of both; `get all` writes
    every problem, and all.sha256. `judge` reads time, slip since the start,
    slip rate and traction from a CSV file or one in the layout of the SCEC
    benchmarks, and says whether the series passes: whether slip, slip rate and
    traction, at rest too, are within --tolerance, and shocks and selection rule
    are the exact ones. It recognises opposite signs, other zeros and halves,
    and names ringing, values that are a step early or late, and echoes of the
    wrong sign or size. Of several series it tells how errors fall with the step.

    \b
      stickslip benchmark list
      stickslip benchmark get loop
      stickslip benchmark judge mine.csv --name loop --figure mine.png
      stickslip benchmark judge coarse.csv fine.csv --name loop

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
        if what:
            raise InputError(
                f"benchmark: list takes no name, got {ascii(what[0])[:60]}: `get` writes a problem, `judge` reads a file"
            )
        _list()
        return
    if not what:
        raise InputError(f"benchmark: {action} needs {'the name of a problem: see `list`' if action == 'get' else 'a file'}")
    if action == "get":
        _get(what, folder or Path())
        return
    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    if not _judge([Path(one) for one in what], name, tolerance, column, (out, figure, look)):
        raise typer.Exit(1)


def _list() -> None:
    from stickslip.cli.output.show import console, print_numbers, print_sentences
    from stickslip.extensions.schemes.benchmark_kinds import ConvergedBenchmark
    from stickslip.extensions.schemes.benchmarks import BENCHMARKS

    screen = console()
    rows = [[name, one.asks + CONVERGED * isinstance(one, ConvergedBenchmark)] for name, one in BENCHMARKS.items()]
    print_numbers(screen, ("name", "asks for"), rows, text=2)
    print_sentences(screen, f"{len(rows)} problems")


def _get(names: list[str], folder: Path) -> None:
    """Write problems, or all of them."""
    from stickslip.cli.output.show import console, say
    from stickslip.extensions.schemes.benchmarks import ALL, BENCHMARKS, benchmark_of, write_all, write_benchmark

    if names == [ALL]:
        announce(write_all(folder))
        say(console(), f"{len(BENCHMARKS)} problems in {folder}: sha256sum --check {ALL}.sha256")
        return
    for name in names:
        benchmark_of(name)
    for name in names:
        announce(*write_benchmark(name, folder))


def _judge(
    files: list[Path],
    name: str | None,
    tolerance: float,
    column: list[str] | None,
    results: tuple[Path | None, Path | None, FigureLook],
) -> bool:
    """Judge series, show and write what comes out, and return True if they pass."""
    from stickslip.cli.overrides import typed_columns
    from stickslip.extensions.schemes.benchmarks import benchmark_of, judge_benchmark
    from stickslip.extensions.schemes.summary import show_judged, tables_of
    from stickslip.run import progress_line

    asked = benchmark_of(files[0].stem if name is None else name)
    columns = typed_columns(column, "benchmark: --column")
    with progress_line("benchmark") as tell:
        study = judge_benchmark(files, asked.name, tolerance=tolerance, columns=columns, progress=tell)
    show_judged(asked.scenario, study)
    out, figure, look = results
    announce(*write_files(*tables_of(study, out), (figure, drawing(study.plot, look))))
    return study.passed
