"""Regularisations as schemes of the lab: the exact contact with the little inertia or memory that its selection rule replaces.

Their *size* is the small settling time (s) of the slip rate; here it is the step of the mesh. A contact mass of Z size and a
lag of `size` obey the same equation, Z size dy/dt = load - g(y), with y the slip rate v for the mass, and for the lag the delayed
rate w on which friction depends. At Courant number 1/2 the mass is rho dx/2, that of the contact node of a grid with lumped masses.
Sources: Campillo et al. 1996, section 3; for the lag Hess & Soom 1990, J. Tribol. 112, 147.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from stickslip.extensions.schemes.contract import Grid, Sample, Scheme, SchemeContact
from stickslip.extensions.schemes.run import SCHEMES
from stickslip.foundation.errors import InputError
from stickslip.friction import LaggedFriction
from stickslip.problem import Problem
from stickslip.problem.bodies import as_slab
from stickslip.run import uninterrupted
from stickslip.run.simulate import simulate


class Regularisation:
    """A scheme that runs the exact engine on a changed problem, and shows the history at the steps of the mesh.

    `change` returns the problem with a regularisation of a size (s). The contact of the grid, and its search, are not used.
    """

    order, courant, largest_courant = 1.0, 0.5, math.inf

    def __init__(self, name: str, title: str, change: Callable[[Problem, float], Problem]) -> None:
        self.name, self.title, self.change = name, title, change

    def begin(self, grid: Grid) -> Replay:
        """Return the slab at t = 0. Raises InputError if the regularisation does not suit the law."""
        try:
            changed = self.change(grid.problem, grid.dt)
        except InputError as error:
            raise InputError(f"schemes: {self.name} does not suit {grid.problem.friction.kind} friction: {error}") from None
        return Replay(self._samples(changed, grid))

    def _samples(self, changed: Problem, grid: Grid) -> Iterator[Sample]:
        """Run the changed problem when the first sample is asked for, and yield the state at each step."""
        time = grid.dt * np.arange(math.floor(grid.duration / grid.dt) + 2)
        run = uninterrupted(simulate(changed, float(time[-1]), shortest_event=0.0))
        end = run.history.span[1]
        if end < time[-1]:
            reason = f"its run ends at {end:g} s ({run.status.name})"
            raise InputError(f"schemes: {self.name} with {grid.cells} cells: {reason}: give a shorter duration")
        states = np.column_stack([time, run.slip(time) - grid.slip, run.slip_rate(time), run.traction(time)])
        yield from (Sample(*state) for state in states.tolist())


class Replay:
    """The samples of a run, one after the other."""

    def __init__(self, samples: Iterator[Sample]) -> None:
        self.samples = samples

    def first(self, contact: SchemeContact) -> Sample:
        """Return the state just after t = 0."""
        return next(self.samples)

    def advance(self, contact: SchemeContact) -> Sample:
        """Return the state at the next step."""
        return next(self.samples)


def with_contact_mass(problem: Problem, size: float) -> Problem:
    """Return the problem of a slab with the contact mass Z size."""
    return replace(problem, body=replace(as_slab(problem.body), contact_mass=problem.body.impedance * size))


def with_lag(problem: Problem, size: float) -> Problem:
    """Return the problem with friction that follows the slip rate by a time (s)."""
    return replace(problem, friction=LaggedFriction(problem.friction, time=size))


LAB: dict[str, Scheme] = SCHEMES | {
    "contact-mass": Regularisation("contact-mass", "exact, with the contact mass Z dt", with_contact_mass),
    "lag": Regularisation("lag", "exact, with friction that lags by dt", with_lag),
}
"""All that the lab can run, by name: the numerical schemes, and two regularisations."""
