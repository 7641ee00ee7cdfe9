"""What `check` says of all bodies in which waves run; each kind of them adds what it alone knows."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator

from stickslip.contact import Uniqueness
from stickslip.foundation.names import KINDS_OF_BODY
from stickslip.foundation.show import brief
from stickslip.friction import SinusoidalSlip
from stickslip.problem import Problem
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.scenarios import Scenario
from stickslip.run.check.asked import CHECK_DRIVERS, CheckOfKind, Fact
from stickslip.run.reference.rate_and_state import SteadySliding
from stickslip.run.reference.slab import PulseTrain

LARGE_STRAIN = 0.01
"""A larger shear strain (no unit) than this raises a warning: linear elasticity is doubtful."""


class CheckOfWaves(CheckOfKind):
    """The answers of bodies with waves, as far as they are alike."""

    @abstractmethod
    def modulus(self, body: BodyOnCharacteristics) -> float:
        """Return the (smallest) shear modulus (Pa)."""

    @abstractmethod
    def first_echo(self, body: BodyOnCharacteristics) -> float:
        """Return when the first wave that slip has sent out comes back to the contact (s)."""

    def symbol_of_stiffness(self, body: BodyOnCharacteristics) -> str:
        """Return the symbol of the stiffness with a space before it; "" if none is short."""
        return ""

    @abstractmethod
    def growth(self, body: BodyOnCharacteristics, by_slip: float) -> float:
        """Return the growth rate (1/s) of a small disturbance of rest, where friction has a slope along slip (1/m)."""

    def of_rest(self, scenario: Scenario) -> list[str]:
        """Return a warning about what rest costs."""
        return []

    def chaos(self, body: BodyOnCharacteristics, contact: Uniqueness) -> list[str]:
        """Return a warning about disturbances that echoes amplify, where it is known by how much."""
        return []

    def resisted(self, problem: Problem) -> list[Fact]:
        """Return the dashpot that resists slip beside friction and waves, if there is one."""
        body, unit = problem.body, problem.unit_of("impedance")
        return [Fact("D", body.dashpot, unit, "dashpot at the contact, beside friction and Z")] if body.dashpot else []

    def pulses(self, problem: Problem) -> list[Fact]:
        """Return the period of pulses, if the load carries the contact over the maxima of friction along slip.

        The period is 2 pi Z / (omega sqrt((load - mu0 S)^2 - (a S)^2)).
        """
        law, body = problem.friction, problem.body
        if not isinstance(law, SinusoidalSlip):
            return []
        beyond, swing = problem.load - law.mean * problem.normal, abs(law.amplitude) * problem.normal
        if not (beyond > swing and law.wavenumber):
            return []
        train = PulseTrain(body.damping, problem.load, problem.normal, law.mean, abs(law.amplitude), abs(law.wavenumber))
        return [Fact("pulse period", train.period, "s", "time between pulses under the load of the start, until the first echo")]

    def chosen(self, problem: Problem) -> Iterator[str]:
        """Yield how the body moves before the start, what stress is in it, and how its driver begins."""
        yield from _motion(problem)
        first, far = problem.body.first_share, " and the far stress" * (not problem.is_driven_rigidly)
        if first < 1.0:
            shares = f"{first:.6g} to {1.0 - first:.6g}"
            yield f"the two sides share the load{far} in proportion to their stiffness: {shares}"
        held = problem.body.held_at_start(problem.rate, problem.initial_shear)
        if any(held):
            sizes = " and ".join(brief(one, problem.load_unit) for one in held if one)
            yield f"the {KINDS_OF_BODY[problem.load_unit].loads} grows from the contact to the driver by what drag takes, {sizes}"
        yield from CHECK_DRIVERS[problem.driver_kind].at_start(problem)

    def other_start(self, problem: Problem) -> str:
        """Return the start of a contact without mass, if the load is given, the rate is not, and the law never sticks.

        Such a contact takes the slip rate that load and state determine at 0+, and the body moves as if it had rested before.
        """
        loaded = problem.initial_load is not None and problem.initial_rate is None
        if problem.friction.sticks or not loaded:
            return ""
        body = problem.body
        return (
            f"without {body.mass_field} the {body.noun} behind the contact starts from rest, which is another start; "
            "with [initial] rate = 0 a mass starts from there, too"
        )

    def stability(self, problem: Problem, by_slip: float, by_rate: float) -> str:
        """Return whether friction weakens with slip faster than the body unloads."""
        body = problem.body
        number = -problem.normal * by_slip / body.stiffness
        if by_slip >= 0:
            return "friction does not weaken with slip at the start; what slip rate does to it: see uniqueness"
        if not_held := CHECK_DRIVERS[body.driver_kind].not_held:
            return f"friction weakens with slip: alpha_w h = {number:.6g} {not_held}"
        if number < 1:
            slower = f"friction weakens more slowly than the {body.noun} unloads: it creeps"
            return f"statically stable: alpha_w h = {number:.6g} < 1, {slower}"
        rate = self.growth(body, by_slip)
        return f"statically unstable: alpha_w h = {number:.6g} > 1; a small disturbance grows at {rate:.6g} /s"

    def critical_stiffness(self, body: BodyOnCharacteristics, sliding: SteadySliding) -> tuple[str, float] | None:
        """Return the stiffness of a body that is held, beside that of slow sliding; with a mass at the contact none is known."""
        if CHECK_DRIVERS[body.driver_kind].not_held or body.has_inertia:
            return None
        return f"stiffness{self.symbol_of_stiffness(body)}", sliding.critical_stiffness(damping=body.dashpot)

    def warnings(self, scenario: Scenario, contact: Uniqueness) -> list[str]:
        """Return what a user should know of strain, echoes, rest, and of several slip rates at one load."""
        found, problem, body = list[str](), scenario.problem, scenario.problem.body
        # the radius of a string may not be known
        strain = abs(problem.load) / self.modulus(body) if body.load_unit == "Pa" else 0.0
        if strain > LARGE_STRAIN:
            found.append(f"the shear strain at the start is {strain:.3g}: linear elasticity is doubtful beyond {LARGE_STRAIN:g}")
        if problem.friction.memory == "since-arrest" and body.inertia == 0.0:
            found += CHECK_DRIVERS[body.driver_kind].healing(body)
        for change, _ in problem.driver_steps[1:2]:
            felt = change + body.time_to_driver
            if scenario.duration < felt:
                found.append(f"the run ends before the contact feels that the driver changes, at {felt:.6g} s")
        echo = self.first_echo(body)
        if scenario.duration < echo:
            found.append(f"the run ends before the first echo returns at R = {echo:.6g} s")
        found += self.of_rest(scenario)
        if contact.plateaus:
            found.append("a continuum of slip rates solves the contact equation at one load: no rule picks one of them")
        if contact.window is not None:
            if 0.0 < contact.window[1] - contact.window[0] < 1e-9 * problem.strength:
                found.append(
                    "the window of several slip rates is narrower than 1e-9 of the strength: small changes of the numbers matter"
                )
            found += self.chaos(body, contact)
        return found


def _motion(problem: Problem) -> Iterator[str]:
    """Yield how the body moves before the start."""
    body, unit = problem.body, problem.unit_of("slip_rate")
    if problem.initial_shear == 0.0:
        if problem.rate != 0.0:
            yield f"the whole {body.noun} moves at {brief(problem.rate, unit)}, as the contact does"
        return
    rates = body.rates_at_start(problem.rate, problem.initial_shear)
    if len(rates) > 1 and rates[0] != rates[1]:  # sides that are apart: as an observer sees them for whom the other driver rests
        rates[1] = 0.0 - rates[1][0], 0.0 - rates[1][1]
    sides = [f"from {brief(near, unit)} at the contact to {brief(far, unit)} at the driver" for near, far in rates]
    if len(set(sides)) == 1:
        yield f"the {body.noun} is being sheared evenly, {sides[0]}, as if it had been pulled so for long"
    else:
        yield f"both sides are being sheared evenly, {' and '.join(sides)}, as if they had been pulled so for long"
