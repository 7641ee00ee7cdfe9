"""Straight segments of a loading, as they leave a driver and as they arrive at the contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading_history import SILENT, LoadingHistory, Tone
from stickslip.problem.problem import Problem


def scaled(history: float | LoadingHistory | None, gain: float) -> tuple[Floats, Tone]:
    """Return the starts (s), values and slopes (rows) of a history, and its tone, the last three times a number.

    A constant is one part, and None stands for 0.
    """
    if not isinstance(history, LoadingHistory):
        return np.array([[0.0], [gain * (history or 0.0)], [0.0]]), SILENT
    amplitude, frequency, phase = history.tone
    tone = Tone(gain * amplitude, frequency, phase) if amplitude != 0.0 else SILENT
    start, value, slope = history.parts
    return np.array([start, gain * value, gain * slope]), tone


def straight(parts: Floats, start: Floats) -> tuple[Floats, Floats]:
    """Return the values and the slopes of straight parts (rows as of `scaled`), from times (s) on."""
    own, value, slope = parts
    n = np.searchsorted(own, start, side="right") - 1
    return value[n] + slope[n] * (start - own[n]), slope[n]


def put_way(history: float | LoadingHistory, segments: Any, start: Floats) -> None:
    """Write how far (m) what moves at a rate has come, and the rate, without a sinusoid, into segments that begin at times (s)."""
    own, value, slope = scaled(history, 1.0)[0]
    lasting = np.diff(own)
    whole = np.append(0.0, np.cumsum(lasting * (value[:-1] + 0.5 * slope[:-1] * lasting)))
    n = np.searchsorted(own, start, side="right") - 1
    since = start - own[n]
    segments.pulled = whole[n] + since * (value[n] + 0.5 * slope[n] * since)
    segments.pull, segments.pull_slope = value[n] + slope[n] * since, slope[n]


def arriving(parts: Floats, tone: Tone, delay: float, problem: Problem, kind: type[Inflow] = Inflow) -> Inflow:
    """Return the inflow of straight parts (rows as of `scaled`) as it arrives at the contact, after the delay (s).

    The first one is extended back to 0 s: nothing asks for the inflow before the delay is over.
    """
    start, value, slope = np.array(parts)
    start = start + delay
    value[0], start[0] = value[0] - slope[0] * delay, 0.0
    late = tone if tone is SILENT else Tone(tone.amplitude, tone.frequency, tone.phase - tone.frequency * delay)
    shares, ones = np.full(len(start), float(problem.body.reflection)), np.ones(len(start))
    return kind(start, value, slope, late, problem.round_trip_time, shares, ones)
