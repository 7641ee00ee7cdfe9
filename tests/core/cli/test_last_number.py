"""The last number at the shell: slip at the end in the second line, all selection rules in one table, curves as CSV and netCDF."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stickslip as ss
from stickslip.foundation.given import preferred
from tests.command_line import Command


def second(text: str) -> str:
    return text.splitlines()[1]


def test_run_and_show_say_the_last_number_in_their_second_line(command: Command) -> None:
    run = command("run", "reversing-axis", "--duration", "0.3 s", "--out", "a.nc").out
    slip = ss.simulate("reversing-axis", 0.3).reach
    assert second(run) == f"slip at the end {1e6 * slip.end:.8g} um; largest displacement 631.4779 um, at 0.10063 s"
    assert second(command("show", "a.nc").out) == second(run)
    command("run", "reversing-axis", "--duration", "0.3 s", "--catalogue", "a.csv")
    assert second(command("show", "a.csv").out) == second(run)


def test_events_that_slip_back_have_a_sign_in_the_table(command: Command) -> None:
    shown = command("run", "reversing-axis", "--duration", "0.3 s").out
    table = shown.partition("slip events")[2].partition("shocks")[0]
    slips = [float(line.split()[3]) for line in table.splitlines() if re.match(r" *[\d.e-]+ +[\d.e-]+ ", line)]
    assert slips == pytest.approx(ss.simulate("reversing-axis", 0.3).events.slip.to_list()[: len(slips)], rel=1e-4)
    assert min(slips) < 0.0 < max(slips)
    assert "size of slip: mean" in shown


def test_proof_waves_and_predictability_are_one_line_and_all_has_the_rest(command: Command) -> None:
    short, full = command("run", "fig6-slab").out, command("run", "fig6-slab", "--all").out
    lines = [line for line in short.splitlines() if re.search("proven|trapped|predictab", line)]
    assert len(lines) == 1
    for word in ("proven: ", "trapped energy: ", "predictability: throughout", "--all"):
        assert word in lines[0]
    for text in ("\ntrapped energy: ", "\npredictability: echoes multiply", "\nproven: the contact equation holds"):
        assert text in full


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["export", "fig6-slab", "a.txt", "--points", "5"], "--points is for files .csv and .nc, not for .txt"),
        (["export", "fig6-slab", "a.csv", "--area", "1 m^2"], "--area is for files .txt and .dat, not for .csv"),
        (["export", "fig6-slab", "a.txt", "--area", "1 m^2"], "the loads of a slab are stresses already"),
        (["export", "direct-shear-block", "a.txt", "--area", "-1"], "area must be"),
        (["export", "fig6-slab", "a.csv", "--points", "1"], "the number of points must be a whole number above 1, got 1"),
        (["export", "fig6-slab", "a.csv", "--points", "5", "-r", "3"], "give either a sampling rate or a number of points"),
        (["run", "fig6-slab", "--catalogue", "e.csv", "--csv", "a.csv"], "keeps slip events only, no history: leave out --csv"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(command: Command, tmp_path: Path, arguments: list[str], message: str) -> None:
    assert message in command(*arguments).refusal
    assert not [path.name for path in tmp_path.iterdir()]


def test_curves_from_the_shell_are_those_of_the_run(command: Command, tmp_path: Path) -> None:
    run = ss.simulate("fig6-slab")
    made = command("run", "fig6-slab", "--out", "run.nc", "--csv", "run.csv").out
    assert made.endswith("written: run.nc\nwritten: run.csv\n")
    assert command("show", "run.nc", "--csv", "show.csv").out.endswith("written: show.csv\n")
    assert command("export", "run.nc", "export.csv").out == "written: export.csv\n"
    texts = {(tmp_path / f"{name}.csv").read_bytes() for name in ("run", "show", "export")}
    assert len(texts) == 1
    table = pd.read_csv(tmp_path / "run.csv")
    assert list(table) == ["time (s)", "slip (m)", "slip rate (m/s)", "load (Pa)", "traction (Pa)"]
    assert len(table) == 1001
    np.testing.assert_array_equal(table["traction (Pa)"], run.traction(table["time (s)"]))
    assert command("export", "run.nc", "run2.nc", "-n", "11").code == 0
    with xr.open_dataset(tmp_path / "run2.nc", decode_times=False) as found:
        np.testing.assert_array_equal(found["load"], run.load(np.linspace(0.0, 12.0, 11)))
    assert "holds curves of a run, not the run" in command("show", "run2.nc").refusal
    assert command("export", "fig6-slab", "export.csv", "-n", "3").code == 0  # its own file is replaced, a stranger's is not
    (tmp_path / "mine.csv").write_text("time (s),slip (m)\n0,1\n")
    assert "stickslip did not write it" in command("export", "fig6-slab", "mine.csv").refusal


def test_one_event_and_a_catalogue_as_csv(command: Command, tmp_path: Path) -> None:
    command("export", "second-event-maxwell", "late.csv", "--event", "1", "-r", "50")
    late = pd.read_csv(tmp_path / "late.csv")
    window = ss.simulate("second-event-maxwell").window(1)
    np.testing.assert_array_equal(late["slip (m)"], window.event_slip(late["time (s)"]))
    command("run", "direct-shear-block", "--duration", "5 s", "--catalogue", "e.csv")
    command("show", "e.csv", "--csv", "units.csv")
    events = pd.read_csv(tmp_path / "units.csv", comment="#")
    assert {"start (s)", "slip (m)", "peak_rate (m/s)", "traction_drop (N)", "pulses"} <= set(events)
    assert events["slip (m)"].to_list() == ss.simulate("direct-shear-block", 5.0).events.slip.to_list()


def test_units_that_a_command_shows_end_with_it(command: Command) -> None:
    assert "in/s" in command("check", "granite-slab", "--set", "pull_rate=1 in/s").out
    assert preferred("m/s") is None
