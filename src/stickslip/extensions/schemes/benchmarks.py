"""Problems for other programs, each with its right series as a file, and a report on a series of theirs.

`BENCHMARKS` lists them: a problem of one contact has an exact series (`problems.py`), another one a series that has converged, with
an error band (`benchmark_kinds.ConvergedBenchmark`).
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.extensions.schemes.benchmark_kinds import Benchmark, ConvergedBenchmark
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.converged import SeriesWithinBand
from stickslip.extensions.schemes.judgement import TOLERANCE
from stickslip.extensions.schemes.judging import judged
from stickslip.extensions.schemes.planar_series import of_faults
from stickslip.extensions.schemes.problems import OF_ONE_CONTACT
from stickslip.extensions.schemes.schemes import Schemes
from stickslip.foundation.arguments import for_users
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.netcdf_file import write
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario, library, load_scenario, read_source
from stickslip.run import TextProgress

if TYPE_CHECKING:
    import xarray as xr

ALL_BENCHMARKS: tuple[Benchmark | ConvergedBenchmark, ...] = (*OF_ONE_CONTACT, *of_faults())
"""All problems."""
BENCHMARKS = {one.name: one for one in ALL_BENCHMARKS}
"""The problems by name."""

ALL = "all"
"""What stands for every problem."""


def benchmark_of(name: str) -> Benchmark | ConvergedBenchmark:
    """Return the problem of a name. Raises InputError for an unknown one."""
    if name not in BENCHMARKS:
        raise InputError(f"benchmark: there is no problem {ascii(name)[:60]}; {nearest(name, BENCHMARKS)}")
    return BENCHMARKS[name]


def scenario_named(name: str) -> Scenario:
    """Return the bundled scenario of a name. Raises InputError if there is none."""
    if name in library.names():
        return load_scenario(name)
    hint = nearest(name, [*BENCHMARKS, *library.names()])
    hint = hint if hint.startswith("did") else 'name it, as in judge_series(FILE, "fig4-loop")'
    raise InputError(f"judge_series: of which problem is {ascii(name)[:60]}? {hint}")


@for_users
def judge_series(
    series: Series | str | Path | Sequence[Series | str | Path],
    problem: Problem | Scenario | str | Path | None = None,
    *,
    tolerance: float = TOLERANCE,
    rtol: float = 1e-10,
    columns: Mapping[str, str | int] | None = None,
    progress: TextProgress | bool | None = None,
) -> Any:  # Schemes, but for the name of a benchmark whose series has converged: those who type need no cast
    """Compare series of any other program with the exact solution of every selection rule, at the relative tolerance `rtol`.

    Parameters
    ----------
    series : Series, str, Path or sequence of them
        Slip since t = 0, slip rate and traction over time, or files of them, which
        `stickslip.extensions.schemes.series.read_series` reads.
    problem : Problem, Scenario, str or Path, optional
        Any problem of one contact, its scenario, a scenario file, or the name of a benchmark or of a bundled scenario; by default
        the benchmark or the bundled scenario that has the name of the first series.
    tolerance : float
        Largest share by which a series that passes may be off; see `stickslip.extensions.schemes.judgement.Judgement`.
    columns : dict, optional
        What headings of the files mean, as in {"slip": "D (mm)", "time": 1}.

    Returns
    -------
    Schemes
        With `passed`, and in `judgements` what is off and which convention would explain it. If the problem is a benchmark whose
        series has converged and is not exact, the result is a `SeriesWithinBand` with `passed` and a table.

    Raises
    ------
    InputError
        If the problem is not of one contact or has no name, if no series is given, or if one cannot be read, does not begin at
        t = 0, is shorter than the scenario's duration, or has slip, slip rate or traction in wrong units.
    KeyboardInterrupt
        If the user presses Ctrl-C.
    """
    given = [series] if isinstance(series, Series | str | Path) else list(series)
    if not given:
        raise InputError("judge_series: needs a series or more")
    name = _name_of(given[0]) if problem is None else problem
    if isinstance(name, str) and name in BENCHMARKS:
        named = BENCHMARKS[name]
        if isinstance(named, ConvergedBenchmark):
            return named.judge(_read(given, columns), tolerance, progress)
        problem = named.scenario
    source = scenario_named(_name_of(given[0])) if problem is None else problem
    if not isinstance(source, Problem):
        scenario = read_source("judge_series", source)
        several = _read(given, columns, scenario.problem.body.load_unit)
        return judged(scenario, several, (tolerance, rtol), progress)
    several = _read(given, columns, source.body.load_unit)
    scenario = read_source("judge_series", source, max(float(one.time[-1]) for one in several))
    return judged(scenario, several, (tolerance, rtol), progress, to_their_ends=True)


def _name_of(series: Series | str | Path) -> str:
    return series.name if isinstance(series, Series) else Path(series).stem


def _read(
    given: Sequence[Series | str | Path], columns: Mapping[str, str | int] | None, load_unit: str = "Pa"
) -> tuple[Series, ...]:
    """Return series, those in files read as the series of a body with this unit of loads."""
    from stickslip.extensions.schemes.series import read_series

    return tuple(one if isinstance(one, Series) else read_series(one, columns=columns, load_unit=load_unit) for one in given)


def exact_series(name: str) -> xr.Dataset:
    """Return the right series of a problem: time, slip since t = 0, slip rate, traction, and in an exact one events and shocks."""
    return benchmark_of(name).series()


def write_benchmark(name: str, folder: str | Path = ".") -> tuple[Path, Path, Path]:
    """Write a problem of BENCHMARKS for other programs to a folder that exists, and return the paths of the three files.

    NAME.toml is the scenario in SI units, NAME.nc the exact series, and NAME.sha256 the checksums of both for `sha256sum --check`.
    Raises InputError if the name is unknown, or a file cannot be written.
    """
    found, place = benchmark_of(name), Path(folder)
    if not place.is_dir():
        raise InputError(f"benchmark: there is no folder {place}")
    text = found.scenario.to_toml()
    scenario = write_atomically(place / f"{name}.toml", lambda draft: draft.write_text(text, encoding="utf-8", newline="\n"))
    series = write(found.series(), place / f"{name}.nc")
    sums = "".join(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in (scenario, series))
    checksums = write_atomically(place / f"{name}.sha256", lambda draft: draft.write_text(sums, encoding="utf-8", newline="\n"))
    return scenario, series, checksums


def write_all(folder: str | Path = ".") -> Path:
    """Write every problem of BENCHMARKS to a folder, as `write_benchmark` does, and return the path of a file of all checksums."""
    sums = "".join(write_benchmark(name, folder)[-1].read_text(encoding="utf-8") for name in BENCHMARKS)
    return write_atomically(Path(folder) / f"{ALL}.sha256", lambda draft: draft.write_text(sums, encoding="utf-8", newline="\n"))


def judge_benchmark(
    file: str | Path | Sequence[str | Path],
    name: str | None = None,
    *,
    tolerance: float = TOLERANCE,
    columns: Mapping[str, str | int] | None = None,
    progress: TextProgress | bool | None = None,
) -> Schemes | SeriesWithinBand:
    """Compare the series of another program, in one file or in several of different steps, with the right one of a problem.

    `stickslip.extensions.schemes.series.read_series` reads a file. The problem is by default that with the name of the first; the
    other arguments are as for `judge_series`. Raises InputError if the name is unknown, or a file cannot be read.
    """
    files = [file] if isinstance(file, str | Path) else list(file)
    found = benchmark_of(Path(files[0]).stem if name is None else name)
    return found.judge(_read(files, columns, found.scenario.problem.body.load_unit), tolerance, progress)
