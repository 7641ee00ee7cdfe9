"""List what a fit asks of each kind of body."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence

from stickslip.extensions.inference.fit.free import Free
from stickslip.extensions.inference.fit.part import Part, StickSlip
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import LoadingHistory, Problem
from stickslip.problem.bodies import BodyOnCharacteristics


class FittedKind(ABC):
    """What is asked of a kind of body; where nothing is answered a record shows nothing of it."""

    @abstractmethod
    def check_sensor(self, body: BodyOnCharacteristics, sensor: str) -> None:
        """Raise InputError if shear of such a body is not measured where `sensor` says."""

    @abstractmethod
    def is_away(self, record: Record, sensor: str) -> bool:
        """Return True if shear is measured at the driver, which waves reach later."""

    def about_drive(self, problem: Problem, record: Record, sensor: str, start: str | None, begins: str) -> Iterator[str]:
        """Yield sentences on what a record says of the drive."""
        yield from ()

    @abstractmethod
    def doubts_of_rate(self, problem: Problem, rate: LoadingHistory | float) -> Iterator[str]:
        """Yield sentences on a load point that hardly moves like a machine."""

    def rounded_times(self, body: BodyOnCharacteristics, names: Sequence[str]) -> list[str]:
        """Return a note on free numbers with which travel times are rounded. Raises InputError if they cannot be told apart."""
        return []

    def swing(self, body: BodyOnCharacteristics, cycles: StickSlip, names: set[str]) -> float:
        """Return how far a slip event goes beyond balance, as a share of how far away it began: all of it without losses."""
        return 1.0

    def shown(self, problem: Problem, part: Part, cycles: StickSlip, names: set[str]) -> Iterator[tuple[str, float]]:
        """Yield names and values (SI) of the numbers of the body that stick-slip shows."""
        yield from ()

    def doubts_of_stiffness(self, problem: Problem, part: Part, free: Sequence[Free]) -> Iterator[str]:
        """Yield a question if a stiffness that is not free differs from that of the record."""
        yield from ()


FITTED_KINDS: ByKind[FittedKind] = ByKind("stickslip.extensions.inference.fit.kinds")
