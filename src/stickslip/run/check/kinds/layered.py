"""What `check` says of bodies of layers: their layers, their cells, and what rest costs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

from stickslip.contact import growth_on_layers
from stickslip.foundation.constants import DEAD_LOAD, RIGID
from stickslip.foundation.names import TURNS
from stickslip.problem import Problem
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers
from stickslip.problem.bodies.layered.layers import Layers
from stickslip.problem.scenarios import Scenario
from stickslip.run.check.asked import CHECK_DRIVERS, Fact
from stickslip.run.check.with_waves import CheckOfWaves

MANY_PIECES = 100_000
"""From this many pieces of rest on (some seconds), a warning says how many there are."""


class _CheckOfLayered(CheckOfWaves):
    def numbers(self, problem: Problem) -> list[Fact]:
        """Return what follows from the layers and their cells, what each driver sends back, and the rate of loading."""
        body = of_layers(problem.body)
        sides, series = (", that of both sides", f", both sides {body.sides_together.resist}") if len(body.stacks) > 1 else ("", "")
        unit = {name: problem.unit_of(name) for name in ("impedance", "stiffness", "load_rate")}
        symbol, slip = ("GJ", "radian") if body.load_unit == TURNS else ("G", "metre")
        cells, driver = body.cells, CHECK_DRIVERS[problem.driver_kind]
        found = [Fact("Z", body.impedance, unit["impedance"], f"impedance at the contact{sides}"), *self.resisted(problem)]
        back = driver.sends_back, CHECK_DRIVERS[problem.body.driver_kind].sends_back  # it is the first driver that may change
        for side, one, sent in zip(("", "other "), body.stacks, back, strict=False):
            found += _of_side(side, one, body, unit["impedance"], sent)
        return [
            *found,
            Fact("R", body.two_way_time, "s", f"longest two-way travel time to a driver, through all {body.part}s"),
            Fact("cells", float(sum(cells.counts)), "1", f"of equal travel time: {_counts(cells.counts)} of the {body.part}s"),
            Fact("time of a cell", cells.time, "s", "to the contact, a wave brings news every two of them"),
            Fact("error", cells.error, "1", f"largest relative error of a {body.part}'s travel time, rounded to cells"),
            Fact(
                f"{symbol}/h",
                body.stiffness,
                unit["stiffness"],
                f"load lost per {slip} of slow slip: the {body.part}s in series{series}",
            ),
            Fact(f"{symbol} V/h", body.stiffness * problem.first_pull_rate, unit["load_rate"], "rate of loading at first"),
            *driver.facts(problem, f"{body.time_to_driver:.6g} s"),
        ]

    def modulus(self, body: BodyOnCharacteristics) -> float:
        """Return the smallest shear modulus rho c^2 (Pa) of the layers."""
        stacks = of_layers(body).stacks
        return min(rho * c * c for one in stacks for rho, c in zip(one.density, one.wave_speed, strict=True))

    def first_echo(self, body: BodyOnCharacteristics) -> float:
        """Return when the first wave comes back: from a driver, or where layers differ."""
        return min(_first_echo(one) for one in of_layers(body).stacks)

    def mass_on_ground(self, body: BodyOnCharacteristics) -> float | None:
        """Return the mass of layers with free tops."""
        stacks = of_layers(body).stacks
        mass = sum(one.time * sum(one.cell_impedances) for one in stacks)
        return mass + body.inertia if all(one.reflection == DEAD_LOAD for one in stacks) else None

    def growth(self, body: BodyOnCharacteristics, by_slip: float) -> float:
        return growth_on_layers(of_layers(body), -body.normal_load * by_slip)

    def of_rest(self, scenario: Scenario) -> list[str]:
        """Return a warning about the cost of rest if waves never fade, under a law that sticks and a driver that stays."""
        problem, body = scenario.problem, of_layers(scenario.problem.body)
        trips, heavy = scenario.duration / body.round_trip_time, any(one.driver_inertia > 0.0 for one in body.stacks)
        stays = problem.friction.sticks and len(problem.driver_steps) == 1
        last = heavy or (body.is_driven_rigidly and not body.has_drag)
        if not (stays and trips > MANY_PIECES and last):
            return []
        rigid = f"waves between {body.part}s and rigid drivers never fade"
        why = "a driver with a mass sends sharp waves back whole" if heavy else rigid
        cure = "set driver_inertia to 0" if heavy else "give drag, or a driver of finite impedance"
        return [
            f"{why}, so rest is followed through every round trip of two cells: at least {trips:.2g} pieces, each of"
            f" {sum(body.cells.counts)} cells; under long loading {cure}"
        ]


def of_layers(body: BodyOnCharacteristics) -> OfLayers:
    """Return a body whose structure is "layered"."""
    return cast(OfLayers, body)


def _counts(counts: Sequence[int]) -> str:
    return " + ".join(str(one) for one in counts)


def _of_side(side: str, one: Layers, body: OfLayers, unit: str, sent: str) -> Iterator[Fact]:
    for i, (impedance, count) in enumerate(zip(one.impedances, one.counts, strict=True), 1):
        name, two_way = f"{side}{body.part} {i}", f"two-way time {2.0 * count * one.time:.6g} s"
        yield Fact(f"Z of {name}", impedance, unit, f"impedance {body.impedance_formula}; {two_way}")
    for i, share in enumerate(one.interface_reflections, 1):
        meet = f"where {body.part} {i} meets {body.part} {i + 1}"
        yield Fact(
            f"r of {side}{i}, {i + 1}", -share, "1", f"reflection of waves from the contact {meet}: below 0 where it is stiffer"
        )
    share = RIGID if one.driver_inertia > 0.0 else one.reflection
    yield Fact(f"{side}r", share, "1", f"reflection {sent}: -1 rigid, 0 matched, +1 dead load")


def _first_echo(one: Layers) -> float:
    passed = 0
    drags = one.drag or (0.0,) * len(one.counts)
    for count, share, drag in zip(one.counts, (*one.interface_reflections, one.reflection), drags, strict=True):
        if drag > 0.0:
            return 2.0 * (passed + 1) * one.time
        passed += count
        if share != 0.0:
            break
    return 2.0 * passed * one.time


ANSWERS = _CheckOfLayered()
