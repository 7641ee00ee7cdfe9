"""`stickslip slide`: find how far slopes and isolated blocks slide under earthquake records."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import (
    FIGURES,
    Changes,
    FigureFile,
    choices,
    complete_scenario,
    names_in,
    option,
    picture,
    table_of,
)
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.extensions.strong_motion.displacements import SlidingDisplacements

complete_analysis = choices("analysis", names_in("extensions.strong_motion.asked", "ANALYSES"))
complete_unit = choices("unit", names_in("extensions.strong_motion.asked", "LENGTHS"))

RECORDS = "Files of strong motion, or folders of them; their layout is found by their content."
MOST_YIELDS = 10_000
"""Largest number of points of a range of yield coefficients."""
YIELDS = "Yield coefficients, yield accelerations as parts of g: LOW..HIGH:POINTS[:log] or VALUE,VALUE,...; or with a unit."
POLARITY = (
    "1 takes records as they come (slides while -a exceeds the yield), -1 the opposite, as most programs of this field; or both."
)
BACKWARD = "Yield coefficients of backward slip, or same as forward; by default the block never slides backward."
TO_PGA = "Scale each record to a peak acceleration (a part of g); several with commas between them."
BODY = "The scenario that lends the column of coupled and decoupled analyses: its body."


def slide(
    records: Annotated[list[Path], typer.Argument(help=RECORDS)],
    *,
    yields: Annotated[str, typer.Option("--yield", "-y", help=YIELDS)],
    polarity: Annotated[str, typer.Option(help=POLARITY)] = "both",
    both_signs: Annotated[bool, typer.Option("--both-signs", help="Both polarities, which is also the default.")] = False,
    scale: Annotated[str | None, option("Factors on the records, with commas between them.")] = None,
    scale_to_pga: Annotated[str | None, option(TO_PGA)] = None,
    backward: Annotated[str | None, option(BACKWARD)] = None,
    analysis: Annotated[
        str, typer.Option(help="A rigid block, or a column that deforms.", autocompletion=complete_analysis)
    ] = "rigid",
    body: Annotated[str | None, option(BODY, autocompletion=complete_scenario)] = None,
    changes: Changes = None,
    component: Annotated[str | None, option("Which component of files that have several.")] = None,
    baseline: Annotated[str | None, option("mean takes the mean off each record; by default nothing is taken off.")] = None,
    unit: Annotated[str, typer.Option(help="Unit of displacements.", autocompletion=complete_unit)] = "m",
    out: Annotated[Path | None, table_of("record, polarity, scale and yield")] = None,
    figure: FigureFile = None,
    record_figure: Annotated[
        Path | None, picture("acceleration, velocity and displacement of one record", "--record-figure")
    ] = None,
    record: Annotated[str | None, option("Which record that is, by a part of its name.", panel=FIGURES)] = None,
    look: FigureLook,
) -> None:
    r"""Find how far slopes and isolated blocks slide under earthquake records: every record at every yield coefficient.

    A block on shaken ground slides while the ground accelerates by more than its
    yield acceleration (Newmark 1965). Between the samples of a record the
    acceleration is a straight line, under which the answer of a rigid block is
    exact. The table has a row for each record, polarity, scale and yield, in the
    words of the field: PGA, PGV, Arias intensity, significant duration, mean
    period, and displacement.

    \b
      stickslip slide records/*.AT2 --yield 0.1
      stickslip slide records --yield 0.05..0.3:6 --scale-to-pga 0.4 \
        --unit cm --out table.csv --figure d.png
      stickslip slide one.AT2 -y 0.05,0.1 --record-figure motion.png
      stickslip slide records -y 0.1 --analysis coupled \
        --body sliding-slab-shaken --set "body.thickness=30 m"

    With one-way slip the two polarities of a record have two answers, and one
    may be twice the other. The first file that cannot be read ends the
    command, before anything is written.

    Exit code: 0 done, 1 an analysis failed, 2 unusable input, 130 interrupted.
    """
    from stickslip.extensions.strong_motion.summary import show_sliding

    table = Target("--out", out, (".csv",))
    check_targets(table, Target("--figure", figure), Target("--record-figure", record_figure))
    look.check(figure, record_figure)
    if record is not None and record_figure is None:
        raise InputError("slide: --record says what --record-figure draws: name its file, say --record-figure motion.png")
    if both_signs and polarity != "both":
        raise InputError(f"slide: --both-signs and --polarity {polarity} exclude each other")
    given = {"scale": scale, "scale_to_pga": scale_to_pga, "backward": backward}
    asked = {"polarity": _polarity(polarity), "analysis": analysis, "column": _column(analysis, body, changes)}
    asked |= {name: _several(text, name) for name, text in given.items()}
    study = _study(records, _yields(yields), asked | {"component": component, "baseline": baseline, "unit": unit})
    if record is not None:
        study.place_of(record)  # a name that no record has is told before anything is written
    show_sliding(study)
    announce(
        *write_files(
            (out, study.to_csv),
            (figure, drawing(study.plot, look)),
            (record_figure, drawing(lambda **place: study.plot_record(record, **place), look)),
        )
    )
    raise typer.Exit(0 if study.ok else 1)


def _study(records: list[Path], yields: Any, asked: dict[str, Any]) -> SlidingDisplacements:
    from stickslip.extensions.strong_motion.sliding import sliding
    from stickslip.run import progress_line

    with progress_line("slide:") as report:
        try:
            return sliding(records, yields, **asked, progress=report)
        except InputError as error:
            raise InputError(_in_options(str(error))) from None


def _in_options(message: str) -> str:
    """Return a message of `sliding` in the words of the command line: arguments as options."""
    message = message.replace("polarity=-1", "--polarity -1").replace("scale or scale_to_pga", "--scale or --scale-to-pga")
    message = message.replace("None or 'mean'", "'mean', or left out")
    if not message.startswith("sliding: "):
        return message
    argument = re.match(r"sliding: (scale_to_pga|scale|polarity|unit|baseline|backward) must", message)
    if argument is None:
        return f"slide: {message.removeprefix('sliding: ')}"
    return f"slide: --{argument[1].replace('_', '-')} must{message[argument.end() :]}"


def _yields(text: str) -> Any:
    """Return the yield coefficients in a text: a range, or values with commas between them."""
    from stickslip.extensions.strong_motion.asked import read_coefficients
    from stickslip.foundation.axis import TypedRange, check_ends, range_meant, spaced

    found = TypedRange.of(text, "slide: --yield")
    if found is None:
        try:
            return read_coefficients(_several(text, "yield"), "slide: --yield")
        except InputError as error:
            meant = range_meant(text)
            raise InputError(f"slide: --yield: {meant}, got {ascii(text)[:60]}" if meant else str(error)) from None
    low, high = (float(read_coefficients(_typed(end), "slide: --yield")[0]) for end in (found.low, found.high))
    if found.points is None or found.points < 2:
        raise InputError(f"slide: --yield: a range needs its number of points, at least 2, as in {text.partition(':')[0]}:6")
    check_ends("slide: --yield", low, high, log=found.log)
    if found.points > MOST_YIELDS:
        raise InputError(f"slide: --yield: a range has at most {MOST_YIELDS} points, got {found.points}")
    return spaced(low, high, found.points, log=found.log)


def _several(text: str | None, name: str) -> Any:
    """Return the values in a text with commas between them; "same" stays a word."""
    if text is None or text == "same":
        return text
    values = [_typed(one.strip()) for one in text.split(",") if one.strip()]
    if not values:
        raise InputError(f"slide: --{name.replace('_', '-')} has no value, got {ascii(text)[:60]}")
    return values


def _typed(text: str) -> Any:
    """Return a typed number as a number, and anything else, such as a number with a unit, as it is."""
    try:
        return float(text)
    except ValueError:
        return text


def _polarity(text: str) -> Any:
    value = _typed(text)
    return int(value) if value in (1.0, -1.0) else value


def _column(analysis: str, body: str | None, changes: list[str] | None) -> Any:
    """Return the body of the scenario that lends it."""
    from stickslip.cli.overrides import load_with
    from stickslip.extensions.strong_motion.asked import read_analysis

    if body is None:
        if changes:
            raise InputError("slide: --set changes the scenario of --body, which is not given")
        if analysis in ("coupled", "decoupled"):
            raise InputError(f"slide: --analysis {analysis} needs a column: name its scenario, say --body sliding-slab-shaken")
        read_analysis("slide", analysis, None)
        return None
    if analysis == "rigid":
        raise InputError("slide: --body is for --analysis coupled or decoupled; a rigid block needs none")
    return load_with("slide", body, changes).problem.body
