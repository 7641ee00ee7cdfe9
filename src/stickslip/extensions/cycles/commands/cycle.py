"""`stickslip cycle`: find the periodic motion of a body, and follow it along a number of its scenario."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import Changes, FigureFile, ScenarioName, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.cli.output.show import print_numbers, print_sentences, say, titled
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from stickslip.extensions.cycles.branch import BranchOfCycles

NEAR = "Duration of the run at whose end the cycle is looked for: s, or with a unit. Default: long enough for some cycles."
ALONG = "Follow the cycle along this number of the scenario, such as pull_rate or body.stiffness; with --to."
TO = "Value at the other end of --along, a number in SI or with a unit."
DOUBLED_TOO = "Follow cycles of twice the period, too, where the period doubles."
GO_ON = "Go on with the branch in --out, which Ctrl-C has ended, or to a farther --to."
ROWS_SHOWN = 24
"""Largest number of cycles of a branch that are printed; edges are printed beside them."""


def cycle(
    scenario: ScenarioName,
    *,
    changes: Changes = None,
    near: Annotated[str | None, option(NEAR)] = None,
    along: Annotated[str | None, option(ALONG)] = None,
    to: Annotated[str | None, option(TO)] = None,
    steps: Annotated[int, typer.Option(help="About how many steps cross the range of --along.")] = 40,
    double: Annotated[bool, typer.Option("--double", help=DOUBLED_TOO)] = False,
    out: Annotated[Path | None, table_of("cycle")] = None,
    resume: Annotated[bool, typer.Option("--resume", help=GO_ON)] = False,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Find the periodic motion of a body, with its period and multipliers.

    One period multiplies small disturbances by the multipliers: the cycle is
    stable if all are smaller than 1. A contact that rests forgets, and has 0.
    The cycle is looked for near the end of a run of the scenario, of a rigid
    body, or of a slab or string, of layers or behind a machine too. With
    --along and --to it is followed as one number changes, around folds: edges
    where stick is lost, the period doubles, or the cycle ends in steady
    sliding are found and named. The figure shows one period, or amplitude and period of
    the branch, dashed where it is unstable. A position loop at a set point
    (pull rate 0) hunts: its edges are folds, the end of hunting, and stops
    that are grazed. Ctrl-C keeps what there is of a branch in --out, and
    --resume goes on.

    \b
      stickslip cycle block --figure cycle.png
      stickslip cycle mine.toml --along pull_rate --to "0.5 m/s" --out a.csv
      stickslip cycle mine.toml --set body.damping=2 --near "20 s"

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.overrides import load
    from stickslip.extensions.cycles.find_cycle import cycle as search
    from stickslip.extensions.cycles.follow import follow
    from stickslip.problem.scenarios import typed_number
    from stickslip.run import progress_line

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    if (along is None) != (to is None):
        raise InputError(f"cycle: {'--to needs --along' if along is None else '--along needs --to'}: give both, or neither")
    _check_branch(along, out, double=double, resume=resume)
    chosen = load(scenario, "cycle", changes)
    with progress_line(f"{chosen.name}:") as report:
        found = search(chosen, None if near is None else typed_number(near), progress=report)
        branch = None
        if along is not None and to is not None:
            earlier = out if resume else None
            branch = follow(found, along, to=typed_number(to), steps=steps, double=double, resume=earlier, progress=report)
    screen = titled(chosen)
    print_sentences(screen, found.text, found.stability_text, found.certainty_text)
    if branch is not None:
        _show_branch(screen, branch)
    drawn = found if branch is None else branch
    announce(*write_files((out, drawn.to_csv), (figure, drawing(drawn.plot, look))))
    if branch is not None and branch.interrupted:
        raise KeyboardInterrupt


def _check_branch(along: str | None, out: Path | None, *, double: bool, resume: bool) -> None:
    """Refuse options of a branch without one. Raises InputError."""
    if along is None and (double or resume):
        raise InputError(f"cycle: {'--double' if double else '--resume'} is for branches: give --along and --to, too")
    if resume and (out is None or not out.is_file()):
        raise InputError("cycle: --resume goes on with the branch in the table --out: give one that is there")


def _show_branch(screen: Console, branch: BranchOfCycles) -> None:
    """Print the cycles of a branch, some of them if there are many, and its edges."""
    from stickslip.foundation.show import number

    every = -(-len(branch.points) // ROWS_SHOWN)
    words = {True: "yes", False: "no", None: "-"}
    shown = [one for n, one in enumerate(branch.points) if n % every == 0 or one.edge or n == len(branch.points) - 1]
    followed, values = _in_one_unit([one.value for one in shown], branch.parameter.unit)
    second, periods = _in_one_unit([one.measures.period for one in shown], "s")
    rate, amplitudes = _in_one_unit([one.measures.amplitude for one in shown], branch.problem.unit_of("slip_rate"))
    rows = [
        [
            *numbers,
            f"{100.0 * one.measures.stick_share:.4g} %",
            "-" if one.multipliers[0] != one.multipliers[0] else number(abs(one.multipliers[0]), 4),
            words[one.stable],
            one.edge,
        ]
        for *numbers, one in zip(values, periods, amplitudes, shown, strict=True)
    ]
    say(screen, "")
    measured = f"{branch.parameter.name.rpartition('.')[2]}{followed}", f"period{second}", f"amplitude{rate}"
    print_numbers(screen, (*measured, "rest", "largest\nmultiplier", "stable", "edge"), rows)
    say(screen, "")
    more = [text for text in (branch.hysteresis_text, branch.interrupted_text) if text]
    print_sentences(screen, branch.text, *branch.edge_texts, *more)


def _in_one_unit(values: list[float], unit: str) -> tuple[str, list[str]]:
    """Return the second line of the heading of a column, with one unit for all of it, and its numbers in that."""
    from stickslip.foundation.names import readable_unit
    from stickslip.foundation.show import BRIEF_DIGITS, number

    name, size = readable_unit(unit, values, log=True)
    return "" if name == "1" else f"\n({name.replace('µ', 'u')})", [number(value / size, BRIEF_DIGITS) for value in values]
