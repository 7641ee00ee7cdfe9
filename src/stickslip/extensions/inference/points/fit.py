"""Fit friction laws to measured points, of one direction of slip or of both."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stickslip.extensions.inference.points.fit_both_ways import fit_both_ways
from stickslip.extensions.inference.points.fit_one_way import Fit, fit_one_way
from stickslip.foundation.arguments import for_users
from stickslip.foundation.errors import InputError
from stickslip.friction import Points

__all__ = ["Fit", "fit", "fit_each"]


@for_users
def fit(points: Any, law: Any, *, start: Mapping[str, Any] | None = None, fixed: Mapping[str, Any] | None = None) -> Fit:
    """Fit the parameters of a friction law to measured points, by least squares.

    Parameters
    ----------
    points : Points, str, Path, DataFrame or mapping
        The points, in a form that `Points.read` understands.
    law : str, FrictionLaw or class
        The law: its name in scenario files, such as "hyperbolic-rate"; the names of a law of slip and a law of slip rate, joined by
        "+" or "*"; or a law with parameters, such as `FromExpression`: its values are the start if points give no better hint.
    start : mapping, optional
        Starting values of parameters, in SI or as text with a unit. By default they follow from the points.
    fixed : mapping, optional
        Values of known parameters, which are not fitted.

    Raises
    ------
    InputError
        If the points or an argument cannot be used, or for a law with a state or with points of its own.

    Notes
    -----
    Points of both directions of slip give one law for both, or `BothWays` if BIC tells two laws by more than 10; a note says how
    far the directions differ. All points have the same weight. Uncertainties follow from the curvature of the sum of squares at
    its minimum: they hold if the differences from the law are independent from point to point. Whole exponents are tried from 1 to
    4.
    """
    read = Points.read(points)
    if read.backward is None:
        return fit_one_way(read, law, start, fixed)
    return fit_both_ways(read, law, start, fixed)


@for_users
def fit_each(points: Any) -> list[Fit]:
    """Fit every law that suits the points, and return the fits, best first by `Fit.bic`.

    These are the laws with parameters and without a state that depend only on variables of the points; for the forms of points see
    `Points.read`. Raises InputError if they cannot be used.
    """
    from stickslip.friction import LAWS

    read, found = Points.read(points), []
    for kind in LAWS:
        try:
            found.append(fit(read, kind))
        except InputError:
            continue  # a law that these points do not suit
    return sorted(found, key=lambda one: one.bic)
