"""Free the drift of a record by itself where its plateaus or its residuals show one, and hold it where the fit does not need it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from stickslip.extensions.inference.certainty.certainty import Certainty
from stickslip.extensions.inference.fit.estimate import Estimate
from stickslip.extensions.inference.fit.free import DRIFT, TREND, Free, read_free, with_scale
from stickslip.extensions.inference.fit.looks import looks_of
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.part import Part
from stickslip.extensions.inference.fit.pieces import pieces_of
from stickslip.extensions.inference.fit.plateaus import PlateauDrift
from stickslip.extensions.inference.fit.setup import scales_of
from stickslip.extensions.inference.fit.starting import shown_drift, slides
from stickslip.extensions.inference.record.record import SHEAR
from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.problem import Problem

TRENDS = ("auto", "none")
"""What may be done about a drift: free it where it shows, or nothing."""
KEPT = 3.0
"""A drift stays free if it is larger than this many standard errors; normal noise alone gives one record of 370 so large a one."""
UNITS_OF_DRIFTS = {TREND: "1/m", DRIFT: "1/s"}


class Offer(NamedTuple):
    """A free number that describes a drift and that nobody asked for: its name, why it is free, and what cannot be told of it."""

    name: str
    why: str
    unsure: tuple[str, ...] = ()


def offered(problem: Problem, parts: Sequence[Part], free: Sequence[Free], trend: str) -> tuple[Offer | None, PlateauDrift | None]:
    """Return the drift to free beside other numbers, if any, and the drift with which starting values are read off plateaus."""
    named = {one.name for one in free} & {TREND, DRIFT}
    if named:
        return None, shown_drift(problem, parts, with_slip=TREND in named)
    look = shown_drift(problem, parts)
    if trend == "none" or look is None or not look.seen:
        return None, None
    name, along = (TREND, "slip") if look.with_slip else (DRIFT, "time")
    why = f"plateaus of friction {'fall' if look.value < 0.0 else 'rise'} with {along}"
    return Offer(name, why, tuple(_unsure(look))), look


def _unsure(look: PlateauDrift) -> list[str]:
    """Return sentences on what the plateaus do not tell of their drift."""
    found = list[str]()
    if not look.told and look.rates > 1:
        found.append(
            f"whether friction drifts with slip ({TREND}) or with time ({DRIFT}) cannot be told from {look.plateaus} plateaus "
            f"at {look.rates} rates: free the other one instead, and compare"
        )
    if look.rates == look.plateaus and look.plateaus > 1:
        found.append(
            f"each of the {look.plateaus} rates comes once: levels cannot tell a drift from the effect of rate (a - b), only "
            "slopes within plateaus do; a record that comes back to a rate is surer"
        )
    return found


def lacking(found: Estimate, slopes: Floats) -> Offer | None:
    """Return the drift that a fit lacks, as its residuals show; `slopes` are their derivatives."""
    model = found.model
    name = next((one for one in model.sizes if one in SHEAR), None)
    if name is None or not all(slides(model.problem, part) for part in model.parts):
        return None
    by = {one.name: one.rows / one.weight[:, None] for one in pieces_of(model, np.zeros(model.samples), slopes)}
    free = {one.name for one in model.free}
    for look in looks_of(model, found.searched, name, by[name]):
        number = DRIFT if look.kind == "drift with time" or (look.kind == "drift" and TREND in free) else TREND
        if look.kind.startswith("drift") and number not in free:
            told = "" if look.kind != "drift" else ", with slip or with time, which the record does not tell apart"
            return Offer(number, f"what is left of {name} without it looks like a {look.kind}{told}")
    return None


def with_number(found: Estimate, name: str) -> Model:
    """Return the model of a fit with one more free number; the search begins where the fit has ended."""
    model = _begun(found)
    (new,) = with_scale(read_free(model.problem, [name], {}), scales_of(model.parts[0], model.problem))
    shared, own = ([one for one in model.free if (one.part is None) is alike] for alike in (True, False))
    return model.with_(free=(*shared, new, *own))


def without_number(found: Estimate, name: str) -> Model:
    """Return the model of a fit without one of its free numbers; the search begins where the fit has ended."""
    model = _begun(found)
    return model.with_(free=tuple(one for one in model.free if one.name != name))


def _begun(found: Estimate) -> Model:
    model = found.model
    free = [replace(one, start=v, given=None) for one, v in zip(model.free, model.values(found.searched), strict=True)]
    return model.with_(free=tuple(free), step=Model.step, unsure={}, memory={})


def _size(found: Estimate, sure: Certainty, name: str) -> tuple[float, float]:
    """Return the value of a drift and its standard error (SI)."""
    free = found.model.free
    i = next(i for i, one in enumerate(free) if one.name == name)
    return found.model.values(found.searched)[i], free[i].width(0.0, float(sure.widths[i]))


def needed(found: Estimate, sure: Certainty, name: str) -> bool:
    """Return True if a fit needs a drift, which is then far enough from 0."""
    value, error = _size(found, sure, name)
    return bool(np.isfinite(error) and abs(value) > KEPT * error > 0.0)


def said(offer: Offer, found: Estimate, sure: Certainty) -> list[str]:
    """Return sentences on a drift that is free although nobody asked for it."""
    value, error = _size(found, sure, offer.name)
    size = f"{brief(value, UNITS_OF_DRIFTS[offer.name], 3)} ± {brief(error, UNITS_OF_DRIFTS[offer.name], 1)}"
    both = {TREND, DRIFT} <= {one.name for one in found.model.free}
    caveats = () if both else offer.unsure
    return [f"{offer.why}: {offer.name} is free, too, and is {size}; trend='none' leaves it out", *caveats]
