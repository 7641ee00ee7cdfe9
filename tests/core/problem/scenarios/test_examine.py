"""What `examine` says about a start, against the numbers of the design and against other ways to get them."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from stickslip import ElasticSlab, Problem, SpringBlock
from stickslip.contact.rules.loop import resolved
from stickslip.friction import LAWS, FromTable, HyperbolicRate, RateAndState, SinusoidalSlip, TwoStateRateAndState
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.scenario import Scenario, load_scenario, read_scenario
from stickslip.problem.scenarios.templates import template
from stickslip.run.check.asked import Fact
from stickslip.run.check.examine import examine
from stickslip.run.reference.rate_and_state import SteadySliding

Floats = NDArray[np.float64]
LAW = SinusoidalSlip(1.0, 0.5, 5.0)
SLAB = ElasticSlab(2800, 3500, 1e4, 1e8)


def growth_in(text: str) -> float:
    return float(text.partition("grows at ")[2].split(" ")[0])


@pytest.mark.sampled(every=15)
@pytest.mark.parametrize("name", library.in_1d())
def test_every_bundled_scenario_can_be_examined(name: str) -> None:
    found = examine(load_scenario(name))
    assert set(found.given) == {"body", "friction", "loading", "initial", "run"}
    assert found.start
    assert found.stability or found.steady.lines()
    assert found.uniqueness.summary


def test_examine_derives_the_numbers_of_the_paper() -> None:
    derived = {fact.name: fact.value for fact in examine(load_scenario("fig6-slab")).derived}
    assert derived["Z"] == 9.8e6
    assert derived["G"] == 3.43e10
    assert derived["R"] == pytest.approx(2e4 / 3500, rel=1e-15, abs=0)
    assert derived["strength"] == derived["load"] == 8e7
    assert derived["excess"] == 0


def test_the_pulse_period_is_the_time_between_the_pulses_of_the_reconstructed_slab() -> None:
    """Peaks at 0.153986, 2.256706 and 4.359426 s; as printed the load does not exceed the largest friction, so none is named."""
    derived = {fact.name: fact.value for fact in examine(load_scenario("fig5-slab-reconstructed")).derived}
    assert derived["pulse period"] == pytest.approx(4.359426 - 2.256706, rel=0, abs=2e-5)
    assert "pulse period" not in {fact.name for fact in examine(load_scenario("fig5-slab-printed")).derived}


@pytest.mark.parametrize(("beyond", "stable"), [(2.744086e-3 - 1e-8, True), (2.744086e-3 + 1e-8, False)])
def test_the_slab_is_stable_up_to_where_weakening_meets_its_stiffness(beyond: float, stable: bool) -> None:
    problem = Problem(SLAB, LAW, initial_slip=math.pi / 10 + beyond, initial_excess=0.0)
    assert examine(Scenario(problem, 10.0)).stability.startswith("statically stable" if stable else "statically unstable")


@pytest.mark.parametrize("beyond", [2.8e-3, 1e-2, 0.1, 0.3])
def test_the_growth_of_the_slab_solves_its_dispersion_relation(beyond: float) -> None:
    """lambda coth(lambda h/c) = c alpha_w, alpha_w = -S mu'/G."""
    slip = math.pi / 10 + beyond
    growth = growth_in(examine(Scenario(Problem(SLAB, LAW, initial_slip=slip, initial_excess=0.0), 10.0)).stability)
    weakening = -1e8 * 2.5 * math.cos(5 * slip) / 3.43e10
    assert growth / math.tanh(growth * 1e4 / 3500) == pytest.approx(3500 * weakening, rel=1e-5, abs=0)


def test_the_growth_of_the_block_solves_its_characteristic_equation() -> None:
    block = SpringBlock(2.8e12, 3.43e13, 1e14)
    slip = math.pi / 5
    growth = growth_in(examine(Scenario(Problem(block, LAW, initial_slip=slip, initial_excess=0.0), 10.0)).stability)
    assert 2.8e12 * growth**2 == pytest.approx(2.5e14 - 3.43e13, rel=1e-5, abs=0)


def test_the_growth_under_states_is_that_of_the_closed_form_and_of_the_equations_by_hand() -> None:
    """One state: rel 1e-9 of the characteristic equation. Two: rel 1e-5 of the eigenvalues of central differences."""

    def growth(problem: Problem) -> float:
        return examine(Scenario(problem, 1.0)).steady.slidings[0].growth

    block, rate, (a, b, c, near, far) = SpringBlock(2.8e12, 3.43e13, 1e14), 1e-3, (0.01, 0.01, 0.006, 1e-3, 2e-2)
    one = RateAndState(0.6, a, b + c, near)
    closed = SteadySliding(1e14, a, b + c, near, rate).block_growth(3.43e13, 2.8e12, 0.0)
    assert growth(Problem(block, one, pull_rate=rate)) == pytest.approx(closed.real, rel=1e-9)

    def right(y: Floats) -> Floats:
        u, v, w, w2 = y
        mu = a * math.asinh(v / 2e-6 * math.exp((0.6 + b * w + c * w2) / a))
        rates = (1e-6 * math.exp(-w) - v) / near, (1e-6 * math.exp(-w2) - v) / far
        return np.array([v, (-3.43e13 * u - 1e14 * mu) / 2.8e12, *rates])

    at, steps = np.array([0.0, rate, math.log(1e-6 / rate), math.log(1e-6 / rate)]), np.diag([1e-4, 1e-7, 1e-4, 1e-4])
    matrix = np.transpose([(right(at + h) - right(at - h)) / (2.0 * h.sum()) for h in steps])
    problem = Problem(block, TwoStateRateAndState(0.6, a, b, near, c, far), pull_rate=rate)
    assert growth(problem) == pytest.approx(np.linalg.eigvals(matrix).real.max(), rel=1e-5)


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("fig5-block-printed", "statically stable"),
        ("fig6-block-printed", "oscillates"),
        ("fig6-block-reconstructed", "unstable"),
        ("fig7-block-critical", "oscillates"),
        ("fig5-slab-printed", "statically stable"),
        ("fig5-slab-reconstructed", "statically unstable"),
    ],
)
def test_examine_says_whether_the_start_is_stable(name: str, word: str) -> None:
    assert examine(load_scenario(name)).stability.startswith(word)


@pytest.mark.parametrize(
    ("excess", "pull", "words"),
    [
        (5.0, 0.0, "slips at once"),
        (0.0, 1.0, "slips at 0+"),
        (0.0, 0.0, "stays stuck"),
        (-6.86e6, 1.0, "loading reaches the strength after about 2 s"),
        (-3.1e8, 0.0, "slips backwards at once"),
    ],
)
def test_examine_says_what_happens_at_the_start(excess: float, pull: float, words: str) -> None:
    assert words in examine(Scenario(Problem(SLAB, LAW, pull, initial_excess=excess), 10.0)).start


def test_examine_names_the_jump_at_the_start() -> None:
    """v(0+) of the slip law is excess / Z; of the rate law the landing of the rule, which may leave stick below the strength."""
    assert "jumps to 6.37753773e-05 m/s" in examine(load_scenario("fig5-slab-printed")).start
    problem = load_scenario("fig6-slab").problem
    for rule, excess, words in (
        ("perfect-delay", 0.0, "slips at 0+: the load is the static strength and grows; the slip rate jumps to 4.10204082 m/s"),
        ("perfect-delay", -1e6, "stuck: the load is 1e+06 Pa below"),
        (
            "maxwell",
            -1e6,
            "slips at once, because the rule 'maxwell' leaves stick below the static strength; the slip rate",
        ),
        ("perfect-delay", 1e6, "slips at once: the load exceeds the static strength by 1e+06 Pa; the slip rate jumps to 4.2"),
    ):
        changed = replace(problem, selection=rule, initial_excess=excess)
        assert words in examine(Scenario(changed, 10.0)).start
    heavy = replace(problem, body=replace(SLAB, contact_mass=1e5))
    assert "jumps" not in examine(Scenario(heavy, 10.0)).start


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("kind", LAWS)
def test_every_law_that_weakens_with_rate_has_critical_values(kind: str) -> None:
    problem = read_scenario(template("slab", kind), "new").problem
    found = examine(Scenario(problem, 10.0))
    weakens = problem.friction.depends_on_rate and kind != "velocity-strengthening" and problem.friction.state is None
    assert bool(found.critical) == weakens
    assert bool(found.along_slip) == (problem.friction.depends_on_slip and problem.friction.depends_on_rate)
    for fact in found.critical:
        assert fact.value > 0.0
        assert fact.meaning.startswith("here ")


@pytest.mark.parametrize(("alpha", "side"), [(0.05, "below"), (0.5, "above"), (None, "at")])
def test_each_critical_value_says_on_which_side_of_it_the_problem_is(alpha: float | None, side: str) -> None:
    """alpha_c = Z / (S (mu_s - mu_d)) = 0.196 s/m, and the critical stress is that for which alpha would be it."""

    def critical(alpha: float) -> dict[str, Fact]:
        law = HyperbolicRate(static=0.8, dynamic=0.3, alpha=alpha)
        return {fact.name: fact for fact in examine(Scenario(Problem(SLAB, law, initial_excess=0.0), 10.0)).critical}

    found = critical(alpha or critical(0.5)["friction.alpha"].value)
    assert found["friction.alpha"].value == pytest.approx(0.196, rel=1e-9, abs=0)
    assert found["friction.alpha"].meaning.startswith(f"here {side} it, at ")
    assert "proven" not in found["friction.alpha"].meaning
    if alpha is not None:
        assert found["body.normal_stress"].meaning.startswith(f"here {side} it, at ")


def warnings(scenario: Scenario) -> str:
    return "\n".join(examine(scenario).warnings)


@pytest.mark.parametrize(("start", "slips"), [({}, False), ({"initial_rate": 0.1}, True)], ids=["at rest", "moving"])
def test_only_a_contact_at_rest_can_wait_in_vain(start: dict[str, float], slips: bool) -> None:
    problem = Problem(SpringBlock(2.8e12, 3.43e13, 1e14), LAW, pull_rate=1e-9, initial_excess=-1e12, **start)
    assert ("nothing will slip" in warnings(Scenario(problem, 1.0))) is not slips


@pytest.mark.parametrize(("given", "shown"), [({}, True), ({"creep_rtol": 1e-4}, True), ({"creep_rtol": 0.0}, False)])
def test_an_option_that_is_off_is_not_listed(given: dict[str, float], shown: bool) -> None:
    facts = examine(load_scenario("fig6-slab").with_values({f"run.{name}": one for name, one in given.items()})).given["run"]
    assert ("creep_rtol" in {fact.name for fact in facts}) is shown


@pytest.mark.parametrize(("name", "over"), [("fig6-slab", "steady sliding after 200 round trips of it"), ("creep", "creep after")])
def test_the_automatic_tolerance_says_what_it_leaps_over(name: str, over: str) -> None:
    problem = Problem(SLAB, SinusoidalSlip(1.0, 0.5, 5.0), pull_rate=1e-9, initial_excess=0.0)
    found = examine(load_scenario(name) if name != "creep" else Scenario(problem, 10.0)).given["run"]
    (automatic,) = (fact.meaning for fact in found if fact.name == "creep_rtol")
    assert over in automatic


def test_examine_warns_of_what_is_doubtful() -> None:
    slab = load_scenario("fig6-slab")
    assert "multiplies a disturbance by up to 1.49 " in warnings(slab)
    assert "up to 3.92e+05" in warnings(load_scenario("fig7-slab-critical"))
    assert "up to 1 + 0.00047 " in warnings(load_scenario("bowed-string-slab"))
    assert "narrower than 1e-9" in warnings(load_scenario("fig7-slab-critical"))
    assert "before the first echo" in warnings(replace(slab, duration=5.0))
    assert "nothing will slip" in warnings(replace(slab, problem=replace(slab.problem, initial_excess=-1e6)))
    soft = replace(slab.problem, body=replace(SLAB, wave_speed=100.0))
    assert "linear elasticity is doubtful" in warnings(replace(slab, problem=soft))
    block = load_scenario("fig6-block-printed")
    assert warnings(block) == ""
    assert "has no effect" in warnings(replace(block, problem=replace(block.problem, selection="maxwell")))


@pytest.mark.parametrize("name", ["drill-string", "pipe-and-collar"])
def test_sizes_in_millimetres_are_asked_about(name: str) -> None:
    """Programs for shafts take mm; a number here is in m, and no string is 100 m wide."""
    scenario = load_scenario(name)
    body: Any = scenario.problem.body
    assert "in mm" not in warnings(scenario)
    outer, inner = (1e3 * np.array(one) for one in (body.outer_diameter, body.inner_diameter))
    wide = replace(body, outer_diameter=outer, inner_diameter=inner, bit_radius=155.575)
    said = warnings(replace(scenario, problem=replace(scenario.problem, body=wide)))
    assert f"outer_diameter is {outer.max():.6g} m: is it in mm? write '{outer.max():.6g} mm'" in said
    assert "bit_radius is 155.575 m: is it in mm? write '155.575 mm'" in said


def test_healing_at_once_on_a_slab_without_mass_is_warned_of() -> None:
    scenario = load_scenario("cycles-slab")
    assert warnings(scenario) == ""
    bare = replace(scenario.problem, body=replace(scenario.problem.body, contact_mass=0.0))
    assert "creeps in tiny slips" in warnings(replace(scenario, problem=bare))
    worn = replace(bare, friction=replace(bare.friction, memory="all"))
    assert "creeps in tiny slips" not in warnings(replace(scenario, problem=worn))


def test_rate_and_state_is_judged_by_its_stiffness() -> None:
    """0.4 of the critical stiffness S (b - a)/Dc = 5e7 N/m; the slab's G/h = 3.43e7 against 5e8 Pa/m."""
    block, slab = (examine(load_scenario(f"rate-and-state-{body}")) for body in ("block", "slab"))
    assert "stiffness K = 2e+07 against the critical 5e+07 N/m" in block.stability
    assert "stiffness G/h = 3.43e+07 against the critical 5e+08 Pa/m" in slab.stability
    forwards = load_scenario("rate-and-state-block")
    backwards = forwards.with_values({"loading.pull_rate": -forwards.problem.first_pull_rate})
    assert "against the critical 5e+07 N/m" in examine(backwards).stability
    assert block.steady.slidings[0].stable is slab.steady.slidings[0].stable is False
    assert slab.uniqueness.regime == "regular"
    assert "a given state" in slab.uniqueness.summary
    assert "never sticks" in slab.start
    assert not block.warnings + slab.warnings
    assert {fact.name for fact in slab.derived} >= {"steady friction", "steady state", "b - a"}
    assert not {fact.name for fact in slab.derived} & {"strength", "excess"}


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "slides from the start, at 1e-06 m/s: steady sliding at the pull rate"),
        ({"initial.rate": 1e-3}, "slides from the start, at 0.001 m/s: steady sliding"),
        (
            {"initial.load": 3e4, "initial.state": 10.0},
            "slides from the start, at 1e-06 m/s: there the initial load and friction balance",
        ),
        (
            {"initial.load": 3e4, "initial.state": 10.0, "initial.rate": -1e-3},
            "slides from the start, at -0.001 m/s: as initial rate",
        ),
    ],
)
def test_examine_says_how_a_contact_starts_that_never_sticks(given: dict[str, float], words: str) -> None:
    scenario = load_scenario("velocity-steps-block")
    found = examine(scenario.with_values(given) if given else scenario)
    assert found.start == words


def test_only_what_a_body_and_a_law_can_feel_is_listed() -> None:
    def listed(scenario: Scenario) -> set[str]:
        return {fact.name for facts in examine(scenario).given.values() for fact in facts}

    table = FromTable(rate=[0.0, 1.0], friction=[0.6, 0.5])
    block = Scenario(Problem(SpringBlock(1.0, 1.0, 10.0), table, initial_excess=0.0), 1.0)
    assert not {"counts", "memory", "far_stress_rate"} & listed(block)
    assert not {"far_stress_rate"} & listed(Scenario(Problem(SLAB, LAW, initial_excess=0.0), 1.0))
    matched = replace(SLAB, driver_impedance=SLAB.impedance)
    slips = FromTable(slip=[0.0, 1.0], friction=[0.6, 0.5])
    assert {"counts", "memory", "far_stress_rate"} <= listed(Scenario(Problem(matched, slips, initial_excess=0.0), 1.0))


@pytest.mark.parametrize(("rate", "shown"), [(2e-61, 0.0), (1e-16, 0.0), (-0.0, 0.0), (2e-6, 2e-6), (4.1, 4.1)])
def test_a_rate_whose_load_rounding_hides_is_rest(rate: float, shown: float) -> None:
    assert resolved(rate, 8e7, 9.8e6) == shown
