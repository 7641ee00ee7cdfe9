"""Files of strong motion in eleven layouts: one motion, known by content, with its unit, interval and count; what is refused."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.strong_motion.layouts import LAYOUTS, plain
from stickslip.foundation.columns import Table
from stickslip.foundation.errors import InputWarning
from stickslip.foundation.named_columns import NamedColumns
from stickslip.foundation.text_columns import read_file, read_text
from tests.extensions.strong_motion.layouts import files
from tests.extensions.strong_motion.layouts.files import COUNT, FILES, MOTION, STEP, TIME

WANTED = ("time", "ground_acceleration")
G = 9.80665
MOST = 2_000_000


def read(text: str, columns: dict[str, str] | None = None) -> Table:
    return read_text(text, WANTED, "a", MOST, named=NamedColumns(columns or {}))


def acceleration(table: Table) -> np.ndarray:
    """Accelerations in g."""
    return table.columns["ground_acceleration"] / G


def refused(text: str, columns: dict[str, str] | None = None) -> str:
    with pytest.raises(ss.InputError) as found:
        read(text, columns)
    message = str(found.value)
    assert message.startswith("a, line ")
    assert "\n" not in message
    return message.split(": ", 1)[1]


def told(text: str, columns: dict[str, str] | None = None) -> str:
    """What is said of a file that may be refused."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        try:
            return read(text, columns).place
        except ss.InputError as error:
            return str(error)


@pytest.mark.parametrize("layout", FILES)
def test_the_motion_is_read_in_each_layout(layout: str) -> None:
    """With its interval, its unit, its peak and its component in a note; CWB has three components, of which one is chosen."""
    written = FILES[layout]
    table = read(written.text(), {"ground_acceleration": "NS"} if layout == "CWB" else None)
    assert acceleration(table) == pytest.approx(MOTION, abs=written.error)
    assert np.ptp(acceleration(table) - MOTION) > 0.0
    assert table.columns["time"] == pytest.approx(TIME, abs=1e-12)
    assert table.interval == pytest.approx(STEP, rel=1e-15)
    assert table.doubts == ()
    said = re.fullmatch(r"(\d+) samples every (\S+) s, (\S+) (\S+) (?:\((\S+) g\) )?at most, from (.*)", table.notes[0])
    assert said is not None, table.notes
    assert (int(said[1]), float(said[2])) == (COUNT, STEP)
    assert float(said[5] or said[3]) == pytest.approx(np.abs(MOTION).max(), rel=2e-4)
    assert said[6] == written.header + (f", {written.component}" if written.component else "")
    assert said[4] == written.unit
    assert len(table.notes) == 1


@pytest.mark.parametrize("layout", FILES)
def test_exactly_one_layout_knows_a_file(layout: str) -> None:
    """By its content, whatever its name; only the last one, any text with an interval, may fit where another does."""
    first = FILES[layout].text().splitlines()[:200]
    fitting = [one for one in LAYOUTS if one.begins(first)]
    assert fitting[1:] in ([], [plain])


@pytest.mark.parametrize("layout", FILES)
def test_a_file_may_have_other_ends_of_lines_blanks_and_a_mark_at_its_begin(layout: str, tmp_path: Path) -> None:
    """CRLF, blanks behind the lines, empty lines at the end, the mark of UTF-8, and letters of Latin-1 in the header."""
    written = FILES[layout]
    text, columns = written.text(), NamedColumns({"ground_acceleration": "NS"} if layout == "CWB" else {})
    best = read_text(text, WANTED, "a", MOST, named=columns).columns["ground_acceleration"]
    odd = text.replace("\n", "   \r\n") + "\r\n  \r\n"
    letter = next(
        (
            word
            for word in ("MADE FOR TESTS", "text 1", "line of text 1", "TST", "made for tests", "A record", "Memo.")
            if word in text
        ),
        "",
    )
    contents = {
        "ends": odd.encode(),
        "mark": b"\xef\xbb\xbf" + text.encode(),
        "letters": text.replace(letter, letter[:-1] + "é", 1).encode("latin-1"),
    }
    for name, content in contents.items():
        path = tmp_path / name
        path.write_bytes(content)
        table = read_file(path, WANTED, (10**7, MOST), named=columns)
        assert (table.columns["ground_acceleration"] == best).all(), name


@pytest.mark.parametrize("layout", FILES)
def test_a_file_that_breaks_off_or_has_letters_in_its_numbers_is_refused_in_one_line(layout: str) -> None:
    """Where the layout counts its samples, or its seconds; the others end where they end."""
    text, columns = FILES[layout].text(), {"ground_acceleration": "NS"} if layout == "CWB" else None
    lines = text.splitlines()
    last = next(i for i in range(len(lines) - 1, -1, -1) if re.match(r"\s*[-+.\d]", lines[i]))
    torn = "\n".join([*lines[: last // 2], lines[last // 2][:-3] + "x.y", *lines[last // 2 + 1 :]])
    if layout.split()[0] not in ("COSMOS", "CSMIP", "GeoNet") or layout.endswith(("V1", "V1A")):
        assert "number" in refused(torn, columns)
    if layout not in ("CWB", "pySLAMMER", "text"):
        message = refused("\n".join(lines[: 3 * last // 10]), columns)
        assert re.search(r"says \d+ samples, but \d+ follow: the end is missing", message)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("seed", range(12))
def test_any_count_width_and_number_in_a_line_are_read(seed: int) -> None:
    """Random numbers of samples and of those in a line, and numbers of any size."""
    draw = np.random.default_rng(seed)
    count, across = int(draw.integers(2, 700)), int(draw.integers(1, 12))
    motion = draw.normal(size=count) * 10.0 ** draw.uniform(-3, 1)
    motion -= motion.mean()
    size = np.abs(motion).max()
    for text, error in (
        (files.at2(motion, across=across), 1e-6),
        (files.plain(motion, head=f"units: g\nnpts {count} dt 0.01", across=1), 1e-8),
        (files.dyna(motion), 1e-6 / size),
        (files.smc(motion), 1e-4),
        (files.obspy_text(motion, layout="SLIST"), 1e-9),
        (files.cosmos_channel(motion / size, columns=(across, 10 + across)), 1e-6),
        (files.geonet_component(0.9 * motion / size), 1e-5),
    ):
        table = read(text)
        found = acceleration(table)
        assert len(found) == count
        assert found / np.abs(found).max() == pytest.approx(motion / size, abs=error)
        assert table.interval == 0.01


def test_several_components_are_columns_of_which_one_is_chosen() -> None:
    """By its direction, or its number; without a choice the message names them; what is not asked for need not be chosen."""
    scales = {"N00E": 1.0, "UP": 0.5, "N90E": -0.25}
    text = "".join(files.geonet_component(scale * MOTION, direction=name) for name, scale in scales.items())
    message = refused(text)
    assert message == (
        "a file of GeoNet: 3 components, 'N00E', 'UP', 'N90E': choose one, as columns = { ground_acceleration = \"N00E\" }"
    )
    for i, (name, scale) in enumerate(scales.items()):
        for given in (name, str(i + 2)):
            table = read(text, {"ground_acceleration": given})
            assert acceleration(table) == pytest.approx(scale * MOTION, abs=1e-6)
            assert table.notes[0].endswith(f"from the header of GeoNet, {name}")
    assert "no column 'N45E' for ground_acceleration" in refused(text, {"ground_acceleration": "N45E"})
    assert list(read_text(text, ("time", "slip"), "a", MOST).columns) == ["time"]


def test_channels_of_one_direction_are_told_apart_by_their_number() -> None:
    """As in a building; COSMOS, CSMIP and CWB have several channels in a file, too."""
    twice = files.cosmos_channel() + files.cosmos_channel(-MOTION)
    assert "'channel 1 090', 'channel 2 090'" in refused(twice)
    assert acceleration(read(twice, {"ground_acceleration": "channel 2 090"})) == pytest.approx(-MOTION, abs=1e-6)
    pair = files.csmip_channel() + files.csmip_channel(0.5 * MOTION, channel="Chan  2:  UP")
    assert acceleration(read(pair, {"ground_acceleration": "UP"})) == pytest.approx(0.5 * MOTION, abs=1e-6)
    assert acceleration(read(files.cwb(), {"ground_acceleration": "EW"})) == pytest.approx(-MOTION, abs=1e-6)
    down = files.cwb(sequence="Time U(+); N(-); E(+)")
    assert acceleration(read(down, {"ground_acceleration": "NS"})) == pytest.approx(-MOTION, abs=1e-6)


def test_channels_may_have_different_numbers_of_samples_but_one_interval() -> None:
    """As those of a digital recorder often have by one or two."""
    pair = files.csmip_channel() + files.csmip_channel(MOTION[:-9], channel="Chan  2:  UP")
    assert acceleration(read(pair, {"ground_acceleration": "UP"})) == pytest.approx(MOTION[:-9], abs=1e-6)
    assert acceleration(read(pair, {"ground_acceleration": "090"})) == pytest.approx(MOTION, abs=1e-6)
    other = files.csmip_channel(said="points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.4)")
    assert "channels with different intervals" in refused(files.csmip_channel() + other)


REFUSED = {
    "too few": (files.at2(count=1010), "an AT2 file of PEER: its header says 1010 samples, but 1003 follow: the end is missing"),
    "too many": (files.at2(count=1000), "PEER: its header says 1000 samples, but 1003 follow: remove what is no sample"),
    "velocity": (files.at2(what="VELOCITY TIME SERIES IN UNITS OF CM/S"), "it holds velocity: give the file of the acceleration"),
    "displacement": (files.at2(what="DISPLACEMENT TIME HISTORY IN UNITS OF CM"), "it holds displacement: give the file of the acc"),
    "a velocity under the name of acceleration": (files.dyna(units="cm/s"), "it is in a unit of velocity"),
    "DYNA of velocity": (files.dyna(kind="VELOCITY", units="cm/s"), "it holds velocity"),
    "SMC of velocity": (files.smc(first="4 VELOCITY"), "a file of the USGS (SMC): it holds velocity"),
    "COSMOS of velocity": (files.cosmos_channel().replace("ted acceleration ", "ted velocity ", 1), "it holds velocity"),
    "text of velocity": (files.plain(head="velocity in cm/s, dt = 0.01 s"), "it holds velocity"),
    "no unit": (files.dyna(units=""), "no unit of acceleration; g, mg, gal, cm/s^2, mm/s^2, m/s^2, in/s^2 are known"),
    "text without a unit": (
        files.plain(head="dt = 0.01 s"),
        'it does not say the unit of its numbers (g, mg, gal, cm/s^2, mm/s^2, m/s^2, in/s^2): say it as columns = { ground_acc',
    ),
    "counts": (files.obspy_text(unit="Counts"), "it is in counts without a factor to an acceleration"),
    "COSMOS in counts": (files.cosmos_channel(unit="counts (50)"), "it is in counts without a factor"),
    "K-NET without a factor": (files.knet(factor=""), "no Scale Factor from counts to gal, as 7845(gal)/8223790"),
    "null": (files.smc(null=500), "sample 501 of 1003 of 090 is missing (1.7e+38), and 0 more: fill the gap first"),
    "nan": (files.dyna().replace(f"{files.GAL * MOTION[700]:.6f}", "NaN"), "sample 701 of 1003 of HNE is missing (nan)"),
    "gap": (files.cwb(gap=400), "a file of CWB (Taiwan): a gap: sample 401 is at 4.01 s, and SampleRate puts it at 4 s"),
    "second piece": (
        files.obspy_text() + files.obspy_text(start="2000-01-01T00:00:12.030000"),
        "a gap: a second piece of one channel begins 2 s after the first one ends",
    ),
    "no interval": (files.at2(fourth="NPTS= {count:6d}, DT=   .0000 SEC,"), "the sampling interval must be above 0"),
    "two intervals": (files.plain(head="g\ndt = 0.01 s, sampling rate 50 Hz"), "it states two intervals, 0.01 s and 0.02 s"),
    "two records in a file": (2 * files.at2(), "an AT2 file of PEER: text follows its samples: write each record to a file"),
    "K-NET that breaks off": (files.knet(seconds=30), "its header says 3000 samples, but 1003 follow"),
    "one sample": (files.at2(MOTION[:1]), "at least two samples are needed, got 1"),
}  # fmt: skip


@pytest.mark.parametrize("kind", REFUSED)
def test_what_contradicts_itself_or_is_missing_is_refused_in_one_line_that_names_the_layout(kind: str) -> None:
    text, message = REFUSED[kind]
    columns = {"ground_acceleration": "NS"} if text.startswith("#Earth") else None
    assert message in refused(text, columns)


def test_a_row_too_many_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ss.InputError, match=r"^a, sample 1001: more than 1000 rows$"):
        read_text(files.at2(), WANTED, "a", 1000)


def test_a_unit_that_the_user_gives_counts() -> None:
    """In text without a unit; where the file has another, with a warning."""
    bare = files.plain(head="dt = 0.01 s")
    table = read(bare, {"ground_acceleration": "ground_acceleration (gal)"})
    assert acceleration(table) == pytest.approx(MOTION / files.GAL, rel=1e-7)
    with pytest.warns(InputWarning, match="read in the unit that columns gives"):
        table = read(files.at2(), {"ground_acceleration": "2 (gal)"})
    assert acceleration(table) == pytest.approx(MOTION / files.GAL, rel=1e-5, abs=1e-12)


def test_an_offset_is_told_and_kept() -> None:
    """In the unit of the file, and as a share of the peak."""
    counts = np.round((MOTION * files.GAL - 5.0) / files.FACTOR).astype(int).tolist()
    table = read(files.knet(counts))
    assert acceleration(table).mean() * files.GAL == pytest.approx(-5.0, abs=1e-3)
    assert re.fullmatch(r"the mean of the samples is -5 gal, 1\.7 % of the peak", table.notes[1])


@pytest.mark.parametrize(
    ("head", "step"),
    [
        *(("Acceleration (g)\ndt = 0.005 s", 0.005), ("units g\nDT=0.01", 0.01), ("g\nSampling interval (s): 0.02", 0.02)),
        *(("in g's\nNPTS= 1003 DT= .005 SEC", 0.005), ("# g\n# sampling rate: 400 Hz", 0.0025), ("g\ndelta_t 5 ms", 0.005)),
        *(("cm/s/s? no, g\nTime step (ms) = 2.5", 0.0025), ("g\n1003 points, time interval= 0.0005", 0.0005)),
    ],
)
def test_the_interval_in_a_heading_is_found_in_many_words(head: str, step: float) -> None:
    across = 1 if head.startswith("#") else 5
    if head.startswith("cm"):
        head = head.replace("cm/s/s? no, ", "")
    table = read(files.plain(head=head, across=across))
    assert table.interval == pytest.approx(step, rel=1e-12)
    assert acceleration(table) == pytest.approx(MOTION, abs=1e-8)


def test_a_table_with_headings_stays_a_table_though_its_notes_state_an_interval() -> None:
    """Of a logger with other columns, and of a table whose first column is the time."""
    rows = "".join(f"{0.01 * i:.2f} {0.1 * i:.3f}\n" for i in range(9))
    for head in (
        "sampling interval 0.01 s\n\ntime (s)  slip (mm)\n",
        "dt = 0.01 s\ntime slip\n",
        "time (s),slip (mm) dt = 0.01 s\n",
    ):
        assert not plain.begins((head + rows).splitlines())
    table = read_text("sampling interval: 0.01 s\ntime (s)  slip (mm)\n" + rows, ("time", "slip"), "a", 100)
    assert table.columns["slip"] == pytest.approx(1e-4 * np.arange(9))
    assert table.interval is None


HEADS = {name: written.text().splitlines()[:3] for name, written in FILES.items()}
LONG_LINES = [
    *(" " * 10_000, "." * 10_000, "a:" * 5_000, "-1 " * 3_300, "(" * 10_000, "9" * 10_000),
    *("dt" + " " * 10_000, "#" * 10_000),
]


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("line", LONG_LINES, ids=lambda line: line[:3].strip() or "blanks")
def test_lines_made_to_hold_up_a_reader_do_not(line: str) -> None:
    """Behind the first one to three lines, or at their end; a pattern that tries all ways through one takes hours."""
    for head in HEADS.values():
        for count in (1, 2, 3):
            for text in ([*head[:count], *[line] * 20], [*head[: count - 1], head[count - 1] + line, line]):
                assert told("\n".join(text)).startswith("a")


@pytest.mark.sampled(every=20)
@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("layout", FILES)
def test_a_damaged_file_is_read_or_refused_in_one_line(layout: str, seed: int) -> None:
    """Lines are left out, repeated or cut, and letters are exchanged, most of them in the header."""
    draw = np.random.default_rng(seed)
    lines = FILES[layout].text().splitlines()
    for _ in range(int(draw.integers(1, 4))):
        i = min(int(draw.exponential(20.0)), len(lines) - 1)
        kind, at = draw.integers(5), int(draw.integers(max(1, len(lines[i]))))
        if kind == 0:
            del lines[i]
        elif kind == 1:
            lines.insert(i, lines[i])
        elif kind == 2:
            lines[i] = lines[i][:at]
        elif kind == 3:
            lines[i] = lines[i][:at] + str(draw.choice(list("0-9.,:x (=%é\t"))) + lines[i][at + 1 :]
        else:
            del lines[i:]
        lines = lines or [""]
    message = told("\n".join(lines), {"ground_acceleration": "NS"} if layout == "CWB" else None)
    assert message.startswith("a")
    assert "\n" not in message


def test_a_million_samples_take_no_more_than_a_few_times_their_own_memory() -> None:
    """And are all read."""
    motion = np.tile(MOTION, 200)
    text = files.at2(motion)
    table = read(text)
    assert len(table.columns["time"]) == len(motion)
    assert acceleration(table)[-1] == pytest.approx(MOTION[-1], rel=1e-6)
    assert table.columns["time"][-1] == pytest.approx(STEP * (len(motion) - 1), rel=1e-14)
