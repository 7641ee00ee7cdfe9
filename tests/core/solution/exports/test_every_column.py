"""Every column of every file that is written has the numbers of the run in the unit of its heading, for every kind of body."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stickslip as ss
from stickslip.foundation.text_columns import read_file
from stickslip.solution.files.scec import write_scec
from stickslip.solution.observables.event_table import with_units
from stickslip.solution.solution import Solution
from tests.core.solution.exports.every_kind import AREA, KINDS, in_si, parts, run_of


def read_at(run: Solution, name: str, time: np.ndarray) -> tuple[np.ndarray, str]:
    """What a column of this name holds at times, from the run itself, and its SI unit."""
    if name == "time":
        return time, "s"
    if name in ("state", "second state"):
        number = ("state", "second state").index(name)
        return getattr(run, name.replace(" ", "_"))(time), run.problem.friction.states[number].unit
    return getattr(run, name.replace(" ", "_"))(time), run.problem.unit_of(name.replace(" ", "_"))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", KINDS)
def test_curves_as_csv(kind: str, tmp_path: Path) -> None:
    run = run_of(kind)
    table = pd.read_csv(run.to_csv(tmp_path / "a.csv", points=201))
    time = table["time (s)"].to_numpy()
    assert time == pytest.approx(np.linspace(0.0, run.duration, 201), rel=1e-14, abs=0.0)
    names = [parts(heading)[0] for heading in table]
    assert names[:5] == ["time", "slip", "slip rate", "load", "traction"]
    at_driver = ["drive rate", "surface torque"] if "string" in kind else []
    assert names[5:] == ["state", "second state"][: len(run.problem.friction.states)] + at_driver
    for heading in table:
        name, unit = parts(heading)
        expected, si = read_at(run, name, time)
        assert in_si(unit) == (si, 1.0), heading
        np.testing.assert_array_equal(table[heading].to_numpy(), expected, heading)


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("kind", KINDS)
def test_curves_as_netcdf(kind: str, tmp_path: Path) -> None:
    run = run_of(kind)
    with xr.open_dataset(run.to_csv(tmp_path / "a.nc", sampling_rate=20.0 / run.duration), decode_times=False) as found:
        time = found["time"].to_numpy()
        assert len(time) == 21
        for name in ("slip", "slip_rate", "load", "traction", *("state",) * len(run.problem.friction.states)):
            expected, si = read_at(run, name.replace("_", " "), time)
            assert in_si(found[name].attrs["units"]) == (si, 1.0), name
            np.testing.assert_array_equal(found[name].to_numpy(), expected, name)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if "string" not in kind])
@pytest.mark.parametrize("area", [None, AREA])
def test_text_of_the_scec(kind: str, area: float | None, tmp_path: Path) -> None:
    run = run_of(kind)
    is_block = run.problem.load_unit == "N"
    if area and not is_block:
        with pytest.raises(ss.InputError, match="the loads of a slab are stresses already"):
            write_scec(run, tmp_path / "a.txt", 10.0, area=area)
        return
    rate = 50.0 / run.duration
    lines = write_scec(run, tmp_path / "a.txt", rate, components=True, area=area).read_text(encoding="utf-8").splitlines()
    headings = [line.partition(" = ")[2] for line in lines if line.startswith("# Column #")]
    numbers = np.loadtxt([line for line in lines if not line.startswith("#")][1:]).T
    time, size = numbers[0], area or 1.0
    normal = run.problem.normal_load
    of_run = {
        "Time": (time, "s"),
        "horizontal slip": (run.slip(time) - run.problem.initial_slip, "m"),
        "horizontal slip rate": (run.slip_rate(time), "m/s"),
        "normal": (-(np.full(len(time), run.problem.normal) if normal is None else normal.at(time)) / size, "N"),
        "horizontal shear": (run.traction(time) / size, "N"),
    }
    for heading, values in zip(headings, numbers, strict=True):
        name, unit = parts(heading)
        si, factor = in_si(unit)
        if name.startswith("vertical"):
            assert not values.any()
            continue
        of = re.sub(r" (stress|force)$", "", name)
        expected, own = of_run[of]
        if own == "N":
            own = "Pa" if area or not is_block else "N"
            assert name.endswith("stress" if own == "Pa" else "force")
        assert si == own, heading
        scale = float(np.abs(expected).max())
        np.testing.assert_allclose(factor * values, expected, rtol=1e-11, atol=1e-11 * scale, err_msg=heading)


def of_events(run: Solution, table: pd.DataFrame) -> Iterator[tuple[str, np.ndarray, str]]:
    """What columns of a catalogue hold, from the run itself: name, values and SI unit."""
    start, end, peak = (table[name].to_numpy(float) for name in ("start", "end", "peak_time"))
    over = np.where(np.isnan(end), run.duration, end)
    loads, slip = run.problem.load_unit, run.problem.unit_of("slip")
    slipped = run.slip(over) - run.slip(start)
    yield "slip", slipped, slip
    yield "static_drop", run.problem.body.stiffness * slipped, loads
    speed = np.maximum(np.abs(run.slip_rate(peak)), np.abs(run.slip_rate(peak, side="left")))
    yield "peak_rate", speed, f"{slip}/s"
    whole = np.isfinite(end)
    yield "duration", np.where(whole, end - start, np.nan), "s"
    yield "traction_drop", (table.traction_before - table.traction_after).to_numpy(), loads


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("kind", KINDS)
def test_slip_events_in_every_file(kind: str, tmp_path: Path) -> None:
    """In the table, with units in its headings, and in the file of the run; a slip back is negative."""
    run = run_of(kind)
    table = run.events
    with xr.open_dataset(run.to_netcdf(tmp_path / "run.nc"), decode_times=False) as kept:
        headed = with_units(table, run.problem.load_unit)
        for name, expected, si in of_events(run, table):
            heading = next(one for one in headed if parts(one)[0] == name)
            assert parts(heading)[1] == si
            scale = float(np.nanmax(np.abs(expected), initial=0.0))
            np.testing.assert_allclose(headed[heading].to_numpy(float), expected, rtol=1e-6, atol=1e-7 * scale, err_msg=heading)
            if len(table):
                assert in_si(kept[f"event_{name}"].attrs["units"])[0] == si
                np.testing.assert_array_equal(kept[f"event_{name}"].to_numpy(), table[name].to_numpy(), name)


def test_events_to_and_fro_have_signs() -> None:
    """Slip to and fro: the signs of the events add up to the slip of the run; their sizes do not."""
    run = ss.simulate("reversing-axis", 0.3)
    events = run.catalogue(0.0)
    assert (events.slip < 0.0).any()
    assert (events.slip > 0.0).any()
    assert events.slip.sum() == pytest.approx(float(run.slip()), rel=1e-9, abs=1e-15)
    assert events.slip.abs().sum() > 2.0 * abs(float(run.slip()))


@pytest.mark.parametrize("kind", ["block", "slab", "string"])
def test_a_file_of_curves_is_read_back_as_a_record(kind: str, tmp_path: Path) -> None:
    """By the headings alone, in SI: a record of a run is the run."""
    run = run_of(kind)
    shear = {"N": "shear_force", "Pa": "shear_stress", "N m": "torque"}[run.problem.load_unit]
    slip = "slip_angle" if kind == "string" else "slip"
    table = read_file(run.to_csv(tmp_path / "a.csv", points=50), ("time", slip, shear), (10**6, 1000), raw=True)
    np.testing.assert_array_equal(table.columns[slip], run.slip(table.columns["time"]))
    np.testing.assert_array_equal(table.columns[shear], run.traction(table.columns["time"]))


def test_friction_is_drawn_over_the_normal_load_of_its_moment() -> None:
    """Coulomb friction slides at its dynamic coefficient, also after the normal force was halved."""
    run = run_of("block, pressed")
    slides = run.events.start[0] + 0.5 * run.events.duration[0]
    axes = run.plot.friction(start=float(run.events.start[0]) + 1e-6, end=slides).axes[0]  # type: ignore[union-attr]
    line = next(one for one in axes.get_lines() if len(one.get_xdata()) > 100)
    assert np.asarray(line.get_ydata(), float) == pytest.approx(0.4, rel=1e-9)


@pytest.mark.parametrize("kind", ["slab", "block"])
def test_the_text_of_the_scec_is_read_back_in_its_unit(kind: str, tmp_path: Path) -> None:
    """As a record, too: its heading "shear-stress" has no unit, which is MPa by the layout."""
    run = run_of(kind)
    shear = "shear_stress" if kind == "slab" else "shear_force"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = read_file(run.to_scec(tmp_path / "a.txt", 10.0), ("time", "slip", "slip_rate", shear), (10**6, 1000), raw=True)
    time = table.columns["time"]
    np.testing.assert_allclose(table.columns[shear], run.traction(time), rtol=1e-11)
    np.testing.assert_allclose(table.columns["slip_rate"], run.slip_rate(time), rtol=1e-11)
