"""`stickslip show` of the store of a sweep."""

from __future__ import annotations

from pathlib import Path

import pytest

import stickslip as ss
from tests.command_line import Command


def after_title(text: str) -> str:
    """Return a summary without its first line."""
    return text.partition("\n")[2]


@pytest.mark.drawn
def test_show_repeats_the_summary_of_a_sweep(command: Command):
    asked = ["sweep", "fig6-slab", "-v", "run.selection=perfect-delay,minimal,maximal", "-v", "friction.alpha=0.1..1:4"]
    ran = command(*asked, "--out", "map.zarr", "-q", "slip", "-q", "events", "--figure", "ran.png").out
    shown = command("show", "map.zarr", "--figure", "shown.png")
    assert (shown.code, shown.err) == (0, "")
    summary, _, made = after_title(shown.out).partition("made by ")
    assert summary == after_title(ran).removesuffix("written: map.zarr\nwritten: ran.png\n")
    assert made.endswith("written: shown.png\n")
    assert Path("shown.png").read_bytes() == Path("ran.png").read_bytes(), "the first quantity of the sweep, in both"
    assert "[run]\n" in command("show", "map.zarr", "--scenario").out


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run.nc", "--quantity", "slip"], "show: --quantity chooses what is drawn of a sweep, and run.nc is not a sweep"),
        (["map.zarr", "--energy-figure", "a.png"], "map.zarr: the results of a sweep have no --energy-figure: --figure draws"),
    ],
)
def test_what_cannot_be_shown_is_told_in_one_line(command: Command, tmp_path: Path, arguments: list[str], message: str):
    ss.simulate("cycles-block", 20 * ss.YEAR, checkpoint="run.nc")
    ss.sweep("fig6-slab", {"friction.alpha": [0.5, 1.0]}, out="map.zarr")
    before = sorted(tmp_path.iterdir())
    assert command("show", *arguments).refusal.startswith(message)
    assert sorted(tmp_path.iterdir()) == before
