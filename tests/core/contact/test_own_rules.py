"""A user's own rule: as a function, by a name, through a run, a file and a scenario; and what is wrong with a bad one."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.branches import resistance
from stickslip.contact.rules.selection import flaw, selection_table
from stickslip.problem.resistance import Branch
from stickslip.problem.selection_rule import SELECTION_RULES, SelectionTable, registered
from tests.limits import examples

from .laws import Wavy, hyperbolic, slab_problem


@pytest.fixture(autouse=True)
def _forget():
    yield
    registered.clear()


def halfway(g, stable):
    """Leaves stick, and slip, halfway between the folds of a contact with one branch."""
    level = 0.5 * stable[0].excess_from
    return SelectionTable(stick_to=level, keep_from=(level,), keep_to=(math.inf,))


def test_a_function_is_a_rule():
    problem = slab_problem(hyperbolic(1.0), halfway)
    assert problem.rule == "halfway"
    found = ss.uniqueness(problem)
    assert found.rule == "halfway"
    strength, window = found.resistance.strength, found.window
    assert [jump.load for jump in found.jumps] == pytest.approx([strength + 0.5 * window[0]] * 2, rel=1e-14, abs=0)
    assert found.loop_area == 0.0


def test_an_own_rule_runs_and_is_saved_by_its_name(tmp_path: Path):
    scenario = ss.load_scenario("fig4-loop")
    solution = ss.simulate(replace(scenario.problem, selection=halfway), scenario.duration)
    level = [jump.load for jump in ss.uniqueness(solution.problem).jumps]
    assert [float(solution.load(t)) for t in solution.shocks.time] == pytest.approx(level, rel=1e-9, abs=0)
    assert "halfway: the contact equation has several solutions, this run depends on the rule" in repr(solution)
    path = solution.to_netcdf(tmp_path / "run.nc")
    with pytest.raises(ss.InputError, match=r"run\.nc: made under the selection rule 'halfway', unknown here: .*register"):
        ss.open_solution(path)
    ss.selection.register("halfway", halfway)
    again = ss.open_solution(path)
    assert again.problem.selection == "halfway"
    assert again.shocks.equals(solution.shocks)


def test_a_registered_rule_is_named_in_scenarios(tmp_path: Path):
    text = ss.load_scenario("fig4-loop").source.replace('selection = "perfect-delay"', "")
    text = text.replace("[run]\n", '[run]\nselection = "half-way"\n')
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(ss.InputError, match=r"mine\.toml: \[run\] selection 'half-way' is unknown; .* or a registered one"):
        ss.load_scenario(tmp_path / "mine.toml")
    ss.selection.register("half-way", halfway)
    solution = ss.simulate(tmp_path / "mine.toml")
    assert solution.problem.rule == "half-way"
    assert replace(solution.problem, selection=halfway) == solution.problem  # a registered function is kept by its name


def test_a_name_can_be_registered_again_and_the_next_run_follows(tmp_path: Path):
    from stickslip.contact.rules.selection import maximal, minimal

    scenario = ss.load_scenario("fig4-loop")
    times = []
    for rule in (minimal, maximal):
        ss.selection.register("mine", rule)
        times.append(ss.simulate(replace(scenario.problem, selection="mine"), scenario.duration).shocks.time[0])
    assert times[0] > times[1] + 1.0


@pytest.mark.parametrize(
    ("name", "rule", "message"),
    [
        ("maxwell", halfway, "'maxwell' is the name of a built-in rule"),
        ("my rule", halfway, "letters, digits"),
        ("", halfway, "letters, digits"),
        ("mine", None, "must be a function"),
    ],
)
def test_bad_rules_and_names_cannot_be_registered(name, rule, message):
    with pytest.raises(ss.InputError, match=message):
        ss.selection.register(name, rule)
    assert registered == {}


def maxwell(g, stable):
    return halfway(g, stable)


@pytest.mark.parametrize(
    ("rule", "message"),
    [
        ("maxwel", "selection rule 'maxwel' is unknown; did you mean 'maxwell'\\?"),
        ("nothing like it", "is unknown; allowed: .* or a registered one"),
        (lambda g, stable: None, "the function's name, '<lambda>', is not made of letters"),
        (maxwell, "the function's name, 'maxwell', is that of another rule"),
        (3, r"must be a name or a function \(g, stable\).*, got int"),
    ],
)
def test_a_problem_refuses_unknown_rules(rule, message):
    with pytest.raises(ss.InputError, match=message):
        slab_problem(hyperbolic(1.0), rule)


BAD = {
    "no table": (lambda b: (0.0, b, b), "must return a SelectionTable, got tuple"),
    "too short": (lambda b: SelectionTable(0.0, (), (math.inf,)), "1 branches, but keep_from has 0 numbers and keep_to has 1"),
    "nan": (lambda b: SelectionTable(0.0, (math.nan,), (math.inf,)), "a level is not a number"),
    "beyond strength": (
        lambda b: SelectionTable(1.0, (b,), (math.inf,)),
        "stick_to must be at most 0, the static strength, got 1 Pa",
    ),
    "beyond the branch": (lambda b: SelectionTable(0.0, (2 * b,), (math.inf,)), "branch 0 exists from .* but is kept from"),
    "nowhere up": (lambda b: SelectionTable(0.0, (b,), (1e6,)), "when the load rises beyond what stick is kept for, no branch"),
    "nothing kept": (
        lambda b: SelectionTable(0.0, (1.0,), (-1.0,)),
        "rises beyond what stick is kept for, no branch is kept there",
    ),
    "gap": (lambda b: SelectionTable(0.9 * b, (0.5 * b,), (math.inf,)), "rises beyond what stick is kept for, no branch is kept"),
    "nowhere down": (lambda b: SelectionTable(b, (0.5 * b,), (math.inf,)), "no branch is kept there"),
    "stick is over": (lambda b: SelectionTable(-math.inf, (b,), (math.inf,)), "no branch is kept there"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_table_that_cannot_be_followed_is_refused_in_one_line(name):
    make, message = BAD[name]

    def bad(g, stable):
        return make(stable[0].excess_from)

    problem = slab_problem(hyperbolic(1.0), bad)
    for use in (selection_table, ss.uniqueness, lambda p: ss.simulate(p, 1.0)):
        with pytest.raises(ss.InputError, match=f"^selection rule 'bad': .*{message}") as error:
            use(problem)
        assert "\n" not in str(error.value)


@pytest.mark.parametrize("rule", SELECTION_RULES)
def test_the_built_in_rules_can_be_followed(rule):
    for slip in (0.3, 2.2):
        law = Wavy(mean=0.7, amplitude=0.25, beat=2.0, fade=5.0, turn=1.3, step=0.05)
        stable, table = selection_table(slab_problem(law, rule), slip)
        assert len(table.keep_to) == len(stable) >= 2
        assert table.stick_to <= 0.0


def test_a_rule_sees_the_resistance():
    seen = []

    def curious(g, stable):
        seen.append((g.strength, float(g.excess(1.0)), stable))
        return halfway(g, stable)

    problem = slab_problem(hyperbolic(1.0), curious)
    ss.uniqueness(problem)
    strength, excess, stable = seen[0]
    assert (strength, excess) == (8e7, float(resistance(problem).excess(1.0)))
    assert len(stable) == 1


LEVELS = [-math.inf, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, math.inf]
PROBES = [-3.5, -3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5]


def stuck_or_kept(table, branch, excess):
    """Whether the table keeps the branch (-1: stick) at an excess."""
    return excess <= table.stick_to if branch < 0 else table.keep_from[branch] <= excess <= table.keep_to[branch]


def can_be_followed(table):
    """By trying every branch at every excess: what is taken when it is left is kept there."""
    kept = [-1, *(i for i in range(len(table.keep_to)) if table.keep_from[i] <= table.keep_to[i])]
    for branch in kept:
        for excess in PROBES:
            if stuck_or_kept(table, branch, excess):
                continue
            above = branch < 0 or excess > table.keep_to[branch]
            try:
                taken = table.climb(branch, excess) if above else table.descend(branch, excess)
            except StopIteration:
                return False
            if not stuck_or_kept(table, taken, excess):
                return False
    return True


@settings(max_examples=examples(500))
@given(
    stick=st.sampled_from([level for level in LEVELS if level <= 0.0]),
    ends=st.lists(st.tuples(st.sampled_from(LEVELS), st.sampled_from(LEVELS)), min_size=1, max_size=4),
)
def test_flaws_are_those_that_a_walk_meets(stick, ends):
    table = SelectionTable(stick, tuple(low for low, _ in ends), tuple(high for _, high in ends))
    everywhere = tuple(Branch(float(i), i + 1.0, -math.inf, math.inf) for i in range(len(ends)))
    assert (flaw(table, everywhere) == "") == can_be_followed(table)
