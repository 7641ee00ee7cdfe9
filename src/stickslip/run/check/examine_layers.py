"""Find what a user should know about a body of layers before it is run: its layers, its cells, and what rest costs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from stickslip.foundation.constants import RIGID
from stickslip.foundation.names import TURNS, si_unit
from stickslip.foundation.quantities import Choice, NumberSeries, fields_of
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers
from stickslip.problem.bodies.layered.layers import Layers
from stickslip.run.check.facts import Fact

MANY_PIECES = 100_000
"""From this many pieces of rest on (some seconds), a warning says how many there are."""


def of_layers(body: BodyOnCharacteristics) -> OfLayers:
    """Return a body that is not uniform."""
    assert isinstance(body, OfLayers)
    return body


def given_layers(body: BodyOnCharacteristics) -> list[Fact]:
    """Return the lists and the words that a body of layers was given; its numbers are given as those of other bodies are."""
    facts = list[Fact]()
    for name, (declared, _) in fields_of(type(body)).items():
        value = getattr(body, name)
        if isinstance(declared, NumberSeries) and value:
            numbers = ", ".join(f"{one:.6g}" for one in value)
            facts.append(Fact(name, f"{numbers} {declared.item.unit}", "", declared.item.meaning))
        elif isinstance(declared, Choice):
            facts.append(Fact(name, value, "", declared.meaning))
    return facts


def layer_facts(body: OfLayers, load_rate: float, changes: bool = False) -> list[Fact]:
    """Return what follows from the numbers of a body of layers; `load_rate` is the rate of loading at first (Pa/s).

    `changes` says that the first driver changes.
    """
    cells, together = body.cells, "side by side" if body.is_joined else "in series"
    sides = ", that of both sides" if len(body.stacks) > 1 else ""
    unit = {name: si_unit(name, body.load_unit) for name in ("impedance", "stiffness", "load_rate")}
    symbol, slip = ("GJ", "radian") if body.load_unit == TURNS else ("G", "metre")
    found = [Fact("Z", body.impedance, unit["impedance"], f"impedance at the contact{sides}")]
    for side, one in zip(_names(body), body.stacks, strict=True):
        found += _of_side(side, one, body, unit["impedance"], " at first" if changes and not side else "")
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
            f"load lost per {slip} of slow slip: the {body.part}s in series{sides and ', both sides '}{sides and together}",
        ),
        Fact(f"{symbol} V/h", load_rate, unit["load_rate"], "rate of loading at first"),
    ]


def _names(body: OfLayers) -> Sequence[str]:
    return ("",) if len(body.stacks) == 1 else ("", "other ")


def _counts(counts: Sequence[int]) -> str:
    return " + ".join(str(one) for one in counts)


def _of_side(side: str, one: Layers, body: OfLayers, unit: str, first: str) -> Iterator[Fact]:
    for i, (impedance, count) in enumerate(zip(one.impedances, one.counts, strict=True), 1):
        name, two_way = f"{side}{body.part} {i}", f"two-way time {2.0 * count * one.time:.6g} s"
        yield Fact(f"Z of {name}", impedance, unit, f"impedance {body.impedance_formula}; {two_way}")
    for i, share in enumerate(one.interface_reflections, 1):
        meet = f"where {body.part} {i} meets {body.part} {i + 1}"
        yield Fact(
            f"r of {side}{i}, {i + 1}", -share, "1", f"reflection of waves from the contact {meet}: below 0 where it is stiffer"
        )
    of, share = ("sharp fronts" if body.has_machine else "waves"), (RIGID if one.driver_inertia > 0.0 else one.reflection)
    yield Fact(f"{side}r", share, "1", f"reflection of {of} at the driver{first}: -1 rigid, 0 matched, +1 dead load")


def rest_warning(body: OfLayers, duration: float, sticks: bool) -> list[str]:
    """Return a warning about the cost of rest if waves never fade, for a law that sticks and a duration (s)."""
    trips, heavy = duration / body.round_trip_time, any(one.driver_inertia > 0.0 for one in body.stacks)
    if not (sticks and trips > MANY_PIECES and (heavy or (body.is_driven_rigidly and not body.has_drag))):
        return []
    why = (
        "a driver with a mass sends sharp waves back whole" if heavy else f"waves between {body.part}s and rigid drivers never fade"
    )
    cure = "set driver_inertia to 0" if heavy else "give drag, or a driver of finite impedance"
    return [
        f"{why}, so rest is followed through every round trip of two cells: at least {trips:.2g} pieces, each of"
        f" {sum(body.cells.counts)} cells; under long loading {cure}"
    ]


def to_driver(body: OfLayers) -> float:
    """Return the time (s) that a wave takes between the contact and the (first) driver."""
    return sum(body.stacks[0].counts) * body.stacks[0].time


def smallest_modulus(body: OfLayers) -> float:
    """Return the smallest shear modulus rho c^2 (Pa) of the layers."""
    return min(rho * c * c for one in body.stacks for rho, c in zip(one.density, one.wave_speed, strict=True))


def first_echo(body: OfLayers) -> float:
    """Return when the first wave that slip has sent out comes back to the contact (s): from a driver, or where layers differ."""
    return min(_first_echo(one) for one in body.stacks)


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
