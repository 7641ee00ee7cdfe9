"""The sinusoidal slip law under a constant load that exceeds the largest strength: endless slip in pulses.

Source: Campillo et al. 1996, eqs (12) and (14): Z u' = (beta - mu0 S) - a S sin(omega u), whose solution is elementary in
tan(omega u / 2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError


@dataclass(frozen=True)
class PulseTrain:
    """Slip in pulses under a constant load beta (Pa) and the sinusoidal slip law, with Z (Pa s/m), S (Pa) and omega (1/m).

    The load of a slab is constant for ever where the driver absorbs all waves, and under another driver, if it does not move, until
    the first echo of the slip returns. Raises InputError if beta does not exceed (mean + amplitude) S: slip would end at a strength
    that it cannot overcome.

    Source: Campillo et al. 1996, eqs (12) and (14).
    """

    impedance: float
    load: float
    normal_stress: float
    mean: float
    amplitude: float
    wavenumber: float
    initial_slip: float = 0.0

    def __post_init__(self) -> None:
        if self.surplus <= self.wave:
            raise InputError(
                f"PulseTrain: load must exceed the largest strength, {self.normal_stress * (self.mean + self.amplitude):g} Pa"
            )

    @property
    def surplus(self) -> float:
        """The mean driving stress beta - mu0 S (Pa)."""
        return self.load - self.mean * self.normal_stress

    @property
    def wave(self) -> float:
        """The amplitude a S of the strength (Pa)."""
        return self.amplitude * self.normal_stress

    @property
    def _root(self) -> float:
        return math.sqrt((self.surplus - self.wave) * (self.surplus + self.wave))

    @property
    def period(self) -> float:
        """The time between pulses (s), 2 pi Z / (omega sqrt((beta - mu0 S)^2 - (a S)^2))."""
        return 2.0 * math.pi * self.impedance / (self.wavenumber * self._root)

    @property
    def peak_rate(self) -> float:
        """The largest slip rate (m/s)."""
        return (self.surplus + self.wave) / self.impedance

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip u(t) (m) at times t (s), of the shape of t.

        It satisfies B tan(omega u / 2) = A + W tan(phi) with phi linear in t, A = a S, B = beta - mu0 S and W^2 = B^2 - A^2.
        """
        turn, start = np.divmod(0.5 * self.wavenumber * self.initial_slip + 0.5 * math.pi, math.pi)
        begin = math.atan((self.surplus * math.tan(start - 0.5 * math.pi) - self.wave) / self._root)
        phase = begin + math.pi * np.asarray(t, float) / self.period
        turns, rest = np.divmod(phase + 0.5 * math.pi, math.pi)
        half = np.arctan((self.wave + self._root * np.tan(rest - 0.5 * math.pi)) / self.surplus)
        return np.asarray((half + math.pi * (turns + turn)) * 2.0 / self.wavenumber)

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip rate v(t) (m/s) at times t (s), of the shape of t, from the governing equation at the exact slip."""
        return (self.surplus - self.wave * np.sin(self.wavenumber * self.slip(t))) / self.impedance
