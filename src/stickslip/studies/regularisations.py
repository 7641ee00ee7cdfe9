"""Three ways to give a massless contact some of the physics that its selection rule stands for, each with one small time.

The time, the *size* of a regularisation, is how long the slip rate takes to settle (s). A contact mass of Z size and a lag of
`size` obey the same equation, Z size dy/dt = load - g(y), for the slip rate v and for the rate w that friction has caught up
with: their sizes can be compared. Sources: Campillo et al. 1996, section 3; for the lag Hess & Soom 1990, J. Tribol. 112, 147.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from stickslip.bodies import ElasticSlab
from stickslip.contact.equation import resistance
from stickslip.foundation.errors import InputError, nearest
from stickslip.friction import LaggedFriction
from stickslip.problem.problem import Problem

FADES = 1e-6
"""Slip rate below which the direct effect fades, as a share of the smallest slip rate at which the law itself does something."""


@dataclass(frozen=True)
class Kind:
    """How to regularise: what to call it, what its own parameter is, and the problem with it at a size (s)."""

    title: str
    parameter: str
    unit: str
    value: Callable[[Problem, float], float]
    apply: Callable[[Problem, float], Problem]


def _slab(problem: Problem) -> ElasticSlab:
    assert isinstance(problem.body, ElasticSlab)
    return problem.body


def _mass(problem: Problem, size: float) -> float:
    return _slab(problem).impedance * size


def _with_mass(problem: Problem, size: float) -> Problem:
    return replace(problem, body=replace(_slab(problem), contact_mass=_mass(problem, size)))


def _with_lag(problem: Problem, size: float) -> Problem:
    return replace(problem, friction=LaggedFriction(problem.friction, time=size))


def _direct(problem: Problem, size: float) -> float:
    """All the law's variation at a size of a round trip, and with the size to nothing: at R/50 some 0.01, as in laboratories."""
    return problem.friction.variation * size / _slab(problem).two_way_time


def _with_direct_effect(problem: Problem, size: float) -> Problem:
    fades = FADES * min(resistance(problem).scales)
    lagged = LaggedFriction(problem.friction, time=size, direct=_direct(problem, size), direct_rate=fades)
    return replace(problem, friction=lagged)


KINDS = {
    "contact-mass": Kind("contact mass", "contact_mass", "kg/m^2", _mass, _with_mass),
    "lag": Kind("lagged friction", "time", "s", lambda problem, size: size, _with_lag),
    "direct-effect": Kind("lag and direct effect", "direct", "1", _direct, _with_direct_effect),
}
"""Every kind by its name: `by` of `stickslip.regularise`."""


def kind_of(by: str) -> Kind:
    """The kind of that name. Raises InputError."""
    if by not in KINDS:
        raise InputError(f"regularise: there is no regularisation '{by}'; {nearest(by, KINDS)}")
    return KINDS[by]


def check_massless(problem: Problem) -> ElasticSlab:
    """The problem's slab, or InputError where inertia or a state already makes the slip rate unique."""
    if not isinstance(problem.body, ElasticSlab):
        raise InputError("regularise: a block has inertia, which makes its slip rate unique: there is nothing to regularise")
    if problem.body.contact_mass > 0.0:
        raise InputError(
            f"regularise: a contact_mass of {problem.body.contact_mass:g} kg/m^2 makes the slip rate unique already: start from 0"
        )
    if problem.friction.state is not None:
        raise InputError(
            f"regularise: {problem.friction.kind} friction has a state of its own already: start from a law of slip rate"
        )
    return problem.body


def regularised(problem: Problem, by: str, size: float) -> Problem:
    """The problem with a regularisation of a size (s). Raises InputError where the kind does not suit the law."""
    kind = kind_of(by)
    try:
        return kind.apply(problem, size)
    except InputError:
        law = problem.friction.kind
        raise InputError(f"regularise: '{by}' needs a smooth law of slip rate only, {law} is not; try 'contact-mass'") from None
