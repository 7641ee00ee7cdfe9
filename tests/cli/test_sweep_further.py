"""`stickslip sweep` on a cluster, drawn, and what its summary says of changes."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from stickslip.cli.output.sweep_summary import ChangeAlongKey, cases, changes
from stickslip.sweeps.execution import cluster

MAP = ["sweep", "fig6-slab", "-v", "friction.alpha=0.1..0.4:3", "-v", "body.normal_stress=50MPa..200MPa:3"]


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
        (["-q", "pulse"], "sweep: quantity 'pulse' is unknown; did you mean 'pulses'?"),
        (["--scheduler", "nowhere"], "sweep: no dask scheduler answers at nowhere"),
        (["--workers", "0"], "sweep: workers must be 1 or more, got 0"),
        (["--workers", "2", "--threads", "2"], "sweep: give one of threads, workers"),
    ],
)
def test_impossible_sweeps_are_refused_in_one_line(command, options: list[str], message: str):
    shown = command(*MAP[:4], "-v", "body.normal_stress=50MPa,100MPa", *options)
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


def small() -> xr.Dataset:
    counts = [[1.0, 1.0, np.nan], [1.0, 2.0, 3.0]]
    return xr.Dataset(
        {"pulses": (("a", "b"), counts), "slip": (("a", "b"), np.arange(6.0).reshape(2, 3) + 0.5)},
        {"a": [1.0, 2.0], "b": [5.0, 6.0, 9.0]},
    )


def test_changes_are_between_neighbours_that_differ() -> None:
    assert cases(small(), "pulses") == {1.0: 3, 2.0: 1, 3.0: 1}
    assert changes(small(), "pulses") == [ChangeAlongKey("a", 1, 1.0, 2.0), ChangeAlongKey("b", 2, 5.0, 9.0)]
    assert changes(small().isel(b=[0]), "pulses") == []


def test_a_quantity_that_is_no_count_has_no_cases() -> None:
    assert cases(small(), "slip") == {}
    assert cases(xr.Dataset({"many": ("a", np.arange(100.0))}), "many") == {}
