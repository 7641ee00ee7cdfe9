"""The command line with a chain: what it says, what it writes, and what it refuses in one line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.summary import lines_of
from stickslip.problem.scenarios import library
from tests.command_line import Command

IN_1D = {
    "analogy": ("two-blocks", "--map", "friction.static=0.9..1:2", "--map", "friction.dynamic=0.4..0.5:2"),
    "compare": ("two-blocks", "fig6-slab"),
    "ensemble": ("two-blocks",),
    "find": ("two-blocks", "--along", "friction.static=0.9..1"),
    "identify": ("two-blocks", "record.csv", "--free", "friction.static"),
    "infer": ("two-blocks", "record.csv", "--free", "friction.static=0.6..0.8"),
    "schemes": ("two-blocks",),
    "explore": ("two-blocks",),
}
"""Arguments of each command that is for a single contact."""


def test_run_says_what_happened(command: Command) -> None:
    shown = command("run", "two-blocks")
    lines = shown.out.splitlines()
    assert shown.code == 0
    assert lines[:2] == ["Two blocks of unequal strength", "finished: the run reached its duration"]
    assert lines[2] == "2 blocks, up to 1200 s"
    assert lines[3].endswith("changes of single blocks")
    assert lines[4].startswith("largest: ")
    assert "energy: driver " in shown.out


def test_a_balance_that_lacks_more_than_rounding_is_not_called_rounding() -> None:
    run: Any = ss.simulate("two-blocks")
    assert "J of rounding" in "".join(lines_of(run))
    now = run.final.now.copy()
    now[at.HEAT] += 1e-4
    worse = replace(run, final=replace(run.final, now=now))
    assert list(lines_of(worse))[-1].strip() == "the balance lacks 1.0e-04 J, which is more than rounding"


def test_a_run_is_kept_shown_continued_and_written_again(command: Command, tmp_path: Path) -> None:
    first = command("run", "ten-blocks", "--duration", "1200 s", "--out", "a.zarr", "--csv", "a.csv")
    assert first.code == 0
    assert first.out.splitlines()[-2:] == ["written: a.zarr", "written: a.csv"]
    more = command("run", "--resume", "a.zarr", "--duration", "1500 s", "--csv", "b.csv", "--figure", "b.png")
    assert more.code == 0
    assert "156 changes" in more.out
    shown = command("show", "a.zarr", "--all")
    assert "156 changes" in shown.out
    assert "(proven, but for rounding)" in shown.out
    assert 'direction = "forward"' in command("show", "a.zarr", "--scenario").out
    assert command("export", "a.zarr", "c.csv").code == 0
    whole = ss.simulate("ten-blocks")
    for name in ("b.csv", "c.csv"):
        table = pd.read_csv(tmp_path / name, comment="#")
        assert np.array_equal(table["moment (m)"], whole.events["moment"])
        assert np.array_equal(table["first_block"], whole.events["first_block"])
    assert command("export", "a.zarr", "c.nc").code == 0


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".nc"])
def test_events_are_written_with_all_digits(tmp_path: Path, suffix: str) -> None:
    if suffix == ".parquet":
        pytest.importorskip("pyarrow")
    run = ss.simulate("ten-blocks")
    path = run.to_csv(tmp_path / f"a{suffix}")
    if suffix == ".nc":
        import xarray as xr

        found = xr.open_dataset(path)["heat"]
        assert found.attrs["units"] == "J"
        assert np.array_equal(found, run.events["heat"])
        return
    table = pd.read_csv(path, comment="#") if suffix == ".csv" else pd.read_parquet(path)
    assert np.array_equal(table["heat (J)"], run.events["heat"])
    with pytest.raises(ss.InputError, match=r"must end in \.csv, \.parquet, \.nc"):
        run.to_csv(tmp_path / "a.txt")
    with pytest.raises(ss.InputError) as caught:
        run.to_csv(tmp_path / f"nowhere/a{suffix}")
    assert str(caught.value) == f"{tmp_path}/nowhere/a{suffix}: cannot be written: No such file or directory"


def test_a_folder_that_is_not_there_is_said_so(command: Command) -> None:
    for words in (("show", "a.zarr"), ("run", "--resume", "a.zarr")):
        assert command(*words).err.strip() == "stickslip: a.zarr: no such file or folder"


def test_a_run_ends_after_so_many_events(command: Command) -> None:
    shown = command("run", "ten-blocks", "--events", "3")
    assert shown.code == 0
    assert "enough events" in shown.out
    assert "3 events, " in shown.out


def test_values_are_set_by_their_places(command: Command) -> None:
    shown = command("run", "chain", "--set", "chain.blocks=5", "--set", "normal_force.seed=3", "--duration", "400 s")
    assert shown.out.splitlines()[0] == "A chain of fifty blocks: chain.blocks = 5, normal_force.seed = 3"
    assert "5 blocks, up to 400 s" in shown.out


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        (("run", "two-blocks", "--rtol", "1e-3"), "run: --rtol has no effect with a [chain]"),
        (("run", "two-blocks", "--catalogue", "a.csv"), "run: --catalogue has no effect with a [chain]: --csv writes its events"),
        (("run", "two-blocks", "--animation", "a.gif"), "run: a [chain] has --figure, --catalogue-figure"),
        (("run", "two-blocks", "--out", "a.nc"), "--out a.nc: the name must end in .zarr"),
        (("run", "two-blocks", "--set", "body.mass=1"), "a scenario with a [chain] has no [body]"),
        (("run", "two-blocks", "--set", "chain.cupling=1"), "did you mean 'chain.coupling'?"),
        (("run", "two-blocks", "--selection", "maxwell"), "run: --selection has no effect with a [chain]"),
        (("check", "two-blocks", "--figure", "a.png"), "leave them out with a [chain]"),
    ],
)
def test_what_a_chain_does_not_have_is_refused_in_one_line(command: Command, arguments: tuple[str, ...], wanted: str) -> None:
    refused = command(*arguments)
    assert refused.code == 2
    assert len(refused.err.strip().splitlines()) == 1
    assert wanted in refused.err


@pytest.mark.parametrize("name", IN_1D)
def test_commands_for_a_single_contact_name_the_cure(command: Command, tmp_path: Path, name: str) -> None:
    (tmp_path / "record.csv").write_text("time (s),slip (m)\n0,0\n1,1e-3\n2,2e-3\n")
    refused = command(name, *IN_1D[name])
    assert refused.code == 2
    assert len(refused.err.strip().splitlines()) == 1
    assert "[chain]" in refused.err, refused.err


def test_a_chain_takes_no_law_of_points(command: Command, tmp_path: Path) -> None:
    (tmp_path / "points.csv").write_text("slip (m),friction\n0,0.6\n1,0.5\n2,0.4\n")
    refused = command("fit", "points.csv", "--body", "two-blocks", "--out", "mine.toml")
    assert refused.code == 2
    assert "two-blocks has a [chain] of blocks, which takes no other law" in refused.err


def test_every_bundled_chain_says_what_it_shows() -> None:
    chains = [name for name, entry in library.entries().items() if entry.trade == "Chains of blocks"]
    assert {"chain", "two-blocks", "ten-blocks"} <= set(chains)
    for name in chains:
        assert ss.scenarios[name].table("chain") is not None
