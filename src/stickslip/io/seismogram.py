"""Seismograms of the contact as miniSEED or SAC, written by ObsPy (`pip install 'stickslip[seismology]'`)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError, nearest
from stickslip.io.sampling import Series, sample
from stickslip.solution.evaluation import Readings

Quantity = Literal["slip", "slip_rate", "traction"]
CODES: dict[Quantity, str] = {"slip": "U", "slip_rate": "V", "traction": "T"}
"""Last letter of the channel."""
FORMATS = {".mseed": "MSEED", ".sac": "SAC"}
BANDS = ((1000.0, "F"), (250.0, "C"), (80.0, "H"), (10.0, "B"), (1.5, "M"), (0.5, "L"), (0.05, "V"))
"""Letters of the SEED manual, appendix A, for sampling rates (Hz) from so many on; below them "U"."""
KINDS: dict[Quantity, tuple[int, str]] = {"slip": (6, "m"), "slip_rate": (7, "m/s"), "traction": (5, "Pa")}
"""SAC's idep (displacement, velocity, unknown), and the unit."""


def write_seismogram(
    run: Readings,
    path: str | Path,
    sampling_rate: float,
    *,
    quantities: Sequence[Quantity] = ("slip_rate", "traction"),
    start: float | None = None,
    end: float | None = None,
    antialias: bool = False,
    x: float = 0.0,
    network: str = "XX",
    station: str = "SLIDE",
    origin: str = "1970-01-01T00:00:00",
) -> list[Path]:
    """Write quantities of the contact in SI as miniSEED (.mseed: one file, 64-bit numbers) or SAC (.sac: 32-bit numbers, a file for
    each quantity, NAME.slip_rate.sac, or just NAME.sac for a single one). Returns the paths.

    For rate, times, filter and x, the distance (m) from the contact, see `sample`; inside the slab displacement, velocity and
    shear stress stand for slip, slip rate and traction. `origin` (ISO 8601, UTC) is the date of t = 0 (of the start of the event,
    in a window). Channels are the band's letter, X for computed, and U, V or T for slip, slip rate, traction; slip counts from
    the start of the run. Raises InputError without ObsPy, for another suffix, a quantity or a date that is none, and like `sample`.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"{path}: the name must end in {' or '.join(FORMATS)}")
    for one in quantities:
        if one not in CODES:
            raise InputError(f"seismogram: unknown quantity {one!r}; {nearest(str(one), CODES)}")
    obspy = import_obspy()
    begin = _date(obspy, origin)
    series = sample(run, sampling_rate, start=start, end=end, antialias=antialias, x=x)
    codes = {"network": network, "station": station}
    traces = {one: _trace(obspy, series, one, run.problem.load_unit, begin, codes) for one in quantities}
    if path.suffix.lower() == ".mseed":
        return [_write(obspy.Stream(list(traces.values())), path)]
    single = len(traces) == 1
    return [_write(obspy.Stream([trace]), path if single else path.with_suffix(f".{one}.sac")) for one, trace in traces.items()]


def import_obspy() -> Any:
    """ObsPy. Raises InputError, one line, where it is missing."""
    try:
        import obspy
    except ImportError:
        raise InputError("miniSEED and SAC need ObsPy: pip install 'stickslip[seismology]'; .txt (SCEC) does not") from None
    return obspy


def _date(obspy: Any, text: str) -> Any:
    try:
        return obspy.UTCDateTime(text)
    except (TypeError, ValueError):
        raise InputError(f"seismogram: origin must be a date as 1970-01-01T00:00:00, got {text!r}") from None


def band(sampling_rate: float) -> str:
    """First letter of the channel."""
    return next((letter for least, letter in BANDS if sampling_rate >= least), "U")


def _trace(obspy: Any, series: Series, one: Quantity, force: str, begin: Any, codes: dict[str, str]) -> Any:
    kind, unit = KINDS[one]
    header = codes | {"location": "", "channel": f"{band(series.rate)}X{CODES[one]}", "sampling_rate": series.rate}
    trace = obspy.Trace(getattr(series, one), header | {"starttime": begin + series.start})
    trace.stats.sac = {"idep": kind, "kuser0": force if one == "traction" else unit}
    return trace


def _write(stream: Any, path: Path) -> Path:
    return write_atomically(path, lambda draft: stream.write(str(draft), format=FORMATS[path.suffix.lower()]))
