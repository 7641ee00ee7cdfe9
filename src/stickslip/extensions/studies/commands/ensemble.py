"""`stickslip ensemble`: find how far single events of a run can be trusted."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import SIZE_HELP, Changes, Dpi, Duration, FigureFile, Rtol, ScenarioName, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files

if TYPE_CHECKING:
    from stickslip.extensions.studies.ensemble import Ensemble
    from stickslip.problem.scenarios import Scenario

DISTURBANCE = "Largest disturbance of the initial load, as a share of the strength."
SEED = "Seed of the random disturbances; the same seed gives the same members."


def ensemble(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    members: Annotated[int, typer.Option("--members", "-m", help="How many disturbed runs.")] = 8,
    size: Annotated[float, typer.Option(help=DISTURBANCE)] = 1e-12,
    duration: Duration = None,
    events: Annotated[int | None, option("Stop each run after this number of slip events.")] = None,
    seed: Annotated[int, typer.Option(help=SEED)] = 0,
    rtol: Rtol = None,
    checkpoint: Annotated[Path | None, option("Keep the runs in this folder; the same command goes on with them.")] = None,
    out: Annotated[Path | None, table_of("event")] = None,
    figure: FigureFile = None,
    dpi: Dpi = None,
    figure_size: Annotated[str | None, option(SIZE_HELP, "--figure-size")] = None,
) -> None:
    r"""Find how far single events can be trusted: repeat a run with tiny disturbances of the initial load.

    A slab whose friction falls with slip rate amplifies its own echoes, so that
    two runs which differ by rounding diverge. Each member begins with a load
    that is larger or smaller by `size`/2 to `size` of the static strength. The
    command shows the first event at which members differ, and the measured and
    the predicted growth rate of the disturbance.

    \b
      stickslip ensemble fig6-slab --duration "30000 years" --events 65 -f a.png
      stickslip ensemble cycles-block --size 1e-6 --out events.csv
      stickslip ensemble mine.toml --members 20 --size 1e-6 --seed 1

    After Ctrl-C the command shows and saves the result of the finished members.
    With --checkpoint a command that was killed is typed again, and goes on.

    Exit code: 0 done, 1 a run failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load_with
    from stickslip.extensions.studies.summary import show_ensemble

    look = FigureLook(dpi, figure_size)
    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    chosen = load_with("ensemble", scenario, changes, duration=duration, max_events=events, rtol=rtol)
    study = _study(chosen, members, size, seed, checkpoint)
    show_ensemble(chosen, study)
    announce(*write_files((out, study.to_csv), (figure, drawing(study.plot, look))))
    if len(study.runs) < study.wanted:
        raise KeyboardInterrupt
    raise typer.Exit(0 if study.ok else 1)


def _study(scenario: Scenario, members: int, size: float, seed: int, checkpoint: Path | None) -> Ensemble:
    from stickslip.extensions.studies.ensemble import ensemble as study
    from stickslip.run import progress_line

    with progress_line(f"{scenario.name}:") as report:
        run = scenario.problem, scenario.duration, members, size, scenario.rtol
        return study(*run, max_events=scenario.max_events, seed=seed, progress=report, checkpoint=checkpoint)
