"""Traces and streams of ObsPy as records, by what they have: `data`, and `stats` with the interval; ObsPy itself is not needed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from stickslip.extensions.strong_motion.layouts.motion import NO_SAMPLE, UNITS, interval_of, unit_in
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError


class TraceSamples(NamedTuple):
    """The samples of a trace (m/s^2), their interval (s), and its name, with what was done to the interval."""

    values: Floats
    interval: float
    name: str


def is_trace(given: Any) -> bool:
    """Return True for a trace, or a stream of traces."""
    if hasattr(given, "stats") and hasattr(given, "data"):
        return True
    traces = getattr(given, "traces", None)
    return isinstance(traces, Sequence) and all(hasattr(one, "stats") for one in traces)


def samples_of(given: Any, unit: str | None = None, component: str | int | None = None) -> TraceSamples:
    """Return the samples of a trace, or of the trace of a stream that `component` names by its channel.

    Parameters
    ----------
    given
        A trace with `data` and `stats`, whose `delta` (s) or `sampling_rate` (Hz) is the interval, or a stream of such traces.
    unit
        The unit of the samples, as "m/s^2", "g" or "gal": a trace does not know it, and may be in counts.
    component
        The channel, as "HNE", or its last letter, or the number of the trace, from 1 on.

    Raises
    ------
    InputError
        For no unit, for samples that are no numbers or are missing, for a gap, and for several traces if none is named.
    """
    trace = _one_of(given, component)
    stats = trace.stats
    name = _name(stats)
    written = unit_in(unit) if isinstance(unit, str) else ""
    if written not in UNITS:
        got = "it may be in counts" if unit is None else f"got {shown(unit)}"
        raise InputError(f"trace {name}: say the unit of its samples, one of {', '.join(UNITS)}; {got}")
    if np.ma.is_masked(trace.data):
        raise InputError(f"trace {name}: a gap: some samples are masked; fill them first")
    try:
        values = np.asarray(trace.data, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"trace {name}: its data must be numbers") from None
    if values.ndim != 1 or len(values) < 2:
        raise InputError(f"trace {name}: its data must be a row of at least two samples")
    bad = np.flatnonzero(~(np.abs(values) < NO_SAMPLE))
    if len(bad):
        raise InputError(f"trace {name}: sample {bad[0] + 1} of {len(values)} is {values[bad[0]]:g}: fill the gap first")
    notes = list[str]()
    interval = _interval(stats, name, len(values), notes)
    return TraceSamples(values * UNITS[written], interval, name + "".join(f" ({note})" for note in notes))


def _one_of(given: Any, component: str | int | None) -> Any:
    """Return the trace, or the one of a stream. Raises InputError if none or several fit."""
    traces = [given] if hasattr(given, "data") and hasattr(given, "stats") else list(getattr(given, "traces", ()))
    if not traces:
        raise InputError(f"a trace, or a stream with one, is needed, got {shown(given)}")
    channels = [str(getattr(one.stats, "channel", "")) for one in traces]
    wanted = None if component is None else str(component).upper()
    fitting = [
        one
        for i, (one, channel) in enumerate(zip(traces, channels, strict=True), 1)
        if wanted is None or wanted in (channel.upper(), channel.upper()[-1:], str(i))
    ]
    if len(fitting) == 1:
        return fitting[0]
    names = ", ".join(f"'{channel}'" for channel in channels)
    if len(fitting) > 1 and len(set(channels)) < len(channels):
        raise InputError(f"stream: {len(fitting)} traces of channels {names}: a gap? Merge and fill them, or give one trace")
    what = "none fits" if not fitting else "choose one"
    raise InputError(f"stream: {len(traces)} traces of channels {names}: {what}, as component={channels[0]!r}")


def _interval(stats: Any, name: str, count: int, notes: list[str]) -> float:
    """Return the interval (s). Raises InputError if it is missing, or contradicts the rate, and if the count contradicts itself."""
    delta, rate = getattr(stats, "delta", None), getattr(stats, "sampling_rate", None)
    given = [float(delta)] if delta else []
    given += [1.0 / float(rate)] if rate else []
    if not given or not all(math.isfinite(one) and one > 0.0 for one in given):
        raise InputError(f"trace {name}: stats.delta (s) or stats.sampling_rate (Hz) must be above 0")
    if max(given) - min(given) > 1e-6 * min(given):
        raise InputError(f"trace {name}: stats.delta is {given[0]:g} s, but stats.sampling_rate makes it {given[1]:g} s")
    stated = getattr(stats, "npts", None)
    if stated is not None and int(stated) != count:
        raise InputError(f"trace {name}: stats.npts is {int(stated)}, but there are {count} samples")
    return interval_of(given[0], notes)


def _name(stats: Any) -> str:
    parts = [str(getattr(stats, part, "") or "") for part in ("network", "station", "location", "channel")]
    return ".".join(parts) if any(parts) else "without a name"
