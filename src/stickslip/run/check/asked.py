"""List what `check` asks of each kind of body, and of each kind of driver."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from stickslip.contact import Uniqueness
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS, DRIVER_KINDS, Problem
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.scenarios import Scenario
from stickslip.run.reference.rate_and_state import SteadySliding


@dataclass(frozen=True)
class Fact:
    """A number with its unit, or a word, with its name and its meaning, as `stickslip check` shows it."""

    name: str
    value: float | str
    unit: str
    meaning: str


class CheckOfKind(ABC):
    """What is asked of a kind of body; where nothing is answered there is nothing to say."""

    @abstractmethod
    def numbers(self, problem: Problem) -> list[Fact]:
        """Return what follows from the numbers of the body, its driver and its loading."""

    def mass_on_ground(self, body: BodyOnCharacteristics) -> float | None:
        """Return the mass (kg, or kg/m^2) that ground sets in motion where nothing but the contact holds it; None if more does."""
        return None

    def pulses(self, problem: Problem) -> list[Fact]:
        """Return the period of pulses under friction that oscillates along slip, where the load of the start makes them."""
        return []

    def chosen(self, problem: Problem) -> Iterator[str]:
        """Yield what is chosen of the motion of the body, the stress in it, and its driver, before the start."""
        yield from ()

    def other_start(self, problem: Problem) -> str:
        """Return a sentence on the start that the contact would have without its mass, where that is another one; else ""."""
        return ""

    @abstractmethod
    def stability(self, problem: Problem, by_slip: float, by_rate: float) -> str:
        """Return a sentence on static stability at the start, where friction has these slopes along slip (1/m) and rate (s/m)."""

    @abstractmethod
    def critical_stiffness(self, body: BodyOnCharacteristics, sliding: SteadySliding) -> tuple[str, float] | None:
        """Return what the stiffness of the body is called, and that above which sliding is stable; None where none decides."""

    def warnings(self, scenario: Scenario, contact: Uniqueness) -> list[str]:
        """Return what a user should know of the body before a run whose uniqueness is `contact`, one line each."""
        return []


class CheckOfDriver:
    """What is asked of a kind of driver; by default there is nothing to say."""

    sends_back: ClassVar[str] = ""
    """What it reflects, and when, as sentences say it after "reflection"."""
    not_held: ClassVar[str] = ""
    """A remark on a body that is not held in slow motion, because its driver gives way; "" where it is held."""
    to_let_waves_out: ClassVar[tuple[str, ...]] = ()
    """What keeps a history short where the driver sends all waves back; nothing where it does not."""

    def facts(self, problem: Problem, way: str) -> list[Fact]:
        """Return what follows from the numbers of the driver; `way` is the time, in words, from there to the contact."""
        return []

    def at_start(self, problem: Problem) -> Iterator[str]:
        """Yield how the driver begins, and what the far stress then is or does."""
        yield from ()

    def healing(self, body: BodyOnCharacteristics) -> list[str]:
        """Return a warning about friction that heals instantly on a contact without mass, before this driver."""
        return []


CHECK_KINDS: ByKind[CheckOfKind] = ByKind("stickslip.run.check.kinds", BODY_KINDS)
CHECK_DRIVERS: ByKind[CheckOfDriver] = ByKind("stickslip.run.check.drivers", DRIVER_KINDS)
