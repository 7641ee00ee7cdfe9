"""What a fit asks of all bodies with waves."""

from __future__ import annotations

from collections.abc import Iterator

from typing_extensions import override

from stickslip.extensions.inference.fit.asked import FittedKind
from stickslip.extensions.inference.fit.at_drive import about_drive, doubts_of_rate
from stickslip.extensions.inference.fit.model import is_at_driver
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import TURNS
from stickslip.problem import LoadingHistory, Problem
from stickslip.problem.bodies import BodyOnCharacteristics


class FittedWaves(FittedKind):
    """The answers of bodies with waves, as far as they are alike."""

    @override
    def check_sensor(self, body: BodyOnCharacteristics, sensor: str) -> None:
        if sensor == "spring":
            own = f"a {body.noun} has none; sensor 'drive' is one at its driver"
            raise InputError(f"infer: sensor 'spring' is the load cell behind the spring of a block: {own}")

    @override
    def is_away(self, record: Record, sensor: str) -> bool:
        return record.shear is not None and is_at_driver(record.shear, sensor)

    def about_drive(self, problem: Problem, record: Record, sensor: str, start: str | None, begins: str) -> Iterator[str]:
        """Yield sentences on the drive of a body that turns; a slab is driven as the record says."""
        if problem.load_unit == TURNS:
            yield from about_drive(problem, record, sensor, start, begins)

    def doubts_of_rate(self, problem: Problem, rate: LoadingHistory | float) -> Iterator[str]:
        """Yield doubts about the drive of a slab; that of a body that turns swings if it gives way."""
        if problem.load_unit != TURNS:
            yield from doubts_of_rate(problem, rate)
