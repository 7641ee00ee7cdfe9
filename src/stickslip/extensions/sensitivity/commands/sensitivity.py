"""`stickslip sensitivity`: say how much an output of a run changes with each number of its scenario."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from stickslip.cli.options import Changes, Duration, FigureFile, Rtol, ScenarioName, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.cli.output.show import print_numbers, print_sentences, say, titled
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.extensions.sensitivity.result import Sensitivity

OF = "The output: slip, slip_rate, traction, load, state, work, heat ..., or of a slip event start, end, duration, recurrence ..."
BY = "Numbers of the scenario with commas between them, such as friction.a,stiffness. Default: all that are not 0."
AT = "Times of a curve or an energy, with commas between them: s, or with a unit. Default: the whole run."
EVENT = "Row of the slip event, from 0; -1 is the last. Default: the first that has the number."
MOST_TIMES = 8
"""With more times than this no table is printed."""


def sensitivity(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    of: Annotated[str, option(OF)] = "slip",
    to: Annotated[str | None, option(BY)] = None,
    at: Annotated[str | None, option(AT)] = None,
    event: Annotated[int | None, option(EVENT)] = None,
    duration: Duration = None,
    rtol: Rtol = None,
    out: Annotated[Path | None, table_of("number and time")] = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Say how much an output of a run changes with each number of its scenario.

    Six runs with values beside each number give the derivative of the output,
    with an estimate of its error. There is none where an event grazes, appears
    or vanishes: the command says which. The figure shows scaled derivatives,
    number times derivative, over time, or as bars for a number of an event.

    \b
      stickslip sensitivity rate-and-state-block --to a,b,stiffness
      stickslip sensitivity mine.toml --of heat --at "1 s,2 s" --out a.csv
      stickslip sensitivity mine.toml --of recurrence --event -1 -f bars.png

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load_with
    from stickslip.extensions.sensitivity.study import FINE_RTOL
    from stickslip.extensions.sensitivity.study import sensitivity as study
    from stickslip.run import progress_line

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    chosen = load_with("sensitivity", scenario, changes, duration=duration)
    with progress_line(f"{chosen.name}:") as report:
        times = None if at is None else _times(at)
        found = study(chosen, _parts(to), of, at=times, event=event, rtol=rtol or FINE_RTOL, progress=report)
    screen = titled(chosen)
    print_sentences(screen, *found.texts)
    if 1 < len(found.times) <= MOST_TIMES:
        _show_table(screen, found)
    print_sentences(screen, *found.notes)
    announce(*write_files((out, found.to_csv), (figure, drawing(found.plot, look))))


def _parts(text: str | None) -> list[str] | None:
    return None if text is None else [one.strip() for one in text.split(",") if one.strip()]


def _times(text: str) -> list[float]:
    """Return the times (s) in a text. Raises InputError."""
    from stickslip.extensions.sensitivity.study import TIME_ASKED
    from stickslip.problem.scenarios import typed_number

    found = [TIME_ASKED.check("sensitivity", "at", typed_number(one)) for one in _parts(text) or []]
    if not found:
        raise InputError("sensitivity: --at: give a time, or several with commas between them")
    return found


def _show_table(screen: Console, found: Sensitivity) -> None:
    """Print the derivatives at a few times: a row for each, and a column for each number."""
    from stickslip.foundation.show import brief, number

    rows = [
        [brief(time, "s"), number(value, 9), *(number(one, 6) if one == one else "-" for one in slopes)]
        for time, value, slopes in zip(found.times.tolist(), found.values.tolist(), found.derivatives.T.tolist(), strict=True)
    ]
    say(screen, "", "derivatives in SI")
    print_numbers(screen, ("time", found.output.name, *(f"by\n{name.rpartition('.')[2]}" for name in found.numbers)), rows)
    say(screen, "")
