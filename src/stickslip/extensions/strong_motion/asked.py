"""What a study of sliding is asked: yield coefficients, polarities, scales, and the column of soil, checked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from stickslip.extensions.strong_motion.motion import GroundMotion
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.conversion import has_unit, to_number
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.units import si_factor

POLARITIES: Mapping[Any, tuple[int, ...]] = {1: (1,), -1: (-1,), "both": (1, -1)}
"""The polarities that each answer stands for: 1 is the record as it comes, under which the load gains -m a."""
ANALYSES = ("rigid", "coupled", "decoupled")
"""Kinds of analysis: a rigid block, a column that deforms while it slides, and one that deforms before its motion moves a block."""
LENGTHS = ("m", "cm", "mm", "in", "ft")
"""Units of displacements as they are shown; velocities are in the same unit per second."""
ABOVE_ZERO = 'must be above 0: a part of g, such as 0.1, or with a unit, such as "0.1 g"'
"""What a yield coefficient and a peak acceleration must be."""
SAME = "same"
"""Stands for backward yield coefficients that are those forward."""


class ShakingLevels(NamedTuple):
    """How strongly records shake: factors on them, or peak accelerations (g) to which they are scaled."""

    values: tuple[float, ...]
    is_pga: bool

    def scales(self, motion: GroundMotion) -> list[float]:
        """Return the factors on a record. Raises InputError for one that is 0 throughout and cannot be scaled."""
        if not self.is_pga:
            return list(self.values)
        if motion.measures.pga == 0.0:
            raise InputError(f"{motion.name}: its acceleration is 0 throughout, so that no factor brings it to a peak")
        return [value * GRAVITY / motion.measures.pga for value in self.values]


class SlidingAsked(NamedTuple):
    """What a study is asked, apart from the records."""

    forward: Floats
    """Yield coefficients (of g)."""
    backward: Floats
    """Yield coefficients (of g) of backward slip; infinite where there is none."""
    polarities: tuple[int, ...]
    levels: ShakingLevels
    analysis: str
    column: Any


def read_coefficients(given: Any, where: str) -> Floats:
    """Return yield coefficients or peaks (of g): plain numbers are of g, texts and quantities have a unit of acceleration.

    Raises InputError, which begins with `where`, for one that is not above 0.
    """
    several = isinstance(given, Iterable) and not isinstance(given, str) and getattr(given, "ndim", 1) > 0
    if has_unit(given) or not several:
        given = [given]
    found = np.array([_coefficient(one, where) for one in given])
    if not found.size:
        raise InputError(f"{where} must have at least one number")
    return found


def _coefficient(given: Any, where: str) -> float:
    try:
        value = to_number(given, "m/s^2")
    except InputError as error:
        raise InputError(f"{where} {ABOVE_ZERO}; got {error}") from None
    value = value / GRAVITY if isinstance(given, str) or has_unit(given) else value
    if not 0.0 < value < math.inf:
        raise InputError(f"{where} {ABOVE_ZERO}; got {shown(given)}")
    return value


def read_asked(who: str, yields: Any, backward: Any, polarity: Any, *, scale: Any, scale_to_pga: Any) -> SlidingAsked:
    """Return what is asked of rigid blocks. Raises InputError, which begins with `who`."""
    forward = read_coefficients(yields, f"{who}: yields")
    if isinstance(polarity, bool) or not isinstance(polarity, int | float | str) or polarity not in POLARITIES:
        raise InputError(f"{who}: polarity must be 1 (the record as it comes), -1 or 'both', got {shown(polarity)}")
    if scale is not None and scale_to_pga is not None:
        raise InputError(f"{who}: give scale or scale_to_pga, not both")
    levels = ShakingLevels((1.0,), is_pga=False)
    if scale_to_pga is not None:
        levels = ShakingLevels(tuple(read_coefficients(scale_to_pga, f"{who}: scale_to_pga").tolist()), is_pga=True)
    elif scale is not None:
        levels = ShakingLevels(_factors(scale, f"{who}: scale"), is_pga=False)
    return SlidingAsked(forward, _backward(backward, forward, who), POLARITIES[polarity], levels, "rigid", None)


def _factors(given: Any, where: str) -> tuple[float, ...]:
    several = given if isinstance(given, Iterable) and not isinstance(given, str) else [given]
    found = []
    for one in several:
        try:
            found.append(to_number(one, "1"))
        except InputError as error:
            raise InputError(f"{where} must be a number above 0, got {error}") from None
        if not 0.0 < found[-1] < math.inf:
            raise InputError(f"{where} must be a number above 0, got {shown(one)}; polarity=-1 turns a record round")
    if not found:
        raise InputError(f"{where} must have at least one number")
    return tuple(found)


def _backward(given: Any, forward: Floats, who: str) -> Floats:
    if given is None:
        return np.full(len(forward), math.inf)
    if isinstance(given, str) and given == SAME:
        return forward
    found = read_coefficients(given, f"{who}: backward")
    if len(found) not in (1, len(forward)):
        raise InputError(f"{who}: backward must have one number, or one for each of {len(forward)} yields, got {len(found)}")
    return np.broadcast_to(found, forward.shape)


def read_analysis(who: str, analysis: Any, column: Any) -> str:
    """Return the kind of analysis. Raises InputError, which begins with `who`, if it is none, or has no column."""
    if analysis not in ANALYSES:
        raise InputError(
            f"{who}: analysis must be rigid, coupled or decoupled, got {shown(analysis)}; {nearest(str(analysis), ANALYSES)}"
        )
    if analysis == "rigid" and column is not None:
        raise InputError(f"{who}: a column is for analysis='coupled' or 'decoupled'; a rigid block has none")
    if analysis != "rigid" and column is None:
        raise InputError(
            f"{who}: analysis='{analysis}' needs a column, such as ss.SoilColumn(density, wave_speed, thickness, normal_stress)"
        )
    return str(analysis)


def read_length(who: str, unit: Any) -> float:
    """Return the size (m) of a unit of displacements. Raises InputError, which begins with `who`."""
    if unit not in LENGTHS:
        raise InputError(f"{who}: unit must be one of {', '.join(LENGTHS)}, got {shown(unit)}; {nearest(str(unit), LENGTHS)}")
    return float(si_factor(unit, "m"))
