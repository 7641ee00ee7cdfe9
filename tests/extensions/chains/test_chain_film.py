"""A film of a chain shows slip, slip rate and the blocks that move, as the run has them at the times of its frames."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import stickslip as ss
from stickslip.extensions.chains.changes_between import changes_between, slips_of, window_of
from stickslip.extensions.chains.figures.film import stage
from stickslip.extensions.chains.plots import ChainPlots
from stickslip.extensions.chains.run import ChainRun
from stickslip.extensions.chains.solver import solve_chain

mpl.use("Agg")


@cache
def run() -> ChainRun:
    """Return the run of ten blocks, from a rough start."""
    law = ss.friction.Coulomb(static=1.0, dynamic=0.7)
    start = -np.random.default_rng(1).uniform(0.0, 0.5, 10)
    return solve_chain(ss.Chain(law, 10, 1.0, 10.0, 1.0, 1.0, 1e-3, initial_slip=start), 1000.0, keep="changes")


def test_a_frame_marks_the_blocks_between_onset_and_arrest() -> None:
    """The blocks in motion come here from the changes of the run, not from slip rates."""
    first, last, event = window_of(run(), None, None, None)
    slips = slips_of(changes_between(run(), first, last), run().slip)
    times = np.linspace(first, last, 12)
    motion, figure = run().at(times), Figure()
    move, _ = stage(run(), motion, event)(figure)
    slip, rate = figure.axes
    met = set()
    for n in (0, 3, 6, 9, 11):
        move(n)
        inside = {int(j) for j in slips.block[(slips.onset < times[n]) & (times[n] < slips.arrest)]}
        met.add(len(inside))
        for axes in (slip, rate):
            marks = next(line for line in axes.lines if line.get_marker() == "o")
            assert set(np.flatnonzero(np.isfinite(np.asarray(marks.get_ydata(), dtype=float)))) == inside
        assert slip.get_title(loc="left") == f"{times[n]:.3f} s, {times[n] - first:.3f} s in event {event}"
    assert len(met) > 1  # not the same blocks in each frame
    assert met != {0}


def test_a_film_has_its_frames(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    path = ChainPlots(run()).animation(tmp_path / "film.gif", frames=4, progress=lambda done, of: told.append((done, of)))
    with Image.open(path) as film:
        assert film.size == (800, 450)
        film.seek(3)
        with pytest.raises(EOFError):
            film.seek(4)
    assert told == [(n, 4) for n in range(1, 5)]
    between = ChainPlots(run()).animation(tmp_path / "between.gif", "700 s", 800.0, frames=2)
    assert between.stat().st_size > 1000


REFUSED: list[tuple[str, dict[str, Any], str]] = [
    ("film.avi", {}, "the name must end in .gif or .mp4 or .webm"),
    ("film.gif", {"event": 1000}, "plot.animation: event must be a whole number from 0 to"),
    ("film.gif", {"event": 1, "start": 0.0}, "plot.animation: give an event, or start and end, not both"),
    ("film.gif", {"start": 5.0, "end": 4.0}, "plot.animation: start and end must ascend from 0 to 1000 s, got 5 and 4"),
    ("film.gif", {"start": "5 m"}, "plot.animation: start"),
    ("film.gif", {"frames": 1}, "plot.animation: frames must be"),
]


@pytest.mark.parametrize(("name", "given", "message"), REFUSED)
def test_what_cannot_be_shown_is_refused_in_one_line(tmp_path: Path, name: str, given: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError) as error:
        ChainPlots(run()).animation(tmp_path / name, **given)
    assert message in str(error.value)
    assert "\n" not in str(error.value)
    assert not list(tmp_path.iterdir())
