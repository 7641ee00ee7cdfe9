"""Curves of a contact of many nodes have the numbers of the run in the unit of their heading."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stickslip as ss
from tests.core.solution.exports.every_kind import parts


@pytest.mark.slow
def test_curves_of_a_contact_of_many_nodes(tmp_path: Path) -> None:
    scenario = ss.load_scenario("planar-patch")
    slab = replace(scenario.to_solve, nodes=64)
    run = ss.simulate(slab, 1.0)
    table = pd.read_csv(run.to_csv(tmp_path / "a.csv"))
    units = {"time": "s", "slip": "m", "slip rate": "m/s", "traction": "Pa", "heat": "J/m^2"}
    assert [parts(heading) for heading in table] == list(units.items())
    assert float(table["slip (m)"].iloc[-1]) == run.slip[-1, 32]
    with xr.open_dataset(run.to_csv(tmp_path / "a.nc")) as found:
        np.testing.assert_array_equal(found["slip"].to_numpy(), run.slip)
        assert found["heat"].attrs["units"] == "J m-2"
