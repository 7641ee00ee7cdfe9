"""An axis in a position loop: the integral makes the equation of a disturbance of steady sliding one order higher.

Without states it is m s^3 + (D + S mu_v) s^2 + kp s + ki = 0, and sliding is stable if and only if (D + S mu_v) kp > m ki (Routh).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.contact.asked import Withstood
from stickslip.contact.disturbance import Response
from stickslip.contact.kinds.rigid import ContactOfRigid, ModesOfBlock
from stickslip.contact.steady_proof import Judge
from stickslip.problem.bodies import BodyOnCharacteristics, as_on_spring


class ContactOfLoop(ContactOfRigid):
    """What an axis in a position loop answers."""

    def modes(self, body: BodyOnCharacteristics, normal: float, response: Response, *, patient: bool = False) -> ModesOfBlock:
        """Return the roots of m s + D + kp/s + ki/s^2 + S Phi(s)."""
        if not as_on_spring(body).integral_gain:
            return super().modes(body, normal, response)
        above, below = response
        controller = np.array([as_on_spring(body).integral_gain, body.stiffness, body.total_damping, body.inertia])
        return ModesOfBlock(poly.polyadd(poly.polymul(controller, below), poly.polymulx(poly.polymulx(normal * above))))

    def withstood(self, body: BodyOnCharacteristics, normal: float) -> Withstood:
        """Return the damping less what the integral takes of it."""
        taken = body.inertia * as_on_spring(body).integral_gain / body.stiffness
        return Withstood(body.total_damping - taken, is_known=True)

    def overshoots(self, body: BodyOnCharacteristics) -> bool:
        """Return True for an axis with an integral: it has gathered the lag of the rest."""
        return bool(as_on_spring(body).integral_gain)

    def judge(self, body: BodyOnCharacteristics, normal: float, many: int) -> Judge | None:
        """Return the proof for an axis without an integral."""
        return None if as_on_spring(body).integral_gain else super().judge(body, normal, many)


ANSWERS = ContactOfLoop()
