"""The sinusoidal slip law under a constant load above every strength: slip in pulses, for ever.

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
    """Impedance (Pa s/m), load beta (Pa), normal stress (Pa), the law's mean, amplitude > 0 and wavenumber > 0 (1/m), u(0) (m).

    Raises InputError unless beta exceeds (mean + amplitude) S: otherwise slip ends at a strength it cannot pass.
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
        """beta - mu0 S (Pa)."""
        return self.load - self.mean * self.normal_stress

    @property
    def wave(self) -> float:
        """a S (Pa)."""
        return self.amplitude * self.normal_stress

    @property
    def _root(self) -> float:
        return math.sqrt((self.surplus - self.wave) * (self.surplus + self.wave))

    @property
    def period(self) -> float:
        """Time between pulses (s): 2 pi Z / (omega sqrt((beta - mu0 S)^2 - (a S)^2))."""
        return 2.0 * math.pi * self.impedance / (self.wavenumber * self._root)

    @property
    def peak_rate(self) -> float:
        """Largest slip rate (m/s)."""
        return (self.surplus + self.wave) / self.impedance

    @property
    def least_rate(self) -> float:
        """Smallest slip rate (m/s)."""
        return (self.surplus - self.wave) / self.impedance

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """u(t) in m, t in s: B tan(omega u / 2) = A + W tan(phi), phi linear in t, with A = a S, B = beta - mu0 S."""
        turn, start = np.divmod(0.5 * self.wavenumber * self.initial_slip + 0.5 * math.pi, math.pi)
        begin = math.atan((self.surplus * math.tan(start - 0.5 * math.pi) - self.wave) / self._root)
        phase = begin + math.pi * np.asarray(t, float) / self.period
        turns, rest = np.divmod(phase + 0.5 * math.pi, math.pi)
        half = np.arctan((self.wave + self._root * np.tan(rest - 0.5 * math.pi)) / self.surplus)
        return np.asarray((half + math.pi * (turns + turn)) * 2.0 / self.wavenumber)

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """v(t) in m/s, from the governing equation at the exact slip."""
        return (self.surplus - self.wave * np.sin(self.wavenumber * self.slip(t))) / self.impedance
