"""The series that the page check-your-own-code.md offers for download: what they say, and whether their numbers are right."""

from __future__ import annotations

import math
import re
import runpy
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.reference.method_of_steps import method_of_steps
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
def test_a_smaller_tolerance_gives_the_exact_series(problem: str) -> None:
    """To 1e-11 of the largest slip and slip rate, which is what the page promises."""
    exact, scenario = right_limits(problem), SCRIPT["scenario_of"](problem)
    run, time = ss.simulate(scenario, rtol=1e-13), exact.time_s.to_numpy()
    for own, column in ((run.slip(time) - scenario.problem.initial_slip, "slip_m"), (run.slip_rate(time), "slip_rate_m_per_s")):
        assert np.abs(own - exact[column].to_numpy()).max() <= 1e-11 * exact[column].max()


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
