"""Find what a user should know before trusting a run of a scenario: its numbers, its start, its stability, its uniqueness."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
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
from stickslip.foundation.names import own_units
from stickslip.foundation.quantities import Choice, LawField, NamedNumbers, NumberSeries, Quantity, Text, fields_of, in_units
from stickslip.foundation.show import brief, with_unit
from stickslip.friction import FrictionLaw, RateAndState
from stickslip.friction.contract import STATE_NAMES
from stickslip.friction.laws.combined import LawOfParts
from stickslip.friction.piecewise import PiecewiseLaw, noise_in
from stickslip.problem import (
    EXACT_TRIPS,
    MOST_PIECES,
    STEADY,
    VARYING,
    LoadingHistory,
    Problem,
    automatic_length,
    creep_tolerance,
    driver_of,
    leaps_over,
    lumps_by_itself,
    normal_name,
)
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.scenarios import Scenario, doubts, key_of, quantities_in
from stickslip.run.check.asked import CHECK_KINDS, Fact
from stickslip.run.check.ground import facts_of_ground, warnings_of_ground
from stickslip.run.check.stability import stability_of, start_of, wait_of
from stickslip.run.check.starts import chosen_starts

OF_SLIP = ("counts", "memory")
"""Options of a law that say which slip it sees; they mean nothing to a law without slip."""


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

    def numbers(self) -> Iterator[tuple[str, ...]]:
        """Yield name, value and meaning of each number, given or derived, below the name of its table alone."""
        for heading, facts in [*((f"[{name}]", facts) for name, facts in self.given.items()), ("what follows", self.derived)]:
            yield (heading,)
            for one in facts:
                yield one.name, one.value if isinstance(one.value, str) else with_unit(one.value, one.unit), one.meaning

    def findings(self) -> Iterator[tuple[str, str]]:
        """Yield the name and the text of each finding."""
        yield "start", self.start
        yield from (("chosen", line) for line in self.chosen)
        if self.stability:
            yield "stability", self.stability
        yield from (("steady sliding", line) for line in self.steady.lines())
        yield "uniqueness", self.uniqueness.summary
        if self.along_slip:
            yield "along slip", self.along_slip
        for fact in self.critical:
            yield "critical value", f"{fact.name} = {brief(float(fact.value), fact.unit, 9)}; {fact.meaning}"
        yield from self.uniqueness.fold_lines()
        yield from (("warning", warning) for warning in self.warnings)


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
        facts[table] = _lists_and_words(problem.body) if table == "body" else []
        for name, (declared, _) in quantities_in(table, type(problem.body), problem.friction.states).items():
            value = getattr(owner, prefix + name)
            if value == STEADY:
                value = problem.rate if name == "rate" else problem.given_states[STATE_NAMES.index(name)]
            off = owner is scenario and value == 0.0  # an option of a run
            unfelt = owner is problem and name in driver_of(problem).unfelt
            if value is not None and not (off or unfelt):
                facts[table] += _facts(name, value, declared)
    facts["run"] += _automatic(scenario)
    return facts


def _lists_and_words(body: BodyOnCharacteristics) -> list[Fact]:
    """Return the lists and the words that a body was given, such as the numbers of its layers."""
    facts = list[Fact]()
    for name, (declared, _) in fields_of(type(body)).items():
        value = getattr(body, name)
        if isinstance(declared, NumberSeries) and value:
            numbers = ", ".join(f"{one:.6g}" for one in value)
            facts.append(Fact(name, f"{numbers} {declared.item.unit}", "", declared.item.meaning))
        elif isinstance(declared, Choice):
            facts.append(Fact(name, value, "", declared.meaning))
    return facts


def _automatic(scenario: Scenario) -> list[Fact]:
    """Return the automatic creep_rtol and shortest_event (s) of a run, where they apply and are not given."""
    problem, facts = scenario.problem, list[Fact]()
    tolerance = creep_tolerance(problem, None, scenario.rtol)
    if scenario.creep_rtol is None and tolerance > 0.0:
        over = leaps_over(problem)
        turn, of = problem.body.turn, "with slip" if "creep" in over else "of it"
        does = f"leaps over {over} after {EXACT_TRIPS} {turn}s {of}, error of slip at most this times the slip so far"
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
    unit, of_body = problem.load_unit, CHECK_KINDS[problem.body.structure]
    start = [Fact("load", problem.load, unit, "shear load on the contact at the start")]
    if problem.friction.sticks:
        start.insert(0, Fact("strength", problem.strength, unit, "static strength S mu at the start"))
        start.append(Fact("excess", problem.excess, unit, "load minus static strength"))
    if problem.has_initial_rate:
        start.append(Fact("v0", problem.rate, problem.unit_of("slip_rate"), "slip rate at the start"))
    return [*of_body.numbers(problem), *start, *_steady(problem), *of_body.pulses(problem), *facts_of_ground(problem)]


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
    held = rests and -problem.backward_strength <= problem.load and problem.excess <= 0
    if held and steady and not problem.varies and wait_of(problem) > scenario.duration:
        found.append("the run ends before loading reaches the static strength: nothing will slip")
    found += CHECK_KINDS[problem.body.structure].warnings(scenario, contact)
    found += warnings_of_ground(scenario)
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
