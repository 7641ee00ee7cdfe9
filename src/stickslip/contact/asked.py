"""What steady sliding asks of each kind of body: its modes, what drives it, and what friction may take away from it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from stickslip.contact.disturbance import Modes, Response
from stickslip.contact.roots import sign_change
from stickslip.contact.steady_proof import Judge
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS
from stickslip.problem.bodies import BodyOnCharacteristics

SURE = 1e-12
"""Stability at a rate counts as known if this relative change of the normal load does not change it."""
BodyT = TypeVar("BodyT", bound=BodyOnCharacteristics)
ModesT = TypeVar("ModesT", bound=Modes)


class SteadyDrive(NamedTuple):
    """What drives a contact at a steady slip rate v, pulled at a rate V: traction = far stresses + by_pull V - resists v."""

    resists: float
    """Impedance of drivers and drag of layers together (Pa s/m); inf if the drivers hold the rate."""
    by_pull: float
    """Impedance through which the pull acts (Pa s/m)."""
    shares: tuple[float, ...] = (1.0,)
    """Share (1) in the traction of the far stress on each side."""


class Withstood(NamedTuple):
    """The steepest fall of friction with the slip rate under which steady sliding without states is stable."""

    fall: float
    """Pa s/m, N s/m or N m s."""
    is_known: bool
    """False if it rests on what is found of the modes of layers, or behind a machine."""


class ContactOfKind(ABC, Generic[BodyT, ModesT]):
    """What is asked of each kind of body; slip rates are in m/s, and `normal` is the normal load (Pa, N or N m)."""

    @abstractmethod
    def modes(self, body: BodyT, normal: float, response: Response, *, patient: bool = False) -> ModesT:
        """Return the disturbances of steady sliding under a response of friction; `patient`: after a search of a second or two."""

    @abstractmethod
    def steady_drive(self, body: BodyT) -> SteadyDrive:
        """Return what drives the contact at a steady rate."""

    @abstractmethod
    def withstood(self, body: BodyT, normal: float) -> Withstood:
        """Return how steeply friction may fall with the slip rate."""

    def judge(self, body: BodyT, normal: float, many: int) -> Judge | None:
        """Return what proves whether sliding is stable under a law with `many` states; None if nothing does."""
        return None

    def overshoots(self, body: BodyT) -> bool:
        """Return True if a contact that was held may pass steady sliding so far that it rests again."""
        return False

    def not_sought(self, body: BodyT) -> str:
        """Return why steady sliding is not sought, "" if it is."""
        return ""

    def is_surely_stable(self, body: BodyT, normal: float, response: Response) -> bool | None:
        """Return whether sliding is stable; None if rounding decides: a little more or less normal load changes the answer."""
        more, less = (self.modes(body, normal * share, response).verdict is True for share in (1.0 + SURE, 1.0 - SURE))
        return more if more == less else None

    def edge(self, modes_at: Callable[[float], ModesT], low: float, high: float, stable_above: bool) -> float:
        """Return the slip rate between two others where stability changes."""
        return sign_change(lambda rate: 1.0 if (modes_at(rate).verdict is True) == stable_above else -1.0, low, high)

    def withstands(self, body: BodyT, normal: float, fall: float) -> bool:
        """Return True if sliding is stable where friction falls with the slip rate by `fall` (Pa s/m)."""
        return self.modes(body, normal, Response(np.array([-fall / normal]), np.ones(1))).verdict is True

    def largest_fall(self, body: BodyT, normal: float, high: float) -> float:
        """Return the largest fall (Pa s/m) between 0 and `high` that is withstood, by bisection; all smaller ones are, too."""
        low = 0.0
        while True:
            middle = 0.5 * (low + high)
            if not low < middle < high:
                return low
            low, high = (middle, high) if self.withstands(body, normal, middle) else (low, middle)


CONTACT_KINDS: ByKind[ContactOfKind[Any, Any]] = ByKind("stickslip.contact.kinds", BODY_KINDS)
