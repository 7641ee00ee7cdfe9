"""What `check` says of uniform bodies with waves."""

from __future__ import annotations

from typing import Any

from stickslip.contact import Uniqueness
from stickslip.foundation.constants import DEAD_LOAD
from stickslip.problem import Problem
from stickslip.problem.bodies import BodyOnCharacteristics, as_waves
from stickslip.run.check.asked import CHECK_DRIVERS, Fact
from stickslip.run.check.with_waves import CheckOfWaves
from stickslip.run.reference.slab import growth_rate

BARELY_ABOVE = 1.01
"""A growth of a disturbance below this factor (1) is shown as its excess over 1."""


class _CheckOfUniform(CheckOfWaves):
    def numbers(self, problem: Problem) -> list[Fact]:
        """Return impedance, modulus, travel time and stiffness, what the driver sends back, and the rate of loading."""
        body, driver = as_waves(problem.body), CHECK_DRIVERS[problem.driver_kind]
        impedance, stiffness, load_rate = (problem.unit_of(name) for name in ("impedance", "stiffness", "load_rate"))
        _, symbol, of_modulus, meaning = body.modulus_name
        back = f"reflection {driver.sends_back}: -1 rigid, 0 matched, +1 dead load"
        return [
            Fact("Z", body.impedance, impedance, f"impedance {body.impedance_formula}"),
            *self.resisted(problem),
            Fact(symbol, body.modulus, of_modulus, meaning),
            Fact("R", body.round_trip_time, "s", "two-way travel time 2 h/c"),
            Fact(f"{symbol}/h", body.stiffness, stiffness, "load lost by slow slip"),
            Fact("r", body.front_reflection, "1", back),
            *driver.facts(problem, "h/c"),
            Fact(f"{symbol} V/h", body.stiffness * problem.first_pull_rate, load_rate, "rate of loading at first"),
        ]

    def mass_on_ground(self, body: BodyOnCharacteristics) -> float | None:
        """Return the mass of a body with a free top, and of its contact and its damper."""
        waves: Any = as_waves(body)
        if body.reflection != DEAD_LOAD and not body.is_damped:
            return None
        mass: float = 0.5 * body.impedance * waves.two_way_time + body.inertia
        return mass + float(waves.mass_of_damper) if body.is_damped else mass

    def modulus(self, body: BodyOnCharacteristics) -> float:
        return as_waves(body).modulus

    def first_echo(self, body: BodyOnCharacteristics) -> float:
        return as_waves(body).two_way_time

    def symbol_of_stiffness(self, body: BodyOnCharacteristics) -> str:
        return f" {as_waves(body).modulus_name.symbol}/h"

    def growth(self, body: BodyOnCharacteristics, by_slip: float) -> float:
        return growth_rate(as_waves(body), -by_slip)

    def chaos(self, body: BodyOnCharacteristics, contact: Uniqueness) -> list[str]:
        """Return a warning if echoes amplify disturbances: on a slipping branch each multiplies them by |r (1 - 2 Z/g'(v))|."""
        if contact.resistance is None:
            return []
        back, slope = as_waves(body).front_reflection, contact.resistance.slope
        rates = [jump.rate_after for jump in contact.jumps if jump.rate_after > 0]
        gains = [abs(back * (1.0 - 2.0 * body.impedance / float(slope(rate)))) for rate in rates]
        gain = max(gains, default=0.0)
        if gain <= 1.0:
            return []
        size = f"{gain:.3g}" if gain > BARELY_ABOVE else f"1 + {gain - 1.0:.2g}"
        growth = f"each echo multiplies a disturbance by up to {size} at the rates that the rule jumps to"
        return [f"{growth}: long catalogues are chaotic beyond a horizon"]


ANSWERS = _CheckOfUniform()
