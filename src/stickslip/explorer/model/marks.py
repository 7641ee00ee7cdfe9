"""What happens at single times of a run: starts, pulses, arrests and jumps, as marks with a line of text."""

from __future__ import annotations

import numpy as np

from stickslip.explorer.model.answer import Mark, MarkKind, Motion
from stickslip.explorer.model.events import Found
from stickslip.explorer.model.words import short

MOST = 120
"""Largest number of marks; of more, those of smaller events and shocks are left away."""
KINDS: dict[str, MarkKind] = {"fold": "fold", "echo": "echo"}
"""Kinds of the marks of shocks by their cause, if it is not "jump"."""


def marks_of(found: Found, motion: Motion) -> tuple[Mark, ...]:
    """Return the marks of a run in order of time."""
    marks = [*_events(found), *_pulses(found, motion), *_jumps(found)]
    return tuple(sorted(marks, key=lambda mark: mark.time))


def _events(found: Found) -> list[Mark]:
    marks = []
    for _, event in found.events.nlargest(MOST // 4, "slip").iterrows():
        marks.append(Mark(float(event.start), "start", f"a slip event begins at {short(event.start, 's')}"))
        if not np.isnan(event.end):
            text = f"arrest at {short(event.end, 's')}, after {short(event.slip, 'm')} of slip"
            marks.append(Mark(float(event.end), "arrest", text))
    return marks


def _pulses(found: Found, motion: Motion) -> list[Mark]:
    """Return a mark for each pulse, where its slip rate is largest on the curve."""
    marks = []
    for _, pulse in found.pulses.nlargest(MOST // 4, "slip").iterrows():
        inside = np.flatnonzero((motion.time >= pulse.start) & (motion.time <= pulse.start + pulse.duration))
        if len(inside):
            peak = float(motion.time[inside[np.argmax(np.abs(motion.slip_rate[inside]))]])
            text = f"pulse of {short(pulse.slip, 'm')}, fastest with {short(pulse.peak_rate, 'm/s')} at {short(peak, 's')}"
            marks.append(Mark(peak, "pulse", text))
    return marks


def _jumps(found: Found) -> list[Mark]:
    shocks = found.shocks.assign(size=(found.shocks.rate_after - found.shocks.rate_before).abs())
    marks = []
    for _, shock in shocks.nlargest(MOST // 4, "size").iterrows():
        step = f"from {short(shock.rate_before, 'm/s')} to {short(shock.rate_after, 'm/s')}"
        text = f"the slip rate jumps {step} at {short(shock.time, 's')} ({shock.cause})"
        marks.append(Mark(float(shock.time), KINDS.get(shock.cause, "jump"), text))
    return marks
