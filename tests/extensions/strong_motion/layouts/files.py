"""Synthetic files of strong motion: one motion, written in each layout as the programs of that layout write it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

STEP = 0.01
COUNT = 1003
TIME = STEP * np.arange(COUNT)
MOTION: NDArray[np.float64] = 0.3 * np.sin(0.9 * TIME) ** 2 * np.sin(11.0 * TIME + 0.4 * TIME**2)
"""The motion in g, at most 0.3 g; its mean is next to nothing."""
MOTION -= MOTION.mean()
GAL = 980.665
"""One g in cm/s^2."""
FACTOR = 7845 / 8223790
"""From counts to gal."""
FORMAT_OF_GAL = "{:10.4f}"


def rows(numbers: Sequence[str], across: int) -> list[str]:
    """Numbers as lines with so many of them in each."""
    return ["".join(numbers[i : i + across]) for i in range(0, len(numbers), across)]


def fortran(value: float, width: int = 15, digits: int = 7) -> str:
    """A number as Fortran writes it: without a digit before the point."""
    mantissa, _, exponent = f"{value:.{digits - 1}E}".partition("E")
    sign, figures = ("-" if mantissa[0] == "-" else ""), mantissa.lstrip("-").replace(".", "")
    power = int(exponent) + 1 if value else 0
    return f"{sign}.{figures}E{power:+03d}".rjust(width)


def at2(
    motion: NDArray[np.float64] = MOTION,
    count: int | None = None,
    fourth: str = "NPTS= {count:6d}, DT=   .0100 SEC,",
    what: str = "ACCELERATION TIME SERIES IN UNITS OF G",
    across: int = 5,
) -> str:
    """A file of PEER."""
    head = ["MADE FOR TESTS", "Test earthquake, 1/1/2000, Station One, 090", what]
    head.append(fourth.format(count=len(motion) if count is None else count))
    return "\n".join([*head, *rows([fortran(one) for one in motion], across)]) + "\n"


def knet(
    counts: Sequence[int] | None = None,
    factor: str = "7845(gal)/8223790",
    direction: str = "N-S",
    rate: int = 100,
    seconds: int = 10,
) -> str:
    """A file of K-NET; by default of the whole motion, in counts."""
    found = np.round(MOTION * GAL / FACTOR).astype(int).tolist() if counts is None else counts
    said = [
        *(("Origin Time", "2000/01/01 00:00:00"), ("Lat.", "38.103"), ("Long.", "142.860"), ("Depth. (km)", "24"), ("Mag.", "7.0")),
        *(("Station Code", "TST001"), ("Station Lat.", "38.7292"), ("Station Long.", "141.0217"), ("Station Height(m)", "40")),
        *(("Record Time", "2000/01/01 00:00:36"), ("Sampling Freq(Hz)", f"{rate}Hz"), ("Duration Time(s)", f"{seconds}")),
        *(("Dir.", direction), ("Scale Factor", factor), ("Max. Acc. (gal)", "294.0"), ("Last Correction", "2000/01/01 00:00:21")),
    ]
    head = [f"{key:18s}{value}" for key, value in said]
    return "\n".join([*head, "Memo.", *rows([f"{one:9d}" for one in found], 8)]) + "\n"


def cosmos_channel(
    motion: NDArray[np.float64] = MOTION,
    angle: int = 90,
    unit: str = "cm/sec2 (04)",
    factor: float = GAL,
    level: str = "Corrected",
    columns: tuple[int, int] = (8, 10),
    count: int | None = None,
) -> str:
    """A channel of COSMOS V1 or V2, with blocks of velocity and displacement behind it if it is corrected."""
    whole, real = [-999] * 100, [-999.0] * 100
    whole[53], real[61], real[62] = angle, 1000.0 * STEP, len(motion) * STEP
    across, width = columns
    n = len(motion) if count is None else count
    head = [f"{level} acceleration  (Format v01.20 with 13 text lines)  made for tests", *(f"text {i}" for i in range(12))]
    head += [" 100 Integer-header values follow on  10 lines, Format=(10I8)", *rows([f"{one:8d}" for one in whole], 10)]
    head += [" 100 Real-header values follow on  17 lines, Format=(6F13.4)", *rows([f"{one:13.4f}" for one in real], 6)]
    head += ["   2 Comment line(s) follow, each starting with a '|':", "| first", "| 12 velocity pts"]
    head.append(f"{n:8d} acceleration pts, approx  10 secs, units={unit}, Format=({across}F{width}.4)")
    lines = [*head, *rows([f"{factor * one:{width}.4f}" for one in motion], across)]
    if level == "Corrected":
        for what in ("velocity", "displacement"):
            lines.append(f"{n:8d} {what} pts, approx 10 secs, units=cm/sec (05), Format=(8F10.5)")
            lines += rows([f"{0.001 * i:10.5f}" for i in range(n)], 8)
    return "\n".join([*lines, "End-of-data for Chan  1 acceleration"]) + "\n"


def csmip_channel(
    motion: NDArray[np.float64] = MOTION,
    level: str = "Corrected",
    channel: str = "Chan  1:  90 Deg",
    said: str = "points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.4)",
    factor: float = GAL,
    digits: str = "10.4f",
) -> str:
    """A channel of CSMIP, V1 (Uncorrected) or V2."""
    head = [f"{level} accelerogram data     Processed: 01/01/00, made for tests", *(f"line of text {i}" for i in range(5))]
    head += [channel, *(f"line of text {i}" for i in range(6 if level == "Uncorrected" else 18))]
    head += rows([f"{i:5d}" for i in range(100)], 16) + rows([f"{0.1 * i:10.3f}" for i in range(100)], 8)
    lines = [*head, f"{len(motion):6d} {said}", *rows([f"{factor * one:{digits}}" for one in motion], 8)]
    if level == "Corrected":
        for what in ("veloc", "displ"):
            lines.append(f"{len(motion):6d} points of {what} data equally spaced at .010 sec, in cm. (8f10.4)")
            lines += rows([f"{0.01 * i:10.4f}" for i in range(len(motion))], 8)
    return "\n".join([*lines, "/&  ----------  End of data for channel  1"]) + "\n"


def smc(
    motion: NDArray[np.float64] = MOTION,
    first: str = "2 CORRECTED ACCELEROGRAM",
    count: int | None = None,
    azimuth: int = 90,
    rate: float = 1.0 / STEP,
    null: int | None = None,
) -> str:
    """A file of the USGS; the sample `null` has the number that marks a missing one."""
    whole, real = [-32768] * 48, [1.7e38] * 50
    whole[12], whole[13], whole[15], whole[16] = 90, azimuth, 2, len(motion) if count is None else count
    real[1] = rate
    cells = [f"{GAL * one:10.4E}".replace("E+0", "E+").replace("E-0", "E-").rjust(10) for one in motion]
    if null is not None:
        cells[null] = " 1.7000E38"
    head = [first, *(f"text {i} of the header" for i in range(10))]
    head += rows([f"{one:10d}" for one in whole], 8) + rows([f"{one:15.7E}" for one in real], 5)
    return "\n".join([*head, "| a comment", "|", *rows(cells, 8)]) + "\n"


def dyna(
    motion: NDArray[np.float64] = MOTION,
    units: str = "cm/s^2",
    kind: str = "ACCELERATION",
    count: int | None = None,
    interval: str = "0.010000",
) -> str:
    """A file of ESM."""
    said = {"EVENT_NAME": "Città di prova", "EVENT_ID": "TEST-0001", "NETWORK": "XX", "STATION_CODE": "TST", "LOCATION": ""}
    said |= {f"KEY_{i}": f"{i}" for i in range(20)}
    said |= {"SAMPLING_INTERVAL_S": interval, "NDATA": f"{len(motion) if count is None else count}", "UNITS": units}
    said |= {"STREAM": "HNE", "DATA_TYPE": kind, "HEADER_FORMAT": "DYNA 1.2"}
    said |= {f"USER{i}": "" for i in range(64 - len(said))}
    return "\n".join([*(f"{key}: {value}" for key, value in said.items()), *(f"{GAL * one:.6f}" for one in motion)]) + "\n"


def geonet_component(motion: NDArray[np.float64] = MOTION, level: str = "Corrected", direction: str = "N90E") -> str:
    """A component of GeoNet, V1A (Uncorrected) or V2A."""
    n, table = len(motion), np.zeros((10, 10))
    table[3, 0] = n if level == "Uncorrected" else 0
    table[3, 3:6] = (n, n, n) if level == "Corrected" else 0
    table[6, 5] = STEP
    head = [f"{level} accelerogram 20000101_000000_TEST_20 GNS Science", *(f"text {i}" for i in range(8))]
    head += [
        f"Number of points  {n}    Duration {n * STEP:.2f} s",
        "text",
        "text",
        f"Component {direction}",
        "text",
        "text",
        "text",
    ]
    head += [
        *("".join(f"{one:8.0f}" for one in row) for row in table[:4]),
        *("".join(f"{one:8.3f}" for one in row) for row in table[4:]),
    ]
    lines = [*head, *rows([f"{10.0 * GAL * one:8.2f}" for one in motion], 10)]
    if level == "Corrected":
        lines += 2 * rows([f"{0.1 * (i % 50):8.2f}" for i in range(n)], 10)
    return "\n".join(lines) + "\n"


def cwb(
    motion: NDArray[np.float64] = MOTION, unit: str = "gal.", sequence: str = "Time U(+); N(+); E(+)", gap: int | None = None
) -> str:
    """A file of Taiwan; with a gap, one row is left out."""
    head = [
        "#Earthquake Information",
        "#Origin Time(GMT+8): 2000/01/01-00:00:00.000",
        "#StationCode: TST",
        "#StartTime: 2000/01/01-00:00:00.000",
    ]
    head += ["#RecordLength(sec): 10", "#SampleRate(Hz): 100", f"#AmplitudeUnit: {unit}", "#AmplitudeMAX. U:  1.0~ -2.0"]
    head += [f"#DataSequence: {sequence}", "#Data: 4F10.3"]
    lines = [
        "".join(f"{one:10.3f}" for one in (t, 0.1, GAL * a, -GAL * a))
        for t, a in zip(STEP * np.arange(len(motion)), motion, strict=True)
    ]
    if gap is not None:
        del lines[gap]
    return "\n".join([*head, *lines]) + "\n"


def obspy_text(
    motion: NDArray[np.float64] = MOTION,
    layout: str = "TSPAIR",
    unit: str = "M/S**2",
    start: str = "2000-01-01T00:00:00.000000",
    count: int | None = None,
    channel: str = "HNE",
) -> str:
    """Text as ObsPy writes it."""
    count = len(motion) if count is None else count
    said = f"TIMESERIES XX_TST__{channel}_, {count} samples, 100 sps, {start}, {layout}, FLOAT, {unit}"
    cells = [f"{9.80665 * one:+.10e}" for one in motion]
    if layout == "TSPAIR":
        return "\n".join([said, *(f"2000-01-01T00:00:{t:09.6f}  {cell}" for t, cell in zip(TIME, cells, strict=False))]) + "\n"
    return "\n".join([said, *("\t".join(cells[i : i + 6]) for i in range(0, len(cells), 6))]) + "\n"


def slammer(motion: NDArray[np.float64] = MOTION, unit: str = "g's") -> str:
    """A record as pySLAMMER has them."""
    lines = (f"{round(STEP * i, 6)},{one:.9g}" for i, one in enumerate(motion))
    return "\n".join(["# Time Series: made for tests", f"# Time (s),Acceleration ({unit})", *lines]) + "\n"


def plain(motion: NDArray[np.float64] = MOTION, head: str = "A record\nAcceleration in g, dt = 0.01 s", across: int = 1) -> str:
    """Text with an interval in its heading."""
    return "\n".join([head, *rows([f" {one:.8e}" for one in motion], across)]) + "\n"


class Written(NamedTuple):
    """A file of the motion: its text, how exact its numbers are (g), how it names the component, and the header in its note."""

    text: Callable[[], str]
    error: float
    component: str
    header: str
    unit: str = "g"


FILES = {
    "AT2": Written(at2, 6e-8, "", "PEER's header"),
    "AT2, the old header": Written(lambda: at2(fourth="{count:5d}    .0100    NPTS, DT"), 6e-8, "", "PEER's header"),
    "K-NET": Written(knet, 0.6 * FACTOR / GAL, "NS", "the header of K-NET", "gal"),
    "COSMOS V2": Written(cosmos_channel, 6e-5 / GAL, "090", "the header of COSMOS", "cm/s^2"),
    "COSMOS V1": Written(
        lambda: cosmos_channel(level="Uncorrected", unit="g (02)", factor=1.0), 6e-5, "090", "the header of COSMOS"
    ),
    "CSMIP V2": Written(csmip_channel, 6e-5 / GAL, "090", "the header of CSMIP", "cm/s^2"),
    "CSMIP V1": Written(
        lambda: csmip_channel(level="Uncorrected", said="Accelerogram points at 100 pts/sec in units of g.  Format: (8f9.6)",
                              factor=1.0, digits="9.6f"), 6e-7, "090", "the header of CSMIP",
    ),
    "SMC": Written(smc, 2e-5, "090", "the header of an SMC file", "cm/s^2"),
    "DYNA": Written(dyna, 6e-7 / GAL, "HNE", "the header of ESM", "cm/s^2"),
    "GeoNet V2A": Written(geonet_component, 6e-3 / (10.0 * GAL), "N90E", "the header of GeoNet", "mm/s^2"),
    "GeoNet V1A": Written(
        lambda: geonet_component(level="Uncorrected"), 6e-3 / (10.0 * GAL), "N90E", "the header of GeoNet", "mm/s^2"
    ),
    "CWB": Written(cwb, 6e-4 / GAL, "NS", "the header of CWB", "gal"),
    "TSPAIR": Written(obspy_text, 1e-10, "HNE", "the header of ObsPy's text", "m/s^2"),
    "SLIST": Written(lambda: obspy_text(layout="SLIST"), 1e-10, "HNE", "the header of ObsPy's text", "m/s^2"),
    "pySLAMMER": Written(slammer, 1e-9, "", "the headings of pySLAMMER"),
    "text": Written(plain, 1e-8, "", "its heading"),
    "text, eight in a line": Written(
        lambda: plain(head="made for tests\nUNITS OF G\nNPTS= 1003 DT= .01 SEC", across=8), 1e-8, "", "its heading"
    ),
}  # fmt: skip
"""Each layout."""
