"""The table [motion] of scenario files: the motion of a contact is given, and its friction is what is sought."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.foundation.arguments import shown
from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import KINDS_OF_BODY
from stickslip.foundation.quantities import Choice, Quantity, quantity
from stickslip.problem import LoadingHistory
from stickslip.problem.scenarios import ScenarioTable, read_part, to_table, without_owner

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.moved import MovedContact
    from stickslip.problem import Problem
    from stickslip.problem.scenarios import Key, Scenario, Source

MOTION = "motion"
"""The name of the table."""
STILL: dict[str, Any] = {"pull_rate": 0.0}
"""The [loading] of a scenario with a [motion]."""
STATE_KEYS = ("initial_state", "initial_second_state")
NO_LOADING = "[motion] gives slip rate and normal load: leave [loading] out"
NO_BODY = "[motion] has normal_load: leave [body] out, whose load is taken where it has none"
NO_START = "[motion] has initial_slip and initial_state: leave [initial] out"
NEVER_STICKS_AT = 1.0
"""A state for the unused start of the unused body, where none is given."""


@dataclass(frozen=True)
class GivenMotion:
    """What a [motion] says: slip rate and normal load, numbers or histories, and where slip and states begin."""

    slip_rate: Any
    normal_load: Any
    load_unit: str = "N"
    """The unit of plain numbers of the normal load."""
    initial_slip: Number = quantity("m", "slip at the start", default=0.0)
    initial_state: Any = None
    initial_second_state: Any = None


class MotionTable(ScenarioTable):
    """The table [motion]: slip rate and normal load in time, in place of [body], [loading] and [initial]."""

    name = MOTION
    what = "given [{}]"
    instead = "leave out [{}], and give [body] and [loading], for a contact that moves by itself"
    run_keys = frozenset({"duration", "rtol"})
    in_place_of = frozenset({"body", "loading", "initial"})
    why_no_others = "has no effect with a [motion], which says how the contact moves"

    @override
    def kind(self) -> type[GivenMotion]:
        return GivenMotion

    @override
    def other_keys(self) -> Mapping[str, Key]:
        from stickslip.problem.scenarios import Key

        return {
            "slip_rate": Key(_read_varying, meaning="slip rate, a number or a history [motion.slip_rate]"),
            "normal_load": Key(_read_varying, meaning="normal load, a number or a history [motion.normal_load]"),
            "load_unit": Key(lambda value, place: value, "N", "unit of plain numbers of the normal load: 'N', 'Pa', 'N m'"),
            **{name: Key(lambda value, place: value, None, "state of the law at the start, or 'steady'") for name in STATE_KEYS},
        }

    @override
    def completed(self, raw: Mapping[str, Any], source: Source) -> Mapping[str, Any]:
        motion = raw[MOTION]
        if not isinstance(motion, dict) or not isinstance(raw.get("friction", {}), dict):
            return raw  # which is refused in its turn
        if "friction" not in raw:
            raise InputError(f"{source.file}: [friction] is missing")
        reasons = {"loading": NO_LOADING, "initial": NO_START} | ({"body": NO_BODY} if "normal_load" in motion else {})
        for name, why in reasons.items():
            if name in raw:
                raise InputError(f"{source.file}: {why}")
        from stickslip.extensions.given_motion.load_of_motion import UNUSED_BODIES, with_load  # only where there is a [motion]

        motion = with_load(motion, raw.get("body"), source)
        unit = motion["load_unit"]
        law = read_part("friction", dict(raw["friction"]), source._replace(load_unit=unit))
        start: dict[str, Any] = {"load": 0.0}
        if not law.sticks and not law.reverses:
            given = (motion.get(name) for name in STATE_KEYS)
            names = ("state", "second_state")[: len(law.states)]
            start |= {name: NEVER_STICKS_AT if one in (None, "steady") else one for name, one in zip(names, given, strict=False)}
        return dict(raw) | {"body": UNUSED_BODIES[unit], "loading": STILL, "initial": start, MOTION: motion}

    @override
    def read(self, entries: Mapping[str, Any], problem: Problem, source: Source) -> GivenMotion:
        found = GivenMotion(**entries)
        try:
            moved = moved_of(found, problem)
        except InputError as error:
            raise InputError(f"{source.file}: [motion] {without_owner(error)}") from None
        if moved.load_unit != found.load_unit:
            raise InputError(f"{source.file}: [motion] normal_load is in {moved.load_unit}, and load_unit is {found.load_unit!r}")
        return found

    @override
    def write(self, value: GivenMotion) -> dict[str, Any]:
        found = super().write(value)
        return {name: to_table(one) if isinstance(one, LoadingHistory) else one for name, one in found.items()}

    @override
    def paths(self, value: GivenMotion, problem: Problem) -> Iterator[tuple[str, Quantity | Choice]]:
        yield from super().paths(value, problem)
        unit = problem.load_unit
        numbers = {"slip_rate": ("rad/s" if unit == "N m" else "m/s", "slip rate"), "normal_load": (unit, "normal load")}
        units = dict(zip(STATE_KEYS, ((one.unit, one.meaning) for one in problem.friction.states), strict=False))
        for name, (of, meaning) in (numbers | units).items():
            given = getattr(value, name)
            if given is not None and not isinstance(given, LoadingHistory):
                yield name, Quantity(of, meaning)

    @override
    def problem(self, value: GivenMotion, scenario: Scenario) -> MovedContact:
        return moved_of(value, scenario.problem)


def moved_of(value: GivenMotion, problem: Problem) -> MovedContact:
    """Return the contact of a [motion] with the law of a problem. Raises InputError."""
    from stickslip.extensions.given_motion.moved import MovedContact, with_unit_of_load

    load = with_unit_of_load(value.normal_load, value.load_unit)
    starts = {name: getattr(value, name) for name in STATE_KEYS}
    return MovedContact(problem.friction, value.slip_rate, load, value.initial_slip, **starts)


def _read_varying(value: Any, place: Any) -> Any:
    """Return a number of [motion], or a history if it is a table. Raises InputError."""
    if isinstance(value, dict):
        own, of = place.inner, "loading.pull_rate" if place.key == "slip_rate" else "loading.normal_load"
        heading = place.key if place.key == "slip_rate" else KINDS_OF_BODY[place.source.load_unit].normal
        try:
            return read_part(of, value, place.source, heading)
        except InputError as error:
            raise InputError(str(error).replace(of, own)) from None
    if not isinstance(value, str | float | int) or isinstance(value, bool):
        raise InputError(f"{place.source.file}: {place} must be a number, or a table [{place.inner}], got {shown(value)}")
    return value
