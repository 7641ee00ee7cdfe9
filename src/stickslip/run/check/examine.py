"""Find what a user should know before trusting a run of a scenario: its numbers, its start, its stability, its uniqueness."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from stickslip.contact import (
    SteadySlidings,
    Uniqueness,
    critical_normal_stress,
    folds_not_followed,
    proven_slidings,
    regime_when_pressed,
    regimes_along_slip,
    uniqueness_of,
)
from stickslip.foundation.constants import DEAD_LOAD, RIGID
from stickslip.foundation.names import own_units
from stickslip.foundation.quantities import Choice, LawField, NamedNumbers, NumberSeries, Quantity, Text, fields_of, in_units
from stickslip.foundation.show import brief
from stickslip.friction import FrictionLaw, RateAndState, SinusoidalSlip
from stickslip.friction.contract import STATE_NAMES
from stickslip.friction.laws.combined import LawOfParts
from stickslip.friction.piecewise import PiecewiseLaw, noise_in
from stickslip.problem import (
    MOST_PIECES,
    PATIENCE,
    STEADY,
    VARYING,
    LoadingHistory,
    Problem,
    automatic_length,
    creep_tolerance,
    leaps_over,
    lumps_by_itself,
    normal_name,
)
from stickslip.problem.bodies import BodyOnCharacteristics, BodyWithWaves, as_waves
from stickslip.problem.bodies.soft_torque import sent_back, tuned_period
from stickslip.problem.scenarios import Scenario, doubts, key_of, quantities_in
from stickslip.run.check.examine_layers import (
    first_echo,
    given_layers,
    layer_facts,
    of_layers,
    rest_warning,
    smallest_modulus,
    to_driver,
)
from stickslip.run.check.facts import Fact
from stickslip.run.check.stability import stability_of, start_of, wait_of
from stickslip.run.check.starts import chosen_starts
from stickslip.run.reference.slab import PulseTrain

OF_SLIP = ("counts", "memory")
"""Options of a law that say which slip it sees; they mean nothing to a law without slip."""
BARELY_ABOVE = 1.01
"""A growth of a disturbance below this factor (1) is shown as its excess over 1."""
MOST_DRIVERS = 8
"""Largest number of changes of a driver that are shown one by one (1)."""
LARGE_STRAIN = 0.01
"""A larger shear strain (no unit) than this raises a warning: linear elasticity is doubtful."""


@dataclass(frozen=True)
class Examination:
    """The findings of `examine`: given numbers (by table of the scenario), derived numbers, sentences for users, and warnings."""

    given: dict[str, list[Fact]]
    derived: list[Fact]
    start: str
    chosen: list[str]
    """What is chosen of the start where nothing is given."""
    stability: str
    """Static stability; "" where there is none to speak of."""
    steady: SteadySlidings
    uniqueness: Uniqueness
    critical: list[Fact]
    """Critical values of single parameters: the regime changes there while all others stay as they are."""
    along_slip: str
    warnings: list[str]


def examine(scenario: Scenario) -> Examination:
    """Examine a scenario without running it. Raises InputError as `contact.uniqueness` does."""
    problem = scenario.problem
    contact = uniqueness_of(problem)
    return Examination(
        given=_given(scenario),
        derived=_derived(problem),
        start=start_of(problem),
        chosen=chosen_starts(problem),
        stability=stability_of(problem),
        steady=proven_slidings(problem),
        uniqueness=contact,
        critical=_critical(problem, contact),
        along_slip=_along_slip(problem, contact),
        warnings=warnings_of(scenario, contact),
    )


def _given(scenario: Scenario) -> dict[str, list[Fact]]:
    problem = scenario.problem
    facts = {"body": list[Fact](), "friction": _of_law(problem.friction, units=own_units(problem.load_unit))}
    owners = {"body": (problem.body, ""), "loading": (problem, ""), "initial": (problem, "initial_"), "run": (scenario, "")}
    for table, (owner, prefix) in owners.items():
        facts[table] = [] if table != "body" or problem.body.is_uniform else given_layers(problem.body)
        for name, (declared, _) in quantities_in(table, type(problem.body), problem.friction.states).items():
            value = getattr(owner, prefix + name)
            if value == STEADY:
                value = problem.rate if name == "rate" else problem.given_states[STATE_NAMES.index(name)]
            off = owner is scenario and value == 0.0  # an option of a run
            unfelt = name.startswith("far_stress") and problem.is_driven_rigidly
            if value is not None and not (off or unfelt):
                facts[table] += _facts(name, value, declared)
    facts["run"] += _automatic(scenario)
    return facts


def _automatic(scenario: Scenario) -> list[Fact]:
    """Return the automatic creep_rtol and shortest_event (s) of a run, where they apply and are not given."""
    problem, facts = scenario.problem, list[Fact]()
    tolerance = creep_tolerance(problem, None, scenario.rtol)
    if scenario.creep_rtol is None and tolerance > 0.0:
        over = leaps_over(problem)
        turn, of = "round trip" if problem.body.has_waves else "period", "with slip" if "creep" in over else "of it"
        does = f"leaps over {over} after {PATIENCE} {turn}s {of}, error of slip at most this times the slip so far"
        facts.append(Fact("creep_rtol", tolerance, "1", f"automatic: {does}; 0 runs every {turn}"))
    if scenario.shortest_event is None and lumps_by_itself(problem):
        does = f"events shorter than this are lumped once a round trip has more than {MOST_PIECES} pieces"
        facts.append(Fact("shortest_event", automatic_length(problem.body), "s", f"automatic: {does}; 0 lumps none"))
    return facts


def _facts(name: str, value: Any, declared: Quantity) -> list[Fact]:
    """Return what was given for a quantity: a number, or the kind of a loading history and its fields."""
    if not isinstance(value, LoadingHistory):
        return [Fact(name, value, declared.unit, declared.meaning)]
    return [Fact(name, value.kind, "", declared.meaning), *_of_law(value, f"{name}.", units={VARYING: declared.unit})]


def _of_law(law: FrictionLaw | LoadingHistory, prefix: str = "", *, units: Mapping[str, str]) -> list[Fact]:
    """Return all fields of a law or of a loading history; `units` are as for `in_units`.

    A series of points is summarised by their number and the two ends of its range.
    """
    facts: list[Fact] = []
    for name, (entry, _) in fields_of(type(law)).items():
        declared = in_units(entry, units)
        value, place = getattr(law, name), f"{prefix}{key_of(name, declared)}"
        if name in OF_SLIP and isinstance(law, FrictionLaw) and not law.depends_on_slip:
            continue
        if isinstance(declared, Quantity) and value is not None:
            facts.append(Fact(place, value, declared.unit, declared.meaning))
        elif isinstance(declared, NumberSeries) and value:
            unit = "" if declared.item.unit == "1" else f" {declared.item.unit}"
            ends = min(value), max(value)
            facts.append(Fact(place, f"{len(value)} points", "", f"{declared.meaning}, from {ends[0]:g} to {ends[1]:g}{unit}"))
        elif isinstance(declared, NamedNumbers):
            facts += [Fact(f"{place}.{one.name}", one.value, one.unit or "1", "") for one in value]
        elif isinstance(declared, LawField):
            facts += [Fact(place, value.kind, "", declared.meaning), *_of_law(value, f"{place}.", units=units)]
        elif isinstance(declared, Text | Choice):
            facts.append(Fact(place, value, "", declared.meaning))
    return facts


def _derived(problem: Problem) -> list[Fact]:
    body, unit = problem.body, problem.load_unit
    impedance, stiffness, load_rate = (problem.unit_of(name) for name in ("impedance", "stiffness", "load_rate"))
    start = [Fact("load", problem.load, unit, "shear load on the contact at the start")]
    if problem.friction.sticks:
        start.insert(0, Fact("strength", problem.strength, unit, "static strength S mu at the start"))
        start.append(Fact("excess", problem.excess, unit, "load minus static strength"))
    if problem.has_initial_rate:
        start.append(Fact("v0", problem.rate, problem.unit_of("slip_rate"), "slip rate at the start"))
    start += _steady(problem)
    first = ", at first" if problem.loading_varies else ""
    if not body.has_waves:
        size = math.sqrt(body.stiffness) * math.sqrt(body.inertia)
        return [
            Fact("period", body.round_trip_time, "s", "period 2 pi sqrt(m/K) of free oscillation"),
            Fact("sqrt(K m)", size, impedance, f"impedance of the {body.noun}, in place of Z"),
            Fact("K V", body.stiffness * problem.first_pull_rate, load_rate, f"rate of loading while stuck{first}"),
            *start,
        ]
    if not body.is_uniform:
        layers = layer_facts(of_layers(body), body.stiffness * problem.first_pull_rate, problem.driver_changes)
        return [*layers, *_tuned(problem), *_later_drivers(problem), *start, *_pulses(problem)]
    of = "of sharp fronts" if body.has_machine else "of waves"
    begins = " at first" if problem.driver_changes else ""
    waves = as_waves(body)
    _, symbol, of_modulus, meaning = waves.modulus_name
    return [
        Fact("Z", body.impedance, impedance, f"impedance {waves.impedance_formula}"),
        Fact(symbol, waves.modulus, of_modulus, meaning),
        Fact("R", body.round_trip_time, "s", "two-way travel time 2 h/c"),
        Fact(f"{symbol}/h", body.stiffness, stiffness, "load lost by slow slip"),
        Fact("r", waves.front_reflection, "1", f"reflection {of} at the driver{begins}: -1 rigid, 0 matched, +1 dead load"),
        *_tuned(problem),
        *_later_drivers(problem),
        Fact(f"{symbol} V/h", body.stiffness * problem.first_pull_rate, load_rate, "rate of loading at first"),
        *start,
        *_pulses(problem),
    ]


def _tuned(problem: Problem) -> list[Fact]:
    """Return the period at which mass and integral gain of a driver cancel, and what it sends back of a wave of that period."""
    body = problem.body
    if not body.has_machine or math.isnan(period := tuned_period(body)):
        return []
    whole, half, twice = (f"{sent_back(body, factor * period):.2g}" for factor in (1.0, 0.5, 2.0))
    share = f"the driver sends back {whole} of a wave with this period, {half} with half of it, {twice} with twice"
    return [Fact("T", period, "s", f"period to which the driver is tuned, where its mass and integral gain cancel: {share}")]


def _later_drivers(problem: Problem) -> list[Fact]:
    """Return the reflection at a driver that changes, from each change on, and what the driver then is."""
    facts, unit = [], problem.unit_of("impedance")
    for start, share in problem.driver_steps[1 : MOST_DRIVERS + 1]:
        now = "rigid" if share == RIGID else "set free" if share == DEAD_LOAD else ""
        now = now or f"of impedance {brief(problem.body.last_impedance * (1.0 - share) / (1.0 + share), unit)}"
        later = "h/c" if problem.body.is_uniform else f"{to_driver(of_layers(problem.body)):.6g} s"
        facts.append(Fact(f"r from {start:g} s", share, "1", f"the driver is then {now}, as the contact feels {later} later"))
    return facts


def _steady(problem: Problem) -> list[Fact]:
    """Return friction and states of steady sliding at the pull rate, for a law that knows them."""
    law, rate = problem.friction, problem.first_pull_rate
    steady, states = getattr(law, "steady_coefficient", None), law.steady_state(rate) if rate > 0.0 else None
    if steady is None or states is None:
        return []
    sliding = f"in steady sliding at the {'first pull rate' if problem.loading_varies else 'pull rate'}"
    facts = [Fact("steady friction", problem.normal * float(steady(rate)), problem.load_unit, f"friction {sliding}")]
    for name, state, value in zip(STATE_NAMES, law.states, np.ravel(states), strict=False):
        facts.append(Fact(f"steady {name.replace('_', ' ')}", float(value), state.unit, f"state {state.name} {sliding}"))
    if isinstance(law, RateAndState):
        facts.append(Fact("b - a", law.b - law.a, "1", "steady friction falls with slip rate where this is positive"))
    return facts


def _pulses(problem: Problem) -> list[Fact]:
    """Return the period of pulses of a slab whose friction oscillates along slip, if its load carries it over the maxima.

    The period is 2 pi Z / (omega sqrt((load - mu0 S)^2 - (a S)^2)).
    """
    law, body = problem.friction, problem.body
    if not isinstance(law, SinusoidalSlip) or not body.has_waves:
        return []
    beyond, swing = problem.load - law.mean * problem.normal, abs(law.amplitude) * problem.normal
    if not (beyond > swing and law.wavenumber):
        return []
    train = PulseTrain(body.damping, problem.load, problem.normal, law.mean, abs(law.amplitude), abs(law.wavenumber))
    return [Fact("pulse period", train.period, "s", "time between pulses under the load of the start, until the first echo")]


def _critical(problem: Problem, contact: Uniqueness) -> list[Fact]:
    """Return the critical value of the law's own parameter, if it has one, and of the normal stress."""
    if contact.resistance is None:
        return []
    named = {contact.critical_parameter: contact.critical_value, normal_name(problem): critical_normal_stress(contact.resistance)}
    facts = []
    for name, value in named.items():
        if name is not None and value is not None:
            one = problem.parameters[name]
            side = "at" if one.value == value else "above" if one.value > value else "below"
            proof = _proof(contact, problem.load_unit) if name == normal_name(problem) else ""
            facts.append(Fact(one.name, value, one.unit, f"here {side} it, at {brief(one.value, one.unit, 9)}{proof}"))
    return facts


def _proof(contact: Uniqueness, unit: str) -> str:
    """Return how closely the critical normal stress is proven, as the end of a sentence."""
    between = contact.critical_stress_between
    return "" if between is None else f"; proven to within {between[1] - between[0]:.1g} {unit}"


def _along_slip(problem: Problem, contact: Uniqueness) -> str:
    """Return a sentence on the slip (m) where the regime changes, for a law of slip and slip rate; "" for other laws."""
    law = problem.friction
    if contact.resistance is None or not (law.depends_on_slip and law.depends_on_rate):
        return ""
    intervals = regimes_along_slip(problem)
    unit = problem.unit_of("slip")
    texts = [f"{one.regime} from {one.slip_from:.6g} to {one.slip_to:.6g} {unit}" for one in intervals]
    return f"{', '.join(texts)} of slip: the folds move as it slips"


def warnings_of(scenario: Scenario, contact: Uniqueness) -> list[str]:
    """Return what a user should know before trusting a run of a scenario whose uniqueness is `contact`, one line each."""
    problem = scenario.problem
    found = doubts(problem) + _noise(problem.friction, contact)
    steady = problem.body.is_driven_rigidly
    rests = problem.friction.sticks and not problem.has_initial_rate
    held = rests and -problem.strength <= problem.load and problem.excess <= 0
    if held and steady and not problem.varies and wait_of(problem) > scenario.duration:
        found.append("the run ends before loading reaches the static strength: nothing will slip")
    if problem.body.has_waves:
        found += _slab_warnings(scenario, contact)
    rule = problem.rule
    if why := problem.why_not_run or folds_not_followed(problem):
        found.append(f"it cannot be run: {why}")
    moving = problem.friction.depends_on_slip and problem.friction.depends_on_rate
    moving = moving or (contact.resistance is not None and regime_when_pressed(problem) != "regular")
    if contact.regime == "regular" and rule != "perfect-delay" and not (moving and contact.resistance):
        found.append(f"the selection rule {rule} has no effect: the slip rate is unique")
    return found


def _noise(law: FrictionLaw, contact: Uniqueness) -> list[str]:
    """Return a warning for a law, or a part of one, that joins noisy points exactly."""
    parts = law.parts.values() if isinstance(law, LawOfParts) else (law,)
    noises = [noise_in(*part.points) for part in parts if isinstance(part, PiecewiseLaw)]
    folds = f"they make {len(contact.folds)} folds" if contact.folds else ""
    return [noise.warning(folds) for noise in noises if noise is not None]


def _slab_warnings(scenario: Scenario, contact: Uniqueness) -> list[str]:
    found, problem, body = [], scenario.problem, scenario.problem.body
    modulus, echo = _modulus_and_echo(body)
    strain = abs(problem.load) / modulus if body.load_unit == "Pa" else 0.0  # the radius of a string may not be known
    if strain > LARGE_STRAIN:
        found.append(f"the shear strain at the start is {strain:.3g}: linear elasticity is doubtful beyond {LARGE_STRAIN:g}")
    if problem.friction.memory == "since-arrest" and body.inertia == 0.0 and body.is_driven_rigidly:
        found.append(
            f"friction heals instantly and the {body.noun} has no {body.mass_field}:"
            " under slow loading it creeps in tiny slips after the first event"
        )
    if problem.driver_changes:
        felt = problem.driver_steps[1][0] + (body.inflow_delay if body.is_uniform else to_driver(of_layers(body)))
        if scenario.duration < felt:
            found.append(f"the run ends before the contact feels that the driver changes, at {felt:.6g} s")
    if scenario.duration < echo:
        found.append(f"the run ends before the first echo returns at R = {echo:.6g} s")
    if not body.is_uniform:
        found += rest_warning(of_layers(body), scenario.duration, problem.friction.sticks and not problem.driver_changes)
    if contact.plateaus:
        found.append("a continuum of slip rates solves the contact equation at one load: no rule picks one of them")
    if contact.window is not None:
        if 0.0 < contact.window[1] - contact.window[0] < 1e-9 * problem.strength:
            found.append(
                "the window of several slip rates is narrower than 1e-9 of the strength: small changes of the numbers matter"
            )
        found += _chaos(as_waves(body), contact) if body.is_uniform else []
    return found


def _modulus_and_echo(body: BodyOnCharacteristics) -> tuple[float, float]:
    """Return the (smallest) shear modulus (Pa) of a body with waves, and when the first echo returns (s)."""
    if body.is_uniform:
        return as_waves(body).modulus, as_waves(body).two_way_time
    layers = of_layers(body)
    return smallest_modulus(layers), first_echo(layers)


def _chaos(body: BodyWithWaves, contact: Uniqueness) -> list[str]:
    """Return a warning if echoes amplify disturbances: on a slipping branch each multiplies them by |r (1 - 2 Z/g'(v))|."""
    if contact.resistance is None:
        return []
    rates = [jump.rate_after for jump in contact.jumps if jump.rate_after > 0]
    gains = [abs(body.front_reflection * (1.0 - 2.0 * body.impedance / float(contact.resistance.slope(rate)))) for rate in rates]
    gain = max(gains, default=0.0)
    if gain <= 1.0:
        return []
    size = f"{gain:.3g}" if gain > BARELY_ABOVE else f"1 + {gain - 1.0:.2g}"
    growth = f"each echo multiplies a disturbance by up to {size} at the rates that the rule jumps to"
    return [f"{growth}: long catalogues are chaotic beyond a horizon"]
