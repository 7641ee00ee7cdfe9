"""The schema is read from what laws and bodies declare: registering one is enough."""

import json
from dataclasses import MISSING, dataclass
from typing import Any, ClassVar

import pytest
import tomli_w
from hypothesis import given, settings
from hypothesis import strategies as st

from stickslip import ElasticSlab, InputError, Problem, SectionedString, SpringBlock, TorsionalString
from stickslip.foundation.quantities import LawField, NumberSeries, fields_of, quantities_of, quantity
from stickslip.friction import LAWS, FrictionLaw
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem.bodies import BODIES
from stickslip.problem.scenarios import library, templates
from stickslip.problem.scenarios.entries import describe
from stickslip.problem.scenarios.scenario import Scenario, load_scenario, read_scenario
from stickslip.problem.scenarios.schema import entries_in, quantities_in
from tests.limits import examples


def values(kind: type) -> str:
    more = {
        TorsionalString: "polar_moment = 1.5\nnormal_torque = 1.5\n",
        SectionedString: "normal_torque = 1.5\ninner_diameter = [0]\n",
    }
    lists = {name for name, (declared, _) in fields_of(kind).items() if isinstance(declared, NumberSeries)} - {"inner_diameter"}
    return more.get(kind, "") + "".join(
        f"{name} = {'[1.5]' if name in lists else '1.5'}\n"
        for name, (_, default) in {**dict.fromkeys(lists, (None, MISSING)), **quantities_in("body", kind)}.items()
        if default is MISSING
    )


def document(body: type, law: type) -> str:
    example = templates.example_of(law, body.load_unit)
    friction = (
        tomli_w.dumps({"friction": {"kind": law.kind} | example}) if example else f'[friction]\nkind = "{law.kind}"\n{values(law)}'
    )
    state = "".join(f"{name} = {json.dumps(law.start[name])}\n" for name in STATE_NAMES if name in law.start)
    return f'[body]\nkind = "{body.kind}"\n{values(body)}{friction}[initial]\nload = 1.0\n{state}[run]\nduration = 2\n'


@pytest.mark.sampled(every=15)
@pytest.mark.parametrize("law", LAWS.values())
@pytest.mark.parametrize("body", BODIES.values())
def test_every_body_with_every_law_is_read_and_written(body: type, law: type) -> None:
    scenario = read_scenario(document(body, law), "all")
    assert type(scenario.problem.body) is body
    assert type(scenario.problem.friction) is law
    assert all(isinstance(getattr(scenario.problem.friction, name), float | None) for name in quantities_of(law))
    assert read_scenario(scenario.to_toml(), "again") == scenario


@dataclass(frozen=True)
class Stribeck(FrictionLaw):
    """A law that the package does not know."""

    kind: ClassVar[str] = "stribeck"
    source: ClassVar[str] = "nowhere"
    level: float = quantity("1", "level", at_least=0)
    knee: float = quantity("m/s", "where it bends", above=0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.level / (1.0 + v / law.knee)

    def range(self) -> tuple[float, float]:
        return 0.0, self.level


def test_a_new_law_needs_only_its_registration(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(LAWS, "stribeck", Stribeck)
    text = document(ElasticSlab, Stribeck).replace("knee = 1.5", 'knee = "1 mm/s"')
    assert read_scenario(text, "new").problem.friction == Stribeck(1.5, 1e-3)
    with pytest.raises(InputError, match=r"^new: \[friction\] kne is unknown; did you mean 'knee'\?$"):
        read_scenario(text.replace("knee", "kne"), "new")
    assert '# kind = "stribeck"' in templates.template("slab")


@pytest.mark.parametrize("name", library.STARTERS)
def test_starters_explain_every_key_and_run_as_they_are(name: str) -> None:
    text = templates.template(name)
    scenario = read_scenario(text, name)
    example = load_scenario(library.STARTERS[name].example)
    assert scenario.problem == example.problem
    body = type(scenario.problem.body)
    for table, kind in (("body", body), ("friction", type(scenario.problem.friction)), ("loading", body), ("initial", body)):
        for key, (declared, _) in quantities_in(table, kind).items():
            assert any(line.lstrip("# ").startswith(f"{key} = ") and declared.meaning in line for line in text.splitlines())
    assert all(f'kind = "{law}"' in text for law in LAWS)


@pytest.mark.sampled(every=27)
@pytest.mark.parametrize("name", library.STARTERS)
@pytest.mark.parametrize("law", LAWS.values())
def test_a_starter_with_any_law_explains_every_key_of_it(name: str, law: type[FrictionLaw]) -> None:
    text = templates.template(name, law.kind)
    assert type(read_scenario(text, name).problem.friction) is law
    load_unit = read_scenario(text, name).problem.load_unit
    for key, (declared, _) in entries_in("friction", law, (), load_unit).items():
        place = (f"{key} = ", f"[friction.{key}]")
        assert any(line.lstrip("# ").startswith(place) for line in text.splitlines())
        assert isinstance(declared, LawField) or describe(declared) in text
    with pytest.raises(InputError, match=r"^new: \[friction\] kind 'hyperbolic' is unknown; did you mean 'hyperbolic-rate'\?$"):
        templates.template(name, "hyperbolic")
    with pytest.raises(InputError, match=r"^new: only slab, .*, two-slabs take a friction law; fig6-slab has its own$"):
        templates.template("fig6-slab", "coulomb")


def test_bundled_templates_are_the_bundled_files() -> None:
    for name in templates.template_names():
        if name not in library.STARTERS:
            assert templates.template(name) == load_scenario(name).source
    with pytest.raises(InputError, match=r"^no scenario 'slob'; did you mean 'slab'\?$"):
        templates.template("slob")


positive = st.floats(min_value=1e-50, max_value=1e50)
finite = st.floats(min_value=-1e50, max_value=1e50)
line = st.text(st.characters(codec="utf-8", exclude_characters="\r"), max_size=30)


@settings(max_examples=examples(60))
@given(
    mass=positive,
    stiffness=positive,
    force=positive,
    pull=finite,
    slip=finite,
    excess=finite,
    duration=positive,
    title=line,
    text=line,
)
def test_what_is_written_is_read_back_to_the_last_digit(
    mass: float,
    stiffness: float,
    force: float,
    pull: float,
    slip: float,
    excess: float,
    duration: float,
    title: str,
    text: str,
) -> None:
    body, law = SpringBlock(mass, stiffness, force), LAWS["coulomb"](0.6, 0.3)
    problem = Problem(body, law, pull_rate=pull, initial_slip=slip, initial_excess=excess, selection="maxwell")
    scenario = Scenario(problem, duration, 1e-7, title, text)
    assert read_scenario(scenario.to_toml(), "written") == scenario


def test_options_of_a_slab_are_written_too() -> None:
    body = ElasticSlab(2800, 3500, 1e4, 1e8, driver_impedance=9.8e6, contact_mass=3.0, p_wave_speed=6000)
    problem = Problem(body, LAWS["coulomb"](0.6, 0.3), 1e-9, initial_load=5e7, far_stress=1e7, far_stress_rate=0.1)
    scenario = Scenario(problem, 10.0)
    assert read_scenario(scenario.to_toml(), "written") == scenario
