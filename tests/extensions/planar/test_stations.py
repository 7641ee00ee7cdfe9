"""The motion of a station of a contact of many nodes, as a table and in the layout of the SCEC."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.solution import PlanarSolution
from stickslip.extensions.planar.stations import node_at
from stickslip.extensions.schemes.series import read_series
from tests.command_line import Command

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
LAW = ss.friction.LinearSlipWeakening(static=0.7, dynamic=0.5, distance=0.4)
LINE = ss.PlanarSlab(
    ss.Problem(SLAB, LAW, initial_slip=0.5, initial_load=60e6),
    nodes=16,
    length=2e4,
    along={"initial.load": lambda y: 60e6 - 1e3 * y},
)
PLANE = ss.PlanarSlab(ss.Problem(SLAB, LAW, initial_load=60e6), nodes=8, length=8e3, width=8e3, width_nodes=8)


@pytest.fixture(scope="module")
def run() -> PlanarSolution:
    return ss.simulate(LINE, 1.0, frames=40)


@pytest.mark.parametrize("station", [-2500.0, "-2.5 km", "-2600 m", (-2500.0,)])
def test_a_station_is_the_node_that_is_closest_to_it(station: object) -> None:
    assert node_at(LINE, station) == (6,)  # type: ignore[arg-type]
    assert node_at(LINE, None) == (8,)


def test_a_station_on_a_plane_has_two_places() -> None:
    assert node_at(PLANE, "1 km, -4 km") == (5, 0)
    assert node_at(PLANE, (1e3, "1 km")) == (5, 5)


@pytest.mark.parametrize(
    ("slab", "station", "message"),
    [
        (LINE, "11 km", "station: y = 11000 m has no node: nodes lie from -10 km to 8.75 km"),
        (LINE, "1 km, 2 km", 'station: needs y, as in "8 km", got 2 numbers'),
        (PLANE, 0.0, 'station: needs y and z, as in "8 km, 0 km", got 1 number'),
        (LINE, "far", "station: y must be a number in m or a text with a unit"),
    ],
)
def test_a_station_that_is_not_there_is_refused(slab: ss.PlanarSlab, station: object, message: str) -> None:
    with pytest.raises(ss.InputError) as refused:
        node_at(slab, station)  # type: ignore[arg-type]
    assert message in str(refused.value)


def test_the_text_of_the_scec_holds_the_motion_of_the_station(run: PlanarSolution, tmp_path: Path) -> None:
    found = read_series(run.to_scec(tmp_path / "mine.dat", station="-5 km"))
    np.testing.assert_allclose(found.time, run.times, rtol=1e-12)
    np.testing.assert_allclose(found.slip, run.slip[:, 4] - 0.5, rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(found.rate, run.slip_rate[:, 4], rtol=1e-11)
    np.testing.assert_allclose(found.traction, run.traction[:, 4], rtol=1e-11)
    assert "# location=y = -5000 m" in (tmp_path / "mine.dat").read_text().splitlines()


def test_a_table_may_be_of_a_station_and_netcdf_has_all(run: PlanarSolution, tmp_path: Path) -> None:
    rows = np.loadtxt(run.to_csv(tmp_path / "mine.csv", station=-5e3), delimiter=",", skiprows=1)
    np.testing.assert_array_equal(rows[:, 3], run.traction[:, 4])
    with pytest.raises(ss.InputError, match="netCDF has all nodes"):
        run.to_csv(tmp_path / "mine.nc", station=0.0)


def test_the_command_writes_a_station_of_a_folder(command: Command, tmp_path: Path) -> None:
    run = ss.simulate(LINE, 0.2, frames=40, checkpoint=tmp_path / "run.zarr")
    assert command("export", "run.zarr", "mine.txt", "--station", "-5 km").code == 0
    np.testing.assert_allclose(read_series(tmp_path / "mine.txt").traction, run.traction[:, 4], rtol=1e-11)
    refused = command("export", "run.zarr", "mine.txt", "--components")
    assert refused.code == 2
    assert "leave out --components" in refused.err
    refused = command("export", "fig6-slab", "mine.txt", "--station", "0 km")
    assert refused.code == 2
    assert "--station is for the folder of a contact of many nodes" in refused.err
