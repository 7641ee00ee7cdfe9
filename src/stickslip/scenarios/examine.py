"""What a user should know about a scenario before trusting a run: its numbers, its start, its stability, its uniqueness."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, fields

import numpy as np

from stickslip.bodies import ElasticSlab, SpringBlock
from stickslip.contact.along_slip import regimes_along_slip
from stickslip.contact.critical import critical_normal_stress
from stickslip.contact.loop import first_rate
from stickslip.contact.uniqueness import Uniqueness, uniqueness
from stickslip.friction import FrictionLaw, SinusoidalSlip
from stickslip.friction.fields import Choice, NamedNumbers, Part, Series, Text, fields_of
from stickslip.parameters import parameter
from stickslip.problem import Problem
from stickslip.quantities import Quantity
from stickslip.reference.growth_rate import growth_rate
from stickslip.reference.pulse_period import PulseTrain
from stickslip.scenarios.entries import key_of
from stickslip.scenarios.scenario import Scenario
from stickslip.scenarios.schema import quantities_in

LARGE_STRAIN = 0.01
"""Shear strain beyond which linear elasticity is doubtful."""


@dataclass(frozen=True)
class Fact:
    """A number with its unit, or a word, and what it is."""

    name: str
    value: float | str
    unit: str
    meaning: str


@dataclass(frozen=True)
class Examination:
    """What `examine` found: numbers as given, numbers that follow, sentences, warnings."""

    given: dict[str, list[Fact]]
    derived: list[Fact]
    start: str
    stability: str
    uniqueness: Uniqueness
    critical: list[Fact]
    """Numbers at which the regime changes, one at a time, all else kept."""
    along_slip: str
    warnings: list[str]


def examine(scenario: Scenario) -> Examination:
    """Examine a scenario without running it. Raises InputError like `contact.uniqueness`."""
    problem = scenario.problem
    contact = uniqueness(problem)
    return Examination(
        given=_given(scenario),
        derived=_derived(problem),
        start=_start(problem),
        stability=_stability(problem),
        uniqueness=contact,
        critical=_critical(problem, contact),
        along_slip=_along_slip(problem, contact),
        warnings=_warnings(scenario, contact),
    )


def _given(scenario: Scenario) -> dict[str, list[Fact]]:
    problem = scenario.problem
    body = type(problem.body)
    initial = {f.name.removeprefix("initial_"): getattr(problem, f.name) for f in fields(problem) if f.name.startswith("initial_")}
    holders = {
        "body": (body, vars(problem.body)),
        "loading": (body, vars(problem)),
        "initial": (body, initial),
        "run": (body, {"duration": scenario.duration, "rtol": scenario.rtol}),
    }
    facts = {
        table: [
            Fact(name, values[name], declared.unit, declared.meaning)
            for name, (declared, _) in quantities_in(table, kind, problem.friction.state).items()
            if values[name] is not None
        ]
        for table, (kind, values) in holders.items()
    }
    return {"body": facts.pop("body"), "friction": _of_law(problem.friction)} | facts


def _of_law(law: FrictionLaw, prefix: str = "") -> list[Fact]:
    """Everything that a law was given; of a series of points how many there are, and between which ends."""
    facts: list[Fact] = []
    for name, (declared, _) in fields_of(type(law)).items():
        value, place = getattr(law, name), f"{prefix}{key_of(name, declared)}"
        if isinstance(declared, Quantity) and value is not None:
            facts.append(Fact(place, value, declared.unit, declared.meaning))
        elif isinstance(declared, Series) and value:
            unit = "" if declared.item.unit == "1" else f" {declared.item.unit}"
            facts.append(Fact(place, f"{len(value)} points", "", f"{declared.meaning}, from {value[0]:g} to {value[-1]:g}{unit}"))
        elif isinstance(declared, NamedNumbers):
            facts += [Fact(f"{place}.{one.name}", one.value, one.unit or "1", "") for one in value]
        elif isinstance(declared, Part):
            facts += [Fact(place, value.kind, "", declared.meaning), *_of_law(value, f"{place}.")]
        elif isinstance(declared, Text | Choice):
            facts.append(Fact(place, value, "", declared.meaning))
    return facts


def _derived(problem: Problem) -> list[Fact]:
    body, unit = problem.body, problem.load_unit
    start = [
        Fact("strength", problem.strength, unit, "static strength S mu at the start"),
        Fact("load", problem.load, unit, "shear load on the contact at the start"),
        Fact("excess", problem.excess, unit, "load minus static strength"),
    ]
    if isinstance(body, SpringBlock):
        return [
            Fact("period", body.period, "s", "period 2 pi sqrt(m/K) of free oscillation"),
            Fact("sqrt(K m)", math.sqrt(body.stiffness) * math.sqrt(body.mass), "N s/m", "what a slip rate costs: plays Z's part"),
            Fact("K V", body.stiffness * problem.pull_rate, "N/s", "rate of loading while stuck"),
            *start,
        ]
    return [
        Fact("Z", body.impedance, "Pa s/m", "impedance rho c"),
        Fact("G", body.shear_modulus, "Pa", "shear modulus rho c^2"),
        Fact("R", body.two_way_time, "s", "two-way travel time 2 h/c"),
        Fact("G/h", body.stiffness, "Pa/m", "load lost per metre of slow slip"),
        Fact("r", body.reflection, "1", "reflection at the driver: -1 rigid, 0 matched, +1 dead load"),
        Fact("G V/h", body.stiffness * problem.pull_rate, "Pa/s", "rate of loading at first"),
        *start,
        *_pulses(problem),
    ]


def _pulses(problem: Problem) -> list[Fact]:
    """The period of pulses of a slab whose friction oscillates along slip: 2 pi Z / (omega sqrt((load - mu0 S)^2 - (a S)^2))."""
    law, body = problem.friction, problem.body
    if not isinstance(law, SinusoidalSlip) or not isinstance(body, ElasticSlab):
        return []
    beyond, swing = problem.load - law.mean * problem.normal, abs(law.amplitude) * problem.normal
    if not (beyond > swing and law.wavenumber):
        return []
    train = PulseTrain(body.impedance, problem.load, problem.normal, law.mean, abs(law.amplitude), abs(law.wavenumber))
    return [Fact("pulse period", train.period, "s", "time between pulses under the load of the start, until the first echo")]


def loading_rate(problem: Problem) -> float:
    """How fast the load of a stuck contact grows (Pa/s or N/s): exact for a block, the mean over round trips for a slab."""
    body = problem.body
    if isinstance(body, ElasticSlab) and not math.isinf(body.driver_impedance):
        return problem.far_stress_rate
    return body.stiffness * problem.pull_rate


def _start(problem: Problem) -> str:
    excess, unit, pulled = problem.excess, problem.load_unit, problem.pull_rate > 0
    rate = first_rate(problem)
    jump = f"; the slip rate jumps to {rate:.9g} m/s" if rate > 0.0 else ""
    if problem.load < -problem.strength:
        return f"slips backwards at once: the load is {-problem.load - problem.strength:.6g} {unit} beyond the static strength"
    if excess > 0:
        return f"slips at once: the load exceeds the static strength by {excess:.6g} {unit}{jump}"
    if excess == 0 and pulled:
        return f"slips at 0+: the load is the static strength and grows{jump}"
    if rate > 0.0:
        return f"slips at once, because the rule '{problem.rule}' leaves stick below the static strength{jump}"
    if excess == 0:
        return "stays stuck: the load is the static strength"
    wait = _wait(problem)
    when = f"; loading reaches the strength after about {wait:.6g} s" if math.isfinite(wait) else ""
    return f"stuck: the load is {-excess:.6g} {unit} below the static strength{when}"


def _wait(problem: Problem) -> float:
    """Time (s) in which steady loading makes up for what the load lacks: an estimate for a slab."""
    rate = loading_rate(problem)
    return max(-problem.excess, 0.0) / rate if rate > 0 else math.inf


def slopes(law: FrictionLaw, slip: float, rate: float = 0.0) -> tuple[float, float]:
    """Derivatives of mu with respect to slip (1/m) and slip rate (s/m) at a law slip (m) and a rate (m/s; 0 means 0+).

    By a complex step, which loses no digits: a law's formula is analytic.
    """
    piece = int(law.piece_at(slip, rate))
    step = 1e-100
    by_slip = np.imag(law.piece_coefficient(piece, np.complex128(complex(slip, step)), np.complex128(rate)))
    by_rate = np.imag(law.piece_coefficient(piece, np.complex128(slip), np.complex128(complex(rate, step))))
    return float(by_slip) / step, float(by_rate) / step


def _stability(problem: Problem) -> str:
    """Static stability at the start and how fast a small disturbance grows."""
    body = problem.body
    by_slip, by_rate = slopes(problem.friction, problem.law_slip)
    if isinstance(body, SpringBlock):
        return _block_stability(body, by_slip, by_rate)
    number = -problem.normal * by_slip / body.stiffness
    if by_slip >= 0:
        return "friction does not weaken with slip at the start; what slip rate does to it: see uniqueness"
    if not math.isinf(body.driver_impedance):
        return f"friction weakens with slip: alpha_w h = {number:.6g} (a rigid driver holds it below 1, this one is not rigid)"
    if number < 1:
        return f"statically stable: alpha_w h = {number:.6g} < 1, friction weakens more slowly than the slab unloads: it creeps"
    rate = growth_rate(body.wave_speed, body.thickness, body.shear_modulus, problem.normal, -by_slip)
    return f"statically unstable: alpha_w h = {number:.6g} > 1; a small disturbance grows at {rate:.6g} /s"


def _block_stability(body: SpringBlock, by_slip: float, by_rate: float) -> str:
    spring, dash = body.stiffness + body.normal_force * by_slip, body.damping + body.normal_force * by_rate
    fastest = max((-dash + sign * cmath.sqrt(dash * dash - 4 * body.mass * spring) for sign in (1, -1)), key=lambda root: root.real)
    growth = fastest / (2 * body.mass)
    values = f"K + S mu'(u) = {spring:.6g} N/m, damping + S mu'(v) = {dash:.6g} N s/m"
    if spring < 0 or (growth.real > 0 and growth.imag == 0):
        return f"unstable: {values}; a small disturbance grows at {growth.real:.6g} /s"
    if growth.real > 0:
        return f"swings with growing amplitude and does not run away: {values}; growth {growth.real:.6g} /s"
    return f"statically stable: {values}"


def _critical(problem: Problem, contact: Uniqueness) -> list[Fact]:
    """The law's own critical value where it has one, and that of the normal stress."""
    if contact.resistance is None:
        return []
    stress = critical_normal_stress(contact.resistance)
    named = dict.fromkeys([(contact.critical_parameter, contact.critical_value), ("normal_stress", stress)])
    found = [(parameter(problem, name), value) for name, value in named if name is not None and value is not None]
    side = {True: "above", False: "below", None: "at"}
    return [
        Fact(one.name, value, one.unit, f"here {side[one.value > value if one.value != value else None]} it, at {one.value:.9g}")
        for one, value in found
    ]


def _along_slip(problem: Problem, contact: Uniqueness) -> str:
    """For a law of slip and slip rate, where the regime changes as it slips; "" for others."""
    law = problem.friction
    if contact.resistance is None or not (law.depends_on_slip and law.depends_on_rate):
        return ""
    stretches = regimes_along_slip(problem)
    texts = [f"{one.regime} from {one.slip_from:.6g} to {one.slip_to:.6g} m" for one in stretches]
    return f"{', '.join(texts)} of slip: the folds move as it slips"


def _warnings(scenario: Scenario, contact: Uniqueness) -> list[str]:
    problem, found = scenario.problem, []
    steady = isinstance(problem.body, SpringBlock) or math.isinf(problem.body.driver_impedance)
    if steady and -problem.strength <= problem.load and problem.excess <= 0 and _wait(problem) > scenario.duration:
        found.append("the run ends before loading reaches the static strength: nothing will slip")
    if isinstance(problem.body, ElasticSlab):
        found += _slab_warnings(scenario, problem.body, contact)
    rule = problem.rule
    moving = problem.friction.depends_on_slip and problem.friction.depends_on_rate
    if contact.regime == "regular" and rule != "perfect-delay" and not (moving and contact.resistance):
        found.append(f"the selection rule {rule} has no effect: the slip rate is unique")
    return found


def _slab_warnings(scenario: Scenario, body: ElasticSlab, contact: Uniqueness) -> list[str]:
    found, problem = [], scenario.problem
    strain = abs(problem.load) / body.shear_modulus
    if strain > LARGE_STRAIN:
        found.append(f"the shear strain at the start is {strain:.3g}: linear elasticity is doubtful beyond {LARGE_STRAIN:g}")
    if problem.friction.memory == "since-arrest" and body.contact_mass == 0.0 and body.reflection == -1.0:
        found.append("healing at once on a slab without contact_mass: slowly pulled, it creeps by tiny slips after the first event")
    if scenario.duration < body.two_way_time:
        found.append(f"the run ends before the first echo returns at R = {body.two_way_time:.6g} s")
    if contact.plateaus:
        found.append("a continuum of slip rates solves the contact equation at one load: no rule picks one of them")
    if contact.window is not None:
        if 0.0 < contact.window[1] - contact.window[0] < 1e-9 * problem.strength:
            found.append(
                "the window of several slip rates is narrower than 1e-9 of the strength: small changes of the numbers matter"
            )
        found += _chaos(body, contact)
    return found


def _chaos(body: ElasticSlab, contact: Uniqueness) -> list[str]:
    """An echo multiplies a disturbance of a slipping branch by |r (1 - 2 Z/g'(v))|."""
    if contact.resistance is None:
        return []
    rates = [jump.rate_after for jump in contact.jumps if jump.rate_after > 0]
    gains = [abs(body.reflection * (1.0 - 2.0 * body.impedance / float(contact.resistance.slope(rate)))) for rate in rates]
    if max(gains, default=0.0) <= 1.0:
        return []
    growth = f"each echo multiplies a disturbance by up to {max(gains):.3g} at the rates that the rule jumps to"
    return [f"{growth}: long catalogues are chaotic beyond a horizon"]
