"""A scenario with other values is the scenario of a file in which those values were edited."""

import tomllib
from typing import Any

import pytest

import stickslip as ss
from stickslip.cli.overrides import typed_values
from stickslip.problem.scenarios.library import text
from stickslip.problem.scenarios.parameter_paths import parameter_paths
from stickslip.problem.scenarios.scenario import Scenario, read_scenario
from tests.messages import refused

EDITS = [
    ("fig6-slab", {"friction.alpha": 0.1}, [("alpha = 1.0", "alpha = 0.1")]),
    ("fig6-slab", {"alpha": "0.1 s/m"}, [("alpha = 1.0", "alpha = 0.1")]),
    ("fig6-slab", {"body.thickness": "5 km", "run.duration": 6.0}, [('"10 km"', '"5000 m"'), ('"12 s"', '"6 s"')]),
    ("fig6-slab", {"initial.load": "81 MPa"}, [("excess = 0.0", 'load = "81 MPa"')]),
    ("velocity-steps-block", {"loading.pull_rate.values[1]": "3 um/s"}, [('"10 um/s"', '"3 um/s"')]),
    ("bowed-string-slab", {"pressing": "2 Pa"}, [("normal_stress = 1.0", "normal_stress = 2.0"), ("load = 0.35", "load = 0.70")]),
    ("fig6-slab", {"one_way": "true"}, [("[loading]\n", "[loading]\none_way = true\n")]),
    ("second-event-maximal", {"run.selection": "maxwell"}, [('selection = "maximal"', 'selection = "maxwell"')]),
]


def edited(name: str, edits: list[tuple[str, str]]) -> Scenario:
    """Read a bundled scenario after replacing pieces of its text, each of which must be there."""
    content = text(name)
    for old, new in edits:
        assert old in content
        content = content.replace(old, new)
    return read_scenario(content, "edited")


@pytest.mark.parametrize(("name", "values", "edits"), EDITS)
def test_other_values_are_those_of_an_edited_file(name: str, values: dict[str, Any], edits: list[tuple[str, str]]) -> None:
    expected, found = edited(name, edits), ss.scenarios[name].with_values(values)
    assert found != ss.scenarios[name]
    assert found.problem == expected.problem
    assert (found.duration, found.rtol, found.max_events) == (expected.duration, expected.rtol, expected.max_events)
    typed = ss.scenarios[name].with_values(typed_values([f"{key} = {value}" for key, value in values.items()], "typed", "a=1"))
    assert typed.problem == expected.problem


@pytest.mark.sampled(every=18)
@pytest.mark.parametrize("name", sorted(ss.scenarios))
def test_each_parameter_can_be_given_the_value_that_it_has(name: str) -> None:
    scenario = ss.scenarios[name]
    document = tomllib.loads(scenario.to_toml())
    for parameter in parameter_paths(scenario):
        value: Any = document
        for key in parameter.name.split("."):
            value = value.get(key) if "[" not in key else value[key.partition("[")[0]][int(key.partition("[")[2][:-1])]
            if value is None:
                break
        if value is not None and not isinstance(value, dict):  # a pull rate that varies in time is no number
            found = scenario.with_values({parameter.name: value})
            assert found.problem == scenario.problem
            assert found.to_toml().partition("[body]")[2] == scenario.to_toml().partition("[body]")[2]


def test_the_title_tells_what_was_changed_and_what_was_described_is_left_out() -> None:
    found = ss.scenarios["fig6-slab"].with_values({"friction.alpha": 0.1, "body.thickness": "5 km"})
    assert found.title == "Fig. 6, slab, rate law, alpha = 1: friction.alpha = 0.1, body.thickness = 5 km"
    assert (found.name, found.description) == ("fig6-slab", "")
    assert ss.simulate(found).title == found.title


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"pressing": 1e7, "normal_stress": 1e7}, "pressing and body.normal_stress exclude each other"),
        ({"initial.load": 1e7, "initial.excess": 0.0}, "initial.load and initial.excess exclude each other"),
        ({"pressing": -1.0}, "pressing must be greater than 0 Pa"),
        ({"loading.pull_rate.values[1]": 1.0}, "'loading.pull_rate.values[1]' is not a parameter of this scenario"),
        ({"friction.alpa": 1}, "fig6-slab: 'friction.alpa' is not a parameter of this scenario; did you mean 'friction.alpha'?"),
        ({"friction.alpha": -1.0}, "fig6-slab: friction.alpha must be at least 0 s/m, got -1"),
        ({"friction.alpha": "2 m"}, "fig6-slab: friction.alpha must be a number in s/m or a text with a unit"),
        ({"friction.kind": "linear-slip-weakening"}, "fig6-slab: 'friction.kind' is not a parameter of this scenario"),
        ({"body.thickness": None}, "fig6-slab: body.thickness must be a number in m or a text with a unit"),
        ({"initial.slip": 1.0, "run.duration": "-1 s"}, "fig6-slab: run.duration must be greater than 0 s, got -1"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(values: dict[str, Any], message: str) -> None:
    with refused(message):
        ss.scenarios["fig6-slab"].with_values(values)


def test_a_plain_number_for_what_turns_is_said_back_with_its_unit() -> None:
    string = ss.scenarios["drill-string"]
    assert string.with_values({"pull_rate": 120.0}).title.endswith(": pull_rate = 120 rad/s (1145.9 rpm)")
    assert string.with_values({"pull_rate": "120 rpm"}).title.endswith(": pull_rate = 120 rpm")
