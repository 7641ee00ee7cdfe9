"""The folder that `stickslip paper` writes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
import xarray as xr

from stickslip.foundation.atomic_write import write_atomically
from stickslip.paper import make
from stickslip.reports.page import save_text


def test_every_file_is_there_and_nothing_else(folder: Path) -> None:
    expected = {f"figure{n}.{kind}" for n in range(1, 8) for kind in ("png", "svg", "nc")}
    expected |= {f"{name}.csv" for name in ("cases", "events", "shocks", "claims", "constants")} | {"report.html"}
    assert {path.name for path in folder.iterdir()} == expected


@pytest.mark.parametrize("number", range(1, 8))
def test_data_reopen_with_units(number: int, folder: Path) -> None:
    dataset = xr.load_dataset(folder / f"figure{number}.nc", engine="h5netcdf")
    assert dataset.attrs["source"].startswith("stickslip ")
    assert dataset.attrs["Conventions"].startswith("CF-")
    numeric = [v for v in dataset.variables.values() if v.dtype.kind == "f"]
    assert numeric
    assert all("units" in v.attrs for v in numeric)


def test_svg_has_no_date(folder: Path) -> None:
    assert "dc:date" not in (folder / "figure5.svg").read_text(encoding="utf-8")


def test_tables_reopen(folder: Path) -> None:
    claims = pd.read_csv(folder / "claims.csv")
    assert set(claims.number) == set(range(1, 21))
    shocks = pd.read_csv(folder / "shocks.csv")
    assert set(shocks.columns) >= {"case", "time [s]", "cause", "rate_before [m/s]", "rate_after [m/s]"}
    events = pd.read_csv(folder / "events.csv")
    assert "start [s]" in events.columns


@pytest.mark.slow
def test_a_second_run_writes_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    make(tmp_path)
    for path in folder.iterdir():
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), path.name


def test_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    path = save_text(tmp_path / "table.csv", "old")

    def fail(partial: Path) -> None:
        partial.write_text("half")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_atomically(path, fail)
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["table.csv"]


def test_importing_the_package_imports_no_plotting() -> None:
    code = "import sys, stickslip, stickslip.paper; print('matplotlib' in sys.modules, 'jinja2' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]
