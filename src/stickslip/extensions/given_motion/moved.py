"""A contact whose motion is given: what a user states of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arguments import CheckedArguments, shown
from stickslip.foundation.conversion import Number, WithUnit, has_unit, to_number, unit_among
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import MOST_SAMPLES, NumberSeries, Quantity, quantity
from stickslip.friction import FrictionLaw
from stickslip.problem import LoadingHistory, PiecewiseLinear, Steps

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.along import FrictionAlongMotion

LOADS = "N or Pa or N m"
"""Units of a normal load: of a force, a stress, or the torque of friction if mu is 1."""
MARK = "stickslip_motion_format"
"""The attribute of files of runs along given motions."""
STEADY_START = "steady"
"""The word for the state of steady sliding at the first slip rate."""


@dataclass(frozen=True, eq=False)
class MovedContact(CheckedArguments):
    """A contact whose slip rate and normal load are given in time: friction's states and its traction are what is sought.

    `stickslip.simulate(moved, duration)` solves it. There is no body and no spring: whatever moves the contact is as strong as it
    must be, as a servo-controlled rig, an axis or a robot that follows its path.

    Parameters
    ----------
    friction : FrictionLaw
        Any law: of slip, of slip rate, or with one or two states.
    slip_rate : float, str or LoadingHistory
        The slip rate (m/s, or rad/s of a contact that turns): a number, a text with a unit, or a history of `stickslip.loading`.
        It may be negative, and may pass through 0.
    normal_load : float, str or LoadingHistory
        The normal load: a force (N, also for plain numbers), a stress (Pa), or a torque (N m). It stays above 0.
    initial_slip : float or str, default 0.0
        Slip (m or rad) at the start.
    initial_state, initial_second_state : float, str or "steady", optional
        States of the law at the start, as users see them, in the forward direction. By default those of steady sliding at the first
        slip rate; of bristles at rest, unbent.

    Raises
    ------
    InputError
        If a field cannot be used, or a state at the start is needed and not given.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um")
    >>> steps = ss.loading.Steps([0.0, "20 s"], ["1 um/s", "10 um/s"])
    >>> run = ss.simulate(ss.MovedContact(law, steps, "5 MPa"), "60 s")
    >>> print(run.coefficient([19.0, 20.0, 60.0]).round(6))
    [0.6      0.623026 0.588487]
    """

    friction: FrictionLaw
    slip_rate: Any
    normal_load: Any
    initial_slip: Number = quantity("m", "slip at the start", default=0.0)
    initial_state: Any = None
    initial_second_state: Any = None
    load_unit: str = field(init=False, default="N")
    """The unit of the normal load and of the traction: N, Pa or N m."""

    def __post_init__(self) -> None:
        if not isinstance(self.friction, FrictionLaw):
            raise InputError(f"MovedContact: friction must be a law of ss.friction, got {shown(self.friction)}")
        load, unit = _history(self.normal_load, "normal_load", LOADS, "N")
        turns = unit == "N m"
        rate, _ = _history(self.slip_rate, "slip_rate", "rad/s" if turns else "m/s", "rad/s" if turns else "m/s")
        if self.friction.slips_in and self.friction.slips_in != ("rad" if turns else "m"):
            raise InputError(
                f"MovedContact: friction has numbers in {self.friction.slips_in}, and a normal load in {unit} goes with"
                f" {'rad' if turns else 'm'}"
            )
        if not load.lowest > 0.0 and not _stays_above(load):
            raise InputError(f"MovedContact: normal_load must stay above 0 {unit}, but may fall to {load.lowest:g}")
        slip = to_number(self.initial_slip, "rad" if turns else "m")
        if not np.isfinite(slip):
            raise InputError(f"MovedContact: initial_slip must be a number, got {shown(self.initial_slip)}")
        for name, value in (("slip_rate", rate), ("normal_load", load), ("load_unit", unit), ("initial_slip", slip)):
            object.__setattr__(self, name, value)
        self._set_states()

    def _set_states(self) -> None:
        """Check the states at the start, and fill in those that are not given."""
        names = ("initial_state", "initial_second_state")
        states = self.friction.states
        for name, declared in zip(names, (*states, None, None), strict=False):
            given = getattr(self, name)
            if given is None or given == STEADY_START:
                continue
            if declared is None:
                raise InputError(f"MovedContact: {name}: {type(self.friction).__name__} has {len(states)} states: leave it out")
            object.__setattr__(self, name, _checked_state(given, name, declared))
        missing = [name for name, _ in zip(names, states, strict=False) if getattr(self, name) in (None, STEADY_START)]
        if not missing:
            return
        found = self._steady_states()
        if found is None:
            raise InputError(
                f"MovedContact: {missing[0]} is needed: {type(self.friction).__name__} has no steady state at a first slip rate of"
                f" {self.slip_rate.first:g} {self.rate_unit}"
            )
        for name, value in zip(names, found, strict=False):
            if name in missing:
                object.__setattr__(self, name, float(value))

    def _steady_states(self) -> Any:
        """Return the states of steady sliding at the first slip rate, of bristles at rest 0; None if there are none."""
        law, rate = self.friction, self.slip_rate.first
        if rate == 0.0:
            return [0.0] * len(law.states) if len(law.reverses) == len(law.states) else None
        found = law.steady_state(abs(rate))
        if found is None:
            return None
        values = np.atleast_1d(np.asarray(found, float).reshape(len(law.states), -1)[:, 0]).copy()
        values[list(law.reverses)] *= np.sign(rate)
        return values

    @property
    def turns(self) -> bool:
        """True if slip is an angle, and the traction a torque."""
        return self.load_unit == "N m"

    @property
    def rate_unit(self) -> str:
        """The unit of the slip rate."""
        return "rad/s" if self.turns else "m/s"

    @property
    def given_states(self) -> tuple[float, ...]:
        """The states at the start, as users see them."""
        return tuple((self.initial_state, self.initial_second_state)[: len(self.friction.states)])

    @property
    def run_type(self) -> type[FrictionAlongMotion]:
        """The class of its runs."""
        from stickslip.extensions.given_motion.along import FrictionAlongMotion

        return FrictionAlongMotion

    @staticmethod
    def rate_of(times: ArrayLike, displacements: ArrayLike) -> Steps:
        """Return the slip rate (m/s) between measured displacements (m) at times (s, the first 0), straight from one to the next.

        This takes the displacements as exact: noise of an encoder becomes noise of the slip rate. Raises InputError for times that
        do not ascend from 0, and for numbers that are not finite.
        """
        who = "MovedContact.rate_of"
        time = NumberSeries(Quantity("s", "times"), ascending=True, most=MOST_SAMPLES).check(who, "times", _row(times))
        place = NumberSeries(Quantity("m", "displacements"), most=MOST_SAMPLES).check(who, "displacements", _row(displacements))
        if len(time) != len(place):
            raise InputError(f"{who}: needs as many displacements as times, got {len(place)} and {len(time)}")
        if time[0] != 0.0:
            raise InputError(f"{who}: times must begin with 0, got {time[0]:g}: take the first time off all of them")
        rates, count = np.diff(place) / np.diff(time), max(len(time) - 1, 2)  # steps are two at least
        return Steps(time[:count], np.append(rates, rates[-1])[:count].tolist())


def _row(given: Any) -> Any:
    """Return an array of another library as one of numpy, but for one with a unit."""
    return np.asarray(given) if hasattr(given, "__array__") and not has_unit(given) else given


def _history(given: Any, name: str, units: str, plain: str) -> tuple[LoadingHistory, str]:
    """Return what is given as a history, and its unit among `units`; plain numbers are in `plain`. Raises InputError."""
    if isinstance(given, LoadingHistory):
        if set(given.unit.split(" or ")).isdisjoint(units.split(" or ")):
            raise InputError(f"MovedContact: {name} must be in {units}, got a history in {given.unit}")
        given.check()
        return given, given.unit if given.unit in units.split(" or ") else plain
    try:
        value = to_number(given, units)
    except InputError as error:
        raise InputError(f"MovedContact: {name} must be a number in {units}, or a history of ss.loading, got {error}") from None
    if not np.isfinite(value):
        raise InputError(f"MovedContact: {name} must be finite, got {shown(given)}")
    return PiecewiseLinear((0.0, 1.0), (value, value)), unit_among(given, units) or plain


def with_unit_of_load(given: Any, unit: str) -> Any:
    """Return a normal load in this unit if it says none itself."""
    if isinstance(given, LoadingHistory):
        return given.in_unit(unit) if " or " in given.unit else given
    return f"{given!r} {unit}" if isinstance(given, float | int) else given


def _stays_above(load: LoadingHistory) -> bool:
    """Return True if the last straight part of a normal load falls for ever, which ends with the run, and all before stay above 0.

    The run itself checks the last part up to its end.
    """
    start, value, slope = load.parts
    ends = value[:-1] + slope[:-1] * np.diff(start)
    return bool(slope[-1] < 0.0 and min(value.min(), ends.min(initial=np.inf)) > abs(load.tone.amplitude))


def _checked_state(given: float | str | WithUnit, name: str, declared: Any) -> float:
    """Return a state at the start, as users see it. Raises InputError."""
    try:
        value = to_number(given, declared.unit)
    except InputError as error:
        raise InputError(f"MovedContact: {name} must be a number in {declared.unit} or 'steady', got {error}") from None
    if not np.isfinite(value) or (value < 0.0 and not (declared.signed or declared.reverses)):
        raise InputError(f"MovedContact: {name} must be a number of at least 0 {declared.unit}, got {shown(given)}")
    return value
