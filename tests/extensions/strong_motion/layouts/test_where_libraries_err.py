"""Where readers of strong motion are known to err: in each case a synthetic file, and what is right."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.columns import Table
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.text_columns import read_text
from tests.extensions.strong_motion.layouts import files
from tests.extensions.strong_motion.layouts.files import COUNT, FACTOR, GAL, MOTION

G = 9.80665


def read(text: str, component: str | None = None) -> Table:
    named = NamedColumns({} if component is None else {"ground_acceleration": component})
    return read_text(text, ("time", "ground_acceleration"), "a", 10**6, named=named)


@pytest.mark.parametrize("left", range(5))
def test_the_last_line_of_an_at2_file_is_read(left: int) -> None:
    """Two readers leave it out, whether it is short or whole."""
    motion = MOTION[: COUNT - left]
    found = read(files.at2(motion)).columns["ground_acceleration"] / G
    assert len(found) == len(motion)
    assert found[-6:] == pytest.approx(motion[-6:], abs=6e-8)


@pytest.mark.parametrize(
    ("text", "interval"), [(".0025", 0.0025), ("0.00125", 0.00125), ("2.5E-4", 2.5e-4), (".004166667", 0.004166667)]
)
def test_an_interval_that_is_no_whole_millisecond_stays_what_it_is(text: str, interval: float) -> None:
    """One reader rounds to 1 ms, so that 400 Hz become 333 Hz and a displacement 1.44 times as large."""
    for file in (
        files.at2(fourth=f"NPTS= {{count:6d}}, DT=   {text} SEC,"),
        files.at2(fourth=f"{{count:5d}}    {text}    NPTS, DT"),
        files.dyna(interval=text),
        files.plain(head=f"g\ndt = {text} s" if text[0] != "." else f"g\ndt={text} s"),
    ):
        assert read(file).interval == interval
        assert np.diff(read(file).columns["time"]) == pytest.approx(interval, rel=1e-9)


@pytest.mark.parametrize(
    "fourth",
    [
        *(
            "NPTS=   {count}, DT=   .0100 SEC,",
            "NPTS={count},DT=.0100 SEC",
            "NPTS= {count}, DT= .0100 SEC",
            "npts={count} dt=.01 sec",
        ),
        *(
            "{count}    .0100    NPTS, DT",
            " {count}  0.01  NPTS, DT",
            "NPTS = {count} , DT = .0100 SEC",
            "NPTS=  {count}, DT=  1.00E-02 SEC",
        ),
    ],
)
def test_every_way_to_write_the_fourth_line_of_an_at2_file_is_read(fourth: str) -> None:
    """One reader makes ten times the interval of `.0100`, and one refuses the standard header."""
    table = read(files.at2(fourth=fourth))
    assert table.interval == 0.01
    assert len(table.columns["time"]) == COUNT


def test_the_factor_of_a_file_of_k_net_is_its_own_after_another_file() -> None:
    """One reader applies it twice after a file of its own layout."""
    counts = np.round(MOTION * GAL / FACTOR).astype(int).tolist()
    best = 1e-2 * np.array(counts) * FACTOR
    for _ in range(3):
        assert read(files.knet(counts)).columns["ground_acceleration"] == pytest.approx(best, rel=1e-14)
        other = read(files.knet(counts, factor="3920(gal)/6182761", direction="E-W")).columns["ground_acceleration"]
        assert other == pytest.approx(1e-2 * np.array(counts) * 3920 / 6182761, rel=1e-14)


def test_azimuths_at_the_same_angle_from_north_are_two_components() -> None:
    """One reader takes 045 and 315 as the same file twice."""
    text = files.csmip_channel(channel="Chan  1:  45 Deg") + files.csmip_channel(-0.5 * MOTION, channel="Chan  2: 315 Deg")
    assert read(text, "045").columns["ground_acceleration"] / G == pytest.approx(MOTION, abs=1e-6)
    assert read(text, "315").columns["ground_acceleration"] / G == pytest.approx(-0.5 * MOTION, abs=1e-6)
    with pytest.raises(ss.InputError, match=r"2 components, '045', '315': choose one"):
        read(text)


def test_an_smc_file_is_in_cm_per_second_squared() -> None:
    """One reader takes its numbers for g; its columns touch each other."""
    text = files.smc()
    assert "E+1-" in text
    table = read(text)
    assert np.abs(table.columns["ground_acceleration"]).max() == pytest.approx(G * np.abs(MOTION).max(), rel=1e-4)


@pytest.mark.parametrize(
    ("stated", "meant"), [("0.004999999888", 0.005), ("0.009999999776482582", 0.01), ("0.0024999999441206455", 0.0025)]
)
def test_an_interval_of_single_precision_is_what_was_meant_and_is_said(stated: str, meant: float) -> None:
    """Programs that keep it as a number of single precision write its last digits; one reader rounds it to a microsecond."""
    table = read(files.dyna(interval=stated))
    assert table.interval == meant
    assert table.notes[0].startswith(f"1003 samples every {meant:g} s")
    assert table.notes[1] == f"the interval {float(stated):.10g} s is {meant:g} s in single precision"


@pytest.mark.parametrize("stated", ["0.0049999", "0.00333333", "0.0078125", "0.00390625", "0.01000002", "0.005"])
def test_an_interval_that_is_none_of_single_precision_stays_what_it_is(stated: str) -> None:
    table = read(files.dyna(interval=stated))
    assert table.interval == float(stated)
    assert len(table.notes) == 1
