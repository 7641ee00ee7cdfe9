"""Leave the end of a record out of the fit, to be predicted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.studies.inference.part import Part

LEFT_OUT = Quantity("s", "time at the end of the record that is left out", above=0.0)
LEAST = 8
"""Smallest number of samples that a part keeps."""


def share_of(held_out: Any, parts: Sequence[Part]) -> float:
    """Return the share of a record at its end that is left out, from a share or a time. Raises InputError."""
    if held_out is None:
        return 0.0
    if isinstance(held_out, int | float) and not isinstance(held_out, bool):
        if not 0.0 < held_out < 1.0:
            raise InputError(f"infer: held_out must be a share between 0 and 1, or a time with a unit, got {held_out:g}")
        return float(held_out)
    seconds, whole = LEFT_OUT.check("infer", "held_out", held_out), sum(part.duration for part in parts)
    if seconds >= whole:
        raise InputError(f"infer: held_out of {seconds:g} s leaves nothing of a record of {whole:g} s")
    return seconds / whole


def shortened(parts: Sequence[Part], share: float) -> list[Part]:
    """Return the parts that are fitted: of one record its first part, of several the whole ones that come first.

    Parts that are left out as a whole follow nothing; a record in several parts keeps the first of them. Raises InputError if too
    little is left.
    """
    if share == 0.0:
        return list(parts)
    if len(parts) > 1:
        count = max(1, min(len(parts) - 1, round(len(parts) * (1.0 - share))))
        return list(parts[:count])
    (part,) = parts
    record = part.record.part(None, float(part.record.time[0] + (1.0 - share) * part.duration))
    if len(record) < LEAST:
        raise InputError(f"infer: held_out leaves {len(record)} samples to be fitted")
    return [replace(part, record=record)]
