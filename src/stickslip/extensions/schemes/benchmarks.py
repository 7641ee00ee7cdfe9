"""Twelve problems of the slab for other programs, each with its exact series as a file, and a report on a series of theirs.

Each problem asks one thing of a program. A scheme that passes all of them moves waves, rests, slips, makes shocks and follows the
rule that it claims.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import stickslip
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.judgement import TOLERANCE
from stickslip.extensions.schemes.run import check_suitable
from stickslip.extensions.schemes.schemes import Schemes
from stickslip.extensions.schemes.shocks import check_length, check_units
from stickslip.extensions.schemes.verdict import exact_runs
from stickslip.foundation.arguments import for_users, shown
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.netcdf_file import write
from stickslip.friction import HyperbolicRate, LinearSlipWeakening, SinusoidalSlip
from stickslip.friction.laws.of_rate import Coulomb
from stickslip.problem import Problem
from stickslip.problem.bodies import ElasticSlab
from stickslip.problem.scenarios import Scenario, library, load_scenario, read_source
from stickslip.run import TextProgress, telling
from stickslip.run.simulate import simulate

if TYPE_CHECKING:
    import xarray as xr

RTOL_OF_EXACT = 1e-12
"""Relative tolerance of the exact series."""
INTERVALS = 4000
"""Number of equal intervals of time in a series."""
ROCK = ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
"""The slab of the paper."""
MATCHED = replace(ROCK, driver_impedance=ROCK.impedance)
"""The same slab under a half-space of the same rock, which reflects nothing."""


def _smooth() -> Scenario:
    law = SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=2.0)
    return Scenario(Problem(ROCK, law, pull_rate=0.3, initial_slip=math.pi / 4, initial_excess=0.0), 8.0)


def _at_the_maximum() -> Scenario:
    law = SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=50.0)
    excess = 5e7 * (1.0 - math.cos(0.05))
    return Scenario(Problem(ROCK, law, initial_slip=math.pi / 100 + 1e-3, initial_excess=excess), 5.7)


def _weakening(slab: ElasticSlab) -> Scenario:
    law = LinearSlipWeakening(static=0.677, dynamic=0.525, distance=0.4)
    rock = replace(slab, density=2670.0, wave_speed=3464.0, normal_stress=1.2e8)
    rock = rock if math.isinf(slab.driver_impedance) else replace(rock, driver_impedance=rock.impedance)
    return Scenario(Problem(rock, law, initial_excess=3.6e5), 12.0)


def _coulomb() -> Scenario:
    return Scenario(Problem(ROCK, Coulomb(static=0.8, dynamic=0.3), pull_rate=1e-6, initial_excess=0.0), 9.0)


def _regular() -> Scenario:
    law = HyperbolicRate(static=0.8, dynamic=0.3, alpha=0.1)
    return Scenario(Problem(ROCK, law, pull_rate=0.5, initial_excess=0.0), 12.0)


def _dwell() -> Scenario:
    law = HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    return Scenario(Problem(MATCHED, law, initial_load=7e7, far_stress=7.5e7), 8.0)


@dataclass(frozen=True)
class Benchmark:
    """A problem for other programs: what it asks of them, and its scenario."""

    name: str
    asks: str
    make: Callable[[], Scenario]

    @property
    def scenario(self) -> Scenario:
        """The scenario, with the tolerance of the exact series."""
        return replace(self.make(), rtol=RTOL_OF_EXACT, name=self.name, title=f"benchmark {self.name}", description=self.asks)


def _bundled(name: str) -> Callable[[], Scenario]:
    return lambda: load_scenario(name)


_ALL = (
    Benchmark("smooth-slip", "the order of convergence: slip begins without a shock and goes on", _smooth),
    Benchmark("linear-weakening", "a kink of the law, a shock by an echo, arrest; it has a closed form", lambda: _weakening(ROCK)),
    Benchmark("no-echo", "a driver that absorbs every wave: radiation damping alone", lambda: _weakening(MATCHED)),
    Benchmark("coulomb", "two large shocks and exact rest after one round trip of the waves", _coulomb),
    Benchmark("one-pulse", "exactly one pulse, and rest until the echo", _bundled("fig5-slab-u0-1e-2")),
    Benchmark("three-pulses", "three pulses of 8 ms at the right times, and complete arrest", _bundled("fig5-slab-reconstructed")),
    Benchmark("load-at-the-maximum", "no pulse of the grid's own: friction just holds after the first", _at_the_maximum),
    Benchmark("regular-rate", "friction of slip rate with one solution, under a fast driver", _regular),
    Benchmark("rate-shock", "an onset from the strength exactly, and two shocks of 4 m/s", _bundled("fig6-slab")),
    Benchmark("weak-shock", "a shock of 2.6e-5 m/s that must neither be lost nor grow", _bundled("fig7-slab-critical")),
    Benchmark("loop", "which selection rule: the load passes both folds", _bundled("fig4-loop")),
    Benchmark("dwell", "which selection rule: the load rises to between the folds and stays there", _dwell),
)
BENCHMARKS = {one.name: one for one in _ALL}
"""The problems by name."""


def benchmark_of(name: str) -> Benchmark:
    """Return the problem of a name. Raises InputError for an unknown one."""
    if name not in BENCHMARKS:
        raise InputError(f"benchmark: there is no problem {ascii(name)[:60]}; {nearest(name, BENCHMARKS)}")
    return BENCHMARKS[name]


def scenario_named(name: str) -> Scenario:
    """Return the benchmark or the bundled scenario of a name. Raises InputError if there is none."""
    if name in BENCHMARKS:
        return BENCHMARKS[name].scenario
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
) -> Schemes:
    """Compare series of any other program with the exact solution of every selection rule, at the relative tolerance `rtol`.

    Parameters
    ----------
    series : Series, str, Path or sequence of them
        Slip since t = 0, slip rate and traction over time, or files of them, which
        `stickslip.extensions.schemes.series.read_series` reads.
    problem : Problem, Scenario, str or Path, optional
        As for `schemes`; by default the benchmark or the bundled scenario that has the name of the first series.
    tolerance : float
        Largest share by which a series that passes may be off; see `stickslip.extensions.schemes.judgement.Judgement`.
    columns : dict, optional
        What headings of the files mean, as in {"slip": "D (mm)", "time": 1}.

    Returns
    -------
    Schemes
        With `passed`, and in `judgements` what is off and which convention would explain it.

    Raises
    ------
    InputError
        If the problem is not a slab's or has no name, if no series is given, or if one cannot be read, does not begin at t = 0, is
        shorter than the scenario's duration, or has slip, slip rate or traction in wrong units.
    KeyboardInterrupt
        If the user presses Ctrl-C.
    """
    from stickslip.extensions.schemes.series import read_series

    given_series = [series] if isinstance(series, Series | str | Path) else list(series)
    several = tuple(one if isinstance(one, Series) else read_series(one, columns=columns) for one in given_series)
    if not several:
        raise InputError("judge_series: needs a series or more")
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"judge_series: tolerance must lie between 0 and 1, got {shown(tolerance)}")
    ends = max(float(one.time[-1]) for one in several) if isinstance(problem, Problem) else None
    scenario = read_source("judge_series", scenario_named(several[0].name) if problem is None else problem, ends)
    lasts, given = scenario.duration, scenario.problem
    check_suitable(given)
    for one in several:
        check_length(one, lasts if ends is None else float(one.time[-1]))
    with telling(progress, "judge_series") as tell:
        exact = exact_runs(given, lasts, rtol, tell)
    for one in several:
        check_units(one, exact[given.rule], given)
    return Schemes(given, exact, several, tolerance=tolerance)


def exact_series(name: str) -> xr.Dataset:
    """Return the exact series of a problem: time, slip since t = 0, slip rate and traction, and its events and shocks.

    At each shock there are two rows of the same time, with the values before it and after it.
    """
    scenario = benchmark_of(name).scenario
    run = simulate(scenario)
    shocks = run.shocks[["time", "rate_before", "rate_after", "traction_before", "traction_after"]]
    at = shocks.time.to_numpy(float)
    uniform = np.unique(np.concatenate([np.linspace(0.0, run.history.span[1], INTERVALS + 1), at]))
    sides = [(at, "left"), (uniform, "right")]
    time = np.concatenate([times for times, _ in sides])
    order = np.argsort(time, kind="stable")  # stable: the values before a shock come first
    rate = np.concatenate([run.slip_rate(times, side) for times, side in sides])  # type: ignore[arg-type]
    traction = np.concatenate([run.traction(times, side) for times, side in sides])  # type: ignore[arg-type]
    table = shocks.rename(columns=lambda column: f"shock_{column}").rename_axis("shock")
    events = run.events[["start", "end", "slip", "peak_rate", "pulses"]].rename(columns=lambda column: f"event_{column}")
    found = table.to_xarray().merge(events.rename_axis("event").to_xarray())
    values = {"time": time, "slip": run.slip(time) - run.problem.initial_slip, "slip_rate": rate, "traction": traction}
    units = {"time": "s", "slip": "m", "slip_rate": "m s-1", "traction": "Pa"}
    found = found.assign({column: ("sample", values[column][order], {"units": unit}) for column, unit in units.items()})
    about = {"title": scenario.title, "asks": scenario.description, "rtol": RTOL_OF_EXACT, "version": stickslip.__version__}
    return found.assign_attrs(**about, rule=run.problem.rule, scenario=scenario.to_toml())


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
    series = write(exact_series(name), place / f"{name}.nc")
    sums = "".join(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in (scenario, series))
    checksums = write_atomically(place / f"{name}.sha256", lambda draft: draft.write_text(sums, encoding="utf-8", newline="\n"))
    return scenario, series, checksums


def judge_benchmark(
    file: str | Path,
    name: str | None = None,
    *,
    tolerance: float = TOLERANCE,
    columns: Mapping[str, str | int] | None = None,
    progress: TextProgress | bool | None = None,
) -> Schemes:
    """Compare the series of another program with the exact solution.

    `stickslip.extensions.schemes.series.read_series` reads the file. The problem is by default that with the name of the file; the
    other arguments are as for `judge_series`. Raises InputError if the name is unknown, or the file cannot be read.
    """
    scenario = benchmark_of(Path(file).stem if name is None else name).scenario
    return judge_series(file, scenario, tolerance=tolerance, columns=columns, progress=progress)
