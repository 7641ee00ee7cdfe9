"""The units for one answer, chosen once for all panels."""

from __future__ import annotations

from typing import Literal

import numpy as np

from stickslip.extensions.explorer.model.answer import Answer, BodyCurves
from stickslip.extensions.explorer.page.view import Units
from stickslip.figures.style import nearly_flat
from stickslip.foundation.given import PLACE
from stickslip.foundation.names import readable_unit, si_unit

Curve = Literal["slip", "slip_rate", "traction"]
REACH_OF_COMPANION = 4.0
"""A companion whose curve is more than so many times as large does not widen the axis; the legend says how far it reaches."""
SHARE_OF_RUN = 0.2
"""The panels of slab and energy share the axis of time of the others if they show at least this share of the run."""


def units_of(answer: Answer, kept: Answer | None = None) -> Units:
    """Return the units of an answer, and of the run that is kept beside it: panels that show the same quantity share the unit."""
    contact, slab, main = answer.contact, answer.slab, answer.motions[0]
    further = kept.motions[:1] if kept else ()
    same = (*held(answer, "traction"), *(motion for motion in further if share_axis(main, motion, "traction")))
    stresses = [curve for motion in same for curve in (motion.traction, motion.load)]
    offset = float(main.traction[0]) if nearly_flat(*stresses) else 0.0
    slips = [motion.slip for motion in (*held(answer, "slip"), *further)]
    rates = [motion.slip_rate for motion in (*held(answer, "slip_rate"), *further)]
    log = answer.solution.problem.friction.creeps  # slip rates are then never zero, and differ widely
    rate, span, window = si_unit("slip_rate", main.load_unit), np.ptp(main.time), np.ptp(answer.energy.time)
    whole = window >= SHARE_OF_RUN * span
    return Units(
        time=readable_unit("s", span),
        near=readable_unit("s", span if whole else window),
        begin=0.0 if whole else float(answer.energy.time[0]),
        whole=bool(whole),
        slip=readable_unit(si_unit("slip", main.load_unit), *slips),
        rate=readable_unit(rate, *rates, log=log),
        log=log,
        stress=readable_unit(main.load_unit, *(curve - offset for curve in stresses)),
        offset=offset,
        load=readable_unit(main.load_unit, contact.load if contact else main.load),
        on_curve=readable_unit(rate, main.slip_rate, contact.path_rate if contact else 0.0),
        place=readable_unit("m", slab.place if slab else 1.0, of=PLACE),
        slip_unit=si_unit("slip", main.load_unit),
    )


def share_axis(main: BodyCurves, other: BodyCurves, curve: Curve) -> bool:
    """Return True if a curve of two bodies can share an axis: the block equivalent to a slab is that of 1 m², so its N are Pa."""
    loads = main.load_unit, other.load_unit
    return loads == ("Pa", "N") or si_unit(curve, loads[0]) == si_unit(curve, loads[1])


def held(answer: Answer, curve: Curve) -> tuple[BodyCurves, ...]:
    """Return the bodies that an axis is made to hold: the body itself, and its companion unless that would make it look flat."""
    main, other = answer.motions[0], answer.motions[1:2]
    fits = all(extent(one, curve) <= REACH_OF_COMPANION * extent(main, curve) for one in other)
    return (main, *other) if fits and all(share_axis(main, one, curve) for one in other) else (main,)


def extent(motion: BodyCurves, curve: Curve) -> float:
    """Return the range of a curve (SI)."""
    return float(np.ptp(getattr(motion, curve)))
