"""The series that the page check-your-own-code.md offers for download: what they say, and whether their numbers are right."""

from __future__ import annotations

import math
import re
import runpy
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from mpmath import mp, mpf

import stickslip as ss
from tests.core.run.reference.method_of_steps import method_of_steps
from tests.docs.pages import ROOT

FOLDER = ROOT / "docs" / "exact"
SCRIPT = runpy.run_path(str(ROOT / "docs" / "exact_series.py"))
PROBLEMS = SCRIPT["PROBLEMS"]


@pytest.fixture(scope="module")
def old() -> dict[str, str]:
    return {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.csv")}


@pytest.fixture(scope="module")
def new() -> dict[str, str]:
    made: dict[str, str] = SCRIPT["files"]()
    return made


def read(name: str) -> Any:
    """Return a file as a user reads it."""
    return pd.read_csv(FOLDER / name, comment="#")


def right_limits(problem: str) -> Any:
    """Return the series of a problem without the rows just before shocks."""
    return read(f"{problem}.csv").drop_duplicates("time_s", keep="last")


def test_the_exact_series_are_those_of_a_run_now(old: dict[str, str], new: dict[str, str]) -> None:
    """Each number to 1e-10 of the largest one of its column; headers but for the version."""
    assert list(SCRIPT["differences"](old, new)) == []
    assert set(old) == set(new)


@pytest.mark.parametrize(
    ("name", "found", "put", "fault"),
    [
        ("linear-slab.csv", "81240000.0\n", "81240000.1\n", "has other numbers"),
        ("fig6-slab.csv", "23.4402332474", "23.4402332574", "has other numbers"),
        ("events.csv", "3.02910245", "3.02910246", "has other numbers"),
        ("events.csv", ",Pa\n", ",N\n", "describes something else"),
        ("fig6-slab.csv", "#   alpha = 1.0", "#   alpha = 1.1", "describes something else"),
        ("linear-slab.csv", "0.03,", "nan,", "has other numbers"),
    ],
)
def test_a_wrong_number_in_a_series_is_noticed(
    name: str, found: str, put: str, fault: str, old: dict[str, str], new: dict[str, str]
) -> None:
    assert found in old[name]
    wrong = old | {name: old[name].replace(found, put, 1)}
    assert list(SCRIPT["differences"](wrong, new)) == [f"{name} {fault}"]


def test_another_version_is_no_difference(old: dict[str, str], new: dict[str, str]) -> None:
    other = {name: text.replace(f"stickslip {ss.__version__}", "stickslip 99.0") for name, text in old.items()}
    assert other != old
    assert list(SCRIPT["differences"](other, new)) == []


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("problem", PROBLEMS)
def test_a_second_integration_gives_the_exact_series(problem: str) -> None:
    """The method of steps shares no code with the engine: slip and slip rate to 1e-9 of the largest ones."""
    exact, scenario = right_limits(problem), SCRIPT["scenario_of"](problem)
    shocks = read("shocks.csv").query("problem == @problem").time_s.to_numpy()
    time = exact.time_s.to_numpy()
    away = (np.abs(time[:, None] - shocks) > 1e-9).all(axis=1)
    other = method_of_steps(scenario.problem, scenario.duration, 3e-14)
    for own, column in ((other.slip(time) - scenario.problem.initial_slip, "slip_m"), (other.slip_rate(time), "slip_rate_m_per_s")):
        assert np.abs(own - exact[column].to_numpy())[away].max() <= 1e-9 * exact[column].max()


@pytest.mark.parametrize("problem", PROBLEMS)
def test_smaller_tolerances_give_the_exact_series(problem: str) -> None:
    """To what the page promises: 1e-11 of the largest slip and slip rate, and 1e-10 for the slip rate in the pulses of Fig. 5.

    Before each of these pulses the contact creeps at 0.35 mm/s, where a slip of 0.2 m, rounded to 1.4e-17 m, is 4e-14 s early or
    late, in each of some twenty steps; in the pulse the slip rate changes by 1.7e3 m/s^2. Of 200 runs with tolerances from 1e-13 to
    1e-12 the median misses 40 digits by 2.4e-11 of the largest slip rate, the worst by 8.1e-11.
    """
    exact, scenario = right_limits(problem), SCRIPT["scenario_of"](problem)
    time, allowed = exact.time_s.to_numpy(), 1e-10 if problem in SCRIPT["PULSES"] else 1e-11
    for rtol in (1e-13, 2e-13, 3e-13, 5e-13):
        run = ss.simulate(scenario, rtol=rtol)
        slip, rate = exact.slip_m.to_numpy(), exact.slip_rate_m_per_s.to_numpy()
        assert np.abs(run.slip(time) - scenario.problem.initial_slip - slip).max() <= 1e-11 * slip.max()
        assert np.abs(run.slip_rate(time) - rate).max() <= allowed * rate.max()


@pytest.mark.slow
def test_forty_digits_give_the_pulses() -> None:
    """Slip to 5e-12 and slip rate to 2e-11 of the largest, up to the first echo, which ends the event."""
    exact = right_limits("fig5-slab-reconstructed").query("time_s < 5.714")
    times = exact.time_s.to_numpy()
    with mp.workdps(40):
        slip, rate = np.array(list(pulses([mpf(time) for time in times])), float).T
    assert times.size > 300
    assert np.abs(exact.slip_m.to_numpy() - slip).max() <= 5e-12 * slip.max()
    assert np.abs(exact.slip_rate_m_per_s.to_numpy() - rate).max() <= 2e-11 * rate.max()


def value(coefficients: list[mpf], x: mpf) -> mpf:
    """Return a polynomial at x, from its coefficients with the lowest order first."""
    return mp.fsum(c * x**k for k, c in enumerate(coefficients))


def pulses(times: list[mpf], order: int = 40) -> Iterator[tuple[mpf, mpf]]:
    """Yield slip and slip rate of the slab of Fig. 5, from Z u' = initial load + G V t / h - S mu(u), by Taylor's series."""
    problem = SCRIPT["scenario_of"]("fig5-slab-reconstructed").problem
    stress, wavenumber, start = mpf(problem.body.normal_stress), mpf(problem.friction.wavenumber), mpf(problem.initial_slip)
    impedance = mpf(problem.body.density) * mpf(problem.body.wave_speed)
    pull = impedance * mpf(problem.body.wave_speed) * mpf(problem.pull_rate) / mpf(problem.body.thickness)
    force, amplitude = stress / 2 * mp.sin(wavenumber * start) + mpf(problem.excess), stress / 2
    now, slip, n = mpf(0), mpf(0), 0
    while n < len(times):
        u, w = [slip], []
        sine, cosine = [mp.sin(wavenumber * (start + slip))], [mp.cos(wavenumber * (start + slip))]
        for k in range(order):
            load = (force + pull * now, pull)[k] if k < 2 else mpf(0)
            u.append((load - amplitude * sine[k]) / impedance / (k + 1))
            w.append(wavenumber * (k + 1) * u[k + 1])
            sine.append(sum(w[j] * cosine[k - j] for j in range(k + 1)) / (k + 1))
            cosine.append(-sum(w[j] * sine[k - j] for j in range(k + 1)) / (k + 1))
        step = (mpf("1e-30") * abs(u[1] / u[order])) ** (mpf(1) / (order - 1))
        while n < len(times) and times[n] <= now + step:
            yield value(u, times[n] - now), value([k * u[k] for k in range(1, order + 1)], times[n] - now)
            n += 1
        now, slip = now + step, value(u, step)


def test_slip_and_traction_of_linear_weakening_have_their_closed_form() -> None:
    """The page compares the slip rate; slip is its integral, and traction its friction."""
    exact = right_limits("linear-slab")
    z, trip, excess, fall, distance = 2670.0 * 3464.0, 2e4 / 3464.0, 8.16e7 - 1.2e8 * 0.677, 1.2e8 * (0.677 - 0.525), 0.4
    scale = z * distance / fall
    kink, arrest = scale * math.log(1.0 + fall / excess), trip + scale * math.log((excess + fall) / (2.0 * excess))
    t = np.minimum(exact.time_s.to_numpy(), arrest)
    growing, constant = excess * distance / fall * np.expm1(t / scale), distance + (excess + fall) / z * (t - kink)
    echo = t - trip
    slip = np.select([t < kink, t < trip], [growing, constant], constant - 2.0 * excess * distance / fall * np.expm1(echo / scale))
    assert exact.slip_m.to_numpy() == pytest.approx(slip, rel=0.0, abs=1e-12 * slip.max())
    moving = exact.time_s.to_numpy() < arrest
    friction = 1.2e8 * np.maximum(0.677 - 0.152 * slip / distance, 0.525)
    assert exact.traction_Pa.to_numpy()[moving] == pytest.approx(friction[moving], rel=1e-12)


@pytest.mark.parametrize("problem", PROBLEMS)
def test_the_header_of_a_series_holds_its_scenario(problem: str, tmp_path: Path) -> None:
    lines = [line for line in (FOLDER / f"{problem}.csv").read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    assert f"code: stickslip {ss.__version__}" in lines[1]
    (tmp_path / "again.toml").write_text("\n".join(line[4:] for line in lines if line.startswith("#   ")), encoding="utf-8")
    again, scenario = ss.load_scenario(tmp_path / "again.toml"), SCRIPT["scenario_of"](problem)
    assert (again.problem, again.duration, again.rtol) == (scenario.problem, scenario.duration, scenario.rtol)
    assert lines[2].startswith(f"# selection rule: {scenario.problem.rule} (")
    assert (FOLDER / f"{problem}.csv").stat().st_size < 100_000


def test_the_table_of_parameters_is_that_of_the_scenarios() -> None:
    """Each cell agrees with the scenario, an empty one is a parameter that is not there, and no parameter of a law lacks a row."""
    text = (ROOT / "docs" / "check-your-own-code.md").read_text(encoding="utf-8")
    names = re.search(r"^\| in SI \|(.*)\|$", text, re.MULTILINE)
    assert names is not None
    assert tuple(name.strip() for name in names[1].split("|")) == PROBLEMS
    rows = re.findall(r"^\| `(\w+)\.(\w+)`[^|]* \|(.*)\|$", text, re.MULTILINE)
    assert len(rows) > 15
    for column, problem in enumerate(PROBLEMS):
        scenario = SCRIPT["scenario_of"](problem)
        tables = tomllib.loads(scenario.to_toml())
        tables["initial"]["excess"] = scenario.problem.excess
        cells = {(table, key): cells.split("|")[column].strip() for table, key, cells in rows}
        for (table, key), cell in cells.items():
            above, _, below = cell.partition("/")
            value = float(above) / float(below or 1.0) if cell else None
            assert tables[table].get(key) == (None if value is None else pytest.approx(value, rel=1e-12)), (problem, key)
        assert set(tables["friction"]) - {"kind", "memory", "counts"} <= {key for table, key in cells if table == "friction"}
