"""Write seismograms of the contact as miniSEED or SAC, by means of ObsPy (`pip install 'stickslip[seismology]'`)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, Unpack

from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError, nearest
from stickslip.io.sampling import SampledRun, Sampling, sample
from stickslip.solution.evaluation import Readings

Quantity = Literal["slip", "slip_rate", "traction"]
HEADERS: dict[Quantity, tuple[str, int, str]] = {
    "slip": ("U", 6, "m"),
    "slip_rate": ("V", 7, "m/s"),
    "traction": ("T", 5, "Pa"),
}
"""Of each quantity the last letter of the channel, SAC's code idep (displacement, velocity, unknown), and the unit."""
FORMATS = {".mseed": "MSEED", ".sac": "SAC"}
"""ObsPy's name of the format that belongs to each suffix."""
BANDS = ((1000.0, "F"), (250.0, "C"), (80.0, "H"), (10.0, "B"), (1.5, "M"), (0.5, "L"), (0.05, "V"))
"""Lowest sampling rate (Hz) of each band, and its letter in the SEED manual, appendix A; the letter is U below all of them."""


def write_seismogram(
    run: Readings,
    path: str | Path,
    sampling_rate: float,
    *,
    quantities: Sequence[Quantity] = ("slip_rate", "traction"),
    x: float = 0.0,
    network: str = "XX",
    station: str = "SLIDE",
    origin: str = "1970-01-01T00:00:00",
    **sampling: Unpack[Sampling],
) -> list[Path]:
    """Write quantities of a run, or of a window on it, in SI as miniSEED or SAC, and return the paths.

    The path is NAME.mseed for one file of 64-bit numbers, or NAME.sac for 32-bit numbers in one file for each quantity,
    NAME.slip_rate.sac and so on; a single quantity goes to NAME.sac. Quantities are "slip", "slip_rate" and "traction", at a
    distance `x` from the contact (m); inside the slab they are displacement, velocity and shear stress. There are `sampling_rate`
    samples per second (Hz), and the other arguments of `sample` may be given.

    Channels are named by the letter of the band, X for computed data, and U, V or T for slip, slip rate and traction. Slip is
    counted from the start of the run or, in a window, of the event. `network` and `station` are codes for the header, and `origin`
    is the date (ISO 8601, UTC) of t = 0, which in a window is the start of the event.

    Raises InputError as `sample` does; also if ObsPy is missing, or for an unknown suffix or quantity or an invalid date.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"{path}: the name must end in {' or '.join(FORMATS)}")
    for one in quantities:
        if one not in HEADERS:
            raise InputError(f"seismogram: unknown quantity {one!r}; {nearest(str(one), HEADERS)}")
    obspy = import_obspy()
    begin = _date(obspy, origin)
    series = sample(run, sampling_rate, x=x, **sampling)
    header = {"network": network, "station": station, "location": "", "starttime": begin + series.start}
    traces = {one: _trace(series, one, run.problem.load_unit, header) for one in quantities}
    if path.suffix.lower() == ".mseed":
        return [_write(obspy.Stream(list(traces.values())), path)]
    single = len(traces) == 1
    return [_write(obspy.Stream([trace]), path if single else path.with_suffix(f".{one}.sac")) for one, trace in traces.items()]


def import_obspy() -> Any:
    """Import ObsPy and return it. Raises InputError, with a message of one line, if it is missing."""
    try:
        import obspy
    except ImportError:
        raise InputError("miniSEED and SAC need ObsPy: pip install 'stickslip[seismology]'; .txt (SCEC) does not") from None
    return obspy


def _date(obspy: Any, text: str) -> Any:
    try:
        return obspy.UTCDateTime(text)
    except (TypeError, ValueError):
        raise InputError(f"seismogram: origin must be a date such as 1970-01-01T00:00:00, got {text!r}") from None


def band(sampling_rate: float) -> str:
    """Return the letter of the band to which a sampling rate (Hz) belongs: the first letter of the channel."""
    return next((letter for least, letter in BANDS if sampling_rate >= least), "U")


def _trace(series: SampledRun, one: Quantity, force: str, header: dict[str, Any]) -> Any:
    letter, kind, unit = HEADERS[one]
    header = header | {"channel": f"{band(series.rate)}X{letter}", "sampling_rate": series.rate}
    trace = import_obspy().Trace(getattr(series, one), header)
    trace.stats.sac = {"idep": kind, "kuser0": force if one == "traction" else unit}
    return trace


def _write(stream: Any, path: Path) -> Path:
    return write_atomically(path, lambda draft: stream.write(str(draft), format=FORMATS[path.suffix.lower()]))
