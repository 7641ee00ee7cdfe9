"""`stickslip schemes`: compare numerical schemes, or the series of another program, with the exact solution of every rule."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from stickslip.cli.options import Changes, Columns, Duration, FigureFile, Rtol, ScenarioName, option
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.schemes.schemes import Schemes
    from stickslip.problem.scenarios import Scenario

CHOSEN = "Schemes, separated by commas: all for the numerical ones (if not given), contact-mass, lag, or other names."
SEARCH = "How the contact looks for a slip rate: stick-first, continue, newton or fastest; stick-first if not given."


def schemes(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    scheme: Annotated[str | None, option(CHOSEN)] = None,
    nx: Annotated[str | None, option("Cells in the thickness, separated by commas; 25,50,100,200 if not given.")] = None,
    search: Annotated[str | None, option(SEARCH)] = None,
    courant: Annotated[float | None, option("Courant number, in place of each scheme's own.")] = None,
    series: Annotated[list[Path] | None, option("Judge the series in a file instead; may be repeated.", "--series")] = None,
    column: Columns = None,
    out: Annotated[Path | None, option("Save the table (.csv, and the shocks in NAME-shocks.csv).", "--out", "-o")] = None,
    figure: FigureFile = None,
    look: FigureLook,
    duration: Duration = None,
    rtol: Rtol = None,
) -> None:
    r"""Measure numerical schemes against the exact solution: errors, orders, pulses, and the selection rule that each follows.

    The slab is cut into cells and moved by schemes of differences and finite
    elements, on several meshes. Where several slip rates solve the contact
    equation, a scheme takes one of them; the comparison with the exact solution
    of every selection rule shows which rule it follows, if any. contact-mass and
    lag are no numerical schemes: they show which rule physics chooses, by exact
    runs with an inertia, or a lag of friction, as small as the step of the mesh.
    With --series the slip, slip rate and traction that another program has
    written get the same report.

    \b
      stickslip schemes fig4-loop
      stickslip schemes fig5-slab-u0-1e-2 --scheme newmark,hht --nx 50,100,200
      stickslip schemes fig4-loop --scheme contact-mass,lag --nx 50,200,800
      stickslip schemes fig6-slab --series mine.csv --figure mine.png

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load_with
    from stickslip.extensions.schemes.summary import show_schemes, tables_of

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))  # the file of shocks goes beside it
    look.check(figure)
    chosen = load_with("schemes", scenario, changes, duration=duration, rtol=rtol)
    if series:
        needless = {"--scheme": scheme, "--nx": nx, "--search": search, "--courant": courant}
        if given := [name for name, value in needless.items() if value is not None]:
            raise InputError(f"schemes: {given[0]} is for schemes of stickslip: leave it out with --series, which judges a file")
        study = _judged(chosen, series, column)
    elif column:
        raise InputError("schemes: --column says what the columns of a file of --series are")
    else:
        study = _study(chosen, scheme or "all", _cells("25,50,100,200" if nx is None else nx), search or "stick-first", courant)
    show_schemes(chosen, study)
    announce(*write_files(*tables_of(study, out), (figure, drawing(study.plot, look))))
    if study.interrupted:
        raise KeyboardInterrupt


def _cells(text: str) -> list[int]:
    """Return the numbers of cells that were typed. Raises InputError."""
    parts = [part.strip() for part in text.split(",") if part.strip()]
    if not parts or not all(part.isdecimal() for part in parts):
        raise InputError(f"schemes: --nx must be whole numbers separated by commas, such as 20,50,100, got {ascii(text)[:60]}")
    return [int(part) for part in parts]


def _study(scenario: Scenario, scheme: str, cells: list[int], search: str, courant: float | None) -> Schemes:
    from stickslip.extensions.schemes.run import SCHEMES
    from stickslip.extensions.schemes.schemes import schemes as study
    from stickslip.run import progress_line

    typed = [name.strip() for name in scheme.split(",") if name.strip()]
    names = [one for name in typed for one in (SCHEMES if name == "all" else [name])]
    how = {"search": search, "rtol": scenario.rtol}
    with progress_line("schemes") as tell:
        return study(scenario, None, names, cells, courant=courant, progress=tell, **how)  # type: ignore[arg-type]


def _judged(scenario: Scenario, paths: list[Path], column: list[str] | None) -> Schemes:
    from stickslip.cli.overrides import typed_columns
    from stickslip.extensions.schemes.judgement import TOLERANCE
    from stickslip.extensions.schemes.judging import judged
    from stickslip.extensions.schemes.series import read_series
    from stickslip.run import progress_line

    columns = typed_columns(column, "schemes: --column")
    unit = scenario.problem.body.load_unit
    several = [read_series(path, columns=columns, load_unit=unit) for path in paths]
    with progress_line("schemes") as tell:
        return judged(scenario, several, (TOLERANCE, scenario.rtol), tell)
