"""`stickslip sweep` says what it did, what it would do, and what it cannot do."""

import re
from pathlib import Path

import pytest
import xarray as xr
from typer import Context

from stickslip.cli.options import complete_axis, complete_vary
from stickslip.extensions.sweeps.command import complete_design, complete_quantity, complete_series
from stickslip.extensions.sweeps.results.store import ResultStore
from stickslip.extensions.sweeps.sweep import SweepProgress

MAP = ["sweep", "fig6-slab", "--vary", "friction.alpha=0.1..1:4", "--vary", "thickness=5km,10km"]


def test_sweep_says_what_came_of_it(command):
    shown = command(*MAP, "--out", "map.zarr")
    assert (shown.code, shown.err) == (0, "")
    assert "4 x 2 = 8 members over friction.alpha, body.thickness" in shown.out
    assert "\n8 finished\n" in shown.out
    assert "events: 0 in 2 members, 1 in 6; changes along friction.alpha between 0.1 s/m and 0.4 s/m" in shown.out
    assert shown.out.endswith("written: map.zarr\n")
    with xr.open_zarr("map.zarr") as found:
        assert found.events.values.tolist() == [[0, 0], [1, 1], [1, 1], [1, 1]]


def test_sweep_accepts_quantities_series_and_tables(command, tmp_path: Path):
    (tmp_path / "members.csv").write_text("friction.alpha,thickness\n1,1 km\n0.5 s/m,2 km\n")
    asked = ["--list", "members.csv", "-q", "slip", "-q", "heat", "--series", "slip, load", "--samples", "7", "--out", "list.zarr"]
    shown = command("sweep", "fig6-slab", *asked)
    assert shown.code == 0
    assert "2 members from a list over friction.alpha, body.thickness" in shown.out
    with xr.open_zarr("list.zarr") as found:
        assert set(found) == {"slip", "heat", "series_slip", "series_load", "status", "reason"}
        assert found["body.thickness"].values.tolist() == [1000.0, 2000.0]
        assert found.sizes == {"member": 2, "time": 7}


def test_words_are_varied_in_a_grid_that_continues_and_in_a_table(command, tmp_path: Path):
    rules = ["perfect-delay", "minimal", "maximal"]
    grid = ["sweep", "fig6-slab", "-v", f"run.selection={','.join(rules)}", "-v", "alpha=0.1,1", "-v", "thickness=5km,10km"]
    first = command(*grid, "-q", "slip", "--out", "map.zarr", "--chunk", "4")
    assert first.code == 0
    assert "3 x 2 x 2 = 12 members over run.selection, friction.alpha, body.thickness" in first.out
    again = command(*grid, "-q", "slip", "--out", "map.zarr", "--chunk", "4", "--figure", "map.png")
    assert again.out == f"{first.out}written: map.png\n"
    (tmp_path / "members.csv").write_text("run.selection,alpha\n" + "".join(f"{rule},1\n" for rule in rules))
    assert (
        command("sweep", "fig6-slab", "--list", "members.csv", "-q", "slip", "--out", "list.zarr", "--figure", "list.png").code == 0
    )
    with xr.open_zarr("map.zarr") as found, xr.open_zarr("list.zarr") as listed:
        assert found["run.selection"].values.tolist() == listed["run.selection"].values.tolist() == rules
        assert found.slip.sel({"friction.alpha": 1.0, "body.thickness": 10e3}).values.tolist() == listed.slip.values.tolist()


def test_sweep_draws_samples(command):
    shown = command("sweep", "fig6-slab", "-v", "alpha=0.1..1:log", "--design", "lhs", "-m", "6", "--seed", "3")
    assert shown.code == 0
    assert "6 members drawn as a Latin hypercube over friction.alpha" in shown.out


def test_numbers_of_the_summary_are_in_the_unit_above_them(command):
    out = command("sweep", "fig6-slab", "-v", "alpha=1", "-q", "first_traction_drop", "-q", "slip", "--out", "one.zarr").out
    with xr.open_zarr("one.zarr") as found:
        drop = float(found.first_traction_drop.values.item())
    assert f"{drop / 1e6:.6g}" in re.search(r"^first_traction_drop .*MPa.*$", out, re.MULTILINE)[0]


@pytest.mark.parametrize(("masses", "told"), [("0,1e6", True), ("1e5,1e6", False)])
def test_a_map_says_where_members_without_mass_start_in_another_way(command, masses: str, told: bool):
    shown = command(
        "sweep", "rate-and-state-slab", "-v", f"contact_mass={masses}", "--set", "duration=0.1 s", "-q", "slip", "--out", "m.zarr"
    )
    assert (
        shown.code,
        "note: without contact_mass the slab behind the contact starts from rest" in " ".join(shown.out.split()),
    ) == (0, told)


def test_a_duration_is_typed_as_for_a_run(command):
    shown = command("sweep", "fig6-slab", "--vary", "friction.alpha=0.1,1", "-q", "slip", "--duration", "1 s", "--out", "map.zarr")
    assert shown.code == 0
    with xr.open_zarr("map.zarr") as found:
        assert found.slip.values[1] == pytest.approx(4.102, rel=1e-3)


def test_a_sweep_that_is_stopped_before_anything_is_finished_draws_and_tells_nothing(command, monkeypatch: pytest.MonkeyPatch):
    def stopped(store: ResultStore):
        raise KeyboardInterrupt

    monkeypatch.setattr(ResultStore, "missing", stopped)
    shown = command(*MAP, "--figure", "map.png")
    assert (shown.code, shown.out, shown.err) == (130, "", "stickslip: interrupted\n")
    assert not Path("map.png").exists()


def test_a_dry_run_writes_nothing(command, tmp_path: Path):
    shown = command(*MAP, "--out", "map.zarr", "--dry-run")
    assert shown.code == 0
    assert shown.out.endswith("4 x 2 = 8 members over friction.alpha, body.thickness, in the compiled batch\n")
    curves = command(*MAP, "--series", "slip", "--dry-run").out
    assert curves.endswith("over friction.alpha, body.thickness, one by one (curves over time need whole solutions)\n")
    assert list(tmp_path.iterdir()) == []


def test_failures_are_counted_with_their_reasons(command):
    shown = command("sweep", "fig6-slab", "-v", "loading.far_stress_rate=0,1,2")
    assert shown.code == 0
    assert "1 finished\n2 bad parameters\n  2: member: [loading] far_stress and far_stress_rate need a slab" in shown.out
    assert command("sweep", "fig6-slab", "-v", "loading.far_stress_rate=1,2").code == 1


def test_progress_is_shown_in_one_line():
    assert str(SweepProgress(0, 0, 100, float("nan"), float("nan"))) == "0 of 100 members"
    assert str(SweepProgress(0, 0, 100, 0.0, float("nan"))) == "0 of 100 members"
    assert str(SweepProgress(50, 2, 100, 12.5, 240.0)) == "50 of 100 members, 12.5 a second, 4 min left, 2 failed"


def test_keys_quantities_and_designs_are_completed():
    from typer.main import get_command

    from stickslip.cli.app import app

    context = Context(get_command(app))
    context.params = {"scenario": "fig6-slab"}
    assert complete_vary(context, "friction.") == ["friction.static=", "friction.dynamic=", "friction.alpha="]
    context.params = {"scenario": "no such"}
    assert complete_vary(context, "friction.") == []
    context.params = {"scenario": "fig6-slab"}
    assert complete_axis(context, "friction.") == ["friction.static=", "friction.dynamic=", "friction.alpha="]
    assert complete_axis(context, "friction.al") == ["friction.alpha=", "friction.alpha=LOW..HIGH"]
    assert complete_axis(context, "run.") == []
    assert complete_series("sl") == ["slip", "slip_rate"]
    assert complete_series("slip,") == ["slip,slip_rate", "slip,traction", "slip,load"]
    assert complete_quantity("recu") == ["recurrence", "recurrence_cv"]
    assert complete_design("") == ["grid", "random", "lhs"]
