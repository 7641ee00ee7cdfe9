"""Members that take as long as thousands of others hold nobody up: they run last, and the summary names them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.extensions.sweeps.batch import run
from stickslip.extensions.sweeps.execution.chunk import NOT_RUN
from stickslip.extensions.sweeps.execution.plan import make_plan
from stickslip.extensions.sweeps.summary import show_slowest
from stickslip.extensions.sweeps.sweep import SweepProgress
from tests.extensions.sweeps.batch.cases import CASES
from tests.extensions.sweeps.stores import files

DURATIONS = [1e3, 2e5, 2e3, 1e5, 4e3, 3e3]
LONG = [1, 3]
"""Members whose history is longer than the room that the tests leave in a batch."""


def sweep(out: Path | None, **options: Any) -> xr.Dataset:
    return ss.sweep(CASES["coulomb block"].scenario, {"run.duration": DURATIONS}, chunk=2, out=out, **options)


@pytest.fixture(autouse=True)
def little_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "LARGEST_CAPACITY", 512)


@pytest.mark.slow
def test_long_members_run_when_all_others_are_done(monkeypatch: pytest.MonkeyPatch) -> None:
    reports: list[SweepProgress] = []
    done_before: list[int] = []
    alone = run.run_alone
    monkeypatch.setattr(run, "run_alone", lambda *given: done_before.append(reports[-1].done) or alone(*given))
    found = sweep(None, progress=reports.append)
    assert done_before[0] == len(DURATIONS) - len(LONG)
    assert len(done_before) == len(LONG)
    assert [report.done for report in reports] == sorted(report.done for report in reports)
    assert (reports[-1].done, reports[-1].failed) == (len(DURATIONS), 0)
    assert sorted(reports[-1].alone) == LONG
    assert 0.0 < sum(reports[-1].alone.values()) <= reports[-1].seconds
    for n, duration in enumerate(DURATIONS):
        by_itself = ss.sweep(CASES["coulomb block"].scenario, {"run.duration": [duration]})
        for name in by_itself.data_vars:
            assert np.array_equal(found[name].values[n], by_itself[name].values[0], equal_nan=name not in ("reason", "status"))


@pytest.mark.slow
def test_a_sweep_stopped_before_its_long_members_has_all_others_and_continues_to_the_same_files(tmp_path: Path) -> None:
    sweep(tmp_path / "whole.zarr")

    def stop(report: SweepProgress) -> None:
        if report.done == len(DURATIONS) - len(LONG):
            raise KeyboardInterrupt

    stopped = sweep(tmp_path / "map.zarr", progress=stop).load()
    assert np.flatnonzero(stopped.status.values == NOT_RUN).tolist() == LONG
    assert np.flatnonzero(np.isnan(stopped.slip.values)).tolist() == LONG
    continued = sweep(tmp_path / "map.zarr").load()
    assert (continued.status.values == 0).all()
    assert files(tmp_path / "map.zarr") == files(tmp_path / "whole.zarr")


SAID = "1 member took 80 % of the processor time (50 s): 40 s at friction.alpha = 2 s/m, body.thickness = 1000 m"


@pytest.mark.parametrize(("alone", "said"), [({30: 40.1, 1: 0.1}, [SAID]), ({30: 0.3, 1: 0.1}, []), ({}, [])])
def test_the_summary_names_the_members_that_took_most_of_the_time(
    capsys: pytest.CaptureFixture[str], alone: dict[int, float], said: list[str]
) -> None:
    grid = {"friction.alpha": np.linspace(1.0, 2.0, 2), "body.thickness": np.linspace(1e3, 50e3, 30)}
    last = SweepProgress(60, 0, 60, np.nan, np.nan, 50.0, alone)
    show_slowest(make_plan("fig6-slab", grid), last)
    assert [line for line in capsys.readouterr().out.splitlines() if "processor time" in line] == said
