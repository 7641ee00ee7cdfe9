"""`stickslip sweep` on a cluster, refined, and drawn."""

from collections.abc import Iterator
from pathlib import Path

import pytest
import xarray as xr

from stickslip.sweeps.execution import cluster

MAP = ["sweep", "fig6-slab", "-v", "friction.alpha=0.1..0.4:3", "-v", "body.normal_stress=50MPa..200MPa:3"]


def test_sweep_refines_and_draws(command, tmp_path: Path):
    shown = command(*MAP, "-q", "events", "--refine", "irregular", "--depth", "2", "--out", "map.zarr", "--figure", "map.png")
    assert (shown.code, shown.err) == (0, "")
    with xr.open_zarr("map.zarr") as found:
        assert set(found) == {"events", "irregular", "status", "reason"}
        assert int(found.level.max()) == 2
        assert f"{found.sizes['member']} members of a refined map over friction.alpha, body.normal_stress" in shown.out
        assert 9 < found.sizes["member"] < 81
    assert shown.out.endswith("written: map.zarr\nwritten: map.png\n")
    assert {path.name for path in tmp_path.iterdir()} == {"map.zarr", "map.png"}
    assert command(*MAP, "-q", "events", "--refine", "irregular", "--depth", "2", "--out", "map.zarr").code == 0


def test_sweep_draws_a_grid(command, tmp_path: Path):
    five = ["-v", "friction.alpha=0.1..0.4:5", "-v", "body.normal_stress=50MPa..200MPa:5"]
    assert command("sweep", "fig6-slab", *five, "--figure", "map.svg").code == 0
    drawn = (tmp_path / "map.svg").read_text()
    assert "<svg" in drawn
    assert "<image" in drawn  # the map itself, as pixels


def test_sweep_draws_axes_of_words(command):
    """Three selection rules along an axis of maps, which a parameter with two values tells apart."""
    three = ["-v", "run.selection=perfect-delay,minimal,maximal", "-v", "friction.alpha=0.1..1:2", "-v", "thickness=5km..10km:5"]
    shown = command("sweep", "fig6-slab", *three, "-q", "slip", "--figure", "map.png")
    assert (shown.code, shown.err) == (0, "")
    assert shown.out.endswith("written: map.png\n")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--figure", "map.bmp"], "--figure map.bmp: the name must end in .png or .pdf or .svg"),
        (["--refine", "pulse"], "sweep: quantity 'pulse' is unknown; did you mean 'pulses'?"),
        (["--refine", "slip"], "refine: slip is not a whole number: give the factor by which it must change"),
        (["--refine", "pulses", "--dry-run"], "sweep: --refine needs a grid of --vary"),
        (["--refine", "pulses", "--design", "lhs", "-m", "4"], "sweep: --refine needs a grid of --vary"),
        (["--refine", "pulses", "--depth", "-1"], "refine: depth must be a whole number, 0 or more, got -1"),
        (["--scheduler", "nowhere"], "sweep: no dask scheduler answers at nowhere"),
        (["--workers", "0"], "sweep: workers must be 1 or more, got 0"),
        (["--workers", "2", "--threads", "2"], "sweep: give one of threads, workers"),
    ],
)
def test_impossible_sweeps_are_refused_in_one_line(command, options: list[str], message: str):
    shown = command(*MAP[:4], "-v", "body.normal_stress=50MPa,100MPa", *options)
    if "lhs" in options:
        shown = command("sweep", "fig6-slab", "-v", "alpha=0.1..1", *options)
    assert shown.code == 2
    assert shown.err.startswith(f"stickslip: {message}")
    assert len(shown.err.splitlines()) == 1


def test_chunks_that_a_cluster_lost_are_reported(command, monkeypatch: pytest.MonkeyPatch):
    def lose(work: object, chunks: object) -> Iterator[object]:
        raise cluster.ChunksLostError("sweep: the dask scheduler is lost")
        yield

    monkeypatch.setattr("stickslip.sweeps.sweep.on_threads", lambda threads: lose)
    shown = command(*MAP, "--out", "map.zarr")
    assert (shown.code, shown.err) == (1, "stickslip: sweep: the dask scheduler is lost\n")
    with xr.open_zarr("map.zarr") as found:
        assert (found.status == -1).all()
