"""Fit a friction law to measured points of one direction of slip, by least squares."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip.extensions.inference.determined import covariance_of, misses_trend, sizes_and_correlation, undetermined
from stickslip.extensions.inference.points.fit_search import EXPONENTS, Leaf, leaves, numbers_of, rebuilt, search, slopes, template
from stickslip.foundation.arguments import NamesAttributes
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import own_units
from stickslip.foundation.quantities import in_units
from stickslip.foundation.show import ShownAsTable, with_uncertainty
from stickslip.friction import FrictionLaw, Points

EXACT_POINTS = 1e-9
"""With a residual below this (no unit), points lie on a law up to the errors of calculation."""
AT_LIMIT = 1e-9
"""A parameter is at its limit if it is closer than this share of the change that the points would notice."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit(NamesAttributes, ShownAsTable):
    """The result of `fit`: the law that fits best, and how well the points determine it.

    `points` have the variables of the law, and `residual` is their standard deviation about the law (no unit), corrected for the
    number of fitted parameters. `values` are the parameters in SI by their names in scenario files. `uncertainty` are their
    standard uncertainties, infinite if the points do not determine one, and `correlation` has the same order. `bic` is the Bayesian
    information criterion (Schwarz 1978): of several laws for the same points, the law with the smallest value fits best for its
    number of parameters; a difference above 10 is decisive. `notes` are sentences on undetermined parameters, and on trends that
    the law misses.
    """

    law: FrictionLaw
    points: Points
    residual: float
    values: dict[str, float]
    uncertainty: dict[str, float]
    correlation: Floats
    bic: float
    notes: list[str]
    _covariance: Floats
    _how: dict[str, str]

    def band(self, u: ArrayLike = 0.0, v: ArrayLike = 0.0) -> tuple[Floats, Floats]:
        """Return friction of the law (no unit) at slips (m) and slip rates (m/s), which broadcast, and its standard error.

        The error follows from the uncertainty of the parameters. Those that the points do not determine are taken as known.
        """
        slip, rate = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        by = slopes(self.law, list(self.uncertainty), slip.ravel(), rate.ravel())
        spread = np.sum((by @ np.nan_to_num(self._covariance)) * by, axis=1)
        return self.law.coefficient(slip, rate), np.sqrt(np.maximum(spread, 0.0)).reshape(slip.shape)

    @property
    def fitted(self) -> str:
        """What was fitted: the kind of the law."""
        return self.law.kind

    @property
    def title(self) -> str:
        """One line: which law was fitted to which points."""
        count = sum(map(len, self.points.ways))
        return f"{self.fitted} fitted to {count} points along {' and '.join(self.points.has)}"

    @property
    def rows(self) -> list[tuple[str, str, str]]:
        """Name, value and unit of each number of the result, as text."""
        known, sizes = leaves(self.law), self.uncertainty
        found, units = [], own_units(self.points.load_unit)
        for name, value in self.values.items():
            declared = known[name].declared.unit
            unit = "" if declared == "1" else units.get(declared, declared)
            how = f"({self._how[name]})" if name in self._how else ""
            found.append((name, with_uncertainty(value, sizes.get(name)), f"{unit} {how}".strip()))
        return [*found, ("residual", f"{self.residual:.3g}", "standard deviation of the points about the law")]

    @property
    def _caption(self) -> str:
        """The title."""
        return self.title

    def _lines(self) -> list[tuple[str, ...]]:
        """Return rows and notes."""
        return [*self.rows, *(("note", note) for note in self.notes)]


def fit_one_way(
    points: Points, law: Any, start: Mapping[str, Any] | None, fixed: Mapping[str, Any] | None, *, way: str = ""
) -> Fit:
    """Fit the parameters of a law to points of one direction of slip, as `fit` does; `way` names it in messages."""
    wanted = template(law)
    chosen = _points_for(wanted, points)
    units = own_units(chosen.load_unit)
    known = {name: leaf._replace(declared=in_units(leaf.declared, units)) for name, leaf in leaves(wanted).items()}
    held, begun = numbers_of(fixed, known, "fixed"), numbers_of(start, known, "start")
    whole = [name for name, leaf in known.items() if leaf.declared.whole and name not in held]
    free = [name for name, leaf in known.items() if not leaf.declared.whole and name not in held]
    if not free:
        raise InputError("fit: every parameter is fixed: there is nothing to fit")
    if len(chosen) <= len(free) + len(whole):
        raise InputError(f"fit: {len(chosen)} points{way} cannot determine {len(free) + len(whole)} parameters of {wanted.kind}")
    found = []
    for exponents in product(*([begun[name]] if name in begun else EXPONENTS for name in whole)):
        tried = held | dict(zip(whole, exponents, strict=True))
        total, values = search(rebuilt(wanted, tried, checked=False), free, chosen, begun)
        found.append((total, tried | values))
    total, values = min(found, key=lambda one: one[0])
    return _result(wanted, chosen, {name: values[name] for name in known}, total, whole=whole, free=free)


def _points_for(law: FrictionLaw, points: Points) -> Points:
    """Return the points with the variables of a law. Raises InputError if they lack one."""
    needs = [name for name, needed in (("slip", law.depends_on_slip), ("slip_rate", law.depends_on_rate)) if needed]
    for name in needs:
        if name not in points.has:
            raise InputError(f"fit: {law.kind} depends on {name}, but the points have {' and '.join(points.has)} only")
    if points.slip is not None and "slip" in needs and law.counts == "path" and points.slip.min() < 0.0:
        raise InputError(
            f"fit: {law.kind} counts the path of slip, which is never negative, got {points.slip.min():g} {points.slips_in or 'm'}"
        )
    return points.along(needs[0]) if len(needs) == 1 else points


def _result(law: FrictionLaw, points: Points, values: dict[str, float], total: float, *, free: list[str], whole: list[str]) -> Fit:
    """Return the fit with the results that follow from its parameters. Raises InputError if they are no law."""
    known, n, variables = leaves(law), len(points), points.variables
    variance = total / max(n - len(free) - len(whole), 1)
    by = slopes(rebuilt(law, values, checked=False), free, *variables)
    limits = [name for i, name in enumerate(free) if _at_limit(known[name], values[name], by[:, i], variance)]
    values = values | {name: float(known[name].declared.at_least or 0.0) for name in limits}
    try:
        made = rebuilt(law, values)
    except InputError as error:
        raise InputError(f"fit: the points give no {law.kind}: {str(error).partition(': ')[2]}") from None
    points.of_contact(made)
    inner = [i for i, name in enumerate(free) if name not in limits]
    names = [free[i] for i in inner]
    covariance, unseen = covariance_of(by[:, inner], variance)
    sizes, correlation = sizes_and_correlation(covariance)
    uncertainty = dict(zip(names, sizes.tolist(), strict=True))
    open_sets = [[names[i] for i in part] for part in unseen]
    notes = [f"{name} is at its limit, {values[name]:g}: no other value that is allowed fits better" for name in limits]
    notes += undetermined(values, uncertainty, correlation, open_sets)
    order = np.lexsort(variables)
    if math.sqrt(total / n) > EXACT_POINTS and misses_trend((made.coefficient(*variables) - points.friction)[order]):
        notes.append("the law misses a trend of the points: the uncertainties are too small, see a figure of the fit")
    bic = n * math.log(max(total / n, EXACT_POINTS**2)) + (len(inner) + len(whole) + 1) * math.log(n)
    how = {name: "fixed" for name in values if name not in free} | dict.fromkeys(
        whole, f"tried {EXPONENTS[0]:g} to {EXPONENTS[-1]:g}"
    )
    how |= dict.fromkeys(limits, "at its limit") | {name: "not determined" for part in open_sets for name in part}
    return Fit(made, points, math.sqrt(variance), values, uncertainty, correlation, bic, notes, covariance, how)


def _at_limit(leaf: Leaf, value: float, slopes_by: Floats, variance: float) -> bool:
    """Return True if a parameter with the lower limit 0 is there, as closely as the points would notice."""
    least = leaf.declared.at_least
    size = float(np.linalg.norm(slopes_by))
    if least is None or leaf.is_scale or size == 0.0:
        return False
    noticed = math.sqrt(variance) / size
    return value - least <= AT_LIMIT * max(noticed, abs(value))
