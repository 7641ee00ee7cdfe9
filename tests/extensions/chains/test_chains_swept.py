"""Sweeps over chains: each member is the run that is made by hand, and a sweep that stopped goes on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.engine import engine_key
from stickslip.extensions.chains.deciding import DECIDING_CODE
from stickslip.extensions.chains.swept import SUMMARIES
from stickslip.extensions.sweeps.execution.chunk import MEMBER_CODE
from stickslip.extensions.sweeps.sweep import SweepProgress
from tests.command_line import Command
from tests.messages import refused

STARTS = {"initial_slip.seed": [1, 2, 3]}
"""Chains that start out of place in three ways."""


def by_hand(values: dict[str, Any]) -> Any:
    """Return the run of a member."""
    return ss.simulate(ss.scenarios["ten-blocks"].with_values({"run.duration": 900.0} | values))


def ten_blocks(vary: Any = None, **asked: Any) -> xr.Dataset:
    return ss.sweep(ss.scenarios["ten-blocks"].with_values({"run.duration": 900.0}), vary or STARTS, **asked)


def test_members_are_runs_by_hand_bit_for_bit() -> None:
    found = ten_blocks()
    assert list(found.data_vars)[:6] == list(SUMMARIES)
    for n, seed in enumerate(STARTS["initial_slip.seed"]):
        run = by_hand({"initial_slip.seed": seed})
        largest = run.events[np.argmax(run.events["moment"])]
        start = run.at(0.0).slip[0]
        expected = {
            "events": len(run.events),
            "event_rate": len(run.events) / 900.0,
            "changes": run.count_of_changes,
            "largest_moment": largest["moment"],
            "largest_time": largest["time"],
            "total_slip": (run.slip - start).sum(),
        }
        assert {name: found[name].values[n] for name in SUMMARIES} == expected
    assert len(set(found.total_slip.values.tolist())) == 3, "other seeds give other runs"
    assert not found.largest_time.values.any(), "the largest event is that of the start"
    assert found.event_rate.attrs["units"] == "s-1"
    assert found.largest_moment.attrs == {"long_name": SUMMARIES["largest_moment"][1], "units": "m"}
    assert found.attrs["title"] == "stickslip sweep: Chain, Coulomb"
    assert "rtol" not in found.attrs


def test_a_chain_without_events_has_no_largest() -> None:
    found = ss.sweep("two-blocks", {"run.duration": [1e-3, 1200.0]}, quantities=["events", "largest_moment", "largest_time"])
    assert found.events.values[0] == 0.0 < found.events.values[1]
    assert np.isnan(found.largest_moment.values).tolist() == np.isnan(found.largest_time.values).tolist() == [True, False]


def test_a_store_is_of_the_code_of_chains() -> None:
    found = ten_blocks({"initial_slip.seed": [1]}, quantities="events")
    assert found.attrs["engine"] == engine_key(*MEMBER_CODE, *DECIDING_CODE, "extensions/chains/swept.py")


def test_a_number_of_ones_own_is_a_function_of_the_run() -> None:
    found = ten_blocks({"coupling": ["20 N/m"]}, quantities=["events", ("heat", "J", lambda run: run.energy().heat)])
    run = by_hand({"chain.coupling": 20.0})
    assert (found.heat.item(), found.heat.attrs["units"]) == (run.energy().heat, "J")


def test_a_member_that_cannot_be_has_a_reason() -> None:
    found = ten_blocks({"friction.dynamic": [0.5, 1.5]})
    assert np.isnan(found.events.values).tolist() == [False, True]
    assert "dynamic" in found.reason.values[1]


def test_a_sweep_that_was_stopped_goes_on(tmp_path: Path) -> None:
    path, done = tmp_path / "kept.zarr", []

    def stop(progress: SweepProgress) -> None:
        raise KeyboardInterrupt

    stopped = ten_blocks(out=path, progress=stop)
    assert stopped.status.values.tolist() == [0, -1, -1], "one member a chunk"
    found = ten_blocks(out=path, progress=lambda progress: done.append(progress.done))
    assert done == [1, 2, 3]
    assert found.load().identical(ten_blocks())


@pytest.mark.slow
def test_workers_of_dask_find_the_same() -> None:
    assert ten_blocks(workers=1).identical(ten_blocks())


@pytest.mark.parametrize(
    ("asked", "parts"),
    [
        ({"quantities": ["evnts"]}, ("'evnts' is unknown", "did you mean 'events'?")),
        ({"quantities": ["pulses"]}, ("'pulses' is unknown", "allowed: changes, event_rate, events", "total_slip")),
        ({"quantities": []}, ("no quantity is given", "largest_moment")),
        ({"quantities": [("changes", "1", len)]}, ("'changes'", "choose another name")),
        ({"series": ["slip"]}, ("series", "single contact", "leave them out")),
        ({"vary": {"chain.copling": [1.0]}}, ("copling", "coupling")),
    ],
)
def test_what_a_chain_has_not_is_said_in_one_line(asked: dict[str, Any], parts: tuple[str, ...]) -> None:
    with refused(*parts, begins="sweep: "):
        ten_blocks(**asked)


def test_other_problems_of_extensions_are_still_refused() -> None:
    name = next(name for name, one in ss.scenarios.items() if one.table("contact") is not None)
    with refused(name, "[contact]", begins="sweep: "):
        ss.sweep(name, {"friction.static": [0.6, 0.7]})


def test_the_command_sweeps_chains(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "kept.zarr"
    asked = ("ten-blocks", "--duration", "600 s", "--vary", "chain.coupling=20..40:2", "--vary", "initial_slip.seed=1,2")
    planned = command("sweep", *asked, "--dry-run")
    assert "2 x 2 = 4 members over chain.coupling, chain.initial_slip.seed, one by one" in planned.out
    shown = command("sweep", *asked, "-q", "largest_moment", "-q", "events", "--out", str(path))
    assert shown.code == 0
    assert "4 finished" in shown.out
    assert "largest_moment" in command("show", str(path)).out
    with xr.open_zarr(path) as kept:
        run = ss.simulate(ss.scenarios["ten-blocks"].with_values({"chain.coupling": 40.0, "initial_slip.seed": 2}), 600.0)
        assert kept.events.values[1, 1] == len(run.events)  # type: ignore[attr-defined] # the run of a chain
