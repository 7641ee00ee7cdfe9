"""Regularisations: three ways to give a massless contact the physics that its selection rule replaces, each with a small time.

This time, the *size* of a regularisation (s), is the time in which the slip rate settles. A contact mass of Z size and a lag of
`size` obey the same equation, Z size dy/dt = load - g(y), with y the slip rate v for the mass, and the delayed rate w on which
friction depends for the lag. Their sizes can therefore be compared, as can the slips of regularised and exact runs.
Sources: Campillo et al. 1996, section 3; for the lag Hess & Soom 1990, J. Tribol. 112, 147.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from stickslip.bodies import ElasticSlab, as_slab
from stickslip.contact.branches import resistance
from stickslip.contact.roots import sign_change
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.friction import LaggedFriction
from stickslip.problem.problem import Problem, check_problem
from stickslip.solution.solution import Solution
from stickslip.studies.verdict import mean_magnitude

UNIFORM = 2001
"""Number of evenly spaced times at which runs are compared; times within the pieces of both histories are added."""
INSIDE = np.linspace(0.0, 1.0, 5)[:-1]
"""Positions of the times within each piece of a history, as shares of its length."""


@dataclass(frozen=True)
class SlipDifference:
    """A difference in slip between two runs (m): mean and largest magnitude over time, and signed value at the end."""

    mean: float
    largest: float
    end: float


def difference(one: Solution, other: Solution, until: float) -> SlipDifference:
    """Return the slip of `one` minus the slip of `other`, from t = 0 to `until` (s)."""
    time = np.unique(np.concatenate([np.linspace(0.0, until, UNIFORM), _inside(one, 0.0, until), _inside(other, 0.0, until)]))
    gap = one.slip(time) - other.slip(time)
    return SlipDifference(mean_magnitude(gap, time), float(np.abs(gap).max()), float(gap[-1]))


def _inside(solution: Solution, start: float, end: float) -> Floats:
    """Return times from start to end (s), four in every piece of the history, and the end."""
    breaks = solution.breaks
    times = (breaks[:-1, None] + np.diff(breaks)[:, None] * INSIDE).ravel()
    return np.append(times[(times >= start) & (times <= end)], min(end, float(breaks[-1])))


def passage(solution: Solution, level: float, rising: bool, near: float, span: tuple[float, float]) -> float:
    """Return the time (s) in a span (start, end) at which the slip rate passes a level (m/s), upwards if `rising`.

    If there are several such times, the result is the one nearest to `near`; it is NaN if there is none.
    """
    time = _inside(solution, *span)
    beyond = (solution.slip_rate(time) > level) == rising
    steps = np.flatnonzero(beyond[1:] & ~beyond[:-1])
    if not steps.size:
        return math.nan
    step = int(steps[np.argmin(np.abs(time[steps] - near))])
    way = 1.0 if rising else -1.0
    return sign_change(lambda t: way * (float(solution.slip_rate(t)) - level), float(time[step]), float(time[step + 1]))


FADES = 1e-6
"""Slip rate below which the direct effect fades, as a share of the smallest characteristic slip rate of the contact."""


@dataclass(frozen=True)
class Kind:
    """A kind of regularisation: its title, its parameter with unit, and functions of a problem and a size (s).

    `value` returns the parameter, and `apply` the regularised problem.
    """

    title: str
    parameter: str
    unit: str
    value: Callable[[Problem, float], float]
    apply: Callable[[Problem, float], Problem]


def _mass(problem: Problem, size: float) -> float:
    return problem.body.impedance * size


def _with_mass(problem: Problem, size: float) -> Problem:
    return replace(problem, body=replace(as_slab(problem.body), contact_mass=_mass(problem, size)))


def _with_lag(problem: Problem, size: float) -> Problem:
    return replace(problem, friction=LaggedFriction(problem.friction, time=size))


def _direct(problem: Problem, size: float) -> float:
    """Return the direct effect of a size (s): the variation of the friction coefficient times size over the two-way travel time.

    It vanishes with the size; at R/50 it is about 0.01, as measured in laboratories.
    """
    return problem.friction.variation * size / problem.body.round_trip_time


def _with_direct_effect(problem: Problem, size: float) -> Problem:
    fades = FADES * min(resistance(problem).scales)
    lagged = LaggedFriction(problem.friction, time=size, direct=_direct(problem, size), direct_rate=fades)
    return replace(problem, friction=lagged)


KINDS = {
    "contact-mass": Kind("contact mass", "contact_mass", "kg/m^2", _mass, _with_mass),
    "lag": Kind("lagged friction", "time", "s", lambda problem, size: size, _with_lag),
    "direct-effect": Kind("lag and direct effect", "direct", "1", _direct, _with_direct_effect),
}
"""All kinds of regularisation, keyed by the argument `by` of `stickslip.studies.regularise`."""


def kind_of(by: str) -> Kind:
    """Return the kind of regularisation with a given name. Raises InputError if there is none."""
    if by not in KINDS:
        raise InputError(f"regularise: there is no regularisation '{by}'; {nearest(by, KINDS)}")
    return KINDS[by]


def check_massless(problem: Problem) -> ElasticSlab:
    """Return the slab of a problem. Raises InputError if inertia or a state of the law already makes the slip rate unique."""
    check_problem("regularise", problem)
    refusal = "regularise: a block has inertia, which makes its slip rate unique: there is nothing to regularise"
    slab = as_slab(problem.body, refusal)
    if slab.has_inertia:
        raise InputError(
            f"regularise: a contact_mass of {slab.contact_mass:g} kg/m^2 makes the slip rate unique already: start from 0"
        )
    if problem.friction.states:
        raise InputError(
            f"regularise: {problem.friction.kind} friction has a state of its own already: start from a law of slip rate"
        )
    return slab


def regularised(problem: Problem, by: str, size: float) -> Problem:
    """Return the problem with a regularisation of a size (s). Raises InputError if the kind is unknown or does not suit the law."""
    kind = kind_of(by)
    try:
        return kind.apply(problem, size)
    except InputError:
        law = problem.friction.kind
        raise InputError(f"regularise: '{by}' needs a smooth law of slip rate only, {law} is not; try 'contact-mass'") from None
