"""Define a problem: one body, one friction law, the loading and the initial state."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError, replace
from functools import cached_property
from typing import Any, NoReturn, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import own_units
from stickslip.foundation.quantities import quantities_of
from stickslip.foundation.show import Declared, ShownAsTable, brief, brief_repr, fields_in, shown_fields
from stickslip.friction.contract import one_argument
from stickslip.problem.fields import INITIAL_STATES, STEADY, ProblemFields
from stickslip.problem.loading import VARYING, LoadingHistory
from stickslip.problem.parameters import Parameters
from stickslip.problem.selection_rule import PERFECT_DELAY, SELECTION_RULES, name_of
from stickslip.problem.start import Start, start_of

DAY = 86_400.0
"""A day, s: what is called a round trip of a block that never sticks."""


class Problem(ShownAsTable, ProblemFields):
    """Everything that a run needs except its duration and its tolerance.

    Parameters
    ----------
    body
        An `ElasticSlab`, whose loads are stresses (Pa), a `SpringBlock`, whose loads are forces (N), or a body that turns, a
        `TorsionalString` or a `RotatingBlock`, whose loads are torques (N m) and whose slip is an angle: read rad for m below.
    friction
        The friction law of the contact. A Python function of slip `u` (m), of slip rate `v` (m/s) or of both is made a law by
        `stickslip.friction.FromFunction`, and a text such as "0.3 + 0.5/(1 + v)" by `stickslip.friction.FromExpression`. Its
        value at v = 0 is then the static strength, divided by the normal stress.
    pull_rate
        Rate V at which the driver is pulled (m/s), or a loading history of it.
    initial_slip
        Slip u0 at the start (m).
    initial_load
        Shear load on the contact at the start (Pa, N or N m). Give either `initial_load` or `initial_excess`; the default of a body
        without a spring is 0.
    initial_excess
        Initial load minus static strength, stored without rounding. The strength is the strength against forward slip,
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
    normal_load
        Normal stress (Pa) or normal force (N) that varies in time: a loading history that begins with that of the body and stays
        above 0 (see Notes).
    ground_velocity, ground_acceleration
        Velocity (m/s) or acceleration (m/s^2, or texts in "g" or "gal") of the ground under the contact: a loading history. The
        ground is at rest before the start (see Notes).
    one_way
        True forbids backward slip, as of a block on a slope that never slips uphill.
    selection
        The rule that selects one slip rate if several solve the contact equation, or its name (`stickslip.selection`).
    driver_reflection
        Reflection coefficient of the driver of a slab or string that changes: steps from the body's own on (see Notes).
    force
        Force (N) on a rigid body, or torque (N m) on one that turns, that is added to its load: a number, or a loading history. It
        acts from the start of the run on, and may jump; on a belt it points so that it makes the belt run ahead.

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

    At most one of `pull_rate` and `far_stress` may be a loading history (`stickslip.loading`). The initial velocity in a
    slab is linear in x, from the initial rate, or rest, at the contact to the pull rate at 0 s at the driver. With
    initial_rate="steady" it is the same everywhere.

    `normal_load` may vary beside one of them: steps, straight lines or a sinusoid. Friction is S(t) mu(u, v, state), and the
    strength at rest S(t) mu_static; `body.normal_stress` or `body.normal_force` is S(0). Where several slip rates solve the contact
    equation, its folds move with S: perfect delay follows them, and any other rule needs a normal load that changes by steps only.

    Where the ground moves, slip and slip rate are relative to it. A block's spring hangs on the ground, and its load gains -m a(t);
    `initial_load` is the load before the ground moves. The driver and the far stress of a slab do not move with the ground: the
    load of its contact is beta - Z v_ground - m a_ground, in which beta is the wave that arrives and m the contact mass. So it is
    under layers of one side, or of two that are joined; sides that are apart have no ground.

    `driver_reflection` is the share r = (Z - Zd) / (Z + Zd) of a wave that the driver sends back, for its impedance Zd: -1 if it is
    rigid, 0 if it is matched, 1 if the far end is set free. A wave meets the driver of the moment, and its echo is at the contact
    h/c later: r w + Z (1 - r) V + (1 + r) far_stress. Where the driver is rigid at first, `far_stress` must be given: 0 if nothing
    holds the far end that is set free. Behind layers Z is that of the last one; of two drivers, the first one changes.

    See Also
    --------
    stickslip.simulate : run a problem.
    stickslip.load_scenario : read a problem and its duration from a file.

    Examples
    --------
    >>> import stickslip as ss
    >>> body = ss.SpringBlock(mass=1.0, stiffness="1 kN/m", normal_force=10.0)
    >>> law = ss.friction.Coulomb(static=0.6, dynamic=0.5)
    >>> problem = ss.Problem(body, law, pull_rate="1 mm/s", initial_excess=0.0)
    >>> print(f"starts at a load of {problem.load:.3f} {problem.load_unit}; S = {problem.normal} {problem.load_unit}")
    starts at a load of 6.000 N; S = 10.0 N
    """

    def __setattr__(self, name: str, value: Any) -> NoReturn:
        """Refuse what a dataclass refuses: that of the fields lets its subclasses have further attributes."""
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __post_init__(self) -> None:
        super().__post_init__()
        _ = self.rate  # refuses a start without balance
        self._check_rate()

    def _shown(self) -> dict[str, str]:
        """Return the texts of the fields that differ from their defaults, by name; body and friction come first."""
        units = own_units(self.load_unit)
        shown = dict(shown_fields(self, units))
        shown["friction"] = self.law_text
        for name in self._varying:
            shown[name] = brief_repr(getattr(self, name), {VARYING: self.unit_of(name)})
        for name, state in zip(INITIAL_STATES, self.friction.states, strict=False):
            if getattr(self, name) is not None:
                value = getattr(self, name)
                shown[name] = f"'{value if value == STEADY else brief(value, units.get(state.unit, state.unit))}'"
        return shown | ({"selection": f"'{self.rule}'"} if "selection" in shown else {})

    @property
    def law_text(self) -> str:
        """The friction law as the call that makes it, with the units that its numbers have on this contact."""
        law = self.friction
        declared = type(law).__repr__ is Declared.__repr__  # some laws show themselves otherwise
        return brief_repr(law, own_units(self.load_unit)) if declared else repr(law)

    def __repr__(self) -> str:
        shown = self._shown()
        parts = [shown.pop("body"), shown.pop("friction"), ", ".join(f"{name}={text}" for name, text in shown.items())]
        return "\n".join(["Problem(", *(f"    {part}," for part in parts), ")"])

    def _lines(self) -> list[tuple[str, str, str]]:
        shown, declared = self._shown(), quantities_of(Problem)
        rows = []
        for name, part in (("body", self.body), ("friction", self.friction)):
            units = own_units(self.load_unit) if name == "friction" else {}
            rows += [(name, type(part).__name__, ""), *fields_in(part, f"{name}.", units)]
        for name in [name for name in shown if name not in ("body", "friction")]:
            rows.append((name, shown[name].strip("'"), declared[name].meaning if name in declared else ""))
        return rows

    def _check_rate(self) -> None:
        """Raise InputError if the problem has an initial rate that it cannot have."""
        given = self.initial_rate
        if given is not None and self.body.has_stops:
            from stickslip.problem.rare_checks import check_thrown  # here, because few bodies have stops

            check_thrown(self.body, self.rate)
        if given is None or self.body.has_inertia:
            return
        if given == 0.0 and not (self.starts_steadily or self.friction.sticks):
            return  # the start from rest, which it is without a mass: a sweep over the mass may include 0
        if not self.starts_steadily:
            why = "a contact without mass has no slip rate of its own, load and friction determine it"
            raise InputError(
                f"Problem: initial_rate: {why}: give it a mass, leave the rate out, or leave out load and state, so that it"
                " starts in steady sliding"
            )
        if self.has_initial_rate and resistance_slope(self) <= 0.0:
            rate = brief(self.rate, self.unit_of("slip_rate"))
            raise InputError(
                f"Problem: initial_rate: at {rate} friction falls faster with the slip rate than waves carry"
                " away, so that a contact without mass leaves this rate at once: give another rate, or the contact a mass"
            )

    @property
    def loading_texts(self) -> dict[str, str]:
        """Short descriptions of the pull rate and of the rest of the loading, by field name."""
        given = {name: getattr(self, name) for name in quantities_of(Problem) if not name.startswith("initial_")}
        given["far_stress_rate"] = self.far_stress_rate or None
        return {name: self._loading_text(value, self.unit_of(name)) for name, value in given.items() if value is not None}

    @staticmethod
    def _loading_text(value: LoadingHistory | float, unit: str) -> str:
        return f"{value.kind}, {brief(value.first, unit)} at first" if isinstance(value, LoadingHistory) else brief(value, unit)

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
        if self.friction.sticks and not self.body.is_free:
            return self.body.round_trip_time
        varying = [getattr(self, name) for name in self._varying]
        swing = min((2.0 * math.pi / one.tone.frequency for one in varying if one.tone.amplitude != 0.0), default=math.inf)
        if not self.body.is_free:
            return self.body.turn_time(min(DAY, swing))
        from stickslip.problem.free_turn import turn_of_free  # few bodies have no spring

        found: float = turn_of_free(self, self.rate, swing if self.friction.sticks else min(DAY, swing))
        return found

    @property
    def parameters(self) -> Parameters[Self]:
        """The numbers of the problem by name: `problem.parameters["friction.alpha"].value`, in SI."""
        return Parameters(self, self.load, self.excess)

    def facing(self, direction: int) -> Self:
        """Return the problem with the law that slip in a direction sees, forwards or (below 0) backwards, for both directions."""
        law, load = self.friction, None if self.initial_excess is None else self.load
        if not law.backward_from:
            return self
        given: dict[str, Any] = {} if load is None else {"initial_load": load, "initial_excess": None}
        return replace(self, friction=law.ways[1 if direction < 0 else 0], **given)

    @property
    def folds_move(self) -> bool:
        """True if the folds of the contact equation move with slip: no mass, and a law of slip and slip rate without a state."""
        law = self.friction
        return law.depends_on_slip and law.depends_on_rate and not (law.states or self.body.has_inertia)

    @property
    def rules(self) -> tuple[str, ...]:
        """The names of the built-in selection rules that this problem can be run with."""
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
    def contact_states(self) -> tuple[float, ...]:
        """The initial states of `contact_law`: `states`, and those that follow from time alone."""
        if self.normal_load is None:
            return self.states
        tone = self.normal_load.tone
        grows = float(self.normal_load.parts[2, 0]) + tone.amplitude * tone.frequency * math.cos(tone.phase)
        return (*self.states, 0.0, grows / self.normal)

    @property
    def kept_series(self) -> int:
        """The number of series that a run keeps with each piece: those of states, and of the rate of a machine behind layers."""
        return len(self.contact_law.states) + (self.body.has_machine and not self.body.is_uniform)

    @property
    def states(self) -> tuple[float, ...]:
        """The initial states in the form that the formulas use (`FrictionLaw.inner_state`); none for a law without one."""
        if self.has_initial_rate:
            return self._start.states
        return self.friction.inner_states(self.given_states)

    @cached_property
    def excess(self) -> float:
        """The initial load minus the static strength, without rounding if it was given as `initial_excess`.

        An initial load within 4 ulp of the strength, forward or backward, counts as equal to it.
        """
        if self.initial_excess is not None:
            return self.initial_excess
        load = self.load
        rounding = 4 * np.spacing(self.strength)
        for edge in (self.strength, -self.backward_strength):  # strengths against forward and against backward slip
            if abs(load - edge) <= rounding:
                return edge - self.strength
        return load - self.strength

    @property
    def load(self) -> float:
        """The shear load on the contact at t = 0 (Pa, N or N m)."""
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


def resistance_slope(problem: Problem) -> float:
    """Return how damping v + S mu grows with the slip rate at the start (Pa s/m or N s/m)."""
    slopes = problem.friction.slopes(problem.law_slip, abs(problem.rate), one_argument(problem.states))
    return problem.body.total_damping + problem.normal * float(slopes[1])


def written_out(problem: Problem) -> Problem:
    """Return a problem with its initial load and state as numbers, where they followed from steady sliding."""
    if not problem.has_initial_rate or not problem.starts_steadily:
        return problem
    law, rate = problem.friction, problem.initial_rate
    if not problem.body.has_inertia:
        rate = None  # it follows from load and state
    elif law.sticks or isinstance(rate, str):
        rate = problem.rate
    seen = np.ravel(law.outer_state(np.array(one_argument(problem.states)))) if law.states else np.zeros(0)
    states: dict[str, Any] = dict(zip(INITIAL_STATES, seen.tolist(), strict=False))
    return replace(problem, initial_load=problem.load, initial_rate=rate, **states)
