"""Writing the reproduction of the paper: figures, tables and the report in one folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import stickslip as ss
from stickslip.extensions.paper.cases import REFERENCE, Runs
from stickslip.extensions.paper.claims import CLAIMS, STATEMENTS, ClaimVerdict

if TYPE_CHECKING:
    from stickslip.extensions.paper.plates import Plate


def make(out: Path | str, progress: Callable[[str], object] | None = None, *, rtol: float = 1e-10) -> Path:
    """Write figures, tables and the report on the paper to one folder, and return the path of the report, `report.html`.

    The same version writes the same files, byte for byte; a file is either whole or not there. `progress` is called with one line
    of text before each step, and `rtol` is the relative tolerance of all runs. Raises OSError if the folder cannot be written, and
    RuntimeError if the engine gives up on a run.
    """
    from stickslip.extensions.paper.plates import PLATES
    from stickslip.extensions.paper.report import report
    from stickslip.extensions.paper.tables import all_tables
    from stickslip.figures.page import save_text

    say = progress or (lambda _: None)
    folder, runs = Path(out), Runs(rtol)
    folder.mkdir(parents=True, exist_ok=True)
    images: dict[int, bytes] = {}
    for plate in PLATES:
        say(f"figure {plate.number} of {len(PLATES)}: {plate.title}")
        images[plate.number] = _make_figure(folder / f"figure{plate.number}", runs, plate)
    verdicts: list[ClaimVerdict] = []
    for number, measure in CLAIMS.items():
        say(f"claim {number} of {len(CLAIMS)}: {STATEMENTS[number]}")
        verdicts.append(measure(runs))
    say("tables")
    for name, table in all_tables(runs, verdicts).items():
        save_text(folder / f"{name}.csv", table.to_csv(index=False, lineterminator="\n"))
    say("report")
    return save_text(folder / "report.html", report(runs, images, verdicts))


def _make_figure(path: Path, runs: Runs, plate: Plate) -> bytes:
    """Write a figure as netCDF, PNG and SVG under a path without suffix, and return the bytes of the SVG file."""
    from stickslip.figures.page import save_figure
    from stickslip.foundation.netcdf_file import write

    dataset = plate.data(runs)
    about = {"Conventions": "CF-1.11", "source": f"stickslip {ss.__version__}", "references": REFERENCE, "rtol": runs.rtol}
    write(dataset.assign_attrs(about, title=plate.title, comment=plate.caption), path.with_suffix(".nc"))
    return save_figure(path, plate.draw(dataset))
