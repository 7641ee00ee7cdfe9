"""Traces and streams of ObsPy as objects: what they have is enough, and what they do not say is asked for."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.strong_motion.obspy_traces import is_trace, samples_of

MOTION = np.sin(0.1 * np.arange(200)).astype(np.float32)


def trace(data: Any = MOTION, channel: str = "HNE", **stats: Any) -> SimpleNamespace:
    """A stand-in for a trace of ObsPy."""
    known = {"network": "XX", "station": "TST", "location": "", "channel": channel, "delta": 0.005, "sampling_rate": 200.0}
    return SimpleNamespace(data=data, stats=SimpleNamespace(**{**known, "npts": len(data), **stats}))


def stream(*traces: SimpleNamespace) -> SimpleNamespace:
    return SimpleNamespace(traces=list(traces))


@pytest.mark.parametrize(("unit", "size"), [("g", 9.80665), ("m/s^2", 1.0), ("M/S**2", 1.0), ("cm/s2", 1e-2), ("gal", 1e-2)])
def test_the_samples_of_a_trace_are_taken_in_the_unit_that_is_given(unit: str, size: float) -> None:
    found = samples_of(trace(), unit)
    assert found.values == pytest.approx(size * MOTION.astype(float), rel=1e-15)
    assert found[1:] == (0.005, "XX.TST..HNE")


def test_an_interval_of_single_precision_is_what_was_meant() -> None:
    """As of a file of SAC, whose interval is 0.004999999888."""
    single = float(np.float32(0.005))
    found = samples_of(trace(delta=single, sampling_rate=1.0 / single), "g")
    assert found.interval == 0.005
    assert found.name == "XX.TST..HNE (the interval 0.004999999888 s is 0.005 s in single precision)"
    assert samples_of(trace(delta=None), "g").interval == 0.005
    assert samples_of(trace(delta=1.0 / 300.0, sampling_rate=300.0), "g").interval == 1.0 / 300.0


def test_one_trace_of_a_stream_is_chosen_by_its_channel() -> None:
    three = stream(*(trace((i + 1) * MOTION, f"HN{letter}") for i, letter in enumerate("ENZ")))
    assert is_trace(three)
    assert is_trace(trace())
    assert not is_trace([0.0, 1.0])
    assert not is_trace(MOTION)
    for name in ("HNN", "hnn", "N", 2, "2"):
        assert samples_of(three, "m/s^2", name).values == pytest.approx(2.0 * MOTION, rel=1e-6)
    with pytest.raises(ss.InputError, match=r"^stream: 3 traces of channels 'HNE', 'HNN', 'HNZ': choose one, as component='HNE'$"):
        samples_of(three, "g")
    with pytest.raises(ss.InputError, match="none fits"):
        samples_of(three, "g", "BHZ")
    with pytest.raises(ss.InputError, match="2 traces of channels 'HNE', 'HNE': a gap"):
        samples_of(stream(trace(), trace()), "g")
    with pytest.raises(ss.InputError, match="a trace, or a stream with one, is needed"):
        samples_of(stream(), "g")


@pytest.mark.parametrize(
    ("given", "unit", "message"),
    [
        (trace(), None, "trace XX.TST..HNE: say the unit of its samples, one of g, mg, .*; it may be in counts"),
        (trace(), "counts", "say the unit of its samples, .*; got 'counts'"),
        (trace(), "cm/s", "say the unit of its samples"),
        (trace(np.where(np.arange(200) == 7, np.nan, MOTION)), "g", "sample 8 of 200 is nan: fill the gap first"),
        (trace(np.ma.masked_greater(MOTION, 0.9)), "g", "a gap: some samples are masked"),
        (trace(npts=300), "g", "stats.npts is 300, but there are 200 samples"),
        (trace(delta=0.01), "g", "stats.delta is 0.01 s, but stats.sampling_rate makes it 0.005 s"),
        (trace(delta=0.0, sampling_rate=None), "g", "must be above 0"),
        (trace(np.array([["a", "b"]])), "g", "its data must be numbers"),
        (trace(MOTION.reshape(2, 100), npts=2), "g", "a row of at least two samples"),
    ],
)
def test_what_a_trace_lacks_is_refused_in_one_line(given: SimpleNamespace, unit: str | None, message: str) -> None:
    with pytest.raises(ss.InputError, match=message) as found:
        samples_of(given, unit)
    assert "\n" not in str(found.value)
