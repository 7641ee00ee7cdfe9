"""A rigid driver: it holds the body, sends all waves back, and feels no far stress."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from stickslip.problem import Problem
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.run.check.asked import CheckOfDriver
from stickslip.run.check.far_side import infinite_mass


class _CheckOfRigidDriver(CheckOfDriver):
    sends_back: ClassVar[str] = "of waves at the driver"
    to_let_waves_out: ClassVar[tuple[str, ...]] = (
        "a driver that lets waves out and yet holds the slab (driver_impedance and driver_integral_gain)",
    )

    def at_start(self, problem: Problem) -> Iterator[str]:
        yield from infinite_mass(problem)
        if problem.far_stress is not None or problem.far_stress_rate != 0.0:
            yield "the far stress is not felt, because the driver is rigid all along"

    def healing(self, body: BodyOnCharacteristics) -> list[str]:
        return [
            f"friction heals instantly and the {body.noun} has no {body.mass_field}:"
            " under slow loading it creeps in tiny slips after the first event"
        ]


ANSWERS = _CheckOfRigidDriver()
