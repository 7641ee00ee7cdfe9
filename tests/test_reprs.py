"""What people see of an object: short texts that can be read back, sentences, and tables for notebooks."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, fields, replace
from html.parser import HTMLParser
from typing import Any, ClassVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stickslip as ss
from stickslip.foundation.quantities import NumberSeries, Quantity, declare, fields_of, quantity
from stickslip.foundation.show import UNHANDY, brief, html_table
from stickslip.friction import LAWS, FrictionLaw
from stickslip.problem.loading import HISTORIES

NAMES: dict[str, Any] = (
    {name: getattr(ss.friction, name) for name in ss.friction.__all__}
    | {name: getattr(ss.loading, name) for name in dir(ss.loading)}
    | {name: getattr(ss, name) for name in ("ElasticSlab", "SpringBlock", "Problem")}
)
ROUGH = 5.1e-6
"""Largest relative error of a number with six digits."""
SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
SOURCES = {name: ss.load_scenario(name) for name in ("fig6-slab", "cycles-block", "rate-and-state-block", "fig4-loop")}


def same(one: Any, other: Any) -> bool:
    """Return True if two objects have the same fields, numbers to within six digits."""
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=ROUGH)
    if isinstance(one, tuple | list):
        return len(one) == len(other) and all(map(same, one, other))
    if hasattr(one, "__dataclass_fields__"):
        return type(one) is type(other) and all(same(getattr(one, f.name), getattr(other, f.name)) for f in fields(one))
    return bool(one == other)


def example_of(kind: Any) -> Any:
    """Return the law or the loading history of the example that its class gives, which may hold other laws."""
    tables = {
        name: example_of(LAWS[value["kind"]]) for name, value in kind.example.items() if isinstance(value, dict) and "kind" in value
    }
    return kind(**(kind.example | tables))


UNITS = st.sampled_from(["m", "s", "m/s", "Pa", "N", "N/m", "Pa s/m", "kg/m^3", "1/m", "s/m", "Pa/s", "kg"])


@given(value=st.floats(-1e40, 1e40).filter(lambda value: value == 0.0 or abs(value) > 1e-40), unit=UNITS)
def test_what_is_shown_can_be_given_again(value: float, unit: str) -> None:
    text = brief(value, unit)
    assert len(text) <= len(f"{value:.6g} {unit}") + UNHANDY
    assert Quantity(unit, "").check("Owner", "field", text) == pytest.approx(value, rel=ROUGH, abs=1e-320)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (1e4, "m", "10 km"),
        (2e-5, "m", "20 um"),
        (0.164279, "m", "0.164279 m"),
        (5e-8, "m/s", "5e-08 m/s"),
        (0.05 / ss.YEAR, "m/s", "0.05 m/year"),
        (1e-9, "m/s", "1e-09 m/s"),
        (480 * ss.YEAR, "s", "480 years"),
        (ss.YEAR, "s", "1 year"),
        (-64471887.2, "Pa", "-64.4719 MPa"),
        (3.43e13, "N/m", "34.3 TN/m"),
        (0.0, "Pa", "0 Pa"),
        (5.0, "1/m", "5 /m"),
        (0.1 + 0.2, "1", "0.3"),
        (math.inf, "Pa s/m", "inf Pa s/m"),
    ],
)
def test_quantities_are_shown_in_a_unit_that_makes_them_short(value: float, unit: str, text: str) -> None:
    assert brief(value, unit) == text


@pytest.mark.parametrize("kind", [*LAWS.values(), *HISTORIES.values()], ids=lambda kind: kind.kind)
def test_laws_and_histories_are_shown_as_the_call_that_makes_them(kind: Any) -> None:
    made = example_of(kind)
    text = repr(made)
    assert same(eval(text, NAMES), made)
    assert "np." not in text
    assert not re.search(r"\d{8}", text)


@pytest.mark.parametrize("name", SOURCES)
def test_problems_are_shown_in_five_lines_that_make_them_again(name: str) -> None:
    problem = SOURCES[name].problem
    text = repr(problem)
    assert len(text.splitlines()) == 5
    assert same(eval(text, NAMES), problem)
    assert name in repr(SOURCES[name])
    assert text in repr(SOURCES[name])


def test_a_problem_is_shown_with_what_differs_from_the_defaults() -> None:
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    assert repr(ss.Problem(SLAB, law, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)) == (
        "Problem(\n"
        "    ElasticSlab(density='2800 kg/m^3', wave_speed='3.5 km/s', thickness='10 km', normal_stress='100 MPa'),\n"
        "    HyperbolicRate(static=0.8, dynamic=0.3, alpha='1 s/m'),\n"
        "    pull_rate='0.05 m/year', initial_excess='0 Pa',\n"
        ")"
    )
    pulled = ss.Problem(SLAB, law, pull_rate=ss.loading.Steps([0, 60], [1e-3, 2.0]), initial_load=6e7, selection="minimal")
    last = "    pull_rate=Steps(times=['0 s', '60 s'], values=['1 mm/s', '2 m/s']), initial_load='60 MPa', selection='minimal',"
    assert repr(pulled).splitlines()[3] == last


def test_long_tables_are_summarised() -> None:
    law = ss.friction.FromTable(slip=np.linspace(0.0, 1.0, 500), friction=np.linspace(0.7, 0.5, 500))
    assert repr(law) == "FromTable(friction=<500 values, 0.7 to 0.5>, slip=<500 values, '0 m' to '1 m'>)"


@dataclass(frozen=True)
class Own(FrictionLaw):
    """A law as a user writes it, with fields that are declared and one that is not."""

    kind = "own"
    example: ClassVar = {"level": 0.5}
    level: float = quantity("1", "level")
    slips: Any = declare(NumberSeries(Quantity("m", "slips")), (0.0, 1.0))
    note: str = "plain"

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.level + 0.0 * v

    def range(self) -> tuple[float, float]:
        return self.level, self.level


def test_laws_of_users_are_shown_in_the_same_way() -> None:
    assert repr(Own(np.float64(1 / 3))) == "Own(level=0.333333)"
    assert repr(Own(0.5, slips=[0, 2e-3], note="it's")) == "Own(level=0.5, slips=['0 m', '2 mm'], note=\"it's\")"


def test_uniqueness_prints_as_sentences_and_shows_a_list() -> None:
    found = ss.uniqueness(SOURCES["fig6-slab"].problem)
    assert str(found) == found.summary
    assert f"{found}".count(". ") >= 3
    assert repr(found).splitlines() == [
        "stickslip Uniqueness",
        "  regime       irregular, proven",
        "  critical     alpha = 0.196 s/m",
        "  window       load minus static strength from -15.5281 MPa to 0 Pa",
        "  fold         slip rate 1.25876976 m/s, load 64.4718872424 MPa; proven to within 9e-15 m/s",
        "  jump up *    slip rate 0 to 4.10204082 m/s at a load of 80 MPa; traction changes by -40.2 MPa",
        "  jump down *  slip rate 1.25876976 to 0 m/s at a load of 64.4718872424 MPa; traction changes by 12.3359 MPa",
        "  loop *       the load going up and down encloses 46.2819 MPa m/s in the plane of load and slip rate",
        "  *            depends on the rule 'perfect-delay'; nothing else above does.",
        f"  summary      {found.summary}",
    ]
    assert repr(found.jumps[1]) == (
        "Jump(rate_before='1.25877 m/s', rate_after='0 m/s', load='64.4719 MPa', direction='down',"
        " traction_before='52.1359 MPa', traction_after='64.4719 MPa')"
    )


class Tables(HTMLParser):
    """Check that every element is closed in order, and collect the texts of the cells."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.cells: list[str] = []
        self.tags: set[str] = set()
        self.feed(text)
        self.close()
        assert self.open == []
        self.cells = [cell.strip() for cell in self.cells]

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.open.append(tag)
        self.tags.add(tag)
        if tag in ("td", "th", "caption", "div"):
            self.cells.append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.cells:
            self.cells[-1] += data


@pytest.mark.parametrize("name", SOURCES)
def test_notebooks_show_tables(name: str) -> None:
    scenario = SOURCES[name]
    for shown in (scenario, scenario.problem, ss.uniqueness(scenario.problem)):
        page = Tables(shown._repr_html_())
        assert {"table", "caption", "tr", "td"} <= page.tags
    cells = Tables(scenario.problem._repr_html_()).cells
    for owner, place in ((scenario.problem.body, "body"), (scenario.problem.friction, "friction")):
        assert {f"{place}.{key}" for key, (declared, _) in fields_of(type(owner)).items() if isinstance(declared, Quantity)} & set(
            cells
        )
        assert type(owner).__name__ in cells


def test_results_are_tables_in_notebooks() -> None:
    run = ss.simulate(SOURCES["cycles-block"])
    page = Tables(run._repr_html_())
    assert "events" in page.cells
    assert any(cell.startswith("7 slip events, the largest of 0.164279 m in one pulse, ") for cell in page.cells)
    study = ss.studies.ensemble(run.problem, run.duration, members=2)
    page = Tables(study._repr_html_())
    assert "recurrence" in page.cells
    assert study.text in page.cells
    compared = ss.studies.compare(run, replace(SOURCES["fig6-slab"], title=""), names=["a<b", "c&d"])
    page = Tables(compared._repr_html_())
    assert {"a<b", "c&d", "slip (m)"} <= set(page.cells)
    assert not re.search(r"\d{8}", repr(compared))


def test_html_is_escaped() -> None:
    evil = "</td><script>alert('x & y')</script>"
    page = Tables(html_table(evil, [(evil, evil)], (evil, "b")))
    assert "script" not in page.tags
    assert page.cells == [evil, evil, "b", evil, evil]
    scenario = replace(SOURCES["fig6-slab"], title=evil, description=evil, name=evil)
    assert "script" not in Tables(scenario._repr_html_()).tags


def test_exported_text_keeps_every_digit_of_body_and_law(tmp_path: Any) -> None:
    body = replace(SLAB, density=2800.123456789)
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1 / 3)
    run = ss.simulate(ss.Problem(body, law, pull_rate=1.0, initial_excess=0.0), 1.0)
    text = run.to_scec(tmp_path / "a.txt", 10.0).read_text()
    assert "'density': 2800.123456789" in text
    assert "'alpha': 0.3333333333333333" in text
