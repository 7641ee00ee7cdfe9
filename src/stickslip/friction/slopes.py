"""How friction changes with slip and with slip rate."""

from __future__ import annotations

import numpy as np

from stickslip.friction.law import FrictionLaw


def slopes(law: FrictionLaw, slip: float, rate: float = 0.0) -> tuple[float, float]:
    """Derivatives of mu with respect to slip (1/m) and slip rate (s/m) at a law slip (m) and a rate (m/s; 0 means 0+).

    By a complex step, which loses no digits: a law's formula is analytic.
    """
    piece = int(law.piece_at(slip, rate))
    step = 1e-100
    by_slip = np.imag(law.piece_coefficient(piece, np.complex128(complex(slip, step)), np.complex128(rate)))
    by_rate = np.imag(law.piece_coefficient(piece, np.complex128(slip), np.complex128(complex(rate, step))))
    return float(by_slip) / step, float(by_rate) / step
