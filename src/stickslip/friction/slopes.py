"""Compute the derivatives of friction with respect to slip and slip rate."""

from __future__ import annotations

import numpy as np

from stickslip.friction.law import FrictionLaw


def slopes(law: FrictionLaw, slip: float, rate: float = 0.0) -> tuple[float, float]:
    """Return the derivatives of mu with respect to slip (1/m) and slip rate (s/m).

    `slip` (m) is the slip as the law counts it; `rate` (m/s) is not negative, and 0 means the limit 0+. The derivatives come from
    a complex step, which loses no digits because the formula of a law is analytic.
    """
    piece = int(law.piece_at(slip, rate))
    step = 1e-100
    by_slip = np.imag(law.piece_coefficient(piece, np.complex128(complex(slip, step)), np.complex128(rate)))
    by_rate = np.imag(law.piece_coefficient(piece, np.complex128(slip), np.complex128(complex(rate, step))))
    return float(by_slip) / step, float(by_rate) / step
