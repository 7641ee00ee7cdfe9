"""Refined maps of a scenario: the critical curve in closed form, and searches that are stopped and taken up again."""

from __future__ import annotations

import time
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from zarr.codecs import GzipCodec

import stickslip as ss
from stickslip.contact.critical import margin
from stickslip.sweeps.estimate import estimate
from stickslip.sweeps.execution.plan import make_plan
from stickslip.sweeps.results.refinement_spec import Change, cases, cells_of, changes
from stickslip.sweeps.results.store import open_store, publish
from stickslip.sweeps.sweep import SweepProgress, carry_out, on_threads


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


def small() -> xr.Dataset:
    counts = [[1.0, 1.0, np.nan], [1.0, 2.0, 3.0]]
    return xr.Dataset(
        {"pulses": (("a", "b"), counts), "slip": (("a", "b"), np.arange(6.0).reshape(2, 3) + 0.5)},
        {"a": [1.0, 2.0], "b": [5.0, 6.0, 9.0]},
    )


def test_changes_are_between_neighbours_that_differ() -> None:
    assert cases(small(), "pulses") == {1.0: 3, 2.0: 1, 3.0: 1}
    assert changes(small(), "pulses") == [Change("a", 1, 1.0, 2.0), Change("b", 2, 5.0, 9.0)]
    assert changes(small().isel(b=[0]), "pulses") == []


def test_a_quantity_that_is_no_count_has_no_cases() -> None:
    assert cases(small(), "slip") == {}
    assert cases(xr.Dataset({"many": ("a", np.arange(100.0))}), "many") == {}


ALPHA, STRESS = "friction.alpha", "body.normal_stress"
IMPEDANCE = 2800.0 * 3500.0
FEW = {"friction.alpha": np.geomspace(0.05, 2.0, 3), STRESS: np.linspace(50e6, 200e6, 3)}


def irregular(solution: ss.Solution) -> bool:
    """The regime without all else that `stickslip.uniqueness` says."""
    return margin(solution.problem) < 0.0


def contents(store: Path) -> dict[str, bytes]:
    return {str(path.relative_to(store)): path.read_bytes() for path in sorted(store.rglob("*")) if path.is_file()}


def refine(out: Path | None = None, **options: Any) -> xr.Dataset:
    """A small map of regimes: 9 members of the coarse grid, and more along the critical curve."""
    settings: dict[str, Any] = {"depth": 3, "quantities": [("several", "1", irregular)], "chunk": 4, "threads": 1}
    return ss.refine("fig6-slab", FEW, "several", out=out, **settings | options)


def test_the_critical_curve_is_found_to_a_ten_thousandth() -> None:
    """alpha_c = Z/(S (muS - muD)), eq. (15), over alpha and S, where it crosses a corner: 5120 x 5120 cells were it a grid."""
    low, high = np.array([0.05, 50e6]), np.array([0.0985, 200e6])
    vary = {ALPHA: np.linspace(0.05, 0.0985, 6), STRESS: np.linspace(50e6, 200e6, 6)}
    found = ss.refine("fig6-slab", vary, "several", depth=10, quantities=[("several", "1", irregular)])
    cells = cells_of(found)
    below, above = (np.stack([side[ALPHA], side[STRESS]], axis=1)[cells.changes] for side in (cells.low, cells.high))
    critical = IMPEDANCE / 0.5  # alpha S on the curve
    assert ((above - below) / 2.0 / (high - low)).max() < 1e-4  # the curve is nowhere farther from a cell's middle
    assert (below.prod(axis=1) <= critical * (1.0 + 1e-12)).all()
    assert (above.prod(axis=1) >= critical * (1.0 - 1e-12)).all()
    stress = np.linspace(critical / 0.0985, 200e6, 300)[:-1]
    for point in np.stack([critical / stress, stress], axis=1):
        assert ((below <= point * (1.0 + 1e-12)) & (point <= above * (1.0 + 1e-12))).all(axis=1).any()
    assert found.sizes["member"] < 2e-5 * 5121**2
    assert np.array_equal(found.several, found[ALPHA] * found[STRESS] > critical)


def test_members_lie_where_the_grid_would_have_them() -> None:
    found = refine()
    assert found.level.values.tolist() == sorted(found.level.values.tolist())
    assert int((found.level == 0).sum()) == 9
    ratio = np.log(found[ALPHA] / 0.05) / np.log(2.0 / 0.05) * 16.0
    assert ratio.values == pytest.approx(np.rint(ratio.values), abs=1e-12)
    coarse = found.isel(member=found.level == 0)
    assert sorted(set(coarse[STRESS].values.tolist())) == [50e6, 125e6, 200e6]
    assert found[ALPHA].attrs["units"] == "s/m"
    pairs = set(zip(found[ALPHA].values.tolist(), found[STRESS].values.tolist(), strict=True))
    assert len(pairs) == found.sizes["member"]


def test_cells_tile_the_map() -> None:
    found = refine()
    cells = cells_of(found)
    area = (np.log(cells.high[ALPHA] / cells.low[ALPHA]) * (cells.high[STRESS] - cells.low[STRESS])).sum()
    assert area == pytest.approx(np.log(40.0) * 150e6, rel=1e-12)
    assert np.isnan(cells.answer[cells.changes]).all()
    answers = cells.answer[~cells.changes]
    middle = (cells.low[ALPHA] * cells.low[STRESS])[~cells.changes][answers == 1.0]
    assert (middle >= IMPEDANCE / 0.5).all()
    assert set(answers.tolist()) == {0.0, 1.0}


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_a_search_that_was_stopped_continues(error: type[BaseException], tmp_path: Path) -> None:
    """By Ctrl-C, or by whatever else in the middle of a round: what is done is not done again, and the store is the same."""
    whole = refine(tmp_path / "whole.zarr")
    out, told = tmp_path / "map.zarr", []

    def stop(report: SweepProgress) -> None:
        if report.done > 20:
            raise error

    if error is KeyboardInterrupt:
        part = refine(out, progress=stop)
        there = part.status.values >= 0
        assert 20 < there.sum() < part.sizes["member"] < whole.sizes["member"]
        assert part.attrs["refinement_complete"] == 0
        assert 4 <= len(cells_of(part).answer) < len(cells_of(whole).answer)
        assert part.several.values[there].tolist() == whole.several.values[: len(there)][there].tolist()
    else:
        with pytest.raises(error):
            refine(out, progress=stop)
    assert not out.exists()
    again = refine(out, progress=told.append)
    assert contents(out) == contents(tmp_path / "whole.zarr")
    assert not (tmp_path / "map.rounds").exists()
    assert again.identical(whole)
    assert told[0].done == 9
    assert sum(later.done > before.done for before, later in pairwise(told)) < whole.sizes["member"] / 4


def test_a_finished_search_is_not_run_again(tmp_path: Path) -> None:
    first, told = refine(tmp_path / "map.zarr"), []
    (tmp_path / "map.rounds").mkdir()  # a kill between the last two steps
    second = refine(tmp_path / "map.zarr", progress=told.append)
    assert told == []
    assert second.identical(first)
    assert [path.name for path in tmp_path.iterdir()] == ["map.zarr"]
    with pytest.raises(ss.InputError, match=r"map\.zarr: was made with another refinement"):
        refine(tmp_path / "map.zarr", depth=4)


def test_maps_of_earlier_versions_are_read_and_what_is_packed_otherwise_is_not(tmp_path: Path) -> None:
    """Earlier versions left the packing to xarray: Zstandard without checksums."""
    found = refine(tmp_path / "map.zarr").load().drop_encoding()
    publish(tmp_path / "earlier.zarr", lambda draft: found.to_zarr(draft, consolidated=False))
    assert open_store(tmp_path / "earlier.zarr").identical(found)
    packed = {STRESS: {"compressors": (GzipCodec(),)}}
    publish(tmp_path / "other.zarr", lambda draft: found.to_zarr(draft, consolidated=False, encoding=packed))
    with pytest.raises(
        ss.InputError, match=rf"other\.zarr: not the store of a sweep: its array '{STRESS}' is packed in another way"
    ):
        open_store(tmp_path / "other.zarr")


def test_the_search_ends_at_the_most_members_and_says_so() -> None:
    assert refine().attrs["refinement_complete"] == 1
    found = refine(most=40)
    assert found.attrs["refinement_complete"] == 0
    assert 9 < found.sizes["member"] <= 40
    cells = cells_of(found)
    assert (cells.high[STRESS] - cells.low[STRESS])[cells.changes].min() > 75e6 / 8.0
    with pytest.raises(ss.InputError, match="coarse grid has 9 points, 8 are allowed"):
        refine(most=8)


def test_members_without_an_answer_mark_no_boundary() -> None:
    """Members that are refused are kept with their reason, and nothing is refined towards them."""
    vary = {"loading.far_stress_rate": [0.0, 1.0, 2.0], ALPHA: np.linspace(0.05, 2.0, 5)}
    found = ss.refine("fig6-slab", vary, "several", depth=2, quantities=[("several", "1", irregular)])
    refused = found["loading.far_stress_rate"] > 0.0
    assert (found.status.values[refused] == 10).all()
    assert "finite driver_impedance" in str(found.reason.values[refused][0])
    assert np.isfinite(found.several.values[~refused]).all()


def test_a_jump_by_a_factor_is_refined_by_bisection() -> None:
    """A number that grows slowly, but tenfold at alpha_c: one axis is a bisection."""

    def jumping(solution: ss.Solution) -> float:
        alpha = solution.problem.friction.alpha  # type: ignore[attr-defined]
        return (1.0 + 0.1 * alpha) * (10.0 if irregular(solution) else 1.0)

    found = ss.refine(
        "fig6-slab", {ALPHA: np.linspace(0.05, 2.0, 4)}, "jump", factor=5.0, depth=12, quantities=[("jump", "m", jumping)]
    )
    cells = cells_of(found)
    ((low,), (high,)) = (side[ALPHA][cells.changes] for side in (cells.low, cells.high))
    assert low <= IMPEDANCE / 0.5 / 100e6 <= high
    assert high - low == pytest.approx(0.65 / 2**12, rel=1e-9)
    assert found.sizes["member"] == 4 + 12
    with pytest.raises(ss.InputError, match="slip is not a whole number: give the factor by which"):
        ss.refine("fig6-slab", {ALPHA: np.linspace(0.05, 2.0, 4)}, "slip")


@pytest.mark.parametrize(
    ("vary", "options", "message"),
    [
        ({ALPHA: [2, 1]}, {}, "friction.alpha needs two or more numbers in ascending order"),
        ({ALPHA: [1]}, {}, "friction.alpha needs two or more numbers"),
        ({ALPHA: (0.05, 2.0)}, {}, "friction.alpha must be an array or a list: a tuple"),
        ({"run.selection": ["maxwell", "minimal"]}, {}, "run.selection needs two or more numbers"),
        ({ALPHA: [1, 2]}, {"factor": 1.0}, "factor must be above 1"),
        ({ALPHA: [1, 2]}, {"depth": -1}, "depth must be a whole number, 0 or more, got -1"),
        ({ALPHA: [1, 2]}, {"depth": 2.5}, "depth must be a whole number, 0 or more, got 2.5"),
        ({ALPHA: [1, 2]}, {"quantities": ["pulse"]}, "did you mean 'pulses'"),
    ],
)
def test_impossible_refinements_are_refused(vary: dict[str, Any], options: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        ss.refine("fig6-slab", vary, "pulses", **options)


def test_a_plain_sweep_has_no_cells() -> None:
    with pytest.raises(ss.InputError, match=r"not made by stickslip\.refine"):
        cells_of(ss.sweep("fig6-slab", {ALPHA: [1.0]}, quantities=["slip"]))
