"""Scenarios with a [motion] have no body, no loading and no start: nobody is shown one, and what is written reads back equal."""

from pathlib import Path

import pytest

import stickslip as ss
from stickslip.problem.scenarios import Scenario, read_scenario
from stickslip.problem.scenarios.parameter_paths import parameter_paths
from tests.extensions.given_motion.running import refused, stickslip

HEAD = """
[friction]
kind = "rate-and-state"
reference = 0.6
a = 0.01
b = 0.015
distance = "10 um"

"""
TAIL = """
[motion.slip_rate]
kind = "steps"
times = [0.0, "20 s"]
values = ["1 um/s", "10 um/s"]

[run]
duration = "60 s"
"""
STRESS = "[motion]\nnormal_load = '5 MPa'\n"
PLAIN = "[motion]\nnormal_load = 5e6\nload_unit = 'Pa'\n"
HISTORY = "[motion.normal_load]\nkind = 'steps'\ntimes = [0.0, '30 s']\nvalues = ['5 MPa', '6 MPa']\n"
BODY = "[body]\nkind = 'elastic-slab'\ndensity = 3e3\nwave_speed = 3e3\nthickness = 1e3\nnormal_stress = '5 MPa'\n[motion]\n"
TURNING = "[motion]\nnormal_load = '3 N m'\n"


def scenario_of(motion: str) -> Scenario:
    tail = TAIL.replace("um/s", "urad/s") if motion == TURNING else TAIL
    head = HEAD.replace("um", "urad") if motion == TURNING else HEAD
    return read_scenario(head + motion + tail, "test")


@pytest.mark.parametrize("motion", [STRESS, PLAIN, HISTORY, BODY, TURNING])
def test_what_is_written_reads_back_equal_and_has_no_body(motion: str) -> None:
    scenario = scenario_of(motion)
    written = scenario.to_toml()
    again = read_scenario(written, "again")
    assert again == scenario
    assert again.to_toml() == written
    assert set(scenario.document) == {"friction", "motion", "run"}
    for one in (scenario, again):
        assert one.to_solve.load_unit == ("N m" if motion == TURNING else "Pa")
        assert one.to_solve.normal_load.first == (3.0 if motion == TURNING else 5e6)
    shown = repr(scenario) + scenario._repr_html_()
    assert "RateAndState" in shown
    assert not any(word in shown for word in ("Slab", "Block", "initial_load", "normal_stress="))


@pytest.mark.parametrize("motion", [STRESS, BODY])
def test_parameters_are_those_that_are_there(motion: str) -> None:
    scenario = scenario_of(motion)
    tables = {one.name.partition(".")[0] for one in parameter_paths(scenario)}
    assert tables == {"friction", "run", "motion"}
    changed = scenario.with_values({"motion.normal_load": "6 MPa", "friction.a": 0.02, "motion.initial_slip": "2 mm"})
    assert (changed.to_solve.normal_load.first, changed.to_solve.initial_slip) == (6e6, 2e-3)
    assert changed.to_solve.friction.a == 0.02
    assert changed.to_solve.load_unit == "Pa"


REFUSED = [
    ("body.mass", "test: body.mass: a scenario with a [motion] has no [body]; `stickslip check SCENARIO --parameters` lists all"),
    ("loading.pull_rate", "test: loading.pull_rate: a scenario with a [motion] has no [loading]"),
    ("initial.state", "test: initial.state: a scenario with a [motion] has no [initial]"),
    ("pressing", "test: 'pressing' is not a parameter of this scenario"),
    ("density", "test: 'density' is not a parameter of this scenario"),
]


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("name", "said"), REFUSED)
def test_a_number_of_what_is_not_there_is_refused_in_one_line(name: str, said: str) -> None:
    with pytest.raises(ss.InputError) as error:
        scenario_of(STRESS).with_values({name: 2.0})
    assert str(error.value).startswith(said)
    assert "\n" not in str(error.value)


def test_the_command_line_lists_and_refuses_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "steps.toml"
    file.write_text(HEAD + STRESS + TAIL)
    stickslip("check", file, "--parameters")
    said = capsys.readouterr().out
    assert "motion.normal_load" in said
    assert not any(word in said for word in ("body.", "loading.", "initial.", "pressing"))
    refused("run", file, "--set", "body.density=2e3")
    said = capsys.readouterr().err
    assert "body.density: a scenario with a [motion] has no [body]" in said
    assert len(said.strip().splitlines()) == 1


WRONG = [
    ("[motion]\nnormal_load = 5.0\nload_unit = 'kN'\n", "[motion] load_unit 'kN' is unknown; allowed: 'N', 'Pa', 'N m'"),
    ("[motion]\nnormal_load = '5 MPa'\nload_unit = 'N'\n", "[motion] normal_load is in Pa, and load_unit is 'N'"),
    ("[motion]\n", "[motion] normal_load is missing: a number such as '100 N' or '5 MPa', or a history"),
    (BODY.replace("density = 3e3", "density = 0.0"), "[body] density must be greater than 0 kg/m^3, got 0"),
    (BODY + "normal_load = '5 MPa'\n", "[motion] has normal_load: leave [body] out, whose load is taken where it has none"),
    ("[loading]\npull_rate = 1.0\n" + STRESS, "[motion] gives slip rate and normal load: leave [loading] out"),
    ("[initial]\nload = 1.0\n" + STRESS, "[motion] has initial_slip and initial_state: leave [initial] out"),
]


@pytest.mark.parametrize(("motion", "said"), WRONG)
def test_what_cannot_be_meant_is_refused(motion: str, said: str) -> None:
    with pytest.raises(ss.InputError) as error:
        scenario_of(motion)
    assert str(error.value) == f"test: {said}"


def test_a_motion_without_friction_says_so() -> None:
    with pytest.raises(ss.InputError) as error:
        read_scenario(STRESS + TAIL, "test")
    assert str(error.value) == "test: [friction] is missing"
