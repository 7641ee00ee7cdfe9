"""Define a problem: one body, one friction law, the loading and the initial state."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.bodies import BODIES, BodyOnCharacteristics
from stickslip.foundation.arguments import CheckedArguments, check_type, is_number, shown
from stickslip.foundation.conversion import Converted, Number, OptionalNumber, WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, check_fields, quantities_of, quantity
from stickslip.foundation.show import brief, brief_repr, fields_in, html_table, shown_fields
from stickslip.friction import FrictionLaw
from stickslip.friction.custom.from_function import as_law
from stickslip.loading import SILENT, VARYING, LoadingHistory
from stickslip.problem.parameters import Parameters
from stickslip.problem.selection_rule import PERFECT_DELAY, SELECTION_RULES, SelectionRule, checked, name_of
from stickslip.problem.start import INITIAL_STATES, STEADY, Start, check_rate, start_of, starts_steadily

MAY_VARY = ("pull_rate", "far_stress")
"""Fields of a problem that may be a loading history instead of a number."""
DAY = 86_400.0
"""A day, s: what is called a round trip of a block that never sticks."""
A_HISTORY = "; what varies in time is one of stickslip.loading, such as Steps([0.0, 10.0], [1e-6, 1e-5])"
"""Hint for a value that is no number."""
LOAD = "Pa or N"
"""Unit of a load: Pa on a slab, N on a block."""
LONGEST_ROUND_TRIP = 1e6
"""Largest number of periods of a block (1) in what is called its round trip."""


def _required() -> Any:
    """Return a field without a default; type checkers read the annotation `Converted` only where a field has a value."""
    return field()


@dataclass(frozen=True)
class Problem(CheckedArguments):
    """Everything that a run needs except its duration and its tolerance.

    Parameters
    ----------
    body
        An `ElasticSlab`, whose loads are stresses (Pa), or a `SpringBlock`, whose loads are forces (N).
    friction
        The friction law of the contact. A Python function of slip `u` (m), of slip rate `v` (m/s) or of both is made a law by
        `stickslip.friction.FromFunction`, and a text such as "0.3 + 0.5/(1 + v)" by `stickslip.friction.FromExpression`. Its
        value at v = 0 is then the static strength, divided by the normal stress.
    pull_rate
        Rate V at which the driver is pulled (m/s), or a loading history of it.
    initial_slip
        Slip u0 at the start (m).
    initial_load
        Shear load on the contact at the start (Pa or N). Give either `initial_load` or `initial_excess`.
    initial_excess
        Initial load minus static strength (Pa or N), stored without rounding. The strength is the strength against forward slip,
        even if the load is negative. A law that never sticks has no strength to exceed: give its initial load.
    initial_state
        Initial value of the state of a law that has one, in the unit of the law. The default for a law that sticks is 0, the healed
        state; any other law with a state needs the value, unless the contact starts in steady sliding. "steady" is the state of
        steady sliding at the (first) pull rate.
    initial_second_state
        The same for the second state of a law with two states.
    initial_rate
        Slip rate v0 at the start (m/s), or "steady". If neither load nor state is given, the contact starts in steady sliding at
        this rate, and "steady" is the pull rate, or the rate that a driver of finite impedance keeps under the far stress given. A
        contact with inertia may also start out of balance, under a load that is given. The default is rest under a law that
        sticks. A contact with inertia that never sticks starts by default at the rate at which the initial load and friction in
        the initial state balance, and in steady sliding at the pull rate if neither load nor state is given.
    far_stress
        Shear stress (Pa) far beyond a driver of finite impedance, or a loading history of it. The default is the initial load,
        minus Z v0 if the contact starts at an initial rate.
    far_stress_rate
        Rate of change of the far stress (Pa/s).
    selection
        The rule that selects one slip rate if several solve the contact equation, or its name (`stickslip.selection`).

    Raises
    ------
    InputError
        If a value is missing, out of range or not applicable to this body and law; the message is one line that says which.

    Notes
    -----
    An initial load within 4 ulp of the static strength counts as excess 0. With excess 0 the contact stays stuck if the pull rate
    is 0 and slips at t = 0+ if the pull rate is positive. With an initial load above the strength the contact slips at once; the
    left limit at t = 0 is then the initial state at rest.

    A contact with inertia that never sticks, or with an `initial_rate`, starts at a rate of its own (`has_initial_rate`), which is
    `Problem.rate`. Any other starts at rest, and a contact without mass that never sticks then slips at once at the rate that load
    and friction determine.

    At most one of `pull_rate` and `far_stress` may be a loading history (`stickslip.loading`). The initial velocity in a slab is
    linear in x, from the initial rate, or rest, at the contact to the pull rate at 0 s at the driver. With initial_rate="steady" it
    is the same everywhere.
    """

    body: BodyOnCharacteristics
    friction: Converted[FrictionLaw, FrictionLaw | Callable[..., Any] | str] = _required()  # noqa: RUF009 - makes a field
    pull_rate: Converted[float | LoadingHistory, float | str | WithUnit | LoadingHistory] = quantity(
        "m/s", "rate V at which the driver is pulled", default=0.0
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
    selection: str | SelectionRule = "perfect-delay"

    def __post_init__(self) -> None:
        bodies = tuple(BODIES.values())
        if isinstance(self.body, FrictionLaw) and isinstance(self.friction, bodies):
            names = f"{shown(self.body)} as body and {shown(self.friction)} as friction"
            raise InputError(f"Problem: body comes first, then friction: got {names}")
        check_type("Problem: body", self.body, bodies, "an ElasticSlab or a SpringBlock")
        object.__setattr__(self, "friction", as_law("Problem: friction", self.friction))
        self._check_varying()
        steady = ("initial_rate",) if str(self.initial_rate) == STEADY else ()
        check_fields(self, but=(*self._varying, *steady), units={LOAD: self.body.load_unit})
        self._check_slip()
        self._check_load()
        self._check_state()
        _ = self.rate  # refuses a start at which nothing balances
        check_rate(self)
        object.__setattr__(self, "selection", checked(self.selection))
        self._check_far_side()

    def _shown(self) -> dict[str, str]:
        """Return the texts of the fields that differ from their defaults, by name; body and friction come first."""
        shown = dict(shown_fields(self, {LOAD: self.load_unit}))
        for name in self._varying:
            shown[name] = brief_repr(getattr(self, name), {VARYING: quantities_of(Problem)[name].unit})
        for name, state in zip(INITIAL_STATES, self.friction.states, strict=False):
            if getattr(self, name) is not None:
                value = getattr(self, name)
                shown[name] = f"'{value if value == STEADY else brief(value, state.unit)}'"
        return shown | ({"selection": f"'{self.rule}'"} if "selection" in shown else {})

    def __repr__(self) -> str:
        shown = self._shown()
        parts = [shown.pop("body"), shown.pop("friction"), ", ".join(f"{name}={text}" for name, text in shown.items())]
        return "\n".join(["Problem(", *(f"    {part}," for part in parts), ")"])

    def _repr_html_(self) -> str:
        shown, declared = self._shown(), quantities_of(Problem)
        rows = []
        for name, part in (("body", self.body), ("friction", self.friction)):
            rows += [(name, type(part).__name__, ""), *fields_in(part, f"{name}.")]
        for name in [name for name in shown if name not in ("body", "friction")]:
            rows.append((name, shown[name].strip("'"), declared[name].meaning if name in declared else ""))
        return html_table("stickslip Problem", rows)

    def _check_varying(self) -> None:
        for name in MAY_VARY:
            value, declared = getattr(self, name), quantities_of(Problem)[name]
            if isinstance(value, LoadingHistory):
                if value.unit not in (VARYING, declared.unit):
                    raise InputError(f"Problem: {name} must be in {declared.unit}, got a history of values in {value.unit}")
            elif value is not None or name == "pull_rate":
                try:
                    declared.check("Problem", name, value)
                except InputError as error:
                    raise InputError(f"{error}{'' if is_number(value) else A_HISTORY}") from None
        if len(self._varying) > 1:
            raise InputError("Problem: only one of pull_rate and far_stress may vary in time")
        if isinstance(self.far_stress_rate, LoadingHistory):
            raise InputError("Problem: far_stress_rate must be a number in Pa/s: what may vary in time is pull_rate or far_stress")
        for name in self._varying:
            getattr(self, name).check()

    def _check_load(self) -> None:
        steady = self.has_initial_rate and not self.given_states
        if (self.initial_load is None) == (self.initial_excess is None) and not (steady and self.initial_load is None):
            found = "neither" if self.initial_load is None else "both"
            raise InputError(f"Problem: needs either initial_load or initial_excess (load minus static strength), got {found}")

    def _check_slip(self) -> None:
        try:
            self.friction.check_start(self.law_slip)
        except InputError as error:
            raise InputError(f"Problem: friction: {error}") from None

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
        steady = self.has_initial_rate and starts_steadily(self)
        for i, state in enumerate(() if steady else law.states):
            field_name = INITIAL_STATES[i]
            value = getattr(self, field_name)
            if value is None and not healed:
                raise InputError(f"Problem: needs {field_name}, the {state.meaning}, in {state.unit}")
            signed = state.signed or state.reverses
            above = None if law.sticks or signed else 0.0
            declared = Quantity(state.unit, state.meaning, above=above, at_least=None if signed else 0.0)
            if isinstance(value, str) and value == STEADY:
                _ = self._steady_states  # refuses where there is none
                continue
            value = float(np.ravel(law.healed_state)[i]) if value is None else value
            if isinstance(value, tuple | list | np.ndarray) and len(law.states) > 1:
                both = " and ".join(INITIAL_STATES)
                raise InputError(f"Problem: {field_name} must be one number, got {shown(value)}: each state has its own, {both}")
            object.__setattr__(self, field_name, declared.check("Problem", field_name, value))

    def _check_far_side(self) -> None:
        if self.body.is_driven_rigidly and (self.far_stress is not None or self.far_stress_rate != 0.0):
            raise InputError("Problem: far_stress and far_stress_rate need a slab with a finite driver_impedance")

    @property
    def _varying(self) -> tuple[str, ...]:
        return tuple(name for name in MAY_VARY if isinstance(getattr(self, name), LoadingHistory))

    @property
    def varies(self) -> bool:
        """True if the pull rate or the far stress is a loading history; a constant far_stress_rate does not count."""
        return len(self._varying) > 0

    @property
    def first_pull_rate(self) -> float:
        """The pull rate V (m/s) at and before the start, which determines the initial velocity in a slab."""
        return self.pull_rate.first if isinstance(self.pull_rate, LoadingHistory) else self.pull_rate

    @property
    def loading_texts(self) -> dict[str, str]:
        """Short descriptions of the pull rate and, if given, of the far stress and its rate of change, by field name."""
        return {
            name: f"{value.kind}, {brief(value.first, unit)} at first" if isinstance(value, LoadingHistory) else brief(value, unit)
            for name, value, unit in (
                ("pull_rate", self.pull_rate, "m/s"),
                ("far_stress", self.far_stress, "Pa"),
                ("far_stress_rate", self.far_stress_rate or None, "Pa/s"),
            )
            if value is not None
        }

    def pull_rate_at(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the pull rate V (m/s) at times (s since the start of the run) of any shape."""
        rate = self.pull_rate
        return rate.at(t) if isinstance(rate, LoadingHistory) else np.full(np.shape(t), rate)

    @property
    def round_trip_time(self) -> float:
        """The length of a round trip of the history, s: the slab's two-way travel time, or the block's period of free oscillation.

        A block that never sticks may creep for years without a rest to leap over, so its round trip lasts a day. It is no longer
        than the period of a tone in its loading, nor than LONGEST_ROUND_TRIP of its own periods, because times in a longer one
        would not resolve them; but it never is shorter than one period of the block.
        """
        period = self.body.round_trip_time
        if self.body.has_waves or self.friction.sticks:
            return period
        tone = self.pull_rate.tone if isinstance(self.pull_rate, LoadingHistory) else SILENT
        swing = 2.0 * math.pi / tone.frequency if tone.amplitude != 0.0 else math.inf
        return max(period, min(DAY, LONGEST_ROUND_TRIP * period, swing))

    @property
    def parameters(self) -> Parameters:
        """The numbers of the problem by name: `problem.parameters["friction.alpha"].value`, in SI."""
        return Parameters(self)

    @property
    def folds_move(self) -> bool:
        """True if the folds of the contact equation move with slip: no mass, and a law of slip and slip rate without a state."""
        law = self.friction
        return law.depends_on_slip and law.depends_on_rate and not law.states and not self.body.has_inertia

    @property
    def rules(self) -> tuple[str, ...]:
        """The names of the built-in selection rules under which the problem can be run."""
        return (PERFECT_DELAY,) if self.folds_move else SELECTION_RULES

    @property
    def why_not_run(self) -> str:
        """Why the problem cannot be run under its selection rule; empty if it can."""
        if not self.folds_move or self.rule == PERFECT_DELAY:
            return ""
        return (
            f"selection {self.rule!a}: under friction of slip and slip rate the folds move with slip, and only {PERFECT_DELAY} is "
            "followed there; under a law of the slip rate alone every rule is"
        )

    @property
    def rule(self) -> str:
        """The name of the selection rule."""
        return name_of(self.selection)

    @property
    def normal(self) -> float:
        """S: the normal stress (Pa) of the slab, or the normal force (N) of the block."""
        return self.body.normal_load

    @property
    def load_unit(self) -> str:
        """The unit of loads and tractions: Pa for the slab, N for the block."""
        return self.body.load_unit

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

    @cached_property
    def _start(self) -> Start:
        return start_of(self)

    @property
    def rate(self) -> float:
        """The slip rate v0 at t = 0 (m/s): 0 unless the contact `has_initial_rate`."""
        return self._start.rate if self.has_initial_rate else 0.0

    @property
    def initial_shear(self) -> float:
        """How much faster a slab moves at its driver than at its contact at t = 0 (m/s): V - v0, and 0 in steady sliding."""
        return 0.0 if isinstance(self.initial_rate, str) else self.first_pull_rate - self.rate

    @property
    def stress(self) -> float:
        """The shear stress in a slab at t = 0 (Pa): the load minus Z v0, which leaves with the waves."""
        return self.load - self.body.damping * self.rate

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

    @property
    def states(self) -> tuple[float, ...]:
        """The initial states in the form that the formulas use (`FrictionLaw.inner_state`); none for a law without one."""
        if self.has_initial_rate:
            return self._start.states
        return self.friction.inner_states(self.given_states)

    @cached_property
    def strength(self) -> float:
        """The static strength S mu_static(u0) at the start (Pa or N).

        It is the reference from which loads are stored as differences. For a law that sticks and has a state it is the strength
        in the healed state 0. For a law that never sticks it is 0.
        """
        return self.normal * float(self.friction.static_coefficient(self.law_slip))

    @cached_property
    def excess(self) -> float:
        """The initial load minus the static strength (Pa or N), without rounding if it was given as `initial_excess`.

        An initial load within 4 ulp of the strength, forward or backward, counts as equal to it.
        """
        if self.initial_excess is not None:
            return self.initial_excess
        load = self.load
        rounding = 4 * np.spacing(self.strength)
        for edge in (self.strength, -self.strength):  # strengths against forward and against backward slip
            if abs(load - edge) <= rounding:
                return edge - self.strength
        return load - self.strength

    @property
    def load(self) -> float:
        """The shear load on the contact at t = 0 (Pa or N)."""
        if self.initial_load is not None:
            return self.initial_load
        return self._start.load if self.initial_excess is None else self.strength + self.initial_excess


def check_problem(who: str, problem: Any, wanted: str = "a Problem") -> None:
    """Raise InputError, beginning with `who`, if an object is not a problem; hint at what was probably meant."""
    if isinstance(problem, Problem):
        return
    hint = ""
    if isinstance(problem, str):
        hint = "; a bundled scenario has one: ss.scenarios[name].problem"
    elif isinstance(getattr(problem, "problem", None), Problem):
        hint = "; take its .problem"
    raise InputError(f"{who}: problem must be {wanted}, got {shown(problem)}{hint}")
