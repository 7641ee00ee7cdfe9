"""What moving ground adds to the energies of a run: its work on a body with waves, and the absolute velocity of a contact.

A slab is seen from outside: the ground works against friction. A block is seen from the ground: the force of inertia -m a works on
its slip, and is no force of the spring (`solution.observables.kinds.rigid`).
"""

from __future__ import annotations

import numpy as np

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.solution.observables.quadrature import Integrand, up_to


def shaken(history: History, at: Positions) -> Floats:
    """Return the work of moving ground on a slab up to each position, J/m^2; it is 0 where the ground is at rest."""
    return np.zeros(len(at.piece)) if history.problem.ground is None else up_to(history, at, shaking(history))


def shaking(history: History) -> Integrand:
    """Return the power that moving ground puts into a slab as a function of positions, W/m^2: friction moves with the ground."""
    return lambda at: -(history.problem.strength + history.friction(at)) * (speed(history, at) - history.rate(at))


def speed(history: History, at: Positions) -> Floats:
    """Return the absolute velocity of the contact (m/s): its slip rate, and the velocity of the ground."""
    ground = history.problem.ground
    return history.rate(at) if ground is None else history.rate(at) + ground.velocity_at(*history.times_inside(at))
