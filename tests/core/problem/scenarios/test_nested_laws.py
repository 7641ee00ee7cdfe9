"""Laws of laws, lists and named numbers in a scenario: what is wrong is said with its place."""

from __future__ import annotations

import pytest

from stickslip.problem.scenarios.scenario import read_scenario
from stickslip.problem.scenarios.templates import template
from tests.messages import refused

CASES = [
    ("sum", "static = 0.4 ", "statik = 0.4 ", "[friction.slip] statik is unknown; did you mean 'static'?"),
    ("sum", "static = 0.4 ", "", "[friction.slip] static is missing: friction coefficient before slip"),
    ("sum", '"0.4 m"', '"0.4 s"', "[friction.slip] distance must be a number in m"),
    ("sum", "# exponent = 1.0", "exponent = 1.5", "[friction.rate] exponent must be a whole number up to 16, got 1.5"),
    (
        "sum",
        '[friction.rate]\nkind = "exponential-stribeck"',
        "[friction.rate]",
        "[friction.rate] kind is missing; allowed: both-ways, carlson-langer, coulomb",
    ),
    (
        "sum",
        '[friction.rate]\nkind = "exponential-stribeck"',
        '[friction.rate]\nkind = "sum"',
        "is itself made of laws and cannot be part",
    ),
    ("sum", "[friction.rate]", "[friction.rat]", "[friction] rat is unknown; did you mean 'rate'?"),
    ("sum", "[friction.slip]", "[[friction.slip]]", "[friction.slip] must be a table"),
    ("product", '"1 s/m"', "-1.0", "[friction.rate] alpha must be at least 0 s/m"),
    ("expression", "mu_s = 0.8", "mu_s = [0.8]", "[friction.parameters] 'mu_s' must be a number or a text with a unit, got [0.8]"),
    ("expression", "mu_s = 0.8", "mu_s = nan", "[friction] parameters 'mu_s' must be finite, got nan"),
    (
        "expression",
        '"1 s/m"',
        '"1 parsnip"',
        "[friction] parameters 'alpha' must be a number or a text with a unit: 'parsnip' is not a unit",
    ),
    ("expression", "[friction.parameters]", "[friction.parameter]", "[friction] parameter is unknown; did you mean 'parameters'?"),
    ("expression", '# counts = "net"', 'counts = "walked"', "[friction] counts 'walked' is unknown; allowed: net, path"),
    ("expression", '"mu_d + (mu_s - mu_d) / (1 + alpha*v)"', "3", "[friction] expression must be text, got int"),
    ("piecewise-linear-slip", '"5 cm"', '"5 kg"', "[friction] slips[1] must be a number in m"),
    ("piecewise-linear-slip", '"5 cm"', "-1.0", "[friction] slips[1] must be at least 0 m, got -1"),
    ("piecewise-linear-slip", '"5 cm"', "0.4", "[friction] slips must ascend, but [2] = 0.2 follows 0.4"),
    ("coulomb", "dynamic = 0.5", "dynamic = 0.9", "[friction] static must be at least dynamic, got static 0.6 < dynamic 0.9"),
]


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("kind", "old", "new", "message"), CASES)
def test_mistakes_in_nested_laws_are_refused_with_their_place(kind: str, old: str, new: str, message: str) -> None:
    text = template("slab", kind)
    assert old in text
    with refused(message, begins="my.toml: "):
        read_scenario(text.replace(old, new, 1), "my.toml")
