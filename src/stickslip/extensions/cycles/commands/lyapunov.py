"""`stickslip lyapunov`: find at what rate small disturbances of a motion grow, and for how long events are predictable."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from stickslip.cli.options import Changes, FigureFile, ScenarioName, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.cli.output.show import print_sentences, titled

DURATION_OF_RUN = "Duration of the run, in s or with a unit. Default: that of the scenario."
LEFT_OUT = "Time at its start that does not count, in s or with a unit. Default: a fifth of the duration."


def lyapunov(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    duration: Annotated[str | None, option(DURATION_OF_RUN)] = None,
    skip: Annotated[str | None, option(LEFT_OUT)] = None,
    out: Annotated[Path | None, table_of("interval of the run, with the growth")] = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Find how fast small disturbances grow, and how long events are predictable.

    The largest Lyapunov exponent, with its standard error: above 0 the motion
    is chaotic, and single events mean nothing beyond a horizon. Rigid bodies
    under a steady pull or in a position loop, and slabs and strings without
    masses under a law of slip rate, have an equation of disturbances; of
    chains disturbed runs are compared. Of all others (strings with a bit,
    layers, machines, loadings that vary) two runs that differ a little are
    compared after each round trip. The figure shows how a disturbance grows
    along the run.

    \b
      stickslip lyapunov mine.toml --duration "20 h"
      stickslip lyapunov drill-string --duration "30 min"
      stickslip lyapunov mine.toml --skip "1 h" --figure growth.png

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load
    from stickslip.extensions.cycles.lyapunov import lyapunov as search
    from stickslip.problem.scenarios import typed_number
    from stickslip.run import progress_line

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    chosen = load(scenario, "lyapunov", changes, any_kind=True)
    with progress_line(f"{chosen.name}:") as report:
        lasts, left_out = (None if one is None else typed_number(one) for one in (duration, skip))
        found = search(chosen, lasts, skip=left_out, progress=report)
    print_sentences(titled(chosen), *found.texts)
    announce(*write_files((out, found.to_csv), (figure, drawing(found.plot, look))))
