"""Set a drive of a drill string so that it takes up torsional waves: the numbers of SoftTorque, SoftSpeed and Z-torque drives.

A drive with the moment of inertia J under a speed controller with the gains kp and ki answers a torque of the circular frequency w
like the impedance Zd = kp + i (w J - ki / w), and sends back the share (Z - Zd) / (Z + Zd) of a wave in pipe of the impedance Z.
With ki = w^2 J inertia and integral gain cancel at that frequency, and with kp = Z nothing is sent back there.

The formulas follow from the equation of the drive. Such drives: Halsey, Kyllingstad & Kylling 1988, SPE 18049 (torque feedback);
Kyllingstad & Nessjoen 2009, SPE/IADC 119660 (a speed controller tuned to the period of stick-slip); Dwars 2015, SPE/IADC 173037
(impedance matching without the inertia of the drive).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Protocol, TypeVar

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.problem.bodies.contract import BodyOnCharacteristics

MATCHED = "impedance matched"
"""The word for a drive whose impedance is that of the pipe at all periods of stick-slip."""
TOP_DRIVE = 2900.0
"""The moment of inertia (kg m^2) of a top drive where none is given: that of well B of Aarsnes & Shor 2018."""
SLOW = 10.0
"""Time in which a drive with matched impedance makes up for what it lags behind, in two-way travel times of the string (1)."""
PERIOD = Quantity("s", "period of the stick-slip to which the drive is tuned", above=0)
MEANING = f'a drive tuned to a period of stick-slip, as "5 s", or "{MATCHED}"; it gives the three numbers of the drive'
"""Meaning of the key in a scenario."""
GAIN = Quantity("N m s", "proportional gain of the drive", above=0)
INERTIA = Quantity("kg m^2", "moment of inertia of the drive", above=0)


class Driven(BodyOnCharacteristics, Protocol):
    """A string whose drive may be set."""

    @property
    def two_way_time(self) -> float:
        """The two-way travel time to the drive (s)."""
        ...


String = TypeVar("String", bound=Driven)


def with_soft_torque(string: String, setting: Any, gain: Any = None, inertia: Any = None) -> String:
    """Return a string with another drive: tuned to a period (s, or a text), or of matched impedance; see `MEANING`.

    The proportional gain (N m s) is by default the impedance of the pipe. The moment of inertia (kg m^2) is by default that of the
    string's drive, or else `TOP_DRIVE`; with "impedance matched" the controller makes up for it. Raises InputError.
    """
    where = type(string).__name__
    kp = string.last_impedance if gain is None else GAIN.check(where, "driver_impedance", gain)
    word = " ".join(setting.lower().replace("-", " ").replace("_", " ").split()) if isinstance(setting, str) else setting
    if word in (MATCHED, "matched"):
        if inertia is not None:
            why = "is a drive whose controller makes up for its inertia: leave driver_inertia out, or give a period"
            raise InputError(f'{where}: soft_torque = "{MATCHED}" {why}')
        heavy, ki = 0.0, kp / (SLOW * string.two_way_time)
    else:
        if isinstance(word, str) and not any(one.isdigit() for one in word):
            raise InputError(f'{where}: soft_torque must be a period, as "5 s", or "{MATCHED}", got {shown(setting)}')
        period = PERIOD.check(where, "soft_torque", setting)
        own = string.driver_inertia if 0.0 < string.driver_inertia < math.inf else TOP_DRIVE
        heavy = own if inertia is None else INERTIA.check(where, "driver_inertia", inertia)
        ki = (2.0 * math.pi / period) ** 2 * heavy
    numbers = {"driver_impedance": kp, "driver_inertia": heavy, "driver_integral_gain": ki}
    return replace(string, **numbers)


def tuned_period(string: BodyOnCharacteristics) -> float:
    """Return the period (s) at which inertia and integral gain of a drive cancel; NaN if it has not both."""
    if not (string.driver_inertia > 0.0 and string.driver_integral_gain > 0.0):
        return math.nan
    return 2.0 * math.pi * math.sqrt(string.driver_inertia / string.driver_integral_gain)


def sent_back(string: BodyOnCharacteristics, period: float) -> float:
    """Return the size of the share (1) that the drive sends back of a wave with a period (s)."""
    turns = 2.0 * math.pi / period
    drive = complex(string.driver_impedance, turns * string.driver_inertia - string.driver_integral_gain / turns)
    return abs((string.last_impedance - drive) / (string.last_impedance + drive))
