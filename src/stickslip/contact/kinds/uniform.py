"""A uniform body with waves: a disturbance of its sliding comes back from the driver after a round trip."""

from __future__ import annotations

import math
from functools import partial

from numpy.polynomial import polynomial as poly

from stickslip.contact.asked import ContactOfKind, SteadyDrive, Withstood
from stickslip.contact.disturbance import Response, of_contact
from stickslip.contact.steady_proof import Discs, Judge, slope_symbols
from stickslip.contact.wave_modes import Polynomial, WaveModes
from stickslip.contact.wave_proof import of_slab
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import RIGID
from stickslip.problem import driver_impedance
from stickslip.problem.bodies import BodyWithWaves


class ContactOfUniform(ContactOfKind[BodyWithWaves, WaveModes]):
    """What a uniform body with waves answers."""

    def modes(self, body: BodyWithWaves, normal: float, response: Response, *, patient: bool = False) -> WaveModes:
        """Return the roots of A + Z (1 - r E) / (1 + r E), in closed form or of a machine that answers each wave in its own way."""
        a, z, driver = of_contact(body, normal, response), body.impedance * response.denominator, driver_impedance(body)
        if driver.is_constant:
            return WaveModes(a, z, float(body.reflection), body.round_trip_time)

        # The driver resists with x, so that r = -(x - Z) / (x + Z): both sides times x + Z.
        def mixed(f: Polynomial, g: Polynomial) -> Polynomial:
            resists, one = driver
            found: Polynomial = poly.polyadd(poly.polymul(f, resists), poly.polymul(body.impedance * g, one))
            return poly.polytrim(found)

        return WaveModes(mixed(a, z), mixed(z, a), RIGID, body.round_trip_time)

    def steady_drive(self, body: BodyWithWaves) -> SteadyDrive:
        """Return the driver's impedance, to which a dashpot at the contact adds."""
        driver = driver_impedance(body).steady
        return SteadyDrive(driver + body.damping - body.impedance, driver)

    def withstood(self, body: BodyWithWaves, normal: float) -> Withstood:
        """Return the least that body and driver take of a disturbance at any frequency.

        Nothing but a dashpot takes of one that the driver sends back whole, as a mass does with the sharp fronts that only a
        contact without mass makes.
        """
        own, dashpot, driver = body.impedance, body.damping - body.impedance, driver_impedance(body)
        back = body.reflection if body.has_inertia else body.front_reflection
        if back == RIGID:
            fall = dashpot
        elif not driver.is_constant:
            fall = self.largest_fall(body, normal, _surely_falls(body))
        elif body.has_inertia:
            fall = self.largest_fall(body, normal, driver.steady + body.damping - own)
        else:
            fall = dashpot + min(driver.steady, own * own / driver.steady if driver.steady else 0.0)
        return Withstood(fall, driver.is_constant)

    def judge(self, body: BodyWithWaves, normal: float, many: int) -> Judge | None:
        """Return the proof under a law with one state, and a driver that sends back the same share of every wave."""
        return partial(_proven, body, normal) if many == 1 and driver_impedance(body).is_constant else None


def _surely_falls(body: BodyWithWaves) -> float:
    """Return a fall of friction with the slip rate (Pa s/m) that a slab under a machine does not withstand.

    A disturbance exp(t/R) grows under it: friction gives what body, waves and machine take at s = 1/R.
    """
    s, driver = 1.0 / body.round_trip_time, driver_impedance(body)
    machine = float(poly.polyval(s, driver.numerator) / poly.polyval(s, driver.denominator))
    echo = math.exp(-1.0) * (body.impedance - machine) / (body.impedance + machine)
    return body.impedance * (1.0 - echo) / (1.0 + echo) + body.inertia * s + body.damping - body.impedance


def _proven(body: BodyWithWaves, normal: float, slopes: Discs) -> tuple[Floats, Floats]:
    """Return for each cell whether sliding is proven to be stable, and whether it is proven to be unstable."""
    stable, unstable = of_slab(body, normal, slopes)
    fade = slopes[slope_symbols(1)[1][1]]
    fades = fade.centre < -fade.radius
    return stable & fades, unstable & fades


ANSWERS = ContactOfUniform()
