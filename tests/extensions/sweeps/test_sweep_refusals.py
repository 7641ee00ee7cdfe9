"""Every sweep that cannot be carried out is refused in one line, and writes nothing."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import stickslip as ss
from tests.command_line import Command, check_refusal

FOUR_KEYS = [word for name in ("alpha", "static", "dynamic", "thickness") for word in ("-v", f"{name}=0.1,0.2")]
CASES = [
    (["run", "fig6-slab", "-q"], "run: there is no option -q; it is an option of show and sweep; `stickslip run --help` explains"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--out", "bad.zarr"], "--out bad.zarr: is a file, where a sweep needs a folder"),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1", "--figure", "a.png"],
        "sweep: --figure draws one to three keys, but here no key",
    ),
    (["sweep", "fig6-slab", *FOUR_KEYS, "--figure", "a.png"], "sweep: --figure draws one to three keys, but here 4 keys vary"),
    (["sweep", "fig6-slab"], "sweep: needs either --vary or --list, got neither"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--list", "a.csv"], "sweep: needs either --vary or --list, got --vary and --list"),
    (["sweep", "fig6-slab", "-v", "alpha"], '--vary must be "KEY=LOW..HIGH:POINTS"'),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1,2", "-q", "xyz"],
        "sweep: quantity 'xyz' is unknown; allowed: arrested, balance, branches, damped, ",
    ),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--out", "map.nc"], "--out map.nc: the name must end in .zarr"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--out", "no/map.zarr"], "--out no/map.zarr: there is no folder no"),
    (["sweep", "fig6-slab", "--list", "no.csv"], "--list no.csv: no such file"),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1..2", "--design", "lhs", "--members", "1e12"],
        "sweep: --members must be a whole number",
    ),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1..2:100000", "-v", "static=0.6..0.8:100000", "--dry-run"],
        "--vary: a grid has at most 1e+09 members, got 1e+10",
    ),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)


@pytest.mark.parametrize("path", ["pipe.png", "/dev/zero"])
def test_a_list_that_is_no_ordinary_file_is_not_waited_for(command: Command, path: str) -> None:
    check_refusal(command, ["sweep", "fig6-slab", "--list", path], f"--list {path}: not an ordinary file")


def test_the_store_of_a_sweep_is_told_from_a_scenario(tmp_path: Path) -> None:
    store = tmp_path / "map.zarr"
    ss.sweep("fig6-slab", {"friction.alpha": [0.5, 1.0]}, out=store)
    said = f"{store}: a folder of results, not a scenario: `stickslip show {store}` summarises them"
    with pytest.raises(ss.InputError, match=f"^{re.escape(said)}$"):
        ss.load_scenario(store)
