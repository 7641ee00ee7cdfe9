"""Converged series at stations of a fault: their order and band, and which series of other programs pass."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.extensions.schemes import benchmarks, planar_series
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.planar_series import FAULT, STATIONS, Station, StationSeries, converged, of_faults, on_mesh
from stickslip.foundation.arrays import Floats
from tests.command_line import Command

QUICK = (160, 320, 640)
"""Meshes of the quick tests: the edges of the nucleus and the barriers are nodes."""


def ramp(distance: float) -> Station:
    """Slip of 0.5 (t - a)^2 from a front at a = 1 s on, which a mesh with this distance between nodes has late and too fast."""
    time = np.linspace(0.0, 4.0, 4001)
    since = np.maximum(time - 1.0 - 0.5 * distance, 0.0)
    grown = 1.0 + 0.3 * distance
    return Station(time, np.stack([0.5 * grown * since**2, grown * since, 5.0 - grown * since]))


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(planar_series, "MESHES", QUICK)
    for one in of_faults():
        monkeypatch.setitem(benchmarks.BENCHMARKS, one.name, one)


def test_series_of_order_one_are_extrapolated_to_the_right_one_within_its_band() -> None:
    found, right = converged([ramp(distance) for distance in (0.1, 0.05, 0.025)]), ramp(0.0)
    arrives = 1.0 + np.sqrt(2.0 * planar_series.ARRIVED)
    assert abs(float(found.arrival) - arrives) <= float(found.arrival_band) < 1e-3
    assert abs(float(found.peak_rate) - 3.0) <= float(found.peak_rate_band) < 1e-2
    assert found.order_of_slip == pytest.approx(1.0, abs=0.05)
    for row, name in enumerate(("slip", "slip_rate", "traction")):
        off = np.abs(found[name].to_numpy() - np.interp(found.time, right.time, right.fields[row]))
        assert (off <= found[f"{name}_band"].to_numpy() + 1e-3).all()
        assert off[found.time < 3.9].max() < 5e-3  # the meshes end at 4 s, whatever their fronts are


def test_a_station_that_never_slips_has_no_front() -> None:
    time = np.linspace(0.0, 1.0, 5)
    arrival, peak, arrest = Station(time, np.zeros((3, 5))).key
    assert np.isnan([arrival, arrest]).all()
    assert peak == 0.0


@pytest.mark.parametrize(("station", "tolerance"), [("0km", 0.01), ("8km", 0.01), ("16km", 0.12)])
def test_a_right_coarse_series_passes_and_a_late_front_does_not(station: str, tolerance: float) -> None:
    """The coarse one has nodes at 125 m, and a low peak at 16 km; 2 % late are 0.04 s at 8 km and 0.09 s at 16 km."""
    name, own = f"{FAULT}-{station}", on_mesh(QUICK[1])[list(STATIONS).index(station)]
    assert _judged(own.time, own.fields, name, tolerance).passed
    right = benchmarks.exact_series(name)
    fields = np.stack([right[one] for one in ("slip", "slip_rate", "traction")])
    assert _judged(right.time.to_numpy(), fields, name, tolerance=5e-3).passed
    late = Station(right.time.to_numpy(), fields).at(right.time.to_numpy(), 0.02 * float(right.arrival))
    judged = _judged(right.time.to_numpy(), late, name, tolerance)
    assert not judged.passed
    assert judged.table.set_index("quantity").share["front arrival"] > 0.01


def _judged(time: Floats, fields: Floats, name: str, tolerance: float) -> StationSeries:
    found = ss.studies.judge_series(Series(time, *fields, "mine"), name, tolerance=tolerance)
    assert isinstance(found, StationSeries)
    return found


@pytest.mark.slow
def test_a_finer_mesh_lies_within_the_band() -> None:
    """The band is that of three meshes up to 320 nodes, and what is right the extrapolation of 320 and 640."""
    for n, station in enumerate(STATIONS):
        found = converged([on_mesh(nodes)[n] for nodes in (80, 160, 320)])
        finer = converged([on_mesh(nodes)[n] for nodes in QUICK])
        assert 0.4 < finer.order_of_slip < 1.3
        for name in ("slip", "slip_rate", "traction"):
            inside = np.abs(found[name] - finer[name]) <= found[f"{name}_band"] + 1e-9 * np.abs(found[name]).max()
            assert float(inside.mean()) > 0.9, (station, name)


def test_the_command_judges_a_series_in_the_layout_of_the_scec(command: Command, tmp_path: Path) -> None:
    assert f"{FAULT}-8km" in command("benchmark", "list").out
    command("benchmark", "get", f"{FAULT}-8km")
    with xr.open_dataset(tmp_path / f"{FAULT}-8km.nc") as right:
        rows = np.column_stack([right.time, right.slip, right.slip_rate, 1e-6 * right.traction])
    np.savetxt("mine.dat", rows, header="t slip slip-rate shear-stress", comments="")
    judged = command("benchmark", "judge", "mine.dat", "--name", f"{FAULT}-8km", "--tolerance", "0.005", "--out", "table.csv")
    assert judged.code == 0
    assert "front arrival" in (tmp_path / "table.csv").read_text()
    assert "meshes of 160, 320, 640 nodes" in judged.out


@pytest.mark.slow
def test_a_mesh_beyond_those_of_the_benchmark_lies_within_its_band(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    for n, station in enumerate(STATIONS):
        found = converged([on_mesh(nodes)[n] for nodes in planar_series.MESHES])
        finer = converged([on_mesh(nodes)[n] for nodes in (640, 1280, 2560)])
        for name in planar_series.KEY_TIMES:
            assert abs(float(found[name]) - float(finer[name])) <= 1.5 * float(found[f"{name}_band"]) + 2e-4, (station, name)
        for name in ("slip", "slip_rate", "traction"):
            inside = np.abs(found[name] - finer[name]) <= found[f"{name}_band"] + 1e-6 * np.abs(found[name]).max()
            assert float(inside.mean()) > 0.95, (station, name)
