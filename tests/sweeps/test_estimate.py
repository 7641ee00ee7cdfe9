"""The estimated cost of a sweep is about what it turns out to be."""

from __future__ import annotations

import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from stickslip.sweeps.estimate import estimate
from stickslip.sweeps.execution.plan import make_plan
from stickslip.sweeps.sweep import carry_out, on_threads


@pytest.mark.parametrize("series", [[], ["slip", "slip_rate"]])
def test_cost_is_about_what_it_turns_out_to_be(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, series: list[str]) -> None:
    monkeypatch.setattr("stickslip.sweeps.estimate.LONG_ENOUGH", 0.2)
    vary = {"thickness": np.linspace(5e3, 20e3, 10), "density": np.linspace(2e3, 3e3, 9)}
    plan = make_plan("fig5-slab-reconstructed", vary, series=series, samples=1000)
    monkeypatch.setattr("stickslip.sweeps.estimate.time", SimpleNamespace(perf_counter=time.process_time))  # others share the cores
    found, run = estimate(plan, on_threads(1)), on_threads(1)
    carry_out(plan, tmp_path / "before.zarr", run)  # xarray loads other libraries when it first opens a store
    start = time.process_time()
    carry_out(plan, tmp_path / "map.zarr", run)
    took = time.process_time() - start
    assert (found.members, found.chunks) == (90, 10)
    assert 1 < found.sampled <= 90
    assert found.seconds / 5 < took < found.seconds * 5
    size = sum(path.stat().st_size for path in (tmp_path / "map.zarr").rglob("*") if path.is_file())
    blocks = sum(-(-path.stat().st_size // 4096) for path in (tmp_path / "map.zarr").rglob("*"))
    assert size < found.bytes < 2 * 4096 * blocks


def test_a_sample_counts_its_failures() -> None:
    plan = make_plan("fig6-slab", {"loading.far_stress_rate": np.arange(1.0, 41.0)})
    found = estimate(plan, on_threads(1))
    assert found.failed == found.sampled > 0


def test_what_has_been_compiled_is_not_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first member takes a second, the others nothing."""
    plan, clock = make_plan("fig6-slab", {"friction.alpha": np.linspace(0.1, 2.0, 30)}), [0.0]
    run = on_threads(1)

    def slow_at_first(work, chunks):  # type: ignore[no-untyped-def]
        clock[0] = 1.0
        return run(work, chunks)

    monkeypatch.setattr("stickslip.sweeps.estimate.LONG_ENOUGH", 0.0)
    monkeypatch.setattr("stickslip.sweeps.estimate.time", SimpleNamespace(perf_counter=lambda: clock[0]))
    assert estimate(plan, slow_at_first).seconds == 0.0


def test_workers_share_the_sample_as_they_share_the_sweep(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each chunk takes a millisecond a member, four at a time: 400 members take 0.1 s, and not 0.4 s."""
    plan = make_plan("fig6-slab", {"friction.alpha": np.linspace(0.1, 2.0, 400)})
    seen, clock = [], [0.0]

    def four_at_a_time(work, chunks):  # type: ignore[no-untyped-def]
        shares = [len(values["friction.alpha"]) for _, values in chunks]
        seen.append(shares)
        assert len(shares) <= 4
        clock[0] += 1e-3 * max(shares)
        return iter(())

    monkeypatch.setattr("stickslip.sweeps.estimate.LONG_ENOUGH", 0.04)
    monkeypatch.setattr("stickslip.sweeps.estimate.time", SimpleNamespace(perf_counter=lambda: clock[0]))
    assert estimate(plan, four_at_a_time, 4).seconds == pytest.approx(0.1, rel=0.05, abs=0)
    assert max(map(len, seen)) == 4
