"""The numbers by which two runs are compared."""

from __future__ import annotations

import numpy as np

from stickslip.contact.uniqueness import Uniqueness
from stickslip.explorer.model.answer import KeyNumber, Motion
from stickslip.explorer.model.events import Found


def key_numbers(found: Found, contact: Uniqueness, motion: Motion) -> tuple[KeyNumber, ...]:
    """Return the numbers of a run; NaN for one that it does not have, such as the arrest of a contact that never slips."""
    event, unit = found.largest, motion.load_unit
    of_event = {} if event is None else event.to_dict()

    def of(name: str) -> float:
        return float(of_event.get(name, np.nan))

    return (
        KeyNumber("slip in all", found.total_slip, "m"),
        KeyNumber("slip events", float(len(found.events)), "1"),
        KeyNumber("slip of the largest event", of("slip"), "m"),
        KeyNumber("pulses of the largest event", of("pulses"), "1"),
        KeyNumber("largest slip rate", float(np.abs(motion.slip_rate).max()), "m/s"),
        KeyNumber("arrest", found.arrest, "s"),
        KeyNumber("duration of the largest event", of("duration"), "s"),
        KeyNumber("drop of the traction", of("traction_drop"), unit),
        KeyNumber("shocks", float(len(found.shocks)), "1"),
        KeyNumber("critical value", np.nan if contact.critical_value is None else contact.critical_value, contact.critical_unit),
    )
