"""Names of parameters in figures."""

from __future__ import annotations

import re

import pytest
from matplotlib.mathtext import MathTextParser

import stickslip as ss
from stickslip.figures.names import parameter_name, plain_name, symbol
from stickslip.scenarios.library import names
from stickslip.scenarios.parameter_paths import ParameterPath, parameter_paths


def declared() -> list[ParameterPath]:
    """Every parameter that can be varied in some bundled scenario."""
    return [one for name in names() for one in parameter_paths(ss.load_scenario(name))]


@pytest.mark.parametrize(
    ("name", "meaning", "shown", "short"),
    [
        ("body.normal_stress", "normal stress S on the contact, compression positive", "normal stress $S$ on the contact", "$S$"),
        ("body.density", "density rho", r"density $\rho$", r"$\rho$"),
        ("body.driver_impedance", "impedance Zd of the driver: inf for a rigid one", "impedance $Z_{d}$ of the driver", "$Z_{d}$"),
        ("friction.static", "friction coefficient muS at rest", r"friction coefficient $\mu_{S}$ at rest", r"$\mu_{S}$"),
        ("friction.amplitude", "amplitude a of the oscillation", "amplitude $a$ of the oscillation", "$a$"),
        ("friction.rate", "slip rate v_s at which it is half", "slip rate $v_{s}$ at which it is half", "$v_{s}$"),
        ("friction.exponent", "exponent of v / rate: 1 or 2", "exponent of $v$ / rate", ""),
        ("friction.distance", "slip over which friction falls (often Dc)", "slip over which friction falls", ""),
        ("friction.dynamic", "friction after `distance` of slip", "friction after distance of slip", ""),
        ("friction.distance", "slip over which it falls by a factor e", "slip over which it falls by a factor e", ""),
        ("friction.values[2]", "the values", "the values [2]", ""),
        ("friction.parameters.alpha", "values of the parameters", r"$\alpha$", r"$\alpha$"),
        ("friction.parameters.drop", "values of the parameters", "drop", ""),
        ("run.duration", "how long to simulate", "duration", ""),
        ("run.selection", "selection rule", "selection rule", ""),
    ],
)
def test_a_parameter_has_the_words_and_the_symbol_of_its_meaning(name: str, meaning: str, shown: str, short: str) -> None:
    assert parameter_name(name, meaning) == shown
    assert symbol(name, meaning) == short


def test_plain_names_have_greek_letters() -> None:
    assert plain_name("body.density", "density rho") == "density ρ"
    assert plain_name("friction.static", "friction coefficient muS at rest") == "friction coefficient μS at rest"


def test_every_declared_parameter_has_a_name_that_can_be_typeset() -> None:
    found = declared()
    assert len(found) > 300
    parser = MathTextParser("path")
    for one in found:
        text = parameter_name(one.name, one.declared.meaning)
        assert text
        for mathematics in re.findall(r"\$[^$]+\$", text):
            parser.parse(mathematics)
        words = re.sub(r"\$[^$]+\$", "", text)
        assert not re.search(r"[_.`]|\b(alpha|rho|omega|mu[0SD]?)\b", words), text
