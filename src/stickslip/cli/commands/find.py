"""`stickslip find`: find where stick-slip, a slip event or a number of pulses changes along one parameter."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stickslip.cli.options import Changes, FigureFile, ScenarioName, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.cli.output.show import print_sentences, titled
from stickslip.foundation.errors import InputError

DURATION = "Duration of the runs: s, or with a unit. Default: that of the scenario; for sticking doubled until the edge holds."
ALONG = "NAME=LOW..HIGH: what to vary, and between which values. Default: pull_rate, upwards from where steady sliding is stable."


def find(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    along: Annotated[str, option(ALONG)] = "pull_rate",
    what: Annotated[str, option("What changes: sticking, events or pulses.")] = "sticking",
    duration: Annotated[str | None, option(DURATION)] = None,
    within: Annotated[float, typer.Option(help="Width of the last bracket, as a share of its upper end.")] = 1e-3,
    out: Annotated[Path | None, table_of("run")] = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Find an edge along one number of a scenario, by bisection on exact runs.

    At which pull rate does stick-slip vanish? From which stiffness on is there
    no event, or one pulse less? The answer is the last bracket, with what the
    runs at its two ends did. "sticking" asks whether the contact rests in the
    last third of a run; runs twice as long are asked at the two ends, whether
    they give the same. A contact that starts
    from rest may stick although steady sliding is stable: `stickslip check`
    says from which rate on steady sliding is stable, and finds this edge to 2 %.
    Runs that would begin in steady sliding start without load instead, as only
    rounding would disturb it. --figure shows what each run gave.

    \b
      stickslip find mine.toml --duration "60 s" --figure edge.png
      stickslip find mine.toml --along body.stiffness=1e6..1e8 --what events

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load_with
    from stickslip.foundation.axis import TypedRange
    from stickslip.problem.scenarios import typed_number
    from stickslip.run import progress_line
    from stickslip.run.find import find as study

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    name, given, ends = along.partition("=")
    typed = TypedRange.of(ends, "find: --along")
    if given and (typed is None or typed.points is not None or typed.log):
        raise InputError(f'find: --along must be NAME or NAME=LOW..HIGH, as "pull_rate=1 mm/s..1 m/s", got {ascii(along)[:60]}')
    chosen = load_with("find", scenario, changes, duration=duration)
    values = (typed_number(typed.low), typed_number(typed.high)) if typed else (None, None)
    with progress_line(f"{chosen.name}:") as report:
        lasts = None if duration is None else chosen.duration
        found = study(chosen, name.strip(), *values, what=what, within=within, duration=lasts, progress=report)
    print_sentences(titled(chosen), found.text)
    announce(*write_files((out, found.to_csv), (figure, drawing(found.plot, look))))
