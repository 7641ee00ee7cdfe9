"""The fields of a problem, their checks, and what follows from them at once: a start in motion is found from these."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.arguments import CheckedArguments, check_type, is_number, shown
from stickslip.foundation.constants import RIGID
from stickslip.foundation.conversion import Converted, Number, OptionalNumber, WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import KINDS_OF_BODY, own_units, si_unit
from stickslip.foundation.quantities import Quantity, check_fields, in_units, quantities_of, quantity
from stickslip.friction import FrictionLaw
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem.bodies import BODIES, BodyOnCharacteristics
from stickslip.problem.loading import VARYING, LoadingHistory, Sinusoidal
from stickslip.problem.selection_rule import SelectionRule, checked

if TYPE_CHECKING:
    from stickslip.problem.ground import Ground

HISTORIES_ONLY = ("normal_load", "ground_velocity", "ground_acceleration", "driver_reflection")
"""Fields of a problem that are a loading history or nothing."""
PULLS = ("pull_rate", "far_stress")
"""Fields of a problem that are a number or a loading history; only one of them may vary."""
MAY_VARY = (*PULLS, "force", *HISTORIES_ONLY)
"""Fields of a problem that may be a loading history."""
A_HISTORY = "; what varies in time is one of stickslip.loading, such as Steps([0.0, 10.0], [1e-6, 1e-5])"
"""Hint for a value that is no number."""
LOAD = si_unit("load")
"""Unit of a load: Pa on a slab, N on a block, N m on what turns."""
CONSTANT = {
    "normal_load": "a constant one is normal_stress or normal_force of the body",
    "driver_reflection": "a constant one follows from driver_impedance of the body",
}
"""Hints for a number where only a history may stand."""
SAME_DRIVER = 1e-6
"""Difference (1) between two reflection coefficients that is rounding by people."""
STEADY = "steady"
"""Initial state, or initial rate, that stands for the one of steady sliding at the pull rate."""
INITIAL_STATES = tuple(f"initial_{name}" for name in STATE_NAMES)
"""Names of the initial states in a `Problem`."""


def _required() -> Any:
    """Return a field without a default; type checkers read the annotation `Converted` only where a field has a value."""
    return field()


def _is_body(given: Any) -> bool:
    """Return True if a value is a body of a kind that is known."""
    kind = getattr(given, "kind", None)
    return isinstance(kind, str) and kind in BODIES and isinstance(given, BODIES[kind])


@dataclass(frozen=True)
class ProblemFields(CheckedArguments):
    """The fields of a `Problem`, which describes them."""

    body: BodyOnCharacteristics
    friction: Converted[FrictionLaw, FrictionLaw | Callable[..., Any] | str] = _required()  # noqa: RUF009 - makes a field
    pull_rate: Converted[float | LoadingHistory, float | str | WithUnit | LoadingHistory] = quantity(
        "m/s", "pull rate V of the driver", default=0.0
    )
    initial_slip: Number = quantity("m", "slip u0 at the start", default=0.0)
    initial_load: OptionalNumber = quantity(LOAD, "shear load on the contact at the start", default=None)
    initial_excess: OptionalNumber = quantity(LOAD, "initial load minus static strength, kept exactly", default=None)
    # not declared as a quantity, because the law determines its unit
    initial_state: OptionalNumber = field(default=None)  # type: ignore[arg-type] # the annotation is that of a converted value
    initial_second_state: OptionalNumber = field(default=None)  # type: ignore[arg-type] # as for the one before
    initial_rate: OptionalNumber = quantity(
        "m/s", 'slip rate v0 at the start, or "steady": that of steady sliding at the pull rate', default=None
    )
    far_stress: Converted[float | LoadingHistory | None, float | str | WithUnit | LoadingHistory | None] = quantity(
        "Pa", "shear stress far beyond a driver of finite impedance", default=None
    )
    far_stress_rate: Number = quantity("Pa/s", "rate of change of the far stress", default=0.0)
    normal_load: Converted[LoadingHistory | None, LoadingHistory | None] = quantity(
        LOAD, "normal load that varies in time and begins with that of the body", default=None
    )
    ground_velocity: Converted[LoadingHistory | None, LoadingHistory | None] = quantity(
        "m/s", "velocity of the ground under the contact, at rest before the start", default=None
    )
    ground_acceleration: Converted[LoadingHistory | None, LoadingHistory | None] = quantity(
        "m/s^2", "acceleration of the ground under the contact, at rest before the start", default=None
    )
    one_way: bool = False
    selection: str | SelectionRule = "perfect-delay"
    driver_reflection: Converted[LoadingHistory | None, LoadingHistory | None] = quantity(
        "1", "reflection of waves at a driver that changes in steps: -1 rigid, 0 matched, 1 set free", default=None
    )
    force: Converted[float | LoadingHistory | None, float | str | WithUnit | LoadingHistory | None] = quantity(
        LOAD, "force on a rigid body, or torque on one that turns, that is added to its load", default=None
    )

    def __post_init__(self) -> None:
        if isinstance(self.body, FrictionLaw) and _is_body(self.friction):
            names = f"{shown(self.body)} as body and {shown(self.friction)} as friction"
            raise InputError(f"Problem: body comes first, then friction: got {names}")
        if not _is_body(self.body):
            bodies = tuple(BODIES.values())
            check_type("Problem: body", self.body, bodies, " or ".join(body.__name__ for body in bodies))
        if not isinstance(self.friction, FrictionLaw):
            from stickslip.friction.custom.from_function import as_law

            object.__setattr__(self, "friction", as_law("Problem: friction", self.friction))
        if isinstance(self.normal_load, LoadingHistory):
            from stickslip.problem.normal_load import begun_with_body

            object.__setattr__(self, "normal_load", begun_with_body(self.normal_load, self.body))
        self._check_varying()
        if self.force is not None or self.body.is_free:
            from stickslip.problem.rare_checks import check_force

            check_force(self)
        steady = ("initial_rate",) if str(self.initial_rate) == STEADY else ()
        check_fields(self, but=(*self._varying, *steady), units=own_units(self.body.load_unit))
        self._check_kind()
        self._check_slip()
        self._check_load()
        self._check_state()
        object.__setattr__(self, "selection", checked(self.selection))
        self._check_far_side()
        self._check_one_way()
        self._check_both_ways()

    def _check_varying(self) -> None:
        for name in MAY_VARY:
            value, declared = getattr(self, name), in_units(quantities_of(type(self))[name], own_units(self.body.load_unit))
            if isinstance(value, LoadingHistory):
                if value.unit != VARYING and declared.unit not in value.unit.split(" or "):
                    unit = "numbers without unit" if declared.unit == "1" else declared.unit
                    raise InputError(f"Problem: {name} must be in {unit}, got a history of values in {value.unit}")
            elif name in HISTORIES_ONLY and value is not None:
                hint = f": {CONSTANT[name]}" if name in CONSTANT else A_HISTORY
                raise InputError(f"Problem: {name} must be a loading history, got {shown(value)}{hint}")
            elif value is not None or name == "pull_rate":
                try:
                    declared.check("Problem", name, value)
                except InputError as error:
                    raise InputError(f"{error}{'' if is_number(value) else A_HISTORY}") from None
        if sum(name in PULLS for name in self._varying) > 1:
            raise InputError("Problem: only one of pull_rate and far_stress may vary in time")
        if self.ground_velocity is not None and self.ground_acceleration is not None:
            raise InputError(
                "Problem: only one of ground_velocity and ground_acceleration may be given: one follows from the other"
            )
        if isinstance(self.far_stress_rate, LoadingHistory):
            unit = self.unit_of("far_stress_rate")
            raise InputError(
                f"Problem: far_stress_rate must be a number in {unit}: what may vary in time is pull_rate or far_stress"
            )
        for name in self._varying:
            getattr(self, name).check()
        self._check_two_drivers()
        if self.normal_load is not None:
            from stickslip.problem.normal_load import check_normal_load

            check_normal_load(self.normal_load, self.body)
        if self.ground is not None and self._given_ground:
            from stickslip.problem.rare_checks import check_ground

            check_ground(self, self.ground, [getattr(self, name) for name in self._varying if name in PULLS])
        if self.driver_reflection is not None:
            from stickslip.problem.rare_checks import check_reflection

            check_reflection(self, self.driver_reflection, SAME_DRIVER)

    def _check_two_drivers(self) -> None:
        """Raise InputError if a loading varies that acts through two drivers, and does not come through both alike."""
        varying = [name for name in self._varying if name in ("pull_rate", "far_stress")]
        if varying and self.body.drivers > 1 and not self.is_driven_rigidly:
            name = type(self.body).__name__
            raise InputError(
                f"Problem: {varying[0]} that varies needs rigid drivers on both sides of a {name}, which do not change: "
                f"leave driver_impedance, other_driver_impedance and driver_reflection out, or give {varying[0]} a number"
            )

    def _check_load(self) -> None:
        steady = self.has_initial_rate and not self.given_states
        if (self.initial_load is None) == (self.initial_excess is None) and not (steady and self.initial_load is None):
            found = "neither" if self.initial_load is None else "both"
            raise InputError(f"Problem: needs either initial_load or initial_excess (load minus static strength), got {found}")

    def _check_kind(self) -> None:
        """Raise InputError if the numbers of the law were given with units of length, and the contact turns, or the other way."""
        kind, law = KINDS_OF_BODY[self.body.load_unit], self.friction
        if law.slips_in not in ("", kind.slip):
            name, units = type(self.body).__name__, f"{kind.slip} and {kind.slip}/s" + " (or deg and rpm)" * (kind.slip == "rad")
            raise InputError(
                f"Problem: friction: {type(law).__name__} has numbers in {law.slips_in} or {law.slips_in}/s, but a contact of "
                f"{name} {kind.moves}: give them in {units}"
            )

    def _check_slip(self) -> None:
        try:
            self.friction.check_start(self.law_slip)
        except InputError as error:
            raise InputError(f"Problem: friction: {error}") from None
        if self.body.has_stops and not self.friction.sticks:
            name = type(self.friction).__name__
            why = f"hard stops need a law that knows rest, which {name} does not: leave them out, or give one such as Coulomb"
            raise InputError(f"Problem: friction: {why}")

    def _check_state(self) -> None:
        law, name = self.friction, type(self.friction).__name__
        for needless in INITIAL_STATES[len(law.states) :]:
            if getattr(self, needless) is not None:
                raise InputError(f"Problem: {needless}: {name} has no {'second ' if law.states else ''}state variable")
        if not law.states:
            return
        if not law.sticks and self.initial_excess is not None:
            raise InputError(f"Problem: initial_excess: {name} has no static strength to exceed, give initial_load")
        healed = law.sticks or (law.reverses and self.initial_load is not None)
        steady = self.has_initial_rate and self.starts_steadily
        for i, state in enumerate(() if steady else law.states):
            field_name, unit = INITIAL_STATES[i], own_units(self.body.load_unit).get(state.unit, state.unit)
            value = getattr(self, field_name)
            if value is None and not healed:
                raise InputError(f"Problem: needs {field_name}, the {state.meaning}, in {unit}")
            signed = state.signed or state.reverses
            above = None if law.sticks or signed else 0.0
            declared = Quantity(unit, state.meaning, above=above, at_least=None if signed else 0.0)
            if isinstance(value, str) and value == STEADY:
                _ = self._steady_states  # refuses where there is none
                continue
            value = float(np.ravel(law.healed_state)[i]) if value is None else value
            if isinstance(value, tuple | list | np.ndarray) and len(law.states) > 1:
                both = " and ".join(INITIAL_STATES)
                raise InputError(f"Problem: {field_name} must be one number, got {shown(value)}: each state has its own, {both}")
            object.__setattr__(self, field_name, declared.check("Problem", field_name, value))

    def _check_far_side(self) -> None:
        at_first = self.body.is_driven_rigidly or (self.driver_changes and self.body.reflection == RIGID)
        if not at_first:
            return
        if self.driver_changes and self.far_stress is None:
            unit = self.unit_of("far_stress")
            raise InputError(
                "Problem: driver_reflection needs a far_stress, because the driver is rigid at first:"
                f" 0 {unit} if nothing holds the far end that is set free"
            )
        if self.driver_reflection is None and (self.far_stress is not None or self.far_stress_rate != 0.0):
            noun = self.body.noun_with_driver
            raise InputError(f"Problem: far_stress and far_stress_rate need a {noun} with a finite driver_impedance")

    def _check_one_way(self) -> None:
        if not isinstance(self.one_way, bool):
            raise InputError(f"Problem: one_way must be True or False, got {shown(self.one_way)}")
        if self.one_way and not self.friction.sticks:
            name = type(self.friction).__name__
            raise InputError(f"Problem: one_way needs a law with a static strength, and {name} never sticks")
        if self.one_way and is_number(self.initial_rate) and self.initial_rate < 0.0:  # type: ignore[operator]
            raise InputError("Problem: initial_rate is backwards, where a contact that slips one way only does not go")

    def _check_both_ways(self) -> None:
        law = self.friction
        if not law.backward_from:
            return
        if self.normal_load is not None:
            raise InputError(f"Problem: normal_load varies, which is not followed under {type(law).__name__}: leave it out")
        if law.depends_on_slip and law.depends_on_rate and not self.body.has_inertia:
            why = "the folds of a contact without mass move with slip, which is followed under one law for both directions only"
            raise InputError(
                f"Problem: friction: {type(law).__name__} depends on slip and slip rate: {why}: give the contact a mass"
            )

    @cached_property
    def _varying(self) -> tuple[str, ...]:
        return tuple(name for name in MAY_VARY if isinstance(getattr(self, name), LoadingHistory))

    @property
    def _felt(self) -> tuple[str, ...]:
        """The names of the histories that act on the body: a far stress behind a driver that stays rigid does not."""
        return tuple(name for name in self._varying if name != "far_stress" or not self.is_driven_rigidly)

    @cached_property
    def varies(self) -> bool:
        """True if the load at rest is no ramp: by a history, a force, a play, moving ground, or a driver that changes or moves."""
        body = self.body
        moves = body.has_machine or body.is_damped or body.has_play or self.force is not None
        return moves or self.driver_changes or any(name != "driver_reflection" for name in self._felt)

    @cached_property
    def driver_steps(self) -> tuple[tuple[float, float], ...]:
        """When (s) the driver takes a reflection coefficient, the first time 0, and these coefficients (1).

        Steps to the same coefficient are left out. The body's own is exact, and that of a history may be rounded.
        """
        own = self.body.reflection
        steps = [(0.0, own)]
        for one in () if self.driver_reflection is None else self.driver_reflection.segments:
            share = own if abs(one.value - own) <= SAME_DRIVER else one.value
            if share != steps[-1][1]:
                steps.append((one.start, share))
        return tuple(steps)

    @property
    def driver_changes(self) -> bool:
        """True if the driver of a slab changes in time: it is set free, stops, or takes up another share of the waves."""
        return self.driver_reflection is not None and len(self.driver_steps) > 1

    @cached_property
    def driver_kind(self) -> str:
        """The kind of driver that holds throughout the run, by which `stickslip.problem.drivers` answers."""
        return "changing" if self.driver_changes else self.body.driver_kind

    @property
    def is_driven_rigidly(self) -> bool:
        """True if the driver is rigid throughout the run."""
        return self.body.is_driven_rigidly and not self.driver_changes

    @property
    def far_stress_varies(self) -> bool:
        """True if the far stress changes in time, and a driver that gives way feels it."""
        changes = isinstance(self.far_stress, LoadingHistory) or self.far_stress_rate != 0.0
        return changes and not self.body.is_driven_rigidly

    def normal_at(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the normal load S (Pa, N or N m) at times (s since the start of the run) of any shape."""
        return np.full(np.shape(t), self.normal) if self.normal_load is None else self.normal_load.at(t)

    @property
    def normal_varies(self) -> bool:
        """True if the normal load is a loading history."""
        return isinstance(self.normal_load, LoadingHistory)

    @property
    def loading_varies(self) -> bool:
        """True if the pull rate or the far stress is a loading history, or the driver changes."""
        return self.driver_changes or any(name in PULLS for name in self._felt)

    @cached_property
    def force_in_time(self) -> LoadingHistory | None:
        """The force on the body (N, or N m) as a history; None if there is none."""
        return Sinusoidal(self.force, amplitude=0.0, period=1.0) if isinstance(self.force, float) else self.force

    @cached_property
    def ground(self) -> Ground | None:
        """The motion of the ground; None if it is at rest."""
        belt: Ground | None = self.body.belt_as_ground(self.pull_rate, self._given_ground)
        if not self._given_ground:
            return belt
        from stickslip.problem.ground import Ground

        return Ground.of(self.ground_velocity, self.ground_acceleration)

    @property
    def _given_ground(self) -> str:
        """The name of the field with a motion of the ground; "" if there is none."""
        return next((name for name in ("ground_velocity", "ground_acceleration") if getattr(self, name) is not None), "")

    @cached_property
    def contact_law(self) -> FrictionLaw:
        """The law that the contact obeys: `friction`, times the growth of the normal load if that varies (`friction.pressed`)."""
        if self.normal_load is None:
            return self.friction
        least, most = self.normal_load.lowest / self.normal, self.normal_load.highest / self.normal
        from stickslip.friction.pressed import Pressed

        return Pressed(self.friction, least, most)

    @property
    def first_pull_rate(self) -> float:
        """The pull rate V (m/s) at and before the start, which determines the initial velocity in a slab."""
        return self.pull_rate.first if isinstance(self.pull_rate, LoadingHistory) else self.pull_rate

    @property
    def normal(self) -> float:
        """S: the normal stress (Pa), force (N) or torque (N m) of the body; at the start if it varies."""
        return self.body.normal_load

    @property
    def load_unit(self) -> str:
        """The unit of loads and tractions: Pa for the slab, N for the block, N m for what turns."""
        return self.body.load_unit

    def unit_of(self, name: str) -> str:
        """Return the SI unit that a field of the problem, or a quantity of `foundation.names.si_unit`, has with this body."""
        declared = quantities_of(ProblemFields).get(name)
        return si_unit(name, self.load_unit) if declared is None else own_units(self.load_unit).get(declared.unit, declared.unit)

    @property
    def law_slip(self) -> float:
        """The slip (m) that the friction law sees at the start.

        It is the initial slip u0, or its magnitude if the law counts the path. It is 0 for a law that remembers slip only since
        the last arrest, because the start counts as an arrest.
        """
        if self.friction.memory == "since-arrest":
            return 0.0
        return abs(self.initial_slip) if self.friction.counts == "path" else self.initial_slip

    @property
    def has_initial_rate(self) -> bool:
        """True if the contact starts at a slip rate of its own: one that is given, or because it has inertia and never sticks."""
        if self.friction.sticks:
            return self.initial_rate is not None and self.initial_rate != 0.0
        return self.body.has_inertia or self.initial_rate is not None

    @property
    def starts_steadily(self) -> bool:
        """True if neither load nor state is given: a contact that starts in motion then starts in steady sliding."""
        return self.initial_load is None and self.initial_excess is None and not self.given_states

    @property
    def begins_in_balance(self) -> bool:
        """True if no load is given: it then is the load of steady sliding."""
        return self.initial_load is None and self.initial_excess is None

    @property
    def given_states(self) -> tuple[float, ...]:
        """The initial states, as users see them; none for a law without a state, or in steady sliding that is not written out."""
        given: list[Any] = [getattr(self, name) for name in INITIAL_STATES]
        return tuple(self._steady_states[i] if value == STEADY else value for i, value in enumerate(given) if value is not None)

    @cached_property
    def _steady_states(self) -> list[float]:
        """The states of steady sliding at the pull rate, as users see them. Raises InputError if there are none."""
        law, rate = self.friction, self.first_pull_rate
        states = law.steady_state(abs(rate)) if rate != 0.0 else None
        if states is None:
            why = f"{type(law).__name__} does not say in which state it slides steadily" if rate else "the pull rate is 0 at first"
            raise InputError(f"Problem: initial_state '{STEADY}': {why}: give a number")
        return [-one if rate < 0.0 and i in law.reverses else one for i, one in enumerate(np.ravel(states).tolist())]

    @cached_property
    def strength(self) -> float:
        """The static strength S mu_static(u0) at the start (Pa, N or N m).

        Loads are stored as differences from it. For a law that sticks and has a state it is the strength
        in the healed state 0. For a law that never sticks it is 0.
        """
        return self.normal * float(self.friction.static_coefficient(self.law_slip))

    @cached_property
    def backward_strength(self) -> float:
        """The static strength against backward slip at the start (Pa, N or N m), where it may differ."""
        law = self.friction
        return self.normal * float(law.ways[1].static_coefficient(self.law_slip)) if law.backward_from else self.strength
