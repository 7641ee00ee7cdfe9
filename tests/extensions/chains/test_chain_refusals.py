"""Every [chain] that cannot be used is refused in one line, which says where, what, and what is allowed."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.problem.scenarios.scenario import read_scenario

TEXT = """
[friction]
kind = "coulomb"
static = 1.0
dynamic = 0.8
[chain]
blocks = 3
mass = "1 kg"
coupling = "5 N/m"
stiffness = "1 N/m"
normal_force = "1 N"
pull_rate = "1 mm/s"
[run]
duration = "10 s"
"""
NORMAL = 'normal_force = "1 N"'
DRAWN = f"{NORMAL[:12]} = {{ "
BAD = [
    ("blocks = 3", "", "[chain] blocks is missing"),
    ("blocks = 3", "blocks = 0", "[chain] blocks must be a whole number, or [rows, columns] of a lattice, got 0"),
    ("blocks = 3", "blocks = 2.5", "[chain] blocks must be a whole number"),
    ("blocks = 3", "blocks = true", "[chain] blocks must be a whole number"),
    ("blocks = 3", 'blocks = "3"', "[chain] blocks must be a whole number"),
    ("blocks = 3", "blocks = 1000000000", "[chain] blocks must be at most 1000000 in all, got 1000000000"),
    ("blocks = 3", "blocks = [2000, 2000]", "[chain] blocks must be at most 1000000 in all, got 4000000"),
    ("blocks = 3", "blocks = [2, 2, 2]", "[chain] blocks must be a whole number, or [rows, columns]"),
    ('mass = "1 kg"', "", "[chain] mass is missing: mass m of a block"),
    ('mass = "1 kg"', "mass = -1", "[chain] mass must be greater than 0 kg, got -1"),
    ('mass = "1 kg"', 'mass = "1 m"', "[chain] mass must be a number in kg"),
    ('mass = "1 kg"', "mass = [1.0, 2.0]", "[chain] mass must have 3 numbers as there are blocks, got 2"),
    ('mass = "1 kg"', "mass = [1.0, 2.0, -3.0]", "[chain] mass[2] must be greater than 0 kg, got -3"),
    ('mass = "1 kg"', "mass = []", "[chain] mass must have one number for each block or spring, got an empty list"),
    ('mass = "1 kg"', "mass = nan", "[chain] mass must be"),
    ('mass = "1 kg"', "mass = [[1.0, 1.0], [1.0, 1.0], [1.0, 1.0]]", "[chain] mass[0] must be a number in kg"),
    ('mass = "1 kg"', "mas = 1", "[chain] mas is unknown; did you mean 'mass'?"),
    ('coupling = "5 N/m"', "coupling = inf", "[chain] coupling must be finite, got inf"),
    ('coupling = "5 N/m"', "coupling = -1.0", "[chain] coupling must be at least 0 N/m, got -1"),
    ('coupling = "5 N/m"', "coupling = [1.0]", "[chain] coupling of 3 blocks with free ends must have 2 springs, got 1"),
    ('coupling = "5 N/m"', 'coupling = { drawn = "uniform", low = 1, high = 2, seed = 1 }', "[chain] coupling must be a number"),
    (NORMAL, f"{DRAWN} low = 1, high = 2, seed = 1 }}", "[chain] normal_force must say how its numbers are drawn, as"),
    (NORMAL, f'{DRAWN} drawn = "unifrom", low = 1, high = 2, seed = 1 }}', "drawn 'unifrom' is unknown; did you mean 'uniform'?"),
    (NORMAL, f'{DRAWN} drawn = "uniform", low = 1, seed = 1 }}', "normal_force high is missing: uniform has low, high and seed"),
    (NORMAL, f'{DRAWN} drawn = "uniform", low = 1, high = 2 }}', "normal_force seed is missing"),
    (NORMAL, f'{DRAWN} drawn = "uniform", low = 1, hi = 2, seed = 1 }}', "normal_force 'hi' is unknown; did you mean 'high'?"),
    (NORMAL, f'{DRAWN} drawn = "uniform", low = 1, high = 2, seed = -1 }}', "seed must be a whole number from 0 to"),
    (NORMAL, f'{DRAWN} drawn = "uniform", low = "1 m", high = 2, seed = 1 }}', "normal_force low must be a number in N"),
    (
        NORMAL,
        f'{DRAWN} drawn = "uniform", low = -2, high = -1, seed = 1 }}',
        "normal_force must be at least 0 N, got -1.48818, drawn for block 0",
    ),
    (
        NORMAL,
        f'{DRAWN} drawn = "lognormal", median = -2, sigma = 1, seed = 1 }}',
        "[chain] normal_force median of 'lognormal' must be above 0, got -2",
    ),
    ("[run]", 'ends = "open"\n[run]', "[chain] ends 'open' is unknown; "),
    ("[run]", 'direction = "backward"\n[run]', "[chain] direction 'backward' is unknown; allowed: both, forward"),
    ("[run]", 'damping = "-1 N s/m"\n[run]', "[chain] damping must be at least 0 N s/m, got -1"),
    ("[run]", "initial_slip = inf\n[run]", "[chain] initial_slip must be finite, got inf"),
    ("[run]", "[run]\nrtol = 1e-9", "[run] rtol has no effect with a [chain], whose events are located to rounding: leave it out"),
    ("[run]", '[body]\nkind = "spring-block"\nmass = 2\n[run]', "a scenario with a [chain] has no [body]: leave it out"),
    ("[run]", "[loading]\npull_rate = 1e-3\n[run]", "has no [loading]: leave it out; [chain] has pull_rate"),
    ("[run]", "[initial]\nslip = 1.0\n[run]", "has no [initial]: leave it out; [chain] has initial_slip"),
    (
        "[run]",
        '[body]\nkind = "spring-block"\nmass = 1.0\nstiffness = 1.0\nnormal_force = 1.0\n[run]',
        "has no [body]: leave it out",
    ),
    ("[run]", "[loading]\npull_rate = 0\n[run]", "has no [loading]: leave it out"),
    ("[run]", "[initial]\nload = 0\n[run]", "has no [initial]: leave it out"),
    ('kind = "coulomb"', 'kind = "coulom"', "[friction] kind 'coulom' is unknown; did you mean 'coulomb'?"),
    ('pull_rate = "1 mm/s"', 'pull_rate = "1 mm"', "[chain] pull_rate must be a number in m/s"),
    ('pull_rate = "1 mm/s"', 'pull_rate = "-1 mm/s"\ndirection = "forward"', "direction 'forward' needs a pull_rate of 0 or more"),
    ("blocks = 3\nmass", 'blocks = 2\nends = "periodic"\nmass', "a periodic chain needs at least 3 blocks in a circle, got 2"),
]


@pytest.mark.parametrize(("old", "new", "wanted"), BAD)
def test_a_table_that_cannot_be_used_is_refused_in_one_line(old: str, new: str, wanted: str) -> None:
    assert old in TEXT
    with pytest.raises(ss.InputError) as refused:
        read_scenario(TEXT.replace(old, new, 1), "mine.toml")
    message = str(refused.value)
    assert message.startswith("mine.toml: ")
    assert "\n" not in message
    assert len(message) < 400
    assert wanted in message, message


def test_a_law_that_no_chain_has_is_refused_before_its_start() -> None:
    law = 'kind = "rate-and-state"\nreference = 0.6\nrate = 1e-6\na = 0.01\nb = 0.015\ndistance = 1e-5'
    text = TEXT.replace('kind = "coulomb"\nstatic = 1.0\ndynamic = 0.8', law)
    with pytest.raises(ss.InputError, match=r"^mine.toml: \[friction\] RateAndState has a state variable"):
        read_scenario(text, "mine.toml")


def test_what_a_run_of_a_chain_has_not_is_refused() -> None:
    for given, wanted in (({"rtol": 1e-3}, "a Chain has no rtol"), ({"keep": "all"}, "keep 'all' is unknown; allowed: catalogue")):
        with pytest.raises(ss.InputError, match=wanted):
            ss.simulate("two-blocks", **given)
    with pytest.raises(ss.InputError, match="needs a duration"):
        ss.simulate(ss.scenarios["two-blocks"].to_solve, None)  # type: ignore[call-overload]
