"""A problem: one body, one friction law, how they are loaded and where they start."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.bodies import Body, ElasticSlab
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, check_quantities, quantities_of, quantity
from stickslip.friction import FrictionLaw
from stickslip.loading import LoadingHistory
from stickslip.problem.selection_rule import SelectionRule, checked, name_of

MAY_VARY = ("pull_rate", "far_stress")
"""What may be a loading history instead of a number."""


def normal_load(body: Body) -> float:
    """S: normal stress (Pa) of a slab, normal force (N) of a block."""
    return body.normal_stress if isinstance(body, ElasticSlab) else body.normal_force


@dataclass(frozen=True)
class Problem:
    """Everything that a run needs but its duration and its tolerance.

    The slab's loads are stresses (Pa), the block's forces (N). Give either `initial_load` or `initial_excess`; the excess over
    the static strength is kept exactly, and a load within 4 ulp of the strength counts as excess 0. With excess 0 the contact
    stays stuck for pull_rate 0 and slips at 0+ for pull_rate > 0. The excess is measured from the strength against forward slip,
    also where the load is negative. An initial load beyond the strength slips at once; the left
    limit at t = 0 is then the initial state at rest.

    A law that never sticks (rate-and-state) has strength 0: give its initial_load. initial_state is the state of a law that has
    one, in the law's own unit; a law that sticks starts healed (0) by default.

    far_stress (Pa; default: the initial load) and far_stress_rate (Pa/s) load a slab through a driver of finite impedance.
    One of pull_rate and far_stress may vary in time (`stickslip.loading`). A slab begins sheared evenly by the pull rate at 0 s.
    `selection` names the rule that picks one slip rate where several solve the contact equation, or is that rule
    (`stickslip.selection`).
    """

    body: Body
    friction: FrictionLaw
    pull_rate: float | LoadingHistory = quantity("m/s", "rate V at which the driver is pulled", default=0.0)
    initial_slip: float = quantity("m", "slip u0 at the start", default=0.0)
    initial_load: float | None = quantity("Pa or N", "shear load on the contact at the start", default=None)
    initial_excess: float | None = quantity("Pa or N", "initial load minus static strength, kept exactly", default=None)
    initial_state: float | None = field(default=None)  # its unit is the law's business
    far_stress: float | LoadingHistory | None = quantity("Pa", "shear stress far behind a driver of finite impedance", default=None)
    far_stress_rate: float = quantity("Pa/s", "its rate of change", default=0.0)
    selection: str | SelectionRule = "perfect-delay"

    def __post_init__(self) -> None:
        if not isinstance(self.body, Body):
            raise InputError(f"Problem: body must be an ElasticSlab or a SpringBlock, got {type(self.body).__name__}")
        if not isinstance(self.friction, FrictionLaw):
            raise InputError(f"Problem: friction must be a friction law, got {type(self.friction).__name__}")
        self._check_varying()
        check_quantities(self, but=self._varying)
        if (self.initial_load is None) == (self.initial_excess is None):
            found = "neither" if self.initial_load is None else "both"
            raise InputError(f"Problem: needs either initial_load or initial_excess (load minus static strength), got {found}")
        self._check_state()
        object.__setattr__(self, "selection", checked(self.selection))
        self._check_far_side()

    def _check_varying(self) -> None:
        for name in MAY_VARY:
            value, unit = getattr(self, name), quantities_of(Problem)[name].unit
            if not isinstance(value, Real | LoadingHistory) and (name == "pull_rate" or value is not None):
                one = f"a number in {unit} or one of stickslip.loading, such as Steps([0.0, 10.0], [1e-6, 1e-5])"
                raise InputError(f"Problem: {name} must be {one}, got {ascii(value)[:60]}")
        if len(self._varying) > 1:
            raise InputError("Problem: only one of pull_rate and far_stress may vary in time")
        if isinstance(self.far_stress_rate, LoadingHistory):
            raise InputError("Problem: far_stress_rate must be a number in Pa/s: what may vary in time is pull_rate or far_stress")
        for name in self._varying:
            getattr(self, name).check()

    def _check_state(self) -> None:
        law, name = self.friction, type(self.friction).__name__
        if law.state is None:
            if self.initial_state is not None:
                raise InputError(f"Problem: initial_state: {name} has no state variable")
            return
        if not law.sticks and self.initial_excess is not None:
            raise InputError(f"Problem: initial_excess: {name} has no static strength to exceed, give initial_load")
        declared = Quantity(law.state.unit, law.state.meaning, at_least=0.0, above=None if law.sticks else 0.0)
        value = 0.0 if self.initial_state is None and law.sticks else self.initial_state
        if value is None:
            raise InputError(f"Problem: needs initial_state, the {law.state.meaning}, in {law.state.unit}")
        object.__setattr__(self, "initial_state", declared.check("Problem", "initial_state", value))

    def _check_far_side(self) -> None:
        free = isinstance(self.body, ElasticSlab) and not math.isinf(self.body.driver_impedance)
        if not free and (self.far_stress is not None or self.far_stress_rate != 0.0):
            raise InputError("Problem: far_stress and far_stress_rate need a slab with a finite driver_impedance")

    @property
    def _varying(self) -> tuple[str, ...]:
        return tuple(name for name in MAY_VARY if isinstance(getattr(self, name), LoadingHistory))

    @property
    def varies(self) -> bool:
        """Whether the loading varies in time, but for a far stress that grows steadily."""
        return len(self._varying) > 0

    @property
    def first_pull_rate(self) -> float:
        """V (m/s) at the start, and before: by it a slab is sheared then."""
        return self.pull_rate.first if isinstance(self.pull_rate, LoadingHistory) else self.pull_rate

    @property
    def loading_texts(self) -> dict[str, str]:
        """How it is loaded, in a word or two each: pull rate, and far stress and its rate of change where there are such."""
        return {
            name: f"{value.kind}, {value.first:.6g} {unit} at first" if isinstance(value, LoadingHistory) else f"{value:.6g} {unit}"
            for name, value, unit in (
                ("pull_rate", self.pull_rate, "m/s"),
                ("far_stress", self.far_stress, "Pa"),
                ("far_stress_rate", self.far_stress_rate or None, "Pa/s"),
            )
            if value is not None
        }

    def pull_rate_at(self, t: ArrayLike) -> NDArray[np.float64]:
        """V (m/s) at times t (s since the start of the run)."""
        rate = self.pull_rate
        return rate.at(t) if isinstance(rate, LoadingHistory) else np.full(np.shape(t), rate)

    @property
    def rule(self) -> str:
        """Name of the selection rule."""
        return name_of(self.selection)

    @property
    def normal(self) -> float:
        """S: normal stress (Pa) of the slab, normal force (N) of the block."""
        return normal_load(self.body)

    @property
    def load_unit(self) -> str:
        """Unit of loads and tractions: Pa for the slab, N for the block."""
        return "Pa" if isinstance(self.body, ElasticSlab) else "N"

    @property
    def law_slip(self) -> float:
        """The slip (m) that the friction law sees at the start: u0, its magnitude where the law counts the path, 0 where it heals.

        The start is an arrest: a law that remembers slip since the last one knows nothing of u0.
        """
        if self.friction.memory == "since-arrest":
            return 0.0
        return abs(self.initial_slip) if self.friction.counts == "path" else self.initial_slip

    @property
    def state(self) -> float:
        """The state at the start as the law's formulas see it (`FrictionLaw.inner_state`); 0 for a law without one."""
        return 0.0 if self.initial_state is None else self.friction.inner_state(self.initial_state)

    @cached_property
    def strength(self) -> float:
        """Static strength S mu_static(u0) at the start (Pa or N): the reference from which loads are kept as differences.

        That of the state 0 (healed) for a law that sticks and has a state; 0 for a law that never sticks.
        """
        return self.normal * float(self.friction.static_coefficient(self.law_slip))

    @cached_property
    def excess(self) -> float:
        """Initial load minus static strength (Pa or N), exact where it was given as such."""
        if self.initial_excess is not None:
            return self.initial_excess
        assert self.initial_load is not None
        rounding = 4 * np.spacing(self.strength)
        for edge in (self.strength, -self.strength):  # forwards and backwards
            if abs(self.initial_load - edge) <= rounding:
                return edge - self.strength
        return self.initial_load - self.strength

    @property
    def load(self) -> float:
        """Shear load on the contact at t = 0 (Pa or N)."""
        return self.initial_load if self.initial_load is not None else self.strength + self.excess
