"""The units in which one answer is shown, chosen once for all panels."""

from __future__ import annotations

import numpy as np

from stickslip.explorer.model.answer import Answer, Motion
from stickslip.explorer.page.view import Units
from stickslip.figures.style import nearly_flat, unit_of


def units_of(answer: Answer) -> Units:
    """Return the units of an answer: panels that show the same quantity share the unit."""
    motions, contact, slab = answer.motions, answer.contact, answer.slab
    main = motions[0]
    same = [motion for motion in motions if share_loads(main, motion)]
    stresses = [curve for motion in same for curve in (motion.traction, motion.load)]
    offset = float(main.traction[0]) if nearly_flat(*stresses) else 0.0
    slips = [motion.slip for motion in motions]
    rates = [motion.slip_rate for motion in motions]
    return Units(
        time=unit_of("s", np.ptp(main.time)),
        slip=unit_of("m", *slips),
        rate=unit_of("m/s", *rates),
        stress=unit_of(main.load_unit, *(curve - offset for curve in stresses)),
        offset=offset,
        load=unit_of(main.load_unit, contact.load if contact else main.load),
        place=unit_of("m", slab.place if slab else 1.0),
    )


def share_loads(main: Motion, other: Motion) -> bool:
    """Return True if loads of two bodies can share an axis: the block equivalent to a slab is that of 1 m², so its N are Pa."""
    return main.load_unit == other.load_unit or main.body == "slab"
