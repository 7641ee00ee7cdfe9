"""Members that another library has chosen, in every form that holds them, are run as those of the package's own designs."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pint
import pytest
import xarray as xr

import stickslip as ss
from stickslip.extensions.sweeps.design.design import read_design
from stickslip.extensions.sweeps.sweep import SweepProgress
from stickslip.problem.scenarios import Scenario
from tests.extensions.sweeps.stores import files
from tests.messages import refused

SLAB = ss.load_scenario("fig6-slab")
NAMES = ["alpha", "body.thickness"]
MEMBERS = np.array([[0.5, 1e4], [1.0, 2e4], [0.1, 5e3], [0.5, 1e4]])
UREG = pint.get_application_registry()


def csv(folder: Path, content: str) -> Path:
    path = folder / "members.csv"
    path.write_text(content)
    return path


class OfOthers:
    """A table of a library that is not pandas: it has named columns, and one is found by its name."""

    columns = NAMES

    def __getitem__(self, name: str) -> list[float]:
        return [float(one) for one in MEMBERS[:, NAMES.index(name)]]


RECORDS = [dict(zip(NAMES, row, strict=True)) for row in MEMBERS.tolist()]
GIVEN: dict[str, tuple[Any, Any]] = {
    "array": (NAMES, MEMBERS),
    "array of texts": (NAMES, MEMBERS.astype(str)),
    "rows": (NAMES, MEMBERS.tolist()),
    "rows with units": (("alpha", "thickness"), [[0.5, "10 km"], ["1 s/m", 2e4], [0.1, "5 km"], [0.5, "1e4 m"]]),
    "names in an array": (np.array(NAMES), MEMBERS),
    "rows one by one": (NAMES, (row for row in MEMBERS.tolist())),
    "DataArray": (NAMES, xr.DataArray(MEMBERS)),
    "DataFrame": (None, pd.DataFrame(MEMBERS, columns=NAMES)),
    "table of others": (None, OfOthers()),
    "structured array": (None, np.array([tuple(row) for row in MEMBERS], dtype=[(name, float) for name in NAMES])),
    "columns": (None, dict(zip(NAMES, MEMBERS.T, strict=True))),
    "columns with units": (None, {"alpha": MEMBERS[:, 0] * UREG.s / UREG.m, "thickness": MEMBERS[:, 1] / 1e3 * UREG.km}),
    "cells with units": (None, {"alpha": MEMBERS[:, 0], "thickness": [10 * UREG.km, "20 km", 5e3, 10 * UREG.km]}),
    "records": (None, RECORDS),
}


@pytest.mark.parametrize("form", GIVEN)
def test_every_form_holds_the_same_members(form: str) -> None:
    design = read_design(SLAB, *GIVEN[form])
    assert (design.kind, design.dims) == ("list", ("member",))
    assert design.names == ("friction.alpha", "body.thickness")
    assert np.array_equal(np.transpose(design.columns), MEMBERS)


def test_a_file_holds_the_same_members(tmp_path: Path) -> None:
    path = csv(tmp_path, "# chosen by hand\nalpha, body.thickness\n0.5,10 km\n1,20 km\n0.1,5000\n0.5,1e4 m\n")
    for given in (path, str(path)):
        assert np.array_equal(np.transpose(read_design(SLAB, None, given).columns), MEMBERS)


def alone(scenario: Scenario, row: Any) -> ss.Solution:
    return ss.simulate(scenario.with_values(dict(zip(NAMES, row, strict=True))))


@pytest.mark.parametrize("series", [(), ("slip", "load")])
def test_each_member_is_the_run_of_its_numbers_bit_for_bit(series: tuple[str, ...]) -> None:
    found = ss.sweep(SLAB, NAMES, design=MEMBERS, quantities=["peak_rate", "first_duration", "end_time"], series=series, samples=9)
    assert found.sizes["member"] == 4
    for i, row in enumerate(MEMBERS):
        run = alone(SLAB, row)
        assert found["friction.alpha"].values[i] == row[0]
        if run.events.empty:
            assert np.isnan([found.peak_rate.values[i], found.first_duration.values[i]]).all()
        else:
            assert found.peak_rate.values[i] == run.events.peak_rate.max()
            assert found.first_duration.values[i] == run.events.duration.iloc[0]
        for curve in series:
            assert np.array_equal(found[f"series_{curve}"].values[i], getattr(run, curve)(np.linspace(0.0, 12.0, 9)))


def test_members_of_an_own_design_given_again_have_the_same_results() -> None:
    vary = {"alpha": (0.1, 1.0), "thickness": (5e3, 2e4)}
    own = ss.sweep(SLAB, vary, design="lhs", members=50)
    again = ss.sweep(SLAB, design={name: own[name].values for name in ("friction.alpha", "body.thickness")})
    assert all(own[name].values.tobytes() == again[name].values.tobytes() for name in own if name != "reason")


def test_a_stopped_sweep_of_given_members_goes_on_and_its_store_is_that_of_one_that_was_not(tmp_path: Path) -> None:
    def stop(progress: SweepProgress) -> None:
        raise KeyboardInterrupt

    asked: dict[str, Any] = {"design": MEMBERS, "quantities": ["slip"], "chunk": 1}
    stopped = ss.sweep(SLAB, NAMES, out=tmp_path / "a.zarr", progress=stop, **asked)
    assert (stopped.status.values == 0).sum() == 1
    ss.sweep(SLAB, NAMES, out=tmp_path / "a.zarr", **asked)
    ss.sweep(SLAB, out=tmp_path / "b.zarr", **(asked | {"design": RECORDS}))
    assert files(tmp_path / "a.zarr") == files(tmp_path / "b.zarr")
    other = np.where(MEMBERS == 1.0, np.nextafter(1.0, 2.0), MEMBERS)
    with refused("was made with other values of friction.alpha"):
        ss.sweep(SLAB, NAMES, out=tmp_path / "a.zarr", **(asked | {"design": other}))


def test_the_command_runs_the_members_of_a_file_and_shows_them(command: Any, tmp_path: Path) -> None:
    csv(tmp_path, "alpha,thickness\n0.5,10 km\n1,20 km\n")
    run = command("sweep", "fig6-slab", "--design", "members.csv", "-q", "slip", "--out", "a.zarr")
    assert (run.code, run.err) == (0, "")
    assert "2 members from a list over friction.alpha, body.thickness" in run.out
    with xr.open_zarr("a.zarr") as found:
        assert found.slip.equals(ss.sweep("fig6-slab", NAMES, design=MEMBERS[:2], quantities="slip").slip)
    assert "2 members from a list" in command("show", "a.zarr", "--csv", "a.csv").out
    assert pd.read_csv("a.csv", comment="#")["body.thickness (m)"].tolist() == [1e4, 2e4]


REFUSED_COMMANDS: list[tuple[list[str], str]] = [
    (["--design", "members.csv", "-v", "alpha=1,2"], "needs either --vary or --list, got --vary and --design members.csv"),
    (["--design", "members.csv", "--list", "members.csv"], "got --list and --design members.csv"),
    (["--design", "other.csv"], "sweep: design other.csv: no such file"),
    (["--design", "members.csv", "-m", "5"], "members belongs to the designs random and lhs"),
    (["--design", "members.tsv", "-v", "alpha=1,2"], "sweep: design 'members.tsv' is unknown"),
]


@pytest.mark.parametrize(("more", "said"), REFUSED_COMMANDS)
def test_the_command_refuses_two_sources_of_members(command: Any, tmp_path: Path, more: list[str], said: str) -> None:
    csv(tmp_path, "alpha\n1\n")
    told: SimpleNamespace = command("sweep", "fig6-slab", *more)
    assert told.code == 2
    assert said in told.err
    assert told.err.count("\n") == 1


BAD: dict[str, tuple[Any, Any, str]] = {
    "unknown name": (["alpa", "thickness"], MEMBERS, "'alpa' is not a parameter of this scenario; did you mean 'alpha'?"),
    "unknown column": (None, {"alpa": [1.0]}, "'alpa' is not a parameter of this scenario; did you mean 'alpha'?"),
    "nan": (NAMES, np.where(MEMBERS == 2e4, np.nan, MEMBERS), "member 1: body.thickness must be finite, got nan"),
    "masked": (NAMES, np.ma.masked_array(MEMBERS, MEMBERS == 2e4), "member 1: body.thickness must be a number"),
    "text": (NAMES, [[1.0, "thick"]], "member 0: body.thickness must be a number in m or a text with a unit"),
    "wrong unit": (NAMES, [[1.0, 1e4], [1.0, "2 s"]], "member 1: body.thickness"),
    "wrong unit of a column": (None, {"alpha": [1.0] * UREG.km}, "'kilometer' does not convert to s/m"),
    "out of range": (NAMES, np.where(MEMBERS == 2e4, -1.0, MEMBERS), "member 1: body.thickness must be greater than 0 m, got -1"),
    "truth": (NAMES, np.ones((2, 2), bool), "member 0: friction.alpha must be a number"),
    "nothing in a cell": (NAMES, [[1.0, None]], "member 0: body.thickness must be a number"),
    "a column too few": (NAMES, MEMBERS[:, :1], "the array has 1 columns, but vary has 2 names"),
    "a column too many": (NAMES[:1], MEMBERS, "the array has 2 columns, but vary has 1 names"),
    "one dimension": (NAMES, MEMBERS[0], "an array must have two dimensions, a row for each member"),
    "three dimensions": (NAMES, np.ones((2, 2, 2)), "an array must have two dimensions"),
    "no rows": (NAMES, MEMBERS[:0], "the table has no members"),
    "empty list": (NAMES, [], "the table has no members"),
    "empty mapping": (None, {}, "the table has no members"),
    "empty DataFrame": (None, pd.DataFrame(), "the table has no members"),
    "a name twice": (["alpha", "friction.alpha"], MEMBERS, "friction.alpha is varied twice"),
    "a column twice": (None, pd.DataFrame(MEMBERS, columns=["alpha", "alpha"]), "friction.alpha is varied twice"),
    "two starts": (["initial.load", "initial.excess"], MEMBERS, "initial.load and initial.excess exclude each other"),
    "no names": (None, MEMBERS, "an array needs the names of its columns: vary must be a list of them, got None"),
    "one name": ("alpha", MEMBERS, "vary must be a list of them, got 'alpha'"),
    "ranges for names": ({"alpha": (0, 1)}, MEMBERS, "vary must be a list of them"),
    "a table for names": (pd.DataFrame(MEMBERS, columns=NAMES), MEMBERS, "vary must be a list of them, got DataFrame"),
    "names twice": (NAMES, pd.DataFrame(MEMBERS, columns=NAMES), "its columns have names of their own: leave out vary"),
    "rows that differ": (NAMES, [[1.0, 2.0], [1.0]], "the rows differ in length"),
    "columns that differ": (None, {"alpha": [1, 2], "thickness": [1]}, "alpha has 2, thickness has 1"),
    "a record with less": (None, [{"alpha": 1, "thickness": 2}, {"alpha": 1}], "member 1 has no 'thickness'"),
    "a record with more": (None, [{"alpha": 1}, {"alpha": 1, "thickness": 2}], "member 1 has 'thickness', which member 0 has not"),
    "a number for a column": (None, {"alpha": 1.0}, "alpha must be a list of values, one for each member, got 1.0"),
    "a number": (NAMES, 5, "must be an array, a DataFrame, a mapping of columns, a list of records, or a CSV file, got 5"),
    "nothing": (None, None, "must be an array, a DataFrame, a mapping of columns, a list of records, or a CSV file, got None"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_members_are_refused_in_one_line(what: str) -> None:
    vary, design, said = BAD[what]
    with refused(said, begins="sweep: design"):
        ss.sweep(SLAB, vary, design=design)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("alpha,alpha\n1,2\n", "friction.alpha is varied twice"),
        ("alpha,thickness\n1\n", "member 0: body.thickness must be a number"),
        ("alpha\n1,2,3\n", "not a table of members"),
        ("alpha\n", "the table has no members"),
        ("", "not a table of members"),
        ("alpha;thickness\n1;2\n", "'alpha;thickness' is not a parameter"),
    ],
)
def test_a_file_that_holds_no_members_is_refused_in_one_line(tmp_path: Path, content: str, said: str) -> None:
    with refused(said, begins="sweep: design"):
        ss.sweep(SLAB, design=csv(tmp_path, content))


def test_an_array_in_place_of_vary_is_told_where_it_belongs() -> None:
    with refused("an array of members is a design, whose columns vary names", begins="sweep: vary must be"):
        ss.sweep(SLAB, MEMBERS)
