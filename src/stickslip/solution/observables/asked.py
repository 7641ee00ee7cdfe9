"""What a finished run is asked that its body answers by its kind: energies, field, motion at the driver, loads found again."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple

from stickslip.engine import History, Positions, Side
from stickslip.foundation.arrays import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS, Problem

AtContact = Callable[[], Floats]
"""The displacement of the contact (m) at the times that are asked about. It raises InputError for times outside the run."""


class AtDriver(NamedTuple):
    """What is measured at the driver at some times, one-dimensional."""

    rate: Floats
    """Velocity of the face that the driver holds, m/s."""
    load: Floats
    """Shear stress there (Pa, N or N m), positive if the driver pulls forwards."""


class Field(NamedTuple):
    """Displacement, velocity and stress in a slab at given places and times: arrays of the same shape."""

    displacement: Floats
    """Displacement u, m: absolute, as the slip is where the ground does not move; in a window, relative to the contact at the start
    of the event. It includes that of moving ground, as velocity does."""
    velocity: Floats
    """Velocity v, m/s."""
    stress: Floats
    """Shear stress sigma, Pa: positive if it pulls the contact forwards."""


class Extent(NamedTuple):
    """The places (m) inside a body with waves, from that of one driver to that of the other; the contact is at 0."""

    lowest: float
    """0 if there is one side."""
    highest: float
    boundaries: tuple[float, ...]
    """Where layers meet."""
    two_way_time: float
    """The longest two-way travel time to a driver (s)."""


class FollowedFronts(NamedTuple):
    """How wave fronts run to and fro between contact and driver."""

    two_way_time: float
    """s."""
    share: float
    """The share (1) of a front that the driver sends back, at most."""
    trips: float
    """Over more round trips than this, the ways of one and the same front cannot be told apart."""


class LoadCompared(NamedTuple):
    """How the loads of a history compare with those that are found again."""

    missed: float = 0.0
    """Largest difference (Pa, N or N m)."""
    compared: int = 0
    """Number of steps, and of rests, whose loads were compared."""


class ObservablesOfKind(ABC):
    """What a kind of body makes of a finished run. Energies are those of each m^2 of contact, or of a whole rigid body (J)."""

    # ---- energy -------------------------------------------------------------------------------------------------------------

    @abstractmethod
    def energies(self, history: History, at: Positions, nodes: int) -> dict[str, Floats]:
        """Return the energies at positions in a history: see `energy.balance.energies`."""

    @abstractmethod
    def event_energies(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return what slip events release, work, damp and leave trapped, from their first to their last positions."""

    @abstractmethod
    def energetics(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return how much kinetic energy slip events gain, what they radiate, and what is trapped before them."""

    @abstractmethod
    def trapped(self, history: History) -> float | None:
        """Return the energy in the waves at the end of a run; None without waves, or if it takes too long to find."""

    def coordinates(self, problem: Problem) -> dict[str, Any]:
        """Return the coordinates of its energies besides time, as xarray takes them: none, unless they are those of parts."""
        return {}

    # ---- at the driver ------------------------------------------------------------------------------------------------------

    @abstractmethod
    def at_driver(self, history: History, time: Floats, side: Side) -> AtDriver:
        """Return rate and load at the (first) driver at times (s since the epoch) in the run; at a jump on the given side."""

    def ways(self, problem: Problem) -> list[float]:
        """Return the time (s) that a wave takes from each driver to the contact."""
        return [problem.body.time_to_driver]

    def fronts_drawn(self, fronts: Floats) -> Floats:
        """Return the times (s) of fronts at the driver to draw a curve on both sides of: all, unless it is dear."""
        return fronts

    # ---- inside -------------------------------------------------------------------------------------------------------------

    @abstractmethod
    def field(self, history: History, at_contact: AtContact, place: Floats, time: Floats, side: Side) -> Field:
        """Return the field inside the body at places (m) and times (s) of one shape: see `field.field`."""

    @abstractmethod
    def extent(self, problem: Problem) -> Extent:
        """Return the places inside the body. Raises InputError for a rigid body."""

    @abstractmethod
    def fronts(self, problem: Problem) -> FollowedFronts:
        """Return how fronts run to and fro inside the body. Raises InputError for a rigid body."""

    # ---- proof --------------------------------------------------------------------------------------------------------------

    @abstractmethod
    def load_compared(self, history: History) -> LoadCompared:
        """Return how far the loads of a history are from those that follow from its slip and its problem."""


OBSERVABLES: ByKind[ObservablesOfKind] = ByKind("stickslip.solution.observables.kinds", BODY_KINDS)


def observables_of(problem: Problem) -> ObservablesOfKind:
    """Return the answers of the kind of body of a problem."""
    return OBSERVABLES[problem.body.structure]
