"""Writing the reproduction of the paper: figures, tables and the report in one folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import stickslip as ss
from stickslip.paper.cases import REFERENCE, Runs
from stickslip.paper.claims import CLAIMS, STATEMENTS, Verdict
from stickslip.paper.files import image, save_bytes, save_data, save_table, save_text
from stickslip.paper.tables import all_tables

if TYPE_CHECKING:
    from stickslip.paper.plates import Plate


def make(out: Path | str, progress: Callable[[str], object] | None = None, *, rtol: float = 1e-10) -> Path:
    """Write figures, tables and the report on the paper to one folder.

    Parameters
    ----------
    out : Path or str
        The folder; it is made if it does not exist.
    progress : callable, optional
        Called with one line of text before each step.
    rtol : float
        Relative tolerance of all runs.

    Returns
    -------
    Path
        The path of the report, `report.html`.

    Raises
    ------
    OSError
        If the folder cannot be written.
    RuntimeError
        If the engine gives up on a run.

    Notes
    -----
    The same version writes the same files, byte for byte. A file is either whole or not there.
    """
    say = progress or (lambda _: None)
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    runs = Runs(rtol)
    images = make_figures(folder, runs, say)
    verdicts = measure_claims(runs, say)
    say("tables")
    for name, table in all_tables(runs, verdicts).items():
        save_table(folder / f"{name}.csv", table)
    say("report")
    from stickslip.paper.report import report

    return save_text(folder / "report.html", report(runs, images, verdicts))


def make_figures(folder: Path, runs: Runs, say: Callable[[str], object]) -> dict[int, bytes]:
    """Write each figure as netCDF, PNG and SVG, and return the SVG files' bytes by the number of the figure."""
    from stickslip.paper.plates import PLATES

    images: dict[int, bytes] = {}
    for plate in PLATES:
        say(f"figure {plate.number} of {len(PLATES)}: {plate.title}")
        images[plate.number] = _make_figure(folder, runs, plate)
    return images


def _make_figure(folder: Path, runs: Runs, plate: Plate) -> bytes:
    dataset = plate.data(runs)
    about = {"Conventions": "CF-1.11", "source": f"stickslip {ss.__version__}", "references": REFERENCE, "rtol": runs.rtol}
    save_data(folder / f"figure{plate.number}.nc", dataset.assign_attrs(about, title=plate.title, comment=plate.caption))
    figure = plate.draw(dataset)
    save_bytes(folder / f"figure{plate.number}.png", image(figure, "png"))
    svg = image(figure, "svg")
    save_bytes(folder / f"figure{plate.number}.svg", svg)
    return svg


def measure_claims(runs: Runs, say: Callable[[str], object] = lambda _: None) -> list[Verdict]:
    """Return a verdict on every claim, in the order of their numbers."""
    verdicts = []
    for number, measure in CLAIMS.items():
        say(f"claim {number} of {len(CLAIMS)}: {STATEMENTS[number]}")
        verdicts.append(measure(runs))
    return verdicts
