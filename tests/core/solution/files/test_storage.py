"""Solutions on disk: bit for bit, whole or absent, with their provenance."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import Variable, read_tables, seal, write, write_variables
from tests.problems import MODULUS, SLAB, rate_law_slab, slip_law_block, slip_law_slab

RUNS = {
    "slab, rate law, leap": (rate_law_slab(), 480 * ss.YEAR),
    "slab, slip law": (slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0),
    "block": (slip_law_block(5.0, MODULUS * 1e3), 5.0),
    "lossy slab": (
        ss.Problem(
            ss.ElasticSlab(2800, 3500, 1e4, 1e8, driver_impedance=1e6),
            ss.friction.LinearSlipWeakening(0.8, 0.3, 0.1),
            initial_excess=1e5,
            far_stress=8.1e7,
            far_stress_rate=10.0,
        ),
        30.0,
    ),
}


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", RUNS)
def test_round_trip_is_bit_identical(name: str, tmp_path: Path) -> None:
    run = ss.simulate(*RUNS[name])
    back = ss.open_solution(run.to_netcdf(tmp_path / "run.nc"))
    assert back.problem == run.problem
    assert (back.duration, back.rtol, back.status) == (run.duration, run.rtol, run.status)
    times = np.linspace(0.0, run.duration, 101)
    for quantity in ("slip", "slip_rate", "traction", "load"):
        assert np.array_equal(getattr(back, quantity)(times), getattr(run, quantity)(times)), quantity
    assert back.events.equals(run.events)
    assert back.shocks.equals(run.shocks)
    again = back.to_netcdf(tmp_path / "again.nc")
    assert again.read_bytes() == (tmp_path / "run.nc").read_bytes()


def test_arrays_make_the_file_of_their_dataset(tmp_path: Path) -> None:
    """xarray and h5netcdf write netCDF independently; solutions are written without them, because that takes long."""
    variables = {
        "time": Variable(("time",), np.linspace(0.0, 1.0, 5), {"units": "s"}),
        "slip": Variable(("time", "piece"), np.array([[np.nan, 1.5]] * 5), {"units": "m", "long_name": "slip, µ"}),
        "pieces": Variable(("piece",), np.arange(2), {}),
        "cause": Variable(("shock",), np.array(["start", "écho", ""]), {"units": "", "of": ["a", "wave"]}),
        "none": Variable(("no_shock",), np.empty(0), {"units": "Pa"}),
        "words": Variable(("no_shock",), np.array([], dtype=str), {}),
        "reached": Variable((), 12.0, {"units": "s"}),
    }
    attributes = {"title": "a run", "status_ok": 1, "rtol": 1e-10}
    ours = write_variables(variables, attributes, tmp_path / "ours.nc")
    other = write(xr.Dataset({name: tuple(one) for name, one in variables.items()}, attrs=attributes), tmp_path / "other.nc")
    xr.testing.assert_identical(*(xr.load_dataset(path, engine="h5netcdf") for path in (ours, other)))
    assert stored(ours) == stored(other)


PLACES = ("_NCProperties", "_Netcdf4Coordinates", "_Netcdf4Dimid", "DIMENSION_LIST", "REFERENCE_LIST")
"""Who wrote the file; addresses of dimensions, `stored` follows them, and what a reader may know without a look at them."""


def stored(path: Path) -> dict[str, object]:
    """Return for each table in the file, in its order, the type, the shape, how far it may grow, its dimensions and attributes."""

    def about(attributes: h5py.AttributeManager) -> dict[str, str]:
        return {name: repr((value, attributes.get_id(name).dtype)) for name, value in attributes.items() if name not in PLACES}

    with h5py.File(path) as file:
        scales = {name: one.attrs["_Netcdf4Dimid"] for name, one in file.items() if one.is_scale}
        tables = {
            name: (one.dtype.str, one.shape, one.maxshape, [axis.keys() for axis in one.dims if len(axis)], about(one.attrs))
            for name, one in file.items()
        }
        return {"scales": sorted(scales, key=scales.__getitem__), "tables": repr(sorted(tables.items())), **about(file.attrs)}


def test_tables_of_a_run_are_read_as_xarray_reads_them(tmp_path: Path) -> None:
    path = ss.simulate(rate_law_slab(), 12.0).to_netcdf(tmp_path / "run.nc")
    tables = read_tables(path)
    with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as file:
        assert set(tables.variables) == set(file.variables)
        assert tables.attrs == file.attrs
        for name, one in file.variables.items():
            ours = tables.variables[str(name)]
            assert (ours.dims, dict(ours.attrs)) == (one.dims, one.attrs), name
            assert np.array_equal(ours.values, one.values, equal_nan=one.dtype.kind == "f"), name
        assert {name: tables.sizes[str(name)] for name in file.sizes} == dict(file.sizes)


def test_a_dimension_of_several_lengths_is_refused(tmp_path: Path) -> None:
    with h5py.File(path := tmp_path / "two.nc", "w") as file:
        file["x"], file["y"], file["z"] = np.arange(3.0), np.arange(3.0), np.arange(2.0)
        file["x"].make_scale("x")
        for name in ("y", "z"):
            file[name].dims[0].attach_scale(file["x"])
    seal(path)
    with pytest.raises(InputError, match="'x' is of several lengths in it"):
        read_tables(path)


def test_file_holds_scenario_and_provenance(tmp_path: Path) -> None:
    path = ss.simulate(rate_law_slab(), 12.0).to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(path, engine="h5netcdf") as file:
        assert file.attrs["source"] == f"stickslip {ss.__version__}"
        assert file.attrs["selection_rule"] == "perfect-delay"
        assert "depends on the rule" in file.attrs["selection_note"]
        assert (file.attrs["selection_regime"], file.attrs["selection_decided_shocks"]) == ("irregular", 0)
        assert 'kind = "hyperbolic-rate"' in file.attrs["scenario"]
        assert file.attrs["rtol"] == 1e-10
        assert {name: file[name].attrs["units"] for name in ("time", "slip", "slip_rate", "traction", "load")} == {
            "time": "s",
            "slip": "m",
            "slip_rate": "m s-1",
            "traction": "Pa",
            "load": "Pa",
        }
        assert float(file.slip[-1]) == pytest.approx(23.4402332474, rel=1e-10, abs=0.0)
        assert list(file.shock_cause.values) == ["start", "echo"]


def test_run_without_events_is_saved_too(tmp_path: Path) -> None:
    run = ss.simulate(ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), initial_load=1e6), 10.0)
    assert len(ss.open_solution(run.to_netcdf(tmp_path / "still.nc")).events) == 0


def test_writing_into_a_missing_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ss.InputError, match="cannot be written"):
        ss.simulate(rate_law_slab(), 1.0).to_netcdf(tmp_path / "missing" / "run.nc")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("content", [b"", b"not a netCDF file"])
def test_files_that_are_not_solutions_are_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "wrong.nc"
    path.write_bytes(content)
    with pytest.raises(ss.InputError, match=r"wrong\.nc: not a netCDF file"):
        ss.open_solution(path)


def test_other_netcdf_files_are_refused(tmp_path: Path) -> None:
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(ss.InputError, match="not a solution"):
        ss.open_solution(tmp_path / "other.nc")
