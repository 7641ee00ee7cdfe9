"""Magnitudes of slip events from their moments.

Papers on chains measure an event by mu = ln M, where the moment M is the sum of slip over the blocks (m); seismology by
m = (2/3) log10 M and a constant, where M is a seismic moment (N m). The two are proportional: a slope of one is a slope of the
other.

Sources: J.M. Carlson, J.S. Langer, Phys. Rev. A 40, 6470 (1989), mu; T.C. Hanks, H. Kanamori, J. Geophys. Res. 84 (1979), m.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from stickslip.foundation.arguments import for_users, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

Scale = Literal["ln", "moment"]
"""What a magnitude is: "ln" is mu = ln M, "moment" is m = (2/3) log10 M."""
FACTORS = {"ln": 1.0, "moment": 2.0 / (3.0 * np.log(10.0))}
"""A magnitude divided by ln M."""
RUN_OR_NUMBERS = "the run of a chain or a list of numbers"
"""What functions of catalogues take."""
SYMBOLS = {"ln": r"\mu = \ln M", "moment": r"m = \frac{2}{3} \log_{10} M"}
"""How a figure writes a magnitude."""


@for_users
def magnitudes(moments: Any, scale: Scale = "ln") -> Floats:
    """Return the magnitudes of events from their moments.

    Parameters
    ----------
    moments : ChainRun or array_like
        The run of a chain, of whose events those with a moment are taken, or moments M: of a chain the sum of slip over the blocks
        (m). Of a moment below 0, of slip backwards, the size counts.
    scale : {"ln", "moment"}
        "ln" is mu = ln M, as papers on chains have it; "moment" is m = (2/3) log10 M, as seismology has it but for its constant.

    Raises
    ------
    InputError
        If a moment is 0 or not finite, or if the scale is not known.

    Examples
    --------
    >>> import stickslip as ss
    >>> ss.studies.magnitudes([1.0, 10.0], "moment").round(3).tolist()
    [0.0, 0.667]
    """
    if not isinstance(scale, str) or scale not in get_args(Scale):
        raise InputError(f"magnitudes: scale must be 'ln' or 'moment', got {shown(scale)}")
    given = moments_of(moments)
    return np.asarray(np.log(np.abs(given)) * FACTORS[scale])


def moments_of(source: Any) -> Floats:
    """Return moments from a run (of its events those with a moment), or as they are given. Raises InputError."""
    if (events := getattr(source, "events", None)) is not None:
        found = np.asarray(events["moment"], dtype=float)
        return np.asarray(found[found != 0.0])
    given = numbers_of("magnitudes", "moments", source, RUN_OR_NUMBERS)
    if not given.all():
        where = int(np.flatnonzero(given == 0.0)[0])
        raise InputError(f"magnitudes: moments must not be 0, and that of event {where + 1} of {len(given)} is: leave it out")
    return given


def numbers_of(who: str, name: str, given: Any, wanted: str = "a list of numbers") -> Floats:
    """Return a list of finite numbers as an array. Raises InputError, which begins with `who` and says what is `wanted`."""
    if hasattr(given, "columns") or getattr(getattr(given, "dtype", None), "names", None):
        raise InputError(f"{who}: {name} must be {wanted}, got a table: give the run itself, or {name}")
    try:
        found = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{who}: {name} must be {wanted}, got {shown(given)}") from None
    if found.ndim != 1 or not found.size:
        got = f"an array of shape {found.shape}" if found.ndim else shown(given)
        raise InputError(f"{who}: {name} must be {wanted}, got {got}")
    if not np.isfinite(found).all():
        where = int(np.flatnonzero(~np.isfinite(found))[0])
        raise InputError(f"{who}: {name} must be finite, and number {where + 1} of {len(found)} is {found[where]:g}")
    return found
