"""Straight segments of a loading, as they leave a driver and as they arrive at the contact."""

from __future__ import annotations

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.problem.inflow import Inflow
from stickslip.problem.loading import SILENT, LoadingHistory, Segment, Tone
from stickslip.problem.problem import Problem


def scaled(history: float | LoadingHistory, gain: float) -> tuple[list[Segment], Tone]:
    """Return the segments of a history and its tone, times a number; a constant is one segment."""
    if not isinstance(history, LoadingHistory):
        return [Segment(0.0, gain * history, 0.0)], SILENT
    amplitude, frequency, phase = history.tone
    tone = Tone(gain * amplitude, frequency, phase) if amplitude != 0.0 else SILENT
    return [Segment(s.start, gain * s.value, gain * s.slope) for s in history.segments], tone


def in_parts(value: float | LoadingHistory | None) -> tuple[Floats, Tone]:
    """Return the starts (s), values and slopes (rows) of a history, and its tone; None stands for 0."""
    segments, tone = scaled(value or 0.0, 1.0)
    return np.array(segments).T, tone


def straight(parts: Floats, start: Floats) -> tuple[Floats, Floats]:
    """Return the values and the slopes of straight parts (rows as of `in_parts`), from times (s) on."""
    own, value, slope = parts
    n = np.searchsorted(own, start, side="right") - 1
    return value[n] + slope[n] * (start - own[n]), slope[n]


def arriving(segments: list[Segment], tone: Tone, delay: float, problem: Problem, kind: type[Inflow] = Inflow) -> Inflow:
    """Return the inflow as it arrives at the contact, after the delay (s).

    The first segment is extended back to 0 s: nothing asks for the inflow before the delay is over.
    """
    start, value, slope = np.array(segments).T
    start = start + delay
    value[0], start[0] = value[0] - slope[0] * delay, 0.0
    late = tone if tone is SILENT else Tone(tone.amplitude, tone.frequency, tone.phase - tone.frequency * delay)
    shares, ones = np.full(len(start), float(problem.body.reflection)), np.ones(len(start))
    return kind(start, value, slope, late, problem.round_trip_time, shares, ones)
