"""The disturbances of steady sliding of any body, for the tests of this folder."""

from __future__ import annotations

from stickslip.contact.asked import CONTACT_KINDS
from stickslip.contact.disturbance import Modes, Response
from stickslip.problem.bodies import BodyOnCharacteristics


def modes_of(body: BodyOnCharacteristics, normal: float, response: Response) -> Modes:
    """Return the disturbances of a body that slides under a normal load (Pa or N) and a response of friction."""
    found: Modes = CONTACT_KINDS[body.structure].modes(body, normal, response)
    return found
