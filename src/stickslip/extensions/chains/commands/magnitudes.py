"""`stickslip magnitudes`: find the Gutenberg-Richter slope of a catalogue in a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.options import FigureFile, option, table_of
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.cli.output.show import console, print_sentences
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.foundation.arrays import Floats

COMPLETENESS = "Magnitude of completeness; default: by the largest curvature."
BIN = "Width of the bins to whose middles magnitudes were rounded; 0 if they were not."
LARGEST = "Leave out events above this magnitude, and cut the law off there."
COLUMN = 'Its column of magnitudes, or of moments; default: "magnitude", "mag" or "moment".'
SCALE = 'Of moments: "ln" for ln M, "moment" for (2/3) log10 M.'
MAGNITUDES, MOMENTS = ("magnitude", "mag", "ml", "mw"), ("moment", "m0")
"""Headings of the two kinds of columns, in small letters and without a unit."""


def magnitudes(
    catalogue: Annotated[Path, typer.Argument(help="A CSV file with a heading, a row for each event.")],
    *,
    completeness: Annotated[float | None, option(COMPLETENESS)] = None,
    bin_width: Annotated[float, option(BIN, "--bin")] = 0.0,
    largest: Annotated[float | None, option(LARGEST)] = None,
    column: Annotated[str | None, option(COLUMN)] = None,
    scale: Annotated[str, option(SCALE)] = "ln",
    seed: Annotated[int, option("Seed of the resampling.")] = 0,
    out: Annotated[Path | None, table_of("bin of magnitudes")] = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Find the Gutenberg-Richter slope b of a catalogue, with its interval and how well the law fits.

    The file has a column of magnitudes, or of moments M, such as the events of
    a chain that `stickslip run --csv` writes. For mu = ln M the slope of papers
    on chains is beta.

    \b
      stickslip magnitudes catalogue.csv --bin 0.1 --completeness 2.5
      stickslip magnitudes events.csv --largest 2 --figure b.png

    Exit code: 0 done, 2 unusable input.
    """
    from stickslip.extensions.chains.statistics import gutenberg_richter

    check_targets(Target("--out", out, (".csv",)), Target("--figure", figure))
    look.check(figure)
    found = gutenberg_richter(read_magnitudes(catalogue, column, scale), completeness, bin_width, largest=largest, seed=seed)
    print_sentences(console(), *found.sentences)
    announce(*write_files((out, found.to_csv), (figure, drawing(found.plot, look))))


def read_magnitudes(path: Path, column: str | None, scale: str) -> Floats:
    """Return magnitudes from a CSV file. Raises InputError."""
    import pandas as pd

    from stickslip.extensions.chains.magnitudes import magnitudes as of_moments
    from stickslip.extensions.chains.magnitudes import numbers_of

    try:
        table = pd.read_csv(path, comment="#", skipinitialspace=True)
    except FileNotFoundError:
        raise InputError(f"magnitudes: there is no file {path}") from None
    except (OSError, ValueError) as error:  # not text, or no table
        raise InputError(f"magnitudes: {path}: cannot be read as CSV: {' '.join(str(error).split())}") from None
    known = {str(name).partition(" (")[0].strip().lower(): name for name in table.columns}
    wanted = (column.strip().lower(),) if column else (*MAGNITUDES, *MOMENTS)
    name = next((one for one in wanted if one in known), None)
    if name is None:
        has = ", ".join(map(str, table.columns[:8]))
        raise InputError(f"magnitudes: {path}: no column {' or '.join(map(repr, wanted))}; it has {has}: name one by --column")
    values = numbers_of(f"magnitudes: {path}", f"column {name!r}", table[known[name]])
    return of_moments(values[values != 0.0], scale) if name in MOMENTS else values  # type: ignore[arg-type]
