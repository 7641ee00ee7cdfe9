"""Write on-fault time series as text, in the layout of the SCEC/USGS spontaneous rupture benchmarks.

Comment lines begin with # and say what was run and what the columns are. Then one line names the fields, and one line follows for
each sample. Stress is in MPa, as in the benchmarks; a block has forces, in N, unless the area of its contact is given. Source:
R.A. Harris et al. 2009, Seismol. Res. Lett. 80, 119; scecdata.usc.edu/cvws.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple, Unpack

import numpy as np

import stickslip
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import TURNS
from stickslip.foundation.quantities import Quantity
from stickslip.problem import Problem
from stickslip.problem.scenarios import to_table
from stickslip.solution.evaluation import Readings
from stickslip.solution.files.sampling import SampledRun, Span, sample
from stickslip.solution.window import Window

AREA = Quantity("m^2", "area of the contact of a block", above=0)


def write_scec(
    run: Readings,
    path: str | Path,
    sampling_rate: float,
    *,
    problem: str = "stickslip",
    station: str = "contact",
    components: bool = False,
    area: float | str | WithUnit | None = None,
    **sampling: Unpack[Span],
) -> Path:
    """Write time, slip, slip rate and shear stress of a run, or of a window on it, as text, and return the path.

    There are `sampling_rate` samples per second (Hz), and the other arguments of `sample`, `start`, `end` and `antialias`, may be
    given. Slip is counted from the start of the run or, in a window, of the event. `problem` and `station` are texts of one line
    for the header. With `components` there are the eight columns of the three-dimensional benchmarks: those that begin with h- hold
    the slip of this model, those with v- are zero, and the last one is the normal stress. There tension is positive, as in TPV29 to
    TPV37, so that the normal stress is negative. The forces of a block are stresses (MPa) where the `area` of its contact is given
    (m^2, or a text with a unit); otherwise they are forces (N), and their columns are named so.

    Raises InputError as `sample` does, for a contact that turns, for the area of a slab, whose loads are stresses already, and for
    a header text with line breaks or control characters.
    """
    if run.problem.load_unit == TURNS:
        what = f"a contact that turns ({type(run.problem.body).__name__})"
        raise InputError(f"export: the layout of the SCEC has slip in m and stress in MPa, {what} has neither: write netCDF")
    for name, text in (("problem", problem), ("station", station)):
        if not text.isprintable():
            raise InputError(f"{name} must be one line of text, got {text!r}")
    on = _divided_by(run.problem, area)
    series = sample(run, sampling_rate, **sampling)
    columns = _columns(run, series, on, components)
    header = [f"# {line}" for line in _about(run, series, problem, station, [meaning for _, meaning, _ in columns])]
    numbers = np.column_stack([values for _, _, values in columns])
    lines = (" ".join((f"{row[0]: .13E}", *(f"{value: .12E}" for value in row[1:]))) for row in numbers.tolist())
    text = "\n".join([*header, " ".join(name for name, _, _ in columns), *lines, ""])
    return write_atomically(Path(path), lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))


class LoadsOfFile(NamedTuple):
    """What loads are in a file: "stress" or "force", their unit there, and the factor from SI to it."""

    kind: str
    unit: str
    factor: float


def _divided_by(problem: Problem, area: float | str | WithUnit | None) -> LoadsOfFile:
    """Return what the loads of a problem are in a file, given the area of the contact (m^2), if it is known."""
    if problem.load_unit == "N" and area is None:
        return LoadsOfFile("force", "N", 1.0)
    if problem.load_unit == "N":
        return LoadsOfFile("stress", "MPa", 1e-6 / AREA.check("export", "area", area))
    if area is not None:
        raise InputError("export: area is that of a block's contact: the loads of a slab are stresses already; leave it out")
    return LoadsOfFile("stress", "MPa", 1e-6)


def _columns(run: Readings, series: SampledRun, on: LoadsOfFile, components: bool) -> list[tuple[str, str, Floats]]:
    """Return the name, the meaning and the numbers of each column.

    The vertical components of the three-dimensional benchmarks are zero here, because slip has one direction.
    """
    time = ("t", "Time (s)", series.time)
    slip = [
        ("slip", "slip (m)", series.slip),
        ("slip-rate", "slip rate (m/s)", series.slip_rate),
        (f"shear-{on.kind}", f"shear {on.kind} ({on.unit})", on.factor * series.traction),
    ]
    if not components:
        return [time, *slip]
    zero = np.zeros_like(series.slip)
    along = [(f"h-{name}", f"horizontal {meaning}", values) for name, meaning, values in slip]
    across = [(f"v-{name}", f"vertical {meaning}", zero) for name, meaning, _ in slip]
    normal = -on.factor * run.normal_load(series.time)
    return [time, *along, *across, (f"n-{on.kind}", f"normal {on.kind} ({on.unit})", normal)]


def _about(run: Readings, series: SampledRun, problem: str, station: str, meanings: list[str]) -> Iterator[str]:
    solution = run.solution if isinstance(run, Window) else run
    yield f"problem={problem}"
    yield "code=stickslip"
    yield f"code_version={stickslip.__version__}"
    yield f"body={to_table(run.problem.body)}"
    yield f"friction={to_table(run.problem.friction)}"
    yield from (f"{name}={text}" for name, text in run.problem.loading_texts.items())
    yield f"initial_load={run.problem.load!r} {run.problem.load_unit}"
    if run.problem.has_initial_rate:
        yield f"initial_rate={run.problem.rate!r} m/s"
    yield f"selection_rule={run.problem.rule}"
    yield f"rtol={solution.rtol:g}"  # type: ignore[attr-defined]
    if isinstance(run, Window):
        row, offset = run.epoch
        late = f"{row} rows of {run.history.round_trip_time!r} s (round trips; block: periods) and {offset!r} s after t = 0"
        yield f"origin=start of the slip event {late}"
    yield "element_size=0 (no grid: exact waves)"
    yield f"time_step={1.0 / series.rate:.13E} s"
    yield f"num_time_steps={len(series.slip)}"
    yield f"location={station}"
    yield f"Time series in {len(meanings)} columns: E21.13, then E20.12"
    for number, meaning in enumerate(meanings, 1):
        yield f"Column #{number} = {meaning}"
    yield "The line below lists the names of the data fields:"
