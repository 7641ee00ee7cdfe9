"""A body of layers: disturbances come back from where layers meet, too, and their roots are counted and followed."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import numpy as np

from stickslip.contact.asked import ContactOfKind, SteadyDrive, Withstood
from stickslip.contact.crossing import crossing
from stickslip.contact.disturbance import Response, of_contact
from stickslip.contact.layer_count import MOST_PIECES
from stickslip.contact.layer_modes import LayerModes
from stickslip.contact.layer_response import driven_steadily, response_of, taken_by_layers
from stickslip.problem import driver_impedance
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers

PATIENT = 1 << 20
"""Largest number of pieces in which the roots of one motion are counted, a second or two of work."""
BELOW = 1e-4
"""What layers withstand is checked by a count of roots under a fall of friction that is smaller by this share (1)."""


class ContactOfLayers(ContactOfKind[BodyOnCharacteristics, LayerModes]):
    """What a body of layers answers."""

    def modes(self, body: BodyOnCharacteristics, normal: float, response: Response, *, patient: bool = False) -> LayerModes:
        """Return the roots of A + W."""
        below = np.asarray(response.denominator, float)
        return LayerModes(of_contact(body, normal, response), below, _layers(body), PATIENT if patient else MOST_PIECES)

    def steady_drive(self, body: BodyOnCharacteristics) -> SteadyDrive:
        """Return what drivers and drag do together, while all of a side moves alike, and a dashpot at the contact beside them."""
        drive = driven_steadily(_layers(body))
        return drive._replace(resists=drive.resists + body.dashpot)

    def not_sought(self, body: BodyOnCharacteristics) -> str:
        """Return that it is not sought behind a machine."""
        is_sought = driver_impedance(body).is_constant
        return "" if is_sought else "not sought for layers behind a driver with a mass or an integral gain"

    def withstood(self, body: BodyOnCharacteristics, normal: float) -> Withstood:
        """Return what a dashpot takes behind rigid drivers, and otherwise what is found that drivers and drag take, too."""
        rigid = body.is_driven_rigidly
        if rigid and not _layers(body).has_drag:
            fall = body.dashpot
        elif body.has_inertia:
            fall = self.largest_fall(body, normal, body.dashpot + _surely_falls(_layers(body)))
        else:
            fall = self._without_mass(body, normal)
        return Withstood(fall, rigid)

    def _without_mass(self, body: BodyOnCharacteristics, normal: float) -> float:
        """Return the same without a mass at the contact: found by sampling, and checked by a count of roots.

        A count decides nothing where a root is as good as on the axis, so it is made a little below.
        """
        found = body.dashpot + taken_by_layers(_layers(body))
        if found == 0.0 or self.withstands(body, normal, found * (1.0 - BELOW)):
            return found
        return self.largest_fall(body, normal, found)

    def is_surely_stable(self, body: BodyOnCharacteristics, normal: float, response: Response) -> bool | None:
        """Return the verdict, which is None where rounding decides."""
        return self.modes(body, normal, response).verdict

    def edge(self, modes_at: Callable[[float], LayerModes], low: float, high: float, stable_above: bool) -> float:
        """Return where the root that grows crosses the axis."""
        return crossing(modes_at, low, high, stable_above)


def _layers(body: BodyOnCharacteristics) -> OfLayers:
    return cast(OfLayers, body)


def _surely_falls(body: OfLayers) -> float:
    """Return a fall of friction with the slip rate (Pa s/m) under which exp(t/R) grows on layers with a mass at the contact."""
    s = 1.0 / body.two_way_time
    above, below = response_of(body, np.array([s], complex))
    return float((above[0] / below[0]).real) + body.inertia * s


ANSWERS = ContactOfLayers()
