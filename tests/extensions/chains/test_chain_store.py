"""Runs of chains in folders: written as they go, opened, continued bit for bit, and refused in one line where they are damaged."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr

import stickslip as ss
from stickslip.extensions.chains import store_layout
from stickslip.extensions.chains.rows import Snapshots
from stickslip.extensions.chains.run import ChainRun
from stickslip.extensions.chains.state import ChainState
from stickslip.foundation.netcdf_file import Variable, read_tables, write_variables

LAW = ss.friction.Coulomb(static=1.0, dynamic=0.7)
EVERY = 0.0
"""Time between two checkpoints (s): as often as they may be."""


def _chain(**given: Any) -> ss.Chain:
    normal = ss.Drawn("uniform", 0.9, 1.1, seed=2)
    return ss.Chain(LAW, 12, 1.0, 6.0, 1.0, normal, 1e-3, **given)


def _same(one: ChainRun, other: ChainRun) -> None:
    """Two runs have the same bits: events, changes, slip, and the state from which they go on."""
    assert np.array_equal(one.events, other.events)
    assert np.array_equal(one.slip, other.slip)
    assert np.array_equal(one.slip_rate, other.slip_rate)
    for name, values in one.state.arrays.items():
        assert np.array_equal(values, other.state.arrays[name], equal_nan=True), name
    if one.change_rows is not None:
        assert np.array_equal(one.changes, other.changes)


def test_a_run_in_a_folder_is_the_run_in_memory(tmp_path: Path) -> None:
    whole = ss.simulate(_chain(), 3000.0, keep="changes")
    kept = ss.simulate(_chain(), 3000.0, keep="changes", checkpoint=tmp_path / "a.zarr", checkpoint_every=EVERY)
    opened = ss.open_solution(tmp_path / "a.zarr")
    assert len(whole.events) > 20
    for run in (kept, opened):
        _same(run, whole)
        assert (run.status, run.duration) == (whole.status, whole.duration)
    assert opened.energy() == whole.energy()
    assert np.array_equal(opened.motion(1000.0, 2900.0, 40).slip, whole.motion(1000.0, 2900.0, 40).slip)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("stop", [0.5, 1234.5])
def test_a_run_that_is_resumed_has_the_bits_of_one_that_never_stopped(tmp_path: Path, stop: float) -> None:
    whole = ss.simulate(_chain(), 3000.0, keep="changes")
    ss.simulate(_chain(), stop, keep="changes", checkpoint=tmp_path / "a.zarr")
    _same(ss.resume(tmp_path / "a.zarr", 3000.0), whole)
    _same(ss.open_solution(tmp_path / "a.zarr"), whole)


def _in_small_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each call of compiled code take so few steps that a short run has many of them."""
    monkeypatch.setattr("stickslip.extensions.chains.running.STEPS_IN_BUDGET", 1)
    for name in ("FIRST_BUDGET", "LARGEST_BUDGET"):
        monkeypatch.setattr(f"stickslip.run.run_loop.{name}", 200)


def test_a_run_that_is_killed_goes_on_from_its_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The rows after the checkpoint are in the folder already, and are written again."""
    monkeypatch.setattr(store_layout, "ROWS_OF_CHUNK", 50)
    monkeypatch.setattr("stickslip.extensions.chains.store.ROWS_OF_CHUNK", 50)
    _in_small_steps(monkeypatch)
    folder, calls = tmp_path / "a.zarr", []

    def killed(report: Any) -> None:
        calls.append(report)
        if len(calls) == 8:
            shutil.copytree(folder, tmp_path / "b.zarr")

    whole = ss.simulate(_chain(), 3000.0, keep="changes", checkpoint=folder, progress=killed)
    assert len(calls) > 12
    stale = store_layout.open_chain(tmp_path / "b.zarr")
    rows = zarr.open_group(tmp_path / "b.zarr", mode="r", use_consolidated=False)["changes"].shape[0]  # type: ignore[union-attr]
    assert len(stale.change_rows or ()) < rows
    _same(ss.resume(tmp_path / "b.zarr"), whole)


def test_ctrl_c_leaves_a_folder_that_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _in_small_steps(monkeypatch)

    def stop(report: Any) -> None:
        if report.events > 3:
            raise KeyboardInterrupt

    whole = ss.simulate(_chain(), 3000.0)
    stopped = ss.simulate(_chain(), 3000.0, checkpoint=tmp_path / "a.zarr", progress=stop)
    assert stopped.status.name == "interrupted"
    assert 3 < len(stopped.events) < len(whole.events)
    assert np.array_equal(stopped.events, whole.events[: len(stopped.events)])
    _same(ss.resume(tmp_path / "a.zarr"), whole)


def test_a_chain_under_a_smooth_law_is_resumed_bit_for_bit(tmp_path: Path) -> None:
    law = ss.friction.HyperbolicRate(static=1.0, dynamic=0.7, alpha=10.0)
    chain = ss.Chain(law, [2, 3], 1.0, (2.0, 3.0), 1.0, ss.Drawn("uniform", 0.9, 1.1, seed=2), 1e-2, damping=0.1)
    whole = ss.simulate(chain, 400.0, keep="changes")
    first = ss.simulate(chain, float(whole.events["time"][3]) + 0.3, keep="changes", checkpoint=tmp_path / "a.zarr")
    assert first.slip_rate.any()  # it stops within an event
    _same(ss.resume(tmp_path / "a.zarr", 400.0), whole)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("many", [1, 17])
def test_a_run_ends_after_so_many_events_and_goes_on_from_there(tmp_path: Path, many: int) -> None:
    whole = ss.simulate(_chain(), 3000.0, keep="changes")
    first = ss.simulate(_chain(), 3000.0, keep="changes", max_events=many, checkpoint=tmp_path / "a.zarr")
    assert (len(first.events), first.status.name) == (many, "enough events")
    assert np.array_equal(first.changes, whole.changes[: len(first.changes)])
    assert first.duration == pytest.approx(first.events["time"][-1] + first.events["duration"][-1], rel=1e-15)
    assert first.count_of_changes == len(first.changes)
    more = ss.resume(tmp_path / "a.zarr", max_events=many + 3)
    assert np.array_equal(more.events, whole.events[: many + 3])
    _same(ss.resume(tmp_path / "a.zarr"), whole)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("duration", [299.0, 100.0])
def test_a_run_does_not_end_before_the_time_that_it_has_reached(tmp_path: Path, duration: float) -> None:
    """Its last event is over long before: the state that it goes on from is older than its end."""
    ss.simulate(_chain(), 300.0, checkpoint=tmp_path / "a.zarr")
    with pytest.raises(ss.InputError) as caught:
        ss.resume(tmp_path / "a.zarr", duration)
    said = f"the run has already reached 300 s: a duration of {duration:g} s lies before that"
    assert str(caught.value) == f"{tmp_path / 'a.zarr'}: {said}"
    assert store_layout.open_chain(tmp_path / "a.zarr").duration == 300.0
    assert ss.resume(tmp_path / "a.zarr", 300.0).duration == 300.0


def test_snapshots_are_bounded_in_number_and_in_memory() -> None:
    for count in (3, 100_000):
        kept, state = Snapshots(), ChainState.empty(count)
        for i in range(3000):
            state.now[0] = i
            kept.add(state)
        assert len(kept.states) <= Snapshots.most(state)
        assert kept.states[0].now[0] == 0.0
        assert len(kept.states) * sum(one.nbytes for one in state.arrays.values()) <= max(2**24, 2 * 8 * 11 * count)


def test_what_a_folder_cannot_say_is_refused_before_the_run(tmp_path: Path) -> None:
    from scipy import sparse

    other = ss.friction.Coulomb(static=0.9, dynamic=0.7)
    matrix = sparse.csr_matrix(np.array([[0.0, 1.0], [1.0, 0.0]]))
    chains = {
        "different laws": ss.Chain([LAW, other], 2, 1.0, 1.0, 1.0, 1.0, 1e-3),
        "coupling is a matrix": ss.Chain(LAW, 2, 1.0, matrix, 1.0, 1.0, 1e-3),
    }
    for why, chain in chains.items():
        with pytest.raises(ss.InputError, match=why) as refused:
            ss.simulate(chain, 10.0, checkpoint=tmp_path / "a.zarr")
        assert "\n" not in str(refused.value)
        assert not (tmp_path / "a.zarr").exists()
        assert ss.simulate(chain, 10.0).status.ok
    with pytest.raises(ss.InputError, match=r"folder NAME\.zarr, got"):
        ss.simulate(_chain(), 10.0, checkpoint=tmp_path / "a.nc")


# ---- damaged folders -------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sound folder."""
    folder = tmp_path_factory.mktemp("kept") / "a.zarr"
    ss.simulate(_chain(), 3000.0, keep="changes", checkpoint=folder)
    return folder


def _state_with(folder: Path, change: Any) -> None:
    """Write the checkpoint of a folder again with other arrays and attributes."""
    variables, _, about = read_tables(folder / "state.nc")
    arrays, attributes = {name: np.array(one.values) for name, one in variables.items()}, dict(about)
    change(arrays, attributes)
    made = {name: Variable(variables[name].dims, one) for name, one in arrays.items()}
    write_variables(made, attributes, folder / "state.nc")


def _piece(arrays: Any, attributes: Any) -> None:
    arrays["whole"][1, 3] = 7


def _block(arrays: Any, attributes: Any) -> None:
    arrays["now"][7] = 12.0


def _nan(arrays: Any, attributes: Any) -> None:
    arrays["blocks"][0, 0] = np.nan


def _rows(arrays: Any, attributes: Any) -> None:
    attributes["events"] = 10**12


def _negative(arrays: Any, attributes: Any) -> None:
    attributes["changes"] = -1


def _fewer(arrays: Any, attributes: Any) -> None:
    attributes["events"] -= 1


def _other(arrays: Any, attributes: Any) -> None:
    attributes["digest"] = "0"


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("change", [_piece, _block, _nan, _rows, _negative, _fewer, _other])
def test_a_state_that_no_run_has_is_refused_in_one_line(kept: Path, tmp_path: Path, change: Any) -> None:
    folder = tmp_path / "b.zarr"
    shutil.copytree(kept, folder)
    _state_with(folder, change)
    for read in (lambda: ss.open_solution(folder).events, lambda: ss.resume(folder, 4000.0).events):
        with pytest.raises(ss.InputError) as refused:
            read()
        assert str(refused.value).startswith(f"{folder}: ")
        assert "\n" not in str(refused.value)


def _truncated(folder: Path) -> None:
    file = folder / "events" / "c.0.0"
    file.write_bytes(file.read_bytes()[:-9])


def _missing(folder: Path) -> None:
    (folder / "events" / "c.0.0").unlink()


def _without_state(folder: Path) -> None:
    (folder / "state.nc").unlink()


def _half_a_state(folder: Path) -> None:
    file = folder / "state.nc"
    file.write_bytes(file.read_bytes()[:2000])


def _no_metadata(folder: Path) -> None:
    (folder / "zarr.json").write_text('{"stickslip_chain"')


def _another_scenario(folder: Path) -> None:
    file = folder / "zarr.json"
    file.write_text(file.read_text().replace("blocks = 12", "blocks = 13"))


def _linked(folder: Path) -> None:
    (folder / "state.nc").rename(folder.parent / "elsewhere.nc")
    (folder / "state.nc").symlink_to(folder.parent / "elsewhere.nc")


DAMAGES = [_truncated, _missing, _without_state, _half_a_state, _no_metadata, _another_scenario, _linked]


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_folder_is_refused_in_one_line(kept: Path, tmp_path: Path, damage: Any) -> None:
    folder = tmp_path / "b.zarr"
    shutil.copytree(kept, folder)
    damage(folder)
    read = (lambda: ss.resume(folder, 4000.0)) if damage is _linked else lambda: ss.open_solution(folder).events
    with pytest.raises(ss.InputError) as refused:
        read()
    assert str(folder) in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_folder_of_another_version_of_the_code_is_not_resumed(kept: Path, tmp_path: Path) -> None:
    folder = tmp_path / "b.zarr"
    shutil.copytree(kept, folder)
    _state_with(folder, lambda arrays, attributes: attributes.update(engine="another"))
    assert len(ss.open_solution(folder).events) > 20
    with pytest.raises(ss.InputError, match="cannot be resumed: another version of stickslip made it"):
        ss.resume(folder, 4000.0)


def test_a_run_that_is_over_or_has_its_events_is_not_resumed_for_less(kept: Path) -> None:
    for given, wanted in (
        ({"duration": 10.0}, "has already reached"),
        ({"max_events": 2}, "already has"),
        ({"max_pieces": 9}, "max_p"),
    ):
        with pytest.raises(ss.InputError, match=wanted):
            ss.resume(kept, **given)  # type: ignore[arg-type]
