"""`stickslip sweep` on a cluster, drawn, and what its summary says of changes."""

from collections.abc import Iterator

import numpy as np
import pytest
import xarray as xr

from stickslip.extensions.sweeps.execution import cluster
from stickslip.extensions.sweeps.summary import ChangeAlongKey, cases, changes

MAP = ["sweep", "fig6-slab", "-v", "friction.alpha=0.1..0.4:3", "-v", "body.normal_stress=50MPa..200MPa:3"]


def test_chunks_that_a_cluster_lost_are_reported(command, monkeypatch: pytest.MonkeyPatch):
    def lose(work: object, chunks: object) -> Iterator[object]:
        raise cluster.ChunksLostError("sweep: the dask scheduler is lost")
        yield

    monkeypatch.setattr("stickslip.extensions.sweeps.sweep.on_threads", lambda threads: lose)
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
