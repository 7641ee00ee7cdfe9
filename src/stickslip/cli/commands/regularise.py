"""`stickslip regularise`: find the selection rule to which regularised contacts converge."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import (
    Changes,
    Duration,
    FigureFile,
    Rtol,
    ScenarioName,
    complete_regularisation,
    option,
    table_of,
)
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario
    from stickslip.studies.regularise import Regularisation


def regularise(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    by: Annotated[str, typer.Option(help="Kind of regularisation.", autocompletion=complete_regularisation)] = "contact-mass",
    largest: Annotated[str | None, option("Largest size: s, or with a unit; default R/30.")] = None,
    smallest: Annotated[str | None, option("Smallest size; default R/491520.")] = None,
    count: Annotated[int, typer.Option(help="How many sizes, evenly spaced in their logarithm.")] = 8,
    out: Annotated[Path | None, table_of("size")] = None,
    figure: FigureFile = None,
    look: FigureLook,
    duration: Duration = None,
    rtol: Rtol = None,
) -> None:
    r"""Find which selection rule physics chooses: compare runs of ever less inertia or lag with the answer of every rule.

    If several slip rates solve the contact equation, a rule picks one. A
    little more physics makes the slip rate unique: a contact mass of Z size, or
    friction that lags behind the slip rate by the time `size`, with or without
    a direct effect (variation of mu * size / R). The size shrinks, and the runs
    are compared with the exact answer of each rule. The result is the rule to
    which the runs converge, if any, and the power of the size by which their
    error falls.

    \b
      stickslip regularise fig4-loop
      stickslip regularise fig4-loop --by lag --figure lag.png --out lag.csv
      stickslip regularise mine.toml --largest "0.1 s" --smallest "1 us"

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.output.studies import show_regularisation
    from stickslip.cli.overrides import load_with

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    chosen = load_with("regularise", scenario, changes, duration=duration, rtol=rtol)
    study = _study(chosen, by, _sizes(chosen, largest, smallest, count))
    show_regularisation(chosen, study)
    announce(*write_files((out, study.to_csv), (figure, drawing(study.plot, look))))


def _sizes(scenario: Scenario, largest: str | None, smallest: str | None, count: int) -> list[float]:
    """Return the sizes (s) that were typed, evenly spaced in their logarithm. Raises InputError."""
    from stickslip.cli.overrides import read
    from stickslip.scenarios.schema import read_duration
    from stickslip.studies.regularisations import check_massless
    from stickslip.studies.regularise import default_sizes

    usual = default_sizes(check_massless(scenario.problem).two_way_time)
    first = read(read_duration, largest, "regularise", "largest", usual[0])
    last = read(read_duration, smallest, "regularise", "smallest", usual[-1])
    if not last < first:
        raise InputError(f"regularise: --smallest must be less than --largest, got {last:g} s and {first:g} s")
    if not 3 <= count <= 100:
        raise InputError(f"regularise: --count must lie between 3 and 100, got {count}")
    return [first * (last / first) ** (k / (count - 1)) for k in range(count)]


def _study(scenario: Scenario, by: str, sizes: list[float]) -> Regularisation:
    from stickslip.run.progress import progress_line
    from stickslip.studies.regularise import regularise as study

    with progress_line(f"{scenario.name}:") as report:
        return study(scenario.problem, scenario.duration, by, sizes, rtol=scenario.rtol, progress=report)
