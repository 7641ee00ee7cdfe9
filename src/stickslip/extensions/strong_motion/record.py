"""`ss.loading.record`: the record of an accelerometer from its file, in whatever format of text it came, or from ObsPy."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from stickslip.foundation.arguments import as_path, for_users, shown
from stickslip.foundation.errors import InputError
from stickslip.problem import Accelerogram
from stickslip.problem.scenarios import fields_of_file

WHO = "record"


@for_users
def record(
    source: str | Path | Any,
    *,
    component: str | int | None = None,
    polarity: Literal[1, -1] = 1,
    scale: float = 1.0,
    baseline: Literal["mean"] | None = None,
    columns: Mapping[str, str | int] | None = None,
    unit: str | None = None,
) -> Accelerogram:
    r"""Read the acceleration of the ground from a file of a recorder, or from a trace or stream of ObsPy.

    Units, number of samples, interval and sign are those of the file; `print(record)` says what was found.

    Parameters
    ----------
    source
        The name of a file: PEER (.AT2), K-NET and KiK-net, COSMOS, CSMIP, SMC, ESM (DYNA), GeoNet, CWB, TSPAIR of ObsPy, or any
        text with columns `time (s)` and `acceleration (g)`. Formats are known by what stands in the file, not by its name. Or an
        object of ObsPy, which need not be installed here.
    component
        Which of several components: the heading of its column, such as "N90E", or its number.
    polarity
        1 as recorded, -1 for the opposite direction. A load on a block gains -m times the acceleration of the ground, so that
        with 1 a positive acceleration slides the block backwards.
    scale
        Factor on the samples.
    baseline
        "mean" takes the mean off the samples, as the offset of an instrument. By default nothing is taken off.
    columns
        Headings of a table by their meaning, as {"time": "Zeit (ms)", "ground_acceleration": "3 (gal)"}.
    unit
        Unit of the samples of an object of ObsPy, which has none.

    Returns
    -------
    Accelerogram
        A loading history for `ground_acceleration`, in m/s^2: straight lines between samples, 0 after the last one.

    Raises
    ------
    InputError
        If the file cannot be read, contradicts itself, or holds something else; the message is one line that says what was found.

    Examples
    --------
    >>> import stickslip as ss
    >>> with open("made.csv", "w") as file:
    ...     _ = file.write("time (s),acceleration (g)\n0.00,0\n0.01,0.2\n0.02,-0.1\n0.03,0\n")
    >>> ss.loading.record("made.csv").about
    '4 samples every 10 ms, 0.2 g at most'
    """
    if component is not None and columns is not None and "ground_acceleration" in columns:
        raise InputError(f"{WHO}: component and columns both say which column is {'ground_acceleration'}: give one of them")
    if isinstance(source, str | Path):
        if unit is not None:
            cure = 'that of a column goes with columns, as {"ground_acceleration": "3 (gal)"}'
            raise InputError(f"{WHO}: unit is for objects of ObsPy; {cure}")
        named = dict(columns or {}) | ({} if component is None else {"ground_acceleration": str(component)})
        fields = fields_of_file(as_path(f"{WHO}: source", source), named, baseline)
    else:
        fields = _of_trace(source, component, unit, baseline)
    return Accelerogram(**fields, scale=scale, polarity=polarity)


def _of_trace(source: Any, component: str | int | None, unit: str | None, baseline: str | None) -> dict[str, Any]:
    """Return the fields of the record in an object of ObsPy. Raises InputError."""
    from stickslip.extensions.strong_motion.obspy_traces import samples_of

    if not hasattr(source, "stats") and not hasattr(source, "traces"):
        wanted = "the name of a file, or a trace or stream of ObsPy"
        raise InputError(
            f"{WHO}: source must be {wanted}, got {shown(source)}; arrays make one as ss.loading.Accelerogram(values, interval)"
        )
    values, interval, name = samples_of(source, unit, None if component is None else str(component))
    return {"values": values, "interval": interval, "origin": name} | ({} if baseline is None else {"offset": float(values.mean())})
