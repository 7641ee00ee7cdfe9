"""Check the numbers beside the arrays of a file: attributes, and the place that a checkpoint gives in its catalogue.

A file with a valid checksum may still have been made by hand, or by a faulty program. Its arrays are checked in
`engine/history/soundness.py`.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stickslip.foundation.errors import InputError


def number(attributes: Mapping[str, Any], name: str, path: Path, lowest: float = 0.0) -> float:
    """Return an attribute that must be a finite number, at least `lowest`. Raises InputError if it is not."""
    value = attributes[name]
    if np.ndim(value) or isinstance(value, str | bytes) or not (math.isfinite(value) and value >= lowest):
        raise InputError(f"{path}: not a file that stickslip has written: {name} is {value!r}")
    return float(value)


def whole_number(attributes: Mapping[str, Any], name: str, path: Path, lowest: float = 0.0, highest: float = 2.0**62) -> int:
    """Return an attribute that must be a whole number from `lowest` to `highest`. Raises InputError if it is not."""
    value = number(attributes, name, path, lowest)
    if value != int(value) or value > highest:
        raise InputError(f"{path}: not a file that stickslip has written: {name} is {value!r}")
    return int(attributes[name])


def check_place(about: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """Return what a catalogue's checkpoint says of its rows and of the stream of events.

    Raises InputError for a number out of range, and for a file name that leads to another folder.
    """
    name = about["catalogue"]
    if not isinstance(name, str) or name != Path(name).name or set(name) & set("/\\\0") or name in ("", ".", ".."):
        raise InputError(f"{path}: not a file that stickslip has written: its catalogue is named {name!r}, which is no bare name")
    counts = {key: whole_number(about, key, path) for key in ("bytes", "told", "first", "forgotten")}
    return counts | {
        "catalogue": name,
        "digest": str(about["digest"]),
        "last_piece": whole_number(about, "last_piece", path, -(2.0**62)),
        "last_xi": number(about, "last_xi", path),
        "event_rate": number(about, "event_rate", path),
        "energies": whole_number(about, "energies", path, highest=1),
        "displaced": number(about, "displaced", path, -sys.float_info.max) if "displaced" in about else 0.0,  # older files: unknown
        "displaced_at": number(about, "displaced_at", path) if "displaced_at" in about else 0.0,
    }
