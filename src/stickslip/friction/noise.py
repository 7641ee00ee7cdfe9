"""Recognise noise in points that are to be joined exactly.

The value at each inner point is compared with the straight line between its two neighbours. Along a smooth curve these differences
keep their sign for many points; in noise that differs from point to point, neighbouring differences have correlation -2/3 and
change sign in 73 % of all cases.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MOST_CHANGES = 0.55
"""Share of sign changes between neighbouring differences (no unit) above which points look noisy.

It lies between 0.73 +- 0.07 (noise, 50 points) and 0.4 (a sine with five points in each wavelength).
"""
FEWEST_REVERSALS = 5
"""Number of turns of friction from rise to fall or back, from which noise matters."""
SMALLEST = 1e-6
"""Standard deviation (no unit) below which noise is ignored: no apparatus resolves it, and single precision rounds by more."""


class Noise(NamedTuple):
    """Noise in points: its standard deviation (no unit), and how often friction turns from rise to fall or back."""

    size: float
    reversals: int

    def warning(self, makes: str = "") -> str:
        """Return the warning for users; `makes` says what the points make, by default how often friction turns."""
        makes = makes or f"friction turns {self.reversals} times"
        return (
            f"the points look noisy (about {self.size:.1g} in friction): interpolated exactly, {makes}; "
            "smooth them or fit a law with `stickslip fit`"
        )


def noise_in(places: Sequence[float], values: Sequence[float]) -> Noise | None:
    """Return the noise in points with ascending places, or None if they look smooth or turn hardly ever."""
    x, y = np.asarray(places, float), np.asarray(values, float)
    turns = reversals(y)
    if turns < FEWEST_REVERSALS:
        return None
    left = (x[2:] - x[1:-1]) / (x[2:] - x[:-2])
    differences = y[1:-1] - left * y[:-2] - (1.0 - left) * y[2:]
    size = float(np.sqrt(np.mean(differences**2 / (1.0 + left**2 + (1.0 - left) ** 2))))
    changes = float(np.mean(differences[1:] * differences[:-1] < 0.0))
    return Noise(size, turns) if changes > MOST_CHANGES and size > SMALLEST else None


def reversals(values: Sequence[float] | NDArray[np.float64]) -> int:
    """Return how often a sequence turns from rise to fall or back; equal neighbours are passed over."""
    steps = np.diff(np.asarray(values, float))
    signs = np.sign(steps[steps != 0.0])
    return int(np.count_nonzero(signs[1:] != signs[:-1]))
